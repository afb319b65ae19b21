"""Weights are learned from corrections: the plan that was corrected must cost more than what the person made of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TypedDict, Unpack

import numpy as np
import pytest

from tests import bundled
from tmd.evaluation.models import paper_models
from tmd.evaluation.models.paper_models import Crf, loss
from tmd.evaluation.runs.dataset import BundledData, Example
from tmd.inference.config import PAPER_EXTENDED
from tmd.inference.energy import Weights, named_weights
from tmd.inference.weight_learning import Journal, Learned, Propose, learn_weights
from tmd.pddl.model import Instruction
from tmd.world.demonstration import Demonstration, Segment

ROOT = Path(__file__).parents[2]
TEXT = "Take the mug and put it on the table."


class Options(TypedDict):
    """Options of learning."""

    factors: tuple[str, ...]
    rounds: int
    journal: Journal | None


@pytest.fixture(scope="module")
def data() -> BundledData:
    return bundled.data("ramen")


def correction(name: str, done: Sequence[Instruction], proposed: Sequence[Instruction] | None) -> Example:
    half = len(TEXT) - 1
    mine = None if proposed is None else tuple(proposed)
    segments = (Segment(0, half, tuple(done)),)
    demonstration = Demonstration(name, "own", "kitchen1", TEXT, segments, (), mine)
    return Example(name, "own", "kitchen", "kitchen1", 1, demonstration)


def test_a_correction_pushes_the_weights_from_the_plan_it_corrects(
    data: BundledData, monkeypatch: pytest.MonkeyPatch
) -> None:
    lessons = list(data.examples)[::6][:8]
    model = Crf(PAPER_EXTENDED, learned=False).fit(lessons, data, np.random.default_rng(0))
    asked = correction("asked", (), None)
    first, second = (plan for plan in model.plans(asked, data, top=2))
    corrected = correction("corrected", second.instructions, first.instructions)
    seen: list[tuple[Propose, int]] = []

    def listen(
        propose: Propose, examples: int, start: Weights, random: np.random.Generator, **options: Unpack[Options]
    ) -> Learned:
        seen.append((propose, examples))
        return learn_weights(propose, examples, start, random, **options)

    monkeypatch.setattr(paper_models, "learn_weights", listen)
    learner = Crf(PAPER_EXTENDED, most_examples=2, rounds=1)
    learner.fit([*lessons, corrected], data, np.random.default_rng(0))
    ((propose, count),) = seen
    assert count == 2
    start, learned = named_weights("paper_extended"), learner.weights_["kitchen"]
    rows = [propose(number, start) for number in range(count)]
    pairs = [(plan.instructions, lost) for row in rows for plan, lost in row]
    assert (first.instructions, 1.0) in pairs
    assert min(lost for done, lost in pairs if done == second.instructions) < 0.001

    def gap(weights: Weights) -> float:
        raw = [sum(weights[name] * value for name, value in plan.raw.items()) for plan in (first, second)]
        return (raw[0] - raw[1]) / (abs(raw[0]) + abs(raw[1]))

    assert gap(start) < 0
    assert gap(learned) > gap(start)


def test_only_the_plan_that_was_corrected_is_as_far_off_as_can_be(data: BundledData) -> None:
    lessons = list(data.examples)[::6][:8]
    model = Crf(PAPER_EXTENDED, learned=False).fit(lessons, data, np.random.default_rng(0))
    first, second = model.plans(correction("asked", (), None), data, top=2)
    world = data.world("kitchen1")
    plain, corrected = (correction("x", second.instructions, proposed) for proposed in (None, first.instructions))
    assert loss(first, corrected, world) == 1.0 > loss(first, plain, world)
    assert loss(second, corrected, world) == loss(second, plain, world) < 0.001
    assert loss(replace(first, choices=first.choices[:1]), corrected, world) < 1.0
