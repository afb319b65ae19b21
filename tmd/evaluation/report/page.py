"""A run as one self-contained page: no script, nothing that is loaded, text of users only as text."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from zlib import crc32

from tmd import __version__
from tmd.evaluation.report import paper_table
from tmd.evaluation.report.confusion import NO_CLAUSE, NOTHING, VerbErrors, by_instruction, by_verb
from tmd.evaluation.report.examples import SHOWN, SYMBOLS, best_and_worst
from tmd.evaluation.report.figures import LABELS, learning_curves, overall_bars, task_bars, tasks_of
from tmd.evaluation.report.in_words import in_words
from tmd.evaluation.report.reference_row import ALPHA, differing, reference
from tmd.evaluation.runs.finished_run import Run
from tmd.evaluation.runs.summary import EMPTY, average
from tmd.evaluation.runs.trial_records import Trials, films
from tmd.inference.energy import title
from tmd.records.fit import Fit
from tmd.records.metrics import SUCCESS, Means, Metrics, Pair
from tmd.view.alignment import Mark
from tmd.view.markup import data, templates

FOLDER = "pages"


def page_name(model: str, example: str | int) -> str:
    """Return the file name of the page on a prediction; it is unique, and safe in an address."""
    plain = f"{model}-{example}"
    safe = re.sub(r"[^A-Za-z0-9_.-]", "_", plain)[:120]
    return f"{safe}.html" if safe == plain else f"{safe}-{crc32(plain.encode('utf-8', 'replace')):08x}.html"


def linked_pages(run: Path) -> frozenset[str]:
    """Return the pages that are there, by file name."""
    return frozenset(path.name for path in (run / FOLDER).glob("*.html"))


# How many verbs the table of verbs shows.
_VERBS = 30
# How many weights the table of weights shows.
_WEIGHTS = 40


@dataclass(frozen=True, slots=True)
class LearnedWeights:
    """Weights and curve that one row learned.

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
    """Errors of one row. ``cells`` are (count, share of the line) by recorded and predicted instruction."""

    model: str
    verbs: list[VerbErrors]
    rarer: int
    unparsed: VerbErrors | None
    names: list[str]
    cells: dict[tuple[str, str], tuple[int, float]]


def differences(metrics: Metrics, row: str | None, order: Sequence[str]) -> list[Pair]:
    """Return the differences of one row from all others, as ``row`` minus the other."""
    own = [pair.seen_from(row) for pair in metrics.significance.pairs if row is not None and row in (pair.a, pair.b)]
    return sorted(own, key=lambda pair: order.index(pair.b))


def table_2(metrics: Metrics, rows: Sequence[str]) -> dict[str, Any] | None:
    """Return our numbers and the paper's for the rows and tasks that both have; ``None`` if there are none."""
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
    """Return the weights that one row learned, over its training sets."""
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
    """Return the errors of one row."""
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


# Data whose texts may not be passed on.
_VEIL500 = "veil500"
# How many instructions are named in a cell.
_MENTIONED = 3


def render(run: Run, trials: Trials | None = None, pages: frozenset[str] = frozenset()) -> str:
    """Return the page.

    Args:
        run: The run.
        trials: The robot's trials of its predictions; ``None`` where there are none.
        pages: The pages on single predictions that are there, by file name.
    """
    metrics, fits = run.metrics, list(run.fits.values())
    paper, others = paper_table.in_order(metrics.models)
    others.sort(key=lambda model: model == EMPTY)
    order = [*paper, *others]
    chief = reference(metrics.models)
    shown = sorted((m for m in order if m != EMPTY), key=lambda m: m != chief)
    page = templates().get_template("report.html.j2")
    return page.render(
        version=__version__,
        style=data("report.css"),
        title_of=paper_table.title,
        factor_title=title,
        page_name=page_name,
        page_folder=FOLDER,
        said=_said,
        mentioned=_mentioned,
        metrics=metrics,
        paper=paper,
        others=others,
        order=order,
        reference=chief,
        meaning=in_words(metrics),
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
        overall=overall_bars(metrics, order, metrics.columns),
        by_task=task_bars(metrics, order, [c for c in (SUCCESS, "IED", "EED", "END") if c in metrics.columns]),
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
        pages=pages,
    )


def _with_goal(metrics: Metrics) -> int | None:
    """Return the number of examples with a goal; ``None`` where all have one."""
    rows = metrics.models.values()
    return max(row.goals for row in rows) if any(row.goals < row.n for row in rows) else None


def _said(value: object) -> str:
    """Return a value of the configuration."""
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)


def _mentioned(counts: Counter[str] | Counter[tuple[str, str]]) -> str:
    """List the most frequent ones: ``moveto × 3, grasp × 2``, and of pairs ``moveto → grasp × 2``."""
    most = sorted(((" → ".join((key,) if isinstance(key, str) else key), n) for key, n in counts.items()), key=_rank)
    return ", ".join(f"{key} × {count}".replace(" ", "\N{NO-BREAK SPACE}") for key, count in most[:_MENTIONED])


def _rank(item: tuple[str, int]) -> tuple[int, str]:
    return -item[1], item[0]
