"""kairos, a planner of the package kairos-planner (Apache-2.0): its program on PDDL text, as a process."""

from __future__ import annotations

import os
import re
import shutil
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from tmd.diagnostics import MissingToolError, PlannerError, TmdError
from tmd.pddl.model import Problem
from tmd.planning.fast_downward import checked, path_of, texts_for_planners
from tmd.planning.processes import Deadline, PlannerProcess, Prover, ending
from tmd.planning.result import GaveUp, Solution, Unreachable

NAME = "kairos"
_BETTER = re.compile(r"^; better plan.*$", re.MULTILINE)
_PROVEN = "solved (proven optimal)"
# Seconds after its time limit in which kairos, which knows the limit, prints a plan.
_LATER = 1.0
# Seconds of the processor that kairos has to itself: most of what it solves, it solves sooner.
_ALONE = 0.15
# Seconds by the clock, and share of the time limit, after which the other planner begins in any case.
_ALONE_BY_CLOCK = 5.0
_SHARE = 0.25


def kairos(problem: Problem, *, optimal: bool, deadline: Deadline) -> Solution:
    """Solve a whole problem with kairos; ``optimal`` asks for the best plan by the deadline and for its proof.

    Raises:
        MissingToolError: kairos is not installed.
        PlannerError: It died, or its plan is not valid.
    """
    with _started(problem, optimal, deadline) as process, Prover(problem, deadline) as prover:
        later = Deadline(deadline.left() + _LATER)
        reason = prover.watch(process, later)
        if reason is not None:
            return Unreachable(reason)
        match process.wait(later):
            case 0:
                return _plan(problem, process, deadline)
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


def kairos_beside(problem: Problem, other: Callable[[Deadline], Solution], deadline: Deadline) -> Solution:
    """Solve a whole problem with kairos, and soon with another planner beside it; the first plan is taken.

    Only a plan of kairos counts: all else is for the other planner to find. It begins after some processor time, so
    that the load of the machine does not decide which of them solves a small problem, and goes first from then on.

    Raises:
        MissingToolError, PlannerError, TmdError: As the other planner, where kairos finds no plan.
    """
    with ExitStack() as stack:
        try:
            process = stack.enter_context(_started(problem, False, deadline))
        except (MissingToolError, PlannerError):
            return other(deadline)

        def found() -> bool:
            return process.code() == 0

        alone = deadline.at_most(min(_ALONE_BY_CLOCK, _SHARE * deadline.seconds))
        process.wait(alone.until(lambda: process.processor_time() > _ALONE))
        answer: Solution = GaveUp("")
        failure: TmdError | None = None
        if not found():
            process.give_way()  # what is not solved by now, the other one solves sooner more often
            try:
                answer = other(deadline.until(found))
            except TmdError as error:
                failure = error
            if not isinstance(answer, GaveUp):
                return answer
            process.wait(Deadline(deadline.left() + _LATER))
        if found():
            with suppress(PlannerError):
                return _plan(problem, process, deadline)
            return other(deadline)
        if failure:
            raise failure
        return answer


@contextmanager
def _started(problem: Problem, optimal: bool, deadline: Deadline) -> Iterator[PlannerProcess]:
    """Start kairos; the end of the ``with`` block ends it."""
    domain, task = texts_for_planners(problem)
    with domain, task:
        command = [
            *(program(), path_of(domain), path_of(task), "--threads", "1", "-v"),  # with one thread its plans repeat
            *("--timeout", f"{max(deadline.left(), 0.01):.3f}", "--anytime" if optimal else "--no-anytime"),
        ]
        with PlannerProcess(NAME, command, deadline, passed=(domain, task)) as process:
            yield process


def _plan(problem: Problem, process: PlannerProcess, deadline: Deadline) -> Solution:
    """Return the last plan that kairos printed, replayed."""
    last = _BETTER.split(process.output())[-1]
    return checked(problem, last, process, _PROVEN in process.log(), deadline)


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
