"""A ``repr`` on one line, for results that hold whole environments."""

from __future__ import annotations

from collections.abc import Callable
from textwrap import shorten
from typing import Any, TypeVar

# Maximum number of characters.
LONGEST = 200
_Class = TypeVar("_Class", bound=type)


def short_repr(summary: Callable[[Any], object]) -> Callable[[_Class], _Class]:
    """Return a decorator of a class that shows its objects as their class and a summary: ``<World kitchen1>``."""

    def decorate(cls: _Class) -> _Class:
        def shown(self: object) -> str:
            return shorten(f"<{type(self).__name__} {summary(self)}", LONGEST - 1, placeholder=" …") + ">"

        cls.__repr__ = shown  # type: ignore[assignment]
        return cls

    return decorate
