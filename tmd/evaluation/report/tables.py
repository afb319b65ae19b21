"""The tables of a report that are more than means: beside the paper, differences, weights, errors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from tmd.evaluation.report import paper_table
from tmd.evaluation.report.confusion import NO_CLAUSE, NOTHING, VerbErrors, by_instruction, by_verb
from tmd.evaluation.report.figures import learning_curves
from tmd.evaluation.runs.finished_run import Run
from tmd.evaluation.runs.summary import average
from tmd.records.fit import Fit
from tmd.records.metrics import Means, Metrics, Pair

_VERBS = 30
"""How many verbs the table of verbs shows."""
_WEIGHTS = 40
"""How many weights the table of weights shows."""


@dataclass(frozen=True, slots=True)
class LearnedWeights:
    """What one row learned.

    Attributes:
        model: The row.
        sets: From how many training sets.
        curve: The learning curves, as SVG; ``None`` if none was kept.
        worlds: The kinds of world.
        weights: The largest: name, and (mean, least, largest) over the training sets for each kind of world.
        smaller: How many weights are left out.
    """

    model: str
    sets: int
    curve: str | None
    worlds: list[str]
    weights: list[tuple[str, list[tuple[float, float, float] | None]]]
    smaller: int


@dataclass(frozen=True, slots=True)
class Errors:
    """Where one row goes wrong. ``cells`` are (count, share of the line) by recorded and predicted instruction."""

    model: str
    verbs: list[VerbErrors]
    rarer: int
    unparsed: VerbErrors | None
    names: list[str]
    cells: dict[tuple[str, str], tuple[int, float]]


def differences(metrics: Metrics, row: str | None, order: Sequence[str]) -> list[Pair]:
    """The differences of one row from all others, as ``row`` minus the other."""
    own = [pair.seen_from(row) for pair in metrics.significance.pairs if row is not None and row in (pair.a, pair.b)]
    return sorted(own, key=lambda pair: order.index(pair.b))


def table_2(metrics: Metrics, rows: Sequence[str]) -> dict[str, Any] | None:
    """Our numbers and the paper's for the rows and tasks that both have; ``None`` if there are none."""
    tasks = [task for task in paper_table.TASKS if all(task in metrics.models[model].tasks for model in rows)]
    if not tasks or not rows:
        return None
    found = []
    for model in rows:
        own = [metrics.models[model].tasks[task] for task in tasks]
        mean = Means.model_validate(average(task.model_dump() for task in own))
        found.append((model, own, mean, paper_table.TABLE_2[model]))
    return {"tasks": tasks, "rows": found, "all": len(tasks) == len(paper_table.TASKS), "metrics": paper_table.METRICS}


def learned(fits: Sequence[Fit], model: str) -> LearnedWeights:
    """What one row learned, over its training sets."""
    own = [fit for fit in fits if fit.model == model]
    worlds = sorted({world for fit in own for world in fit.worlds})
    names = list(dict.fromkeys(name for fit in own for found in fit.worlds.values() for name in found.weights))
    weights: list[tuple[str, list[tuple[float, float, float] | None]]] = []
    for name in names:
        cells: list[tuple[float, float, float] | None] = []
        for world in worlds:
            values = [
                f.worlds[world].weights[name] for f in own if world in f.worlds and name in f.worlds[world].weights
            ]
            cells.append((sum(values) / len(values), min(values), max(values)) if values else None)
        weights.append((name, cells))
    order = sorted(weights, key=lambda w: -max(abs(cell[0]) for cell in w[1] if cell))[:_WEIGHTS]
    kept = [weight for weight in weights if weight in order]
    return LearnedWeights(model, len(own), learning_curves(own, model), worlds, kept, len(weights) - len(kept))


def errors(run: Run, model: str) -> Errors:
    """Where one row goes wrong."""
    lines = run.of(model)
    verbs = by_verb(lines)
    known = [verb for verb in verbs if verb.verb != NO_CLAUSE]
    counts = by_instruction(lines)
    names = [*sorted({name for pair in counts for name in pair} - {NOTHING}), NOTHING]
    totals = {gold: sum(counts[gold, mine] for mine in names) for gold in names}
    cells = {(gold, mine): (count, count / totals[gold]) for (gold, mine), count in counts.items()}
    unparsed = next((verb for verb in verbs if verb.verb == NO_CLAUSE), None)
    rarer = sum(verb.clauses for verb in known[_VERBS:])
    return Errors(model, known[:_VERBS], rarer, unparsed, names, cells)
