"""A grounded text as the record that ``tmd ground --json`` prints."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tmd.diagnostics import Refusal
from tmd.export.end_goal import end_goal
from tmd.goals.wording import Wording
from tmd.grounded import Grounded
from tmd.inference.ranking import RankedPlan
from tmd.json_record import rounded
from tmd.pddl.model import Formula, Problem
from tmd.pddl.task import Task
from tmd.pddl.validator import Verdict
from tmd.pddl.writer import format_formula
from tmd.readers.interface import Question
from tmd.records.clauses import ParsedRecord
from tmd.records.grounding import (
    ChoiceRecord,
    GoalRecord,
    GroundedStep,
    GroundingRecord,
    MadeWith,
    ModelUse,
    OptionRecord,
    OtherGoal,
    QuestionRecord,
    RankedPlanRecord,
    RefusedTemplate,
    RefusedText,
)
from tmd.view.goals import ShownGoal, in_words


def grounding_record(
    grounded: Grounded,
    *,
    domain: str,
    environment_file: str | None,
    made_with: Mapping[str, object],
) -> GroundingRecord:
    """Return everything that is known of the plans.

    Args:
        grounded: The plans.
        domain: The domain's name.
        environment_file: The environment's file as it was given; ``None`` for a bundled one.
        made_with: The fields of :class:`~tmd.records.grounding.MadeWith`.
    """
    task = grounded.world.task
    pairs = zip(grounded.plans, grounded.verdicts, strict=True)
    optional: dict[str, Any] = {}  # keys that are left out where there is nothing to say
    if grounded.usage is not None:
        optional["reader"] = ModelUse.of(grounded.usage)
    if grounded.question is not None:
        optional["question"] = _question(grounded.question, task.problem)
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
        **optional,
    )


def _question(question: Question, problem: Problem) -> QuestionRecord:
    options = zip(question.options, option_texts(question, problem), strict=True)
    return QuestionRecord(
        text=question.text,
        step=question.step,
        options=tuple(OptionRecord(answer=text, goal=flat(option.formula)) for option, text in options),
        taken=question.taken,
    )


def option_texts(question: Question, problem: Problem) -> list[str]:
    """Return the answers to a question: the reader's own words, or else the goals in words."""
    wording = Wording(problem)
    return [option.answer or wording.condition(option.formula) for option in question.options]


def flat(formula: Formula) -> str:
    """Return a formula on one line."""
    return " ".join(format_formula(formula).split())


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
    others = tuple(OtherGoal(pddl=flat(lost.formula), row=lost.row or None, why=lost.why) for lost in goal.others)
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
        **({"others": others} if others else {}),
    )


def _refused(refused: tuple[int | None, Refusal] | None) -> RefusedText | None:
    if refused is None:
        return None
    clause, reason = refused
    return RefusedText(clause=clause, why=reason.kind.value, message=reason.message, hint=reason.hint)
