"""Turns of phrase as rows of data (``data/phrases.yaml``): a pattern over decided words, and plainer words for it.

A pattern is a sequence of elements, separated by blanks:

* ``word`` or ``one|two``: these words; ``@name``: a word of that section of ``words.txt``;
* ``N`` or ``DET|NUM``: a word of that class (:class:`~tmd.language.syntax.tokens.Kind`);
* ``NP`` and the like: a macro of the file; ``ANY``: any word; ``ASKS``: a question mark;
* ``x:NP``: an element whose words are kept under a name;
* ``( ... )``, with ``|`` between alternatives; behind an element or a group ``?``, ``*`` and ``+``;
* ``^``: the beginning of a clause, ``^^`` of a sentence; ``$``: the end of a clause.

The replacement has words, ``{x}`` for what was kept, ``{x.stem}`` for the verb of a kept word, and ``word/V`` for a
word of a given class. Words of the pattern that are not kept disappear; with a ``note``, they are reported with it. A
sentence in which a row has fired is tagged anew. The rows of a domain's lexicon are tried after those of the file.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache

import yaml

from tmd.language.clause import Span
from tmd.language.lexicon.lexicon import Lexicon, data_text, section
from tmd.language.syntax.rows import Entry, read_file, read_rows, section_names
from tmd.language.syntax.tagger import decide, tag
from tmd.language.syntax.tokens import Kind, Token, tokenise

_LEAD = rf"(?:[^\t ]+\t(?:{Kind.ADV}|{Kind.FILLER}) )*"
_MARKS = {
    "^": rf"(?:(?<![^\n])|(?<=\t{Kind.CC} )|(?<=\t{Kind.COMMA} )|(?<=\t{Kind.STOP} )){_LEAD}",
    "^^": rf"(?:(?<![^\n])|(?<=\t{Kind.STOP} )){_LEAD}",
    "$": rf"(?={_LEAD}(?:[^\t ]+\t(?:{Kind.STOP}|{Kind.COMMA}|{Kind.CC}) |\Z))",
    "|": "|",
}
_GIVEN = {"ANY": rf"[^\t ]+\t(?!{Kind.STOP} )[A-Z]+ ", "ASKS": rf"[^\t ]*\?[^\t ]*\t{Kind.STOP} "}
"""Macros that patterns cannot express: any word, and a question mark."""
_ELEMENT = re.compile(r"(?:(?P<slot>[a-z]):)?(?P<core>[^?*+]+)(?P<times>[?*+]?)\Z")
_SLOT = re.compile(r"\{([a-z])(\.stem)?\}\Z")
_MOST = 4
"""Times that one row may fire in a sentence."""
_LONGEST = 200
"""Tokens of a sentence that is searched; longer ones are read as they are."""


@dataclass(frozen=True, slots=True)
class PhraseRow:
    """One row.

    Attributes:
        entry: The row as it is written.
        pattern: The compiled pattern, over ``word<tab>CLASS`` and a blank for each token.
        triggers: Words of which the sentence must have one; empty if it must have none.
        replacement: The elements of the replacement.
    """

    entry: Entry
    pattern: re.Pattern[str]
    triggers: frozenset[str]
    replacement: tuple[str, ...]

    @property
    def id(self) -> str:
        """Its name."""
        return self.entry["id"]


_NEEDED, _FURTHER = ("read",), ("as", "note", "means")


@cache
def _builtin() -> tuple[tuple[PhraseRow, ...], Mapping[str, str]]:
    """Return the rows and the macros of ``data/phrases.yaml``."""
    entries, sections = read_file(data_text("phrases.yaml"), "phrases.yaml", _NEEDED, _FURTHER)
    macros, given = dict(_GIVEN), sections["macros"]
    for name in given.values:  # one may name those before it
        macros[name] = f"(?:{given.checked(name, lambda text: _regex(text, macros)[0])})"
    return tuple(_row(entry, macros) for entry in entries), macros


def builtin_rows() -> tuple[PhraseRow, ...]:
    """Return the rows of ``data/phrases.yaml``, in the order in which they are tried."""
    return _builtin()[0]


def read_phrases(node: yaml.Node, file: str) -> tuple[PhraseRow, ...]:
    """Read a list of phrase rows, which may use the macros of the language.

    Raises:
        TmdError: A row lacks a key, uses an id twice, or names an unknown section, class or slot.
    """
    known = {row.id for row in builtin_rows()}
    entries = read_rows(node, file, _NEEDED, _FURTHER)
    for entry in entries:
        if entry["id"] in known:
            entry.fail("id", f"the language has a row with the id '{entry['id']}'", "choose another id")
    return tuple(_row(entry, _builtin()[1]) for entry in entries)


def _row(entry: Entry, macros: Mapping[str, str]) -> PhraseRow:
    body, triggers = entry.checked("read", lambda text: _regex(text, macros))
    pattern = entry.checked("read", lambda _: re.compile(rf"(?<![^ \n]){body}"))
    replacement = tuple(entry["as"].split())
    for element in replacement:
        slot = _SLOT.match(element)
        if slot and slot[1] not in pattern.groupindex:
            entry.fail("as", f"the pattern keeps nothing under '{slot[1]}'")
    return PhraseRow(entry, pattern, triggers, replacement)


def _regex(text: str, macros: Mapping[str, str]) -> tuple[str, frozenset[str]]:
    """Return a pattern as a regular expression, and words of which each match has one, if they can be told."""
    parts: list[str] = []
    groups: list[str] = []
    triggers: list[frozenset[str]] = []
    for element in text.split():
        if element.endswith("("):
            parts.append("(?:" if element == "(" else f"(?P<{element[0]}>(?:")
            groups.append("" if element == "(" else ")")
        elif element.startswith(")") and groups:
            parts.append(element + groups.pop())
        elif element in _MARKS:
            parts.append(_MARKS[element])
            triggers += [frozenset()] if element == "|" and not groups else []
        else:
            body, words = _element(element, macros)
            parts.append(body)
            triggers += [words] if words and not groups else []
    alternatives = frozenset() in triggers
    return "".join(parts), triggers[0] if triggers and not alternatives else frozenset()


def _element(element: str, macros: Mapping[str, str]) -> tuple[str, frozenset[str]]:
    """Return an element as a regular expression, and its words if it is nothing else and must be there."""
    match = _ELEMENT.match(element)
    if match is None:
        raise ValueError(f"'{element}' is no element of a pattern")
    parts = match["core"].split("|")
    lists = [section(name) for part in parts if part.startswith("@") for name in section_names(part[1:])]
    words = frozenset().union(*lists, (part for part in parts if not (part.isupper() or part.startswith("@"))))
    kinds = [part for part in parts if part.isupper() and part not in macros]
    if unknown := [part for part in kinds if part not in Kind.__members__]:
        raise ValueError(f"'{unknown[0]}' is no class of words and no macro")
    bodies = [macros[part] for part in parts if part in macros]
    bodies += [rf"(?:{'|'.join(map(re.escape, sorted(words)))})\t[A-Z]+ "] if words else []
    bodies += [rf"[^\t ]+\t(?:{'|'.join(kinds)}) "] if kinds else []
    body = f"(?:{'|'.join(bodies)}){match['times']}"
    always = len(bodies) == bool(words) and match["times"] in ("", "+")
    return f"(?P<{match['slot']}>{body})" if match["slot"] else body, words if always else frozenset()


def rewrite(tokens: list[Token], lexicon: Lexicon, trace: list[str] | None = None) -> tuple[list[Token], list[Token]]:
    """Replace turns of phrase in decided tokens.

    Args:
        tokens: The decided tokens of a text.
        lexicon: The words and phrases of the domain.
        trace: Takes the ids of the rows that fire, also of those that decide words anew.

    Returns:
        The tokens, decided anew where a row has fired, and the tokens that ask for nothing, with the reason.
    """
    result: list[Token] = []
    dropped: list[Token] = []
    for sentence in _sentences(tokens):
        for row in (*builtin_rows(), *lexicon.phrases) if len(sentence) <= _LONGEST else ():
            for _ in range(_MOST if not row.triggers or any(t.text in row.triggers for t in sentence) else 0):
                text = "".join(f"{t.text.replace(' ', '_')}\t{t.kind.value} " for t in sentence)
                match = row.pattern.search(text)
                slots = _slots(match, sentence) if match and match[0] else {}
                if not match or not match[0] or not _has_verbs(row, slots):
                    break
                if trace is not None:
                    trace.append(row.id)
                begin, end = (text.count(" ", 0, place) for place in match.span())
                new = _new(row, slots, sentence[begin:end], dropped)
                sentence = _decided([*sentence[:begin], *new, *sentence[end:]], lexicon, trace)
        result += sentence
    return result, dropped


def _sentences(tokens: list[Token]) -> Iterator[list[Token]]:
    """Yield sentences; a question goes together with what follows, which may be what is asked if so."""
    start = 0
    for at, token in enumerate(tokens, 1):
        if (token.kind is Kind.STOP and "?" not in token.text and token.text != ":") or at == len(tokens):
            yield tokens[start:at]
            start = at


def _slots(match: re.Match[str], sentence: list[Token]) -> dict[str, list[Token]]:
    """Return the tokens that a match keeps, by name."""
    spans = {name: match.span(name) for name in match.re.groupindex if match[name] is not None}
    return {n: sentence[match.string.count(" ", 0, a) : match.string.count(" ", 0, b)] for n, (a, b) in spans.items()}


def _has_verbs(row: PhraseRow, slots: Mapping[str, list[Token]]) -> bool:
    """Tell whether each kept word of which the verb is wanted can be one."""
    wanted = [slot[1] for element in row.replacement if (slot := _SLOT.match(element)) and slot[2]]
    return all(slots.get(name) and slots[name][0].stem for name in wanted)


def _new(row: PhraseRow, slots: Mapping[str, list[Token]], matched: list[Token], dropped: list[Token]) -> list[Token]:
    """Return what takes the place of a match; what disappears with a note is added to ``dropped``."""
    used = {id(t) for element in row.replacement if (s := _SLOT.match(element)) for t in slots.get(s[1], ())}
    gone = [t for t in matched if id(t) not in used and t.kind is not Kind.ADV]
    spans = [] if row.entry["note"] else [span for t in gone for span in (t.span, *t.parts)]
    for token in gone if row.entry["note"] else ():
        token.note = row.entry["note"]
        dropped.append(token)
    new: list[Token] = []
    for element in row.replacement:
        slot = _SLOT.match(element)
        if slot and not slot[2]:
            new += slots.get(slot[1], ())
            continue
        place = new[-1].span.end if new else matched[0].span.start
        fresh = _fresh(element, slots[slot[1]][0].stem if slot else "", Span(place, place))
        if spans and fresh.kind is not Kind.STOP:  # the clause covers the words that it was made of
            fresh.span, fresh.parts, spans = spans[0], spans[1:], []
        new.append(fresh)
    return new


def _fresh(element: str, stem: str, span: Span) -> Token:
    """Return a new token: a verb of a kept word, a word of a given class, or a word still to be tagged."""
    word, _, kind = (stem, "", Kind.V) if stem else element.partition("/")
    if kind:
        return Token(Kind(kind), word, span, stem=word if kind == Kind.V else "", form="base", strength=3)
    token = tokenise(word)[0]
    token.span = span
    return token


def _decided(tokens: list[Token], lexicon: Lexicon, trace: list[str] | None) -> list[Token]:
    """Return tokens decided anew: each has its first class again, new words get one."""
    result: list[Token] = []
    for token in tokens:
        if token.first:
            token.kind, token.form = token.first
        result += tag([token], lexicon, trace) if token.kind is Kind.WORD and not token.first else [token]
    for token in result:
        token.first = token.first or (token.kind, token.form)
    decide(result, lexicon, trace)
    return result
