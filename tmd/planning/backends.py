"""Planners by name: ``in-process``, ``fast-downward``, and ``up:ENGINE`` for any engine of unified-planning."""

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
    raise TmdError(
        f"there is no planner '{name}'", hint=f"one of {IN_PROCESS}, {FAST_DOWNWARD}, {UP_PREFIX}ENGINE"
    )
