"""Fast Downward on PDDL text: our writer, its translator and its search as processes, its plan read back.

No objects of other packages are between, so names are used as PDDL has them: an action and a predicate, or a type and
an object, may share one. It is under the GPL, and never imported.
"""

from __future__ import annotations

import re
import signal
from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import replace
from typing import IO, TYPE_CHECKING

from tmd.diagnostics import TmdError
from tmd.pddl.model import And, Atom, Formula, Not, Or, Problem
from tmd.pddl.normalise import portable
from tmd.pddl.writer import format_domain, format_problem
from tmd.planning.downward_process import FIRST, NAME, OPTIMAL, DownwardProcess, search_command
from tmd.planning.processes import Deadline, PlannerProcess, died, unnamed_file
from tmd.planning.prover import EXPLAINING, SOON, Prover
from tmd.planning.result import Answer, Filled, GaveUp, Solution, Solved, Unreachable

if TYPE_CHECKING:
    from tmd.pddl.task import Bits, Cube, Task

OPTIMAL_WITH_CONDITIONS = "astar(hmax())"
"""Optimal with conditional effects; under axioms (from universal preconditions) hmax may overestimate."""
OPTIMAL_WITH_AXIOMS = "astar(blind())"

_OPTIMAL = (OPTIMAL, OPTIMAL_WITH_CONDITIONS, OPTIMAL_WITH_AXIOMS)

FIRST_OF_A_GAP = (
    "let(hff,ff(),let(hlm,landmark_sum(lm_reasonable_orders_hps(lm_rhw())),eager_greedy([hff,hlm],preferred=[hff])))"
)
"""Slower than :data:`~tmd.planning.downward_process.FIRST`, with shorter plans: nobody asked for what is left unsaid.

FF alone does not see that a full hand takes nothing more: of a goal that clears a table of four things it evaluates two
million states in vain, with landmarks beside it 1,700. On the bundled problems the plans are as long.
"""

_UNSOLVABLE = (10, 11)
_INCOMPLETE = 12
_NO_MEMORY = (20, 22, 24)
_NO_TIME = (21, 23, -signal.SIGXCPU)
_PYTHON_WITHOUT_MEMORY = ("MemoryError", "SystemError: error return without exception set")
"""How the translator may end where it should end with one of those codes."""
_UNSUPPORTED = 34
_AT_MOST = 6
"""A process that has had so many times its seconds of the processor by the clock is given up."""
_EXHAUSTED = "Completely explored state space"
_AXIOMS = re.compile(r"^Translator axioms: (\d+)$", re.MULTILINE)


class FastDownward:
    """Fast Downward for one whole problem.

    Args:
        problem: The problem.
        optimal: Whether the plan shall be optimal; otherwise it is the first that is found.
        deadline: Until when.
        prove: Whether to look for the reason where there seems to be no plan.
        search: The configuration that is asked first; by default the usual one for what is asked.
    """

    def __init__(
        self, problem: Problem, *, optimal: bool, deadline: Deadline, prove: bool = True, search: str | None = None
    ) -> None:
        self.problem = problem
        self.deadline = deadline
        self.search = search or (OPTIMAL if optimal else FIRST)
        self._prover = Prover(problem, deadline.memory) if prove else None

    def solve(self, started: DownwardProcess | None = None) -> Solution:
        """A plan, or why there is none.

        Args:
            started: One that was started earlier.

        Raises:
            MissingToolError: Fast Downward is not installed.
            PlannerError: It died, or what it gave is no plan.
            TmdError: It does not take the problem.
        """
        memory, processor = self.deadline.memory, self.deadline.processor
        with self._prover or nullcontext(), started or DownwardProcess(self.search, memory, processor) as running:
            running.give(texts_for_planners(self.problem), self.deadline)
            from tmd.pddl import plan_file, validator  # noqa: F401 - while it works

            while running.process.wait(self.deadline.at_most(SOON)) is None and not running.translated():
                if not self.deadline.left():
                    break
            answer = self._answer(running.process, self.search, running.plan)
            if answer is not None:
                return answer
            axioms = _AXIOMS.search(running.process.said())
            exhaustive = OPTIMAL_WITH_CONDITIONS if axioms and axioms[1] == "0" else OPTIMAL_WITH_AXIOMS
            return self._again(running.sas, exhaustive)

    def _again(self, sas: IO[bytes], search: str) -> Solution:
        """Another search on what is translated already."""
        sas.seek(0)
        with unnamed_file() as plan:
            command = search_command(search, plan)
            memory, processor = self.deadline.memory, self.deadline.processor
            with PlannerProcess(
                NAME, command, stdin=sas, passed=(plan.fileno(),), memory=memory, processor=processor
            ) as process:
                answer = self._answer(process, search, plan)
                if answer is None:
                    raise process.failed("ended without a plan and without a proof")
                return answer

    def _answer(self, process: PlannerProcess, search: str, plan: IO[bytes]) -> Solution | None:
        """What one search answers; ``None`` where an exhaustive one has to be asked."""
        reason = self._awaited(process)
        code = process.poll()
        if reason is not None:
            return Unreachable(reason)
        if code is None:
            return GaveUp(f"{self.deadline.seconds:g} s of {NAME}")
        if code in _NO_TIME and self.deadline.processor is not None:
            return GaveUp(f"{self.deadline.processor} s of {NAME}")
        if code == 0:
            plan.seek(0)
            return checked(self.problem, plan.read().decode(errors="replace"), process, search in _OPTIMAL)
        if code in _NO_MEMORY or (code == 1 and any(word in process.said() for word in _PYTHON_WITHOUT_MEMORY)):
            return GaveUp(self.deadline.memory_of(NAME))
        exhausted = code == _INCOMPLETE and search in _OPTIMAL and _EXHAUSTED in process.said()
        if code in _UNSOLVABLE or exhausted:  # the dead ends of other searches are no proof
            return Unreachable(self._reason())
        if (code == _UNSUPPORTED and search == OPTIMAL) or (code == _INCOMPLETE and search not in _OPTIMAL):
            return None
        raise process.failed(died(code))

    def _awaited(self, search: PlannerProcess) -> str | None:
        """Wait for a search; a reason that there is no plan, where that is found first."""
        if self._prover is not None:
            return self._prover.awaited(search, self.deadline)
        search.wait(self.deadline)
        return None

    def _reason(self) -> str:
        """Why there is no plan, which is certain."""
        found = self._prover.reason(self.deadline.at_most(EXPLAINING)) if self._prover else None
        return found or f"{NAME} looked at every state that can be reached, and the goal holds in none"


