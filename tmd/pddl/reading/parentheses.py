"""From the text of a PDDL file to nested groups, with every parenthesis that is missing or left over.

Only the place of PDDL's section keywords and the indentation of lines are used, to tell which parenthesis was left
open. Where faults are collected, each is mended in the way that explains the rest of the text best.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from functools import lru_cache

from tmd.diagnostics import Location, TmdError
from tmd.pddl.reading.syntax import TOKEN, Document, Group, Node, Report, Source, Word, split_lines

_CONTROL = re.compile(r"[\x00-\x08\x0e-\x1f\x7f]")
_PARTS = frozenset({":parameters", ":precondition", ":effect"})
_SECTIONS = frozenset(
    {
        ":requirements", ":types", ":constants", ":predicates", ":functions", ":action", ":durative-action",
        ":derived", ":process", ":event", ":domain", ":objects", ":init", ":goal", ":metric",
    }
)  # fmt: skip
"""Keywords that begin a section, and nothing else."""
_MOST_KEPT = 200_000
"""The groups of longer texts, in characters, are not kept for the next reader."""
_MOST_FAULTS = 100
"""After so many faults of parentheses the rest of a text tells nothing."""


@dataclass(slots=True)
class _Open:
    """A group that is still open."""

    location: Location
    parts: list[Node]
    first: bool
    """Whether it is the first of its line."""

    @property
    def head(self) -> str:
        return self.parts[0].text if self.parts and isinstance(self.parts[0], Word) else ""


def parse(text: str, file: str, report: Report | None = None) -> Document:
    """Split ``text`` into groups.

    Args:
        text: The text.
        file: Names it in errors.
        report: Takes every fault; without it the first one is raised.

    Raises:
        TmdError: A parenthesis is missing or left over, or a word stands outside all parentheses.
    """
    if len(text) <= _MOST_KEPT:
        try:
            document = _faultless(text, file)
        except TmdError:
            pass  # read again, so that all faults are told
        else:
            return replace(document, source=replace(document.source, report=report))
    return _split(text, file, report)


@lru_cache(maxsize=8)
def _faultless(text: str, file: str) -> Document:
    """The groups of a text without faults, kept: a domain is read several times while it is checked or compiled."""
    return _split(text, file, None)


def _split(text: str, file: str, report: Report | None) -> Document:
    source = Source(file, split_lines(text), report)
    parser = _Parser(source)
    for number, line in enumerate(source.lines, start=1):
        parser.read_line(number, line)
        if parser.faults > _MOST_FAULTS:
            break
    parser.end()
    return Document(source, tuple(parser.groups), parser.comments, parser.deepest)


@dataclass(slots=True)
class _Parser:
    """The groups that are open and those that are done."""

    source: Source
    groups: list[Group] = field(default_factory=list)
    stack: list[_Open] = field(default_factory=list)
    comments: dict[int, str] = field(default_factory=dict)
    deepest: Group | None = None
    suspect: _Open | None = None
    """The first group that the indentation of the text says should have been closed before."""
    outside: bool = False
    faults: int = 0

    def read_line(self, number: int, line: str) -> None:
        code, mark, comment = line.partition(";")
        control = _CONTROL.search(code)
        if control:
            place = Location(self.source.file, number, control.start() + 1)
            self.fault(
                f"control character 0x{ord(control[0]):02x}", place, "save it as plain text", "control-character"
            )
            code = _CONTROL.sub(" ", code)
        if mark:
            self.comments[number] = comment.lstrip(";").strip()
        first = True
        for match in TOKEN.finditer(code):
            location = Location(self.source.file, number, match.start() + 1)
            token = match[0].lower()
            if first:
                self.look_at_indentation(token, location)
            if token == "(":
                self.stack.append(_Open(location, [], first))
            elif token == ")":
                self.close(location)
            else:
                self.add_word(Word(token, location))
            first = False

    def fault(self, message: str, location: Location, hint: str | None, code: str) -> None:
        self.faults += 1
        self.source.fault(self.source.error(message, location, hint, code))

    def look_at_indentation(self, token: str, location: Location) -> None:
        """A line that begins left of the group it stands in shows that the group lacks its end."""
        if self.suspect is not None or not self.stack or len(self.stack) == 1:
            return
        opened = self.stack[-1]
        start = opened.location
        if opened.first and start.line < location.line and (start.column, token != ")") > (location.column, False):
            self.suspect = opened

    def close(self, location: Location) -> None:
        if not self.stack:
            self.fault("there is no opening parenthesis for this one", location, "remove it", "extra-parenthesis")
            return
        self.pop(location)

    def pop(self, location: Location) -> None:
        """Make the innermost open group a part of the one around it."""
        opened = self.stack.pop()
        group = Group(tuple(opened.parts), opened.location, location, len(self.stack))
        (self.stack[-1].parts if self.stack else self.groups).append(group)
        if self.deepest is None or group.depth > self.deepest.depth:
            self.deepest = group

    def reopen(self, group: Group) -> _Open:
        """``group``, which was closed too early, as an open one."""
        return _Open(group.location, list(group.parts), False)

    def add_word(self, word: Word) -> None:
        if not self.stack and not self.reopen_last(word):
            return
        if word.text.startswith(":"):
            self.mend_misplaced(word)
        self.stack[-1].parts.append(word)

    def reopen_last(self, word: Word) -> bool:
        """A word outside all parentheses: the last group ended too early, if there is one."""
        if self.groups:
            self.closed_too_early(self.groups[-1])
            self.stack.append(self.reopen(self.groups.pop()))
            return True
        if not self.outside:
            self.fault(f'"{word.text}" stands outside all parentheses', word.location, None, "syntax")
        self.outside = True
        return False

    def mend_misplaced(self, word: Word) -> None:
        """A keyword deep inside another group shows which parenthesis was left open, or closed too early."""
        opened = self.stack[-1]
        if not opened.parts and len(self.stack) == 1 and self.groups:
            self.closed_too_early(self.groups[-1])
            self.stack.insert(0, self.reopen(self.groups.pop()))
        elif not opened.parts and len(self.stack) > 2 and word.text in _SECTIONS:
            self.never_closed(self.stack[-2])
            self.stack.pop()
            while len(self.stack) > 1:
                self.pop(word.location)
            self.stack.append(opened)
        elif word.text in _PARTS and opened.parts and not opened.head.startswith(":"):
            self.mend_part(word)

    def mend_part(self, word: Word) -> None:
        """``:effect`` outside its action: the action ended too early, or something in it did not end."""
        opened = self.stack[-1]
        if opened.head == "define":
            hint = "a parenthesis before it is too many"
            self.fault(f'"{word.text}" stands outside its action', word.location, hint, "extra-parenthesis")
            last = opened.parts[-1]
            if isinstance(last, Group):
                opened.parts.pop()
                self.stack.append(self.reopen(last))
            return
        self.never_closed(opened)
        while len(self.stack) > 2 and not self.stack[-1].head.startswith(":"):
            self.pop(word.location)

    def end(self) -> None:
        """Close what is still open."""
        if not self.stack:
            return
        self.never_closed(self.stack[-1], len(self.stack))
        last = len(self.source.lines)
        while self.stack:
            self.pop(Location(self.source.file, last, len(self.source.lines[-1]) + 1))

    def never_closed(self, opened: _Open, count: int = 1) -> None:
        name = f' "({opened.head}"' if opened.head else ""
        hint = 'add the missing ")"' if count == 1 else f'add the {count} missing ")"'
        if self.suspect is not None and self.suspect.location != opened.location:
            inner = self.suspect
            hint += f'; the indentation says that "({inner.head}" in line {inner.location.line} lacks it'
        self.suspect = None
        self.fault(f"this parenthesis{name} is never closed", opened.location, hint, "unclosed-parenthesis")

    def closed_too_early(self, group: Group) -> None:
        self.fault(
            f'this parenthesis closes "({group.head}" too early: more text follows',
            group.end,
            'a ")" before it is too many',
            "extra-parenthesis",
        )
