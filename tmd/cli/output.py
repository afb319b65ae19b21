"""What commands print: text or one JSON value, as UTF-8, the same bytes for the same input."""

from __future__ import annotations

import json
import sys
from io import TextIOWrapper

DIGITS = 6
"""Numbers of JSON output are rounded to this many decimals, so that the last bits of a sum do not show."""


def emit(text: str, *, error: bool = False) -> None:
    """Write ``text`` to standard output or standard error."""
    stream = sys.stderr if error else sys.stdout
    if isinstance(stream, TextIOWrapper):
        stream.reconfigure(encoding="utf-8", errors="backslashreplace")
    stream.write(text)
    stream.flush()


def emit_json(value: object) -> None:
    """Write one JSON value; keys stand in the order in which they are documented."""
    emit(json.dumps(value, indent=2, ensure_ascii=False) + "\n")


def rounded(value: float) -> float:
    """A number as it is printed; there is no negative zero."""
    return round(value, DIGITS) + 0.0
