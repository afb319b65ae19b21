"""One problem of a file, and the list that collects them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from tmd.check.codes import SEVERITY, Severity
from tmd.diagnostics import Location, TmdError


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One problem.

    Attributes:
        location: Where it is.
        code: Its kind, one of :mod:`tmd.check.codes`.
        message: What is wrong, in one line.
        hint: What to do about it.
        source: The source line.
    """

    location: Location
    code: str
    message: str
    hint: str | None = None
    source: str | None = None

    @property
    def severity(self) -> Severity:
        """Return whether it is an error, a warning or a note."""
        return SEVERITY[self.code]


class Findings:
    """The problems found so far, each once."""

    def __init__(self) -> None:
        self._found: dict[tuple[Location, str, str], Diagnostic] = {}

    def __len__(self) -> int:
        return len(self._found)

    def add(self, error: TmdError, place: Location) -> None:
        """Add a fault, at ``place`` if it has no location."""
        self.put(Diagnostic(error.location or place, error.code or "syntax", error.message, error.hint, error.source))

    def put(self, diagnostic: Diagnostic) -> None:
        """Take in a problem."""
        self._found.setdefault((diagnostic.location, diagnostic.code, diagnostic.message), diagnostic)

    def extend(self, diagnostics: Iterable[Diagnostic]) -> None:
        """Take in several problems."""
        for diagnostic in diagnostics:
            self.put(diagnostic)

    def sorted(self) -> list[Diagnostic]:
        """Return all of them by file, line and column."""
        return [self._found[key] for key in sorted(self._found)]
