"""A grounded text as JSON and as lines for people."""

from __future__ import annotations

from collections.abc import Mapping

from tmd.cli.output import rounded
from tmd.cli.show.clauses import parsed_json, parsed_text
from tmd.cli.show.goals import goals_json, goals_text, refused_json
from tmd.export.end_goal import end_goal
from tmd.grounded import Grounded
from tmd.inference.ranking import RankedPlan
from tmd.pddl.task import Task
from tmd.pddl.validator import Verdict
from tmd.pddl.writer import format_formula


def grounded_json(grounded: Grounded, domain: str) -> dict[str, object]:
    """Everything that is known of the plans; clauses are counted from 0."""
    parsed, task = grounded.parsed, grounded.world.task
    pairs = zip(grounded.plans, grounded.verdicts, strict=True)
    return {
        "text": parsed.text,
        "domain": domain,
        "environment": grounded.world.name,
        **parsed_json(parsed),
        "unseen_verbs": list(grounded.unseen),
        "unknown_nouns": list(grounded.unknown),
        "plans": [_plan_json(plan, verdict, task) for plan, verdict in pairs],
        "refusals": [
            {"clause": refusal.clause, "source": refusal.source, "reason": refusal.reason}
            for refusal in grounded.refusals
        ],
        "refused": refused_json(grounded.refused),
        "warnings": list(grounded.warnings),
    }


def _plan_json(plan: RankedPlan, verdict: Verdict, task: Task) -> dict[str, object]:
    whole = end_goal(plan, task)
    return {
        "steps": [
            {
                "action": step.instruction.name,
                "args": list(step.instruction.args),
                "clause": step.clause,
                "latent": step.latent,
            }
            for step in plan.steps
        ],
        "energy": rounded(plan.energy),
        "factors": _rounded(plan.factors),
        "valid": verdict.valid,
        "cost": verdict.cost,
        "why_not_first": plan.why or None,
        "choices": [
            {"source": choice.source, "energy": rounded(choice.energy), "factors": _rounded(choice.factors)}
            for choice in plan.choices
        ],
        "goal": None if whole is None else format_formula(whole),
        "goals": goals_json(plan, task.problem),
    }


def _rounded(factors: Mapping[str, float]) -> dict[str, float]:
    return {name: rounded(value) for name, value in factors.items()}


def remarks(grounded: Grounded) -> list[str]:
    """Lines for standard error: its warnings, and why there is no plan if there is none."""
    lines = [f"warning: {warning}\n" for warning in grounded.warnings]
    return [*lines, f"no plan: {grounded.reason}\n"] if grounded.reason else lines


def grounded_text(grounded: Grounded) -> str:
    """Clauses, what was skipped, what the steps ask for, then each plan with its energy and why it is not first."""
    parts = [parsed_text(grounded.parsed)]
    told: list[str] = []
    for number, (plan, verdict) in enumerate(zip(grounded.plans, grounded.verdicts, strict=True), start=1):
        goals = _goals_text(plan, grounded)
        parts += [goals] if goals and goals not in told[-1:] else []
        told.append(goals)
        parts.append(_plan_text(number, plan, verdict))
    return "\n".join(parts)


def _goals_text(plan: RankedPlan, grounded: Grounded) -> str:
    """What the steps ask for; empty where the model has no goals."""
    if not plan.goals:
        return ""
    return goals_text(plan, grounded.parsed.clauses, grounded.world.task.problem)


def _plan_text(number: int, plan: RankedPlan, verdict: Verdict) -> str:
    valid = "valid" if verdict.valid else f"invalid: {verdict.reason}"
    steps = f"{len(plan.steps)} step{'' if len(plan.steps) == 1 else 's'}"
    lines = [f"plan {number}: energy {plan.energy:.4f}, {steps}, {valid}"]
    if plan.why:
        lines.append(f"  not first: {plan.why}")
    width = max((len(str(step.instruction)) for step in plan.steps), default=0)
    for place, step in enumerate(plan.steps, start=1):
        origin = f"clause {step.clause + 1}{', left unsaid' if step.latent else ''}"
        lines.append(f"  {place:>3}. {step.instruction!s:<{width}}  {origin}")
    factors = ", ".join(f"{name} {value:.4f}" for name, value in plan.factors.items() if rounded(value))
    lines.append(f"  energy by factor: {factors or 'nothing'}")
    return "\n".join(lines) + "\n"
