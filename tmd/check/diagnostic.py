"""The kinds of problems that the checker reports, one problem, and the list that collects them.

The names of the kinds are stable: scripts and editors may rely on them. ``docs/errors.md`` explains each.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from tmd.diagnostics import Edit, Location, TmdError


class Severity(StrEnum):
    """An error keeps ``tmd`` from using a file; a warning is worth a look."""

    ERROR = "error"
    WARNING = "warning"


_ERRORS = (
    # files
    "unreadable", "not-text", "not-utf8", "too-large", "control-character", "look-alike", "outside-folder",
    # form of PDDL
    "foreign-text", "two-definitions", "other-notation",
    "unclosed-parenthesis", "extra-parenthesis", "nested-too-deeply", "empty-file", "syntax",
    "unknown-section", "unknown-keyword", "duplicate-section", "missing-section", "bad-name",
    "unknown-requirement", "not-supported", "when-in-condition", "not-an-effect",
    # YAML, JSON and what they say
    "yaml-syntax", "yaml-tag", "yaml-alias", "duplicate-key", "unknown-key", "bad-value", "json-syntax",
    "missing-file", "unknown-class", "class-cycle", "unknown-part", "unknown-state", "unknown-action",
    "unknown-domain", "unknown-base", "include-cycle", "missing-skill", "missing-role", "stale-domain",
    "bad-goal", "bad-row", "bad-demonstration", "unknown-environment", "not-executable", "no-room", "overlap",
    "goal-not-reached",
    # meaning of PDDL
    "duplicate-name", "type-cycle", "unknown-type", "unknown-predicate", "unknown-function", "unknown-object",
    "free-variable", "wrong-arity", "wrong-type", "wrongly-derived", "domain-mismatch", "contradictory-init",
)  # fmt: skip
_WARNINGS = (
    "missing-requirement", "unsupported-requirement", "odd-name", "glued-variable", "type-twice",
    "undeclared-parent", "variable-twice", "glued-dash", "parent-after-child", "empty-condition",
    "nested-when", "nested-init", "said-twice", "contradictory-effects", "unused-predicate", "unused-parameter",
    "no-effect", "never-applies", "never-produced", "too-many-cases", "type-without-objects", "unreachable-goal",
    "goal-holds", "ambiguous-domain", "constant-again", "section-order",
    "cost-missing", "latin1-comment", "unserved-verb", "unknown-target", "unread-noun", "impossible-goal",
    "idle-phrase", "domain-not-found", "too-many",
)  # fmt: skip
SEVERITY: Mapping[str, Severity] = {
    **dict.fromkeys(_ERRORS, Severity.ERROR),
    **dict.fromkeys(_WARNINGS, Severity.WARNING),
}


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One problem. ``code`` is one of :data:`SEVERITY`; ``edits`` are the remedy, where it is mechanical."""

    location: Location
    code: str
    message: str
    hint: str | None = None
    source: str | None = None
    edits: tuple[Edit, ...] = ()

    @property
    def severity(self) -> Severity:
        """Error or warning."""
        return SEVERITY[self.code]


class Findings:
    """The problems found so far, each once."""

    def __init__(self) -> None:
        self._found: dict[tuple[Location, str, str], TmdError] = {}

    def __len__(self) -> int:
        return len(self._found)

    def add(self, error: TmdError, place: Location) -> None:
        """Add a fault, at ``place`` if it has no location."""
        self._found.setdefault((error.location or place, error.code or "syntax", error.message), error)

    def sorted(self) -> list[Diagnostic]:
        """Return all of them by file, line and column."""
        found = sorted(self._found.items(), key=lambda item: item[0])
        return [Diagnostic(*key, error.hint, error.source, error.edits) for key, error in found]
