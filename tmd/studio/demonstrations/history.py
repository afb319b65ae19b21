"""Undo and redo over the versions of an immutable value."""

from __future__ import annotations

from typing import Generic, TypeVar

_Version = TypeVar("_Version")


class History(Generic[_Version]):
    """The versions of an immutable value, one of them current."""

    def __init__(self, first: _Version) -> None:
        self._versions = [first]
        self._at = 0

    @property
    def current(self) -> _Version:
        """The current version."""
        return self._versions[self._at]

    def add(self, version: _Version) -> None:
        """Make a new version current, in place of all that were undone."""
        self._versions[self._at + 1 :] = [version]
        self._at += 1

    def undo(self) -> bool:
        """Go back to the version before; return false if there is none."""
        moved = self._at > 0
        self._at -= moved
        return moved

    def redo(self) -> bool:
        """Go to the version after; return false if there is none."""
        moved = self._at + 1 < len(self._versions)
        self._at += moved
        return moved
