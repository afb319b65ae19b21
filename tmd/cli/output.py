"""What commands print: text or one JSON value, as UTF-8, the same bytes for the same input."""

from __future__ import annotations

import sys
from io import TextIOWrapper

from tmd.format.json_layout import lay_out


def emit(text: str, *, error: bool = False) -> None:
    """Write ``text`` to standard output or standard error."""
    stream = sys.stderr if error else sys.stdout
    if isinstance(stream, TextIOWrapper):
        stream.reconfigure(encoding="utf-8", errors="backslashreplace")
    stream.write(text)
    stream.flush()


def emit_json(value: object) -> None:
    """Write one JSON value; keys stand in the order in which they are documented."""
    emit(lay_out(value) + "\n")
