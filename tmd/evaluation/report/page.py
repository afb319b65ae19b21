"""A run as one self-contained page: no script, nothing that is loaded, text of users only as text."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from tmd import __version__
from tmd.evaluation.report.alignment import Mark
from tmd.evaluation.report.predictions import NOTHING, SHOWN, SYMBOLS, best_and_worst, by_instruction
from tmd.evaluation.report.rows import (
    ALPHA,
    LABELS,
    METRICS,
    TABLE_2,
    TASKS,
    differing,
    in_order,
    reference,
    tasks_of,
)
from tmd.evaluation.report.rows import title as row_title
from tmd.evaluation.runs.finished_run import Run, Trials, films
from tmd.evaluation.summary import EMPTY, average
from tmd.inference.energy import title
from tmd.records.fit import Fit
from tmd.records.metrics import SUCCESS, Means, Metrics, Pair
from tmd.view.markup import data, templates

# How many weights the table of weights shows.
_WEIGHTS = 40
# Data whose texts may not be passed on.
_VEIL500 = "veil500"


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
    return {"tasks": tasks, "rows": found, "all": len(tasks) == len(TASKS), "metrics": METRICS}


def learned(fits: Sequence[Fit], model: str) -> dict[str, Any]:
    """Return the weights that one row learned, over its training sets.

    Returns:
        ``{"model", "sets", "losses", "worlds", "weights", "smaller"}``: the row, the number of its training sets, the
        mean loss of the first and of the last epoch (``None`` if no curve was kept), the kinds of world, the largest
        weights as name and (mean, least, largest) over the training sets for each kind of world, and how many are left
        out.
    """
    own = [fit for fit in fits if fit.model == model]
    worlds = sorted({world for fit in own for world in fit.worlds})
    names = dict.fromkeys(name for fit in own for found in fit.worlds.values() for name in found.weights)
    weights = {name: [_spread(own, world, name) for world in worlds] for name in names}
    order = sorted(weights, key=lambda name: -max(abs(cell[0]) for cell in weights[name] if cell))[:_WEIGHTS]
    kept = [(name, cells) for name, cells in weights.items() if name in order]
    curves = [[p.loss for p in found.curve if p.loss is not None] for fit in own for found in fit.worlds.values()]
    ends = [(curve[0], curve[-1]) for curve in curves if curve]
    losses = [sum(part) / len(ends) for part in zip(*ends, strict=True)] if ends else None
    smaller = len(weights) - len(kept)
    return {
        "model": model, "sets": len(own), "losses": losses, "worlds": worlds, "weights": kept, "smaller": smaller
    }  # fmt: skip


def _spread(fits: Sequence[Fit], world: str, name: str) -> tuple[float, float, float] | None:
    """Return mean, least and largest weight of a factor over the training sets; ``None`` where no set has it."""
    values = [
        fit.worlds[world].weights[name] for fit in fits if world in fit.worlds and name in fit.worlds[world].weights
    ]
    return (sum(values) / len(values), min(values), max(values)) if values else None


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


def render(run: Run, trials: Trials | None = None) -> str:
    """Return the page.

    Args:
        run: The run.
        trials: The robot's trials of its predictions; ``None`` where there are none.
    """
    metrics, fits = run.metrics, list(run.fits.values())
    paper, others = in_order(metrics.models)
    others.sort(key=lambda model: model == EMPTY)
    order = [*paper, *others]
    chief = reference(metrics.models)
    shown = sorted((m for m in order if m != EMPTY), key=lambda m: m != chief)
    page = templates().get_template("report.html.j2")
    return page.render(
        version=__version__,
        style=data("report.css"),
        title_of=row_title,
        factor_title=title,
        said=_said,
        metrics=metrics,
        paper=paper,
        others=others,
        order=order,
        reference=chief,
        marked=differing(metrics.significance.pairs, chief) if chief else frozenset(),
        alpha=ALPHA,
        against=differences(metrics, chief, order),
        columns=metrics.columns,
        tested=metrics.tested,
        labels=LABELS,
        success=SUCCESS,
        goals=_with_goal(metrics),
        tasks=tasks_of(metrics),
        table_2=table_2(metrics, paper),
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
