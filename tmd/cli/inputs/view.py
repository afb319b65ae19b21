"""What ``tmd view`` was asked to show, and what it found."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tmd.diagnostics import ExitCode, Location
from tmd.pddl.validator import Verdict
from tmd.view.subject import Subject

STANDARD = "-"
"""Standard input or output."""


@dataclass(frozen=True, slots=True)
class ViewRequest:
    """The options that say what a file is and where it belongs."""

    source: str
    environment: str | None = None
    domain: str | None = None
    problem: Path | None = None
    demonstration: str | None = None
    strip: Path | None = None

    @property
    def name(self) -> str:
        """The file as messages name it."""
        return "standard input" if self.source == STANDARD else self.source

    @property
    def path(self) -> Path:
        """The file."""
        return Path(self.source)


@dataclass(frozen=True, slots=True)
class FoundSubject:
    """What is to be shown.

    Attributes:
        subject: The subject of the page.
        beside: Where the page goes if nobody says.
        remarks: Lines for standard error.
        locations: Where the steps of a plan file stand.
        of_text: Whether there is a text that should have a plan.
    """

    subject: Subject
    beside: Path
    remarks: tuple[str, ...] = ()
    locations: tuple[Location, ...] = ()
    of_text: bool = False

    def ending(self, verdict: Verdict) -> ExitCode:
        """How the program ends, given what the validator says of the plan."""
        if self.of_text and not (self.subject.steps or self.subject.plans):
            return ExitCode.NOT_GROUNDED
        return ExitCode.OK if verdict.valid else ExitCode.INVALID_PLAN

    def complaint(self, verdict: Verdict) -> str:
        """Why the plan does not work, for standard error; empty where it does, or where there is none."""
        if verdict.valid or not self.subject.steps:
            return ""
        place = f"{self.locations[verdict.step - 1]}: " if verdict.step and self.locations else ""
        return f"invalid: {place}{verdict.reason}\n"
