"""Planners of unified-planning, each in a worker process of its own.

The problem goes over as PDDL text (:func:`tmd.pddl.normalise.portable`, then our writer) and is read there by
unified-planning's reader. So the reference sees the lifted domain and grounds it again; it does not share our
grounding.
"""

from __future__ import annotations

import json
import os
import sys
import weakref
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from tmd.diagnostics import LimitError, MissingToolError, PlannerError, TmdError
from tmd.pddl.derived import without_derived
from tmd.pddl.model import TRUE, And, Domain, Exists, Forall, Formula, Imply, Instruction, Not, Or, Problem
from tmd.pddl.normalise import portable
from tmd.pddl.task import Bits, Cube, Task
from tmd.pddl.validator import validate
from tmd.pddl.writer import format_domain, format_problem
from tmd.planning.downward_process import binaries
from tmd.planning.fast_downward import OPTIMAL_WITH_AXIOMS, OPTIMAL_WITH_CONDITIONS
from tmd.planning.processes import Conversation, Deadline
from tmd.planning.result import Answer, Filled, GaveUp, Solution, Solved, Unreachable
from tmd.planning.unsolvable import unreachable_reason

SOLVED = ("SOLVED_SATISFICING", "SOLVED_OPTIMALLY")
"""Statuses with a plan."""

GRACE = 15.0
"""Seconds a worker may stay silent beyond the time limit of its engine: it imports and reads as well."""


@dataclass(frozen=True)
class EngineSpec:
    """An engine of unified-planning and how it is called.

    Attributes:
        name: Its name there.
        parameters: Its parameters.
        time_limit: Seconds after which it is stopped.
        skip_checks: Whether to leave out the engine's own check of the problem kind, which costs 14 ms a call.
        takes_timeout: Whether the engine can be told the limit.
        memory: Bytes that it may take, beside what unified-planning takes; ``None`` for most of what the machine has.
    """

    name: str
    parameters: Mapping[str, str] = field(default_factory=dict)
    time_limit: float = 60.0
    skip_checks: bool = False
    takes_timeout: bool = True
    memory: int | None = None


class UnifiedPlanner:
    """Fills gaps with an engine of unified-planning.

    A goal of several cubes is asked cube by cube, and the cheapest answer is taken. What an engine claims is
    replayed before it is believed.

    Args:
        task: The ground problem.
        engine: The engine.

    Raises:
        MissingToolError: unified-planning or the engine is not installed.
        TmdError: The engine or unified-planning's reader refuses the problem.
    """

    def __init__(self, task: Task, engine: EngineSpec) -> None:
        _needed()
        self.task = task
        self.engine = engine
        open_ended = replace(task.problem, init=task.decode(task.init), goal=TRUE)
        self._worker = _Worker(_opening(open_ended, engine), engine)

    def close(self) -> None:
        """Stop the worker process. It also stops with the planner or the program."""
        self._worker.close()

    def fill(self, state: Bits, goal: Sequence[Cube]) -> Answer:
        """The missing instructions from ``state`` to any cube of ``goal``, as the engine finds them.

        Raises:
            TmdError: The engine failed, refused the problem, or returned a plan that does not work.
        """
        if any(cube.holds(state) for cube in goal):
            return Filled((), state, 0)
        answers: list[Answer] = []
        for cube in goal:
            if not cube.positive & cube.negative:
                answers.append(self._one(state, cube))
        filled = [answer for answer in answers if isinstance(answer, Filled)]
        if filled:
            return min(filled, key=lambda answer: answer.cost)
        for answer in answers:
            if isinstance(answer, GaveUp):
                return answer
        return Unreachable(unreachable_reason(self.task, state, goal))

    def _one(self, state: Bits, cube: Cube) -> Answer:
        reply = self._worker.ask(
            {
                "state": _literals(self.task, Cube(state & ~self.task.init, self.task.init & ~state)),
                "goal": _literals(self.task, cube),
                "timeout": self.engine.time_limit if self.engine.takes_timeout else None,
            }
        )
        if reply is None:
            return GaveUp(f"{self.engine.time_limit:g} s of {self.engine.name}")
        status = reply["status"]
        if status in SOLVED:
            steps = tuple(Instruction(name, tuple(args)) for name, *args in reply["plan"])
            return self._replayed(state, cube, steps)
        return judged(status, self.engine, unreachable_reason(self.task, state, (cube,)))

    def _replayed(self, state: Bits, cube: Cube, steps: tuple[Instruction, ...]) -> Filled:
        cost = 0
        for step in steps:
            operator = self.task.by_instruction.get(step)
            if operator is None or not operator.applicable(state):
                raise PlannerError(f"the plan of {self.engine.name} does not work: {step} cannot be done there")
            state = operator.apply(state)
            cost += operator.cost
        if not cube.holds(state):
            raise PlannerError(f"the plan of {self.engine.name} does not reach its goal")
        return Filled(steps, state, cost)


def solved_by_engine(problem: Problem, name: str, deadline: Deadline) -> Solution:
    """A plan for a whole problem by the engine ``name``.

    Raises:
        MissingToolError: unified-planning or the engine is not installed.
        PlannerError: The engine died, or what it gave is no plan.
        TmdError: The engine or unified-planning's reader refuses the problem.
    """
    _needed()
    engine = EngineSpec(name, time_limit=deadline.seconds, memory=deadline.memory)
    worker = _Worker(_opening(problem, engine), engine)
    try:
        reply = worker.ask({"state": [], "goal": [], "timeout": deadline.left() if engine.takes_timeout else None})
    finally:
        worker.close()
    if reply is None:
        return GaveUp(f"{deadline.seconds:g} s of {name}")
    if reply["status"] not in SOLVED:
        return judged(reply["status"], engine, f"{name} proved it")
    plan = tuple(Instruction(action, tuple(args)) for action, *args in reply["plan"])
    verdict = validate(problem, plan)
    if not verdict.valid:
        raise PlannerError(f"the plan of {name} does not work: {verdict.reason}")
    return Solved(plan, verdict.cost, reply["status"] == "SOLVED_OPTIMALLY")


