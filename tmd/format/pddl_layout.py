"""Laying out PDDL: indentation, spaces and blank lines; comments and the author's own line breaks stay.

Sections and the parts of actions begin on new lines; a line that is too long is broken; nothing is joined. A
group continues under its first argument, or two columns in where its head stands last on a line, unless the author
chose another of the usual ways.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace

from tmd.diagnostics import Location, TmdError
from tmd.pddl.reading.syntax import parse, split_lines

WIDTH = 120
_TOKEN = re.compile(r";.*|[()]|[^\s();]+")
_PARTS = frozenset({":parameters", ":precondition", ":effect"})
# Longer texts are refused, as `tmd check` refuses them.
MAX_CHARACTERS = 10_000_000
# Tokens that are laid out until every line is short enough: some 30 s. A domain of a thousand lines takes 50,000.
_MOST_WORK = 3_000_000
_DEEPEST = 100
# A comment that many blanks behind the code follows it; farther away it is in a column.
_LOOSE = 2
_TOP = frozenset({"define", ":action"})
# Groups that continue two columns in from their parenthesis.
_BODY = frozenset({"forall", "exists"})


@dataclass(frozen=True, slots=True)
class _Token:
    text: str
    # 0: on the line of the token before; 1: on a new line; 2: with a blank line between.
    breaks: int
    # Where it stood; ``indent`` is where its line began.
    column: int
    indent: int

    @property
    def is_comment(self) -> bool:
        return self.text.startswith(";")


@dataclass(slots=True)
class _Open:
    """A group that is open while lines are laid out."""

    column: int
    line_indent: int
    head: str = ""
    count: int = 0
    # The column of the first argument, if it stands on the line of the head.
    argument: int | None = None
    last: str = ""
    # Where it and its line began before.
    was: tuple[int, int] = (0, 0)
    was_argument: int | None = None

    def indent(self, column: int) -> int:
        """Return the column of a line that continues this group and began at ``column`` before."""
        if self.head in _TOP:
            return self.column + (4 if self.last in _PARTS else 2)
        if self.argument is not None and column == self.was_argument:
            return self.argument
        if self.head and column in (self.was[0] + 2, self.was[1] + 2):
            return self.column + 2 if column == self.was[0] + 2 else self.line_indent + 2
        if self.head in _BODY:
            return self.column + 2
        if self.count and not self.head:
            return self.column + 1
        if self.argument is not None:
            return self.argument
        return self.line_indent + 2


def format_pddl(text: str, file: str = "<text>") -> str:
    """Return ``text`` laid out; the same tokens and comments in the same order.

    Raises:
        TmdError: Its parentheses do not match, so nothing can be laid out, or it is too large or too deep.
    """
    if len(text) > MAX_CHARACTERS:
        message = f"{file}: larger than {MAX_CHARACTERS // 1_000_000} MB"
        raise TmdError(message, hint="this is not a file of tmd", code="too-large")
    _refuse_unbalanced(text, file)
    tokens = list(_broken(_tokens(text)))
    work = 0
    while True:
        work += len(tokens)
        if work > _MOST_WORK:
            place = Location(file, 1, 1)
            hint = "break its longest lines first, to some 100 characters"
            raise TmdError("there is too much on too few lines", location=place, hint=hint, code="too-large")
        lines, starts = _lay_out(tokens)
        wider = next((n for n, line in enumerate(lines) if len(line.partition(";")[0].rstrip()) > WIDTH), None)
        if wider is None or not _break_line(tokens, starts[wider], starts[wider + 1], len(lines[wider])):
            break
    laid = "\n".join(lines) + "\n" if lines else ""
    if [t.text for t in _tokens(laid)] != [t.text for t in tokens]:
        raise TmdError("cannot be laid out without changing it", location=Location(file, 1, 1), hint="please report")
    return laid


def _refuse_unbalanced(text: str, file: str) -> None:
    """Refuse unbalanced or very deep parentheses; other faults do not prevent layout."""
    depth = deepest = 0
    for token in _tokens(text):
        depth += {"(": 1, ")": -1}.get(token.text, 0)
        deepest = max(depth, deepest)
        if depth < 0:
            break
    if depth:
        parse(text, file)
        raise TmdError("the parentheses do not match", location=Location(file, 1, 1), code="unclosed-parenthesis")
    if deepest > _DEEPEST:
        message, place = f"nested more than {_DEEPEST} levels deep", Location(file, 1, 1)
        raise TmdError(message, location=place, hint="write it with fewer levels", code="nested-too-deeply")


def _tokens(text: str) -> list[_Token]:
    found: list[_Token] = []
    empty = 0
    for line in split_lines(text):
        expanded = line.expandtabs(8)
        indent = len(expanded) - len(expanded.lstrip())
        matches = list(_TOKEN.finditer(expanded))
        if not matches:
            empty += 1
        for match in matches:
            first = match.start() == indent
            breaks = (2 if empty and found else 1) if first else 0
            found.append(_Token(match[0].rstrip(), breaks, match.start(), indent))
            empty = 0
    return found


def _broken(tokens: list[_Token]) -> Iterator[_Token]:
    """Yield the tokens with sections and the parts of actions on their own lines."""
    groups: list[tuple[str, int]] = []  # of each that is open: its head, and how many parts it has
    for place, token in enumerate(tokens):
        closes = token.text == ")"
        new = token.breaks
        if closes and not (place and tokens[place - 1].is_comment):
            new = min(new, 1)
        elif groups and not new and _begins_line(token, *groups[-1]):
            new = 1
        yield replace(token, breaks=new)
        if token.is_comment:
            continue
        if closes:
            groups.pop()
            continue
        if groups:
            head, count = groups[-1]
            groups[-1] = (token.text.lower() if count == 0 and token.text != "(" else head), count + 1
        if token.text == "(":
            groups.append(("", 0))


def _begins_line(token: _Token, head: str, count: int) -> bool:
    """Return whether ``token``, part ``count`` of the group of ``head``, begins a section or a part of an action."""
    section = head == "define" and token.text == "(" and count >= 2
    return section or (head == ":action" and token.text.lower() in _PARTS)


def _lay_out(tokens: list[_Token]) -> tuple[list[str], list[int]]:
    """Return the lines, and the number of the token that each begins with (and the number of all at the end)."""
    lines: list[str] = []
    starts: list[int] = []
    stack: list[_Open] = []
    indent = 0
    for number, token in enumerate(tokens):
        fresh = token.breaks or not lines or (number > 0 and tokens[number - 1].is_comment)
        if fresh:
            if token.breaks == 2 and token.text != ")" and not _after_open(tokens, number):
                lines.append("")
                starts.append(number)
            indent = _indent(token, stack)
            lines.append(" " * indent)
            starts.append(number)
        elif token.is_comment:
            lines[-1] += " " * _gap(token, tokens[number - 1], tokens[starts[-1]], indent, len(lines[-1]))
        elif token.text != ")" and tokens[number - 1].text != "(":
            lines[-1] += " "
        _enter(token, stack, len(lines[-1]), indent, bool(fresh))
        lines[-1] += token.text
    starts.append(len(tokens))
    return lines, starts


def _gap(comment: _Token, before: _Token, first: _Token, indent: int, length: int) -> int:
    """Return the blanks before a comment: as many as there were, or so many that it stays in its column."""
    was = comment.column - before.column - len(before.text)
    if was <= _LOOSE:
        return max(1, was)
    if first.column != comment.indent:
        return 1
    return max(1, comment.column + indent - comment.indent - length)


def _after_open(tokens: list[_Token], number: int) -> bool:
    return number > 0 and tokens[number - 1].text == "("


def _indent(token: _Token, stack: list[_Open]) -> int:
    if not stack:
        return 0
    if token.text == ")":
        return stack[-1].line_indent
    if token.text.lower() in _PARTS:
        return stack[-1].column + 2
    return stack[-1].indent(token.column)


def _enter(token: _Token, stack: list[_Open], column: int, indent: int, fresh: bool) -> None:
    """Note ``token`` in the groups that are open."""
    if token.is_comment:
        return
    if token.text == ")":
        stack.pop()
        return
    if stack:
        top = stack[-1]
        if top.count == 0 and token.text != "(" and token.text[0] != "?":
            top.head = token.text.lower()
        elif top.count == 1 and top.argument is None and not fresh:
            top.argument = column
            top.was_argument = token.column
        top.count += 1
        top.last = token.text.lower()
    if token.text == "(":
        stack.append(_Open(column, indent, was=(token.column, token.indent)))


def _break_line(tokens: list[_Token], start: int, end: int, length: int) -> bool:
    """Break the line of the tokens from ``start`` to ``end``, of ``length`` columns: at its groups, or when full."""
    opened: list[int] = []
    children: dict[int, list[int]] = {}
    for number in range(start, end):
        text = tokens[number].text
        if text == "(":
            if opened and number != start:
                children.setdefault(opened[-1], []).append(number)
            elif not opened and number != start:
                children.setdefault(-1, []).append(number)
            opened.append(number)
        elif text == ")" and opened:
            opened.pop()
    for _, inner in sorted(children.items()):
        if len(inner) > 1:
            for number in inner:
                tokens[number] = replace(tokens[number], breaks=max(tokens[number].breaks, 1))
            return True
    return _fill(tokens, start, end, length)


def _fill(tokens: list[_Token], start: int, end: int, column: int) -> bool:
    """Break a line of words before the first word that goes beyond the width."""
    for number in range(end - 1, start + 1, -1):
        text = tokens[number].text
        column -= len(text) + (text not in "()")
        if column <= WIDTH - 2 and text not in ("(", ")", "-") and tokens[number - 1].text not in ("(", "-"):
            if tokens[number].breaks or tokens[number].is_comment:
                return False
            tokens[number] = replace(tokens[number], breaks=1)
            return True
    return False
