"""Seeded damage to bytes and to JSON values."""

from __future__ import annotations

import json
from random import Random
from typing import Any

PIECES: tuple[bytes, ...] = (
    b"(", b")", b"((", b"?x", b" - ", b":init", b":effect", b"(not ", b";", b"{", b"}", b"[", b"]",
    b"{{a}}: 1\n", b": ",
    b"- ", b"? [a]\n: 1\n", b"&a", b"*a", b"!!int x", b"\t", b"\0", b"\xff", b"\xef\xbb\xbf", b"\r", b"\r\n",
    b"\xe2\x80\xa8",
    b"\x1b[31m", b"9" * 5_000, b"-1", b"1e999", b"nan", b"null", b"true", b'"', b"'", b"[" * 3_000, b"(" * 3_000,
    b"{a: " * 500,
    b"a" * 20_000, b"../../x", b"\xd9\x85", b"0x_", b"2020-02-30", b"<!ENTITY a 'b'>", b"\n\n", b" ",
)  # fmt: skip
VALUES: tuple[Any, ...] = (
    None, True, -1, 0, 10**30, 1.5, 1e308, "", "x", "5", "?z9", "../../x", "a\nb", "\ud83d\ude00", [], {}, [[]],
    {"a": 1}, "(and)",
)  # fmt: skip


def damaged(data: bytes, choose: Random) -> bytes:
    """``data`` with one to four faults."""
    for _ in range(choose.choice((1, 1, 1, 2, 4))):
        place, length = choose.randrange(len(data) + 1), choose.choice((0, 1, 5, 40, 400))
        kind = choose.randrange(7)
        if kind == 0:
            data = data[:place]
        elif kind == 1:
            data = data[:place] + bytes([choose.randrange(256)]) + data[place + 1 :]
        elif kind == 2:
            data = data[:place] + data[place + length :]
        elif kind == 3:
            data = data[:place] + data[place : place + length] * choose.choice((2, 3, 50)) + data[place + length :]
        elif kind == 4:
            other = choose.randrange(len(data) + 1)
            data = data[:place] + data[other : other + length] + data[place:]
        elif kind == 5 and choose.random() < 0.05:
            data = choose.choice((b"", data.decode("utf-8", "replace").encode("utf-16"), data.replace(b"\n", b"\r\n")))
        else:
            data = data[:place] + choose.choice(PIECES) + data[place + choose.choice((0, length)) :]
    return data


def damaged_json(data: bytes, choose: Random) -> bytes:
    """A JSON text, or a line of JSON Lines, with one to three values changed, doubled or gone."""
    lines = data.splitlines(keepends=True)
    whole = len(lines) != sum(line.startswith(b"{") and line.rstrip().endswith(b"}") for line in lines)
    number = 0 if whole else choose.randrange(len(lines))
    value = json.loads(data if whole else lines[number])
    for _ in range(choose.choice((1, 1, 3))):
        _damage(value, choose)
    written = json.dumps(value).encode() + b"\n"
    return written if whole else b"".join([*lines[:number], written, *lines[number + 1 :]])


def _damage(value: object, choose: Random) -> None:
    while isinstance(value, dict | list) and value:
        key: Any = choose.choice(list(value) if isinstance(value, dict) else range(len(value)))
        inner = value[key]
        if not isinstance(inner, dict | list) or not inner or choose.random() < 0.25:
            if choose.random() < 0.3:
                del value[key]
            else:
                value[key] = choose.choice(VALUES)
            return
        value = inner
