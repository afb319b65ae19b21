"""Learning the paper's own model on a few bundled examples: weights, restoring, going on after a kill, its limits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import pytest

from tests import bundled
from tmd.evaluation.models.paper_models import ROWS, Crf
from tmd.evaluation.models.prediction import Prediction, Served
from tmd.evaluation.runs.dataset import BundledData, Example
from tmd.evaluation.runs.folds import given_fold
from tmd.evaluation.runs.jobs import fit_text
from tmd.inference.config import PAPER
from tmd.inference.energy import NAMES, OURS, Weights, named_weights
from tmd.inference.ranking import RankedPlan
from tmd.library.library import Library
from tmd.pddl.task import Cube
from tmd.planning.result import Filled, NoPlanner, Unreachable
from tmd.records.fit import Fit, WorldFit

ROOT = Path(__file__).parents[2]
LATENT = ("latent_description_length", "latent_instruction_prior", "latent_parameter_prior", "latent_inconsistent_end")
ABSENT = {
    "full": OURS,
    "no_latent": (*LATENT, *OURS),
    "no_nl": ("clause_distance", "parameter_cardinality", "inconsistent_end", *OURS),
    "no_domain": ("inconsistent_end", *LATENT, *OURS),
    "paper_extended_learned": ("language_model", "policy_proposal"),
}
"""The factors that a row does not have."""
EXAMPLES = 4
C = TypeVar("C", bound=Crf)


@pytest.fixture(scope="module")
def data() -> BundledData:
    return bundled.data("ramen")


@pytest.fixture(scope="module")
def train(data: BundledData) -> list[Example]:
    """Two demonstrations from each of three kitchens."""
    return [e for n in (2, 4, 5) for e in [x for x in data.examples if x.number == n][:2]]


@pytest.fixture(scope="module")
def test(data: BundledData) -> list[Example]:
    return [e for e in data.examples if e.number == 1][:3]


def row(name: str, journal: Path | None = None) -> Crf:
    model = ROWS[name]()
    model.most_examples, model.rounds, model.proposals, model.journal = EXAMPLES, 1, 3, journal
    return model


def fitted(model: C, train: Sequence[Example], data: BundledData) -> C:
    return model.fit(train, data, np.random.default_rng(5))


def predictions(model: Crf, test: Sequence[Example], data: BundledData) -> list[Prediction]:
    return [model.predict(e, data, np.random.default_rng(0)) for e in test]


def numbers(model: Crf) -> dict[str, list[float]]:
    return {world: [weights[name] for name in NAMES] for world, weights in model.weights_.items()}


def said(example: Example, text: str) -> Example:
    return replace(example, demonstration=replace(example.demonstration, text=text, segments=()))


# ---------------------------------------------------------------- weights


@pytest.mark.parametrize("name", ABSENT)
def test_a_row_weighs_its_own_factors_and_no_others(name: str, data: BundledData, train: list[Example]) -> None:
    model = fitted(row(name), train, data)
    weights = model.weights_["kitchen"]
    assert set(model.factors) == set(NAMES) - set(ABSENT[name])
    assert [weights[factor] for factor in ABSENT[name]] == [0] * len(ABSENT[name])
    assert all(np.isfinite(weights[factor]) and weights[factor] >= 0 for factor in NAMES)
    assert model.learned_["kitchen"].weights == weights
    assert {point["round"] for point in model.learned_["kitchen"].curve} == {1}


@pytest.mark.parametrize("name", ABSENT)
def test_weights_that_are_not_learned_are_those_of_the_start_for_the_same_factors(
    name: str, data: BundledData, train: list[Example]
) -> None:
    model = row(name)
    model.learned = False
    weights = fitted(model, train, data).weights_["kitchen"]
    start = named_weights(model.config.weights)
    assert [weights[f] for f in NAMES] == [0 if f in ABSENT[name] else start[f] for f in NAMES]
    assert fit_text(name, given_fold(data.examples, data.examples, {2}, {1})[0], model) is None


def test_the_same_seed_learns_the_same(data: BundledData, train: list[Example]) -> None:
    one, other = (fitted(row("full"), train, data) for _ in range(2))
    assert one.learned_ == other.learned_


def test_an_example_is_learned_from_without_the_templates_of_its_environment(
    data: BundledData, train: list[Example], monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: list[tuple[str, set[str]]] = []
    plans = Crf._plans

    def spy(self: Crf, example: Example, data: BundledData, taught: Any, *rest: Any, **more: Any) -> object:  # noqa: ANN401
        library: Library = taught.library
        templates = [template for verb in library.verbs() for template in library.templates(verb)]
        seen.append((example.environment, {template.environment for template in templates}))
        return plans(self, example, data, taught, *rest, **more)

    monkeypatch.setattr(Crf, "_plans", spy)
    fitted(row("full"), train, data)
    assert len(seen) == EXAMPLES
    assert all(others and own not in others for own, others in seen)


# ---------------------------------------------------------------- restoring


@pytest.mark.parametrize("name", ["full", "no_nl", "no_domain", "paper"])
def test_a_restored_model_predicts_what_the_fitted_one_did(
    name: str, data: BundledData, train: list[Example], test: list[Example]
) -> None:
    """By way of the file that a run keeps."""
    model = fitted(row(name), train, data)
    text = fit_text(name, given_fold(data.examples, data.examples, {2, 4, 5}, {1})[0], model)
    saved = Fit.from_text(text, "fit.json").worlds if text is not None else {}
    again = row(name).restore(train, data, saved)
    assert numbers(again) == numbers(model)
    expected = predictions(model, test, data)
    assert any(prediction.instructions for prediction in expected)
    assert predictions(again, test, data) == expected


def test_what_is_restored_are_the_weights_that_were_saved(
    data: BundledData, train: list[Example], test: list[Example]
) -> None:
    """With others saved the predictions are others: restoring does not learn again."""
    saved = {"kitchen": WorldFit(weights={"description_length": 1.0}, curve=())}
    model = row("full").restore(train, data, saved)
    assert model.weights_ == {"kitchen": Weights({"description_length": 1.0})}
    assert not any(prediction.instructions for prediction in predictions(model, test, data))


# ---------------------------------------------------------------- a kill, and going on


class KilledError(Exception):
    """The process was killed."""


class Mortal(Crf):
    """Killed when it has proposed plans for ``lives`` examples; counts how often it was asked."""

    lives = EXAMPLES
    asked = 0

    def _plans(self, *args: Any, **more: Any) -> tuple[RankedPlan, ...]:  # noqa: ANN401
        if self.asked == self.lives:
            raise KilledError
        self.asked += 1
        return super()._plans(*args, **more)


@pytest.mark.parametrize("language", [True, False], ids=["full", "no_nl"])
@pytest.mark.parametrize("lives", [0, 1, EXAMPLES - 1])
def test_a_killed_fit_goes_on_where_it_was_and_learns_the_same(
    lives: int, language: bool, data: BundledData, train: list[Example], tmp_path: Path
) -> None:
    def mortal(lives: int) -> Mortal:
        model = Mortal(
            replace(PAPER, language=language),
            most_examples=EXAMPLES,
            rounds=1,
            proposals=3,
        )
        model.journal = tmp_path / "fit.journal.jsonl"
        model.lives = lives
        return model

    with pytest.raises(KilledError):
        fitted(mortal(lives), train, data)
    again = fitted(mortal(EXAMPLES), train, data)
    assert again.asked == EXAMPLES - lives
    assert again.learned_ == fitted(row("full" if language else "no_nl"), train, data).learned_


# ---------------------------------------------------------------- what was not trained


@pytest.mark.parametrize("name", ["full", "no_latent", "no_domain"])
def test_a_verb_without_training_data_is_passed_over_and_the_rest_is_served(
    name: str, data: BundledData, test: list[Example]
) -> None:
    model = row(name)
    model.learned = False
    fitted(model, test[:1], data)
    fill, stove = (segment.instructions for segment in test[0].demonstration.segments[:2])
    text = "Fill the pot with water. Sing a song. Set it on the stove."
    served = model.predict(said(test[0], text), data, np.random.default_rng(0)).served
    assert [s.verb for s in served] == ["fill", "sing", "set"]
    assert [s.said for s in served] == [fill, (), stove]
    assert served[1] == Served("Sing a song", "sing")


@pytest.mark.parametrize("name", ["full", "no_nl", "no_domain", "no_latent"])
def test_nothing_is_predicted_in_a_kind_of_world_that_was_not_trained(
    name: str, data: BundledData, train: list[Example], test: list[Example]
) -> None:
    model = fitted(row(name), train[:2], data)
    elsewhere = replace(test[0], world="living_room")
    assert model.predict(elsewhere, data, np.random.default_rng(0)) == Prediction()
    assert model.plans(elsewhere, data, top=3) == ()
    assert fitted(row(name), [], data).predict(test[0], data, np.random.default_rng(0)) == Prediction()


@pytest.mark.parametrize("text", ["", "!?"])
def test_a_text_without_clauses_asks_for_nothing(
    text: str, data: BundledData, train: list[Example], test: list[Example]
) -> None:
    model = row("full")
    model.learned = False
    assert fitted(model, train, data).predict(said(test[0], text), data, np.random.default_rng(0)) == Prediction()


@pytest.mark.parametrize("text", ["the pot", "a clean pot."])
def test_a_bare_noun_phrase_is_served_as_a_verb_that_was_left_out(
    text: str, data: BundledData, train: list[Example], test: list[Example]
) -> None:
    model = row("full")
    model.learned = False
    predicted = fitted(model, train, data).predict(said(test[0], text), data, np.random.default_rng(0))
    assert predicted == Prediction(served=(Served(text.rstrip("."), "have"),))


# ---------------------------------------------------------------- the parts


def test_without_latent_nodes_only_what_holds_is_filled() -> None:
    assert NoPlanner().fill(0b101, (Cube(0b010), Cube(0b100))) == Filled((), 0b101, 0)
    assert isinstance(NoPlanner().fill(0b101, (Cube(0b010),)), Unreachable)


def test_several_plans_are_given_cheapest_first(data: BundledData, train: list[Example], test: list[Example]) -> None:
    model = row("full")
    model.learned = False
    plans = fitted(model, train, data).plans(test[0], data, top=3)
    assert len({plan.instructions for plan in plans}) == 3
    assert [plan.energy for plan in plans] == sorted(plan.energy for plan in plans)
    assert model.predict(test[0], data, np.random.default_rng(0)).instructions == plans[0].instructions
