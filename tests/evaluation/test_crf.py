"""The rows of the paper's own model on a small part of the bundled data."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tmd.energy.weights import NAMES, named_weights
from tmd.evaluation.crf import Crf, NoLatent
from tmd.evaluation.dataset import BundledData
from tmd.evaluation.folds import given_fold
from tmd.pddl.task import Cube
from tmd.pddl.validator import validate
from tmd.planning.result import Filled, Unreachable

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def data() -> BundledData:
    return BundledData("ramen", "kitchen", ROOT / "domains", ROOT / "problems")


def test_without_latent_nodes_only_what_holds_is_filled() -> None:
    assert NoLatent().fill(0b101, (Cube(0b010), Cube(0b100))) == Filled((), 0b101, 0)
    assert isinstance(NoLatent().fill(0b101, (Cube(0b010),)), Unreachable)


def test_learning_gives_finite_weights_and_the_same_ones_again(data: BundledData) -> None:
    (fold,) = given_fold(data.examples, {2, 4}, {1})
    fits = [
        Crf(most_examples=4, rounds=1, proposals=3).fit(fold.train, data, np.random.default_rng(5)) for _ in range(2)
    ]
    assert fits[0].weights_ == fits[1].weights_
    weights = fits[0].weights_["kitchen"]
    assert all(np.isfinite(weights[name]) and weights[name] >= 0 for name in NAMES)
    assert weights != named_weights("hand_set")
    assert len(fits[0].learned_["kitchen"].curve) == 1


@pytest.mark.parametrize("latent", [True, False])
def test_every_prediction_is_executable(data: BundledData, latent: bool) -> None:
    (fold,) = given_fold(data.examples, None, {3})
    random = np.random.default_rng(0)
    model = Crf(learned=False, latent=latent, beam=2).fit(fold.train, data, random)
    done = 0
    for example in fold.test[:5]:
        predicted = model.predict(example, data, random).instructions
        assert validate(data.world(example.environment).task.problem, predicted).valid
        done += len(predicted)
    assert done > 0


def test_latent_nodes_find_what_was_left_unsaid(data: BundledData) -> None:
    (fold,) = given_fold(data.examples, None, {2})
    random = np.random.default_rng(0)
    lengths = []
    for latent in (True, False):
        model = Crf(learned=False, latent=latent, beam=2).fit(fold.train, data, random)
        lengths.append(sum(len(model.predict(e, data, random).instructions) for e in fold.test[:5]))
    assert lengths[0] > lengths[1]
