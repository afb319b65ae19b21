"""What the steps of a text ask for, as JSON and as lines for people."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from tmd.export.end_goal import asked_problem
from tmd.goals.clause_goal import Refused
from tmd.grounded import Grounded
from tmd.inference.ranking import RankedPlan
from tmd.language.clause import Clause
from tmd.pddl.model import Problem
from tmd.pddl.writer import format_formula, format_problem
from tmd.view.goals import ShownGoal, in_words


def goals_json(plan: RankedPlan, problem: Problem) -> list[dict[str, object]]:
    """The goals of a plan's steps, in the order of doing; ``null`` for what is not known or not there."""
    return [_goal_json(shown) for shown in in_words(plan.goals, problem)]


def _goal_json(shown: ShownGoal) -> dict[str, object]:
    goal = shown.goal
    return {
        "clause": goal.clause,
        "text": goal.text,
        "pddl": None if goal.formula is None else format_formula(goal.formula),
        "words": shown.words or None,
        "source": goal.source or None,
        "row": goal.row or None,
        "already": goal.already,
        "note": goal.note or None,
        "first": goal.first,
        "last": goal.last,
    }


def refused_json(refused: tuple[int, Refused] | None) -> dict[str, object] | None:
    """Why there is no plan for what was said; ``None`` where it was not refused."""
    if refused is None:
        return None
    clause, reason = refused
    return {"clause": clause, "why": reason.why.value, "message": reason.message, "hint": reason.hint}


def goals_text(plan: RankedPlan, clauses: Sequence[Clause], problem: Problem) -> str:
    """The goals of a plan's steps: in words, as PDDL, and where their meaning comes from."""
    lines = ["goals"]
    for shown in in_words(plan.goals, problem):
        lines.append(f"  {shown.goal.clause + 1}. {_of_part(shown, clauses)}{_told(shown)}")
        lines += [f"     {line}" for line in _below(shown)]
    return "\n".join(lines) + "\n"


def _of_part(shown: ShownGoal, clauses: Sequence[Clause]) -> str:
    """What was said, where it is only a part of the clause: *when you have taken the cup*."""
    clause = clauses[shown.goal.clause] if shown.goal.clause < len(clauses) else None
    whole = "" if clause is None else " ".join(clause.text.split())
    return "" if shown.goal.text == whole else f'"{shown.goal.text}": '


def _told(shown: ShownGoal) -> str:
    return f"{shown.told} (already so)" if shown.asked and shown.goal.already else shown.told


def _below(shown: ShownGoal) -> list[str]:
    """The goal as PDDL with its source, and what was not taken into account."""
    goal = shown.goal
    if goal.formula is None or not shown.asked:
        return []
    source = f"   {goal.source}: {goal.row}" if goal.source else ""
    return [f"{format_formula(goal.formula)}{source}", *([f"note: {goal.note}"] if goal.note else [])]


def whole_goal_text(grounded: Grounded) -> str:
    """The environment as a PDDL problem whose goal is what the text asks for; empty where there is no plan."""
    problem = asked_problem(grounded)
    return "" if problem is None else format_problem(problem)


def whole_goal_json(told: Mapping[str, Any]) -> dict[str, object]:
    """What `tmd ground --goal-only` prints for programs, of all that is told of a text."""
    best = told["plans"][0] if told["plans"] else {"goal": None, "goals": []}
    kept = {key: told[key] for key in ("text", "domain", "environment", "environment_file")}
    return {
        **kept,
        "goal": best["goal"],
        "goals": best["goals"],
        "refused": told["refused"],
        "warnings": told["warnings"],
    }
