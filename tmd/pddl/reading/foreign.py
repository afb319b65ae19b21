"""Text in and around PDDL that is not PDDL: Markdown, prose, comments of other languages, commas, a second definition.

Language models answer with it, and students paste it. It is found before the parentheses are read and blanked out, so
that everything else keeps its place and is read as if it were alone.
"""

from __future__ import annotations

import json
import re
from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import accumulate, pairwise
from pathlib import Path

from tmd.diagnostics import Edit, Location, TmdError

_MARKS = re.compile(
    r"(?=[&;<`~#/\\:\"'$%\s-]|[\u2018-\u201f])(?:"  # how they begin
    r"(?P<entity>&(?:amp;)*(?:\#\d+|\#x[\da-f]+|[a-z]+);=?)"  # before comments: its end would begin one
    r"|(?P<comment>;[^\n]*)"
    r"|(?P<thought><think(?:ing)?>.*?</think(?:ing)?>)"
    r"|(?P<tag></?(?:br|code|div|p|pre|span)(?:\s+[a-z-]+=\"[^\"\n]*\")*\s*/?>)"
    r"|(?P<fence>(?:```|~~~)[a-zA-Z]*)"
    r"|(?P<block>\#\|.*?(?:\|\#|\Z)|/\*.*?(?:\*/|\Z)|<!--.*?(?:-->|\Z))"
    r"|(?P<escape>\\[nrt\"])"
    r"|(?P<slash>\\(?=[()]))"
    r"|(?P<text>(?<!\():[a-z-]+\s+\"[^\"\n]*\")"
    r"|(?P<quoted>(?<![\w?-])[\"'`\u2018-\u201f]\??[\w-]+(?:[ ][\w-]+){0,2}[\"'`\u2018-\u201f](?![\w-]))"
    r"|(?P<dollar>(?<![^\s()])\$(?=[a-z]))"
    r"|(?P<remark>(?<![^\s()])(?://|[\#%]+[ \t]|(?:(?m:^[ \t]*)|(?<=\))[ \t]+)--[ \t])[^\n]*))",
    re.DOTALL | re.IGNORECASE,
)
_TOLD = {
    "entity": ("signs are written as in HTML here", "write the signs themselves, such as > for &gt;"),
    "thought": ("what a language model thinks is not PDDL", "remove it"),
    "tag": ("the marks of HTML are not PDDL", "remove them"),
    "fence": ("the marks of a Markdown block are not PDDL", "remove them"),
    "block": ("this is not a comment of PDDL", 'write ";" before each of its lines'),
    "escape": ("the ends of lines are written as letters here", "write them as ends of lines"),
    "slash": ("a backslash before a parenthesis is not PDDL", "remove it"),
    "text": ("a text in quotes is no part of PDDL", 'write it behind ";"'),
    "quoted": ("names have no quotes in PDDL", "remove them"),
    "dollar": ("a variable begins with a question mark", 'write "?" for "$"'),
    "remark": ("this is not a comment of PDDL", 'begin it with ";"'),
}
# What the lines of numbered, quoted and compared texts begin with.
_MARGINS = tuple(map(re.compile, (r"\s*\d+(?:[:.|)]|(?=\s|$))", r"\s*>(?=\s|$|\()", r"\+", r"[-*](?=\s|$)", r"\|")))
_CONFLICT = re.compile(r"^(<{7}[^\n]*)$.*?^(={7}$.*?^>{7}[^\n]*)$", re.MULTILINE | re.DOTALL)
# Files that are something else altogether, and their cure.
_OTHER_FILES = {
    "a page of the web": (re.compile(r"\s*<(?:!doctype html|html)\b", re.IGNORECASE), "download the file itself"),
    "a pointer of Git LFS": (re.compile(r"version https://git-lfs"), "get the file with: git lfs pull"),
    "the answer that there is no such file": (re.compile(r"\s*404\b"), "look at its address"),
}
# The same for texts without a definition.
_OTHER_LANGUAGES = {
    "JSON": (re.compile(r"\s*[\[{]\s*[\"{\[\]}]"), "write (define ...)"),
    "XML": (re.compile(r"\s*<\?xml\b"), "write (define ...)"),
    "Python": (re.compile(r"(?:\s*#[^\n]*\n)*\s*(?:from|import|def|class)\s+\w"), "write (define ...)"),
    "prose": (re.compile(r"\s*[^\s;(][^();]*\Z"), "write (define ...)"),
}
# The kinds that mean nothing before the definition.
_WITHIN = frozenset({"text", "quoted", "dollar", "slash"})
_DEFINE = re.compile(r"\(\s*define\b", re.IGNORECASE)
_DEFINITION = re.compile(r"\(\s*define\s*\(\s*(domain|problem)\b\s*([^\s()]*)", re.IGNORECASE)
# Text behind a definition that belongs into it: the definition was closed too early.
_STRUCTURE = re.compile(r"\A\s*[():]|\(\s*:|^\s*:", re.MULTILINE)
_ROUND = str.maketrans("[]{}\uff08\uff09", "()()()")
_LINE = re.compile(r"[^\n]+")
_PARENTHESIS = re.compile(r"[()]")


