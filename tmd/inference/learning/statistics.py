"""What is counted in the training data for the priors and the consistency of the energy (section VI).

Three tables: how often each instruction occurs, how often a parameter of an instruction is of each class, and in
which states the objects of a clause are when the clause has been done, P(obj, s, v).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from tmd.pddl.model import Instruction
from tmd.veil.library import Library
from tmd.veil.profiles import Profile
from tmd.veil.template import Template
from tmd.veil.world import World

SMOOTHING = 1.0
"""Added to every count, so that nothing has probability zero (Laplace)."""

StateName = tuple[str, ...]


@dataclass(slots=True)
class Frequencies:
    """Counts of things of one kind, with smoothed probabilities."""

    counts: dict[str, int] = field(default_factory=dict)
    total: int = 0

    def add(self, name: str) -> None:
        """Count one occurrence."""
        self.counts[name] = self.counts.get(name, 0) + 1
        self.total += 1

    def surprise(self, name: str) -> float:
        """-log P(name); what was never seen shares one smoothed count."""
        kinds = len(self.counts) + 1
        return -math.log((self.counts.get(name, 0) + SMOOTHING) / (self.total + SMOOTHING * kinds))


@dataclass(slots=True)
class EndStates:
    """P(obj, s, v): how often an object of a class was in a state when a clause that speaks of it had been done."""

    counts: dict[tuple[str, StateName, bool], int] = field(default_factory=dict)

    def add(self, kind: str, profile: Profile) -> None:
        """Count the states of one object."""
        for state, value in profile.items():
            key = kind, state, value
            self.counts[key] = self.counts.get(key, 0) + 1

    def probability(self, kind: str, state: StateName, value: bool) -> float:
        """The smoothed probability of ``value``; a half where nothing is known."""
        own = self.counts.get((kind, state, value), 0) + SMOOTHING
        other = self.counts.get((kind, state, not value), 0) + SMOOTHING
        return own / (own + other)

    def mean(self, objects: Iterable[tuple[str, Profile]]) -> float | None:
        """The mean probability over all states of the objects (kind and profile); ``None`` for no state at all."""
        found = [self.probability(kind, state, value) for kind, profile in objects for state, value in profile.items()]
        return math.fsum(found) / len(found) if found else None


@dataclass(slots=True)
class Statistics:
    """All tables.

    Attributes:
        instructions: How often each instruction occurs.
        parameters: For each parameter of each instruction, the classes of its objects.
        ends: P(obj, s, v) for the objects that clauses of a verb speak of.
        all_ends: The same whatever the verb, for every object that was used: for latent instructions.
    """

    instructions: Frequencies = field(default_factory=Frequencies)
    parameters: dict[tuple[str, int], Frequencies] = field(default_factory=dict)
    ends: dict[str, EndStates] = field(default_factory=dict)
    all_ends: EndStates = field(default_factory=EndStates)

    def surprise(self, instruction: Instruction, kinds: Sequence[str]) -> tuple[float, float]:
        """-log P of the instruction, and the mean -log P of the classes of its arguments."""
        own = self.instructions.surprise(instruction.name)
        tables = (self.parameters.get((instruction.name, i), _NOTHING) for i in range(len(kinds)))
        each = [table.surprise(kind) for table, kind in zip(tables, kinds, strict=True)]
        return own, math.fsum(each) / len(each) if each else 0.0


_NOTHING = Frequencies()


def count(library: Library) -> Statistics:
    """The tables of a library."""
    found = Statistics()
    for verb in library.verbs():
        for template in library.templates(verb):
            _count_template(verb, template, found)
    return found


def _count_template(verb: str, template: Template, found: Statistics) -> None:
    for instruction in template.instructions:
        found.instructions.add(instruction.name)
        for position, argument in enumerate(instruction.args):
            table = found.parameters.setdefault((instruction.name, position), Frequencies())
            table.add(template.classes.get(argument, argument))
    ends = found.ends.setdefault(verb, EndStates())
    for kind, profile in template.subjects:
        ends.add(kind, profile)
    for variable, profile in template.ends.items():
        found.all_ends.add(template.classes[variable], profile)


def kind_of(name: str, world: World) -> str:
    """The kind of an object, its class as a rule; a constant is its own."""
    if name in world.profiles.constants:
        return name
    return world.mentions.kinds.get(name, name)
