"""Planners of unified-planning, each in a worker process.

The problem goes over as PDDL text (:func:`tmd.pddl.normalise.portable`, then our writer) and is read there by
unified-planning's reader. So the reference sees the lifted domain and instantiates it again; it does not share our
instantiation.
"""

from __future__ import annotations

import json
import socket
import sys
import weakref
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from tmd.diagnostics import LimitError, MissingToolError, PlannerError, TmdError
from tmd.pddl.derived import without_derived
from tmd.pddl.model import TRUE, Domain, Exists, Forall, Formula, Instruction, Problem, signed_subformulas
from tmd.pddl.normalise import portable
from tmd.pddl.task import Bits, Cube, Task
from tmd.pddl.validator import validate
from tmd.pddl.writer import format_domain, format_problem
from tmd.planning.fast_downward import OPTIMAL_WITH_AXIOMS, OPTIMAL_WITH_CONDITIONS, binaries
from tmd.planning.processes import PLANNER, Deadline, PlannerProcess, ending, kill_marked, python_environment
from tmd.planning.result import Answer, Filled, GaveUp, Solution, Solved, Unreachable, filled
from tmd.planning.unsolvable import unreachable_reason

SOLVED = ("SOLVED_SATISFICING", "SOLVED_OPTIMALLY")
"""Statuses with a plan."""

# Seconds that a worker may stay silent beyond the time limit of its engine: it imports and reads as well.
GRACE = 15.0


@dataclass(frozen=True)
class EngineSpec:
    """An engine of unified-planning and how it is called.

    Attributes:
        name: Its name there.
        parameters: Its parameters.
        time_limit: Seconds after which it is stopped.
        skip_checks: Whether to leave out the engine's own check of the problem kind, which costs 14 ms a call.
        memory: Bytes that it may take beyond those of unified-planning; ``None`` for most of the machine's memory.
    """

    name: str
    parameters: Mapping[str, str] = field(default_factory=dict)
    time_limit: float = 60.0
    skip_checks: bool = False
    memory: int | None = None


class UnifiedPlanner:
    """Fills gaps with an engine of unified-planning.

    A goal of several cubes is asked cube by cube, and the cheapest answer is taken. Each plan of an engine is executed
    before it is believed.

    Args:
        task: The instantiated problem.
        engine: The engine.

    Raises:
        MissingToolError: unified-planning or the engine is not installed.
        TmdError: The engine or unified-planning's reader refuses the problem.
    """

    def __init__(self, task: Task, engine: EngineSpec) -> None:
        self.task = task
        self.engine = engine
        self._open_ended = replace(task.problem, init=task.decode(task.init), goal=TRUE)
        self._worker = Worker(self._open_ended, engine)

    def close(self) -> None:
        """Stop the worker process. It also stops with the planner or the program."""
        self._worker.close()

    def fill(self, state: Bits, goal: Sequence[Cube]) -> Answer:
        """Return the instructions from ``state`` to any cube of ``goal`` that the engine finds.

        Raises:
            TmdError: The engine failed, refused the problem, or returned a plan that does not work.
        """
        if any(cube.holds(state) for cube in goal):
            return Filled((), state, 0)
        answers = [self._one(state, cube) for cube in goal if not cube.positive & cube.negative]
        plans = [answer for answer in answers if isinstance(answer, Filled)]
        if plans:
            return min(plans, key=lambda answer: answer.cost)
        gave_up = next((answer for answer in answers if isinstance(answer, GaveUp)), None)
        return gave_up or Unreachable(unreachable_reason(self.task, state, goal))

    def _one(self, state: Bits, cube: Cube) -> Answer:
        if self._worker.closed:
            self._worker = Worker(self._open_ended, self.engine)
        changed = Cube(state & ~self.task.init, self.task.init & ~state)
        status, plan = self._worker.solve(_literals(self.task, changed), _literals(self.task, cube))
        if plan is None:
            return judged(status, self.engine, unreachable_reason(self.task, state, (cube,)))
        operators = []
        after = state
        for step in plan:
            operator = self.task.by_instruction.get(step)
            if operator is None or not operator.applicable(after):
                raise PlannerError(f"the plan of {self.engine.name} does not work: {step} cannot be done there")
            after = operator.apply(after)
            operators.append(operator)
        if not cube.holds(after):
            raise PlannerError(f"the plan of {self.engine.name} does not reach its goal")
        return filled(state, operators)


