"""Planners by name: ``in-process``, ``fast-downward``, and ``up:ENGINE`` for engines of unified-planning."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.util import find_spec

from tmd.diagnostics import TmdError
from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.model import Problem
from tmd.pddl.reading.syntax import nearest
from tmd.pddl.task import Bits, Cube, Task
from tmd.planning.result import Answer, GaveUp, Planner

IN_PROCESS = "in-process"
"""The optimal search of this package, the default."""

IN_PROCESS_FIRST = "in-process-first"
"""The greedy search of this package, content with the first plan it finds."""

FAST_DOWNWARD = "fast-downward"
"""The reference: Fast Downward, run by unified-planning as a separate process."""

FAST_DOWNWARD_FIRST = "fast-downward-first"
"""Fast Downward again, content with the first plan it finds: for whole problems, where optimal is too much to ask."""

AUTO = "auto"
"""For whole problems: the optimal search as far as its cap for gaps, then the first plan of Fast Downward."""

UP_PREFIX = "up:"
"""What stands before the name of any other engine of unified-planning."""


SOON = 2_000
"""Generated states up to which the greedy search's plans are about as cheap as Fast Downward's first ones."""

PLAN_CAP = 1_000_000
"""Generated states after which the in-process search gives up on a whole problem; gaps have a smaller cap."""


def make(name: str, task: Task, *, cap: int | None = None) -> Planner:
    """The planner ``name`` for ``task``.

    Args:
        name: The planner.
        task: The ground problem.
        cap: Generated states after which the in-process search gives up; the usual cap for gaps by default.

    Raises:
        TmdError: There is no such planner, or it refuses the problem.
        MissingToolError: The planner is not installed.
    """
    if name == IN_PROCESS:
        from tmd.planning.gap_filler import GapFiller
        from tmd.planning.search.in_process import DEFAULT_CAP

        return GapFiller(task, cap=DEFAULT_CAP if cap is None else cap)
    if name == IN_PROCESS_FIRST:
        from tmd.planning.search.in_process import DEFAULT_CAP, FirstSearch

        return FirstSearch(task, cap=DEFAULT_CAP if cap is None else cap)
    if name == FAST_DOWNWARD:
        from tmd.planning.up_planners import fast_downward

        return fast_downward(task)
    if name == FAST_DOWNWARD_FIRST:
        from tmd.planning.up_planners import first_plan

        return first_plan(task)
    if name.startswith(UP_PREFIX) and len(name) > len(UP_PREFIX):
        from tmd.planning.up_planners import EngineSpec, UnifiedPlanner

        return UnifiedPlanner(task, EngineSpec(name.removeprefix(UP_PREFIX)))
    known = [IN_PROCESS, IN_PROCESS_FIRST, FAST_DOWNWARD, FAST_DOWNWARD_FIRST, f"{UP_PREFIX}ENGINE"]
    raise TmdError(f"there is no planner '{name}'", hint=nearest(name, known, what="planners"))


class InTurn:
    """Planners that are asked one after another, until one does not give up; each is made when it is first asked.

    Args:
        task: The ground problem.
        planners: The name and the cap of each, as :func:`make` takes them.
    """

    def __init__(self, task: Task, planners: Sequence[tuple[str, int | None]]) -> None:
        self._task = task
        self._asked = tuple(planners)
        self._planners: dict[str, Planner] = {}

    def fill(self, state: Bits, goal: Sequence[Cube]) -> Answer:
        """The first answer that says something, or what the last planner gave up at.

        Raises:
            TmdError, MissingToolError: As :func:`make`.
        """
        answer: Answer = GaveUp("no planner")
        for name, cap in self._asked:
            if name not in self._planners:
                self._planners[name] = make(name, self._task, cap=cap)
            answer = self._planners[name].fill(state, goal)
            if not isinstance(answer, GaveUp):
                break
        return answer


def last_resort(task: Task) -> InTurn:
    """Who is asked for what the optimal search gave up on, content with any plan.

    We first: a plan that our greedy search comes upon soon is about as good as one of Fast Downward, and there at
    once. What it has to search long for is worse, so that is for Fast Downward, where it is installed.
    """
    if find_spec("up_fast_downward") is None:
        return InTurn(task, ((IN_PROCESS_FIRST, None),))
    return InTurn(task, ((IN_PROCESS_FIRST, SOON), (FAST_DOWNWARD_FIRST, None)))


def solve(problem: Problem, planner: str = AUTO) -> Answer:
    """A plan for a whole PDDL problem, from its initial state to its goal.

    Where nothing else is asked for, the plan is optimal if it is found within the cap for gaps, and otherwise the
    first that Fast Downward finds (the in-process search goes on alone where that is not installed).

    Raises:
        TmdError: As :func:`make`, or the problem cannot be ground.
        MissingToolError: As :func:`make`.
    """
    task = ground(problem)
    if planner != AUTO:
        return make(planner, task, cap=PLAN_CAP).fill(task.init, task.goal)
    answer = make(IN_PROCESS, task).fill(task.init, task.goal)
    if not isinstance(answer, GaveUp):
        return answer
    name = FAST_DOWNWARD_FIRST if find_spec("up_fast_downward") else IN_PROCESS
    return make(name, task, cap=PLAN_CAP).fill(task.init, task.goal)
