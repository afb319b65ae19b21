"""Ways through the clauses, and the ranked plans that inference makes of them, with the reasons for the ranking."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from tmd.diagnostics import Refusal
from tmd.inference.commitments import Commitment
from tmd.inference.energy import title
from tmd.inference.tidying import Need
from tmd.pddl.model import Formula, Instruction
from tmd.pddl.task import Bits
from tmd.pddl.writer import format_formula
from tmd.readers.interface import Question
from tmd.short_repr import short_repr


@dataclass(frozen=True, slots=True)
class PlanStep:
    """One instruction of a plan.

    Attributes:
        clause: The clause it serves. A latent step serves the instructions of this clause that follow it.
        latent: Whether the person left it unsaid (it is in I_il, found by the planner).
    """

    instruction: Instruction
    clause: int
    latent: bool


@short_repr(lambda choice: f"{choice.source}: " + ", ".join(str(step.instruction) for step in choice.steps))
@dataclass(frozen=True, slots=True)
class Choice:
    """The sequence that was chosen for one clause.

    Attributes:
        source: The demonstration whose template was used, or the name of another proposer; ``None`` where none could
            be used: the verb is in no demonstration, or nothing that was shown for it can be done here.
        steps: The latent steps, then those of the template.
        raw: The same factors before they are weighed.
    """

    source: str | None
    steps: tuple[PlanStep, ...]
    factors: Mapping[str, float]
    raw: Mapping[str, float]

    @property
    def energy(self) -> float:
        """The sum of the factors."""
        return sum(self.factors.values())


@dataclass(frozen=True, slots=True)
class RejectedProposal:
    """A proposal that cannot be executed here, and the reason."""

    clause: int
    source: str
    reason: str


@short_repr(lambda goal: f"{format_formula(goal.formula)} ({goal.why})")
@dataclass(frozen=True, slots=True)
class LostGoal:
    """A candidate goal of a step that was not taken.

    Attributes:
        row: The lexicon row, action or model's words that it was derived from.
        planned: Whether there is a plan for it.
    """

    formula: Formula
    row: str
    why: str
    planned: bool = False


@short_repr(lambda goal: f"{goal} of '{goal.text}'")
@dataclass(frozen=True, slots=True)
class StepGoal:
    """The goal of one step of a request, and the part of a plan that brings it about.

    Attributes:
        clause: The clause of the text, counted from 0.
        formula: The goal; ``None`` where nothing was to be done, or where no goal is known.
        source: Where its meaning comes from: ``declared``, ``learned``, ``actions``; empty for none.
        row: The row it was read by, as it was written.
        note: What else is to be said: why nothing is done, or what was left out of account.
        first: The first instruction of the plan that serves it, counted from 0.
        last: The one after the last.
        words: The goal in English, at most 200 characters; empty without a goal.
    """

    clause: int
    text: str
    formula: Formula | None
    source: str = ""
    row: str = ""
    already: bool = False
    note: str = ""
    first: int = 0
    last: int = 0
    others: tuple[LostGoal, ...] = ()
    words: str = field(default="", compare=False)

    def __str__(self) -> str:
        """Return the goal as PDDL; empty where there is none."""
        return "" if self.formula is None else format_formula(self.formula)

    @property
    def origin(self) -> str:
        """The source, with the row that the goal was read by where there is one."""
        return f"{self.source}: {self.row}" if self.row else self.source


@dataclass(frozen=True, slots=True)
class Way:
    """A way through the first steps of a request.

    Attributes:
        choices: One for each step.
        needs: What each choice is for.
        readings: For each step with several candidate goals, its index and the goal that was taken.
    """

    energy: float
    state: Bits
    choices: tuple[Choice, ...] = ()
    memory: object = None
    kept: tuple[Commitment, ...] = ()
    goals: tuple[StepGoal, ...] = ()
    needs: tuple[Need, ...] = ()
    readings: tuple[tuple[int, Formula], ...] = ()

    def extended(self, choice: Choice, end: Bits) -> Way:
        """Return the way with a choice for the next step, which ends in ``end``."""
        return replace(self, energy=self.energy + choice.energy, state=end, choices=(*self.choices, choice))

    @property
    def instructions(self) -> tuple[Instruction, ...]:
        """The instructions on it."""
        return tuple(step.instruction for choice in self.choices for step in choice.steps)

    @property
    def order(self) -> tuple[float, tuple[Instruction, ...]]:
        """Cheapest first; ties in the order of the instructions, so that the ranking is the same everywhere."""
        return self.energy, self.instructions


@short_repr(lambda plan: f"of {len(plan.steps)} step(s), energy {plan.energy:.4f}")
@dataclass(frozen=True, slots=True)
class RankedPlan:
    """A plan for the whole text.

    Attributes:
        why: Why it is not ranked first; empty for the first.
        goals: What was asked for, step by step, where the model has goals.
    """

    choices: tuple[Choice, ...]
    state: Bits
    why: str = ""
    goals: tuple[StepGoal, ...] = ()

    @property
    def steps(self) -> tuple[PlanStep, ...]:
        """All steps in order."""
        return tuple(step for choice in self.choices for step in choice.steps)

    @property
    def instructions(self) -> tuple[Instruction, ...]:
        """The plan as it is executed."""
        return tuple(step.instruction for step in self.steps)

    @property
    def factors(self) -> dict[str, float]:
        """The weighed factors, summed over the clauses."""
        return _total(choice.factors for choice in self.choices)

    @property
    def raw(self) -> dict[str, float]:
        """The factors summed over the clauses, before they are weighed: the features that weights are learned on."""
        return _total(choice.raw for choice in self.choices)

    @property
    def energy(self) -> float:
        """Γ: the sum of all factors."""
        return sum(choice.energy for choice in self.choices)


@dataclass(frozen=True, slots=True)
class Inferred:
    """The outcome of inference.

    Attributes:
        plans: The plans, cheapest first.
        refused: Why there is no plan for what was said, and the clause where that showed, if it is one clause.
        question: A question to the user, where two readings of the request are about equally good.
    """

    plans: tuple[RankedPlan, ...]
    rejected: tuple[RejectedProposal, ...]
    refused: tuple[int | None, Refusal] | None = None
    question: Question | None = None


def _total(parts: Iterable[Mapping[str, float]]) -> dict[str, float]:
    total: dict[str, float] = {}
    for part in parts:
        for name, value in part.items():
            total[name] = total.get(name, 0.0) + value
    return total


def why_lost(plan: RankedPlan, best: RankedPlan) -> str:
    """Return the factor that cost ``plan`` most against ``best``, and in which clause the two part."""
    gaps = {
        name: plan.factors.get(name, 0.0) - best.factors.get(name, 0.0)
        for name in sorted(plan.factors.keys() | best.factors.keys())
    }
    name, gap = max(gaps.items(), key=lambda item: item[1], default=("", 0.0))
    pairs = enumerate(zip(plan.choices, best.choices, strict=False), start=1)
    clause = next((number for number, (ours, theirs) in pairs if ours.steps != theirs.steps), 0)
    if gap <= 0:
        return f"equal energy; another way for clause {clause}"
    return f"energy {plan.energy - best.energy:+.4g}: {title(name)} {gap:+.4g}, first for clause {clause}"
