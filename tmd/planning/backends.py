"""Planners by name: ``in-process``, ``fast-downward``, and ``up:ENGINE`` for engines of unified-planning."""

from __future__ import annotations

from tmd.errors import TmdError
from tmd.pddl.task import Task
from tmd.planning.result import Planner

IN_PROCESS = "in-process"
"""The optimal search of this package, the default."""

FAST_DOWNWARD = "fast-downward"
"""The reference: Fast Downward, run by unified-planning as a separate process."""

UP_PREFIX = "up:"
"""What stands before the name of any other engine of unified-planning."""


def make(name: str, task: Task) -> Planner:
    """The planner ``name`` for ``task``.

    Raises:
        TmdError: There is no such planner.
        MissingToolError: The planner is not installed.
    """
    if name == IN_PROCESS:
        from tmd.planning.filler import GapFiller

        return GapFiller(task)
    if name == FAST_DOWNWARD:
        from tmd.planning.fast_downward import fast_downward

        return fast_downward(task)
    if name.startswith(UP_PREFIX) and len(name) > len(UP_PREFIX):
        from tmd.planning.unified import EngineSpec, UnifiedPlanner

        return UnifiedPlanner(task, EngineSpec(name.removeprefix(UP_PREFIX)))
    raise TmdError(
        f"there is no planner '{name}'", hint=f"one of {IN_PROCESS}, {FAST_DOWNWARD}, {UP_PREFIX}ENGINE"
    )
