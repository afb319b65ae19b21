"""The gap filler of inference: the cheapest instructions between two that somebody asked for.

This is the planner call of section IV-B of the paper. One utterance asks for thousands of such gaps, so the order
of work is: what holds already, what is remembered, a short search, the proof that a goal is impossible, a long
search.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tmd.pddl.task import Bits, Cube, Task
from tmd.planning.memo import Memo
from tmd.planning.result import Answer, Filled, GaveUp, Unreachable
from tmd.planning.search.in_process import DEFAULT_CAP, Backend, OptimalSearch, replayed
from tmd.planning.unsolvability.proofs import Impossible

BRIEF = 100
"""Generated states after which a search stops to ask whether its goal is impossible."""
QUICK = 2_000
"""A filler with no greater cap does not look further for the reason when it gives up."""


@dataclass
class Counters:
    """How many questions a filler answered, and by what means."""

    held: int = 0
    exact: int = 0
    generalised: int = 0
    searched: int = 0
    generated: int = 0


class GapFiller:
    """Fills gaps of plans for one task.

    Every answer depends on the question alone: the canonical cheapest plan. With ``generalise`` that is given up
    for speed: an answer may be a plan remembered from another state. It is valid, may be dearer than necessary, and
    may depend on what was asked before (see :meth:`forget`).

    Args:
        task: The ground problem. States may be any that its operators reach from where it was ground.
        backend: The form of the search kernel: ``"auto"``, ``"numba"`` or ``"python"``; plans are the same.
        memo: Whether answers are remembered.
        generalise: Whether remembered plans are used in other states that meet their needs.
        cap: Give up after this many generated states.

    Attributes:
        counters: What was asked and how it was answered.

    Raises:
        MissingToolError: ``backend`` is ``"numba"`` and numba is not installed.
        TmdError: There is no such back-end, or the cap is not positive.
    """

    def __init__(
        self,
        task: Task,
        *,
        backend: Backend = "auto",
        memo: bool = True,
        generalise: bool = False,
        cap: int = DEFAULT_CAP,
    ) -> None:
        self.task = task
        self.counters = Counters()
        self._search = OptimalSearch(task, backend=backend, cap=cap)
        self._impossible = Impossible(task)
        self._memo = Memo(task.operators, generalise) if memo else None

    def fill(self, state: Bits, goal: Sequence[Cube]) -> Answer:
        """The missing instructions from ``state`` to any cube of ``goal``."""
        cubes = tuple(goal)
        if any(cube.holds(state) for cube in cubes):
            self.counters.held += 1
            return Filled((), state, 0)
        if self._memo is None:
            return self._searched(state, cubes)[0]
        known = self._memo.exact(state, cubes)
        if known is not None:
            self.counters.exact += 1
            return known
        entry = self._memo.matching(state, cubes)
        if entry is not None:
            self.counters.generalised += 1
            answer: Answer = replayed(self.task, state, entry.steps)
            self._memo.store(state, cubes, answer)
            return answer
        answer, steps = self._searched(state, cubes)
        self._memo.store(state, cubes, answer, steps)
        return answer

    def forget(self) -> None:
        """Empty the memo, so that later answers do not depend on earlier questions."""
        if self._memo is not None:
            self._memo.clear()

    def _searched(self, state: Bits, goal: tuple[Cube, ...]) -> tuple[Answer, Sequence[int]]:
        self.counters.searched += 1
        search = self._search
        answer = search.fill(state, goal, min(BRIEF, search.cap))
        self.counters.generated += search.generated
        if not isinstance(answer, GaveUp):
            return answer, search.steps
        reason = self._impossible.reason(state, goal)
        if reason is not None:
            return Unreachable(reason), ()
        if search.cap > BRIEF:
            answer = search.fill(state, goal)
            self.counters.generated += search.generated
        if isinstance(answer, GaveUp) and search.cap > QUICK:
            reason = self._impossible.reason_from(state, goal)
            if reason is not None:
                return Unreachable(reason), ()
        return answer, search.steps
