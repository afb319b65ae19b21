"""Errors that people read, and the exit code each of them ends the program with.

Every error a user can cause is a :class:`TmdError`: one line that says what is wrong, where, and what to do.
Anything else that reaches the command line is a fault of the program (exit code 39).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum, StrEnum

from tmd.short_repr import short_repr


class ExitCode(IntEnum):
    """Exit codes of ``tmd``: 0 success, 2 wrong usage as of most commands; 10 a clean "no", 20 a limit, 30 an error."""

    OK = 0
    TESTS_FAILED = 1
    """Sentence tests were run, and not all of them passed."""
    USAGE = 2
    """The command line is wrong."""
    UNREACHABLE = 10
    """It is proven that no plan exists."""
    INVALID_PLAN = 11
    """The plan was read, and it does not work."""
    NOT_GROUNDED = 12
    """The text was read, and no valid plan for it was found."""
    FAULTS_FOUND = 13
    """A check ended and found faults."""
    NOT_EXECUTED = 14
    """The robot stopped before everything that its plan is for was brought about."""
    QUESTION = 15
    """Two readings of the request differ, and nobody answered which one is meant; the first with a plan is taken."""
    GAVE_UP = 20
    """A search ended at its limit: nothing is proven."""
    BAD_INPUT = 31
    """A file or a text cannot be used; the message says where and why."""
    MISSING_TOOL = 32
    """An optional tool or package that this command needs is not there."""
    BAD_DATA = 33
    """A data set is missing, truncated or of another version."""
    CANNOT_WRITE = 34
    """Output could not be written; nothing was half-written."""
    PLANNER_FAILED = 35
    """A planner died, or what it gave is no plan."""
    MODEL_FAILED = 36
    """The language model cannot be asked, or gives no answer."""
    INTERNAL = 39
    """A fault of tmd itself."""
    INTERRUPTED = 130
    """Stopped by the user."""


class RefusalKind(StrEnum):
    """Kinds of reasons for which a request has no plan."""

    NO_SUCH_THING = "no-such-thing"
    IMPOSSIBLE = "impossible"
    UNKNOWN_VERB = "unknown-verb"
    NOT_UNDERSTOOD = "not-understood"
    CONDITION = "condition"
    CONTRADICTION = "contradiction"
    UNSAFE = "unsafe"
    NO_REQUEST = "no-request"
    GAVE_UP = "gave-up"


@short_repr(lambda refusal: f"{refusal.kind}: {refusal.message}")
@dataclass(frozen=True, slots=True)
class Refusal:
    """The reason for which a request, or a part of it, has no goal or no plan.

    It is a result, not an error.

    Attributes:
        message: The reason, in one line.
        hint: What to say or do instead.
        rows: For authors, the rows that were tried, each with its place and the reason why it did not fit.
    """

    kind: RefusalKind
    message: str
    hint: str | None = None
    rows: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, order=True)
class Location:
    """A place in a text: lines and columns count from 1."""

    file: str
    line: int
    column: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


@dataclass(frozen=True, slots=True, order=True)
class Edit:
    """A part of the remedy of a fault: the text from ``start`` to before ``end`` becomes ``text``.

    Line 0 is that of a new file, which is written only where there is none yet.
    """

    start: Location
    end: Location
    text: str = ""


class TmdError(Exception):
    """Something the user can fix.

    Args:
        message: What is wrong, in one line.
        location: Where, if it stands in a text.
        hint: What to do about it, in one line.
        source: The source line at ``location``, shown with a caret when the error is printed at length.
        code: Which kind of fault it is, by its name in ``docs/errors.md``; empty where no checker finds it.
        edits: The remedy, where it is mechanical.
    """

    exit_code = ExitCode.BAD_INPUT

    def __init__(
        self,
        message: str,
        *,
        location: Location | None = None,
        hint: str | None = None,
        source: str | None = None,
        code: str = "",
        edits: Sequence[Edit] = (),
    ) -> None:
        super().__init__(message)
        self.message = message
        self.location = location
        self.hint = hint
        self.source = source
        self.code = code
        self.edits = tuple(edits)

    def __str__(self) -> str:
        place = f"{self.location}: " if self.location else ""
        hint = f" ({self.hint})" if self.hint else ""
        return f"{place}{self.message}{hint}"


class LimitError(TmdError):
    """Something is too large to be worked out: nothing is proven of it."""

    exit_code = ExitCode.GAVE_UP


class OptionError(TmdError):
    """An option that was given has no meaning here, or one that is needed was not given."""

    exit_code = ExitCode.USAGE


class DataError(TmdError):
    """A data set is missing, truncated or of another version."""

    exit_code = ExitCode.BAD_DATA


def one_line(text: str) -> str:
    """Return a text on one line, without control characters: nothing in it moves the cursor of a terminal."""
    return " ".join("".join(sign if sign.isprintable() else " " for sign in text).split())


def install_extra(extra: str) -> str:
    """Return the command that installs an extra of this distribution, for hints."""
    return f"pip install 'tell-me-dave[{extra}]'"


class MissingToolError(TmdError):
    """An optional tool or package is not installed."""

    exit_code = ExitCode.MISSING_TOOL


class OutputError(TmdError):
    """A file or directory cannot be written."""

    exit_code = ExitCode.CANNOT_WRITE


class PlannerError(TmdError):
    """A planner died, or what it gave is no plan."""

    exit_code = ExitCode.PLANNER_FAILED
