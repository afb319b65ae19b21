"""The answer of a planner as a plan file, as JSON and as an exit code."""

from __future__ import annotations

from tmd.diagnostics import ExitCode
from tmd.pddl.model import Domain
from tmd.pddl.plan_file import format_plan
from tmd.planning.result import GaveUp, Solution, Solved, Unreachable


def plan_text(answer: Solved, domain: Domain) -> str:
    """Return the plan as the planning competitions write it, and in a comment whether it is optimal."""
    unit = all(action.cost is None for action in domain.actions)
    known = "optimal: no plan is cheaper" if answer.optimal else "found: a cheaper plan may exist"
    return f"; {known}\n{format_plan(answer.plan, answer.cost, unit=unit)}"


def answer_json(answer: Solution, planner: str) -> dict[str, object]:
    """Return the answer; what says nothing of a plan is null where there is none, ``reason`` where there is one."""
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
    """0 for a plan, 10 for a proof that there is none, 20 where the planner gave up."""
    if isinstance(answer, Solved):
        return ExitCode.OK
    return ExitCode.UNREACHABLE if isinstance(answer, Unreachable) else ExitCode.GAVE_UP
