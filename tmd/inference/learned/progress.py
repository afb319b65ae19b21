"""Progress of something that may take a while, on standard error: nothing where it is quick."""

from __future__ import annotations

import sys
import time
from types import TracebackType
from typing import Self

_PATIENCE = 2.0
"""Seconds that nobody minds waiting without a word."""


class Progress:
    """Tells of work under way, once it has taken two seconds: its share on a terminal, one line elsewhere.

    Args:
        what: The work, such as *learning from the demonstrations of kitchen*.
    """

    def __init__(self, what: str) -> None:
        self._what = what
        self._begun = time.monotonic()
        self._shown = ""

    def tell(self, share: float) -> None:
        """Say how much is done, from 0 to 1."""
        if sys.stderr is None or time.monotonic() - self._begun < _PATIENCE:
            return
        if sys.stderr.isatty():
            self._show(f"\r{self._what}: {share:4.0%}")
        elif not self._shown:
            self._show(f"{self._what} …\n")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        if self._shown.startswith("\r"):
            self._show("\r" + " " * len(self._shown) + "\r")

    def _show(self, text: str) -> None:
        if text != self._shown:
            self._shown = text
            sys.stderr.write(text)
            sys.stderr.flush()
