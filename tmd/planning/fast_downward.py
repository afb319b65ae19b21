"""Fast Downward on PDDL text: our writer, its translator and its search as processes, its plan read back.

No objects of other packages are between, so names are used as PDDL has them: an action and a predicate, or a type and
an object, may share one. It is under the GPL, and never imported.
"""

from __future__ import annotations

import re
import sys
from contextlib import ExitStack
from importlib.util import find_spec
from pathlib import Path
from typing import IO

from tmd.diagnostics import LimitError, MissingToolError, TmdError
from tmd.pddl.model import Instruction, Problem
from tmd.pddl.narrowing import narrowed
from tmd.pddl.normalise import portable
from tmd.pddl.writer import format_domain, format_problem
from tmd.planning.processes import Deadline, PlannerProcess, Prover, ending, memory_limit, unnamed_file
from tmd.planning.result import GaveUp, Solution, Solved, Unreachable

NAME = "Fast Downward"

# The first iteration of LAMA, which Fast Downward calls lama-first.
FIRST = (
    "let(hlm,eval_modify_costs(landmark_sum(lm_factory=lm_reasonable_orders_hps(lm_rhw()),pref=false),cost_type=one),"
    "let(hff,eval_modify_costs(ff(),cost_type=one),"
    "lazy_greedy([hff,hlm],preferred=[hff,hlm],cost_type=one,reopen_closed=false)))"
)
# The best admissible heuristic that needs no preparation. It takes neither conditional effects nor axioms.
OPTIMAL = "astar(lmcut())"
# Under axioms (from universal preconditions) hmax may overestimate.
OPTIMAL_WITH_CONDITIONS = "astar(hmax())"
OPTIMAL_WITH_AXIOMS = "astar(blind())"
_OPTIMAL = (OPTIMAL, OPTIMAL_WITH_CONDITIONS, OPTIMAL_WITH_AXIOMS)

# The translator makes so many small objects, and hardly a cycle, that looking for cycles among them takes a quarter of
# the time of a large task and saves no memory. It becomes the search in its process, without Fast Downward's driver.
_TRANSLATE_AND_SEARCH = """
import gc, os, runpy, sys
gc.disable()
sas, *search = sys.argv[3:]
sys.argv[3:] = ["--sas-file", f"/dev/fd/{sas}"]
runpy.run_module("fast_downward.translate", run_name="__main__", alter_sys=True)
print(flush=True)
if search:
    os.lseek(int(sas), 0, os.SEEK_SET)
    os.dup2(int(sas), 0)
    os.execv(search[0], search)
"""

_UNSOLVABLE = (10, 11)
_INCOMPLETE = 12
_NO_MEMORY = (20, 22, 24)
# How the translator may end where it should end with a code for no memory.
_PYTHON_WITHOUT_MEMORY = ("MemoryError", "SystemError: error return without exception set")
_UNSUPPORTED = 34
_EXHAUSTED = "Completely explored state space"
_STEP = re.compile(r"\(([^()\s][^()]*)\)")
_AXIOMS = re.compile(r"^Translator axioms: (\d+)$", re.MULTILINE)
# Seconds after which the translator alone is stopped: a guard, not part of the result.
_TRANSLATION = 600.0


def binaries() -> Path:
    """Return the directory with Fast Downward's translator and search.

    Raises:
        MissingToolError: It is not installed.
    """
    spec = find_spec("up_fast_downward")
    if spec is None or spec.origin is None:
        raise MissingToolError("Fast Downward is not installed", hint="pip install up-fast-downward")
    return Path(spec.origin).parent / "downward" / "builds" / "release" / "bin"


class _Downward(ExitStack):
    """The files of one problem that Fast Downward works on; a ``with`` block closes them."""

    def __init__(self, problem: Problem, deadline: Deadline) -> None:
        super().__init__()
        self._binaries = binaries()
        self._problem = problem
        self._deadline = deadline
        files = (*texts_for_planners(problem), unnamed_file(), unnamed_file())
        self._files = tuple(self.enter_context(file) for file in files)
        *_, self.sas, self.plan = files
        self._prover = self.enter_context(Prover(problem, deadline))

    def translate(self, search: str | None) -> PlannerProcess:
        """Start the translator, which becomes the search with this configuration."""
        command = [sys.executable, "-S", "-c", _TRANSLATE_AND_SEARCH, *map(path_of, self._files[:2])]
        command += [str(self.sas.fileno()), *(self._command(search) if search else ())]
        paths = {"PYTHONPATH": str(self._binaries)}
        return PlannerProcess(NAME, command, self._deadline, passed=self._files, environment=paths)

    def search(self, configuration: str) -> PlannerProcess:
        """Start another search of what is translated already."""
        self.sas.seek(0)
        return PlannerProcess(NAME, self._command(configuration), self._deadline, stdin=self.sas, passed=(self.plan,))

    def _command(self, search: str) -> list[str]:
        return [str(self._binaries / "downward"), "--search", search, "--internal-plan-file", path_of(self.plan)]

    def answer(self, process: PlannerProcess, search: str) -> Solution | None:
        """Wait for one search and return its answer; ``None`` where an exhaustive one has to be asked."""
        reason = self._prover.watch(process, self._deadline)
        if reason is not None:
            return Unreachable(reason)
        code, optimal = process.wait(self._deadline), search in _OPTIMAL
        if code == 0:
            self.plan.seek(0)
            text = self.plan.read().decode(errors="replace")
            return checked(self._problem, text, process, optimal, self._deadline)
        limit = _limit(code, process, self._deadline)
        if limit is not None:
            return GaveUp(f"{limit} of {NAME}")
        # the dead ends of searches that are not optimal prove nothing
        if code in _UNSOLVABLE or (code == _INCOMPLETE and optimal and _EXHAUSTED in process.output()):
            reason = self._prover.explain()
            return Unreachable(
                reason or f"{NAME} looked at every state that can be reached, and the goal holds in none"
            )
        if (code == _UNSUPPORTED and search == OPTIMAL) or (code == _INCOMPLETE and not optimal):
            return None
        raise process.failed(ending(code or 0))


