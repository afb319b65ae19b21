"""What commands print: text or one JSON value, as UTF-8, the same bytes for the same input."""

from __future__ import annotations

import json
import sys
from io import TextIOWrapper

DIGITS = 6
"""Numbers of JSON output are rounded to this many decimals, so that the last bits of a sum do not show."""
_WIDTH = 120
"""A JSON object or list that fits on a line of this many characters stands on one."""


def emit(text: str, *, error: bool = False) -> None:
    """Write ``text`` to standard output or standard error."""
    stream = sys.stderr if error else sys.stdout
    if isinstance(stream, TextIOWrapper):
        stream.reconfigure(encoding="utf-8", errors="backslashreplace")
    stream.write(text)
    stream.flush()


def emit_json(value: object) -> None:
    """Write one JSON value; keys stand in the order in which they are documented."""
    emit(_laid_out(value, 0) + "\n")


def _laid_out(value: object, indent: int) -> str:
    """JSON for people and programs: what fits stands on one line."""
    line = json.dumps(value, ensure_ascii=False)
    if not value or not isinstance(value, dict | list) or (indent and indent + len(line) <= _WIDTH):
        return line
    inner = " " * (indent + 2)
    if isinstance(value, dict):
        parts = [
            f"{inner}{json.dumps(key, ensure_ascii=False)}: {_laid_out(v, indent + 2)}" for key, v in value.items()
        ]
        return "{\n" + ",\n".join(parts) + f"\n{' ' * indent}}}"
    return "[\n" + ",\n".join(f"{inner}{_laid_out(v, indent + 2)}" for v in value) + f"\n{' ' * indent}]"


def rounded(value: float) -> float:
    """A number as it is printed; there is no negative zero."""
    return round(value, DIGITS) + 0.0
