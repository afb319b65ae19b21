"""The text a person said, from an option, a file or standard input."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click

from tmd.diagnostics import TmdError

MAX_CHARACTERS = 1_000_000
"""Longer texts are refused: nobody says that much."""
_Command = TypeVar("_Command", bound=Callable[..., Any])


def text_options(command: _Command) -> _Command:
    """``--text`` and ``--text-file``, of which exactly one is to be given."""
    command = click.option("--text-file", metavar="FILE", help="A file with what was said; - is standard input.")(
        command
    )
    return click.option("--text", metavar="TEXT", help="What was said.")(command)


def said(text: str | None, file: str | None) -> str:
    """The text.

    Raises:
        click.UsageError: Both options are given, or none.
        TmdError: There is no text, it is too long, or it is not UTF-8.
    """
    if (text is None) == (file is None):
        raise click.UsageError("give one of --text and --text-file")
    found = text if text is not None else _read(file or "")
    place = "--text" if file is None else "standard input" if file == "-" else file
    if not found.strip():
        raise TmdError(f"{place}: the text is empty", hint='say what is to be done: --text "boil some water"')
    if len(found) > MAX_CHARACTERS:
        raise TmdError(
            f"{place}: the text has {len(found):,} characters, more than {MAX_CHARACTERS:,}", hint="split it"
        )
    try:
        found.encode("utf-8")
    except UnicodeEncodeError as error:
        raise TmdError(f"{place}: character {error.start + 1} is not UTF-8", hint="send UTF-8") from error
    return found


def _read(file: str) -> str:
    from tmd.pddl.reading.syntax import read_standard_input, read_text

    return read_standard_input() if file == "-" else read_text(Path(file))
