"""The templates of this package, and the style that all of its pieces share."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from jinja2 import Environment

_DATA = Path(__file__).parent / "data"


def style() -> str:
    """The style sheet of the fragments: CSS that begins no selector but with ``.tmd-``.

    Colours are custom properties of ``.tmd``, with a light and a dark theme; a page that has a theme of its own
    sets ``data-theme`` of an element around them to ``light`` or ``dark``.
    """
    return data("fragments.css")


@cache
def data(name: str) -> str:
    """A file of this package."""
    return (_DATA / name).read_text(encoding="utf-8")


@cache
def templates() -> Environment:
    """The templates; whatever they are given is escaped, unless it is marked as HTML."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    found = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True, loader=FileSystemLoader(_DATA)
    )
    found.filters["number"] = number
    return found


def number(value: float) -> str:
    """An energy: two decimals, a true minus, and 0 without either."""
    return f"{value:.2f}".replace("-", "−") if round(value, 2) else "0"
