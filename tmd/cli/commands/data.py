"""``tmd data``: what is in a copy of a data set."""

from __future__ import annotations

from pathlib import Path

import click

from tmd.cli.inputs.options import json_option
from tmd.cli.output import emit


@click.group("data")
def command() -> None:
    """Look into data sets."""


@command.command("check")
@click.argument("directory", metavar="DIR", type=click.Path(path_type=Path))
@json_option
def check(directory: Path, as_json: bool) -> None:
    """Read a copy of VEIL-500 and count what was found, repaired and dropped.

    Ends with 33 where the copy is missing or damaged.
    """
    from tmd.datasets.veil500.report import check_veil500

    report = check_veil500(directory)
    emit(report.json() if as_json else report.text())
