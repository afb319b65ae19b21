"""Results of a run in sentences: the leading row, its lead, and the same in the paper."""

from __future__ import annotations

from collections.abc import Sequence

from tmd.evaluation.report.paper_table import METRICS, TABLE_2, title
from tmd.evaluation.report.reference_row import ALPHA, FULL
from tmd.evaluation.runs.summary import EMPTY
from tmd.records.metrics import SUCCESS, Metrics

# The rows of Table II that the paper's own model is measured against.
BASELINES = ("chance", "templates", "tree", "no_nl", "nearest")
_WORDS = {SUCCESS: "success"}
# Points below which two means read alike on the page.
_LEAST = 0.05


def in_words(metrics: Metrics) -> list[str]:
    """Return the sentences, by success first; none where no row predicts anything."""
    rows = [row for row in metrics.models if row != EMPTY]
    if not rows:
        return []
    found = []
    if SUCCESS in metrics.columns:
        found.append(
            "A prediction succeeds if it can be executed and the goal of its text holds at its end; the other metrics "
            "compare it with what one person did, who may have done it otherwise."
        )
        found += _leader(metrics, rows, SUCCESS)
    found += _leader(metrics, rows, METRICS[0])
    return [*found, *_as_in_the_paper(metrics, rows)]


def _leader(metrics: Metrics, rows: Sequence[str], metric: str) -> list[str]:
    """Return a sentence on the leading row of a metric, averaged over tasks, and its lead."""
    means = {row: mean for row in rows if (mean := metrics.models[row].average.mean(metric)) is not None}
    order = sorted(means, key=lambda row: -means[row])
    word = _WORDS.get(metric, metric)
    if len(order) < 2:
        return [f"By {word}, {title(row)} has {means[row]:.1f}." for row in order]
    first, second = order[:2]
    ahead = means[first] - means[second]
    if ahead < _LEAST:
        return [f"By {word}, {title(first)} and {title(second)} are level at {means[first]:.1f}."]
    sure = _sure(metrics, first, second, metric)
    return [
        f"By {word}, {title(first)} leads with {means[first]:.1f}, {ahead:.1f} points ahead of {title(second)} "
        f"({means[second]:.1f}){sure}."
    ]


def _sure(metrics: Metrics, one: str, other: str, metric: str) -> str:
    """Return whether the test tells two rows apart; empty where they were not compared."""
    pairs = (pair for pair in metrics.significance.pairs if {pair.a, pair.b} == {one, other})
    tested = next((found for pair in pairs if (found := pair.of(metric)) is not None), None)
    if tested is None:
        return ""
    if tested.p_holm < ALPHA:
        return "; over the examples, chance does not explain the difference"
    return "; over the examples, the difference may be chance"


def _as_in_the_paper(metrics: Metrics, rows: Sequence[str]) -> list[str]:
    """Return whether the paper's full model is ahead of the baselines here, as it is there."""
    baselines = [row for row in BASELINES if row in rows]
    if FULL not in rows or not baselines:
        return []
    metric = METRICS[0]
    here = {row: metrics.models[row].average.mean(metric) or 0.0 for row in (FULL, *baselines)}
    best = max(baselines, key=lambda row: here[row])
    there = max(baselines, key=lambda row: TABLE_2[row].average[0])
    paper = TABLE_2[FULL].average[0] - TABLE_2[there].average[0]
    ahead = here[FULL] - here[best]
    how = f"{ahead:.1f} points ahead of" if ahead >= 0 else f"{-ahead:.1f} points behind"
    as_there = "as in the paper, where it is" if ahead >= _LEAST else "unlike in the paper, where it is"
    return [
        f"By {metric}, {title(FULL)} ({here[FULL]:.1f}) is {how} the best baseline here, {title(best)} "
        f"({here[best]:.1f}), {as_there} {paper:.1f} points ahead of {title(there)}, on other data."
    ]
