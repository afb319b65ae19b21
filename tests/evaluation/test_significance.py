"""Paired tests, against cases worked out by hand and against scipy."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy  # which imports its parts when they are used
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from tmd.evaluation.summary import compare, holm, intervals, sign_flip, summarise
from tmd.records.metrics import METRICS


def prediction(model: str, number: int, score: float, text: str | None = None, **changes: object) -> dict[str, Any]:
    scores = dict.fromkeys(METRICS, score)
    said = {"id": number, "environment": "e", "task": "t", "text": text or f"text {number}", "executable": True}
    return {"model": model} | said | scores | changes


def test_sign_flip_by_hand() -> None:
    # 1+2+3 = 6 is reached in absolute value by +++ and --- only, of 8 patterns; 3-1-2 = 0 by all
    p = sign_flip(np.array([[1.0, 2.0, 3.0], [3.0, -1.0, -2.0], [0.0, 0.0, 0.0], [1.0, 1.0, -1.0]]))
    assert p.tolist() == [0.25, 1.0, 1.0, 1.0]


@settings(max_examples=25, deadline=None)
@given(arrays(np.float64, (2, 7), elements=st.integers(-50, 50).map(float)))
def test_sign_flip_is_scipys_exact_test(totals: np.ndarray[Any, Any]) -> None:
    for row, p in zip(totals, sign_flip(totals), strict=True):
        theirs = scipy.stats.permutation_test((row,), np.sum, permutation_type="samples", n_resamples=np.inf)
        assert p == pytest.approx(theirs.pvalue)


def test_sign_flip_with_many_texts_is_near_scipys() -> None:
    row = np.random.default_rng(3).normal(0.25, 1.0, 60)
    (p,) = sign_flip(row[np.newaxis])
    # with this many texts the sum is all but normal, with the differences' own squares as variance
    assert p == pytest.approx(2 * scipy.stats.norm.sf(abs(row.sum()) / np.sqrt((row**2).sum())), abs=0.01)


def test_p_is_never_0_and_one_sign_is_as_sure_as_the_draws_allow() -> None:
    (p,) = sign_flip(np.ones((1, 100)))
    assert p == pytest.approx(1e-4)


def test_intervals_cover_the_mean_and_are_scipys() -> None:
    totals = np.random.default_rng(1).normal(2.0, 5.0, (1, 80))
    low, high = intervals(totals, np.ones(80))
    theirs = scipy.stats.bootstrap((totals[0],), np.mean, method="percentile", n_resamples=9999).confidence_interval
    assert low[0] == pytest.approx(theirs.low, abs=0.15)
    assert high[0] == pytest.approx(theirs.high, abs=0.15)
    assert low[0] < totals.mean() < high[0]


def test_intervals_weigh_a_text_by_its_examples() -> None:
    # every example differs by exactly 2, whatever the text: nothing varies
    low, high = intervals(np.array([[2.0, 6.0, 4.0]]), np.array([1.0, 3.0, 2.0]))
    assert (low[0], high[0]) == (pytest.approx(2.0), pytest.approx(2.0))


@pytest.mark.parametrize(
    ("values", "corrected"),
    [
        ([0.01, 0.04, 0.03], [0.03, 0.06, 0.06]),
        ([0.5, 0.5], [1.0, 1.0]),
        ([0.02], [0.02]),
        ([], []),
    ],
)
def test_holm_by_hand(values: list[float], corrected: list[float]) -> None:
    assert holm(values) == pytest.approx(corrected)


def test_rows_are_compared_on_the_same_examples_whatever_their_order() -> None:
    a = [prediction("a", n, 10.0 * n) for n in range(5)]
    b = [prediction("b", n, 10.0 * n - 5) for n in reversed(range(4))]
    found = compare([*b, *a], ["a", "b"], METRICS)
    (pair,) = found["pairs"]
    assert (pair["a"], pair["b"], found["examples"]) == ("a", "b", 4)
    assert pair["IED"] == {"difference": 5.0, "low": 5.0, "high": 5.0, "p": 0.125, "p_holm": 0.125}


def test_the_same_text_is_one_draw() -> None:
    def p(texts: list[str]) -> float:
        a = [prediction("a", n, 10.0, text) for n, text in enumerate(texts)]
        b = [prediction("b", n, 0.0, text) for n, text in enumerate(texts)]
        return float(compare(a + b, ["a", "b"], METRICS)["pairs"][0]["END"]["p"])

    assert p(list("uvwxyz")) == pytest.approx(2 / 2**6, abs=1e-4)
    assert p(list("uuuvvv")) == pytest.approx(2 / 2**2)


def test_examples_of_two_environments_are_two() -> None:
    rows = [prediction(m, 1, s, environment=e) for m, s in (("a", 2.0), ("b", 1.0)) for e in ("e", "f")]
    assert compare(rows, ["a", "b"], METRICS)["examples"] == 2


def test_p_is_corrected_for_all_pairs() -> None:
    rows = [prediction(m, n, s) for m, s in (("a", 3.0), ("b", 2.0), ("c", 2.0)) for n in range(8)]
    pairs = {(p["a"], p["b"]): p["IED"] for p in compare(rows, ["a", "b", "c"], METRICS)["pairs"]}
    assert pairs["a", "b"]["p"] == pytest.approx(2 / 2**8, abs=1e-4)
    assert pairs["a", "b"]["p_holm"] == pytest.approx(3 * 2 / 2**8, abs=2e-4)
    assert pairs["b", "c"]["p_holm"] == 1.0


def test_rows_without_a_common_example_are_not_compared() -> None:
    assert compare([prediction("a", 1, 1.0), prediction("b", 2, 1.0)], ["a", "b"], METRICS)["pairs"] == []
    assert compare([], ["a", "b"], METRICS)["pairs"] == []


def test_the_floor_is_the_empty_row_or_nothing() -> None:
    rows = [prediction(m, n, s, task="tu"[n % 2]) for m, s in (("full", 50.0), ("empty", 20.0)) for n in range(3)]
    assert summarise(rows, ["full", "empty"])["floor"]["EED"] == 20.0
    assert summarise(rows, ["full"])["floor"] is None


def test_each_task_counts_alike_in_the_average() -> None:
    scores = {"t": [0.0, 0.0, 0.0, 40.0], "u": [90.0, 100.0]}
    rows = [prediction("m", 0, s, task=task) for task, values in scores.items() for s in values]
    row = summarise(rows, ["m"])["models"]["m"]
    assert row["IED"] == pytest.approx(230 / 6, abs=1e-3)
    assert row["average"]["IED"] == pytest.approx((10 + 95) / 2)
    # standard errors 20 / sqrt(4) and 5 sqrt(2) / sqrt(2), then half the root of the sum of their squares
    assert row["average"]["IED_se"] == pytest.approx((10**2 + 5**2) ** 0.5 / 2, abs=1e-3)
    assert row["average"]["n"] == 6
