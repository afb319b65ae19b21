"""Results as Python shows them: a ``repr`` on one line, and HTML in notebooks."""

from __future__ import annotations

from collections.abc import Callable
from functools import singledispatch
from textwrap import shorten
from typing import Any, TypeVar

# Maximum number of characters.
LONGEST = 200
_Class = TypeVar("_Class", bound=type)


@singledispatch
def html_of(value: object) -> str | None:
    """Return a result as HTML; ``None`` where there is only its ``repr``.

    Results are of low layers and pages of high ones, so :mod:`tmd.view.notebook` registers the HTML of each class here.
    """
    return None


def short_repr(summary: Callable[[Any], object]) -> Callable[[_Class], _Class]:
    """Return a decorator of a class that shows its objects as their class and a summary: ``<World kitchen1>``.

    In notebooks, they are shown as :func:`html_of` says.
    """

    def decorate(cls: _Class) -> _Class:
        def shown(self: object) -> str:
            return shorten(f"<{type(self).__name__} {summary(self)}", LONGEST - 1, placeholder=" …") + ">"

        def in_notebook(self: object) -> str | None:
            return html_of(self)

        cls.__repr__ = shown  # type: ignore[assignment]
        cls._repr_html_ = in_notebook  # type: ignore[attr-defined]
        return cls

    return decorate
