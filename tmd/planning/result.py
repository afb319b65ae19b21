"""Answers of planners: a plan, a proof that there is none, or the limit at which the search stopped.

"No plan" is never ``None``: callers must be able to tell an impossible goal from a search that ended early,
because the first removes a candidate for good and the second only for this limit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol, TypeAlias

if TYPE_CHECKING:
    from tmd.pddl.model import Instruction
    from tmd.pddl.task import Bits, Cube, Operator


@dataclass(frozen=True, slots=True)
class Filled:
    """A plan was found.

    Attributes:
        plan: The missing instructions; empty where the goal holds already.
        cost: The sum of their costs. It is the least possible one for every optimal back-end.
    """

    plan: tuple[Instruction, ...]
    state: Bits
    cost: int


def filled(state: Bits, operators: Sequence[Operator]) -> Filled:
    """Return the plan of ``operators``, executed from ``state``."""
    for operator in operators:
        state = operator.apply(state)
    return Filled(tuple(o.instruction for o in operators), state, sum(o.cost for o in operators))


@dataclass(frozen=True, slots=True)
class Unreachable:
    """A proof that no plan exists; ``reason`` names the atoms that cannot be reached."""

    reason: str


@dataclass(frozen=True, slots=True)
class GaveUp:
    """The end of a search at ``limit``; nothing is proven."""

    limit: str


Answer: TypeAlias = Filled | Unreachable | GaveUp


@dataclass(frozen=True, slots=True)
class Solved:
    """A plan for a whole problem, executed by our own validator before anybody sees it.

    Attributes:
        optimal: Whether the planner proved that there is no cheaper plan; otherwise it was just found.
    """

    plan: tuple[Instruction, ...]
    cost: int
    optimal: bool


Solution: TypeAlias = Solved | Unreachable | GaveUp
"""The answer for a whole problem."""


class Planner(Protocol):
    """Anything that fills gaps: the in-process search and every engine of unified-planning."""

    def fill(self, state: Bits, goal: Sequence[Cube]) -> Answer:
        """Return the missing instructions from ``state`` to any cube of ``goal``."""
        ...


class NoPlanner:
    """A planner that never plans: goals that do not hold already are out of its reach."""

    def fill(self, state: Bits, goal: Sequence[Cube]) -> Answer:
        """Return the empty plan where the goal holds."""
        if any(cube.holds(state) for cube in goal):
            return Filled((), state, 0)
        return Unreachable("it would need instructions that nobody said")
