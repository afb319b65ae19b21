"""Plans: the answer of a planner as text, JSON and exit code; and the plan of a text, a goal or a file to carry out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tmd.diagnostics import ExitCode, TmdError
from tmd.pddl.model import Domain, Problem
from tmd.pddl.reading.reader import with_goal
from tmd.pddl.writer import format_plan
from tmd.planning.backends import AUTO, solve
from tmd.planning.result import GaveUp, Solution, Solved, Unreachable

if TYPE_CHECKING:  # whole problems are planned without requests and robots
    from tmd.cli.grounding import Answer
    from tmd.pddl.plan_file import Plan
    from tmd.robot.monitor.listeners import Order


def plan_text(answer: Solved, domain: Domain) -> str:
    """Return the plan as the planning competitions write it, and in a comment whether it is optimal."""
    unit = all(action.cost is None for action in domain.actions)
    known = "optimal: no plan is cheaper" if answer.optimal else "found: a cheaper plan may exist"
    return f"; {known}\n{format_plan(answer.plan, answer.cost, unit=unit)}"


def answer_json(answer: Solution, planner: str) -> dict[str, object]:
    """Return the answer; fields of the plan are null if there is none, and ``reason`` is null if there is one."""
    found = answer if isinstance(answer, Solved) else None
    status = {Solved: "solved", Unreachable: "unreachable", GaveUp: "gave_up"}[type(answer)]
    return {
        "status": status,
        "planner": planner,
        "plan": [instruction.pddl() for instruction in found.plan] if found else None,
        "cost": found.cost if found else None,
        "optimal": found.optimal if found else None,
        "reason": None if isinstance(answer, Solved) else why_none(answer),
    }


def why_none(answer: Unreachable | GaveUp) -> str:
    """Return why there is no plan, in one line."""
    if isinstance(answer, Unreachable):
        return f"{answer.reason}; this is proven"
    return f"the planner gave up at {answer.limit}; nothing is proven"


def exit_code(answer: Solution) -> ExitCode:
    """Return 0 for a plan, 10 for a proof that there is none, 20 where the planner gave up."""
    if isinstance(answer, Solved):
        return ExitCode.OK
    return ExitCode.UNREACHABLE if isinstance(answer, Unreachable) else ExitCode.GAVE_UP


@dataclass(frozen=True, slots=True)
class Orders:
    """A plan, or why there is none.

    Attributes:
        code: ``OK``, or what the program ends with because there is none.
        given: Fields of the run's record: what ``tmd ground --json`` prints of the text, or the goal.
    """

    orders: tuple[Order, ...]
    code: ExitCode = ExitCode.OK
    remarks: tuple[str, ...] = ()
    given: Mapping[str, Any] = field(default_factory=lambda: {"grounding": None})


def orders_of_text(answer: Answer) -> Orders:
    """Return the best plan of a text. Where two readings of the text differ there is none: the robot does not guess."""
    from tmd.domain_kit import orders_of
    from tmd.view.answer_text import remarks

    told = tuple(remarks(answer.grounded))
    given = {"grounding": answer.record}
    if answer.code:
        return Orders((), answer.code, told, given)
    return Orders(tuple(orders_of(answer.grounded)), remarks=told, given=given)


def orders_of_goal(goal: str, problem: Problem, planner: str | None) -> Orders:
    """Find a plan for a goal, as ``tmd export --goal`` does; an empty one where the goal holds already.

    Raises:
        TmdError: The goal is wrong, or the planner is unknown, not installed or refuses the problem.
    """
    from tmd.robot.monitor.listeners import Order

    given = {"grounding": None, "goal": goal}
    answer = solve(with_goal(problem, goal, "--goal"), planner or AUTO)
    if isinstance(answer, Solved):
        return Orders(tuple(map(Order, answer.plan)), given=given)
    return Orders((), exit_code(answer), (f"no plan: {why_none(answer)}\n",), given)


def orders_of_file(path: Path, problem: Problem) -> Orders:
    """Read a plan file; a plan that does not work is not begun.

    Raises:
        TmdError: The file cannot be read, or has no instructions.
    """
    from tmd.pddl.plan_file import read_plan
    from tmd.robot.monitor.listeners import Order

    plan = read_plan(path, problem)
    if not plan.instructions:
        raise TmdError(f"{path}: the plan has no instructions", hint="write one (name argument ...) a line")
    remarks = tuple(f"warning: {warning}\n" for warning in plan.warnings)
    fault = why_invalid(problem, plan)
    if fault:
        return Orders((), ExitCode.INVALID_PLAN, (*remarks, f"invalid: {fault}\n"))
    return Orders(tuple(map(Order, plan.instructions)), remarks=remarks)


def why_invalid(problem: Problem, plan: Plan) -> str:
    """Return why a plan does not work, with the place in its file; empty if it works."""
    from tmd.pddl.validator import validate

    verdict = validate(problem, plan.instructions)
    place = f"{plan.locations[verdict.step - 1]}: " if verdict.step and plan.locations else ""
    return "" if verdict.valid else f"{place}{verdict.reason}"
