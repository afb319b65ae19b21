"""Why a whole problem has no plan, looked for in a process of its own: ``python -m tmd.planning.prover``.

No search finds out that a mug cannot be in two places; it runs to its limit. The proofs that do
(:mod:`tmd.planning.unsolvable`) need the grounding of the problem, which takes long where the problem is large. So they
run beside a search that has not ended soon, and end with it.
"""

from __future__ import annotations

import pickle
import sys

from tmd.pddl.model import Problem
from tmd.planning.processes import Deadline, PlannerProcess, unnamed_file


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
    """The process that looks for the reason; a ``with`` block ends it.

    Args:
        problem: The problem.
        memory: Bytes that it may take.
    """

    def __init__(self, problem: Problem, memory: int | None = None) -> None:
        with unnamed_file() as question:
            pickle.dump(problem, question)
            question.seek(0)
            self.process = PlannerProcess(
                "the search for a proof",
                [sys.executable, "-m", "tmd.planning.prover"],
                stdin=question,
                environment={"PYTHONPATH": ":".join(filter(None, sys.path))},
                keep_output=True,
                memory=memory,
            )

    def reason(self, deadline: Deadline) -> str | None:
        """The reason; ``None`` where there is none by the deadline."""
        return (self.process.output().strip() or None) if self.process.wait(deadline) == 0 else None


def main() -> int:
    """Read a problem from standard input and print the reason, if there is one."""
    reason = reason_of(pickle.load(sys.stdin.buffer))
    print(reason or "", end="")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
