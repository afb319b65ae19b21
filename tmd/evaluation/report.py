"""The table on the screen, and the page of a run."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tmd.atomic import write_text
from tmd.errors import TmdError

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

EMPTY = "empty"
"""The model that predicts nothing: there is nothing to show of it."""
_SHOWN = 5
"""How many of the best and worst predictions the page shows for each model."""
_WIDTH = 118


def table(metrics: dict[str, Any]) -> Table:
    """The models as rows, the metrics as columns, each mean with its standard error."""
    from rich.table import Table

    config = metrics["config"]
    title = f"{config['task']}, {config['data']} data, {len(metrics['folds'])} folds, seed {config['seed']}"
    found = Table(title=title)
    found.add_column("model")
    for column in ("n", "IED", "EED", "EED-trim", "END", "executable %"):
        found.add_column(column, justify="right")
    for name, row in metrics["models"].items():
        cells = [f"{row[m]:.1f} ±{row[f'{m}_se']:.1f}" for m in ("IED", "EED", "EED_trim", "END")]
        found.add_row(name, str(row["n"]), *cells, f"{row['executable']:.1f}")
    return found


def print_table(metrics: dict[str, Any], console: Console | None = None) -> None:
    """Print the table. All metrics run from 0 to 100, larger is better."""
    from rich.console import Console

    (console or Console()).print(table(metrics))


def write_report(directory: Path) -> Path:
    """Write ``report.html`` from what lies in a run's directory, and return its path.

    Raises:
        TmdError: The directory holds no finished run.
    """
    from rich.console import Console

    metrics, predictions = _read(directory)
    console = Console(record=True, width=_WIDTH, file=io.StringIO())
    console.rule("tmd: evaluation")
    console.print(table(metrics))
    console.print("IED, EED and END run from 0 to 100, larger is better; ± is the standard error of the mean.")
    console.print("The model `empty` predicts nothing: it is the floor of each metric.\n")
    for name, row in metrics["models"].items():
        console.print(_by_task(name, row["tasks"]))
    console.rule("configuration")
    console.print_json(json.dumps(metrics["config"]))
    for name in (name for name in metrics["models"] if name != EMPTY):
        own = sorted((p for p in predictions if p["model"] == name), key=lambda p: (-p["IED"], str(p["id"])))
        _examples(console, f"{name}: best", own[:_SHOWN])
        _examples(console, f"{name}: worst", own[-_SHOWN:])
    path = directory / "report.html"
    write_text(path, console.export_html(inline_styles=True))
    return path


def _read(directory: Path) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    try:
        metrics = json.loads((directory / "metrics.json").read_text(encoding="utf-8"))
        lines = (directory / "predictions.jsonl").read_text(encoding="utf-8").splitlines()
        return metrics, [json.loads(line) for line in lines]
    except (OSError, ValueError):
        raise TmdError(f"{directory}: holds no finished run", hint="run `tmd experiment` to its end") from None


def _by_task(name: str, tasks: dict[str, Any]) -> Table:
    from rich.table import Table

    found = Table(title=f"{name} by task")
    found.add_column("task")
    for column in ("n", "IED", "EED", "END", "executable %"):
        found.add_column(column, justify="right")
    for task, row in tasks.items():
        cells = [f"{row[m]:.1f} ±{row[f'{m}_se']:.1f}" for m in ("IED", "EED", "END")]
        found.add_row(task, str(row["n"]), *cells, f"{row['executable']:.1f}")
    return found


def _examples(console: Console, title: str, predictions: list[dict[str, Any]]) -> None:
    console.rule(title)
    for p in predictions:
        can = "executable" if p["executable"] else "not executable"
        console.print(f"{p['id']} ({p['environment']}): IED {p['IED']:.1f}, END {p['END']:.1f}, {can}", markup=False)
        console.print(f"  predicted: {'; '.join(p['predicted']) or 'nothing'}", markup=False)
        console.print(f"  gold:      {'; '.join(p['gold']) or 'nothing'}", markup=False)
