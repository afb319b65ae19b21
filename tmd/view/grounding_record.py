"""What ``tmd ground --json`` prints, read back: the clauses, the ranked plans and the refusals."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, field_validator, model_validator

from tmd.diagnostics import TmdError
from tmd.grounded import why_refused
from tmd.inference.ranking import Choice, PlanStep, RankedPlan, Refusal, StepGoal
from tmd.language.clause import Clause, Parsed, Relation, Skipped, Span
from tmd.pddl.model import Formula, Instruction
from tmd.pddl.reading.formulas import read_condition
from tmd.pddl.reading.syntax import parse


class _Record(BaseModel):
    """Part of a file. What a later version adds is passed over."""

    model_config = ConfigDict(frozen=True, extra="ignore", allow_inf_nan=False)


class _Step(_Record):
    action: str
    args: tuple[str, ...]
    clause: int = Field(ge=0)
    latent: bool


class _Choice(_Record):
    source: str | None
    factors: dict[str, float]


class _Goal(_Record):
    clause: int = Field(ge=0)
    text: str
    pddl: str | None = None
    source: str | None = None
    row: str | None = None
    already: bool = False
    note: str | None = None
    first: int = Field(default=0, ge=0)
    last: int = Field(default=0, ge=0)

    @field_validator("pddl")
    @classmethod
    def _is_a_condition(cls, text: str | None) -> str | None:
        if text is not None:
            _condition(text)
        return text

    def step_goal(self) -> StepGoal:
        formula = None if self.pddl is None else _condition(self.pddl)
        told = (self.source or "", self.row or "", self.already, self.note or "", self.first, self.last)
        return StepGoal(self.clause, self.text, formula, *told)


def _condition(text: str) -> Formula:
    """The condition that a text states.

    Raises:
        ValueError: It is none.
    """
    try:
        document = parse(text, "pddl")
        document.check_depth()
        if len(document.groups) == 1:
            return read_condition(document.groups[0], document.source)
    except TmdError as error:
        raise ValueError(error.message) from None
    raise ValueError("a goal is one condition")


class _Plan(_Record):
    steps: tuple[_Step, ...]
    choices: tuple[_Choice, ...]
    why_not_first: str | None = None
    goals: tuple[_Goal, ...] = ()

    @model_validator(mode="after")
    def _steps_are_in_order(self) -> _Plan:
        if self.goals:
            self._check_goals()
            return self
        served = [step.clause for step in self.steps]
        if served != sorted(served) or any(clause >= len(self.choices) for clause in served):
            raise ValueError("the steps do not serve the clauses one after the other")
        return self

    def _check_goals(self) -> None:
        """Each goal has one choice, and the next steps of the plan."""
        places = [0, *(place for goal in self.goals for place in (goal.first, goal.last)), len(self.steps)]
        if len(self.goals) != len(self.choices) or places != sorted(places):
            raise ValueError("the goals do not have the steps one after the other")

    def ranked(self) -> RankedPlan:
        steps = [PlanStep(Instruction(s.action, s.args), s.clause, s.latent) for s in self.steps]
        goals = tuple(goal.step_goal() for goal in self.goals)
        own = [tuple(steps[g.first : g.last]) for g in goals] or [
            tuple(step for step in steps if step.clause == number) for number in range(len(self.choices))
        ]
        choices = [Choice(c.source, part, c.factors, {}) for c, part in zip(self.choices, own, strict=True)]
        return RankedPlan(tuple(choices), 0, self.why_not_first or "", goals)


class _Clause(_Record):
    verb: str
    objects: tuple[str, ...]
    relations: tuple[tuple[str, str | None, str], ...] = ()
    text: str
    span: tuple[int, int]
    antecedents: dict[str, tuple[str, ...]] = {}
    together: dict[str, int] = {}
    quantities: dict[str, str] = {}
    condition: str | None = None
    duration: str | None = None
    purpose: str | None = None

    def clause(self) -> Clause:
        said = {name: getattr(self, name) for name in ("antecedents", "together", "quantities")}
        return Clause(
            self.verb,
            self.objects,
            tuple(Relation(*relation) for relation in self.relations),
            Span(*self.span),
            self.text,
            condition=self.condition,
            duration=self.duration,
            purpose=self.purpose,
            **said,
        )


class _Skipped(_Record):
    text: str
    span: tuple[int, int]
    reason: str


class _Refusal(_Record):
    clause: int = Field(ge=0)
    source: str
    reason: str


class _Refused(_Record):
    clause: int = Field(ge=0)
    message: str
    hint: str | None = None


class _Whole(_Record):
    text: str
    domain: str | None = None
    environment: str
    environment_file: str | None = None
    clauses: tuple[_Clause, ...]
    skipped: tuple[_Skipped, ...] = ()
    unseen_verbs: tuple[str, ...] = ()
    unknown_nouns: tuple[str, ...] = ()
    plans: tuple[_Plan, ...]
    refusals: tuple[_Refusal, ...] = ()
    refused: _Refused | None = None
    made_with: dict[str, str | int | None] = {}

    @model_validator(mode="after")
    def _is_of_one_piece(self) -> _Whole:
        for start, end in [*(clause.span for clause in self.clauses), *(piece.span for piece in self.skipped)]:
            if not 0 <= start <= end <= len(self.text):
                raise ValueError(f"the span [{start}, {end}] lies outside of the text")
        for plan in self.plans:
            if not plan.goals and len(plan.choices) != len(self.clauses):
                raise ValueError("a plan has not one choice for each clause")
            served = {goal.clause for goal in plan.goals} | {step.clause for step in plan.steps}
            if any(clause >= len(self.clauses) for clause in served):
                raise ValueError("a plan is for a clause that is not there")
        return self


@dataclass(frozen=True, slots=True)
class GroundingRecord:
    """A grounded text, as it was printed.

    Attributes:
        parsed: The clauses.
        plans: The ranked plans.
        refusals: Templates that could not be used.
        unseen: Verbs that no demonstration has.
        unknown: Nouns that name nothing in the environment.
        domain: The domain's name.
        environment: The environment's name.
        environment_file: Its file as it was given; ``None`` for a bundled one.
        made_with: What decided the plans.
        refused: Why there is no plan for what was said, in a line; empty where it was not refused.
    """

    parsed: Parsed
    plans: tuple[RankedPlan, ...]
    refusals: tuple[Refusal, ...]
    unseen: tuple[str, ...]
    unknown: tuple[str, ...]
    domain: str | None
    environment: str
    environment_file: str | None
    made_with: Mapping[str, str | int | None]
    refused: str = ""


def read_grounding(value: Mapping[str, Any]) -> GroundingRecord:
    """Read what ``tmd ground --json`` printed.

    Raises:
        pydantic.ValidationError: It is something else.
    """
    whole = _Whole.model_validate(value)
    skipped = tuple(Skipped(piece.text, Span(*piece.span), piece.reason) for piece in whole.skipped)
    return GroundingRecord(
        Parsed(whole.text, tuple(clause.clause() for clause in whole.clauses), skipped),
        tuple(plan.ranked() for plan in whole.plans),
        tuple(Refusal(r.clause, r.source, r.reason) for r in whole.refusals),
        whole.unseen_verbs,
        whole.unknown_nouns,
        whole.domain,
        whole.environment,
        whole.environment_file,
        whole.made_with,
        "" if whole.refused is None else why_refused(whole.refused.clause, whole.refused.message, whole.refused.hint),
    )
