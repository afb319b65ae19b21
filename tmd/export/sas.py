"""SAS+ by Fast Downward's translator."""

from __future__ import annotations

from tmd.export.planned_problem import Planned
from tmd.planning.fast_downward import translated


def format_sas(source: Planned) -> str:
    """Format the problem as Fast Downward's translator writes it.

    Raises:
        MissingToolError: Fast Downward is not installed.
        PlannerError: The translator refuses the problem, or died.
        LimitError: It did not end.
    """
    return translated(source.problem)
