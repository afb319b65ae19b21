"""The row ``ranked``: what it may choose from, and that its weights choose."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from tmd.evaluation.models.ranked import FEATURES, PROPOSERS, Candidates, Ranked
from tmd.evaluation.runs.dataset import BundledData, Example
from tmd.pddl.validator import validate

ROOT = Path(__file__).parents[2]


@cache
def pantries() -> tuple[BundledData, Example, Ranked]:
    """The data, the demonstration in the second pantry, and the row as those of the first teach it."""
    data = BundledData("all", "04_tea", ROOT / "domains", ROOT / "problems")
    train = [e for e in data.examples if e.number == 1]
    (test,) = (e for e in data.examples if e.number == 2)
    return data, test, Ranked().fit(train, data, np.random.default_rng(0))


@cache
def candidates() -> Candidates:
    data, test, row = pantries()
    return row.candidates(test, data)


def test_every_candidate_can_be_done() -> None:
    data, test, _ = pantries()
    problem = data.world(test.environment).task.problem
    assert len(candidates().plans) > 4
    assert all(validate(problem, plan).valid for plan in candidates().plans)


def test_every_proposer_has_candidates_and_each_is_someones() -> None:
    proposed = candidates().proposed
    assert set(proposed) == set(PROPOSERS) and all(proposed.values())
    assert {number for own in proposed.values() for number in own} == set(range(len(candidates().plans)))


def test_only_differences_between_candidates_count() -> None:
    features = candidates().features
    assert features.shape == (len(candidates().plans), len(FEATURES))
    assert features.mean(axis=0) == pytest.approx(0)


@pytest.mark.parametrize("proposer", ["goals", "policy"])
def test_the_weights_choose(proposer: str) -> None:
    data, test, row = pantries()
    chosen = Ranked({f"first of {proposer}": 1.0, f"of {proposer}": 0.1})
    chosen.__dict__ |= {"_examples": row._examples, "_tree": row._tree, "_models": row._models}
    first = candidates().plans[candidates().proposed[proposer][0]]
    assert chosen.predict(test, data, np.random.default_rng(1)).instructions == first


def test_end_is_expected_by_the_rules_of_scoring(monkeypatch: pytest.MonkeyPatch) -> None:
    data, test, row = pantries()
    before = candidates().features[:, [FEATURES.index("drawn END"), FEATURES.index("neighbours END")]]
    assert (np.ptp(before, axis=0) > 0).all()
    monkeypatch.setattr(data.scorer(test.environment), "changed", lambda sequence: 0)
    after = row.candidates(test, data).features
    assert not after[:, [FEATURES.index("drawn END"), FEATURES.index("neighbours END")]].any()


def test_what_the_person_did_there_is_not_looked_at() -> None:
    data, test, row = pantries()
    blind = replace(test, demonstration=replace(test.demonstration, segments=()))
    assert blind.gold == () != test.gold
    assert np.array_equal(row.candidates(blind, data).features, candidates().features)
