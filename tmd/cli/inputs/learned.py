"""Where the command line keeps and finds what was learned."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click

VARIABLE = "TMD_LEARNED"
_Command = TypeVar("_Command", bound=Callable[..., Any])


def learned_option(command: _Command) -> _Command:
    """``--learned DIR``: where `tmd learn --out DIR` has saved."""
    return click.option(
        "--learned",
        type=click.Path(path_type=Path),
        metavar="DIR",
        envvar=VARIABLE,
        help=f"What `tmd learn --out DIR` saved; ${VARIABLE}, or else learned/ beside the demonstrations, by default.",
    )(command)
