"""Tokens and nested parentheses of PDDL, each with its file, line and column.

Nothing here recurses, so a text may nest as deeply as it likes. What the groups mean is
:mod:`tmd.pddl.reading.reader`'s affair; :mod:`tmd.pddl.reading.syntax` makes the groups. A :class:`Source` either
raises the first fault, or reports every fault to a collector, and reading goes on behind it.
"""

from __future__ import annotations

import re
import sys
import unicodedata
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from difflib import SequenceMatcher, get_close_matches
from itertools import islice, takewhile
from pathlib import Path
from typing import ParamSpec, TypeAlias, TypeVar

from tmd.diagnostics import Edit, Location, TmdError
from tmd.files import read_bytes
from tmd.pddl.reading.foreign import other_file, pddl_lines

TOKEN = re.compile(r"[()]|\?*[^\s();?]+|\?+")
"""Parentheses and words; a variable always begins a new word."""
_DEEPEST = 100
_LONGEST_LIST_IN_HINT = 8
NO_BLANKS = 'a name has no blanks: "{}"'
"""The fault of a name of several words, of one message for its declaration and its uses."""
# The likeness, of :mod:`difflib`, of two names of which one is a slip for the other.
_LIKENESS = 0.7
_MOST_COMPARED = 500


@dataclass(frozen=True, slots=True)
class Word:
    """A name, keyword, variable or number, in lower case."""

    text: str
    location: Location


@dataclass(frozen=True, slots=True)
class Group:
    """The nodes between an opening parenthesis (at ``location``) and its closing one (at ``end``)."""

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
# Kinds of faults that are made in the same way all over a file.
_HABITS = frozenset({"not-supported", "unknown-section"})


class Reporting:
    """Base of texts that are read: without a ``report``, which takes faults, the first fault is raised."""

    __slots__ = ()
    report: Report | None

    def fault(self, error: TmdError) -> None:
        """Raise ``error``, or report it and return."""
        if self.report is None:
            raise error
        self.report(error)

    def recover(self, otherwise: S, read: Callable[P, T], *arguments: P.args, **named: P.kwargs) -> S | T:
        """Return the result of ``read``, or ``otherwise`` where it fails and faults are reported."""
        if self.report is None:
            return read(*arguments, **named)
        try:
            return read(*arguments, **named)
        except TmdError as error:
            self.fault(error)
            return otherwise


