"""kairos, a planner of the package kairos-planner (Apache-2.0): its program on PDDL text, as a process."""

from __future__ import annotations

import os
import re
import shutil
import sys
from pathlib import Path

from tmd.diagnostics import MissingToolError
from tmd.pddl.model import Problem
from tmd.planning.fast_downward import checked, texts_for_planners
from tmd.planning.processes import Deadline, PlannerProcess, died, unnamed_file
from tmd.planning.prover import EXPLAINING, Prover
from tmd.planning.result import GaveUp, Solution, Unreachable

NAME = "kairos"
_BETTER = re.compile(r"^; better plan.*$", re.MULTILINE)
_PROVEN = "solved (proven optimal)"


def kairos(problem: Problem, *, optimal: bool, deadline: Deadline) -> Solution:
    """A plan of kairos; with ``optimal`` the best it finds by the deadline, and whether it proved that it is.

    Raises:
        MissingToolError: kairos is not installed.
        PlannerError: It died, or what it gave is no plan.
    """
    with unnamed_file() as domain_file, unnamed_file() as problem_file:
        for file, text in zip((domain_file, problem_file), texts_for_planners(problem), strict=True):
            file.write(text.encode())
            file.flush()
        files = (domain_file.fileno(), problem_file.fileno())
        command = [
            *(program(), *(f"/dev/fd/{file}" for file in files), "--threads", "1", "-v"),  # one: the same plan again
            *("--timeout", f"{max(deadline.left(), 0.01):.3f}", "--anytime" if optimal else "--no-anytime"),
        ]
        with PlannerProcess(NAME, command, passed=files, keep_output=True) as process, Prover(problem) as prover:
            # it knows the limit itself, and has a plan by then
            reason = prover.awaited(process, Deadline(deadline.left() + 1.0))
            if reason is not None:
                return Unreachable(reason)
            match process.poll():
                case 0:
                    last = _BETTER.split(process.output())[-1]
                    return checked(problem, last, process, _PROVEN in process.said())
                case None | 11:
                    return GaveUp(f"{deadline.seconds:g} s of {NAME}")
                case 10:
                    return Unreachable(prover.reason(deadline.at_most(EXPLAINING)) or f"{NAME} proved it")
                case 12:
                    return GaveUp(f"the memory of {NAME}")
                case 14:
                    return GaveUp(f"the end of what {NAME} can search")
                case 13:
                    raise process.failed("does not take this kind of problem")
                case code:
                    raise process.failed(died(code))


def program() -> str:
    """The path of kairos.

    Raises:
        MissingToolError: It is not installed.
    """
    beside = Path(sys.executable).parent / "kairos"
    found = str(beside) if os.access(beside, os.X_OK) else shutil.which("kairos")
    if found is None:
        raise MissingToolError("kairos is not installed", hint="pip install kairos-planner (Linux)")
    return found
