"""``tmd ground --json``: the text, its goals, and the ranked plans."""

from __future__ import annotations

from typing import Self

from pydantic import Field, field_validator, model_validator

from tmd.diagnostics import TmdError
from tmd.inference.ranking import Choice, PlanStep, RankedPlan, StepGoal
from tmd.json_record import JsonRecord, Rounded, TextOrNull
from tmd.pddl.model import Formula, Instruction
from tmd.pddl.reading.formulas import read_only_condition
from tmd.pddl.reading.syntax import parse
from tmd.records.clauses import ParsedRecord


class InstructionRecord(JsonRecord):
    """An instruction."""

    action: str
    args: tuple[str, ...]

    @property
    def instruction(self) -> Instruction:
        """The same as PDDL has it."""
        return Instruction(self.action, self.args)


class GroundedStep(InstructionRecord):
    """A step of a plan; a latent one was left unsaid and serves the steps of ``clause`` that follow."""

    clause: int = Field(ge=0)
    latent: bool


class ChoiceRecord(JsonRecord):
    """Choice for one goal, or for one clause where the model has no goals."""

    source: str | None = Field(description="The demonstration or proposer; null where nothing could be used.")
    energy: Rounded
    factors: dict[str, Rounded] = Field(description="What each factor adds to the energy.")


class OtherGoal(JsonRecord):
    """Another candidate goal of a step, and why it was not taken."""

    pddl: str
    row: TextOrNull
    why: str


class GoalRecord(JsonRecord):
    """Goal of one step of the text. Its part of the plan is ``steps[first:last]``."""

    clause: int = Field(ge=0)
    text: str
    pddl: str | None = Field(description="Null where nothing is to be done, or where no goal is known.")
    words: TextOrNull
    source: TextOrNull = Field(description="Where its meaning comes from: declared, learned, actions or model.")
    row: TextOrNull
    already: bool = Field(description="It held already, so nothing is done for it.")
    note: TextOrNull
    first: int = Field(ge=0)
    last: int = Field(ge=0)
    others: tuple[OtherGoal, ...] = Field((), description="The other candidate goals of the step.")

    @field_validator("pddl")
    @classmethod
    def _is_a_condition(cls, text: str | None) -> str | None:
        if text is not None:
            _condition(text)
        return text

    def step_goal(self) -> StepGoal:
        """Return the goal."""
        formula = None if self.pddl is None else _condition(self.pddl)
        told = (self.source or "", self.row or "", self.already, self.note or "", self.first, self.last)
        return StepGoal(self.clause, self.text, formula, *told)


def _condition(text: str) -> Formula:
    """Return the condition that a text states."""
    try:
        return read_only_condition(parse(text, "pddl"))
    except TmdError as error:
        raise ValueError(error.message) from None


class RankedPlanRecord(JsonRecord):
    """A plan with its energy, the validator's verdict on it, and what it is for."""

    steps: tuple[GroundedStep, ...]
    energy: Rounded
    factors: dict[str, Rounded]
    valid: bool
    cost: int
    why_not_first: TextOrNull = Field(description="Which factor speaks most against it; null for the first.")
    choices: tuple[ChoiceRecord, ...]
    goal: str | None = Field(description="What the text asks for, all in all, as PDDL; null without goals.")
    goals: tuple[GoalRecord, ...] = Field(description="Goals in the order of doing; empty for models without.")

    @model_validator(mode="after")
    def _steps_are_in_order(self) -> Self:
        if self.goals:
            places = [0, *(place for goal in self.goals for place in (goal.first, goal.last)), len(self.steps)]
            if len(self.goals) != len(self.choices) or places != sorted(places):
                raise ValueError("the goals do not have the steps one after the other")
            return self
        served = [step.clause for step in self.steps]
        if served != sorted(served) or any(clause >= len(self.choices) for clause in served):
            raise ValueError("the steps do not serve the clauses one after the other")
        return self

    def ranked(self) -> RankedPlan:
        """Return the plan; in which state it ends is not recorded."""
        steps = [PlanStep(step.instruction, step.clause, step.latent) for step in self.steps]
        goals = tuple(goal.step_goal() for goal in self.goals)
        own = [tuple(steps[g.first : g.last]) for g in goals] or [
            tuple(step for step in steps if step.clause == number) for number in range(len(self.choices))
        ]
        choices = [Choice(c.source, part, c.factors, {}) for c, part in zip(self.choices, own, strict=True)]
        return RankedPlan(tuple(choices), 0, self.why_not_first or "", goals)


