"""A run as one self-contained page: no script, nothing that is loaded, text of users only as text."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from tmd import __version__
from tmd.evaluation.report.predictions import NOTHING, SHOWN, SYMBOLS, Mark, best_and_worst, by_instruction
from tmd.evaluation.report.rows import (
    ALPHA,
    LABELS,
    METRICS,
    TABLE_2,
    TASKS,
    best_of,
    by_merit,
    csv_table,
    data_address,
    differing,
    headline,
    in_order,
    latex_table,
    other_order,
    reasons,
    reference,
    tasks_of,
)
from tmd.evaluation.report.rows import title as row_title
from tmd.evaluation.runs.finished_run import Run, Trials, films
from tmd.evaluation.summary import EMPTY, average
from tmd.inference.energy import title
from tmd.records.fit import Fit, WorldFit
from tmd.records.metrics import SUCCESS, Means, Metrics, Pair
from tmd.view.markup import data, templates

# Data whose texts may not be passed on.
_VEIL500 = "veil500"
# How many weights are shown.
_SHOWN = 40
# Mean, least and largest weight over the training sets; ``None`` where no set has the factor.
_Cell: TypeAlias = tuple[float, float, float] | None


def differences(metrics: Metrics, row: str | None, order: Sequence[str]) -> list[Pair]:
    """Return the differences of one row from all others, as ``row`` minus the other."""
    own = [pair.seen_from(row) for pair in metrics.significance.pairs if row is not None and row in (pair.a, pair.b)]
    return sorted(own, key=lambda pair: order.index(pair.b))


def table_2(metrics: Metrics, rows: Sequence[str]) -> dict[str, Any] | None:
    """Return our numbers and the paper's for the rows and tasks that both have; ``None`` if there are none."""
    tasks = [task for task in TASKS if all(task in metrics.models[model].tasks for model in rows)]
    if not tasks or not rows:
        return None
    found = []
    for model in rows:
        own = [metrics.models[model].tasks[task] for task in tasks]
        mean = Means.model_validate(average(task.model_dump() for task in own))
        found.append((model, own, mean, TABLE_2[model]))
    return {
        "tasks": tasks,
        "rows": found,
        "average": len(tasks) > 1,
        "all": len(tasks) == len(TASKS),
        "metrics": METRICS,
    }


def errors(run: Run, model: str) -> dict[str, Any]:
    """Return the errors of one row.

    Returns:
        ``{"model", "names", "cells"}``: the row, the names of instructions, and (count, share of the line) by recorded
        and predicted instruction.
    """
    counts = by_instruction(run.of(model))
    names = [*sorted({name for pair in counts for name in pair} - {NOTHING}), NOTHING]
    totals = {gold: sum(counts[gold, mine] for mine in names) for gold in names}
    cells = {(gold, mine): (count, count / totals[gold]) for (gold, mine), count in counts.items()}
    return {"model": model, "names": names, "cells": cells}


@dataclass(frozen=True, slots=True)
class LearnedWeights:
    """Weights that one row learned.

    Attributes:
        losses: The mean loss of the first and of the last epoch; ``None`` if no curve was kept.
        weights: The largest weights, by factor: a cell for each kind of world.
    """

    model: str
    sets: int
    losses: tuple[float, float] | None
    worlds: tuple[str, ...]
    weights: tuple[tuple[str, tuple[_Cell, ...]], ...]
    smaller: int


def learned(fits: Sequence[Fit], model: str) -> LearnedWeights:
    """Return the weights that one row learned, and how its loss fell."""
    own = [fit for fit in fits if fit.model == model]
    found = [world for fit in own for world in fit.worlds.values()]
    worlds = tuple(sorted({world for fit in own for world in fit.worlds}))
    names = dict.fromkeys(name for world in found for name in world.weights)
    weights = {name: tuple(_spread(own, world, name) for world in worlds) for name in names}
    kept = set(sorted(weights, key=lambda name: -_size(weights[name]))[:_SHOWN])
    shown = tuple((name, cells) for name, cells in weights.items() if name in kept)
    return LearnedWeights(model, len(own), _losses(found), worlds, shown, len(weights) - len(shown))


def _spread(fits: Sequence[Fit], world: str, name: str) -> _Cell:
    found = [fit.worlds[world].weights for fit in fits if world in fit.worlds]
    values = [weights[name] for weights in found if name in weights]
    return (sum(values) / len(values), min(values), max(values)) if values else None


def _size(cells: Sequence[_Cell]) -> float:
    return max(abs(cell[0]) for cell in cells if cell)


def _losses(worlds: Sequence[WorldFit]) -> tuple[float, float] | None:
    """Return the mean loss of the first and of the last epoch."""
    curves = [[point.loss for point in world.curve if point.loss is not None] for world in worlds]
    ends = [(curve[0], curve[-1]) for curve in curves if curve]
    if not ends:
        return None
    return sum(first for first, _ in ends) / len(ends), sum(last for _, last in ends) / len(ends)


def render(run: Run, trials: Trials | None = None) -> str:
    """Return the page."""
    metrics, fits = run.metrics, list(run.fits.values())
    order, chief, tasks = by_merit(metrics), reference(metrics.models), tasks_of(metrics)
    shown = [model for model in order if model != EMPTY]
    paper = in_order(metrics.models)
    otherwise, pairs = other_order(metrics)
    page = templates().get_template("report.html.j2")
    return page.render(
        version=__version__,
        style=data("report.css"),
        title_of=row_title,
        factor_title=title,
        said=_said,
        metrics=metrics,
        headline=headline(metrics),
        provenance=run.provenance,
        duration=_duration,
        downloads={
            "CSV": ("table.csv", data_address(csv_table(metrics, order), "csv")),
            "LaTeX": ("table.tex", data_address(latex_table(metrics, order), "x-tex")),
        },
        order=order,
        reference=chief,
        marked=differing(metrics.significance.pairs, chief) if chief else frozenset(),
        best_of=best_of,
        alpha=ALPHA,
        against=differences(metrics, chief, order),
        columns=metrics.columns,
        tested=metrics.tested,
        labels=LABELS,
        success=SUCCESS,
        goals=_with_goal(metrics),
        tasks=tasks,
        average={model: row.average for model, row in metrics.models.items()},
        by_task={task: {m: r.tasks[task] for m, r in metrics.models.items() if task in r.tasks} for task in tasks},
        table_2=table_2(metrics, paper),
        otherwise=otherwise,
        pairs=pairs,
        reasons=reasons(metrics) if otherwise else [],
        learned=[learned(fits, model) for model in order if any(fit.model == model for fit in fits)],
        errors=[errors(run, model) for model in shown],
        examples=[(model, *best_and_worst(run.of(model))) for model in shown],
        count=SHOWN,
        symbols=SYMBOLS,
        marks=Mark,
        nothing=NOTHING,
        empty=EMPTY,
        veil500=_VEIL500,
        trials=trials,
        films=films(trials),
    )


def _with_goal(metrics: Metrics) -> int | None:
    """Return the number of examples with a goal; ``None`` where all have one."""
    rows = metrics.models.values()
    return max(row.goals for row in rows) if any(row.goals < row.n for row in rows) else None


def _said(value: object) -> str:
    """Return a value of the configuration."""
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)


def _duration(seconds: float) -> str:
    """Return a time for people: *48 s*, *7 min*, *2 h 05 min*."""
    minutes = round(seconds / 60)
    if seconds < 99.5:
        return f"{seconds:.0f} s"
    return f"{minutes} min" if minutes < 100 else f"{minutes // 60} h {minutes % 60:02} min"
