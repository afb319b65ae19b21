"""A grounded text as lines for people."""

from __future__ import annotations

from tmd.cli.show.clauses import parsed_text
from tmd.cli.show.goals import goals_text
from tmd.grounded import Grounded
from tmd.inference.ranking import RankedPlan
from tmd.pddl.validator import Verdict
from tmd.records.json_record import rounded


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
