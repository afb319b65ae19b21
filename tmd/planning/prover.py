"""Why a whole problem has no plan, looked for in a process of its own: ``python -m tmd.planning.prover``.

No search finds out that a mug cannot be in two places; it runs to its limit. The proofs that do
(:mod:`tmd.planning.unsolvable`) need the grounding of the problem, which takes long where the problem is large. So they
run beside a search that has not ended soon, and end with it.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from tmd.planning.processes import Deadline, PlannerProcess, unnamed_file

if TYPE_CHECKING:
    from types import TracebackType

    from tmd.pddl.model import Problem

SOON = 1.0
"""Seconds of search after which proofs are looked for beside it."""
EXPLAINING = 20.0
"""Seconds in which the reason is looked for when it is known that there is no plan."""


def reason_of(problem: Problem) -> str | None:
    """Why ``problem`` has no plan; ``None`` where that is not known.

    Raises:
        TmdError: It cannot be ground.
    """
    from tmd.pddl.grounding.ground_task import ground  # the process only: who starts it needs nothing of these
    from tmd.planning.unsolvable import Impossible, relaxed_literals, unreachable_reason

    task = ground(problem)
    true, false = relaxed_literals(task, task.init)
    if not any(not positive & ~true and not negative & ~false for positive, negative in task.goal):
        return unreachable_reason(task, task.init, task.goal)
    return Impossible(task).reason(task.init, task.goal)


class Prover:
    """The process that looks for the reason, from when it is first needed; a ``with`` block ends it.

    Args:
        problem: The problem.
    """

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        self._process: PlannerProcess | None = None

    def __enter__(self) -> Prover:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._process is not None:
            self._process.__exit__(kind, error, trace)

    def reason(self, deadline: Deadline) -> str | None:
        """The reason; ``None`` where there is none by the deadline."""
        process = self._started()
        return (process.output().strip() or None) if process.wait(deadline) == 0 else None

    def awaited(self, search: PlannerProcess, deadline: Deadline) -> str | None:
        """Wait for a search, from :data:`SOON` on beside it; a reason that there is no plan, where that comes first."""
        if search.wait(deadline.at_most(SOON)) is None:
            search.wait_with(self._started(), deadline)
            if search.poll() is None:
                reason = self.reason(Deadline(0))
                if reason is not None:
                    return reason
                search.wait(deadline)
        return None

    def _started(self) -> PlannerProcess:
        if self._process is None:
            import pickle  # most searches have ended before this is needed

            with unnamed_file() as question:
                pickle.dump(self._problem, question)
                question.seek(0)
                self._process = PlannerProcess(
                    "the search for a proof",
                    [sys.executable, "-m", "tmd.planning.prover"],
                    stdin=question,
                    environment={"PYTHONPATH": ":".join(filter(None, sys.path))},
                    keep_output=True,
                )
        return self._process


def main() -> int:
    """Read a problem from standard input and print the reason, if there is one."""
    import pickle

    reason = reason_of(pickle.load(sys.stdin.buffer))
    print(reason or "", end="")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
