"""Tokens and nested parentheses of PDDL, each with its file, line and column.

Nothing here recurses, so a text may nest as deeply as it likes. What the groups mean is
:mod:`tmd.pddl.reader`'s affair; only the place of PDDL's section keywords is used, to tell which parenthesis
was left open.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import TypeAlias

from tmd.errors import Location, TmdError

_TOKEN = re.compile(r"[()]|[^\s();]+")
_CONTROL = re.compile(r"[\x00-\x08\x0e-\x1f\x7f]")
_PARTS_OF_SECTIONS = frozenset({":parameters", ":precondition", ":effect"})
_LONGEST_LIST_IN_HINT = 8


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


@dataclass(frozen=True, slots=True)
class Source:
    """A text that is being read: it knows its lines, so every error can show the one it speaks of."""

    file: str
    lines: tuple[str, ...]

    def line(self, location: Location | None) -> str | None:
        """The source line at ``location``, if it lies in this text."""
        if location is None or location.file != self.file or not 0 < location.line <= len(self.lines):
            return None
        return self.lines[location.line - 1]

    def error(self, message: str, location: Location | None, hint: str | None = None) -> TmdError:
        """An error at ``location`` that carries its source line."""
        return TmdError(message, location=location, hint=hint, source=self.line(location))


@dataclass(frozen=True, slots=True)
class Document:
    """A parsed text: its outermost groups, the comment of each line, and the deepest group."""

    source: Source
    groups: tuple[Group, ...]
    comments: dict[int, str]
    deepest: Group | None


@dataclass(slots=True)
class _Open:
    """A group that is still open."""

    location: Location
    parts: list[Node]

    @property
    def head(self) -> str:
        return self.parts[0].text if self.parts and isinstance(self.parts[0], Word) else ""


def nearest(name: str, declared: Sequence[str], *, what: str = "declared") -> str | None:
    """A hint that names the declared name closest to ``name``, or all of them where they are few."""
    close = get_close_matches(name, declared, n=1, cutoff=0.6)
    if close:
        return f'did you mean "{close[0]}"?'
    if declared and len(declared) <= _LONGEST_LIST_IN_HINT:
        return f"{what}: {', '.join(declared)}"
    return None


def read_text(path: str | Path) -> str:
    """The text of a UTF-8 file, without byte order mark.

    Raises:
        TmdError: The file is missing, unreadable, binary or not UTF-8.
    """
    place = Location(str(path), 1, 1)
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise TmdError(f"cannot be read: {error.strerror or error}", location=place) from error
    if b"\0" in data:
        raise TmdError("is not a text file", location=place, hint="save it as UTF-8 text")
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
        ) from error


def split_lines(text: str) -> tuple[str, ...]:
    """The lines of ``text``, whatever ends them, without byte order mark."""
    return tuple(text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n").split("\n"))


def parse(text: str, file: str) -> Document:
    """Split ``text`` into groups.

    Raises:
        TmdError: A parenthesis is missing or left over, or a word stands outside all parentheses.
    """
    lines = split_lines(text)
    source = Source(file, lines)
    comments: dict[int, str] = {}
    groups: list[Group] = []
    stack: list[_Open] = []
    deepest: Group | None = None
    for number, line in enumerate(lines, start=1):
        code, mark, comment = line.partition(";")
        control = _CONTROL.search(code)
        if control:
            place = Location(file, number, control.start() + 1)
            raise source.error(f"control character 0x{ord(control[0]):02x}", place, "save it as plain text")
        if mark:
            comments[number] = comment.lstrip(";").strip()
        for match in _TOKEN.finditer(code):
            location = Location(file, number, match.start() + 1)
            token = match[0].lower()
            if token == "(":
                stack.append(_Open(location, []))
            elif token == ")":
                group = _close(stack, groups, location, source)
                if deepest is None or group.depth > deepest.depth:
                    deepest = group
            else:
                _add_word(Word(token, location), stack, groups, source)
    if stack:
        raise _never_closed(stack[-1], source)
    return Document(source, tuple(groups), comments, deepest)


def _close(stack: list[_Open], groups: list[Group], location: Location, source: Source) -> Group:
    if not stack:
        raise source.error("there is no opening parenthesis for this one", location, "remove it")
    opened = stack.pop()
    group = Group(tuple(opened.parts), opened.location, location, len(stack))
    if stack:
        stack[-1].parts.append(group)
    else:
        groups.append(group)
    return group


def _add_word(word: Word, stack: list[_Open], groups: list[Group], source: Source) -> None:
    if not stack:
        if groups:
            raise _closed_too_early(groups[-1], source)
        raise source.error(f'"{word.text}" stands outside all parentheses', word.location)
    opened = stack[-1]
    if word.text.startswith(":"):
        _refuse_misplaced_keyword(word, stack, groups, source)
    opened.parts.append(word)


def _refuse_misplaced_keyword(word: Word, stack: list[_Open], groups: list[Group], source: Source) -> None:
    """A section keyword deep inside another group shows which parenthesis was left open."""
    opened = stack[-1]
    if not opened.parts and len(stack) == 1 and groups:
        raise _closed_too_early(groups[-1], source)
    if not opened.parts and len(stack) > 2 and word.text not in _PARTS_OF_SECTIONS:
        raise _never_closed(stack[-2], source)
    if word.text in _PARTS_OF_SECTIONS and opened.parts and not opened.head.startswith(":"):
        if opened.head == "define":
            raise source.error(
                f'"{word.text}" stands outside its action',
                word.location,
                "a parenthesis before it is too many",
            )
        raise _never_closed(opened, source)


def _never_closed(opened: _Open, source: Source) -> TmdError:
    name = f' "({opened.head}"' if opened.head else ""
    return source.error(f"this parenthesis{name} is never closed", opened.location, 'add the missing ")"')


def _closed_too_early(group: Group, source: Source) -> TmdError:
    return source.error(
        f'this parenthesis closes "({group.head}" too early: more text follows',
        group.end,
        'a ")" before it is too many',
    )
