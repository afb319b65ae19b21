"""A grounded text as the record that ``tmd ground --json`` prints."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tmd.diagnostics import Refusal
from tmd.export.end_goal import end_goal
from tmd.goals.wording import Wording
from tmd.grounded import Grounded
from tmd.inference.ranking import RankedPlan
from tmd.pddl.model import Problem
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
    grounded: Grounded, *, domain: str, environment_file: str | None, made_with: Mapping[str, object]
) -> GroundingRecord:
    """Return everything that is known of the plans.

    ``environment_file`` is as it was given, ``None`` for a bundled one; ``made_with`` are the fields of
    :class:`~tmd.records.grounding.MadeWith`.
    """
    task = grounded.world.task
    pairs = zip(grounded.plans, grounded.verdicts, strict=True)
    optional: dict[str, Any] = {}  # keys that are left out where there is nothing to say
    if grounded.usage is not None:
        optional["reader"] = ModelUse.copied(grounded.usage)
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
        refusals=tuple(map(RefusedTemplate.copied, grounded.rejected)),
        refused=_refused(grounded.refused),
        warnings=grounded.warnings,
        environment_file=environment_file,
        made_with=MadeWith.model_validate(made_with),
        **optional,
    )


def _question(question: Question, problem: Problem) -> QuestionRecord:
    options = zip(question.options, option_texts(question, problem), strict=True)
    told = tuple(OptionRecord(answer=text, goal=format_formula(option.formula)) for option, text in options)
    return QuestionRecord.copied(question, options=told, taken=question.taken)


def option_texts(question: Question, problem: Problem) -> list[str]:
    """Return the answers to a question: the reader's own words, or else the goals in words."""
    wording = Wording(problem)
    return [option.answer or wording.condition(option.formula) for option in question.options]


def _plan(plan: RankedPlan, verdict: Verdict, task: Task) -> RankedPlanRecord:
    whole = end_goal(plan, task)
    return RankedPlanRecord.copied(
        plan,
        steps=tuple(
            GroundedStep.copied(step, action=step.instruction.name, args=step.instruction.args) for step in plan.steps
        ),
        valid=verdict.valid,
        cost=verdict.cost,
        why_not_first=plan.why,
        choices=tuple(map(ChoiceRecord.copied, plan.choices)),
        goal=None if whole is None else format_formula(whole),
        goals=tuple(map(_goal, in_words(plan.goals, task.problem))),
    )


def _goal(shown: ShownGoal) -> GoalRecord:
    goal = shown.goal
    others = tuple(OtherGoal.copied(lost, pddl=format_formula(lost.formula)) for lost in goal.others)
    return GoalRecord.copied(goal, pddl=str(goal) or None, words=shown.words, **({"others": others} if others else {}))


def _refused(refused: tuple[int | None, Refusal] | None) -> RefusedText | None:
    if refused is None:
        return None
    clause, reason = refused
    return RefusedText(clause=clause, why=reason.kind.value, message=reason.message, hint=reason.hint)
