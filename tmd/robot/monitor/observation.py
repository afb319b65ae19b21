"""The symbolic state, read back from the simulation.

A fact is *seen* (a sensor measures it), *derived* (the rules of ``objects.yaml`` follow it from what is seen) or
*kept*: contents, heat and the like have no physics here. A kept fact changes as PDDL says, and only when the
skill's own event was seen in the simulation; what PDDL says is asked of the state that was observed before, not of
the one that was predicted.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.model import GroundAtom, Instruction, Problem, State, universe
from tmd.pddl.semantics import apply
from tmd.pddl.task import Operator, Task
from tmd.robot.skills.skill_file import Skills
from tmd.world.compile import derive, derive_rules
from tmd.world.folder import DomainFolder


class Senses(Protocol):
    """What can be measured in a simulation."""

    def held(self) -> Sequence[str]:
        """The items between the fingers, one for each hand that holds something."""
        ...

    def support(self, item: str) -> tuple[str, str] | None:
        """What an item is at, and how: (thing, relation)."""
        ...

    def is_open(self, name: str) -> bool | None:
        """Whether a door, drawer or lid is open; ``None`` for what has no joint."""
        ...

    def setting(self, name: str) -> str | None:
        """The setting that a knob is at; ``None`` for what has no joint, or stands between two."""
        ...

    def reach(self, name: str) -> float:
        """The distance on the floor from the robot's shoulders to a thing, in metres."""
        ...

    def measured(self, atom: GroundAtom, sensor: str) -> str:
        """The numbers behind a fact, for people."""
        ...


REACH = 1.1
"""Metres within which things are near."""


@dataclass(frozen=True, slots=True)
class Mismatch:
    """A fact that is not as PDDL predicted.

    Attributes:
        atom: The fact.
        expected: Whether it should hold.
        measured: What the simulation shows.
    """

    atom: GroundAtom
    expected: bool
    measured: str

    def __str__(self) -> str:
        return f"{'' if self.expected else 'not '}{self.atom} was expected, but {self.measured}"


class Observer:
    """Reads states back.

    Args:
        problem: The environment.
        folder: Its domain.
        skills: Which predicate is seen by which sensor.
        senses: The simulation.
    """

    def __init__(self, problem: Problem, folder: DomainFolder, skills: Skills, senses: Senses) -> None:
        self.problem = problem
        self.folder = folder
        self.skills = skills
        self.senses = senses
        self._universe = universe(problem)
        declared = {p.name: p.parameters for p in problem.domain.predicates}
        self._robots = {
            predicate: self._universe.of(declared[predicate][0].types)
            for predicate, sensor in skills.seen.items()
            if sensor in ("held", "one_hand", "two_hands")
        }

        self._task, self._rules = self._ground()

    def _ground(self) -> tuple[Task, list[Operator]]:
        """The rules that derive what is asked for, on bit sets."""
        domain = self.problem.domain
        rules = [
            replace(schema, name=f"{schema.name}_{number}")
            for number, (schema, _, _) in enumerate(derive_rules(self.folder) if self.skills.derived else ())
            if any(effect.atom.predicate in self.skills.derived for effect in schema.effects)
        ]
        task = ground(replace(self.problem, domain=replace(domain, actions=(*domain.actions, *rules))))
        known = [task.by_instruction.get(Instruction(rule.name)) for rule in rules]
        return task, [operator for operator in known if operator is not None]

    def after(self, before: State, instruction: Instruction, *, happened: bool) -> State:
        """The state now.

        Args:
            before: The state that was observed before ``instruction``.
            instruction: What was done.
            happened: Whether the skill's own event was seen; otherwise kept facts stay as they were.
        """
        kept = apply(instruction, before, self.problem) if happened else before
        return self.now(kept)

    def now(self, kept: State) -> State:
        """The state now, with what cannot be seen as in ``kept``."""
        told = {a for a in kept if a.predicate not in self.skills.seen and a.predicate not in self.skills.derived}
        found = frozenset(told | self._seen(kept))
        if not self.skills.derived:
            return found
        bits = self._task.encode(found)
        if any(a not in self._task.index and a not in self._task.static for a in found):
            followed = derive(self.problem, self.folder, found)  # a fact that no instruction brings about
        else:
            for operator in self._rules:
                bits = operator.apply(bits)
            followed = self._task.decode(bits)
        return found | {a for a in followed if a.predicate in self.skills.derived}

    def mismatches(self, predicted: State, observed: State) -> list[Mismatch]:
        """Where the two differ, and where what should be confirmed is not; sorted."""
        found = []
        for atom in sorted(predicted ^ observed):
            expected = atom in predicted
            sensor = self.skills.seen.get(atom.predicate, "")
            found.append(Mismatch(atom, expected, self._measured(atom, sensor, atom in observed)))
        for atom in sorted(predicted & observed):
            if self.skills.confirmed.get(atom.predicate) == "reach" and self.senses.reach(atom.args[-1]) > REACH:
                found.append(Mismatch(atom, True, self.senses.measured(atom, "reach")))
        return found

    def _measured(self, atom: GroundAtom, sensor: str, holds: bool) -> str:
        if sensor:
            return self.senses.measured(atom, sensor)
        if atom.predicate in self.skills.derived:
            return f"what is seen gives {'' if holds else 'not '}{atom}"
        return f"nothing was seen that would {'end' if holds else 'bring about'} it"

    def _seen(self, kept: State) -> set[GroundAtom]:
        found: set[GroundAtom] = set()
        held = self.senses.held()
        for predicate, sensor in self.skills.seen.items():
            match sensor:
                case "held":
                    found.update(GroundAtom(predicate, (r, x)) for r in self._robots[predicate] for x in held)
                case "one_hand" | "two_hands":
                    if len(held) == (1 if sensor == "one_hand" else 2):
                        found.update(GroundAtom(predicate, (r,)) for r in self._robots[predicate])
                case _:
                    found |= self._of_things(predicate, sensor, kept, held)
        return found

    def _of_things(self, predicate: str, sensor: str, kept: State, held: Sequence[str]) -> set[GroundAtom]:
        found: set[GroundAtom] = set()
        declared = next(p for p in self.problem.domain.predicates if p.name == predicate)
        for name in self._names(declared.parameters[0].types):
            before = {a for a in kept if a.predicate == predicate and a.args[0] == name}
            if sensor == "support":
                place = None if name in held else self.senses.support(name)
                found |= {GroundAtom(predicate, (name, *place))} if place else set()
            elif sensor == "joint":
                is_open = self.senses.is_open(name)
                found |= before if is_open is None else {GroundAtom(predicate, (name,))} if is_open else set()
            else:
                setting = self.senses.setting(name)
                found |= before if setting is None else {GroundAtom(predicate, (name, setting))}
        return found

    def _names(self, types: Iterable[str]) -> tuple[str, ...]:
        return tuple(self._universe.of(tuple(types)))
