"""Planners of unified-planning, each in a worker process of its own.

The problem goes over as PDDL text (:func:`tmd.pddl.normalise.portable`, then our writer) and is read there by
unified-planning's reader. So the reference sees the lifted domain and grounds it again; it does not share our
grounding.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import weakref
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from tmd.diagnostics import MissingToolError, TmdError
from tmd.pddl.model import TRUE, And, Domain, Exists, Forall, Formula, Imply, Instruction, Not, Or
from tmd.pddl.normalise import portable
from tmd.pddl.task import Bits, Cube, Task
from tmd.pddl.writer import format_domain, format_problem
from tmd.planning.result import Answer, Filled, GaveUp, Unreachable
from tmd.planning.unsolvable import unreachable_reason

SOLVED = ("SOLVED_SATISFICING", "SOLVED_OPTIMALLY")
"""Statuses with a plan."""

GRACE = 30.0
"""Seconds a worker may stay silent beyond the time limit of its engine."""


@dataclass(frozen=True)
class EngineSpec:
    """An engine of unified-planning and how it is called.

    Attributes:
        name: Its name there.
        parameters: Its parameters.
        time_limit: Seconds after which it is stopped.
        skip_checks: Whether to leave out the engine's own check of the problem kind, which costs 14 ms a call.
        takes_timeout: Whether the engine can be told the limit.
        any_plan: Whether the first plan found is good enough, so that the other cubes of a goal need not be asked for.
    """

    name: str
    parameters: Mapping[str, str] = field(default_factory=dict)
    time_limit: float = 60.0
    skip_checks: bool = False
    takes_timeout: bool = True
    any_plan: bool = False


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
        if find_spec("unified_planning") is None:
            raise MissingToolError("the package unified-planning is not installed", hint="pip install unified-planning")
        self.task = task
        self.engine = engine
        self._worker = _Worker(_opening(task, engine), engine)

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
        for cube in sorted((c for c in goal if not c.positive & c.negative), key=lambda c: missing(c, state)):
            answers.append(self._one(state, cube))
            if self.engine.any_plan and isinstance(answers[-1], Filled):
                break
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
                raise TmdError(f"the plan of {self.engine.name} does not work: {step} cannot be done there")
            state = operator.apply(state)
            cost += operator.cost
        if not cube.holds(state):
            raise TmdError(f"the plan of {self.engine.name} does not reach its goal")
        return Filled(steps, state, cost)


def missing(cube: Cube, state: Bits) -> int:
    """How many literals of ``cube`` do not hold in ``state``: a first guess at how far off it is."""
    return (cube.positive & ~state).bit_count() + (cube.negative & state).bit_count()


def judged(status: str, engine: EngineSpec, reason: str) -> Answer:
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
            raise TmdError(f"the planner {engine.name} failed with {status}")


def _literals(task: Task, cube: Cube) -> list[tuple[tuple[str, ...], bool]]:
    true = [((atom.predicate, *atom.args), True) for atom in task.names(cube.positive)]
    return true + [((atom.predicate, *atom.args), False) for atom in task.names(cube.negative)]


def _opening(task: Task, engine: EngineSpec) -> dict[str, Any]:
    problem = replace(portable(task.problem), init=task.decode(task.init), goal=TRUE)
    return {
        "domain": format_domain(problem.domain),
        "problem": format_problem(problem),
        "engine": engine.name,
        "parameters": dict(engine.parameters),
        "skip_checks": engine.skip_checks,
        "takes_timeout": engine.takes_timeout,
    }


class _Worker:
    """The other end of :mod:`tmd.planning.up_worker`, in a fresh working directory."""

    def __init__(self, opening: dict[str, Any], engine: EngineSpec) -> None:
        self.engine = engine
        self.opening = opening
        self._directory: tempfile.TemporaryDirectory[str] | None = None
        self._process: subprocess.Popen[str] | None = None
        self._stop: weakref.finalize[..., Any] | None = None
        self._start()

    def _start(self) -> None:
        self._directory = tempfile.TemporaryDirectory(prefix="tmd-planner-")
        root = str(Path(__file__).resolve().parents[2])
        path = os.pathsep.join(filter(None, (root, os.environ.get("PYTHONPATH", ""))))
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tmd.planning.up_worker"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            cwd=self._directory.name,
            env={**os.environ, "PYTHONPATH": path},
            text=True,
            encoding="utf-8",
        )
        self._stop = weakref.finalize(self, _stopped, self._process, self._directory)
        self._exchange(self.opening, None)

    def ask(self, question: dict[str, Any]) -> dict[str, Any] | None:
        """The answer to a question; ``None`` where it took too long."""
        if self._process is None:
            self._start()
        return self._exchange(question, self.engine.time_limit + GRACE)

    def close(self) -> None:
        """Stop the process and remove its directory."""
        if self._stop is not None:
            self._stop()
        self._process = None

    def _exchange(self, message: dict[str, Any], patience: float | None) -> dict[str, Any] | None:
        process = self._process
        assert process is not None and process.stdin is not None and process.stdout is not None
        try:
            process.stdin.write(json.dumps(message) + "\n")
            process.stdin.flush()
        except BrokenPipeError:
            pass  # the end of the output tells the rest
        line = _read_line(process, patience)
        if line is None:
            self.close()
            return None
        if not line:
            self.close()
            raise TmdError(f"the process of the planner {self.engine.name} ended unexpectedly")
        reply: dict[str, Any] = json.loads(line)
        if "fault" in reply:
            raise _refusal(reply, self.engine)
        return reply


def _read_line(process: subprocess.Popen[str], patience: float | None) -> str | None:
    """The next line of a process, or ``None`` after ``patience`` seconds."""
    import selectors

    assert process.stdout is not None
    with selectors.DefaultSelector() as selector:
        selector.register(process.stdout, selectors.EVENT_READ)
        if not selector.select(patience):
            return None
    return process.stdout.readline()


def _refusal(reply: dict[str, Any], engine: EngineSpec) -> TmdError:
    """The error that a worker's fault means."""
    kind, message = reply["fault"], reply["message"]
    if kind in ("UPNoRequestedEngineAvailableException", "ModuleNotFoundError", "ImportError"):
        return MissingToolError(
            f"unified-planning has no engine '{engine.name}' here", hint=f"pip install up-{engine.name}"
        )
    if kind == "UPUsageError":
        return TmdError(f"the planner {engine.name} does not take this kind of problem: {message}")
    return TmdError(f"unified-planning failed with {kind}: {message}")


