"""Proposers: what stands beside the templates, and that nothing of a text is kept between calls."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

from tmd.inference.config import PAPER, POLICY
from tmd.inference.energy import Energy, Factors, count, named_weights
from tmd.inference.goal_pass import Inference
from tmd.inference.proposers import Instructions, Proposal, Proposer, Situation, proposers_of
from tmd.inference.ranking import Inferred, RankedPlan
from tmd.language import parse
from tmd.language.clause import Clause
from tmd.library.library import Library, learn
from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits
from tmd.planning.backends import IN_PROCESS, TaskPlanners, make
from tmd.world.corpus import Corpus
from tmd.world.folder import DomainFolder
from tmd.world.world import World

ROOT = Path(__file__).parents[2]
TEXTS = ("Put the book on the table.", "Take the cup and put it on the shelf.", "Put the cup on the table.")


@cache
def table() -> tuple[World, Library]:
    corpus = Corpus(DomainFolder(ROOT / "domains" / "02_table"), ROOT / "problems" / "02_table")
    return corpus.world("corner1"), learn(corpus.demonstrations(), corpus.world, corpus.lexicon)


def energy() -> Energy:
    world, library = table()
    return Energy(named_weights("policy"), count(library), world)


def inference(*proposers: Proposer) -> Inference:
    world, library = table()
    own = proposers or tuple(proposers_of(POLICY, world, library, energy()))
    return Inference(world, energy(), TaskPlanners(world.task, make(IN_PROCESS, world.task)), own, POLICY)


def inferred(by: Inference, text: str) -> Inferred:
    world, library = table()
    return by.infer_clauses(parse(text, library.lexicon).clauses, world.task.init, top=3)


def test_one_inference_may_be_asked_by_several_threads() -> None:
    expected = [inferred(inference(), text) for text in TEXTS]
    shared = inference()
    with ThreadPoolExecutor(len(TEXTS)) as pool:
        found = list(pool.map(lambda text: inferred(shared, text), TEXTS * 3))
    assert found == expected * 3


def test_a_model_without_a_policy_has_templates_only() -> None:
    world, library = table()
    for config in (PAPER, POLICY):
        assert len(proposers_of(config, world, library, energy())) == 1
    assert len(proposers_of(POLICY, world, library, energy(), Always(()))) == 2
    assert len(proposers_of(PAPER, world, library, energy(), Always(()))) == 1


class Always:
    """A policy that has one answer."""

    def __init__(self, answer: Instructions) -> None:
        self.answer = answer

    def knows(self, verb: str) -> bool:
        """Every verb."""
        return True

    def best(
        self, clause: Clause, earlier: Sequence[Clause], done: Sequence[Instruction], count: int
    ) -> Sequence[tuple[float, Instructions]]:
        """The answer."""
        return [(0.0, self.answer)]

    def surprise(
        self,
        clause: Clause,
        earlier: Sequence[Clause],
        done: Sequence[Instruction],
        instructions: Sequence[Instruction],
    ) -> float:
        """Anything else surprises."""
        return float(instructions != self.answer)


@pytest.mark.parametrize("guess", [False, True])
def test_nothing_is_proposed_for_a_verb_without_templates_unless_the_model_guesses(guess: bool) -> None:
    world, library = table()
    answer = (first(world),)
    proposers = proposers_of(replace(POLICY, guess=guess), world, library, energy(), Always(answer))
    plan = inferred(inference(*proposers), "Hide the cup on the shelf.").plans[0]
    assert plan.instructions == (answer if guess else ())


def test_what_few_demonstrations_taught_is_trusted_less() -> None:
    world, library = table()
    taught = len(library)

    def plan(few: float) -> RankedPlan:
        config = replace(POLICY, few=few, guess=True)
        policy = Always((first(world),))
        return inferred(inference(*proposers_of(config, world, library, energy(), policy)), "Hide the cup.").plans[0]

    assert plan(0).raw["policy_proposal"] == 1
    assert plan(taught).raw["policy_proposal"] == 2


def first(world: World) -> Instruction:
    """An instruction that can be done at once."""
    return next(o.instruction for o in world.task.operators if o.applicable(world.task.init))


class Own(Proposer):
    """Somebody else's proposer: always the same instructions, and a dislike of everything else."""

    def __init__(self, instructions: Instructions) -> None:
        self.instructions = instructions

    def propose(self, situation: Situation) -> Iterator[Proposal]:
        """The one sequence."""
        yield Proposal("own", self.instructions, (), {}, 0.0)

    def judge(self, situation: Situation, instructions: Instructions, end: Bits) -> Factors:
        """Under the name of a factor that has a weight."""
        return {"language_model": float(instructions != self.instructions)}


def test_another_proposer_needs_nothing_but_to_be_given() -> None:
    world, library = table()
    own = Own((first(world),))
    plan = inferred(inference(own, *proposers_of(PAPER, world, library, energy())), TEXTS[0]).plans[0]
    assert (plan.choices[0].source, plan.instructions) == ("own", (first(world),))
    assert plan.raw["language_model"] == 0
