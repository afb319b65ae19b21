"""Tokens and nested parentheses of PDDL, each with its file, line and column.

Nothing here recurses, so a text may nest as deeply as it likes. What the groups mean is
:mod:`tmd.pddl.reading.reader`'s affair; :mod:`tmd.pddl.reading.parentheses` makes the groups. A :class:`Source` either
raises the first fault, or hands every fault to whoever collects them, and reading goes on behind it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches
from itertools import islice
from pathlib import Path
from typing import ParamSpec, TypeAlias, TypeVar

from tmd.diagnostics import Location, TmdError

TOKEN = re.compile(r"[()]|[^\s();]+")
_DEEPEST = 100
_LONGEST_LIST_IN_HINT = 8
_MOST_COMPARED = 500


@dataclass(frozen=True, slots=True)
class Word:
    """A name, keyword, variable or number, in lower case."""

    text: str
    location: Location


@dataclass(frozen=True, slots=True)
class Group:
    """What stands between an opening parenthesis (at ``location``) and its closing one (at ``end``)."""

    parts: tuple[Node, ...]
    location: Location
    end: Location
    depth: int

    @property
    def head(self) -> str:
        """The first word, or ``""`` where the group does not begin with a word."""
        return self.parts[0].text if self.parts and isinstance(self.parts[0], Word) else ""


Node: TypeAlias = Word | Group
P = ParamSpec("P")
S = TypeVar("S")
T = TypeVar("T")
Report: TypeAlias = Callable[[TmdError], None]
"""Takes a fault, so that reading can go on."""


@dataclass(frozen=True, slots=True)
class Source:
    """A text that is being read: it knows its lines, so every error can show the one it speaks of.

    ``report`` takes the faults; without it the first one is raised.
    """

    file: str
    lines: tuple[str, ...]
    report: Report | None = field(default=None, compare=False, repr=False)

    def line(self, location: Location | None) -> str | None:
        """The source line at ``location``, if it lies in this text."""
        if location is None or location.file != self.file or not 0 < location.line <= len(self.lines):
            return None
        return self.lines[location.line - 1]

    def error(self, message: str, location: Location | None, hint: str | None = None, code: str = "syntax") -> TmdError:
        """An error at ``location`` that carries its source line."""
        return TmdError(message, location=location, hint=hint, source=self.line(location), code=code)

    def fault(self, error: TmdError) -> None:
        """Raise ``error``, or report it and return."""
        if self.report is None:
            raise error
        self.report(error)

    def warn(self, message: str, location: Location | None, hint: str | None, code: str) -> None:
        """Report what is not a fault but worth telling; nobody is told where faults are raised."""
        if self.report is not None:
            self.report(self.error(message, location, hint, code))

    def recover(self, otherwise: S, read: Callable[P, T], *arguments: P.args, **named: P.kwargs) -> S | T:
        """What ``read`` returns; where it fails and faults are reported, ``otherwise``."""
        if self.report is None:
            return read(*arguments, **named)
        try:
            return read(*arguments, **named)
        except TmdError as error:
            self.report(error)
            return otherwise

    def word(self, location: Location | None, number: int) -> Location | None:
        """Where the word ``number`` of the group at ``location`` stands (its head is 0); groups count as one."""
        place = None
        depth = count = 0
        for token, place in self.tokens(location):
            if depth == 1 and token != ")":
                if count == number:
                    return place
                count += 1
            depth += {"(": 1, ")": -1}.get(token, 0)
            if depth <= 0:
                break
        return location

    def type_of(self, location: Location | None, name: str) -> Location | None:
        """Where the type ``name`` of the typed name at ``location`` stands."""
        after_dash = False
        for token, place in self.tokens(location):
            if after_dash and token.lower() == name:
                return place
            if token == ")" or (after_dash and token not in ("(", "either")):
                break
            after_dash |= token == "-"
        return location

    def tokens(self, location: Location | None) -> Iterator[tuple[str, Location]]:
        """The tokens from ``location`` on, as they are written."""
        if self.line(location) is None or location is None:
            return
        for number in range(location.line, len(self.lines) + 1):
            code = self.lines[number - 1].partition(";")[0]
            for match in TOKEN.finditer(code, location.column - 1 if number == location.line else 0):
                yield match[0], Location(self.file, number, match.start() + 1)


@dataclass(frozen=True, slots=True)
class Document:
    """A parsed text: its outermost groups, the comment of each line, and the deepest group."""

    source: Source
    groups: tuple[Group, ...]
    comments: dict[int, str]
    deepest: Group | None

    def check_depth(self) -> None:
        """Make sure that what reads groups within groups comes to an end.

        Raises:
            TmdError: They nest more deeply than anything that people write.
        """
        if self.deepest is not None and self.deepest.depth > _DEEPEST:
            message = f"nested more than {_DEEPEST} levels deep"
            raise self.source.error(message, self.deepest.location, None, "nested-too-deeply")


def nearest(name: str, declared: Sequence[str], *, what: str = "declared") -> str | None:
    """A hint that names the declared name closest to ``name``, or all of them where they are few."""
    candidates = declared if len(declared) <= _MOST_COMPARED else _alike(name, declared)
    close = get_close_matches(name, candidates, n=1, cutoff=0.6)
    if close:
        return f'did you mean "{close[0]}"?'
    if declared and len(declared) <= _LONGEST_LIST_IN_HINT:
        return f"{what}: {', '.join(declared)}"
    return None


def _alike(name: str, declared: Sequence[str]) -> list[str]:
    """Of many names those that may be near ``name``: comparing with all of them takes too long."""
    ends = (name[:2], name[-2:])
    near = (d for d in declared if abs(len(d) - len(name)) <= 2 and (d.startswith(ends[0]) or d.endswith(ends[1])))
    return list(islice(near, _MOST_COMPARED))


def read_text(path: str | Path) -> str:
    """The text of a UTF-8 file, without byte order mark.

    Raises:
        TmdError: The file is missing, unreadable, binary or not UTF-8.
    """
    place = Location(str(path), 1, 1)
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise TmdError(f"cannot be read: {error.strerror or error}", location=place, code="unreadable") from error
    if b"\0" in data:
        raise TmdError("is not a text file", location=place, hint="save it as UTF-8 text", code="not-text")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        before = data[: error.start].decode("utf-8-sig", errors="replace")
        line = before.count("\n") + 1
        column = len(before) - (before.rfind("\n") + 1) + 1
        raise TmdError(
            f"is not UTF-8: byte 0x{data[error.start]:02x}",
            location=Location(str(path), line, column),
            hint="save the file as UTF-8 text",
            code="not-utf8",
        ) from error


def split_lines(text: str) -> tuple[str, ...]:
    """The lines of ``text``, whatever ends them, without byte order mark."""
    return tuple(text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n").split("\n"))
