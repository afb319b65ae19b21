"""What the steps of a text ask for, as lines for people."""

from __future__ import annotations

from collections.abc import Sequence

from tmd.export.end_goal import asked_problem
from tmd.grounded import Grounded
from tmd.inference.ranking import RankedPlan
from tmd.language.clause import Clause
from tmd.pddl.model import Problem
from tmd.pddl.writer import format_formula, format_problem
from tmd.view.goals import ShownGoal, in_words


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
