"""Leaving out of a plan what it does not need (action elimination, Fink and Yang 1992).

The first plan that a satisficing search finds makes detours. Each instruction in turn is left out, with all later ones
that can then not be executed; where the goal is reached nevertheless, they stay out. What people showed is left as they
do it but for whole objects: a second cup that is only taken and put down is not touched.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

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


def untouched(
    plan: Sequence[Instruction],
    task: Task,
    state: Bits,
    reached: Callable[[Sequence[Instruction]], bool],
    counted: Bits,
) -> tuple[Instruction, ...]:
    """The plan without the objects that it handles for nothing.

    Args:
        plan: The plan.
        task: The ground problem.
        state: Where it starts.
        reached: Whether a plan does what it is for.
        counted: The atoms that count as changes; what is left out must not leave more of them changed.
    """
    kept = tuple(plan)
    for name in dict.fromkeys(a for i in plan for a in i.args):
        rest = [i for i in kept if name not in i.args]
        shorter, end = _executable(rest, task, state)
        before = _executable(kept, task, state)[1]
        fewer = ((end ^ state) & counted).bit_count() <= ((before ^ state) & counted).bit_count()
        if len(rest) < len(kept) and fewer and reached(shorter):
            kept = shorter
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
