"""What a planner answered, as a plan file, as JSON and as an exit code."""

from __future__ import annotations

from tmd.diagnostics import ExitCode
from tmd.pddl.model import Domain
from tmd.pddl.plan_file import format_plan
from tmd.planning.result import Answer, Filled, GaveUp, Unreachable


def plan_text(answer: Filled, domain: Domain) -> str:
    """The plan as the planning competitions write it."""
    unit = all(action.cost is None for action in domain.actions)
    return format_plan(answer.plan, answer.cost, unit=unit)


def answer_json(answer: Answer, planner: str) -> dict[str, object]:
    """The answer; ``plan`` and ``cost`` are null where there is no plan, ``reason`` where there is one."""
    found = answer if isinstance(answer, Filled) else None
    status = {Filled: "solved", Unreachable: "unreachable", GaveUp: "gave_up"}[type(answer)]
    return {
        "status": status,
        "planner": planner,
        "plan": [instruction.pddl() for instruction in found.plan] if found else None,
        "cost": found.cost if found else None,
        "reason": None if isinstance(answer, Filled) else why_none(answer),
    }


def why_none(answer: Unreachable | GaveUp) -> str:
    """Why there is no plan, in one line."""
    if isinstance(answer, Unreachable):
        return answer.reason
    return f"the planner gave up at {answer.limit}; nothing is proven"


def exit_code(answer: Answer) -> ExitCode:
    """0 for a plan, 10 for a proof that there is none, 20 where the planner gave up."""
    if isinstance(answer, Filled):
        return ExitCode.OK
    return ExitCode.UNREACHABLE if isinstance(answer, Unreachable) else ExitCode.GAVE_UP
