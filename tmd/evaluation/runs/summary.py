"""From predictions to the table: means with standard errors by task and on average, the floor, and paired tests."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from tmd.evaluation.significance import compare, score
from tmd.records.metrics import COLUMNS, SUCCESS, TESTED

EMPTY = "empty"
"""The model that predicts nothing. Its row is the floor of each metric."""
_DIGITS = 4


def summarise(predictions: Sequence[dict[str, Any]], models: Sequence[str]) -> dict[str, Any]:
    """Return the numbers of ``metrics.json``.

    Returns:
        ``{"models": {NAME: {"n", METRIC, METRIC_se, …, "tasks": {TASK: …}, "average": …}}, "floor", "significance"}``.
        A model's own numbers are means over examples, ``_se`` their standard errors. ``average`` is the mean of the
        tasks' means, as the paper's Table II averages; its standard error takes the tasks as given. ``success`` and
        ``executable`` are percentages. ``goals`` is the number of examples that have a goal; where none has,
        ``success`` is ``None``. ``floor`` is the row ``empty``, ``None`` if that was not asked for. ``significance`` is
        what :func:`~tmd.evaluation.significance.compare` finds.
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
        found |= _column(column, _mean([row[column] for row in told]), spread, len(told))
    return found


def _means(predictions: Sequence[dict[str, Any]]) -> dict[str, Any]:
    goals = sum(p.get(SUCCESS) is not None for p in predictions)
    found: dict[str, Any] = {"n": len(predictions), "goals": goals}
    for column in COLUMNS:
        values = [value for p in predictions if (value := score(p, column)) is not None]
        found |= _column(column, _mean(values), _standard_error(values), len(values))
    return found


def _column(column: str, mean: float, error: float, count: int) -> dict[str, float | None]:
    """Return a mean and its standard error; success of nothing is not told, for 0 would say that all failed."""
    if column == SUCCESS and not count:
        return {column: None, f"{column}_se": None}
    return {column: round(mean, _DIGITS), f"{column}_se": round(error, _DIGITS)}


def _mean(values: Sequence[float]) -> float:
    return math.fsum(values) / len(values) if values else 0.0


def _standard_error(values: Sequence[float]) -> float:
    if len(values) < 2:
        return 0.0
    middle = _mean(values)
    variance = math.fsum((v - middle) ** 2 for v in values) / (len(values) - 1)
    return math.sqrt(variance / len(values))
