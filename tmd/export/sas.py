"""SAS+ by Fast Downward's translator."""

from __future__ import annotations

from tmd.diagnostics import LimitError
from tmd.export.planned_problem import Planned
from tmd.planning.downward_process import DownwardProcess
from tmd.planning.fast_downward import texts_for_planners
from tmd.planning.processes import Deadline, died

# Seconds after which the translator is stopped: a guard, no part of the result.
_LIMIT = 600.0


def format_sas(source: Planned) -> str:
    """Return the problem as Fast Downward's translator writes it.

    Raises:
        MissingToolError: Fast Downward is not installed.
        PlannerError: The translator refuses the problem, or died.
        LimitError: It did not end.
    """
    deadline = Deadline(_LIMIT)
    with DownwardProcess(None) as translator:
        translator.give(texts_for_planners(source.problem), deadline)
        code = translator.process.wait(deadline)
        if code is None:
            raise LimitError(
                f"Fast Downward's translator did not end within {_LIMIT:g} s", hint="use a smaller problem"
            )
        if code:
            raise translator.process.failed(f"did not translate the problem: it {died(code)}")
        translator.sas.seek(0)
        return translator.sas.read().decode()
