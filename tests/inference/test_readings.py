"""Several candidate goals for a step: the prior is a factor, the beam follows all, and the losers are reported."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import pytest

from tmd.diagnostics import Refusal, RefusalKind
from tmd.inference.commitments import constrained, violated
from tmd.inference.config import GOALS
from tmd.inference.energy import Energy, count, named_weights
from tmd.inference.goal_pass import Inference
from tmd.inference.proposers import proposers_of
from tmd.inference.ranking import Inferred, RankedPlan
from tmd.language.clause import Clause, Parsed
from tmd.library.library import Library
from tmd.pddl.ground_formula import goal_cubes, instantiated
from tmd.pddl.model import Formula
from tmd.pddl.reading.reader import with_goal
from tmd.pddl.task import Bits
from tmd.planning.backends import FAST_DOWNWARD, IN_PROCESS, TaskPlanners, make
from tmd.planning.result import Filled
from tmd.readers.interface import (
    CandidateGoal,
    HandledGroup,
    PlanConstraints,
    Question,
    Step,
    StepGoals,
    Usage,
)
from tmd.world.corpus import Corpus
from tmd.world.folder import DomainFolder
from tmd.world.world import World

ROOT = Path(__file__).parents[2]
CUP, BOOK = "(at cup1 shelf1 on)", "(at book1 table1 on)"
BOTH_HELD = "(and (holding pr2 cup1) (holding pr2 book1))"


@cache
def world() -> World:
    """A cup on the table, a book on the shelf."""
    return Corpus(DomainFolder(ROOT / "domains" / "02_table"), ROOT / "problems" / "02_table").world("corner1")


def formula(text: str) -> Formula:
    return instantiated(world().task, with_goal(world().task.problem, text).goal)


def candidate(text: str, belief: float) -> CandidateGoal:
    goal = formula(text)
    return CandidateGoal(goal, goal_cubes(world().task, goal), math.log(belief), explanation=text)


@dataclass
class Fake:
    """A dialogue with given candidates for each step; it remembers in which order goals were reached."""

    candidates: Sequence[Sequence[CandidateGoal] | Refusal]
    constraints: PlanConstraints = field(default_factory=PlanConstraints)
    memory: object = ()
    refusal: Refusal | None = None
    question: Question | None = None
    notes: Sequence[str] = ()
    usage: Usage | None = None
    asks: bool = True

    @property
    def clauses(self) -> tuple[Clause, ...]:
        return tuple(Clause("put", text=f"step {number}") for number in range(len(self.candidates)))

    @property
    def parsed(self) -> Parsed:
        return Parsed("", self.clauses)

    @property
    def steps(self) -> tuple[Step, ...]:
        return tuple(Step(clause, number) for number, clause in enumerate(self.clauses))

    def goals(self, step: Step, state: Bits, memory: object) -> StepGoals | Refusal:
        own = self.candidates[step.number]
        return own if isinstance(own, Refusal) else StepGoals(tuple(own), memory)

    def reached(self, goal: CandidateGoal, state: Bits, memory: object) -> object:
        assert isinstance(memory, tuple)
        return (*memory, goal.explanation)

    def handled(self, step: Step) -> Sequence[HandledGroup] | None:
        return None


def infer(dialogue: Fake, top: int = 1, chosen: dict[int, Formula] | None = None) -> Inferred:
    library = Library(world().mentions.lexicon)
    energy = Energy(named_weights("goals"), count(library), world())
    proposers = proposers_of(GOALS, world(), library, energy)
    planners = TaskPlanners(world().task, make(IN_PROCESS, world().task))
    return Inference(world(), energy, planners, proposers, GOALS).infer(dialogue, world().task.init, top, chosen)


def reached(plan: RankedPlan) -> list[str]:
    return [goal.row for goal in plan.goals]


@pytest.mark.parametrize(("belief", "winner"), [(0.9, CUP), (0.1, BOOK)])
def test_the_prior_decides_between_goals_that_cost_the_same(belief: float, winner: str) -> None:
    found = infer(Fake([[candidate(CUP, belief), candidate(BOOK, 1 - belief)]]))
    assert reached(found.plans[0]) == [winner]
    assert found.plans[0].raw["reading_prior"] == pytest.approx(-math.log(max(belief, 1 - belief)))


def test_the_loser_and_the_reason_are_reported() -> None:
    found = infer(Fake([[candidate(CUP, 0.9), candidate(BOOK, 0.1)]]))
    (other,) = found.plans[0].goals[0].others
    assert (other.row, other.formula) == (BOOK, formula(BOOK))
    assert other.why.startswith("energy +")


def test_a_goal_that_cannot_be_reached_loses_whatever_its_prior() -> None:
    found = infer(Fake([[candidate(BOTH_HELD, 0.99), candidate(CUP, 0.01)]]))
    assert reached(found.plans[0]) == [CUP]
    (other,) = found.plans[0].goals[0].others
    assert "cannot be done here" in other.why


def test_where_none_can_be_reached_the_likeliest_says_why() -> None:
    found = infer(Fake([[candidate(BOTH_HELD, 0.9), candidate("(and (at cup1 shelf1 on) (holding pr2 cup1))", 0.1)]]))
    assert not found.plans and found.refused is not None
    assert found.refused[1].kind is RefusalKind.IMPOSSIBLE


def test_a_reading_that_a_later_step_needs_is_still_followed() -> None:
    """The likelier first reading holds the cup; then nothing else can be held."""
    first = [candidate("(holding pr2 cup1)", 0.9), candidate(CUP, 0.1)]
    found = infer(
        Fake([first, [candidate(BOTH_HELD, 0.5), candidate("(and (holding pr2 book1) (at cup1 shelf1 on))", 0.5)]])
    )
    assert reached(found.plans[0])[1] == "(and (holding pr2 book1) (at cup1 shelf1 on))"


def test_nearly_equal_readings_are_asked_about() -> None:
    found = infer(Fake([[candidate(CUP, 0.5), candidate(BOOK, 0.5)]]))
    assert found.question is not None and found.question.step == 0
    assert {option.formula for option in found.question.options} == {formula(CUP), formula(BOOK)}
    assert found.question.options[0].formula == found.plans[0].goals[0].formula
    assert infer(Fake([[candidate(CUP, 0.99), candidate(BOOK, 0.01)]])).question is None


def test_the_answer_decides() -> None:
    for text in (CUP, BOOK):
        found = infer(Fake([[candidate(CUP, 0.5), candidate(BOOK, 0.5)]]), chosen={0: formula(text)})
        assert reached(found.plans[0]) == [text] and found.question is None


def test_one_candidate_has_no_prior_among_its_factors() -> None:
    found = infer(Fake([[candidate(CUP, 1.0)]]))
    assert "reading_prior" not in found.plans[0].raw and found.plans[0].goals[0].others == ()


def test_the_memory_belongs_to_the_reading() -> None:
    seen: list[object] = []

    class Watching(Fake):
        def goals(self, step: Step, state: Bits, memory: object) -> StepGoals | Refusal:
            seen.append(memory)
            return super().goals(step, state, memory)

    infer(Watching([[candidate(CUP, 0.5), candidate(BOOK, 0.5)], [candidate("(holding pr2 cup1)", 1.0)]]))
    assert set(seen) == {(), (CUP,), (BOOK,)}


def test_a_forbidden_condition_is_brought_about_by_no_plan() -> None:
    never = PlanConstraints(never=(formula("(holding pr2 cup1)"),))
    found = infer(Fake([[candidate(CUP, 1.0)]], never))
    assert not found.plans and found.refused is not None
    assert infer(Fake([[candidate(BOOK, 1.0)]], never)).plans


def test_an_untouched_object_is_in_no_plan() -> None:
    untouched = PlanConstraints(untouched=frozenset({"book1"}))
    found = infer(Fake([[candidate("(or (holding pr2 cup1) (holding pr2 book1))", 1.0)]], untouched))
    assert all("book1" not in instruction.args for instruction in found.plans[0].instructions)
    assert not infer(Fake([[candidate(BOOK, 1.0)]], untouched)).plans


@pytest.mark.parametrize("name", [IN_PROCESS, FAST_DOWNWARD])
@pytest.mark.parametrize("never", ["(holding pr2 cup1)", "(and (at book1 shelf1 on) (holding pr2 cup1))"])
def test_every_planner_respects_what_a_request_forbids(name: str, never: str) -> None:
    own = world().task
    task = constrained(own, PlanConstraints(never=(formula(never),)))
    planners = TaskPlanners(own, make(name, own), name)
    for planner in (planners.quick(task), planners.resort(task)):
        answer = planner.fill(own.init, goal_cubes(own, formula(CUP)))
        if "and" not in never:
            assert not isinstance(answer, Filled)
            continue
        assert isinstance(answer, Filled)
        states = [own.init]
        for instruction in answer.plan:
            states.append(task.by_instruction[instruction].apply(states[-1]))
        assert violated(own, PlanConstraints(never=(formula(never),)), states) is None
