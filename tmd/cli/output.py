"""What commands print: text or one JSON value, as UTF-8, the same bytes for the same input."""

from __future__ import annotations

import os
import sys
from contextlib import nullcontext, suppress
from io import TextIOBase, TextIOWrapper

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
            opened = os.open(os.devnull, os.O_RDWR)
            if opened != number:
                os.dup2(opened, number)
                os.close(opened)
            os.set_inheritable(number, True)
            setattr(sys, name, open(number, mode, encoding="utf-8", closefd=False))  # noqa: SIM115 - it stays open


def emit(text: str, *, error: bool = False) -> None:
    """Write ``text`` to standard output or standard error; where no error can be written, the command goes on."""
    stream = sys.stderr if error else sys.stdout
    with suppress(OSError) if error else nullcontext():
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(encoding="utf-8", errors="backslashreplace")
        stream.write(text)
        stream.flush()


class ErrorStream(TextIOBase):
    """Standard error for libraries that write to a file: what cannot be written is dropped, as by :func:`emit`."""

    encoding = "utf-8"

    def write(self, text: str) -> int:
        """Write it; its length."""
        emit(text, error=True)
        return len(text)

    def isatty(self) -> bool:
        """Whether somebody looks at it."""
        return sys.stderr.isatty()

    def fileno(self) -> int:
        """Its number, for its width."""
        return sys.stderr.fileno()


def emit_json(value: object) -> None:
    """Write one JSON value; keys stand in the order in which they are documented."""
    emit(lay_out(value) + "\n")
