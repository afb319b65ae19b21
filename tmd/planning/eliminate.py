"""Leaving out of a plan what it does not need (action elimination, Fink and Yang 1992).

The first plan that a satisficing search finds makes detours. Each instruction in turn is left out, with all later ones
that can then not be executed; where the goal is reached nevertheless, they stay out.
"""

from __future__ import annotations

from collections.abc import Sequence

from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits, Cube, Task


def eliminate(plan: Sequence[Instruction], task: Task, state: Bits, goal: Sequence[Cube]) -> tuple[Instruction, ...]:
    """The plan without what it does not need to get from ``state`` to a cube of ``goal``."""
    kept = tuple(plan)
    place = 0
    while place < len(kept):
        shorter, end = _executable(kept[:place] + kept[place + 1 :], task, state)
        if any(cube.holds(end) for cube in goal):
            kept = shorter
        else:
            place += 1
    return kept


def _executable(plan: Sequence[Instruction], task: Task, state: Bits) -> tuple[tuple[Instruction, ...], Bits]:
    """What of ``plan`` can be executed in its order, and where it ends."""
    done = []
    for instruction in plan:
        operator = task.by_instruction[instruction]
        if operator.applicable(state):
            done.append(instruction)
            state = operator.apply(state)
    return tuple(done), state
