"""Proofs that a whole problem has no plan, in a separate process: ``python -m tmd.planning.prover``.

No search finds out that a mug cannot be in two places; it runs to its limit. The proofs that do
(:mod:`tmd.planning.unsolvable`) need the instantiated problem, which takes long where the problem is large. So they run
beside a search that has not ended soon, and end with it.
"""

from __future__ import annotations

import pickle
import sys
from typing import TYPE_CHECKING

from tmd.planning.processes import Deadline, PlannerProcess, python_environment, unnamed_file

if TYPE_CHECKING:
    from tmd.pddl.model import Problem

# Seconds of search after which proofs are looked for.
SOON = 1.0
# Seconds in which the reason is looked for when it is known that there is no plan.
EXPLAINING = 20.0


class Prover:
    """The process that looks for a proof, from when it is first needed; a ``with`` block ends it.

    Args:
        problem: The problem.
        deadline: The memory that the process may take.
    """

    def __init__(self, problem: Problem, deadline: Deadline) -> None:
        self._problem = problem
        self._deadline = deadline
        self._process: PlannerProcess | None = None

    def __enter__(self) -> Prover:
        return self

    def __exit__(self, *exception: object) -> None:
        if self._process is not None:
            self._process.kill()

    def reason(self, deadline: Deadline) -> str | None:
        """Return why the problem has no plan; ``None`` where that is not known by the deadline."""
        process = self._started()
        return (process.output().strip() or None) if process.wait(deadline) == 0 else None

    def watch(self, search: PlannerProcess, deadline: Deadline) -> str | None:
        """Wait until a search ends or there is a proof, and return the proof.

        ``None`` means that the search ended or that the deadline was reached.
        """
        if search.wait(deadline.at_most(SOON)) is None and search.wait(deadline, self._started()) is None:
            reason = self.reason(Deadline(0))
            if reason is not None:
                return reason
            search.wait(deadline)
        return None

    def _started(self) -> PlannerProcess:
        if self._process is None:
            with unnamed_file() as question:
                pickle.dump(self._problem, question)
                question.seek(0)
                command = [sys.executable, "-m", "tmd.planning.prover"]
                self._process = PlannerProcess(
                    "the search for a proof", command, self._deadline, stdin=question, environment=python_environment()
                )
        return self._process


def main() -> int:
    """Read a problem from standard input and print why it has no plan, if that can be proven.

    Raises:
        TmdError: It cannot be instantiated.
    """
    from tmd.pddl.grounding.ground_task import ground  # the process only: its parent needs none of these
    from tmd.planning.unsolvable import Impossible, relaxed_literals, unreachable_reason

    task = ground(pickle.load(sys.stdin.buffer))
    true, false = relaxed_literals(task, task.init)
    if any(not cube.positive & ~true and not cube.negative & ~false for cube in task.goal):
        reason = Impossible(task).reason(task.init, task.goal)
    else:
        reason = unreachable_reason(task, task.init, task.goal)
    print(reason or "", end="")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
