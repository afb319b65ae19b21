"""The main result of a run in a sentence."""

from __future__ import annotations

from tmd.evaluation.report.rows import ALPHA, LABELS, best_of, by_merit, difference, title
from tmd.evaluation.summary import EMPTY
from tmd.records.metrics import SUCCESS, TESTED, Difference, Metrics


def headline(metrics: Metrics) -> str:
    """Return the row that leads, by how much, and whether that is significant."""
    rows = [model for model in by_merit(metrics) if model != EMPTY]
    if not rows:
        return "No row predicts anything."
    first, *others = rows
    column = metrics.columns[0]
    mean = metrics.models[first].mean(column) or 0.0
    score = f"{mean:.1f} % success" if column == SUCCESS else f"{LABELS[column]} {mean:.1f}"
    if not others:
        return f"{title(first)}: {score}."
    second = others[0]
    ahead = mean - (metrics.models[second].mean(column) or 0.0)
    told = f"{title(first)}: {score}, {ahead:.1f} more than {title(second)}{_sure(metrics, first, second, column)}."
    best = best_of(metrics.models, TESTED if column == SUCCESS else TESTED[1:])
    also = [LABELS[metric] for metric in TESTED if metric != column and (first, metric) in best]
    return f"{told} It is also the best in {_listed(also)}." if also else told


def _sure(metrics: Metrics, first: str, second: str, column: str) -> str:
    found = difference(metrics, first, second, column)
    return "" if found is None else f" ({sure(found)})"


def sure(found: Difference) -> str:
    """Return the corrected p of a difference: *p = 0.002*, *not significant, p = 0.310*."""
    p = "p < 0.001" if found.p_holm < 0.001 else f"p = {found.p_holm:.3f}"
    return p if found.p_holm < ALPHA else f"not significant, {p}"


def _listed(words: list[str]) -> str:
    return " and ".join(filter(None, (", ".join(words[:-1]), words[-1])))
