"""Subject of a page: a plan in an environment, and its origin as far as it is known."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from tmd.grounded import Grounded
from tmd.inference.ranking import RankedPlan, RejectedProposal, StepGoal
from tmd.language.clause import Parsed
from tmd.pddl.model import Instruction, Problem
from tmd.records.run import RanStep
from tmd.view.goals import doubts
from tmd.view.meaning import Meaning, meanings, meanings_in
from tmd.world.world import World

# Characters of a text that a title shows.
_TITLE = 90


@dataclass(frozen=True, slots=True)
class PlannedStep:
    """An instruction, and what it is for. ``origin`` is ``clause 2``; empty without a text."""

    instruction: Instruction
    origin: str = ""
    words: str = ""
    latent: bool = False


@dataclass(frozen=True, slots=True)
class Said:
    """A text, and what was made of it.

    ``meant`` has for every clause what its nouns mean; ``None`` where that is not known.
    """

    parsed: Parsed
    meant: tuple[Meaning, ...] | None = None
    unseen: tuple[str, ...] = ()
    unknown: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Ran:
    """Execution of a plan by a robot.

    ``status`` is ``done``, ``recovered``, ``stopped`` …, or ``unfinished`` where its log has no end; ``seconds`` are
    simulated.
    """

    status: str
    reason: str = ""
    repairs: int = 0
    seconds: float = 0.0
    steps: tuple[RanStep, ...] = ()

    def of(self, number: int, last: int) -> list[RanStep]:
        """Return the steps that belong to place ``number`` of a plan of ``last``."""
        return [step for step in self.steps if min(max(step.number, 1), last) == number]


@dataclass(frozen=True, slots=True)
class Subject:
    """A plan to show.

    Attributes:
        plans: All ranked plans, the one shown first; empty where nothing was ranked.
        strip: The filmstrip of that, as a ``data:`` address; empty without one.
        refused: The reason why there is no plan; empty where there is one, or where it is not known.
    """

    title: str
    problem: Problem
    steps: tuple[PlannedStep, ...]
    said: Said | None = None
    plans: tuple[RankedPlan, ...] = ()
    refusals: tuple[RejectedProposal, ...] = ()
    ran: Ran | None = None
    strip: str = ""
    made: tuple[tuple[str, str], ...] = ()
    refused: str = ""
    doubts: tuple[str, ...] = ()

    @property
    def planned(self) -> bool:
        """Return whether there is a plan; it has no steps where nothing is to be done."""
        return bool(self.steps or self.plans or not (self.said or self.refused))

    @property
    def goals(self) -> tuple[StepGoal, ...]:
        """Goals of the steps of the text, for the plan that is shown."""
        return self.plans[0].goals if self.plans else ()


def planned_steps(plan: RankedPlan, words: Sequence[str] = ()) -> list[PlannedStep]:
    """Return the steps of a plan, each with its clause; ``words`` are those of each clause."""
    return [
        PlannedStep(step.instruction, f"clause {step.clause + 1}", words[step.clause] if words else "", step.latent)
        for step in plan.steps
    ]


def title_of(text: str, environment: str) -> str:
    """Return the title of a page about a text."""
    flat = " ".join(text.split())
    short = flat if len(flat) <= _TITLE else f"{flat[: _TITLE - 1].rstrip()}…"
    return f"{short} ({environment})"


def text_subject(grounded: Grounded) -> Subject:
    """Return the subject of a grounded text: its best plan beside the others, or why there is none."""
    return grounded_subject(
        title_of(grounded.parsed.text, grounded.world.name),
        grounded.world,
        grounded.parsed,
        grounded.plans,
        grounded.rejected,
        unseen=grounded.unseen,
        unknown=grounded.unknown,
        refused=grounded.refusal,
    )


def grounded_subject(
    title: str,
    world: World,
    parsed: Parsed,
    plans: Sequence[RankedPlan],
    refusals: Sequence[RejectedProposal] = (),
    *,
    unseen: Iterable[str] = (),
    unknown: Iterable[str] = (),
    made: Iterable[tuple[str, str]] = (),
    ran: Ran | None = None,
    strip: str = "",
    refused: str = "",
) -> Subject:
    """Return the best plan of a grounded text; without any plan the text alone."""
    problem = world.task.problem
    meant = meanings(parsed, plans[0], world) if plans else meanings_in(parsed.clauses, (), world)
    words = [" ".join(clause.text.split()) for clause in parsed.clauses]
    steps = planned_steps(plans[0], words) if plans else []
    return Subject(
        title,
        problem,
        tuple(steps),
        Said(parsed, tuple(meant), tuple(unseen), tuple(unknown)),
        tuple(plans),
        tuple(refusals),
        ran,
        strip,
        tuple(made),
        refused,
        tuple(doubts(parsed, plans[0], world)) if plans else (),
    )
