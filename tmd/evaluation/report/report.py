"""The table on the screen, and the page of a run."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from tmd.evaluation.report.rows import ALPHA, by_merit, differing, reference
from tmd.evaluation.summary import EMPTY
from tmd.files import write_text
from tmd.records.metrics import EXECUTABLE, SUCCESS, Means, Metrics

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

# The page's name in the run's directory.
REPORT = "report.html"
# More columns than any screen has.
_WIDEST = 1000


def write_report(directory: Path) -> Path:
    """Write ``report.html`` from what lies in a run's directory, and return its path.

    Raises:
        TmdError: The directory holds no finished run, a file of it is damaged, or it cannot be written to.
    """
    from tmd.evaluation.report.page import render
    from tmd.evaluation.runs.finished_run import read_run, read_trials

    page = render(read_run(directory), read_trials(directory))
    path = directory / REPORT
    write_text(path, page)
    return path


def print_table(metrics: Metrics, console: Console | None = None) -> None:
    """Print the table: means over examples. All metrics run from 0 to 100, larger is better."""
    from rich.console import Console
    from rich.measure import Measurement

    shown, found = console or Console(), table(metrics)
    if Measurement.get(shown, shown.options.update(max_width=_WIDEST), found).maximum > shown.width:
        found = table(metrics, narrow=True)
    try:
        shown.print(found)
    except SystemExit:  # rich ends the program when its output is closed
        raise BrokenPipeError from None


def table(metrics: Metrics, *, narrow: bool = False) -> Table:
    """Return the models as rows, the best first, the metrics as columns, each mean with its standard error.

    Success is the first metric, where any example has a goal. All rows together fit 80 columns in a ``narrow`` table.
    """
    from rich.markup import escape

    against = reference(metrics.models)
    marked = differing(metrics.significance.pairs, against) if against else frozenset()
    found = _frame(metrics, _caption(metrics, against, marked), narrow=narrow)
    scored = [column for column in metrics.columns if column != EXECUTABLE]
    for column in ("n", *(metric.replace("_", "-") for metric in scored), "exec." if narrow else "exec. %"):
        found.add_column(column, justify="right", no_wrap=True)
    between = "" if narrow else " "
    star = {True: "*", False: " " if marked else ""}  # the numbers stay below each other
    for name in by_merit(metrics):
        row = metrics.models[name]
        cells = [_cell(row, m, between) + star[(name, m) in marked] for m in scored]
        found.add_row(escape(name), str(row.n), *cells, f"{row.executable:.1f}")
    return found


def _frame(metrics: Metrics, caption: str, *, narrow: bool) -> Table:
    """Return the table without its numbers."""
    from rich import box
    from rich.markup import escape
    from rich.table import Table

    config = metrics.config
    title = f"{config['task']}, {config['data']} data, {len(metrics.folds)} folds, seed {config['seed']}"
    found = Table(
        title=escape(title),
        caption=escape(caption),
        box=box.SIMPLE_HEAD,
        title_justify="left",
        caption_justify="left",
        pad_edge=False,
        show_edge=not narrow,
        padding=0 if narrow else (0, 1),
        collapse_padding=True,
    )
    found.add_column("model", no_wrap=True)
    return found


def _cell(row: Means, metric: str, between: str) -> str:
    """Return a mean with its standard error; a dash where there is none."""
    mean, error = row.mean(metric), row.se(metric)
    return "–" if mean is None else f"{mean:.1f}{between}±{error or 0.0:.1f}"


def _caption(metrics: Metrics, against: str | None, marked: frozenset[tuple[str, str]]) -> str:
    said = []
    rows = metrics.models.values()
    if SUCCESS in metrics.columns and any(row.goals < row.n for row in rows):
        said.append(f"Success is over the {max(row.goals for row in rows)} examples that have a goal.")
    if metrics.floor is not None:
        said.append(f"The row {EMPTY} predicts nothing: it is the floor.")
    if marked:
        said.append(f"* differs from {against}: paired test by text, Holm, p < {ALPHA}.")
    return " ".join(said)
