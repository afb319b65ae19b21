"""Turns of phrase as rows of data (``data/phrases.yaml``): a pattern over decided words, and plainer words for it.

A pattern is a sequence of elements, separated by blanks:

* ``word`` or ``one|two``: these words; ``@name``: a word of that section of ``words.txt``;
* ``N`` or ``DET|NUM``: a word of that class (:class:`~tmd.language.syntax.tokens.Kind`);
* ``NP`` and the like: a macro of the file; ``ANY``: any word; ``ASKS``: a question mark;
* ``x:NP``: an element whose words are kept under a name;
* ``( ... )``, with ``|`` between alternatives; behind an element or a group ``?``, ``*`` and ``+``;
* ``^``: the beginning of a clause, ``^^`` of a sentence; ``$``: the end of a clause.

The replacement has words, ``{x}`` for what was kept, ``{x.stem}`` for the verb of a kept word, and ``word/V`` for a word
of a given class. Words of the pattern that are not kept disappear. A sentence in which a row has fired is tagged anew.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache

import yaml

from tmd.diagnostics import Location, TmdError
from tmd.language.clause import Span
from tmd.language.lexicon.lexicon import Lexicon, data_text, sections
from tmd.language.syntax.tagger import decide, tag
from tmd.language.syntax.tokens import Kind, Token, tokenise

FILE = "phrases.yaml"
_ANY = r"[^\t ]+\t[A-Z]+ "
_LEAD = rf"(?:[^\t ]+\t(?:{Kind.ADV}|{Kind.FILLER}) )*"
_BEGIN = rf"(?:(?<![^\n])|(?<=\t{Kind.CC} )|(?<=\t{Kind.COMMA} )|(?<=\t{Kind.STOP} )){_LEAD}"
_START = rf"(?:(?<![^\n])|(?<=\t{Kind.STOP} )){_LEAD}"
_FINISH = rf"(?={_LEAD}(?:[^\t ]+\t(?:{Kind.STOP}|{Kind.COMMA}|{Kind.CC}) |\Z))"
_ELEMENT = re.compile(r"(?:(?P<slot>[a-z]):)?(?P<core>[^?*+]+)(?P<times>[?*+]?)\Z")
_SLOT = re.compile(r"\{([a-z])(\.stem)?\}\Z")
_GIVEN = {"ANY": rf"[^\t ]+\t(?!{Kind.STOP} )[A-Z]+ ", "ASKS": rf"[^\t ]*\?[^\t ]*\t{Kind.STOP} "}
"""Macros that patterns cannot express: any word, and a question mark."""
_MOST = 4
"""Times that one row may fire in a sentence."""
_LONGEST = 200
"""Tokens of a sentence that is searched; longer ones are read as they are."""


@dataclass(frozen=True, slots=True)
class PhraseRow:
    """One row.

    Attributes:
        id: Its name.
        pattern: The compiled pattern, over ``word<tab>CLASS`` and a blank for each token.
        triggers: Words of which the sentence must have one; empty if it must have none.
        replacement: The elements of the replacement.
        note: Why the words that disappear ask for nothing; empty where they do.
    """

    id: str
    pattern: re.Pattern[str]
    triggers: frozenset[str]
    replacement: tuple[str, ...]
    note: str = ""


def read_rows(text: str, file: str) -> tuple[PhraseRow, ...]:
    """Read a file of phrase rows.

    Raises:
        TmdError: A row lacks a key, uses an id twice, or names an unknown macro, section, class or slot.
    """
    data = yaml.load(text, getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    macros = dict(_GIVEN)
    for name, pattern in data["macros"].items():
        macros[name] = f"(?:{_compiled(pattern, macros, file, name)})"
    rows: dict[str, PhraseRow] = {}
    for raw in data["rows"]:
        name = str(raw.get("id", ""))
        missing = [key for key in ("id", "read", "as", "example", "paraphrase") if not raw.get(key) and key != "as"]
        if missing or name in rows:
            reason = f"has no '{missing[0]}'" if missing else "is there twice"
            raise _fault(f"the phrase row '{name}' {reason}", text, file, name)
        rows[name] = _row(raw, macros, text, file)
    return tuple(rows.values())


def _row(raw: Mapping[str, str], macros: Mapping[str, str], text: str, file: str) -> PhraseRow:
    name = raw["id"]
    pattern = re.compile(r"(?<![^ \n])" + _compiled(raw["read"], macros, file, name))
    replacement = tuple(str(raw.get("as") or "").split())
    for element in replacement:
        slot = _SLOT.match(element)
        if slot and slot[1] not in pattern.groupindex:
            raise _fault(f"the phrase row '{name}' keeps nothing under '{slot[1]}'", text, file, name)
    return PhraseRow(name, pattern, frozenset(_triggers(raw["read"])), replacement, raw.get("note", ""))


def _fault(message: str, text: str, file: str, name: str) -> TmdError:
    line = next((n for n, row in enumerate(text.splitlines(), 1) if f"id: {name}" in row), 1)
    return TmdError(message, location=Location(file, line, 1), hint="see the head of the file for the format")


def _compiled(pattern: str, macros: Mapping[str, str], file: str, name: str) -> str:
    parts: list[str] = []
    named: list[bool] = []
    for element in pattern.split():
        if element.endswith("("):
            named.append(len(element) > 1)
            parts.append(f"(?P<{element[0]}>(?:" if named[-1] else "(?:")
        elif element.startswith(")") and named:
            parts.append(element + ")" * named.pop())
        elif element in ("^", "^^", "$", "|"):
            parts.append({"^": _BEGIN, "^^": _START, "$": _FINISH}.get(element, element))
        else:
            parts.append(_element(element, macros, file, name))
    return "".join(parts)


def _element(element: str, macros: Mapping[str, str], file: str, name: str) -> str:
    match = _ELEMENT.match(element)
    if match is None:
        raise TmdError(f"the phrase row '{name}' has the element '{element}'", location=Location(file, 1, 1))
    words: list[str] = []
    kinds: list[str] = []
    bodies: list[str] = []
    for part in match["core"].split("|"):
        if part in macros:
            bodies.append(macros[part])
        elif part.startswith("@"):
            words += sections()[part[1:]]
        elif part.isupper():
            kinds.append(Kind(part).value)
        else:
            words.append(part)
    bodies += [rf"(?:{'|'.join(map(re.escape, words))})\t[A-Z]+ "] * bool(words)
    bodies += [rf"[^\t ]+\t(?:{'|'.join(kinds)}) "] * bool(kinds)
    body = f"(?:{'|'.join(bodies)})"
    if match["times"]:
        body = f"(?:{body}){match['times']}"
    return f"(?P<{match['slot']}>{body})" if match["slot"] else body


def _triggers(pattern: str) -> Iterator[str]:
    """Yield the words of the first element that every match has, if it is made of words."""
    depth = 0
    for element in pattern.split():
        depth += element.endswith("(") - element.startswith(")")
        match = _ELEMENT.match(element)
        if (
            depth
            or match is None
            or element in ("^", "^^", "$")
            or match["times"] in ("?", "*")
            or element.startswith(")")
        ):
            continue
        parts = match["core"].split("|")
        if not any(part.isupper() for part in parts):
            for part in parts:
                yield from sections()[part[1:]] if part.startswith("@") else (part,)
            return


@cache
def builtin_rows() -> tuple[PhraseRow, ...]:
    """Return the rows of ``data/phrases.yaml``, in the order in which they are tried."""
    return read_rows(data_text(FILE), FILE)


def rewrite(
    tokens: list[Token], lexicon: Lexicon, trace: list[str] | None = None, rows: tuple[PhraseRow, ...] | None = None
) -> tuple[list[Token], list[Token]]:
    """Replace turns of phrase in decided tokens.

    Args:
        tokens: The decided tokens of a text.
        lexicon: The words of the domain.
        trace: Takes the ids of the rows that fire.
        rows: The rows; those of the language by default.

    Returns:
        The tokens, decided anew where a row has fired, and the tokens that ask for nothing, with the reason.
    """
    rows = builtin_rows() if rows is None else rows
    result: list[Token] = []
    dropped: list[Token] = []
    for sentence in _sentences(tokens):
        if len(sentence) <= _LONGEST:
            sentence = _rewritten(sentence, lexicon, rows, trace, dropped)
        result += sentence
    return result, dropped


def _sentences(tokens: list[Token]) -> Iterator[list[Token]]:
    """Yield sentences; a question goes together with what follows, which may be what is asked if so."""
    sentence: list[Token] = []
    for token in tokens:
        sentence.append(token)
        if token.kind is Kind.STOP and "?" not in token.text and token.text != ":":
            yield sentence
            sentence = []
    if sentence:
        yield sentence


def _rewritten(
    tokens: list[Token],
    lexicon: Lexicon,
    rows: tuple[PhraseRow, ...],
    trace: list[str] | None,
    dropped: list[Token],
) -> list[Token]:
    words = {t.text for t in tokens}
    for row in rows:
        if row.triggers and row.triggers.isdisjoint(words):
            continue
        for _ in range(_MOST):
            text, starts = _joined(tokens)
            match = row.pattern.search(text)
            if match is None or match.end() == match.start() or not _has_verbs(match, row, tokens, starts):
                break
            tokens = _replaced(tokens, starts, match, row, lexicon, dropped)
            words = {t.text for t in tokens}
            if trace is not None:
                trace.append(row.id)
    return tokens


def _has_verbs(match: re.Match[str], row: PhraseRow, tokens: list[Token], starts: list[int]) -> bool:
    """Tell whether each kept word of which the verb is wanted can be one."""
    wanted = [slot[1] for element in row.replacement if (slot := _SLOT.match(element)) and slot[2]]
    return all(tokens[bisect_left(starts, match.start(name))].stem for name in wanted)


def _joined(tokens: list[Token]) -> tuple[str, list[int]]:
    parts, starts, place = [], [], 0
    for token in tokens:
        part = f"{token.text.replace(' ', '_')}\t{token.kind.value} "
        parts.append(part)
        starts.append(place)
        place += len(part)
    return "".join(parts), starts


def _replaced(
    tokens: list[Token], starts: list[int], match: re.Match[str], row: PhraseRow, lexicon: Lexicon, dropped: list[Token]
) -> list[Token]:
    """Return the sentence with a match replaced, decided anew."""
    begin, end = bisect_left(starts, match.start()), bisect_left(starts, match.end())
    slots = {
        name: tokens[bisect_left(starts, match.start(name)) : bisect_left(starts, match.end(name))]
        for name in match.re.groupindex
        if match.group(name) is not None
    }
    used = {id(t) for element in row.replacement if (s := _SLOT.match(element)) for t in slots.get(s[1], ())}
    gone = [t for t in tokens[begin:end] if id(t) not in used and t.kind is not Kind.ADV]
    if row.note:
        for token in gone:
            token.note = row.note
        dropped += gone
    new: list[Token] = []
    spans = [s for t in gone for s in (t.span, *t.parts)] if not row.note else []
    for element in row.replacement:
        slot = _SLOT.match(element)
        if slot and not slot[2]:
            new += slots.get(slot[1], ())
            continue
        place = new[-1].span.end if new else tokens[begin].span.start
        fresh = _fresh(element, slots, slot[1] if slot else "", Span(place, place))
        if spans and fresh.kind is not Kind.STOP:
            fresh.span, fresh.parts, spans = spans[0], spans[1:], []
        new.append(fresh)
    result = [*tokens[:begin], *new, *tokens[end:]]
    _restore(result)
    result = [
        t
        for token in result
        for t in (tag([token], lexicon) if token.kind is Kind.WORD and not token.first else [token])
    ]
    for token in result:
        token.first = token.first or (token.kind, token.form)
    decide(result, lexicon)
    return result


def _fresh(element: str, slots: Mapping[str, list[Token]], slot: str, span: Span) -> Token:
    """Return a new token: a verb of a kept word, a word of a given class, or a word still to be tagged."""
    if slot:
        verb = slots[slot][0]
        return Token(Kind.V, verb.stem, span, stem=verb.stem, form="base", strength=3)
    word, _, kind = element.partition("/")
    if kind:
        return Token(Kind(kind), word, span, stem=word if kind == Kind.V else "", form="base", strength=3)
    token = tokenise(word)[0]
    token.span = span
    return token


def _restore(tokens: list[Token]) -> None:
    """Give every token its first class again."""
    for token in tokens:
        if token.first:
            token.kind, token.form = token.first
