"""A run as one self-contained page: no script, nothing that is loaded, text of users only as text."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

from tmd import __version__
from tmd.evaluation.report import paper_table
from tmd.evaluation.report.alignment import Mark
from tmd.evaluation.report.confusion import NOTHING
from tmd.evaluation.report.examples import SHOWN, SYMBOLS, best_and_worst
from tmd.evaluation.report.figures import LABELS, overall_bars, task_bars, tasks_of
from tmd.evaluation.report.linked_pages import FOLDER, page_name
from tmd.evaluation.report.reference_row import ALPHA, differing, reference
from tmd.evaluation.report.tables import differences, errors, learned, table_2
from tmd.evaluation.runs.finished_run import Run
from tmd.evaluation.runs.summary import EMPTY
from tmd.evaluation.runs.trial_records import Trials, films
from tmd.records.metrics import SUCCESS, Metrics

if TYPE_CHECKING:
    from jinja2 import Environment

_DATA = Path(__file__).parent / "data"
_VEIL500 = "veil500"
"""Data whose texts may not be passed on."""
_MENTIONED = 3
"""How many instructions are named in a cell."""


def render(run: Run, trials: Trials | None = None, pages: frozenset[str] = frozenset()) -> str:
    """The page.

    Args:
        run: The run.
        trials: What a robot did with its predictions; ``None`` where nobody asked for it.
        pages: The pages on single predictions that are there, by file name.
    """
    metrics, fits = run.metrics, list(run.fits.values())
    paper, others = paper_table.in_order(metrics.models)
    others.sort(key=lambda model: model == EMPTY)
    order = [*paper, *others]
    chief = reference(metrics.models)
    shown = sorted((m for m in order if m != EMPTY), key=lambda m: m != chief)
    page = _environment().get_template("report.html.j2")
    return page.render(
        version=__version__,
        style=(_DATA / "report.css").read_text(encoding="utf-8"),
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
    """How many examples have a goal, where that needs saying: where some have none."""
    rows = metrics.models.values()
    return max(row.goals for row in rows) if any(row.goals < row.n for row in rows) else None


def _environment() -> Environment:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    found = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True, loader=FileSystemLoader(_DATA)
    )
    found.filters["one"] = lambda value: f"{value:.1f}"
    found.filters["signed"] = _signed
    found.filters["short"] = lambda value: f"{value:.3g}".replace("-", "−")
    found.filters["p"] = lambda value: "< 0.001" if value < 0.001 else f"{value:.3f}"
    found.filters["said"] = _said
    found.filters["mentioned"] = _mentioned
    found.globals["title_of"] = paper_table.title
    found.globals["page_name"] = page_name
    found.globals["page_folder"] = FOLDER
    return found


def _signed(value: float) -> str:
    """With its sign, but for 0."""
    return f"{value:+.1f}".replace("-", "−") if round(value, 1) else "0.0"


def _said(value: object) -> str:
    """A value of the configuration."""
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)


def _mentioned(counts: Counter[str] | Counter[tuple[str, str]]) -> str:
    """The most frequent ones: ``moveto × 3, grasp × 2``, and of pairs ``moveto → grasp × 2``; never broken inside."""
    most = sorted(((" → ".join((key,) if isinstance(key, str) else key), n) for key, n in counts.items()), key=_rank)
    return ", ".join(f"{key} × {count}".replace(" ", "\N{NO-BREAK SPACE}") for key, count in most[:_MENTIONED])


def _rank(item: tuple[str, int]) -> tuple[int, str]:
    return -item[1], item[0]
