"""Planners by name, for the gaps of plans (:func:`make`) and for whole problems (:func:`solve`)."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from importlib.util import find_spec
from typing import TYPE_CHECKING

from tmd.diagnostics import MissingToolError, PlannerError, TmdError
from tmd.pddl.model import Problem
from tmd.pddl.reading.syntax import nearest
from tmd.planning.downward_process import DownwardProcess
from tmd.planning.fast_downward import FastDownward, FirstPlan
from tmd.planning.processes import Deadline
from tmd.planning.result import Answer, Filled, GaveUp, Planner, Solution, Solved

if TYPE_CHECKING:
    from tmd.pddl.task import Bits, Cube, Task

IN_PROCESS = "in-process"
"""The optimal search of this package, the default."""

IN_PROCESS_FIRST = "in-process-first"
"""The greedy search of this package, content with the first plan it finds."""

FAST_DOWNWARD = "fast-downward"
"""Fast Downward: of whole problems on PDDL text, of gaps the reference that unified-planning runs."""

KAIROS = "kairos"
"""kairos, for whole problems, where it is installed."""

AUTO = "auto"
"""For whole problems: kairos where any plan will do, then Fast Downward, or else the search of this package."""

UP_PREFIX = "up:"
"""What stands before the name of any other engine of unified-planning."""


SOON = 2_000
"""Generated states up to which the greedy search's plans are about as cheap as Fast Downward's first ones."""

FIRST_SHARE = 0.5
"""The share of the time that kairos gets at most before Fast Downward."""
FIRST_SECONDS = 30.0
"""Seconds that it gets at most: nearly all that it solves, it solves sooner."""

TIME_LIMIT = 300.0
"""Seconds for a whole problem: an impossible goal can keep a planner busy for ever."""

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
    if name.startswith(UP_PREFIX) and len(name) > len(UP_PREFIX):
        from tmd.planning.up_planners import EngineSpec, UnifiedPlanner

        return UnifiedPlanner(task, EngineSpec(name.removeprefix(UP_PREFIX)))
    raise _unknown(name, [IN_PROCESS, IN_PROCESS_FIRST, FAST_DOWNWARD, f"{UP_PREFIX}ENGINE"])


def _unknown(name: str, known: Sequence[str]) -> TmdError:
    return TmdError(f"there is no planner '{name}'", hint=nearest(name, known, what="planners"))


def last_resort(task: Task) -> Planner:
    """Who is asked for what the optimal search gave up on, content with any plan.

    We first: a plan that our greedy search comes upon soon is about as good as one of Fast Downward, and there at
    once. What it has to search long for is worse, so that is for Fast Downward, where it is installed.
    """
    if find_spec("up_fast_downward") is None:
        return make(IN_PROCESS_FIRST, task)
    return InTurn((make(IN_PROCESS_FIRST, task, cap=SOON), FirstPlan(task)))


class InTurn:
    """Planners that are asked one after another, until one does not give up.

    Args:
        planners: Who is asked, the first one first.
    """

    def __init__(self, planners: Sequence[Planner]) -> None:
        self._planners = planners

    def fill(self, state: Bits, goal: Sequence[Cube]) -> Answer:
        """The first answer that says something, or what the last planner gave up at."""
        answer: Answer = GaveUp("no planner")
        for planner in self._planners:
            answer = planner.fill(state, goal)
            if not isinstance(answer, GaveUp):
                break
        return answer


def solve(
    problem: Problem,
    planner: str = AUTO,
    *,
    optimal: bool = False,
    seconds: float = TIME_LIMIT,
    started: DownwardProcess | None = None,
) -> Solution:
    """A plan for a whole PDDL problem, from its initial state to its goal.

    Args:
        problem: The problem.
        planner: ``auto``, ``fast-downward``, ``kairos``, ``in-process`` or ``up:ENGINE``.
        optimal: Whether a plan counts only if it is proven that none is cheaper; otherwise the first one does.
        seconds: The limit for planners that are processes. The search in this process has a cap instead.
        started: Fast Downward, if it was started while the problem was read.

    Raises:
        TmdError: There is no such planner, it does not take the problem, or (in this process) that cannot be ground.
        MissingToolError: The planner is not installed.
        PlannerError: The planner died, or what it gave is no plan.
    """
    answer = _solution(problem, planner, optimal, Deadline(seconds), started)
    if optimal and isinstance(answer, Solved) and not answer.optimal:
        return GaveUp(f"a plan of cost {answer.cost} that {planner} did not prove to be optimal")
    return answer


def _solution(
    problem: Problem, planner: str, optimal: bool, deadline: Deadline, started: DownwardProcess | None
) -> Solution:
    name = planner
    if planner == AUTO:
        if not optimal and find_spec("kairos"):
            first = deadline.at_most(min(FIRST_SECONDS, FIRST_SHARE * deadline.seconds))
            with suppress(PlannerError, MissingToolError):
                found = _solution(problem, KAIROS, optimal, first, None)
                if isinstance(found, Solved):  # it was replayed; that there is no plan is for others to confirm
                    return found
        name = FAST_DOWNWARD if find_spec("up_fast_downward") else IN_PROCESS
    if name == FAST_DOWNWARD:
        return FastDownward(problem, optimal=optimal, deadline=deadline).solve(started)
    if name == KAIROS:
        from tmd.planning.kairos import kairos

        return kairos(problem, optimal=optimal, deadline=deadline)
    if name.startswith(UP_PREFIX) and len(name) > len(UP_PREFIX):
        from tmd.planning.up_planners import solved_by_engine

        return solved_by_engine(problem, name.removeprefix(UP_PREFIX), deadline)
    if name != IN_PROCESS:
        raise _unknown(name, [AUTO, FAST_DOWNWARD, KAIROS, IN_PROCESS, f"{UP_PREFIX}ENGINE"])
    from tmd.pddl.grounding.ground_task import ground

    task = ground(problem)
    answer = make(IN_PROCESS, task, cap=PLAN_CAP).fill(task.init, task.goal)
    return Solved(answer.plan, answer.cost, optimal=True) if isinstance(answer, Filled) else answer
