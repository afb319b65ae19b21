"""Deciding by expected loss: the loss by hand, what may be chosen, and the draws of a policy."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from functools import cache
from math import exp, sqrt
from pathlib import Path

import numpy as np
import pytest

from tmd.ground import ground
from tmd.grounded import Grounded
from tmd.inference.bayes_risk import RISK, SAMPLE_SOURCE, expected_losses
from tmd.inference.config import BAYES_RISK, GOALS, InferenceConfig
from tmd.inference.policy.model import Policy
from tmd.knowledge import Knowledge, study
from tmd.language import parse
from tmd.pddl.model import Instruction
from tmd.pddl.validator import validate
from tmd.world.corpus import Corpus
from tmd.world.folder import DomainFolder
from tmd.world.world import World

ROOT = Path(__file__).parents[2]
TEXT = "Take the cup and put it on the shelf."
NOT_DECLARED = replace(BAYES_RISK, sources=(), guess=True)
"""No clause has a goal, so whatever is drawn may be chosen."""


@cache
def table() -> tuple[World, Knowledge]:
    corpus = Corpus(DomainFolder(ROOT / "domains" / "02_table"), ROOT / "problems" / "02_table")
    return corpus.world("corner1"), study(corpus)


def decided(text: str, config: InferenceConfig = BAYES_RISK, top: int = 1) -> Grounded:
    world, knowledge = table()
    return ground(text, world, knowledge.library, reward=knowledge.reward, config=config, top=top)


def policy() -> Policy:
    world, knowledge = table()
    assert knowledge.reward is not None
    return Policy(knowledge.reward, world)


def steps(*lines: str) -> tuple[Instruction, ...]:
    return tuple(Instruction(name, tuple(args)) for name, *args in map(str.split, lines))


def test_the_loss_is_half_of_the_sequences_and_half_of_the_ends() -> None:
    world, _ = table()
    shelved = steps("grasp cup1", "keep cup1 shelf1 on")
    held = steps("grasp cup1")
    # against itself nothing is lost; one of two instructions is missing, and in the end the cup is in the hand
    # (holding, not free, on no table: 3 changes) rather than on the shelf (2 changes), of which one is the same
    nothing, one = expected_losses([shelved, held], [shelved], world)
    assert nothing == 0
    assert one == pytest.approx(0.5 * (1 - 1 / 2) + 0.5 * (1 - 1 / 4))
    # half of the people do the one, half the other
    mean = expected_losses([shelved], [shelved, held], world)
    assert mean == pytest.approx([one / 2])


def test_people_who_do_nothing_are_met_by_doing_nothing() -> None:
    world, _ = table()
    losses = expected_losses([(), steps("grasp cup1")], [()], world)
    assert losses.tolist() == [0, 1]


def test_draws_are_as_frequent_as_they_are_likely() -> None:
    _, knowledge = table()
    clauses = parse(TEXT, knowledge.library.lexicon).clauses[:1]
    by, count = policy(), 3000
    drawn = Counter(sequence[0] for sequence in by.sample(clauses, count, np.random.default_rng(1)))
    common = drawn.most_common(3)
    assert len(common) == 3
    for sequence, times in common:
        likely = exp(-by.surprise(clauses, 0, (), sequence) * (len(sequence) + 1))
        assert abs(times / count - likely) < 5 * sqrt(likely * (1 - likely) / count), (sequence, times, likely)


def test_draws_depend_on_the_seed_alone() -> None:
    _, knowledge = table()
    clauses = parse(TEXT, knowledge.library.lexicon).clauses
    first, again, other = (policy().sample(clauses, 40, np.random.default_rng(seed)) for seed in (3, 3, 4))
    assert first == again
    assert first != other
    assert {len(sequence) for sequence in first} == {len(clauses)}


def test_plans_come_in_the_order_of_their_risk() -> None:
    plans = decided(TEXT, NOT_DECLARED, top=5).plans
    risks = [plan.factors[RISK] for plan in plans]
    assert len(plans) == 5
    assert risks == sorted(risks)
    assert len({plan.instructions for plan in plans}) == 5
    assert decided(TEXT, NOT_DECLARED).plans[0] == plans[0]


def test_what_is_drawn_is_made_executable_before_it_may_be_chosen() -> None:
    world, _ = table()
    plans = decided(TEXT, NOT_DECLARED, top=30).plans
    drawn = [plan for plan in plans if any(choice.source == SAMPLE_SOURCE for choice in plan.choices)]
    assert drawn
    assert all(validate(world.task.problem, plan.instructions).valid for plan in plans)


def test_only_plans_of_inference_are_chosen_from_where_drawn_ones_are_no_candidates() -> None:
    plans = decided(TEXT, replace(NOT_DECLARED, drawn_candidates=False), top=30).plans
    assert plans
    assert not any(choice.source == SAMPLE_SOURCE for plan in plans for choice in plan.choices)


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        (TEXT, {"(at cup1 shelf1 on)": True}),
        ("Clear the table.", {"(at cup1 table1 on)": False}),
        ("Take the cup.", {"(holding pr2 cup1)": True}),
    ],
)
def test_what_is_declared_is_reached_however_unlikely(text: str, wanted: dict[str, bool]) -> None:
    world, _ = table()
    plans = decided(text, top=5).plans
    assert plans
    for plan in plans:
        verdict = validate(world.task.problem, plan.instructions, trace=True)
        assert verdict.valid
        end = set(map(str, verdict.trace[-1]))
        assert {atom: atom in end for atom in wanted} == wanted


def test_what_goals_refuse_is_refused() -> None:
    text = "Put the piano on the shelf."
    refused = decided(text).refused
    assert refused is not None
    assert refused == decided(text, GOALS).refused
    assert decided(text).plans == ()
