"""JSON for people and programs: what fits on a line stands on one."""

from __future__ import annotations

import json

# An object or list that fits on a line of this many characters stands on one.
WIDTH = 120


def lay_out(value: object, indent: int = 0) -> str:
    """Return the text of a JSON value; keys keep their order."""
    line = json.dumps(value, ensure_ascii=False)
    if not value or not isinstance(value, dict | list) or (indent and indent + len(line) <= WIDTH):
        return line
    inner = " " * (indent + 2)
    if isinstance(value, dict):
        parts = [f"{inner}{json.dumps(key, ensure_ascii=False)}: {lay_out(v, indent + 2)}" for key, v in value.items()]
        return "{\n" + ",\n".join(parts) + f"\n{' ' * indent}}}"
    return "[\n" + ",\n".join(f"{inner}{lay_out(v, indent + 2)}" for v in value) + f"\n{' ' * indent}]"
