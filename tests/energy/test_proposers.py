"""Proposers: what stands beside the templates, and that nothing of a text is kept between calls."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cache
from pathlib import Path

from tmd.energy.algorithm1 import Inference
from tmd.energy.config import GOALS, PAPER
from tmd.energy.energy import Energy, Factors
from tmd.energy.plans import Choice, Inferred
from tmd.energy.proposers import Candidate, Instructions, Proposer, Situation, proposers_of
from tmd.energy.statistics import count
from tmd.energy.weights import named_weights
from tmd.language import parse
from tmd.pddl.task import Bits, Cube
from tmd.planning.backends import IN_PROCESS, make
from tmd.planning.result import Answer, Filled, GaveUp, Planner
from tmd.veil.corpus import Corpus
from tmd.veil.library import Library, learn
from tmd.veil.world import World
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).parents[2]
TEXTS = ("Put the book on the table.", "Take the cup and put it on the shelf.", "Put the cup on the table.")


@cache
def table() -> tuple[World, Library]:
    corpus = Corpus(DomainFolder(ROOT / "domains" / "02_table"), ROOT / "problems" / "02_table")
    return corpus.world("corner1"), learn(corpus.demonstrations(), corpus.world, corpus.lexicon)


def energy() -> Energy:
    world, library = table()
    return Energy(named_weights("goals"), count(library), world)


def inference(*proposers: Proposer, planner: Planner | None = None) -> Inference:
    world, library = table()
    own = proposers or tuple(proposers_of(GOALS, world, library, energy()))
    return Inference(world, energy(), planner or make(IN_PROCESS, world.task), own, GOALS)


def inferred(by: Inference, text: str) -> Inferred:
    world, library = table()
    return by.infer(parse(text, library.lexicon).clauses, world.task.init, top=3)


def test_one_inference_may_be_asked_by_several_threads() -> None:
    expected = [inferred(inference(), text) for text in TEXTS]
    shared = inference()
    with ThreadPoolExecutor(len(TEXTS)) as pool:
        found = list(pool.map(lambda text: inferred(shared, text), TEXTS * 3))
    assert found == expected * 3


def test_a_model_without_goals_has_templates_only() -> None:
    world, library = table()
    assert len(proposers_of(PAPER, world, library, energy())) == 1
    assert len(proposers_of(GOALS, world, library, energy())) == 2


def test_nothing_is_proposed_for_a_verb_without_templates_unless_the_model_guesses() -> None:
    world, library = table()
    clause = "Hide the cup on the shelf."
    assert inferred(inference(), clause).plans[0].instructions == ()
    guessing = proposers_of(replace(GOALS, guess=True), world, library, energy())
    plan = inferred(inference(*guessing), clause).plans[0]
    assert "(at cup1 shelf1 on)" in {str(atom) for atom in world.task.decode(plan.state)}


class Nobody:
    """A planner that gives up on everything that does not hold already."""

    def fill(self, state: Bits, goal: Sequence[Cube]) -> Answer:
        """Nothing, or giving up."""
        return Filled((), state, 0) if any(cube.holds(state) for cube in goal) else GaveUp("0 generated states")


def test_the_last_resort_is_asked_where_the_planner_gave_up_and_nothing_else_leads_there() -> None:
    world, library = table()
    taken = library.filtered(
        lambda template: template.source == "set_table-corner1-02"
    )  # the book is in the hand there
    asked: list[int] = []

    def last() -> Planner:
        asked.append(1)
        return make(IN_PROCESS, world.task)

    def end(*, last_resort: bool) -> set[str]:
        proposers = proposers_of(replace(GOALS, last_resort=last_resort), world, taken, energy(), None, last)
        plan = inferred(inference(*proposers, planner=Nobody()), TEXTS[0]).plans[0]
        return {str(atom) for atom in world.task.decode(plan.state)}

    assert "(at book1 table1 on)" not in end(last_resort=False)
    assert not asked
    assert "(at book1 table1 on)" in end(last_resort=True)
    assert asked == [1]


class Own(Proposer):
    """Somebody else's proposer: always the same instructions, and a dislike of everything else."""

    def __init__(self, instructions: Instructions) -> None:
        self.instructions = instructions

    def propose(self, situation: Situation) -> Iterator[Candidate]:
        """The one sequence."""
        yield Candidate("own", self.instructions, (), {}, 0.0)

    def judge(self, situation: Situation, instructions: Instructions, end: Bits) -> Factors:
        """Under the name of a factor that has a weight."""
        return {"words": float(instructions != self.instructions)}

    def resort(
        self, situation: Situation, choices: Collection[Choice], given_up: Collection[Candidate]
    ) -> Iterator[tuple[Candidate, Instructions]]:
        """Nothing more."""
        yield from ()


def test_another_proposer_needs_nothing_but_to_be_given() -> None:
    world, library = table()
    first = next(o.instruction for o in world.task.operators if o.applicable(world.task.init))
    own = Own((first,))
    plan = inferred(inference(own, *proposers_of(PAPER, world, library, energy())), TEXTS[0]).plans[0]
    assert (plan.choices[0].source, plan.instructions) == ("own", (first,))
    assert plan.raw["words"] == 0