def texts_for_planners(problem: Problem) -> tuple[str, str]:
    """Domain and problem as text for planners that read PDDL themselves.

    Where there is no way to do without ``either`` it stays: they take it in the declaration of a predicate.
    """
    try:
        plain = portable(problem)
    except TmdError:
        plain = problem
    return format_domain(plain.domain), format_problem(plain)


def checked(problem: Problem, text: str, process: PlannerProcess, optimal: bool) -> Solved:
    """The plan that a planner wrote, executed.

    Raises:
        PlannerError: It is no plan, or does not work.
    """
    from tmd.pddl.plan_file import parse_plan
    from tmd.pddl.validator import validate

    try:
        plan = parse_plan(text).instructions
    except TmdError as error:
        raise process.failed(f"wrote what is no plan ({error.message})") from error
    verdict = validate(problem, plan)
    if not verdict.valid:
        raise process.failed(f"gave a plan that does not work ({verdict.reason})")
    return Solved(plan, verdict.cost, optimal)


class FirstPlan:
    """The first plan of Fast Downward for the gaps of a task that nothing else fills.

    Args:
        task: The ground problem.
        seconds: The limit for one question, in seconds of the processor: what else the machine does, or that it
            slept, shall not decide what the answer is. A clock's limit is a multiple of it, in case it hangs.
    """

    def __init__(self, task: Task, seconds: int = 20) -> None:
        self.task = task
        self.seconds = seconds

    def fill(self, state: Bits, goal: Sequence[Cube]) -> Answer:
        """Instructions from ``state`` to any cube of ``goal``.

        Raises:
            MissingToolError, PlannerError, TmdError: As :meth:`FastDownward.solve`.
        """
        if any(cube.holds(state) for cube in goal):
            return Filled((), state, 0)
        cubes = [_formula(self.task, cube) for cube in goal if not cube.positive & cube.negative]
        wanted = cubes[0] if len(cubes) == 1 else Or(tuple(cubes))  # a disjunction becomes an axiom
        problem = replace(self.task.problem, init=self.task.decode(state), goal=wanted)
        deadline = Deadline(_AT_MOST * self.seconds, processor=self.seconds)
        asked = FastDownward(problem, optimal=False, deadline=deadline, prove=False, search=FIRST_OF_A_GAP)
        answer = asked.solve()
        if isinstance(answer, Solved):
            for operator in map(self.task.by_instruction.__getitem__, answer.plan):
                state = operator.apply(state)
            return Filled(answer.plan, state, answer.cost)
        if isinstance(answer, Unreachable):
            from tmd.planning.unsolvable import unreachable_reason  # imports numpy, which whole problems do not need

            return Unreachable(unreachable_reason(self.task, state, goal))
        return answer


def _formula(task: Task, cube: Cube) -> Formula:
    atoms = [Atom(atom.predicate, atom.args) for atom in task.names(cube.positive)]
    return And((*atoms, *(Not(Atom(atom.predicate, atom.args)) for atom in task.names(cube.negative))))
