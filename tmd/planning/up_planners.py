"""Planners of unified-planning, each call in a process of its own.

It is separate for three reasons. Engines leave files in the working directory, and two that share one corrupt each
other's. Importing unified-planning takes more than a second. And engines under the GPL are never loaded into the
program itself.

The problem goes over as PDDL text (:func:`tmd.pddl.normalise.portable`, then our writer) and is read there by
unified-planning's reader. So the reference sees the lifted domain and instantiates it again; it does not share our
instantiation.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from importlib.util import find_spec
from typing import Any

from tmd.diagnostics import LimitError, MissingToolError, PlannerError, TmdError
from tmd.pddl.derived import without_derived
from tmd.pddl.model import Domain, Exists, Forall, Formula, Instruction, Problem, signed_subformulas
from tmd.pddl.normalise import portable
from tmd.pddl.validator import validate
from tmd.pddl.writer import format_domain, format_problem
from tmd.planning.fast_downward import OPTIMAL_WITH_AXIOMS, OPTIMAL_WITH_CONDITIONS
from tmd.planning.processes import Deadline, call_in_process, ending, memory_limit, temporary_directory
from tmd.planning.result import GaveUp, Solution, Solved, Unreachable

# Seconds that the process may take beyond the time limit of its engine: it imports and reads as well.
GRACE = 15.0
# Statuses with a plan.
_SOLVED = ("SOLVED_SATISFICING", "SOLVED_OPTIMALLY")


@dataclass(frozen=True)
class EngineSpec:
    """An engine of unified-planning and how it is called.

    Attributes:
        skip_checks: Whether to leave out the engine's own check of the problem kind, which costs 14 ms a call.
        memory: Bytes that it may take beyond those of unified-planning; ``None`` for most of the machine's memory.
    """

    name: str
    parameters: Mapping[str, str] = field(default_factory=dict)
    time_limit: float = 60.0
    skip_checks: bool = False
    memory: int | None = None


def solve_with_engine(source: Problem, engine: EngineSpec) -> Solution:
    """Solve a whole problem with an engine.

    Raises:
        MissingToolError: unified-planning or the engine is not installed.
        PlannerError: The engine died, or its plan is not valid.
        TmdError: The engine or unified-planning's reader refuses the problem.
    """
    require_unified_planning()
    problem = portable(without_derived(source))
    question = (format_domain(problem.domain), format_problem(problem), asdict(engine))
    reply = _asked(engine, question)
    if reply is None:
        return _judged("TIMEOUT", engine)
    if "fault" in reply:
        raise _refusal(reply["fault"], reply["message"], engine.name)
    if reply["status"] not in _SOLVED:
        return _judged(reply["status"], engine)
    plan = [Instruction(name, tuple(arguments)) for name, *arguments in reply["plan"]]
    verdict = validate(source, plan)
    if not verdict.valid:
        raise PlannerError(f"the plan of {engine.name} does not work: {verdict.reason}")
    return Solved(tuple(plan), verdict.cost, reply["status"] == "SOLVED_OPTIMALLY")


def require_unified_planning() -> None:
    """Raise MissingToolError where unified-planning is not installed."""
    if find_spec("unified_planning") is None:
        raise MissingToolError("the package unified-planning is not installed", hint="pip install unified-planning")


def _asked(engine: EngineSpec, question: tuple[object, ...]) -> dict[str, Any] | None:
    """Return the answer of :func:`answer`, from a process with a directory for it alone; ``None`` for none in time."""
    name, function = f"the planner {engine.name}", "tmd.planning.up_planners:answer"
    limits = Deadline(engine.time_limit)  # it limits its memory itself, beyond unified-planning's
    with (
        temporary_directory() as directory,
        call_in_process(name, function, question, limits, directory=directory) as process,
    ):
        code = process.wait(Deadline(engine.time_limit + GRACE))
        if code:
            raise process.failed(ending(code))
        try:
            reply: dict[str, Any] | None = None if code is None else json.loads(process.output())
        except ValueError as error:
            raise process.failed("answered what is no JSON") from error
        return reply


def _judged(status: str, engine: EngineSpec) -> Unreachable | GaveUp:
    """Interpret a status without a plan. ``UNSOLVABLE_INCOMPLETELY`` means "gave up", never "impossible"."""
    match status:
        case "UNSOLVABLE_PROVEN":
            return Unreachable(f"{engine.name} proved it")
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


def _refusal(kind: str, message: str, engine: str) -> TmdError:
    """Return the error that an exception in the engine's process means."""
    if kind in ("UPNoRequestedEngineAvailableException", "ModuleNotFoundError", "ImportError"):
        return MissingToolError(
            f"unified-planning has no engine '{engine}' here",
            hint="'tmd list' shows the planners that are here; packages of others are called up-NAME",
        )
    if kind == "MemoryError":
        return LimitError(f"the planner {engine} came to the end of its memory", hint="use a smaller problem")
    if kind == "UPUsageError":
        return TmdError(f"the planner {engine} does not take this kind of problem: {message}")
    return PlannerError(f"unified-planning failed with {kind}: {message}")


def fast_downward_engine(domain: Domain, time_limit: float = 60.0) -> EngineSpec:
    """Return how Fast Downward, as the optimal reference, is called for ``domain``."""
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


# ---------------------------------------------------------------------- in the process of the engine


def answer(domain: str, problem: str, engine: Mapping[str, Any]) -> dict[str, Any]:
    """Return unified-planning's name of the status, and the plan if there is one; or an exception and its message."""
    try:
        return _solved(domain, problem, engine)
    except Exception as error:
        return {"fault": type(error).__name__, "message": " ".join(str(error).split())}


def _solved(domain: str, problem: str, engine: Mapping[str, Any]) -> dict[str, Any]:
    from unified_planning.environment import get_environment
    from unified_planning.io import PDDLReader

    environment = get_environment()  # the reader mixes objects of other environments with those of this one
    environment.credits_stream = None
    environment.error_used_name = False  # PDDL lets an action and a predicate share a name
    planner: Any = environment.factory.OneshotPlanner(name=engine["name"], params=dict(engine["parameters"]))
    with memory_limit(engine["memory"]):
        read = PDDLReader().parse_problem_string(domain, problem)
        planner.skip_checks = engine["skip_checks"]
        planner.error_on_failed_checks = True
        result = planner.solve(read, timeout=engine["time_limit"])
    steps = None if result.plan is None else result.plan.actions
    plan = steps and [[step.action.name, *map(str, step.actual_parameters)] for step in steps]
    return {"status": result.status.name, "plan": plan}