@dataclass(frozen=True, slots=True)
class Source(Reporting):
    """A text that is being read: it knows its lines, so every error can show the one it speaks of.

    ``report`` takes the faults; without it the first one is raised.
    """

    file: str
    lines: tuple[str, ...]
    report: Report | None = field(default=None, compare=False, repr=False)
    code: tuple[str, ...] = ()
    """The lines without comments and text that is not PDDL, as long as before."""
    once: dict[str, TmdError] = field(default_factory=dict, compare=False, repr=False)
    times: dict[str, int] = field(default_factory=dict, compare=False, repr=False)
    """How often each habit of the author was found."""
    reported: set[str] = field(default_factory=set, compare=False, repr=False)
    """The names of which was warned: once is enough."""
    sections: dict[str, Group] = field(default_factory=dict, compare=False, repr=False)
    """The first group of each head within ``(define``."""
    groups: list[Group] = field(default_factory=list, compare=False, repr=False)
    """The outermost groups."""

    def fault(self, error: TmdError) -> None:
        """Raise ``error``, or report it and return; a habit of the author is reported once, with all its edits."""
        found = self.once.get(error.message) if error.code in _HABITS else None
        if found is None:
            if error.code in _HABITS:
                self.once[error.message] = error
            Reporting.fault(self, error)  # dataclasses with slots have no super()
            return
        message = error.message
        times = self.times[message] = self.times.get(message, 0) + 1
        found.message = f"{message} (and {times} more time{'s' if times > 1 else ''})"
        found.edits += tuple(error.edits)

    def line(self, location: Location | None) -> str | None:
        """Return the source line at ``location``, if it lies in this text."""
        if location is None or location.file != self.file or not 0 < location.line <= len(self.lines):
            return None
        return self.lines[location.line - 1]

    def error(
        self,
        message: str,
        location: Location | None,
        hint: str | None = None,
        code: str = "syntax",
        edits: Sequence[Edit] = (),
    ) -> TmdError:
        """Return an error at ``location`` that carries its source line."""
        return TmdError(message, location=location, hint=hint, source=self.line(location), code=code, edits=edits)

    def fault_at(
        self,
        message: str,
        location: Location | None,
        hint: str | None = None,
        code: str = "syntax",
        edits: Sequence[Edit] = (),
    ) -> None:
        """Raise the error of :meth:`error`, or report it and return."""
        self.fault(self.error(message, location, hint, code, edits))

    def fault_once(self, message: str, location: Location, hint: str | None, code: str, edits: Sequence[Edit]) -> None:
        """Do the same; a habit of the author, of one message, is reported once, with the edits of all its places."""
        found = self.once.get(message)
        if found is not None:
            found.edits += tuple(edits)
            return
        self.once[message] = found = self.error(message, location, hint, code, edits)
        self.fault(found)

    def warn(
        self, message: str, location: Location | None, hint: str | None, code: str, edits: Sequence[Edit] = ()
    ) -> None:
        """Report a warning; it is dropped where faults are raised."""
        if self.report is not None:
            self.report(self.error(message, location, hint, code, edits))

    def text(self, start: Location, end: Location) -> str:
        """Return the text from ``start`` to before ``end``."""
        lines = list(self.lines[start.line - 1 : end.line])
        lines[-1] = lines[-1][: end.column - 1]
        lines[0] = lines[0][start.column - 1 :]
        return "\n".join(lines)

    def removal(self, start: Location, end: Location) -> Edit:
        """Return the edit that removes words with the blanks before them, or lines where nothing else is in them."""
        before, behind = self.lines[start.line - 1][: start.column - 1], self.lines[end.line - 1][end.column - 1 :]
        if before.strip():
            kept = before if before.endswith("(") else before.rstrip()
            return Edit(Location(start.file, start.line, len(kept) + 1), end)
        if behind.strip() or end.line == len(self.lines):
            return Edit(start, shifted(end, len(behind) - len(behind.lstrip())))
        return Edit(Location(start.file, start.line, 1), Location(end.file, end.line + 1, 1))

    def declaration(self, section: str, words: str) -> Edit:
        """Return the edit that adds ``words`` to a section, which is made where there is none."""
        if section in self.sections:
            place = self.sections[section].end
            return Edit(place, place, f" {words}")
        before = self.sections.get(":requirements") if section not in (":requirements", ":domain") else None
        if section == ":constants":
            before = self.sections.get(":types", before)
        before = before or next(iter(self.sections.values()), None)
        place = after(before) if before else Location(self.file, 1, 1)
        return Edit(place, place, f"\n  ({section} {words})")

    def hidden(self, section: str, name: str) -> int | None:
        """Return the line of a section in which ``name`` stands behind a ``;``, if there is one."""
        group = self.sections.get(section)
        for number in range(group.location.line, group.end.line + 1) if group else ():
            if re.search(rf"(?<![\w-]){re.escape(name)}(?![\w-])", self.lines[number - 1].partition(";")[2].lower()):
                return number
        return None

    def closed_too_early(self, group: Group) -> TmdError:
        """Raise or report that more text follows a group, which should be its last part."""
        message = f'this parenthesis closes "({group.head}" too early: more text follows'
        error = self.error(message, group.end, 'a ")" before it is too many', "extra-parenthesis")
        self.fault(error)
        return error

    def word(self, location: Location | None, number: int) -> Location | None:
        """Return the place of word ``number`` (0 for the head) of the group at ``location``; groups count as one."""
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
        """Return the place of the type ``name`` of the typed name at ``location``."""
        behind = islice(self.tokens(location), 1, None)
        return next((place for token, place in behind if token.lower() == name), location)

    def tokens(self, location: Location | None) -> Iterator[tuple[str, Location]]:
        """Yield the tokens from ``location`` on, as they are written."""
        if self.line(location) is None or location is None:
            return
        lines = self.code or self.lines
        for number in range(location.line, len(lines) + 1):
            code = lines[number - 1].partition(";")[0]
            for match in TOKEN.finditer(code, location.column - 1 if number == location.line else 0):
                yield match[0], Location(self.file, number, match.start() + 1)


