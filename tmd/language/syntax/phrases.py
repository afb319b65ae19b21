"""Turns of phrase as rows of data (``data/phrases.yaml``): a pattern over decided words, and plainer words for it.

A pattern is a sequence of elements, separated by blanks:

* ``word`` or ``one|two``: these words; ``@name``: a word of that section of ``words.txt``;
* ``N`` or ``DET|NUM``: a word of that class (:class:`~tmd.language.syntax.tokens.Kind`);
* ``NP`` and the like: a macro of the file; ``ANY``: any word; ``ASKS``: a question mark;
* ``x:NP``: an element whose words are kept under a name;
* ``( ... )``, with ``|`` between alternatives; behind an element or a group ``?``, ``*`` and ``+``;
* ``^``: the beginning of a clause, ``^^`` of a sentence; ``$``: the end of a clause.

The replacement has words, ``{x}`` for what was kept, ``{x.stem}`` for the verb of a kept word, ``{x.end}`` for the
end of a scale that kept words point to, and ``word/V`` for a word of a given class. Words of the pattern that are not
kept disappear; with a ``note``, they are reported with it. A sentence in which a row has fired is tagged again. The
rows of a domain's lexicon are tried after those of the file.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cache

import yaml

from tmd.language.clause import Span
from tmd.language.lexicon.lexicon import Lexicon, PhraseRow, data_text, first_of, section
from tmd.language.syntax.rows import Entry, read_file, read_rows, section_names
from tmd.language.syntax.tagger import decide, tag
from tmd.language.syntax.tokens import Kind, Token, noted, tokenise

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
_SLOT = re.compile(r"\{([a-z])(\.stem|\.deed|\.end)?\}\Z")
_MOST = 4
"""Times that one row may fire in a sentence."""
_LONGEST = 200
"""Tokens of a sentence that is searched; longer ones are read as they are."""


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
    slots = [(element, _SLOT.match(element)) for element in entry["as"].split()]
    for slot in (slot for _, slot in slots if slot and slot[1] not in pattern.groupindex):
        entry.fail("as", f"the pattern keeps nothing under '{slot[1]}'")
    verbs = frozenset(slot[1] for _, slot in slots if slot and slot[2] in (".stem", ".deed"))
    deeds = frozenset(slot[1] for _, slot in slots if slot and slot[2] == ".deed")
    replacement = tuple((element, slot[1] if slot else "") for element, slot in slots)
    examples = tuple((entry[key], entry.places[key]) for key in ("example", "paraphrase"))
    return PhraseRow(entry["id"], pattern, triggers, replacement, verbs, deeds, entry["note"], examples)


def _regex(text: str, macros: Mapping[str, str]) -> tuple[str, frozenset[str]]:
    """Return a pattern as a regular expression, and words of which each match has one, if there are such."""
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
    given, kinds, words = list[str](), list[str](), set[str]()
    for part in match["core"].split("|"):
        if part in macros:
            given.append(macros[part])
        elif part.startswith("@"):
            words.update(*(section(name) for name in section_names(part[1:])))
        elif not part.isupper():
            words.add(part)
        elif part in Kind.__members__:
            kinds.append(part)
        else:
            raise ValueError(f"'{part}' is no class of words and no macro")
    given += [rf"(?:{'|'.join(map(re.escape, sorted(words)))})\t[A-Z]+ "] if words else []
    given += [rf"[^\t ]+\t(?:{'|'.join(kinds)}) "] if kinds else []
    body = f"(?:{'|'.join(given)}){match['times']}"
    always = len(given) == bool(words) and match["times"] in ("", "+")
    return f"(?P<{match['slot']}>{body})" if match["slot"] else body, frozenset(words if always else ())


def rewrite(tokens: list[Token], lexicon: Lexicon, trace: list[str] | None = None) -> tuple[list[Token], list[Token]]:
    """Replace turns of phrase in decided tokens.

    Args:
        tokens: The decided tokens of a text.
        lexicon: The words and phrases of the domain.
        trace: Takes the ids of the rows that fire, also of those that decide words again.

    Returns:
        The tokens, decided again where a row has fired, and the tokens that ask for nothing, with the reason.
    """
    result: list[Token] = []
    dropped: list[Token] = []
    for sentence in _sentences(tokens):
        for row in (*builtin_rows(), *lexicon.phrases) if len(sentence) <= _LONGEST else ():
            if not row.triggers or any(t.text in row.triggers for t in sentence):
                sentence = _applied(row, sentence, lexicon, trace, dropped)
        result += sentence
    return result, dropped


def _applied(
    row: PhraseRow, sentence: list[Token], lexicon: Lexicon, trace: list[str] | None, dropped: list[Token]
) -> list[Token]:
    """Return a sentence with what a row matches replaced; what disappears with a note is added to ``dropped``."""
    for _ in range(_MOST):
        text = "".join(f"{t.text.replace(' ', '_')}\t{t.kind.value} " for t in sentence)
        match = row.pattern.search(text)
        if match is None or not match[0]:
            break
        slots = _slots(match, sentence)
        if not _has_verbs(row, slots, lexicon):
            break
        if trace is not None:
            trace.append(row.id)
        begin, end = (text.count(" ", 0, place) for place in match.span())
        used = {id(t) for e, name in row.replacement if e == f"{{{name}}}" for t in slots.get(name, ())}
        gone = [t for t in sentence[begin:end] if id(t) not in used and t.kind is not Kind.ADV]
        new = _new(row, slots, sentence[begin].span.start, gone, dropped)
        sentence = _decided([*sentence[:begin], *new, *sentence[end:]], lexicon, trace)
    return sentence


def _has_verbs(row: PhraseRow, slots: Mapping[str, list[Token]], lexicon: Lexicon) -> bool:
    """Return whether the words of which a row wants the verb are verbs, and those that are deeds can be done."""
    stems = {name: slots[name][0].stem if name in slots else "" for name in row.verbs}
    return all(stems.values()) and all(lexicon.is_deed(stems[name]) for name in row.deeds)


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


def _new(
    row: PhraseRow, slots: Mapping[str, list[Token]], place: int, gone: list[Token], dropped: list[Token]
) -> list[Token]:
    """Return what takes the place of a match; the first new word covers the words that are gone without a note."""
    spans = [span for token in gone for span in (token.span, *token.parts)]
    if row.note:
        spans = []
        dropped += noted(gone, row.note)
    new: list[Token] = []
    for element, name in (_end_of_scale(*each, slots) for each in row.replacement):
        if name and name not in row.verbs:
            kept = slots.get(name, [])
            again = any(token is other for token in kept for other in new)
            new += map(replace, kept) if again else kept
            continue
        place = new[-1].span.end if new else place
        fresh = _fresh(element, slots[name][0].stem if name else "", name in row.deeds, Span(place, place))
        if spans and fresh.kind is not Kind.STOP:
            fresh.span, fresh.parts, spans = spans[0], spans[1:], []
        new.append(fresh)
    return new


def _end_of_scale(element: str, name: str, slots: Mapping[str, list[Token]]) -> tuple[str, str]:
    """Return the end that kept words point to in the place of ``{x.end}``; other elements as they are."""
    if not element.endswith(".end}"):
        return element, name
    low = any(token.text in section("least_words") for token in slots[name])
    return f"{first_of('least_words' if low else 'most_words')}/N", ""


def _fresh(element: str, stem: str, needed: bool, span: Span) -> Token:
    """Return a new token: a verb of a kept word, a word of a given class, or a word still to be tagged."""
    form = "ing" if needed else "base"  # "needs a wash" is "needs washing"
    word, _, kind = (stem, "", Kind.ING if needed else Kind.V) if stem else element.partition("/")
    if kind:
        stem, first = word if kind in (Kind.V, Kind.ING) else "", (Kind(kind), form)
        return Token(first[0], word, span, stem=stem, form=first[1], strength=3, first=first)
    token = tokenise(word)[0]
    token.span = span
    return token


def _decided(tokens: list[Token], lexicon: Lexicon, trace: list[str] | None) -> list[Token]:
    """Decide tokens again: each has its first class again, new words get one."""
    result: list[Token] = []
    for token in tokens:
        if token.first:
            token.kind, token.form = token.first
        result += [token] if token.first else tag([token], lexicon, trace)
    decide(result, lexicon, trace)
    return result
