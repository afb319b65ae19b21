"""The table of a run for other programs: CSV and LaTeX."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from urllib.parse import quote

from tmd.evaluation.report.rows import LABELS, best_of, title
from tmd.records.metrics import Means, Metrics

# The task of the lines that are over all examples.
_ALL = "all"
_LATEX = {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "±": r"$\pm$"} | {
    special: f"\\{special}" for special in "&%$#_{}"
}


def csv_table(metrics: Metrics, order: Sequence[str]) -> str:
    """Return the means with their standard errors: a line for each row, and for each of its tasks if it has several."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["model", "task", "n", *(name for column in metrics.columns for name in (column, f"{column}_se"))])
    for model in order:
        row = metrics.models[model]
        tasks = sorted(row.tasks.items())
        for task, means in [(_ALL, row), *tasks] if len(tasks) > 1 else tasks:
            cells = (value for column in metrics.columns for value in (means.mean(column), means.se(column)))
            writer.writerow([model, task, means.n, *("" if value is None else value for value in cells)])
    return out.getvalue()


def latex_table(metrics: Metrics, order: Sequence[str]) -> str:
    """Return the table over all examples for LaTeX with the package ``booktabs``; the best of each column is bold."""
    best = best_of(metrics.models, metrics.columns)
    lines = [rf"\begin{{tabular}}{{l{'r' * (len(metrics.columns) + 1)}}}", r"\toprule"]
    lines += [
        " & ".join(["row", "$n$", *(_escaped(LABELS[column]) for column in metrics.columns)]) + r" \\",
        r"\midrule",
    ]
    for model in order:
        row = metrics.models[model]
        cells = [_cell(row, column, bold=(model, column) in best) for column in metrics.columns]
        lines.append(" & ".join([_escaped(title(model)), str(row.n), *cells]) + r" \\")
    return "\n".join([*lines, r"\bottomrule", r"\end{tabular}"]) + "\n"


def _cell(means: Means, column: str, *, bold: bool) -> str:
    mean = means.mean(column)
    if mean is None:
        return "--"
    number = rf"\textbf{{{mean:.1f}}}" if bold else f"{mean:.1f}"
    return rf"{number} $\pm$ {means.se(column) or 0.0:.1f}"


def _escaped(text: str) -> str:
    return "".join(_LATEX.get(letter, letter) for letter in text)


def data_address(text: str, kind: str) -> str:
    """Return an address that holds a text itself, for a link that downloads it."""
    return f"data:text/{kind};charset=utf-8,{quote(text)}"
