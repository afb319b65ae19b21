"""A run as one self-contained page: no script, nothing that is loaded, text of users only as text."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tmd import __version__
from tmd.evaluation import paper_table
from tmd.evaluation.alignment import Mark
from tmd.evaluation.confusion import NO_CLAUSE, NOTHING, VerbErrors, by_instruction, by_verb
from tmd.evaluation.examples import SHOWN, SYMBOLS, best_and_worst
from tmd.evaluation.figures import LABELS, learning_curves, overall_bars, task_bars, tasks_of
from tmd.evaluation.records import Fit, Metrics, Run
from tmd.evaluation.standing import ALPHA, differing, reference
from tmd.evaluation.summary import COLUMNS, EMPTY, METRICS

if TYPE_CHECKING:
    from jinja2 import Environment

_DATA = Path(__file__).parent / "data"
_VEIL500 = "veil500"
"""Data whose texts may not be passed on."""
_VERBS = 30
"""How many verbs the table of verbs shows."""
_WEIGHTS = 40
"""How many weights the table of weights shows."""
_MENTIONED = 3
"""How many instructions are named in a cell."""


@dataclass(frozen=True, slots=True)
class Learned:
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


def render(run: Run) -> str:
    """The page."""
    metrics = run.metrics
    paper, others = paper_table.in_order(metrics.models)
    others.sort(key=lambda model: model == EMPTY)
    order = [*paper, *others]
    against = reference(metrics.models)
    pairs = [pair.model_dump() for pair in metrics.significance.pairs]
    shown = sorted((m for m in order if m != EMPTY), key=lambda m: m != against)
    page = _environment().get_template("report.html.j2")
    return page.render(
        version=__version__,
        style=(_DATA / "report.css").read_text(encoding="utf-8"),
        metrics=metrics,
        paper=paper,
        others=others,
        order=order,
        reference=against,
        marked=differing(pairs, against) if against else frozenset(),
        alpha=ALPHA,
        columns=COLUMNS,
        tested=METRICS,
        labels=LABELS,
        tasks=tasks_of(metrics),
        table_2=_table_2(metrics, paper),
        overall=overall_bars(metrics, order, COLUMNS),
        by_task=task_bars(metrics, order, ("IED", "EED", "END")),
        learned=[_learned(run.fits, model) for model in order if any(fit.model == model for fit in run.fits)],
        errors=[_errors(run, model) for model in shown],
        examples=[(model, *best_and_worst(run.of(model))) for model in shown],
        count=SHOWN,
        symbols=SYMBOLS,
        marks=Mark,
        nothing=NOTHING,
        empty=EMPTY,
        veil500=_VEIL500,
    )


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


def _table_2(metrics: Metrics, rows: Sequence[str]) -> dict[str, Any] | None:
    """Our numbers and the paper's for the rows and tasks that both have; ``None`` if there are none."""
    tasks = [task for task in paper_table.TASKS if all(task in metrics.models[model].tasks for model in rows)]
    if not tasks or not rows:
        return None
    found = []
    for model in rows:
        own = [metrics.models[model].tasks[task] for task in tasks]
        average = {metric: sum(task.mean(metric) for task in own) / len(own) for metric in paper_table.METRICS}
        errors = {metric: sum(task.se(metric) ** 2 for task in own) ** 0.5 / len(own) for metric in paper_table.METRICS}
        found.append((model, own, average, errors, paper_table.TABLE_2[model]))
    return {"tasks": tasks, "rows": found, "all": len(tasks) == len(paper_table.TASKS), "metrics": paper_table.METRICS}


def _learned(fits: Sequence[Fit], model: str) -> Learned:
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
    return Learned(model, len(own), learning_curves(own, model), worlds, kept, len(weights) - len(kept))


def _errors(run: Run, model: str) -> Errors:
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
