"""The gap filler of inference: the cheapest instructions between two that somebody asked for.

This is the planner call of section IV-B of the paper ("a symbolic planner to find the missing instructions").
One utterance asks thousands of such gaps, so answers are remembered.
"""

from __future__ import annotations

from collections.abc import Sequence

from tmd.pddl.task import Bits, Cube, Task
from tmd.planning.result import Answer
from tmd.planning.search import DEFAULT_CAP, Backend, OptimalSearch


class GapFiller:
    """Fills gaps of plans for one task, optimally.

    Args:
        task: The ground problem. States may be any that its operators reach from where it was ground.
        backend: The form of the search kernel: ``"auto"``, ``"numba"`` or ``"python"``; plans are the same.
        memo: Whether answers are remembered, and used in other states that meet the same needs.
        cap: Give up after this many generated states.
    """

    def __init__(
        self, task: Task, *, backend: Backend = "auto", memo: bool = True, cap: int = DEFAULT_CAP
    ) -> None:
        self.task = task
        self.memo = memo
        self._search = OptimalSearch(task, backend=backend, cap=cap)

    def fill(self, state: Bits, goal: Sequence[Cube]) -> Answer:
        """The cheapest missing instructions from ``state`` to any cube of ``goal``."""
        return self._search.fill(state, goal)
