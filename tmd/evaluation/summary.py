"""From predictions to the table: means with standard errors by task and on average, the floor, and paired tests.

The tests are between rows that were tested on the same examples.
Examples with the same text are not independent, whatever the environment: models read the same words. So what is
drawn, and what is flipped, is a text with all its examples.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations, product
from statistics import fmean, stdev
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from tmd.records.metrics import COLUMNS, SUCCESS, TESTED

Floats: TypeAlias = NDArray[np.float64]
_Key: TypeAlias = tuple[str, str]
_Rows: TypeAlias = Mapping[str, Mapping[_Key, Mapping[str, Any]]]
"""The predictions of each row, by example."""

EMPTY = "empty"
"""The model that predicts nothing. Its row is the floor of each metric."""
RESAMPLES = 9999
"""How many sign patterns, and how many bootstrap samples, are drawn."""
LEVEL = 0.95
"""The level of the intervals."""
SEED = 0
"""The draws do not depend on the run's seed: the same predictions have the same p."""
_PARTS = ("difference", "low", "high", "p", "p_holm")
_DIGITS = 4
_SLACK = 1e-9
"""Sums that differ by less are equal: the order of adding must not decide a tie."""


def summarise(predictions: Sequence[dict[str, Any]], models: Sequence[str]) -> dict[str, Any]:
    """Return the numbers of ``metrics.json``.

    Returns:
        ``{"models": {NAME: {"n", METRIC, METRIC_se, …, "tasks": {TASK: …}, "average": …}}, "floor", "significance"}``.
        A model's own numbers are means over examples, ``_se`` their standard errors. ``average`` is the mean of the
        tasks' means, as the paper's Table II averages; its standard error takes the tasks as given. ``success`` and
        ``executable`` are percentages. ``goals`` is the number of examples that have a goal; where none has,
        ``success`` is ``None``. ``floor`` is the row ``empty``, ``None`` if that was not asked for. ``significance`` is
        what :func:`compare` finds.
    """
    table: dict[str, Any] = {}
    for model in models:
        own = [p for p in predictions if p["model"] == model]
        tasks = {t: _means([p for p in own if p["task"] == t]) for t in sorted({p["task"] for p in own})}
        table[model] = _means(own) | {"tasks": tasks, "average": average(tasks.values())}
    return {"models": table, "floor": table.get(EMPTY), "significance": compare(predictions, models, TESTED)}


def average(tasks: Iterable[Mapping[str, Any]]) -> dict[str, Any]:
    """Return the mean of the means of tasks; ``n`` is the number of examples, ``goals`` that of goals."""
    rows = list(tasks)
    found: dict[str, Any] = {"n": sum(row["n"] for row in rows), "goals": sum(row["goals"] for row in rows)}
    for column in COLUMNS:
        told = [row for row in rows if row[column] is not None]
        spread = math.sqrt(math.fsum(row[f"{column}_se"] ** 2 for row in told)) / max(len(told), 1)
        found |= _column(column, fmean([row[column] for row in told] or [0.0]), spread, len(told))
    return found


def _means(predictions: Sequence[dict[str, Any]]) -> dict[str, Any]:
    goals = sum(p.get(SUCCESS) is not None for p in predictions)
    found: dict[str, Any] = {"n": len(predictions), "goals": goals}
    for column in COLUMNS:
        values = [value for p in predictions if (value := score(p, column)) is not None]
        error = stdev(values) / math.sqrt(len(values)) if len(values) > 1 else 0.0
        found |= _column(column, fmean(values or [0.0]), error, len(values))
    return found


def _column(column: str, mean: float, error: float, count: int) -> dict[str, float | None]:
    """Return a mean and its standard error; success is ``None`` without goals, for 0 would mean that all failed."""
    if column == SUCCESS and not count:
        return {column: None, f"{column}_se": None}
    return {column: round(mean, _DIGITS), f"{column}_se": round(error, _DIGITS)}


def score(prediction: Mapping[str, Any], metric: str) -> float | None:
    """Return a score from 0 to 100; true is 100, false is 0, and ``None`` is no score."""
    value = prediction.get(metric)
    if value is None:
        return None
    return 100.0 * value if isinstance(value, bool) else float(value)