def after(node: Node) -> Location:
    """Return the place behind a word or group."""
    end = node.end if isinstance(node, Group) else node.location
    return shifted(end, 1 if isinstance(node, Group) else len(node.text))


def shifted(place: Location, columns: int) -> Location:
    """Return the place so many columns behind ``place``."""
    return Location(place.file, place.line, place.column + columns)


def replaced(node: Node, text: str) -> Edit:
    """Return the edit that puts ``text`` in the place of ``node``."""
    return Edit(node.location, after(node), text)


def enclosed(first: Node, last: Node, opening: str = "(") -> list[Edit]:
    """Return the edits that put the nodes from ``first`` to ``last`` in parentheses."""
    start, end = first.location, after(last)
    return [Edit(start, start, opening), Edit(end, end, ")")]


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
    """Return a hint that names the declared name closest to ``name``, or all of them where they are few."""
    candidates = declared if len(declared) <= _MOST_COMPARED else _alike(name, declared)
    close = [other for other in get_close_matches(name, candidates, n=1, cutoff=0.6) if _is_slip(name, other)]
    if close:
        return f'did you mean "{close[0]}"?'
    if declared and len(declared) <= _LONGEST_LIST_IN_HINT:
        return f"{what}: {', '.join(declared)}"
    return None


def _is_slip(name: str, other: str) -> bool:
    """Return whether one name may be meant for the other: of two short ones, letters may be common by chance."""
    differ = sum(one != two for one, two in zip(name, other, strict=False)) + abs(len(name) - len(other))
    contained = name in other or other in name or sorted(name) == sorted(other) or differ == 1
    return contained or SequenceMatcher(None, name, other).ratio() >= _LIKENESS


# What some call the keywords of PDDL.
_MEANING = {
    ":operator": ":action", ":move": ":action", ":start": ":init", ":state": ":init", ":facts": ":init",
    ":instances": ":objects", ":entities": ":objects", ":vars": ":parameters", ":variables": ":parameters",
    ":args": ":parameters", ":arguments": ":parameters", ":requires": ":precondition", ":post": ":effect",
    ":postcondition": ":effect", ":postconditions": ":effect", ":result": ":effect", ":results": ":effect",
    ":target": ":goal", ":fluents": ":functions", ":axiom": ":derived",
}  # fmt: skip


def meant(word: str, names: Sequence[str]) -> str | None:
    """Return the keyword of ``names`` that is misspelt, shortened, drawn out or called otherwise as ``word``."""
    plain = f":{word.replace('_', '-').strip(':')}"
    close = get_close_matches(plain, names, n=1)
    stem = plain.removeprefix(":")
    within = [name for name in names if len(stem) > 2 and (stem in name or name.removeprefix(":") in stem)]
    other = _MEANING.get(plain) or _MEANING.get(plain.removesuffix("s"))
    if close and (_is_slip(plain, close[0]) or not within):
        return close[0]
    return within[0] if len(within) == 1 else other if other in names else None


def _alike(name: str, declared: Sequence[str]) -> list[str]:
    """Keep, of many names, those that may be near ``name``: comparing with all of them takes too long."""
    ends = (name[:2], name[-2:])
    near = (d for d in declared if abs(len(d) - len(name)) <= 2 and (d.startswith(ends[0]) or d.endswith(ends[1])))
    return list(islice(near, _MOST_COMPARED))