def fast_downward(problem: Problem, *, optimal: bool, deadline: Deadline) -> Solution:
    """Solve a whole problem with Fast Downward.

    The plan is optimal if that is asked for; otherwise it is the first that is found.

    Raises:
        MissingToolError: Fast Downward is not installed.
        PlannerError: It died, or its plan is not valid.
        TmdError: It does not take the problem.
    """
    first = OPTIMAL if optimal else FIRST
    with _Downward(problem, deadline) as files:
        with files.translate(first) as process:
            answer = files.answer(process, first)
            if answer is not None:
                return answer
            axioms = _AXIOMS.search(process.output())
        exhaustive = OPTIMAL_WITH_CONDITIONS if axioms and axioms[1] == "0" else OPTIMAL_WITH_AXIOMS
        with files.search(exhaustive) as process:
            answer = files.answer(process, exhaustive)
            if answer is None:
                raise process.failed("ended without a plan and without a proof")
            return answer


def _limit(code: int | None, process: PlannerProcess, deadline: Deadline) -> str | None:
    """Return the limit of time or memory at which a process ended; ``None`` where it ended otherwise."""
    if code is None:
        return f"{deadline.seconds:g} s"
    without_memory = code == 1 and any(text in process.log() for text in _PYTHON_WITHOUT_MEMORY)
    return deadline.memory_limit() if code in _NO_MEMORY or without_memory else None


def translated(problem: Problem) -> str:
    """Translate a problem to SAS+.

    Raises:
        MissingToolError: Fast Downward is not installed.
        PlannerError: The translator refuses the problem, or died.
        LimitError: It did not end.
    """
    deadline = Deadline(_TRANSLATION)
    with _Downward(problem, deadline) as files, files.translate(None) as process:
        code = process.wait(deadline)
        if code is None:
            hint = "use a smaller problem"
            raise LimitError(f"Fast Downward's translator did not end within {_TRANSLATION:g} s", hint=hint)
        if code:
            raise process.failed(f"did not translate the problem: it {ending(code)}")
        files.sas.seek(0)
        return files.sas.read().decode()


def path_of(file: IO[bytes]) -> str:
    """Return the path by which a process opens a file that it inherits."""
    return f"/dev/fd/{file.fileno()}"


def texts_for_planners(problem: Problem) -> tuple[IO[bytes], IO[bytes]]:
    """Return files of domain and problem for planners that read PDDL themselves.

    Where ``either`` cannot be rewritten it stays: they take it in the declaration of a predicate.
    """
    try:
        plain = portable(narrowed(problem))
    except TmdError:
        plain = problem
    return unnamed_file(format_domain(plain.domain).encode()), unnamed_file(format_problem(plain).encode())


def checked(problem: Problem, text: str, process: PlannerProcess, optimal: bool, deadline: Deadline) -> Solution:
    """Read and execute the plan that a planner wrote, within the memory of ``deadline``.

    Raises:
        PlannerError: It cannot be read, or does not work.
    """
    from tmd.pddl.validator import validate

    lines = [line for line in map(str.strip, text.lower().splitlines()) if line and line[0] != ";"]
    steps = [found[1].split() for line in lines if (found := _STEP.fullmatch(line))]
    if len(steps) < len(lines):
        raise process.failed("wrote what is no plan")
    plan = tuple(Instruction(name, tuple(arguments)) for name, *arguments in steps)
    try:
        with memory_limit(deadline.memory):
            verdict = validate(problem, plan)
    except MemoryError:
        return GaveUp(f"{deadline.memory_limit()} while the plan of {process.name} was checked")
    if not verdict.valid:
        raise process.failed(f"gave a plan that does not work ({verdict.reason})")
    return Solved(plan, verdict.cost, optimal)