def _stopped(process: subprocess.Popen[str], directory: tempfile.TemporaryDirectory[str]) -> None:
    """End a worker."""
    process.kill()
    process.communicate()
    directory.cleanup()


OPTIMAL = "astar(hmax())"
"""Optimal for every domain that Fast Downward translates without axioms, and the fastest such configuration."""

FIRST = (
    "let(hff,ff(),let(hlm,landmark_sum(lm_reasonable_orders_hps(lm_rhw())),eager_greedy([hff,hlm],preferred=[hff])))"
)
"""Fast, and content with any plan.

FF alone does not see that a full hand takes nothing more: of a goal that clears a table of four things it evaluates two
million states in vain, with landmarks beside it 1,700. On the bundled problems the plans are as long.
"""

OPTIMAL_WITH_AXIOMS = "astar(blind())"
"""Universal preconditions become axioms, under which hmax may overestimate."""


def fast_downward(task: Task, *, time_limit: float = 60.0) -> UnifiedPlanner:
    """Fast Downward for ``task``.

    Args:
        task: The ground problem.
        time_limit: Seconds for one call.

    Raises:
        MissingToolError: It is not installed.
    """
    _installed()
    return UnifiedPlanner(task, spec(task.problem.domain, time_limit))


def first_plan(task: Task) -> UnifiedPlanner:
    """Fast Downward for ``task``, content with the first plan that it finds in ten seconds; errors as above."""
    _installed()
    search = {"fast_downward_search_config": FIRST}
    return UnifiedPlanner(task, EngineSpec("fast-downward", search, 10.0, skip_checks=True, any_plan=True))


def _installed() -> None:
    if find_spec("up_fast_downward") is None:
        raise MissingToolError("Fast Downward is not installed", hint="pip install up-fast-downward")


def spec(domain: Domain, time_limit: float = 60.0) -> EngineSpec:
    """How Fast Downward is called for ``domain``."""
    universal = any(
        has_universal(action.precondition, True)
        or any(has_universal(effect.condition, True) for effect in action.effects)
        for action in domain.actions
    )
    search = OPTIMAL_WITH_AXIOMS if universal else OPTIMAL
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
