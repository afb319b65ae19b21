"""From predictions to the table: means with standard errors by task and on average, the floor, and paired tests."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from tmd.evaluation.significance import compare

METRICS = ("IED", "EED", "EED_trim", "END")
EXECUTABLE = "executable"
"""The share of predictions whose every instruction could be executed, in percent."""
EMPTY = "empty"
"""The model that predicts nothing. Its row is the floor of each metric."""
COLUMNS = (*METRICS, EXECUTABLE)
_DIGITS = 4


def summarise(predictions: Sequence[dict[str, Any]], models: Sequence[str]) -> dict[str, Any]:
    """The numbers of ``metrics.json``.

    Returns:
        ``{"models": {NAME: {"n", METRIC, METRIC_se, …, "tasks": {TASK: …}, "average": …}}, "floor", "significance"}``.
        A model's own numbers are means over examples, ``_se`` their standard errors. ``average`` is the mean of the
        tasks' means, as the paper's Table II averages; its standard error takes the tasks as given. ``executable`` is
        a percentage. ``floor`` is the row ``empty``, ``None`` if that was not asked for. ``significance`` is what
        :func:`~tmd.evaluation.significance.compare` finds.
    """
    table: dict[str, Any] = {}
    for model in models:
        own = [p for p in predictions if p["model"] == model]
        tasks = {t: _means([p for p in own if p["task"] == t]) for t in sorted({p["task"] for p in own})}
        table[model] = _means(own) | {"tasks": tasks, "average": average(tasks.values())}
    return {"models": table, "floor": table.get(EMPTY), "significance": compare(predictions, models, METRICS)}


def average(tasks: Iterable[Mapping[str, Any]]) -> dict[str, Any]:
    """The mean of means of tasks, each task counting alike; ``n`` is the number of examples."""
    rows = list(tasks)
    found: dict[str, Any] = {"n": sum(row["n"] for row in rows)}
    for column in COLUMNS:
        found[column] = round(_mean([row[column] for row in rows]), _DIGITS)
        spread = math.sqrt(math.fsum(row[f"{column}_se"] ** 2 for row in rows)) / max(len(rows), 1)
        found[f"{column}_se"] = round(spread, _DIGITS)
    return found


def _means(predictions: Sequence[dict[str, Any]]) -> dict[str, Any]:
    found: dict[str, Any] = {"n": len(predictions)}
    for column in COLUMNS:
        scale = 100 if column == EXECUTABLE else 1
        values = [scale * float(p[column]) for p in predictions]
        found[column] = round(_mean(values), _DIGITS)
        found[f"{column}_se"] = round(_standard_error(values), _DIGITS)
    return found


def _mean(values: Sequence[float]) -> float:
    return math.fsum(values) / len(values) if values else 0.0


def _standard_error(values: Sequence[float]) -> float:
    if len(values) < 2:
        return 0.0
    middle = _mean(values)
    variance = math.fsum((v - middle) ** 2 for v in values) / (len(values) - 1)
    return math.sqrt(variance / len(values))
