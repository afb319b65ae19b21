"""Undo and redo: what somebody made, version by version."""

from __future__ import annotations

from typing import Generic, TypeVar

_Version = TypeVar("_Version")


class History(Generic[_Version]):
    """The versions of an immutable thing, one of them current.

    Args:
        first: The first version.
    """

    def __init__(self, first: _Version) -> None:
        self._versions = [first]
        self._at = 0

    @property
    def current(self) -> _Version:
        """The version that counts."""
        return self._versions[self._at]

    def add(self, version: _Version) -> None:
        """A new version; what had been undone is forgotten."""
        self._versions[self._at + 1 :] = [version]
        self._at += 1

    @property
    def can_undo(self) -> bool:
        """Whether there is an earlier version."""
        return self._at > 0

    @property
    def can_redo(self) -> bool:
        """Whether something was undone."""
        return self._at + 1 < len(self._versions)

    def undo(self) -> bool:
        """Back to the version before; false if there is none."""
        moved = self.can_undo
        self._at -= moved
        return moved

    def redo(self) -> bool:
        """To the version after; false if there is none."""
        moved = self.can_redo
        self._at += moved
        return moved