class RefusedTemplate(JsonRecord):
    """A demonstration whose template cannot be used here."""

    clause: int = Field(ge=0)
    source: str
    reason: str


class RefusedText(JsonRecord):
    """Reason why there is no plan, and a remedy."""

    clause: int | None = Field(ge=0, description="Null where it is about the whole request.")
    why: str
    message: str
    hint: str | None


class ModelUse(JsonRecord):
    """The effort of the language model that read a request."""

    model: str
    prompt_tokens: int = Field(ge=0)
    completion_tokens: int = Field(ge=0)
    seconds: float = Field(ge=0, description="Time spent waiting for the server.")
    cached: int = Field(ge=0, description="Replies that came from the cache.")
    corrections: int = Field(ge=0, description="How often a reply was sent back.")
    digests: tuple[str, ...] = Field(description="Of the replies; they name the files of the cache.")
    thoughts: str = Field(description="The model's own explanation of its reading.")


class OptionRecord(JsonRecord):
    """An answer to a question."""

    answer: str
    goal: str = Field(description="The goal of the step in that case, as PDDL.")


class QuestionRecord(JsonRecord):
    """A question to the user that was not answered."""

    text: str
    step: int = Field(ge=0)
    options: tuple[OptionRecord, ...]
    taken: int = Field(0, ge=0, description="The index of the option that the plans are for.")


class MadeWith(JsonRecord):
    """Settings that decide the plans beside text and environment."""

    version: str
    model: str
    weights: str
    planner: str
    beam: int
    trim: int | None
    top: int


class GroundedText(JsonRecord):
    """Text of a request, with its domain and environment."""

    text: str
    domain: str
    environment: str


_FILE = "The environment's file as it was given; null for the name of a bundled one."


class GroundingRecord(ParsedRecord, GroundedText):
    """A grounded text. Clauses are counted from 0."""

    WHAT = "what tmd ground --json prints"
    REMAKE = "make it again with tmd ground --json"

    unseen_verbs: tuple[str, ...]
    unknown_nouns: tuple[str, ...]
    plans: tuple[RankedPlanRecord, ...] = Field(description="Least energy first.")
    refusals: tuple[RefusedTemplate, ...]
    refused: RefusedText | None
    warnings: tuple[str, ...]
    environment_file: str | None = Field(description=_FILE)
    made_with: MadeWith
    reader: ModelUse | None = Field(None, description="Of the language model; left out where rules read the text.")
    question: QuestionRecord | None = Field(None, description="Left out where there is none.")

    @model_validator(mode="after")
    def _is_of_one_piece(self) -> Self:
        spans = [clause.span for clause in (*self.clauses, *self.constraints)]
        for start, end in [*spans, *(piece.span for piece in self.skipped)]:
            if not 0 <= start <= end <= len(self.text):
                raise ValueError(f"the span [{start}, {end}] lies outside of the text")
        for plan in self.plans:
            if plan.choices and not plan.goals and len(plan.choices) != len(self.clauses):
                raise ValueError("a plan has not one choice for each clause")
            served = {goal.clause for goal in plan.goals} | {step.clause for step in plan.steps}
            if any(clause >= len(self.clauses) for clause in served):
                raise ValueError("a plan is for a clause that is not there")
        return self

    def ranked(self) -> tuple[RankedPlan, ...]:
        """Return the plans."""
        return tuple(plan.ranked() for plan in self.plans)

    def goal_only(self) -> GoalOnlyRecord:
        """Return the record that ``tmd ground --goal-only --json`` prints."""
        names = ("text", "domain", "environment", "environment_file", "refused", "warnings")
        goal, goals = (self.plans[0].goal, self.plans[0].goals) if self.plans else (None, ())
        return GoalOnlyRecord(**{name: getattr(self, name) for name in names}, goal=goal, goals=goals)


class GoalOnlyRecord(GroundedText):
    """Record of ``tmd ground --goal-only --json``: the goal of the first plan."""

    WHAT = "what tmd ground --goal-only --json prints"
    REMAKE = "make it again with tmd ground --goal-only --json"

    environment_file: str | None = Field(description=_FILE)
    goal: str | None
    goals: tuple[GoalRecord, ...]
    refused: RefusedText | None
    warnings: tuple[str, ...]
