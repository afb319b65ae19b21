"""Which row the others are measured against, and which of them differ from it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from tmd.evaluation.runs.summary import EMPTY, TESTED

FULL = "full"
"""The paper's full model: the others are measured against it."""
ALPHA = 0.05
"""A corrected p below this is marked."""


def reference(models: Iterable[str]) -> str | None:
    """The row that the others are measured against: ``full``, or the last one that predicts anything."""
    rows = [name for name in models if name != EMPTY]
    if FULL in rows:
        return FULL
    return rows[-1] if rows else None


def differing(pairs: Iterable[Mapping[str, Any]], against: str) -> frozenset[tuple[str, str]]:
    """The rows that differ from one in a metric, with the metric: corrected p below :data:`ALPHA`."""
    found = set()
    for pair in pairs:
        if against in (pair["a"], pair["b"]):
            other = pair["b"] if pair["a"] == against else pair["a"]
            tested = [metric for metric in TESTED if pair.get(metric) is not None]
            found |= {(other, metric) for metric in tested if pair[metric]["p_holm"] < ALPHA}
    return frozenset(found)