def _needed() -> None:
    if find_spec("unified_planning") is None:
        raise MissingToolError("the package unified-planning is not installed", hint="pip install unified-planning")


def judged(status: str, engine: EngineSpec, reason: str) -> Unreachable | GaveUp:
    """What a status without a plan means. ``UNSOLVABLE_INCOMPLETELY`` means "gave up", never "impossible".

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


def _literals(task: Task, cube: Cube) -> list[tuple[tuple[str, ...], bool]]:
    true = [((atom.predicate, *atom.args), True) for atom in task.names(cube.positive)]
    return true + [((atom.predicate, *atom.args), False) for atom in task.names(cube.negative)]


def _opening(source: Problem, engine: EngineSpec) -> dict[str, Any]:
    problem = portable(without_derived(source))
    return {
        "domain": format_domain(problem.domain),
        "problem": format_problem(problem),
        "engine": engine.name,
        "parameters": dict(engine.parameters),
        "skip_checks": engine.skip_checks,
        "takes_timeout": engine.takes_timeout,
        "memory": engine.memory,
    }


class _Worker:
    """The other end of :mod:`tmd.planning.up_worker`, in a fresh working directory."""

    def __init__(self, opening: dict[str, Any], engine: EngineSpec) -> None:
        self.engine = engine
        self.opening = opening
        self._talk: Conversation | None = None
        self._stop: weakref.finalize[..., Any] | None = None
        self._start()

    def _start(self) -> None:
        root = str(Path(__file__).resolve().parents[2])
        path = os.pathsep.join(filter(None, (root, os.environ.get("PYTHONPATH", ""))))
        command = [sys.executable, "-m", "tmd.planning.up_worker"]
        self._talk = Conversation(f"the planner {self.engine.name}", command, {"PYTHONPATH": path})
        self._stop = weakref.finalize(self, self._talk.close)
        if self._exchange(self.opening) is None:
            raise PlannerError(f"the planner {self.engine.name} did not start within {self._patience():g} s")

    def ask(self, question: dict[str, Any]) -> dict[str, Any] | None:
        """The answer to a question; ``None`` where it took too long.

        Raises:
            TmdError: The engine refused the problem, failed, or printed no answer.
        """
        if self._talk is None:
            self._start()
        return self._exchange(question)

    def close(self) -> None:
        """Stop the process and remove its directory."""
        if self._stop is not None:
            self._stop()
        self._talk = None

    def _patience(self) -> float:
        return self.engine.time_limit + GRACE

    def _exchange(self, message: dict[str, Any]) -> dict[str, Any] | None:
        assert self._talk is not None
        process = self._talk.process
        try:
            line = self._talk.ask(json.dumps(message), Deadline(self._patience()))
            reply: dict[str, Any] | None = None if line is None else json.loads(line)
        except ValueError as error:
            failure = process.failed("answered what is no JSON")
            self.close()
            raise failure from error
        except BaseException:
            self.close()
            raise
        if reply is None:
            self.close()
            return None
        if "fault" in reply:
            self.close()
            raise _refusal(reply, self.engine)
        return reply


def _refusal(reply: dict[str, Any], engine: EngineSpec) -> TmdError:
    """The error that a worker's fault means."""
    kind, message = reply["fault"], reply["message"]
    if kind in ("UPNoRequestedEngineAvailableException", "ModuleNotFoundError", "ImportError"):
        return MissingToolError(
            f"unified-planning has no engine '{engine.name}' here", hint=f"pip install up-{engine.name}"
        )
    if kind == "MemoryError":
        return LimitError(f"the planner {engine.name} came to the end of its memory", hint="use a smaller problem")
    if kind == "UPUsageError":
        return TmdError(f"the planner {engine.name} does not take this kind of problem: {message}")
    return PlannerError(f"unified-planning failed with {kind}: {message}")


def fast_downward(task: Task, *, time_limit: float = 60.0) -> UnifiedPlanner:
    """Fast Downward for ``task``.

    Args:
        task: The ground problem.
        time_limit: Seconds for one call.

    Raises:
        MissingToolError: It is not installed.
    """
    binaries()
    return UnifiedPlanner(task, spec(task.problem.domain, time_limit))


def spec(domain: Domain, time_limit: float = 60.0) -> EngineSpec:
    """How Fast Downward is called for ``domain``."""
    universal = any(
        has_universal(action.precondition, True)
        or any(has_universal(effect.condition, True) for effect in action.effects)
        for action in domain.actions
    )
    search = OPTIMAL_WITH_AXIOMS if universal else OPTIMAL_WITH_CONDITIONS
    return EngineSpec("fast-downward", {"fast_downward_search_config": search}, time_limit, skip_checks=True)


def has_universal(formula: Formula, positive: bool) -> bool:
    """Whether a universal quantifier remains once negations are pushed inwards."""
    match formula:
        case Not(part):
            return has_universal(part, not positive)
        case And(parts) | Or(parts):
            return any(has_universal(part, positive) for part in parts)
        case Imply(left, right):
            return has_universal(left, not positive) or has_universal(right, positive)
        case Forall(_, part):
            return positive or has_universal(part, positive)
        case Exists(_, part):
            return not positive or has_universal(part, positive)
        case _:
            return False
