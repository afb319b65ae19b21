"""A grounded text as the record that ``tmd ground --json`` prints."""

from __future__ import annotations

from collections.abc import Mapping

from tmd.diagnostics import Refusal
from tmd.export.end_goal import end_goal
from tmd.grounded import Grounded
from tmd.inference.ranking import RankedPlan
from tmd.pddl.task import Task
from tmd.pddl.validator import Verdict
from tmd.pddl.writer import format_formula
from tmd.records.clauses import ParsedRecord
from tmd.records.grounding import (
    ChoiceRecord,
    GoalRecord,
    GroundedStep,
    GroundingRecord,
    MadeWith,
    RankedPlanRecord,
    RefusedTemplate,
    RefusedText,
)
from tmd.records.json_record import rounded
from tmd.view.goals import ShownGoal, in_words


def grounding_record(
    grounded: Grounded,
    *,
    domain: str,
    environment_file: str | None,
    made_with: Mapping[str, object],
) -> GroundingRecord:
    """Everything that is known of the plans.

    Args:
        grounded: The plans.
        domain: The domain's name.
        environment_file: The environment's file as it was given; ``None`` for a bundled one.
        made_with: The fields of :class:`~tmd.records.grounding.MadeWith`.
    """
    task = grounded.world.task
    pairs = zip(grounded.plans, grounded.verdicts, strict=True)
    return GroundingRecord(
        text=grounded.parsed.text,
        domain=domain,
        environment=grounded.world.name,
        **ParsedRecord.of(grounded.parsed).given(),
        unseen_verbs=grounded.unseen,
        unknown_nouns=grounded.unknown,
        plans=tuple(_plan(plan, verdict, task) for plan, verdict in pairs),
        refusals=tuple(RefusedTemplate(clause=r.clause, source=r.source, reason=r.reason) for r in grounded.rejected),
        refused=_refused(grounded.refused),
        warnings=grounded.warnings,
        environment_file=environment_file,
        made_with=MadeWith.model_validate(made_with),
    )


def _plan(plan: RankedPlan, verdict: Verdict, task: Task) -> RankedPlanRecord:
    whole = end_goal(plan, task)
    return RankedPlanRecord(
        steps=tuple(
            GroundedStep(action=s.instruction.name, args=s.instruction.args, clause=s.clause, latent=s.latent)
            for s in plan.steps
        ),
        energy=rounded(plan.energy),
        factors=_rounded(plan.factors),
        valid=verdict.valid,
        cost=verdict.cost,
        why_not_first=plan.why or None,
        choices=tuple(
            ChoiceRecord(source=c.source, energy=rounded(c.energy), factors=_rounded(c.factors)) for c in plan.choices
        ),
        goal=None if whole is None else format_formula(whole),
        goals=tuple(map(_goal, in_words(plan.goals, task.problem))),
    )


def _rounded(factors: Mapping[str, float]) -> dict[str, float]:
    return {name: rounded(value) for name, value in factors.items()}


def _goal(shown: ShownGoal) -> GoalRecord:
    goal = shown.goal
    return GoalRecord(
        clause=goal.clause,
        text=goal.text,
        pddl=None if goal.formula is None else format_formula(goal.formula),
        words=shown.words or None,
        source=goal.source or None,
        row=goal.row or None,
        already=goal.already,
        note=goal.note or None,
        first=goal.first,
        last=goal.last,
    )


def _refused(refused: tuple[int, Refusal] | None) -> RefusedText | None:
    if refused is None:
        return None
    clause, reason = refused
    return RefusedText(clause=clause, why=reason.kind.value, message=reason.message, hint=reason.hint)
