"""The HTML templates of all pages and panels, and the style that their pieces share."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from jinja2 import Environment

_DATA = Path(__file__).parent / "data"


def style() -> str:
    """Return the style sheet of the fragments: CSS that begins no selector but with ``.tmd-``.

    Colours are custom properties of ``.tmd``, with a light and a dark theme; a page with its own theme
    sets ``data-theme`` of an element around them to ``light`` or ``dark``.
    """
    return data("fragments.css")


@cache
def data(name: str) -> str:
    """Return the text of a file of this package."""
    return (_DATA / name).read_text(encoding="utf-8")


@cache
def templates() -> Environment:
    """Return the templates; values are escaped, unless they are marked as HTML."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    found = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True, loader=FileSystemLoader(_DATA)
    )
    found.filters["number"] = number
    found.filters["one"] = lambda value: f"{value:.1f}"
    found.filters["signed"] = lambda value: f"{value:+.1f}".replace("-", "−") if round(value, 1) else "0.0"
    found.filters["short"] = lambda value: f"{value:.3g}".replace("-", "−")
    found.filters["p"] = lambda value: "< 0.001" if value < 0.001 else f"{value:.3f}"
    return found


def macro(template: str, name: str, *values: object) -> str:
    """Render one macro of a template."""
    return str(getattr(templates().get_template(template).module, name)(*values))


def number(value: float) -> str:
    """Format an energy: two decimals, a true minus, and 0 without either."""
    return f"{value:.2f}".replace("-", "−") if round(value, 2) else "0"


def rejected_page(heading: str, failures: Sequence[object]) -> str:
    """Return the page on what a robot tried in vain, :class:`tmd.robot.video.rejected_ways.FailedStep` each."""
    page = templates().get_template("explanation.html.j2")
    return page.render(heading=heading, failures=failures, style=style() + data("page.css"))