def solved_by_engine(problem: Problem, name: str, deadline: Deadline) -> Solution:
    """Solve a whole problem with the engine ``name``.

    Raises:
        MissingToolError: unified-planning or the engine is not installed.
        PlannerError: The engine died, or its plan is not valid.
        TmdError: The engine or unified-planning's reader refuses the problem.
    """
    engine = EngineSpec(name, time_limit=deadline.seconds, memory=deadline.memory)
    worker = Worker(problem, engine)
    try:
        status, plan = worker.solve([], [], deadline.left())
    finally:
        worker.close()
    if plan is None:
        return judged(status, engine, f"{name} proved it")
    verdict = validate(problem, plan)
    if not verdict.valid:
        raise PlannerError(f"the plan of {name} does not work: {verdict.reason}")
    return Solved(plan, verdict.cost, status == "SOLVED_OPTIMALLY")


def judged(status: str, engine: EngineSpec, reason: str) -> Unreachable | GaveUp:
    """Interpret a status without a plan. ``UNSOLVABLE_INCOMPLETELY`` means "gave up", never "impossible".

    Raises:
        TmdError: The engine failed or refused the problem.
    """
    match status:
        case "UNSOLVABLE_PROVEN":
            return Unreachable(reason)
        case "UNSOLVABLE_INCOMPLETELY":
            return GaveUp(f"{engine.name} ended without a plan and without a proof")
        case "TIMEOUT":
            return GaveUp(f"{engine.time_limit:g} s of {engine.name}")
        case "MEMOUT":
            return GaveUp(f"the memory of {engine.name}")
        case "UNSUPPORTED_PROBLEM":
            raise TmdError(f"the planner {engine.name} does not take this kind of problem")
        case _:
            raise PlannerError(f"the planner {engine.name} failed with {status}")


_Literal = tuple[tuple[str, ...], bool]


def _literals(task: Task, cube: Cube) -> list[_Literal]:
    signed = ((cube.positive, True), (cube.negative, False))
    return [((atom.predicate, *atom.args), value) for bits, value in signed for atom in task.names(bits)]