def read_text(path: str | Path, report: Report | None = None) -> str:
    """Return the text of a UTF-8 file, without byte order mark.

    Comments of PDDL may hold any bytes, which are read as Latin-1; ``report`` takes a warning then.

    Raises:
        TmdError: The file is missing, unreadable, binary or not UTF-8.
    """
    place = Location(str(path), 1, 1)
    try:
        data = read_bytes(path)
    except OSError as error:
        hint = "check the path, and that you may read there"
        raise TmdError(
            f"cannot be read: {error.strerror or error}", location=place, hint=hint, code="unreadable"
        ) from error
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise TmdError("is UTF-16, not UTF-8", location=place, hint="save it as UTF-8", code="not-utf8")
    if b"\0" in data:
        raise TmdError("is not a text file", location=place, hint="save it as UTF-8 text", code="not-text")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        before = data[: error.start].decode("utf-8-sig", errors="replace")
        line = before.count("\n") + 1
        place = Location(str(path), line, len(before) - (before.rfind("\n") + 1) + 1)
        byte = f"0x{data[error.start]:02x}"
        if Path(path).suffix != ".pddl" or not re.sub(rb";[^\r\n]*", b"", data).isascii():
            hint = "save the file as UTF-8 text"
            raise TmdError(f"is not UTF-8: byte {byte}", location=place, hint=hint, code="not-utf8") from error
        if report is not None:
            message, edit = f"this comment is not UTF-8 (byte {byte}), which some tools refuse", Edit(place, place)
            report(TmdError(message, location=place, hint="save it as UTF-8", code="latin1-comment", edits=[edit]))
        return data.decode("latin-1")


def read_standard_input() -> str:
    """Return the text of standard input.

    Raises:
        TmdError: It cannot be read, is too large or not UTF-8.
    """
    try:
        return read_bytes(sys.stdin.buffer).decode("utf-8-sig")
    except OSError as error:
        raise TmdError(f"standard input cannot be read: {error.strerror or error}", hint="send text") from error
    except UnicodeDecodeError as error:
        raise TmdError(f"standard input: byte {error.start + 1} is not UTF-8", hint="send UTF-8") from error


