"""kairos, a planner of the package kairos-planner (Apache-2.0): its program on PDDL text, as a process."""

from __future__ import annotations

import os
import re
import shutil
import sys
from pathlib import Path

from tmd.diagnostics import MissingToolError
from tmd.pddl.model import Problem
from tmd.planning.fast_downward import checked, path_of, texts_for_planners
from tmd.planning.processes import Deadline, PlannerProcess, Prover, ending
from tmd.planning.result import GaveUp, Solution, Unreachable

NAME = "kairos"
_BETTER = re.compile(r"^; better plan.*$", re.MULTILINE)
_PROVEN = "solved (proven optimal)"


def kairos(problem: Problem, *, optimal: bool, deadline: Deadline) -> Solution:
    """Solve a whole problem with kairos; ``optimal`` asks for the best plan by the deadline and for its proof.

    Raises:
        MissingToolError: kairos is not installed.
        PlannerError: It died, or its plan is not valid.
    """
    domain, task = texts_for_planners(problem)
    with domain, task:
        command = [
            *(program(), path_of(domain), path_of(task), "--threads", "1", "-v"),  # with one thread its plans repeat
            *("--timeout", f"{max(deadline.left(), 0.01):.3f}", "--anytime" if optimal else "--no-anytime"),
        ]
        with (
            PlannerProcess(NAME, command, deadline, passed=(domain, task)) as process,
            Prover(problem, deadline) as prover,
        ):
            later = Deadline(deadline.left() + 1.0)  # it knows the limit itself, and prints a plan by then
            reason = prover.watch(process, later)
            if reason is not None:
                return Unreachable(reason)
            match process.wait(later):
                case 0:
                    last = _BETTER.split(process.output())[-1]
                    return checked(problem, last, process, _PROVEN in process.log(), deadline)
                case None | 11:
                    return GaveUp(f"{deadline.seconds:g} s of {NAME}")
                case 10:
                    return Unreachable(prover.explain() or f"{NAME} proved it")
                case 12:
                    return GaveUp(f"{deadline.memory_limit()} of {NAME}")
                case 14:
                    return GaveUp(f"the end of what {NAME} can search")
                case 13:
                    raise process.failed("does not take this kind of problem")
                case code:
                    raise process.failed(ending(code))


def program() -> str:
    """Return the path of kairos.

    Raises:
        MissingToolError: It is not installed.
    """
    beside = Path(sys.executable).parent / "kairos"
    found = str(beside) if os.access(beside, os.X_OK) else shutil.which("kairos")
    if found is None:
        raise MissingToolError("kairos is not installed", hint="pip install kairos-planner (Linux)")
    return found
