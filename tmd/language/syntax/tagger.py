"""Classes of words: first by lists, then by their neighbours (verb or noun, pronoun or determiner, ...).

Each word gets one class before any grammar runs; leaving the choice to an ambiguous grammar picks the noun reading in
lists and is far slower. What decides is data: of a table of ``data/pos.yaml`` the first row whose condition
(:mod:`~tmd.language.syntax.rows`) holds says what a word is.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cache, lru_cache
from itertools import pairwise
from typing import Any

from tmd.language.clause import NOWHERE
from tmd.language.lexicon.lexicon import (
    Lexicon,
    builtin,
    comparative_root,
    data_text,
    pairs,
    positive,
    section,
    sections,
    singular,
)
from tmd.language.syntax.rows import Conditions, Entry, Test, read_file, section_names
from tmd.language.syntax.tokens import NAME, Kind, Token, fold

_EDGE = Token(Kind.STOP, "", NOWHERE)
"""The token before the first word and behind the last."""
_LONGEST_RUN = 8
"""A pattern has at most so many words."""
WHEN = "says when, which no state shows"
_STRETCHED = re.compile(r"(.)\1{2,}")
"""A letter that is written three times or more."""
ADVERB = 5
"""Longer words that end in *ly* are adverbs."""


@dataclass(slots=True)
class Sentence:
    """The state of the sentence so far; conditions may name its attributes."""

    sub: bool = False
    """Inside a condition or relative clause whose own verb has not come yet ..."""
    nominal: bool = False
    """... and whose subject has come."""
    narrative: bool = False
    """The sentence tells what somebody does: "she takes the cup"."""
    let: bool = False
    """*Let* waits for its verb: "let the tea cool"."""
    verb: bool = False
    """An instruction verb has come."""


_NEW = Sentence()


class Surroundings:
    """A word and its surroundings, which conditions look at.

    Attributes:
        left: The nearest token before it except adverbs, decided.
        right: The nearest token behind it except adverbs, with its first class.
        beyond: The one behind that.
        last: The very token before it.
        last2: The one before that.
        next: The very token behind it.
    """

    __slots__ = ("at", "beyond", "last", "last2", "left", "lexicon", "next", "right", "sentence", "tokens", "word")

    def __init__(
        self,
        tokens: Sequence[Token],
        at: int,
        lexicon: Lexicon,
        left: Token = _EDGE,
        ahead: tuple[Token, Token] = (_EDGE, _EDGE),
        sentence: Sentence = _NEW,
    ) -> None:
        """Look at the word at one place of a text."""
        self.word, self.tokens, self.at, self.lexicon, self.sentence = tokens[at], tokens, at, lexicon, sentence
        self.left, (self.right, self.beyond) = left, ahead
        self.last = tokens[at - 1] if at > 0 else _EDGE
        self.last2 = tokens[at - 2] if at > 1 else _EDGE
        self.next = tokens[at + 1] if at + 1 < len(tokens) else _EDGE

    def graded(self) -> bool:
        """Return whether it is the comparative or superlative of an adjective that is dropped: "dirtiest"."""
        root = positive(self.word.text)
        roots = (root, f"{root}e") if root != self.word.text else comparative_root(self.word.text)
        return not section("drop_adjectives").isdisjoint(roots)

    def verb_next(self) -> bool:
        """Return whether the next word can be nothing but a verb, or is a likely one and the last of its part."""
        _, form, strength = self.lexicon.verb(self.right.text) or ("", "", 0)
        return form == "base" and strength >= 2 + (self.beyond.kind not in (Kind.STOP, Kind.COMMA))

    def particle(self, verb: Token, particle: Token) -> bool | None:
        """Return whether a verb has a particle; ``True`` even before a noun, ``None`` not at all."""
        return self.lexicon.particle(verb.stem or verb.text, particle.text)

    def predicate(self) -> bool:
        """Return whether the adjectives before it belong to a verb: "is full"."""
        before = (t.kind for t in reversed(self.tokens[max(0, self.at - 4) : self.at]))
        return next((kind for kind in before if kind not in (Kind.ADJ, Kind.ADV)), None) is Kind.AUX

    def later_verb(self) -> bool:
        """Return whether a verb comes later in the same part of the sentence."""
        for token in self.tokens[self.at + 1 :]:
            if token.kind in (Kind.STOP, Kind.COMMA, Kind.CC):
                return False
            if (token.strength >= 2 and token.form == "base") or token.kind is Kind.AUX:
                return True
        return False


FEATURES = {f.name: f"w.sentence.{f.name}" for f in fields(Sentence)} | {
    "noun": "w.lexicon.is_noun(w.word.text)",
    "thing": "w.lexicon.names_thing(w.word.text)",
    "thing-of-two": "w.lexicon.names_thing(f'{w.word.text}_{singular(w.next.text)}')",
    "undone": "w.lexicon.is_undone(w.word.text)",
    "deed": "w.lexicon.is_deed(w.word.stem or w.word.text)",
    "letters": "w.word.text.isalpha()",
    "number": "is_number(w.word.text)",
    "compound": "f'{w.word.text}_{singular(w.next.text)}' in _compounds",
    "particle": "w.particle(w.word, w.right) is not None",
    "sure-particle": "w.particle(w.word, w.right)",
    "own-particle": "(w.left.kind == 'V' and w.particle(w.left, w.word) is not None)",
    "adjacent": "w.last is w.left",
    "graded": "w.graded()",
    "verb-next": "w.verb_next()",
    "predicate": "w.predicate()",
    "later-verb": "w.later_verb()",
}
"""Names for conditions, as Python over a word, ``w``."""


@dataclass(frozen=True, slots=True)
class ClassRow:
    """A row that says what a word or a run of words is.

    Attributes:
        id: Its name.
        kind: The class it gives.
        form: The form of the token from now on, where the row says one.
        when: Its condition.
        unless: Entries of several words of its section are not meant where this holds.
        pattern: The words of a run, with a blank behind each.
        entry: The row as it is written.
    """

    id: str
    kind: Kind
    form: str
    when: Test
    unless: Test
    pattern: re.Pattern[str]
    entry: Entry


class WordClasses:
    """The classes of words that a file declares.

    Attributes:
        rows: All rows in the order of the file.
        tables: The rows by the table they stand in.
        terms: The conditions that have a name.
        parts: Pieces of patterns.
    """

    def __init__(self, text: str, file: str) -> None:
        """Read a file.

        Raises:
            TmdError: It is not well-formed, or names a class, a table, a term or a section that does not exist.
        """
        optional = ("when", "pattern", "phrases", "unless", "form")
        entries, sections = read_file(text, file, ("table", "class", "reason"), optional)
        conditions = Conditions(FEATURES, {"is_number": is_number, "singular": singular})
        self.parts: dict[str, str] = {}
        self.tables: dict[str, list[ClassRow]] = {}
        reading: tuple[tuple[str, Callable[[str], Any], dict[str, Any]], ...] = (
            ("groups", conditions.kinds, conditions.groups),
            ("terms", conditions.expression, conditions.names),
            ("parts", self._pattern, self.parts),
            ("tables", lambda _: [], self.tables),
        )
        for name, read, into in reading:
            for key in sections[name].values if name in sections else ():  # one may name those before it
                into[key] = sections[name].checked(key, read)
        self.terms = {name: conditions.compiled(name) for name in conditions.names if name not in FEATURES}
        self.rows = [self._row(entry, conditions) for entry in entries]

    def _row(self, entry: Entry, conditions: Conditions) -> ClassRow:
        if entry["phrases"]:
            entry.checked("phrases", section_names)
        row = ClassRow(
            entry["id"],
            Kind(entry.checked("class", conditions.kinds)[0]),
            entry["form"],
            entry.checked("when", conditions.compiled),
            entry.checked("unless", conditions.compiled) if entry["unless"] else lambda _: False,
            re.compile(entry.checked("pattern", self._pattern)),
            entry,
        )
        for name in entry["table"].split("|"):
            if name not in self.tables:
                entry.fail("table", f"'{name}' is no table", f"tables: {', '.join(self.tables)}")
            self.tables[name].append(row)
        return row

    def _pattern(self, text: str) -> str:
        """Fill pieces of patterns in, or words of sections of ``words.txt``, the longest first."""

        def filled(match: re.Match[str]) -> str:
            if match[1] in self.parts:
                return self.parts[match[1]]
            words = {word for name in section_names(match[1]) for word in section(name)}
            return f"(?:{'|'.join(map(re.escape, sorted(words, key=lambda word: (-len(word), word))))}) "

        return re.sub(r"\{([a-z_|]+)\}", filled, text)


@cache
def classes() -> WordClasses:
    """Return the classes of ``data/pos.yaml``."""
    return WordClasses(data_text("pos.yaml"), "pos.yaml")


def _first(table: str, word: Surroundings) -> ClassRow | None:
    """Return the first row of a table that holds for a word."""
    for row in classes().tables.get(table, ()):
        if row.when(word):
            return row
    return None


# -- first classes -----------------------------------------------------------------------------------------------------


def tag(tokens: list[Token], lexicon: Lexicon, trace: list[str] | None = None) -> list[Token]:
    """Give every token its first class, by lists; fold phrases and runs of words that are one.

    Args:
        tokens: The words of a text.
        lexicon: The words of the domain.
        trace: Takes the ids of the rows that decide something.
    """
    trace = [] if trace is None else trace
    tagged: list[Token] = []
    position = 0
    while position < len(tokens):
        token, used = tokens[position], 1
        found = _phrase(tokens, position, lexicon) or _run(tokens, position)
        if found is not None:
            row, token, used = found
            trace.append(row.id)
        elif token.kind is Kind.WORD and _is_name(tokens, position):
            token.kind = Kind.N
        elif token.kind is Kind.WORD:
            _tag_word(token, lexicon, not tagged or tagged[-1].kind in (Kind.STOP, Kind.CC), trace)
        if token.kind is Kind.NUM and used == 1 and _range(tokens, position, tagged):
            token, used = fold(tokens[position : position + 3], Kind.NUM), 3
            token.text = tokens[position].text  # "two or three eggs": as few as will do
        tagged.append(token)
        position += used
    trace += [row.id for _, row in _each("things", tagged, lexicon)]
    _compounds(tagged, lexicon)
    for token in tagged:
        token.first = token.kind, token.form
    return tagged


def _is_name(tokens: Sequence[Token], at: int) -> bool:
    """Return whether a word beside an arrow is not a state ("rope -> shed"), or is a letter ("aisle A")."""
    word, beside = tokens[at], tokens[max(at - 1, 0) : at + 2]
    ends = beside[-1].kind is not Kind.WORD or beside[-1].text in section("joints")
    if len(word.text) == 1 and word.capital and ends:
        return True
    return not word.arrow and any(t.arrow for t in beside) and word.text not in section("noted_states")


def _each(table: str, tokens: list[Token], lexicon: Lexicon) -> list[tuple[Token, ClassRow]]:
    """Give tokens another first class where a row of a table holds; what they were as verbs is forgotten."""
    fired = [
        (token, row) for at, token in enumerate(tokens) if (row := _first(table, Surroundings(tokens, at, lexicon)))
    ]
    for token, row in fired:
        token.kind, token.stem, token.strength = row.kind, "", 0
    return fired


def _compounds(tokens: list[Token], lexicon: Lexicon) -> None:
    """Keep all words of names of the domain with a particle inside, and of "head light" for ``headlight``."""
    for first, last in pairwise(tokens):
        if first.kind is last.kind is Kind.WORD and f"{first.text}{singular(last.text)}" in lexicon.kinds:
            for token in (first, last):
                token.kind, token.stem, token.strength = Kind.N, "", 0
        elif f"{first.text}{last.text}" in lexicon.verbs and last.text in section("particles"):
            first.kind, first.stem, first.form, first.strength = Kind.WORD, f"{first.text}{last.text}", "base", 3
            last.kind = Kind.FILLER  # "back up", where the domain has "backup"
    for words in lexicon.compounds:
        for at in (at for at, token in enumerate(tokens) if token.text == words[0]):
            run = tokens[at : at + len(words)]
            if (*(t.text for t in run[:-1]), singular(run[-1].text)) == words:
                for token in run:
                    token.kind, token.stem, token.strength = Kind.N, "", 0


@cache
def _phrases() -> Mapping[str, Sequence[tuple[tuple[str, ...], ClassRow]]]:
    """Return entries of several words by the first one, the longest first, each with the row that has its section."""
    found: dict[str, list[tuple[tuple[str, ...], ClassRow]]] = {}
    for row in classes().rows:
        for entry in sections()[row.entry["phrases"]] if row.entry["phrases"] else ():
            words = tuple(entry.split("_"))
            if len(words) > 1:
                found.setdefault(words[0], []).append((words, row))
    return {first: sorted(entries, key=lambda e: -len(e[0])) for first, entries in found.items()}


def _phrase(tokens: list[Token], at: int, lexicon: Lexicon) -> tuple[ClassRow, Token, int] | None:
    """Return the longest phrase of ``words.txt`` that begins here."""
    for words, row in _phrases().get(tokens[at].text, ()):
        run = tokens[at : at + len(words)]
        if tuple(t.text for t in run) == words:
            token = fold(run, row.kind)
            right, beyond, *_ = [*tokens[at + len(words) :][:2], _EDGE, _EDGE]
            if not row.unless(Surroundings([token], 0, lexicon, ahead=(right, beyond))):
                token.text = pairs("joined").get(token.text, token.text)
                return row, token, len(words)
    return None


def _run(tokens: list[Token], at: int) -> tuple[ClassRow, Token, int] | None:
    """Fold a run that a row has a pattern for: "for about 3 minutes", "to 180 degrees", "at 6 pm"."""
    if not _begins_run(tokens[at].text):
        return None
    words = "".join(f"{token.text.replace(' ', '_')} " for token in tokens[at : at + _LONGEST_RUN])
    for row in classes().tables["runs"]:
        if match := row.pattern.match(words):
            used = match.group().count(" ")
            token = fold(tokens[at : at + used], row.kind, " ", row.form)
            token.note = WHEN if row.kind is Kind.SKIP else ""
            return row, token, used
    return None


@lru_cache(maxsize=1 << 14)
def _begins_run(word: str) -> bool:
    return re.match(classes().parts["begin"], f"{word} ") is not None


@lru_cache(maxsize=1 << 14)
def _first_class(word: str) -> ClassRow:
    """Return the row that gives a word its first class."""
    row = _first("first", Surroundings([Token(Kind.WORD, word, NOWHERE)], 0, builtin()))
    assert row is not None, "the last row holds for any word"
    return row


def is_number(word: str) -> bool:
    """Return whether a word is a number, in figures or in words."""
    return (word[0].isdigit() and not word.endswith(("st", "nd", "rd", "th"))) or word in section("numbers")


def _range(tokens: list[Token], at: int, before: list[Token]) -> bool:
    """Tell "take two or three eggs" and "3-4 plates" from "take cup 1 or 2"."""
    words = [t.text for t in tokens[at + 1 : at + 4]]
    spoken = not before or before[-1].kind is not Kind.WORD or before[-1].strength == 3
    joined = len(words) == 3 and words[0] in section("ranges") and is_number(words[1])
    is_open = joined and _first_class(words[2]).kind in (Kind.WORD, Kind.ADJ)
    return is_open and spoken and tokens[at + 3].kind is Kind.WORD


def _tag_word(token: Token, lexicon: Lexicon, starts: bool, trace: list[str]) -> None:
    word = token.text = _spelled(token, lexicon)
    if word.endswith(sections()["contracted"]):
        token.kind = Kind.SUBJECT
        return
    row = _first_class(word)
    token.kind = row.kind
    trace.append(row.id)
    if token.kind is Kind.WORD and _is_adverb(word, lexicon):
        token.kind = Kind.ADV
    elif token.kind is Kind.WORD and token.capital and not lexicon.knows(singular(word)):
        token.form = NAME
    if token.kind in (Kind.SUB, Kind.ADV) and starts and word in lexicon.verbs:
        # "Till the bed": the domain has such a verb
        token.kind, token.stem, token.form, token.strength = Kind.WORD, word, "base", 2
    elif token.kind in (Kind.WORD, Kind.ADJ):
        if reading := _reading(word, lexicon):
            token.stem, token.form, token.strength = reading[0], token.form or reading[1], reading[2]
    elif token.kind is Kind.LET:
        token.stem, token.form, token.strength = word, "base", 3
    else:
        token.stem = pairs("using_verbs").get(word, "")


def _is_adverb(word: str, lexicon: Lexicon) -> bool:
    return word.endswith("ly") and len(word) > ADVERB and not lexicon.is_noun(word)


def _spelled(token: Token, lexicon: Lexicon) -> str:
    """Return a word without its possessive ending, which the form of the token notes, and without slips."""
    word = token.text
    if word.endswith("'s") and word not in section("be") | section("whole"):
        word, token.form = word[:-2], "possessive"
    if word.endswith("s'"):
        token.form = "possessive"
    word = pairs("slips").get(word, word).rstrip("'")
    if _STRETCHED.search(word) and not lexicon.knows(word):  # "pleeease"
        word = _STRETCHED.sub(r"\1", word)
    if word.endswith(sections()["contracted"]):
        return word
    if "-" in word and word.replace("-", "") in lexicon.verbs:
        return word.replace("-", "")  # "de-ice", where the domain has "deice"
    corrected = lexicon.correct(word) if word.isalpha() and not token.capital else None
    return (corrected or word).replace("-", "_")


def _reading(word: str, lexicon: Lexicon) -> tuple[str, str, int] | None:
    """Return the reading of a word as a verb; a word with a hyphen may end in one."""
    reading = lexicon.verb(word)
    if reading is None and "_" in word:
        if lexicon.particle(*word.split("_", 1)) is not None:
            return word, "base", 3  # "pick-up the plate"
        # "deep-fry", "hard-boil": what stands before the hyphen says how
        last = lexicon.verb(word.rpartition("_")[2])
        return last if last is not None and last[1:] == ("base", 3) else None
    return reading


# -- classes by neighbours ---------------------------------------------------------------------------------------------


def decide(tokens: list[Token], lexicon: Lexicon, trace: list[str] | None = None) -> list[tuple[Token, ClassRow]]:
    """Set the class of every token that its neighbours decide, in place, in one pass.

    Args:
        tokens: The words of a text with their first classes.
        lexicon: The words of the domain.
        trace: Takes the ids of the rows that decide something.

    Returns:
        The tokens that were decided, each with the row that did it.
    """
    sentence, left = Sentence(), _EDGE
    fired = _each("clauses", tokens, lexicon)
    for at, (token, ahead) in enumerate(zip(tokens, _ahead(tokens), strict=True)):
        if token.kind is Kind.TO:
            token.form = ""  # the words of a statement are decided twice
        word = Surroundings(tokens, at, lexicon, left, ahead, sentence)
        row = _decide(word)
        if row is not None:
            token.kind, token.form = row.kind, row.form or token.form
            fired.append((token, row))
        if token.kind is Kind.STOP:
            sentence = Sentence()
        _remember(word, sentence)
        if token.kind not in (Kind.ADV, Kind.FILLER, Kind.SKIP):
            left = token
    if trace is not None:
        trace += [row.id for _, row in fired]
    return fired


def _ahead(tokens: list[Token]) -> list[tuple[Token, Token]]:
    """Return the next two tokens behind each, except adverbs."""
    found: list[tuple[Token, Token]] = []
    right = beyond = _EDGE
    for token in reversed(tokens):
        found.append((right, beyond))
        if token.kind not in (Kind.ADV, Kind.SKIP):
            right, beyond = token, right
    return found[::-1]


def _decide(word: Surroundings) -> ClassRow | None:
    """Return the first row that holds for a word; ``None`` leaves it as it is."""
    token = word.word
    if token.kind is not Kind.WORD:
        return _first(token.kind, word)
    table = (token.form if token.form in classes().tables else "base") if token.stem else "unknown"
    row = _first(table, word)
    if (table == "base" or not token.stem) and row is not None and row.kind is Kind.N:
        return _first("adjective", word) or row
    return row


def _remember(word: Surroundings, sentence: Sentence) -> None:
    """Update the state of the sentence by a decided word."""
    token, kind, terms = word.word, word.word.kind, classes().terms
    if kind in (Kind.SUB, Kind.REL, Kind.PURP):
        if not terms["timed"](word):
            sentence.sub, sentence.nominal = True, kind is Kind.REL
    elif kind is Kind.LET:
        if word.left.kind in (Kind.CC, Kind.COMMA):
            sentence.sub = sentence.nominal = False
        sentence.let = not terms["leaving"](word)
    elif kind is Kind.SUBJECT and token.text in section("subjects"):
        sentence.narrative = terms["narrator"](word)
    elif kind in (Kind.N, Kind.PRON):
        sentence.nominal = True
    elif kind in (Kind.FINITE, Kind.AUX):
        sentence.sub = sentence.nominal = False
    elif kind is Kind.V:
        if not token.stem:  # a verb that no list has is its own stem
            known = word.lexicon.verb(token.text)
            token.stem, token.form = known[0] if known else token.text, "base"
        sentence.sub = sentence.nominal = sentence.let = False
        sentence.verb, sentence.narrative = True, sentence.narrative or token.form == "s"
        if terms["serial"](word):
            word.left.kind = Kind.FILLER
        elif terms["helped"](word):
            word.last.kind = word.last2.kind = Kind.ADV
