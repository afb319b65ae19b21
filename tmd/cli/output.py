"""The output of commands: text or one JSON value, as UTF-8, the same bytes for the same input."""

from __future__ import annotations

import os
import sys
from contextlib import nullcontext, suppress
from io import TextIOWrapper
from pathlib import Path
from typing import TextIO

from tmd.cli.colour import coloured, takes_colour
from tmd.files import write_text
from tmd.format.json_layout import lay_out


def open_closed_streams() -> None:
    """Let the standard streams that were closed when the program began read nothing, and write to nowhere.

    Daemons and schedulers start programs like that. The next file that is opened would else be given the number of the
    closed stream, and a library that prints would print into it.
    """
    for number, (name, mode) in enumerate((("stdin", "r"), ("stdout", "w"), ("stderr", "w"))):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # gets the lowest number that is free
            os.set_inheritable(number, True)
            setattr(sys, name, open(number, mode, encoding="utf-8", closefd=False))  # noqa: SIM115 - it stays open


def settle_errors() -> None:
    """Let what cannot be written to standard error go nowhere: the interpreter would end with a code of its own."""
    try:
        sys.stderr.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stderr.fileno())


def emit(value: object, target: Path | None = None, *, error: bool = False) -> None:
    """Write a text, or any other value as JSON with its keys in their order, to standard output or standard error.

    With a ``target``, write it to that file. Where no error can be written, the command goes on. A terminal gets a text
    in colour.
    """
    text = value if isinstance(value, str) else lay_out(value) + "\n"
    if target is not None:
        return write_text(target, text)
    stream = sys.stderr if error else sys.stdout
    if isinstance(value, str) and takes_colour(stream):
        text = coloured(text)
    with suppress(OSError) if error else nullcontext():
        _write(stream, text)


def _write(stream: TextIO, text: str) -> None:
    if isinstance(stream, TextIOWrapper):
        stream.reconfigure(encoding="utf-8", errors="backslashreplace")
    stream.write(text)
    stream.flush()
