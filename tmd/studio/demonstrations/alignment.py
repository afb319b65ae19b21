"""Proposed clauses for the steps of a demonstration; the person may change them.

Steps serve the clauses in the order of the text. How well a step fits a clause depends on the objects that both speak
of (:mod:`tmd.library.clause_alignment`), and by what the library's demonstrations did for the clause's verb: which
instructions, and with which of them they ended. The best division is found by dynamic programming. Clauses at the end
may be without steps at no cost, for the person may not be there yet.

The four constants were chosen on the bundled demonstrations; ``python -m experiments.studio.alignment`` measures how
well the proposals agree with them.
"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from tmd.language.clause import Clause
from tmd.library.clause_alignment import cut_cost, fit, speaks_of
from tmd.library.library import Library
from tmd.pddl.model import Instruction
from tmd.world.world import World

# What it counts that a verb's instructions are usual for it.
_HABIT = 0.75
# What it counts that a verb usually ends so.
_END = 0.5
# What it costs to leave a clause without steps and go on to the next.
_PASSED_OVER = 1.5
# Number of instructions that a verb must have been shown with to count as much as all verbs together.
_PRIOR = 5.0
_NEVER = -1e9
# The keys of all verbs together, and of none.
_ALL, _NOBODY = "", "?"


@dataclass(frozen=True)
class Habits:
    """Instructions that were carried out for each verb.

    Attributes:
        library: Where they were counted.
        done: For each canonical verb how often each instruction was carried out; for all verbs together under "".
        ended: The same for the last instructions.
    """

    library: Library | None = None
    done: defaultdict[str, Counter[str]] = field(default_factory=lambda: defaultdict(Counter))
    ended: defaultdict[str, Counter[str]] = field(default_factory=lambda: defaultdict(Counter))

    @staticmethod
    def of(library: Library) -> Habits:
        """Count in ``library``."""
        found = Habits(library)
        for verb in library.verbs():
            for template in library.templates(verb):
                names = [instruction.name for instruction in template.instructions]
                for counted in (verb, _ALL):
                    found.done[counted].update(names)
                    found.ended[counted][names[-1]] += 1
        return found

    def verb(self, clause: Clause | None) -> str:
        """Return the canonical verb of a clause."""
        if clause is None or self.library is None:
            return _NOBODY
        return self.library.lexicon.canonical_verb(clause.verb)

    def usual(self, verb: str, instruction: str) -> float:
        """Return ln P(instruction | verb) / P(instruction); 0 where nothing is known."""
        everything, own = self.done[_ALL], self.done[verb]
        share = (everything[instruction] + 0.5) / (everything.total() + 0.5 * (len(everything) + 1))
        return math.log((own[instruction] + _PRIOR * share) / (own.total() + _PRIOR) / share)

    def ends(self, verb: str, instruction: str) -> float:
        """Return the probability that the instruction was the last one for the verb."""
        share = (self.ended[_ALL][instruction] + 0.5) / (self.done[_ALL][instruction] + 1.0)
        ended = self.ended[verb][instruction] + _PRIOR * share
        return min(max(ended / (self.done[verb][instruction] + _PRIOR), 1e-3), 1 - 1e-3)


# Nothing was ever shown.
NO_HABITS = Habits()


def propose(
    clauses: Sequence[Clause | None],
    instructions: Sequence[Instruction],
    world: World,
    pinned: Mapping[int, int],
    habits: Habits = NO_HABITS,
) -> tuple[int, ...]:
    """Return the number of the clause of each instruction, from 0, never falling.

    There is at least one clause. ``instructions`` were carried out from the environment's initial state on. ``pinned``
    has the clauses that the person chose, from 0 and never falling, by the number of the instruction, from 0.
    ``habits`` are what was done for verbs before.
    """
    if len(clauses) == 1 or not instructions:
        return (0,) * len(instructions)
    verbs = [habits.verb(clause) for clause in clauses]
    said = [speaks_of(c, world.mentions, world.task.init) if c is not None else {} for c in clauses]
    best = [-_PASSED_OVER * number for number in range(len(clauses))]
    came_from: list[list[int]] = []
    for step, instruction in enumerate(instructions):
        if step:
            ended = [habits.ends(verb, instructions[step - 1].name) for verb in verbs]
            cut = cut_cost(instructions, step, world.profiles)
            best, origins = _advanced(best, ended, cut)
            came_from.append(origins)
        for number, verb in enumerate(verbs):
            fits = fit(instruction, said[number], world.profiles) + _HABIT * habits.usual(verb, instruction.name)
            best[number] += fits if pinned.get(step, number) == number else _NEVER
    found = [best.index(max(best))]
    for origins in reversed(came_from):
        found.append(origins[found[-1]])
    return tuple(reversed(found))


def _advanced(best: Sequence[float], ended: Sequence[float], cut: float) -> tuple[list[float], list[int]]:
    """Return for each clause the best value one step on, and the clause of the step before that leads there.

    ``best`` has the same for the step before, ``ended`` for each clause how likely it is that this step was its last;
    ``cut`` is what it costs to change the clause here.
    """
    values, origins = [], []
    for number in range(len(best)):
        ways = [(best[number] + _END * math.log(1 - ended[number]), number)]
        for before in range(number):
            passed_over = _PASSED_OVER * (number - before - 1)
            ways.append((best[before] + _END * math.log(ended[before]) - cut - passed_over, before))
        value, origin = max(ways, key=lambda way: way[0])
        values.append(value)
        origins.append(origin)
    return values, origins
