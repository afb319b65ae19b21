"""From predictions to the table: means with their standard errors, over all and by task."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

METRICS = ("IED", "EED", "EED_trim", "END")
_DIGITS = 4


def summarise(predictions: Sequence[dict[str, Any]], models: Sequence[str]) -> dict[str, Any]:
    """``{"models": {NAME: {"n", each metric, each metric + "_se", "executable", "tasks": {…}}}}``.

    ``executable`` is a percentage; ``_se`` is the standard error of the mean over examples.
    """
    table: dict[str, Any] = {}
    for model in models:
        own = [p for p in predictions if p["model"] == model]
        tasks = sorted({p["task"] for p in own})
        table[model] = _means(own) | {"tasks": {t: _means([p for p in own if p["task"] == t]) for t in tasks}}
    return {"models": table}


def _means(predictions: Sequence[dict[str, Any]]) -> dict[str, Any]:
    found: dict[str, Any] = {"n": len(predictions)}
    for metric in METRICS:
        values = [float(p[metric]) for p in predictions]
        found[metric] = round(_mean(values), _DIGITS)
        found[f"{metric}_se"] = round(_standard_error(values), _DIGITS)
    found["executable"] = round(100 * _mean([float(p["executable"]) for p in predictions]), _DIGITS)
    return found


def _mean(values: Sequence[float]) -> float:
    return math.fsum(values) / len(values) if values else 0.0


def _standard_error(values: Sequence[float]) -> float:
    if len(values) < 2:
        return 0.0
    middle = _mean(values)
    variance = math.fsum((v - middle) ** 2 for v in values) / (len(values) - 1)
    return math.sqrt(variance / len(values))
