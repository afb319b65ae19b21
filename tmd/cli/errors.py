"""Errors as a line for people, JSON for programs, and an exit code."""

from __future__ import annotations

import errno
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass

import click

from tmd.diagnostics import (
    DataError,
    ExitCode,
    LimitError,
    Location,
    MissingToolError,
    OutputError,
    PlannerError,
    TmdError,
    one_line,
)

_CANNOT_WRITE = {errno.ENOSPC, errno.EROFS, errno.EDQUOT, errno.EFBIG, errno.EIO}
_WIDTH = 100
"""Longer source lines are shown around the fault only."""


@dataclass(frozen=True, slots=True)
class Fault:
    """An error as the user sees it."""

    code: ExitCode
    message: str
    location: Location | None = None
    hint: str | None = None
    source: str | None = None

    def text(self) -> str:
        """Return the fault for people: one line, the source line with a caret where there is one, and the hint."""
        place = f"{self.location}: " if self.location else ""
        lines = [f"error: {place}{one_line(self.message)}"]
        if self.location and self.source is not None:
            lines += pointed(self.source, self.location.column)
        if self.hint:
            lines.append(f"hint: {one_line(self.hint)}")
        return "\n".join(lines) + "\n"

    def json(self) -> Mapping[str, object]:
        """Return the fault for programs."""
        place = self.location
        where = {"file": place.file, "line": place.line, "column": place.column} if place else None
        return {
            "error": {
                "code": int(self.code),
                "name": self.code.name,
                "message": one_line(self.message),
                "location": where,
                "hint": one_line(self.hint) if self.hint else None,
            }
        }


def fault_of(error: BaseException, command: str = "tmd") -> Fault:
    """Return an error as the user sees it; unforeseen ones are faults of the program.

    ``command`` is what it was doing; its help is the last resort of those who look for a remedy.
    """
    if isinstance(error, TmdError):
        hint = error.hint or _remedy(error, command)
        return Fault(error.exit_code, error.message, error.location, hint, error.source)
    if isinstance(error, click.ClickException):
        context = getattr(error, "ctx", None)
        command = context.command_path if context else command
        return Fault(ExitCode.USAGE, error.format_message(), hint=f"see {command} --help")
    if isinstance(error, KeyboardInterrupt | click.Abort):
        return Fault(ExitCode.INTERRUPTED, "interrupted")
    if isinstance(error, RecursionError):
        return Fault(ExitCode.BAD_INPUT, "the input is nested too deeply", hint="write it with fewer levels")
    if isinstance(error, MemoryError):
        return Fault(ExitCode.GAVE_UP, "out of memory", hint="use a smaller problem, or a smaller --beam")
    if isinstance(error, UnicodeError):
        return Fault(ExitCode.BAD_INPUT, f"text that is not UTF-8: {error}", hint="save it as UTF-8")
    if isinstance(error, OSError):
        return _system_fault(error)
    if isinstance(error, ImportError) and error.name and error.name.partition(".")[0] != "tmd":
        message = f"the package {error.name.partition('.')[0]} is missing or damaged"
        return Fault(
            ExitCode.MISSING_TOOL,
            message,
            hint="install tmd again with its dependencies: pip install . in a copy of its repository",
        )
    return _internal(error)


_CHECKED = (".pddl", ".yaml", ".yml", ".jsonl")
"""What ``tmd check`` looks into."""
_REMEDIES: Mapping[type[TmdError], str] = {
    PlannerError: "try another --planner; `tmd plan --help` names them",
    LimitError: "use a smaller problem, or fewer words",
    DataError: "compare the data with the released files",
    OutputError: "check that the directory exists, that you may write there and that the disk has room",
    MissingToolError: "install it, or do without what needs it",
}


def _remedy(error: TmdError, command: str) -> str:
    """Return the remedy for an error without a hint."""
    kind = next((remedy for kind, remedy in _REMEDIES.items() if isinstance(error, kind)), None)
    if kind is not None:
        return kind
    if error.location is not None and error.location.file.endswith(_CHECKED):
        return f"`tmd check {error.location.file}` reports everything that is wrong there"
    return f"see {command} --help"


def _system_fault(error: OSError) -> Fault:
    message = f"{error.filename or 'output'}: {error.strerror or error}"
    if error.errno in _CANNOT_WRITE:
        return Fault(ExitCode.CANNOT_WRITE, message, hint="make room, or write elsewhere")
    if error.filename:
        return Fault(ExitCode.BAD_INPUT, message, hint="check the path, and that you may read there")
    if "No usable temporary directory" in str(error):  # as tempfile says that it could not write into any
        message = f"no temporary file can be written in any of {str(error).partition('found in ')[2]}"
        return Fault(ExitCode.CANNOT_WRITE, message, hint="make room, or name a directory that has some: TMPDIR=…")
    return _internal(error)


def _internal(error: BaseException) -> Fault:
    what = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    return Fault(
        ExitCode.INTERNAL, f"internal error: {what}; please report", hint="tmd --debug … shows where it happened"
    )


def pointed(source: str, column: int) -> list[str]:
    """Return the source line, and under it a caret at ``column``; a long line is cut to what is around it."""
    line = "".join(c if c.isprintable() else " " for c in source.rstrip("\r\n"))
    start = max(0, column - 1 - _WIDTH // 2) if len(line) > _WIDTH else 0
    shown = line[start : start + _WIDTH]
    before = shown[: max(0, column - 1 - start)]
    width = sum(2 if unicodedata.east_asian_width(c) in "WF" else 1 for c in before)
    return [f"  {shown}", f"  {' ' * width}^"]