def compare(predictions: Sequence[dict[str, Any]], models: Sequence[str], metrics: Sequence[str]) -> dict[str, Any]:
    """Return every two rows, on the examples that all rows have; in each metric on those of them that are scored by it.

    Returns:
        ``{"examples", "texts", "resamples", "level", "pairs": [{"a", "b", METRIC: {"difference", "low", "high",
        "p", "p_holm"}}]}``. ``difference`` is the mean over examples of a minus b, ``low`` to ``high`` its interval,
        ``p`` of the two-sided test of no difference, ``p_holm`` the same, corrected for the number of pairs. A metric
        that no example is scored by is ``None``.
    """
    found: dict[str, Any] = {"examples": 0, "texts": 0, "resamples": RESAMPLES, "level": LEVEL, "pairs": []}
    if len(models) < 2:
        return found
    rows = {model: {_key(p): p for p in predictions if p["model"] == model} for model in models}
    keys = sorted(set.intersection(*(set(row) for row in rows.values())))
    if not keys:
        return found
    texts = {rows[models[0]][key]["text"] for key in keys}
    pairs = list(combinations(models, 2))
    table: list[dict[str, Any]] = [{"a": a, "b": b} for a, b in pairs]
    for metric in metrics:
        for entry, difference in zip(table, _differences(rows, keys, pairs, metric), strict=True):
            entry[metric] = difference
    return found | {"examples": len(keys), "texts": len(texts), "pairs": table}


def _differences(
    rows: _Rows, keys: Sequence[_Key], pairs: Sequence[tuple[str, str]], metric: str
) -> list[dict[str, float] | None]:
    """Return the entries of :func:`compare` for each pair in one metric: a family of tests."""
    scores = {model: {key: score(row[key], metric) for key in keys} for model, row in rows.items()}
    scored = [key for key in keys if all(found[key] is not None for found in scores.values())]
    if not scored:
        return [None] * len(pairs)
    said = [next(iter(rows.values()))[key]["text"] for key in scored]
    place = {text: number for number, text in enumerate(sorted(set(said)))}
    where = np.array([place[text] for text in said])
    columns = {model: np.array([found[key] for key in scored], dtype=np.float64) for model, found in scores.items()}
    totals = np.array([np.bincount(where, weights=columns[a] - columns[b], minlength=len(place)) for a, b in pairs])
    values = sign_flip(totals).tolist()
    low, high = intervals(totals, np.bincount(where, minlength=len(place)).astype(np.float64))
    means = totals.sum(axis=1) / len(scored)
    found = zip(means, low, high, values, holm(values), strict=True)
    return [dict(zip(_PARTS, map(_rounded, parts), strict=True)) for parts in found]


def sign_flip(totals: Floats) -> Floats:
    """Return the p of the two-sided paired permutation test (Fisher's sign-flip test) of each row of ``totals``.

    If two models are equally good, each difference could as well have had the other sign. p is the share of sign
    patterns whose sum is at least as far from 0 as the one seen: of all patterns where there are few, otherwise
    of :data:`RESAMPLES` random ones and the one seen.

    Args:
        totals: Shape (tests, texts): the sum of differences over the examples of each text.

    Returns:
        Shape (tests,).
    """
    count = totals.shape[1]
    exact = 2**count <= RESAMPLES + 1
    if exact:
        signs = np.array(list(product((1.0, -1.0), repeat=count)))
    else:
        signs = np.random.default_rng(SEED).choice([1.0, -1.0], size=(RESAMPLES, count))
    seen = np.abs(totals.sum(axis=1))
    as_far = (np.abs(signs @ totals.T) >= seen - _SLACK * (1 + seen)).sum(axis=0)
    p: Floats = as_far / len(signs) if exact else (1 + as_far) / (1 + len(signs))
    return p


def intervals(totals: Floats, sizes: Floats) -> tuple[Floats, Floats]:
    """Percentile bootstrap intervals of the mean difference, drawing texts with all their examples.

    Args:
        totals: Shape (tests, texts): the sum of differences over the examples of each text.
        sizes: Shape (texts,): how many examples each text has.

    Returns:
        Lower and upper ends, of shape (tests,) each.
    """
    count = len(sizes)
    drawn = np.random.default_rng(SEED).multinomial(count, np.full(count, 1 / count), size=RESAMPLES)
    means = (drawn @ totals.T) / (drawn @ sizes)[:, np.newaxis]
    low, high = np.quantile(means, [(1 - LEVEL) / 2, (1 + LEVEL) / 2], axis=0)
    return low, high


def holm(values: Sequence[float]) -> list[float]:
    """Return the p values of a family of tests after Holm's step-down correction: the least may be looked for."""
    count = len(values)
    order = np.argsort(values, kind="stable")
    corrected = np.empty(count)
    scaled = np.minimum(1.0, np.arange(count, 0, -1) * np.array(values)[order])
    corrected[order] = np.maximum.accumulate(scaled)
    return [float(value) for value in corrected]


def _key(prediction: dict[str, Any]) -> _Key:
    return prediction["environment"], str(prediction["id"])


def _rounded(value: float) -> float:
    return round(float(value), _DIGITS) + 0.0