def other_file(text: str, definition: bool) -> tuple[str, str] | None:
    """Return what a text is that is no PDDL at all, and the cure; it should have a ``definition`` or a condition."""
    if definition and _OTHER_LANGUAGES["JSON"][0].match(text) and _DEFINE.search(text):
        with suppress(ValueError, RecursionError):
            json.loads(text)
            return "JSON", "take the text of the definition out of it"
    kinds = _OTHER_FILES if not definition or _DEFINE.search(text) else {**_OTHER_FILES, **_OTHER_LANGUAGES}
    return next(((what, cure) for what, (begin, cure) in kinds.items() if begin.match(text)), None)


def pddl_lines(lines: Sequence[str], file: str) -> tuple[tuple[str, ...], list[TmdError]]:
    """Return ``lines`` with everything blanked out that is not PDDL, and a fault for each kind of that."""
    text = _Text(lines, file)
    text.margin()
    text.conflict()
    text.marks()
    text.around()
    text.brackets()
    text.commas()
    return tuple(text.kept.split("\n")), text.faults


class _Text:
    """A text, what is kept of it (``kept``), and the same without comments (``bare``); all of one length."""

    def __init__(self, lines: Sequence[str], file: str) -> None:
        self.lines = lines
        self.file = file
        self.kept = self.bare = "\n".join(lines)
        self.starts = [0, *accumulate(len(line) + 1 for line in lines)]
        self.faults: list[TmdError] = []

    def place(self, offset: int) -> Location:
        line = bisect_right(self.starts, offset)
        return Location(self.file, line, offset - self.starts[line - 1] + 1)

    def fault(self, message: str, offset: int, hint: str, code: str, edits: Sequence[Edit]) -> None:
        place = self.place(offset)
        source = self.lines[place.line - 1]
        self.faults.append(TmdError(message, location=place, hint=hint, source=source, code=code, edits=edits))

    def edit(self, start: int, end: int, text: str = "") -> Edit:
        return Edit(self.place(start), self.place(end), text)

    def removal(self, start: int, end: int) -> Edit:
        """Return the edit that removes a part of the text, whole lines with their ends."""
        first = self.starts[self.place(start).line - 1]
        last = self.kept.find("\n", end)
        if not self.bare[first:start].strip() and last >= 0 and not self.kept[end:last].strip():
            return self.edit(first, last + 1)
        return self.edit(start, end)

    def change(self, spans: Iterable[tuple[int, int]], how: Callable[[str], str]) -> None:
        """Change parts of the text, each to one of its length."""
        kept, bare = list(self.kept), list(self.bare)
        for start, end in spans:
            kept[start:end], bare[start:end] = how(self.kept[start:end]), how(self.bare[start:end])
        self.kept, self.bare = "".join(kept), "".join(bare)

    def margin(self) -> None:
        """Blank what all lines begin with: their numbers, or the marks of quoted and compared texts."""
        full = [number for number, line in enumerate(self.lines) if line.strip()]
        for margin in _MARGINS if len(full) > 2 and _DEFINE.search(self.kept) else ():
            found = [margin.match(self.lines[number]) for number in full]
            spans = [(self.starts[n], self.starts[n] + m.end()) for n, m in zip(full, found, strict=True) if m]
            if len(spans) == len(full):
                edits = [self.edit(*span) for span in spans]
                message = (
                    f'each line begins with something like "{self.kept[slice(*spans[0])].strip()}", which is not PDDL'
                )
                self.fault(message, 0, "remove it", "foreign-text", edits)
                self.change(spans, blanks)
                return

    def conflict(self) -> None:
        """Blank the marks of a merge that is not done, and the second of its two versions."""
        found = list(_CONFLICT.finditer(self.kept))
        if found:
            message, hint = "a merge was left undone here", "keep one of the two versions, and remove the marks"
            self.fault(message, found[0].start(), hint, "foreign-text", ())
            self.change((span for match in found for span in (match.span(1), match.span(2))), blanks)

    def marks(self) -> None:
        """Blank the marks of Markdown and comments of other languages; comments of PDDL are no part of ``bare``."""
        found: dict[str, list[re.Match[str]]] = {}
        first = _DEFINE.search(self.bare)
        begin = first.start() if first else len(self.bare)
        for match in _MARKS.finditer(self.bare):
            if match.lastgroup in _WITHIN and match.start() < begin:
                continue  # all of this is not PDDL, which is reported
            if match.lastgroup and match.lastgroup != "comment":
                found.setdefault(match.lastgroup, []).append(match)
        for kind, matches in found.items():
            self.change((match.span() for match in matches), _KEPT.get(kind, blanks))
        self.bare = re.sub(r";[^\n]*", lambda comment: blanks(comment[0]), self.bare)
        self.hidden()
        for kind, matches in found.items():
            message, hint = _TOLD[kind]
            edits = [edit for match in matches for edit in self._mended(kind, match)]
            self.fault(message, matches[0].start() + _indent(matches[0][0]), hint, "foreign-text", edits)

    def hidden(self) -> None:
        """Read on behind the one ";" that hides the parentheses that are missing."""
        missing = self.bare.count("(") - self.bare.count(")")
        found = [
            match
            for match in re.finditer(r"(?<=\S);(?=\s*[()])([^;\n]*)", self.kept)
            if missing > 0 and not self.bare[match.start() : match.end()].strip()
            if match[1].count(")") - match[1].count("(") == missing
        ]
        if len(found) == 1:
            start, end = found[0].span()
            message = f'";" begins a comment, and hides "{found[0][1].strip()}" here'
            edits = [self.edit(start, start + 1, " ")]
            self.fault(message, start, "remove it", "other-notation", edits)
            text = self.kept[start + 1 : end]
            self.kept = f"{self.kept[:start]} {text}{self.kept[end:]}"
            self.bare = f"{self.bare[:start]} {text}{self.bare[end:]}"

    def _mended(self, kind: str, match: re.Match[str]) -> Iterator[Edit]:
        if kind in ("fence", "tag", "slash", "thought"):
            yield self.removal(*match.span())
        elif kind == "entity":
            yield self.edit(*match.span(), _plain(match[0]).rstrip(" ") or " ")
        elif kind == "escape":
            yield self.edit(*match.span(), {"n": "\n", '"': '"'}.get(match[0][1], " "))
        elif kind == "text":
            end = "" if self.kept[match.end() :].lstrip(" \t").startswith("\n") else "\n"
            yield self.edit(*match.span(), f"; {match[0].split(chr(34))[1]}{end}")
        elif kind == "quoted":
            yield self.edit(*match.span(), match[0][1:-1].replace(" ", "-"))
        elif kind == "dollar":
            yield self.edit(*match.span(), "?")
        elif kind == "remark":
            mark = match[0].split()[0]
            start = match.start() + _indent(match[0])
            yield self.edit(start, start + (2 if mark.startswith("//") else len(mark)), ";")
        else:
            for line in _LINE.finditer(match[0]):
                start = match.start() + line.start() + _indent(line[0])
                yield self.edit(start, start, "; ")
            if self.kept[match.end() :].partition("\n")[0].strip():
                yield self.edit(match.end(), match.end(), "\n")

    def around(self) -> None:
        """Blank what stands around the first definition."""
        self.begun_again()
        first = _DEFINITION.search(self.bare) or _DEFINE.search(self.bare)
        if first is None:
            return
        begin = first.start()
        if self.bare[:begin].strip():
            self._prose(0, begin, 'this text before "(define" is not PDDL')
        others = list(_DEFINITION.finditer(self.bare, begin + 1))
        last = others[0].start() if others else len(self.bare)
        end = _end_of_group(self.bare, begin, last)
        rest = self.bare[end:last]
        if rest.strip() and (others or not _STRUCTURE.search(rest)):
            self._prose(end, last, "this text behind the definition is not PDDL")
        if others:
            self._definitions(others)

    def begun_again(self) -> None:
        """Blank the beginnings of a definition before the last one of several."""
        found = list(_DEFINITION.finditer(self.bare))
        spans = []
        for one, other in pairwise(found):
            between = self.bare[one.end() : other.start()]
            if between.strip() != ")" or one.groups() != other.groups():
                break
            spans.append((one.start(), one.end() + between.index(")") + 1))
        if spans:
            edits = [self.removal(*span) for span in spans]
            message, hint = "this definition begins twice", "remove one of the two beginnings"
            self.fault(message, spans[0][0], hint, "two-definitions", edits)
            self.change(spans, blanks)

    def _prose(self, start: int, end: int, message: str) -> None:
        """Report and blank text; the comments of PDDL in it stay."""
        spans = [(start + m.start(), start + m.end()) for m in re.finditer(r"\S(?:[^\n]*\S)?", self.bare[start:end])]
        if re.match(r"\(\s*in-package\b", self.bare[spans[0][0] :], re.IGNORECASE):
            message = '"(in-package ...)" is Lisp, not PDDL'
        edits = [self.removal(*span) for span in spans]
        self.fault(message, spans[0][0], 'remove it, or write ";" before each of its lines', "foreign-text", edits)
        self.change(spans, blanks)

    def _definitions(self, others: Sequence[re.Match[str]]) -> None:
        """Report and blank further definitions."""
        ends = [*(match.start() for match in others[1:]), len(self.kept)]
        edits = []
        for match, end in zip(others, ends, strict=True):
            path = str(self._file_for(match))
            new = Location(path, 0, 0)
            text = re.sub(r"[ \t]+$", "", self.kept[match.start() : end], flags=re.MULTILINE)
            edits.append(Edit(new, new, text.strip() + "\n"))
        edits.append(self.edit(len(self.kept[: others[0].start()].rstrip()), len(self.kept.rstrip())))
        kind, name = others[0].groups()
        message = f'this file has {len(others) + 1} definitions: here begins the {kind.lower()} "{name}"'
        hint = f"put it into a file of its own, such as {Path(edits[0].start.file).name}"
        self.fault(message, others[0].start(), hint, "two-definitions", edits)
        self.change([(others[0].start(), len(self.kept))], blanks)

    def _file_for(self, match: re.Match[str]) -> Path:
        """Return the file that a definition may be put into."""
        kind, name = match[1].lower(), re.sub(r"[^\w.-]", "_", match[2])
        own = Path(self.file)
        names = (kind if kind == "domain" else name or kind, f"{kind}-{name}")
        return next(path for n in names if (path := own.with_name(f"{n}.pddl")) != own)

    def brackets(self) -> None:
        """Read other brackets as parentheses."""
        spans = [match.span() for match in re.finditer(r"[\[\]{}\uff08\uff09]", self.bare)]
        places = [start for start, _ in spans if self.bare[max(0, start - 1) : start] != "\x1b"]
        if places:
            edits = [self.edit(place, place + 1, self.bare[place].translate(_ROUND)) for place in places]
            message = f'PDDL has round parentheses only, not "{self.bare[places[0]]}"'
            self.fault(message, places[0], 'write "(" and ")"', "other-notation", edits)
            self.change(spans, lambda bracket: bracket.translate(_ROUND))

    def commas(self) -> None:
        """Blank commas."""
        places = [match.start() for match in re.finditer(",", self.bare)]
        if not places:
            return
        edits = []
        for place in places:
            around = self.bare[max(0, place - 1) : place] + self.bare[place + 1 : place + 2]
            edits.append(self.edit(place, place + 1, "" if re.search(r"[\s()]", around) or len(around) < 2 else " "))
        more = f" ({len(places)} of them)" if len(places) > 1 else ""
        self.fault(f"PDDL has no commas{more}", places[0], "separate words by blanks", "other-notation", edits)
        self.change([(place, place + 1) for place in places], blanks)


def _plain(text: str) -> str:
    """Return an entity of HTML as the sign that it means, filled up with blanks."""
    from html import unescape  # which most texts do not need

    return unescape(unescape(text)).replace("\xa0", " ").ljust(len(text))


def blanks(text: str) -> str:
    """Return a text with each character but the ends of lines a blank."""
    return re.sub(r"[^\n]", " ", text)


def _indent(text: str) -> int:
    return len(text) - len(text.lstrip())


def _end_of_group(text: str, begin: int, end: int) -> int:
    """Return the place behind the group that begins at ``begin``; ``end`` where it is not closed before that."""
    depth = 0
    for match in _PARENTHESIS.finditer(text, begin, end):
        depth += 1 if match[0] == "(" else -1
        if not depth:
            return match.end()
    return end


# What stays of marks that are not blanked out.
_KEPT: Mapping[str, Callable[[str], str]] = {
    "entity": _plain,
    "quoted": lambda text: f" {text[1:-1].replace(' ', '-')} ",
    "dollar": lambda _: "?",
}
