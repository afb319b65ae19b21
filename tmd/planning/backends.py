"""Planners by name: ``in-process``, ``fast-downward``, and ``up:ENGINE`` for engines of unified-planning."""

from __future__ import annotations

from importlib.util import find_spec

from tmd.errors import TmdError
from tmd.pddl.grounding import ground
from tmd.pddl.model import Problem
from tmd.pddl.syntax import nearest
from tmd.pddl.task import Task
from tmd.planning.result import Answer, GaveUp, Planner

IN_PROCESS = "in-process"
"""The optimal search of this package, the default."""

FAST_DOWNWARD = "fast-downward"
"""The reference: Fast Downward, run by unified-planning as a separate process."""

FAST_DOWNWARD_FIRST = "fast-downward-first"
"""Fast Downward again, content with the first plan it finds: for whole problems, where optimal is too much to ask."""

AUTO = "auto"
"""For whole problems: the optimal search as far as its cap for gaps, then the first plan of Fast Downward."""

UP_PREFIX = "up:"
"""What stands before the name of any other engine of unified-planning."""


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
        from tmd.planning.filler import GapFiller
        from tmd.planning.search import DEFAULT_CAP

        return GapFiller(task, cap=DEFAULT_CAP if cap is None else cap)
    if name == FAST_DOWNWARD:
        from tmd.planning.fast_downward import fast_downward

        return fast_downward(task)
    if name == FAST_DOWNWARD_FIRST:
        from tmd.planning.fast_downward import first_plan

        return first_plan(task)
    if name.startswith(UP_PREFIX) and len(name) > len(UP_PREFIX):
        from tmd.planning.unified import EngineSpec, UnifiedPlanner

        return UnifiedPlanner(task, EngineSpec(name.removeprefix(UP_PREFIX)))
    known = [IN_PROCESS, FAST_DOWNWARD, FAST_DOWNWARD_FIRST, f"{UP_PREFIX}ENGINE"]
    raise TmdError(f"there is no planner '{name}'", hint=nearest(name, known, what="planners"))


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
