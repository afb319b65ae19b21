"""Numbers written as ranges: ``1-8`` or ``1,3,5-7``."""

from __future__ import annotations

import re

import click

_PIECE = re.compile(r"\s*(\d{1,4})\s*(?:-\s*(\d{1,4})\s*)?")


def numbers(ctx: click.Context, param: click.Parameter, value: str | None) -> tuple[int, ...] | None:
    """What an option of numbers says: each number once, in ascending order (a callback of :mod:`click`).

    Raises:
        click.BadParameter: It says anything else.
    """
    if value is None:
        return None
    found: set[int] = set()
    for piece in value.split(","):
        match = _PIECE.fullmatch(piece)
        if match is None:
            raise click.BadParameter(f"'{piece}' is neither a number nor a range such as 1-8", ctx, param)
        first, last = int(match[1]), int(match[2] or match[1])
        if last < first:
            raise click.BadParameter(f"the range {piece.strip()} runs backwards", ctx, param)
        found.update(range(first, last + 1))
    return tuple(sorted(found))
