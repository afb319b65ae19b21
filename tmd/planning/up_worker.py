"""A process in which unified-planning and its engines run: ``python -m tmd.planning.up_worker``.

It is separate for three reasons. Engines leave files in the working directory, and two that share one corrupt each
other's. Importing unified-planning takes more than a second. And engines under the GPL are never loaded into the
program itself.

It speaks JSON Lines. The first line gives the domain, the problem and the engine; each following line asks for
a plan. Every line is answered by one line.
"""

from __future__ import annotations

import json
import os
import sys
import threading
import time
from pathlib import Path
from shutil import rmtree
from typing import IO, Any, TypeAlias

from tmd.planning.processes import PLANNER, kill_marked, memory_limit

Message: TypeAlias = dict[str, Any]
"""One line, decoded."""


class PlannerEngine:
    """The problem and the engine of this process; the problem is built once and cloned for each question."""

    def __init__(self, opening: Message) -> None:
        from unified_planning.environment import get_environment
        from unified_planning.io import PDDLReader

        environment = get_environment()  # the reader mixes objects of other environments with those of this one
        environment.credits_stream = None
        environment.error_used_name = False  # PDDL lets an action and a predicate share a name
        self.planner: Any = environment.factory.OneshotPlanner(name=opening["engine"], params=opening["parameters"])
        self._limit = memory_limit(opening["memory"])
        self._limit.__enter__()  # until the process ends
        self.base: Any = PDDLReader().parse_problem_string(opening["domain"], opening["problem"])
        self.planner.skip_checks = opening["skip_checks"]
        self.planner.error_on_failed_checks = True

    def solve(self, question: Message) -> Message:
        """Answer a question with unified-planning's name of the status, and the plan if there is one."""
        problem = self.base.clone()
        for atom, value in question["state"]:
            problem.set_initial_value(self._atom(atom), value)
        for atom, value in question["goal"]:
            expression = self._atom(atom)
            problem.add_goal(expression if value else problem.environment.expression_manager.Not(expression))
        result = self.planner.solve(problem, timeout=question["timeout"])
        steps = None if result.plan is None else result.plan.actions
        plan = steps and [[step.action.name, *map(str, step.actual_parameters)] for step in steps]
        return {"status": result.status.name, "plan": plan}

    def _atom(self, atom: list[str]) -> object:
        return self.base.fluent(atom[0])(*(self.base.object(name) for name in atom[1:]))


def serve(questions: IO[str], answers: IO[str]) -> None:
    """Answer lines until there are no more; an exception is answered by its name and message."""
    engine: PlannerEngine | None = None
    reply: Message
    for line in questions:
        try:
            if engine is None:
                engine, reply = PlannerEngine(json.loads(line)), {"ready": True}
            else:
                reply = engine.solve(json.loads(line))
        except Exception as error:
            reply = {"fault": type(error).__name__, "message": " ".join(str(error).split())}
        answers.write(json.dumps(reply) + "\n")
        answers.flush()


def end_with_parent(parent: int) -> None:
    """End this process, the processes that it started, and its directory, when its parent is gone."""
    while os.getppid() == parent:
        time.sleep(1.0)
    mark = os.environ.get(PLANNER)
    if mark and Path.cwd().name == mark:  # the directory was made for this process
        kill_marked(PLANNER, mark)
        rmtree(Path.cwd(), ignore_errors=True)
    os._exit(1)


def main() -> None:
    """Serve on the standard streams; the output of engines goes to the error stream instead."""
    threading.Thread(target=end_with_parent, args=(os.getppid(),), daemon=True).start()
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    serve(sys.stdin, answers)


if __name__ == "__main__":
    main()
