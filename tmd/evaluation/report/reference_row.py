"""Reference row of a run, and the rows that differ from it."""

from __future__ import annotations

from collections.abc import Iterable

from tmd.evaluation.runs.summary import EMPTY
from tmd.records.metrics import TESTED, Pair

# The paper's full model: the others are measured against it.
FULL = "full"
# A corrected p below this is marked.
ALPHA = 0.05


def reference(models: Iterable[str]) -> str | None:
    """Return the row that the others are measured against: ``full``, or the last one that predicts anything."""
    rows = [name for name in models if name != EMPTY]
    if FULL in rows:
        return FULL
    return rows[-1] if rows else None


def differing(pairs: Iterable[Pair], against: str) -> frozenset[tuple[str, str]]:
    """Return the rows that differ from one in a metric, with the metric: corrected p below :data:`ALPHA`."""
    own = [pair.seen_from(against) for pair in pairs if against in (pair.a, pair.b)]
    tested = [(pair.b, metric, found) for pair in own for metric in TESTED if (found := pair.of(metric)) is not None]
    return frozenset((other, metric) for other, metric, found in tested if found.p_holm < ALPHA)
