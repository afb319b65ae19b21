"""getConstraints (section VI-E): what a sequence of instructions needs of the state it begins in."""

from __future__ import annotations

from collections.abc import Sequence

from tmd.pddl.model import Instruction
from tmd.pddl.semantics import regress
from tmd.pddl.task import Cube, Operator, Task

MOST_CUBES = 64
"""Conditional effects can make the constraints a long disjunction; the smallest cubes are kept. What is lost
are only roundabout ways to make the sequence executable; every cube kept is exact."""


def get_constraints(operators: Sequence[Operator]) -> list[tuple[Cube, ...]]:
    """For each t the constraints of ``operators[t:]``, as a disjunction of cubes; the last entry is "true".

    A sequence begun in a state that satisfies one of the cubes can be executed to its end. An empty
    disjunction means that it never can.
    """
    found: list[tuple[Cube, ...]] = [(Cube(),)]
    for operator in reversed(operators):
        cubes: set[Cube] = set()
        for cube in found[-1]:
            cubes.update(regress(cube, operator))
        found.append(tuple(sorted(cubes, key=_size)[:MOST_CUBES]))
    found.reverse()
    return found


class Constraints:
    """The constraints of instruction sequences in one task, remembered."""

    def __init__(self, task: Task) -> None:
        self._task = task
        self._known: dict[tuple[Instruction, ...], tuple[Cube, ...]] = {}

    def of(self, instructions: tuple[Instruction, ...]) -> tuple[Cube, ...]:
        """The constraints of a sequence; those of its tails are kept as well, since tails are asked for next."""
        if instructions not in self._known:
            operators = [self._task.by_instruction[i] for i in instructions]
            for t, cubes in enumerate(get_constraints(operators)):
                self._known[instructions[t:]] = cubes
        return self._known[instructions]


def _size(cube: Cube) -> tuple[int, int, int]:
    return (cube.positive.bit_count() + cube.negative.bit_count(), cube.positive, cube.negative)