class Worker:
    """The other end of :mod:`tmd.planning.up_worker`, in a temporary directory of the same lifetime.

    The worker and all processes that it started carry a mark in their environment, because engines run in process
    groups of their own.

    Args:
        source: The problem.
        engine: The engine.

    Raises:
        MissingToolError: unified-planning or the engine is not installed.
        TmdError: The engine or unified-planning's reader refuses the problem, or the process failed.
    """

    command = (sys.executable, "-m", "tmd.planning.up_worker")

    def __init__(self, source: Problem, engine: EngineSpec) -> None:
        if find_spec("unified_planning") is None:
            raise MissingToolError("the package unified-planning is not installed", hint="pip install unified-planning")
        problem = portable(without_derived(source))
        self._engine = engine
        self._name = f"the planner {engine.name}"
        directory = TemporaryDirectory(prefix="tmd-planner-")
        mark = Path(directory.name).name
        self._socket, other = socket.socketpair()
        with other:
            self._process = PlannerProcess(
                self._name,
                self.command,
                Deadline(engine.time_limit),  # the worker limits its memory itself, beyond unified-planning's
                channel=other,
                directory=directory.name,
                environment={**python_environment(), PLANNER: mark, "TMPDIR": directory.name},
            )
        self.close = weakref.finalize(self, _stop, self._process, self._socket, directory, mark)
        opening = {
            "domain": format_domain(problem.domain),
            "problem": format_problem(problem),
            "engine": engine.name,
            "parameters": dict(engine.parameters),
            "skip_checks": engine.skip_checks,
            "memory": engine.memory,
        }
        if self._exchange(opening) is None:
            raise PlannerError(f"{self._name} did not start within {engine.time_limit + GRACE:g} s")

    @property
    def closed(self) -> bool:
        """Return whether the process was stopped."""
        return not self.close.alive

    def solve(
        self, state: Sequence[_Literal], goal: Sequence[_Literal], seconds: float | None = None
    ) -> tuple[str, tuple[Instruction, ...] | None]:
        """Return unified-planning's status for a question, and the plan if there is one.

        Args:
            state: The literals of the initial state that differ from those of the problem.
            goal: The literals that must hold in addition to the goal of the problem.
            seconds: The time limit, by default that of the engine.

        Raises:
            TmdError: The engine refused the problem, failed, or printed no answer.
        """
        timeout = self._engine.time_limit if seconds is None else seconds
        reply = self._exchange({"state": state, "goal": goal, "timeout": timeout})
        if reply is None:
            return "TIMEOUT", None
        if reply["status"] not in SOLVED:
            return reply["status"], None
        return reply["status"], tuple(Instruction(name, tuple(args)) for name, *args in reply["plan"])

    def _exchange(self, message: Mapping[str, Any]) -> dict[str, Any] | None:
        """Send a line and return the line that answers it; ``None``, and a stopped process, where there is none."""
        answered = False
        try:
            line = self._ask(json.dumps(message))
            reply: dict[str, Any] | None = None if line is None else json.loads(line)
            if reply is not None and "fault" in reply:
                raise _refusal(reply["fault"], reply["message"], self._engine.name)
            answered = reply is not None
        except ValueError as error:
            raise self._process.failed("answered what is no JSON") from error
        finally:
            if not answered:
                self.close()
        return reply

    def _ask(self, line: str) -> str | None:
        deadline = Deadline(self._engine.time_limit + GRACE)
        answer = bytearray()
        try:
            self._socket.settimeout(deadline.left())
            self._socket.sendall(f"{line}\n".encode())
            while not answer.endswith(b"\n"):
                self._socket.settimeout(deadline.left() or 0.001)
                piece = self._socket.recv(1 << 16)
                if not piece:
                    raise ConnectionError
                answer += piece
        except TimeoutError:
            return None
        except ConnectionError as error:
            code = self._process.wait(Deadline(1.0))
            raise self._process.failed("closed its output" if code is None else ending(code)) from error
        return answer.decode(errors="replace")


def _stop(process: PlannerProcess, channel: socket.socket, directory: TemporaryDirectory[str], mark: str) -> None:
    """Kill a worker and all processes that it started, and remove its directory."""
    kill_marked(PLANNER, mark)
    process.kill()
    kill_marked(PLANNER, mark)  # those that were being started
    channel.close()
    directory.cleanup()


def _refusal(kind: str, message: str, engine: str) -> TmdError:
    """Return the error that a worker's exception means."""
    if kind in ("UPNoRequestedEngineAvailableException", "ModuleNotFoundError", "ImportError"):
        return MissingToolError(f"unified-planning has no engine '{engine}' here", hint=f"pip install up-{engine}")
    if kind == "MemoryError":
        return LimitError(f"the planner {engine} came to the end of its memory", hint="use a smaller problem")
    if kind == "UPUsageError":
        return TmdError(f"the planner {engine} does not take this kind of problem: {message}")
    return PlannerError(f"unified-planning failed with {kind}: {message}")


def fast_downward_for_gaps(task: Task, *, time_limit: float = 60.0) -> UnifiedPlanner:
    """Return Fast Downward as the reference planner for the gaps of ``task``, with a time limit for one call.

    Raises:
        MissingToolError: It is not installed.
    """
    binaries()
    return UnifiedPlanner(task, spec(task.problem.domain, time_limit))


def spec(domain: Domain, time_limit: float = 60.0) -> EngineSpec:
    """Return how Fast Downward is called for ``domain``."""
    universal = any(
        has_universal(condition)
        for action in domain.actions
        for condition in (action.precondition, *(effect.condition for effect in action.effects))
    )
    search = OPTIMAL_WITH_AXIOMS if universal else OPTIMAL_WITH_CONDITIONS
    return EngineSpec("fast-downward", {"fast_downward_search_config": search}, time_limit, skip_checks=True)


def has_universal(formula: Formula) -> bool:
    """Return whether a universal quantifier remains once negations are pushed inwards."""
    return any(isinstance(p, Forall if positive else Exists) for p, positive in signed_subformulas(formula))