def split_lines(text: str) -> tuple[str, ...]:
    """Return the lines of ``text``, with any line ends, without byte order mark."""
    return tuple(text.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n").split("\n"))


_ODD_BLANK = re.compile(r"[^\S \t\n\r\f\v\x1c-\x1f]|[\u200b-\u200d\u2060\ufeff]")
"""Blanks that only look like one: the no-break space, the ideographic space and the like."""
_CONTROL = re.compile(r"[\x00-\x08\x0e-\x1f\x7f]")
# Words with groups behind them, and the groups in which names stand with their arguments.
CONNECTIVES = frozenset({"and", "or", "not", "when", "imply", "forall", "exists"})
# The parts of an action.
PARTS = (":parameters", ":precondition", ":effect")
# Keywords that begin a section, and nothing else.
_SECTIONS = frozenset(
    {
        ":requirements", ":types", ":constants", ":predicates", ":functions", ":action", ":durative-action",
        ":derived", ":process", ":event", ":domain", ":objects", ":init", ":goal", ":metric",
    }
)  # fmt: skip
# Number of faults of parentheses after which the rest of a text tells nothing.
_MOST_FAULTS = 100


_OPERATORS = CONNECTIVES | {
    "define", "increase", "decrease", "assign", "scale-up", "scale-down", "preference", "oneof", "probabilistic",
    "=", "<", ">", "<=", ">=", "+", "-", "*", "/", "either", "always", "sometime", "!", "~",
}  # fmt: skip
# Words that are not called where the others are, ``and(on(a, b), clear(a))``.
_NEVER_CALLED = _OPERATORS - {"and", "or", "not", "imply", "when"} | {"minimize", "maximize"}
# A plain name as planners take it; in PDDL it begins with a letter.
NAME = re.compile(r"[a-z0-9_][a-z0-9_-]*")
_WITH_ATOMS = CONNECTIVES | {":init", ":goal", ":predicates", ":precondition", ":effect"}


@dataclass(slots=True)
class _Open:
    """A group that is still open."""

    location: Location
    parts: list[Node]
    first: bool
    """Whether it is the first of its line."""
    spread: bool = False
    """Whether its parts are those of the group around it, as in ``(on(a b))``."""
    called: bool = False
    """Whether it was written like a call."""

    @property
    def head(self) -> str:
        return self.parts[0].text if self.parts and isinstance(self.parts[0], Word) else ""


def _shown(parts: Sequence[Node], levels: int = 4) -> str:
    """Return the text of a group with these parts, so many levels of it."""
    shown = (part.text if isinstance(part, Word) else _shown(part.parts, levels - 1) for part in parts)
    return f"({' '.join(shown)})" if levels else "(...)"


def _reopened(group: Group) -> _Open:
    return _Open(group.location, list(group.parts), False)


def _may_be_name(word: str) -> bool:
    """Return whether a word before a parenthesis may be the name of a call."""
    return bool(NAME.fullmatch(word)) and word not in _NEVER_CALLED


def _around_an_atom(parts: Sequence[Node]) -> Group | None:
    """Return the first atom that has another one in it, which should have been closed before that."""
    waiting = list(reversed(parts))
    while waiting:
        node = waiting.pop()
        if isinstance(node, Group):
            inner = next((part for part in node.parts if isinstance(part, Group)), None)
            if inner and all(NAME.fullmatch(group.head) and group.head not in _OPERATORS for group in (node, inner)):
                return node
            waiting.extend(reversed(node.parts))
    return None


def _keyword_before(around: _Open) -> bool:
    """Return whether the last word is a condition or effect, as in ``:effect done()``, perhaps behind others."""
    before = next((part for part in reversed(around.parts[:-1]) if isinstance(part, Word)), None)
    last = around.parts[-1]
    part = isinstance(last, Word) and f":{last.text}" in PARTS
    return before is not None and before.text in _WITH_ATOMS and not part


def parse(text: str, file: str, report: Report | None = None, *, definition: bool = False) -> Document:
    """Split ``text`` into groups.

    ``report`` takes every fault; without it the first one is raised. A ``definition`` is a domain or problem, not a
    condition.

    Raises:
        TmdError: A parenthesis is missing or left over, or a word stands outside all parentheses.
    """
    lines = split_lines(text)
    if other := other_file(text, definition):
        source = Source(file, lines)
        raise source.error(f"this is {other[0]}, not PDDL", Location(file, 1, 1), other[1], "empty-file")
    code, foreign = pddl_lines(lines, file)
    source = Source(file, lines, report, code)
    commas = [fault for fault in foreign if "commas" in fault.message]
    for fault in foreign:
        if fault not in commas:
            source.fault(fault)
    parser = _Parser(source)
    for number, line in enumerate(source.code, start=1):
        parser.read_line(number, line)
        if parser.faults > _MOST_FAULTS:
            break
    parser.end(commas)
    source.groups.extend(parser.groups)
    for part in parser.groups[0].parts if parser.groups else ():
        if isinstance(part, Group):
            source.sections.setdefault(part.head, part)
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
    undefined: TmdError | None = None
    """The fault that there is no ``(define``."""
    early: TmdError | None = None
    """The fault that the definition is closed too early."""
    called: list[Edit] = field(default_factory=list)
    """The edits of ``on(a b)`` to ``(on a b)``."""
    call: str = "(name argument ...)"
    """The first of them as it should be."""

    def read_line(self, number: int, line: str) -> None:
        code, mark, comment = line.partition(";")
        start = Location(self.source.file, number, 1)
        control = _CONTROL.search(code)
        if control:
            message = f"control character 0x{ord(control[0]):02x}"
            self.fault(message, shifted(start, control.start()), "save it as plain text", "control-character")
            code = _CONTROL.sub(" ", code)
        blank = _ODD_BLANK.search(code)
        if blank:
            message = f"this is no blank of PDDL: {blank[0]!r} ({unicodedata.name(blank[0], 'unnamed')})"
            places = [shifted(start, odd.start()) for odd in _ODD_BLANK.finditer(code)]
            edits = [Edit(odd, shifted(odd, 1), " ") for odd in places]
            self.fault(message, places[0], 'write " "', "look-alike", edits)
            code = _ODD_BLANK.sub(" ", code)
        if mark:
            self.comments[number] = comment.lstrip(";").strip()
        first = True
        ended = -1
        for match in TOKEN.finditer(code):
            location = shifted(start, match.start())
            token = match[0].lower()
            if match.start() == ended and token[0] == "?":
                message = f'some tools want a blank before "{token}"'
                edits = [Edit(location, location, " ")]
                self.source.warn(message, location, "put a blank before it", "glued-variable", edits)
            ended = match.end() if token not in "()" else -1
            if first:
                self.look_at_indentation(token, location)
            if token == "(":
                self.open(location, first)
            elif token == ")":
                self.close(location)
            else:
                self.add_word(Word(token, location))
            first = False

    def open(self, location: Location, first: bool) -> None:
        """Begin a group: a new one, or in ``on(a b)`` that of the name before it."""
        around = self.stack[-1] if self.stack else None
        word = around.parts[-1] if around and around.parts else None
        glued = isinstance(word, Word) and after(word) == location
        if around is None or not isinstance(word, Word) or not glued or not _may_be_name(word.text):
            self.stack.append(_Open(location, [], first))
        elif len(around.parts) == 1 and around.head not in _OPERATORS:
            self.called.append(Edit(location, shifted(location, 1), " "))
            self.stack.append(_Open(location, [], first, spread=True, called=True))
        elif len(around.parts) > 1 and (around.head in _WITH_ATOMS or _keyword_before(around)):
            self.called.append(
                Edit(word.location, shifted(location, 1), f"({self.source.text(word.location, location)} ")
            )
            around.parts.pop()
            self.stack.append(_Open(word.location, [word], first, called=True))
        else:
            self.stack.append(_Open(location, [], first))

    def fault(self, message: str, location: Location, hint: str | None, code: str, edits: Sequence[Edit] = ()) -> None:
        self.faults += 1
        self.source.fault_at(message, location, hint, code, edits)

    def look_at_indentation(self, token: str, location: Location) -> None:
        """Suspect a group that a line stands in although it begins left of it: the group may lack its end."""
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
        if opened.spread:
            self.called.append(Edit(location, shifted(location, 1)))
            self.stack[-1].parts.extend(opened.parts)
        if opened.called and opened.head == "not" and len(opened.parts) > 1 and isinstance(opened.parts[1], Word):
            self.negated(opened, location)
        if opened.called and self.call.startswith("(name"):
            self.call = _shown((self.stack[-1] if opened.spread else opened).parts)
        if opened.spread:
            return
        group = Group(tuple(opened.parts), opened.location, location, len(self.stack))
        (self.stack[-1].parts if self.stack else self.groups).append(group)
        if self.deepest is None or group.depth > self.deepest.depth:
            self.deepest = group

    def negated(self, opened: _Open, end: Location) -> None:
        """Make a group of the atom in ``not(on a b)``."""
        head, *atom = opened.parts
        place = atom[0].location
        self.called += (Edit(place, place, "("), Edit(end, end, ")"))
        opened.parts = [head, Group(tuple(atom), place, end, len(self.stack) + 1)]

    def add_word(self, word: Word) -> None:
        if not self.stack and not self.reopen_last(word):
            return
        if word.text.startswith(":"):
            self.fix_misplaced(word)
        elif word.text in CONNECTIVES and not self.calls(word):
            self.fix_unopened(word)
        self.stack[-1].parts.append(word)

    def calls(self, word: Word) -> bool:
        """Return whether a parenthesis follows a word, as in ``and(on(a, b))``."""
        behind = self.source.code[word.location.line - 1][after(word).column - 1 :]
        return behind.startswith("(") and _may_be_name(word.text)

    def fix_unopened(self, word: Word) -> None:
        """Repair ``:precondition and (...)``, which lacks the parenthesis that its end closes."""
        opened = self.stack[-1]
        last = opened.parts[-1] if opened.parts else None
        if isinstance(last, Word) and (last.text in PARTS[1:] or last.text == opened.head == ":goal"):
            message = f'a parenthesis is missing before "{word.text}"'
            self.fault(message, word.location, f'write "({word.text}"', "extra-parenthesis")
            self.stack.append(_Open(word.location, [], False))

    def reopen_last(self, word: Word) -> bool:
        """Reopen the last group for a word outside all parentheses; return whether there is one."""
        if self.groups:
            self.closed_too_early(self.groups[-1])
            self.stack.append(_reopened(self.groups.pop()))
            return True
        if word.text == "define" and not self.outside:
            edits = [Edit(word.location, word.location, "(")]
            message = 'a parenthesis is missing before "define"'
            self.fault(message, word.location, 'write "(define"', "syntax", edits)
            self.stack.append(_Open(word.location, [word], True))
            return False
        if not self.outside:
            self.fault(f'"{word.text}" stands outside all parentheses', word.location, None, "syntax")
        self.outside = True
        return False

    def fix_misplaced(self, word: Word) -> None:
        """Repair what a keyword deep inside another group shows: a parenthesis left open, or closed too early."""
        opened = self.stack[-1]
        if not opened.parts and len(self.stack) == 2 and word.text in _SECTIONS:
            self.suspect = None  # the sections before are closed, with any indentation
        if not opened.parts and len(self.stack) == 1 and self.groups:
            self.stack.insert(0, self.outermost(self.groups.pop()))
        elif not opened.parts and len(self.stack) > 2 and word.text in _SECTIONS:
            self.never_closed(self.stack[-2])
            self.stack.pop()
            while len(self.stack) > 1:
                self.pop(word.location)
            self.stack.append(opened)
        elif word.text in PARTS and opened.parts and opened.head[:1] != ":" and f":{opened.head}" not in _SECTIONS:
            self.fix_part(word)

    def outermost(self, group: Group) -> _Open:
        """Open the definition around sections: ``group``, which ended too early, or one of which only the title is."""
        if group.head not in ("domain", "problem"):
            self.closed_too_early(group)
            return _reopened(group)
        place = group.location
        edits = [Edit(place, place, "(define ")]
        self.undefined = self.source.error(f'"(define" is missing before "({group.head}"', place, None, "syntax", edits)
        self.undefined.hint = f'write "(define ({group.head} ...)", and ")" at the end'
        self.faults += 1
        self.source.fault(self.undefined)
        return _Open(place, [Word("define", place), group], False)

    def fix_part(self, word: Word) -> None:
        """Repair ``:effect`` outside its action: the action ended too early, or something in it did not end."""
        opened = self.stack[-1]
        if opened.head == "define":
            hint = "a parenthesis before it is too many"
            self.fault(f'"{word.text}" stands outside its action', word.location, hint, "extra-parenthesis")
            last = opened.parts[-1]
            if isinstance(last, Group):
                opened.parts.pop()
                self.stack.append(_reopened(last))
            return
        self.never_closed(opened)
        while len(self.stack) > 2 and not self.stack[-1].head.startswith(":"):
            self.pop(word.location)

    def end(self, commas: Sequence[TmdError]) -> None:
        """Close what is still open, and report calls; those have commas, which are no other slip."""
        if self.called:
            place = self.called[0].start
            message = f"this is written like a call{' with commas' if commas else ''}; PDDL has none"
            edits = (*self.called, *(edit for fault in commas for edit in fault.edits))
            self.fault(message, place, f"write {self.call}", "other-notation", edits)
        else:
            for fault in commas:
                self.source.fault(fault)
        if not self.stack:
            return
        end = Location(self.source.file, len(self.source.lines), len(self.source.lines[-1]) + 1)
        if self.undefined and len(self.stack) == 1:
            self.undefined.edits += (Edit(end, end, ")\n"),)
        elif self.early and len(self.stack) == 1:
            self.early.hint = "move it to the end of the file"
        else:
            self.never_closed(self.stack[-1], len(self.stack))
        while self.stack:
            self.pop(end)

    def never_closed(self, opened: _Open, count: int = 1) -> None:
        atom = _around_an_atom(opened.parts) if count <= 2 else None
        if atom is not None:
            words = [*takewhile(lambda part: isinstance(part, Word), atom.parts)]
            place, self.suspect = after(words[-1]), None
            message, edits = f'this parenthesis "({atom.head}" is never closed', [Edit(place, place, ")")]
            self.fault(message, atom.location, 'add the missing ")" behind it', "unclosed-parenthesis", edits)
            return
        name = f' "({opened.head}"' if opened.head else ""
        hint = 'add the missing ")"' if count == 1 else f'add the {count} missing ")"'
        if self.suspect is not None and self.suspect.location != opened.location:
            inner = self.suspect
            hint += f'; the indentation says that "({inner.head}" in line {inner.location.line} lacks it'
        self.suspect = None
        self.fault(f"this parenthesis{name} is never closed", opened.location, hint, "unclosed-parenthesis")

    def closed_too_early(self, group: Group) -> None:
        self.faults += 1
        self.early = self.source.closed_too_early(group)
