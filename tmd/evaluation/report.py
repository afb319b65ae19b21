"""The table on the screen, and the page of a run."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from tmd.atomic import write_text
from tmd.evaluation.standing import ALPHA, differing, reference
from tmd.evaluation.summary import EMPTY, METRICS

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

REPORT = "report.html"
"""The page's name in the run's directory."""


def write_report(directory: Path) -> Path:
    """Write ``report.html`` from what lies in a run's directory, and return its path.

    Raises:
        TmdError: The directory holds no finished run, a file of it is damaged, or it cannot be written to.
    """
    from tmd.evaluation.linked_pages import linked_pages
    from tmd.evaluation.page import render
    from tmd.evaluation.records import read_run
    from tmd.evaluation.trials import read_trials

    page = render(read_run(directory), read_trials(directory), linked_pages(directory))
    path = directory / REPORT
    write_text(path, page)
    return path


def print_table(metrics: dict[str, Any], console: Console | None = None) -> None:
    """Print the table: means over examples. All metrics run from 0 to 100, larger is better."""
    from rich.console import Console

    (console or Console()).print(table(metrics))


def table(metrics: dict[str, Any]) -> Table:
    """The models as rows, the metrics as columns, each mean with its standard error; the floor is marked."""
    from rich import box
    from rich.markup import escape
    from rich.table import Table

    config = metrics["config"]
    title = f"{config['task']}, {config['data']} data, {len(metrics['folds'])} folds, seed {config['seed']}"
    against = reference(metrics["models"])
    marked = differing(metrics["significance"]["pairs"], against) if against else frozenset()
    found = Table(
        title=escape(title),
        caption=escape(_caption(metrics, against, marked)),
        box=box.SIMPLE_HEAD,
        title_justify="left",
        caption_justify="left",
        pad_edge=False,
        collapse_padding=True,
    )
    found.add_column("model", no_wrap=True)
    for column in ("n", "IED", "EED", "EED-trim", "END", "exec. %"):
        found.add_column(column, justify="right", no_wrap=True)
    for name, row in metrics["models"].items():
        cells = [f"{row[m]:.1f} ±{row[f'{m}_se']:.1f}" + _star((name, m) in marked, bool(marked)) for m in METRICS]
        found.add_row(escape(name), str(row["n"]), *cells, f"{row['executable']:.1f}")
    return found


def _star(here: bool, anywhere: bool) -> str:
    """A mark, or its place where there are marks at all: the numbers stay below each other."""
    return ("*" if here else " ") if anywhere else ""


def _caption(metrics: dict[str, Any], against: str | None, marked: frozenset[tuple[str, str]]) -> str:
    said = []
    if metrics["floor"] is not None:
        said.append(f"The row {EMPTY} predicts nothing: it is the floor.")
    if marked:
        said.append(f"* differs from {against}: paired test by text, Holm, p < {ALPHA}.")
    return " ".join(said)
