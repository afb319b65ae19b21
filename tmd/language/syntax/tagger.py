"""Classes of words: first by lists, then by their neighbours (verb or noun, pronoun or determiner, ...).

Each word gets one class before any grammar runs; leaving the choice to an ambiguous grammar picks the noun reading in
lists and is far slower. What decides is data: of a table of ``data/pos.yaml`` the first row whose condition
(:mod:`~tmd.language.syntax.conditions`) holds says what a word is.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, fields
from functools import cache, lru_cache
from operator import attrgetter

from tmd.language.clause import NOWHERE
from tmd.language.lexicon.lexicon import (
    Lexicon,
    builtin,
    comparative_root,
    data_text,
    pairs,
    phrases,
    positive,
    section,
    sections,
    singular,
    slips,
)
from tmd.language.syntax.conditions import TOKENS, Test
from tmd.language.syntax.rows import Row, Tables
from tmd.language.syntax.tokens import NAME, Kind, Token, fold

_EDGE = Token(Kind.STOP, "", NOWHERE)
"""What stands before the first word and behind the last."""
_LONGEST_RUN = 8
"""A pattern has at most so many words."""
_LONG = 5
"""Longer words that end in *ly* are adverbs."""


@dataclass(slots=True)
class Sentence:
    """What is known of the sentence so far; conditions may name its attributes."""

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


class Word:
    """A word and what stands around it: what a condition looks at.

    Its properties, with ``-`` for ``_``, are the features that conditions may name.

    Attributes:
        left: The token before it that is no adverb, decided.
        right: The token behind it that is no adverb, with its first class.
        beyond: The one behind that.
    """

    __slots__ = ("at", "beyond", "left", "lexicon", "right", "sentence", "tokens", "word")

    def __init__(self, tokens: list[Token], at: int, lexicon: Lexicon, left: Token, sentence: Sentence) -> None:
        """Look at the word at one place of a text."""
        self.word, self.tokens, self.at, self.lexicon = tokens[at], tokens, at, lexicon
        self.left, self.sentence = left, sentence
        self.right = self.beyond = _EDGE

    @property
    def last(self) -> Token:
        """The very token before it."""
        return self.tokens[self.at - 1] if self.at > 0 else _EDGE

    @property
    def last2(self) -> Token:
        """The one before that."""
        return self.tokens[self.at - 2] if self.at > 1 else _EDGE

    @property
    def next(self) -> Token:
        """The very token behind it."""
        return self.tokens[self.at + 1] if self.at + 1 < len(self.tokens) else _EDGE

    @property
    def noun(self) -> bool:
        """The lists or the domain know it as a noun."""
        return self.lexicon.is_noun(self.word.text)

    @property
    def thing(self) -> bool:
        """The domain has things that are called so."""
        return self.lexicon.names_thing(self.word.text)

    @property
    def letters(self) -> bool:
        """It has letters only."""
        return self.word.text.isalpha()

    @property
    def number(self) -> bool:
        """It is a number, in figures or in words."""
        return _is_number(self.word.text)

    @property
    def graded(self) -> bool:
        """It is the comparative or superlative of an adjective that is dropped: "dirtiest"."""
        root = positive(self.word.text)
        roots = (root, f"{root}e") if root != self.word.text else comparative_root(self.word.text)
        return not section("drop_adjectives").isdisjoint(roots)

    @property
    def compound(self) -> bool:
        """It begins a compound of ``words.txt``: "light bulb"."""
        return f"{self.word.text}_{singular(self.next.text)}" in section("compounds")

    @property
    def verb_next(self) -> bool:
        """The next word can be nothing but a verb, or is a likely one and the last of its part."""
        verb = self.lexicon.verb(self.right.text)
        ends = self.beyond.kind in (Kind.STOP, Kind.COMMA)
        return verb is not None and verb[1] == "base" and (verb[2] == 3 or (verb[2] == 2 and ends))

    @property
    def particle(self) -> bool:
        """The word behind it is its particle: "switch on"."""
        return self.lexicon.particle(self.word.stem or self.word.text, self.right.text) is not None

    @property
    def sure_particle(self) -> bool:
        """The word behind it is its particle even before a noun."""
        return self.lexicon.particle(self.word.stem, self.right.text) is True

    @property
    def own_particle(self) -> bool:
        """It is the particle of the verb before it: "put back"."""
        return self.left.kind is Kind.V and self.lexicon.particle(self.left.stem, self.word.text) is not None

    @property
    def predicate(self) -> bool:
        """The adjectives before it belong to a verb: "is full"."""
        before = (t.kind for t in reversed(self.tokens[max(0, self.at - 4) : self.at]))
        return next((kind for kind in before if kind not in (Kind.ADJ, Kind.ADV)), None) is Kind.AUX

    @property
    def adjacent(self) -> bool:
        """No adverb stands before it."""
        return self.last is self.left

    @property
    def later_verb(self) -> bool:
        """A verb comes later in the same part of the sentence."""
        for token in self.tokens[self.at + 1 :]:
            if token.kind in (Kind.STOP, Kind.COMMA, Kind.CC):
                return False
            if (token.strength >= 2 and token.form == "base") or token.kind is Kind.AUX:
                return True
        return False


FEATURES: dict[str, Test] = {f.name: attrgetter(f"sentence.{f.name}") for f in fields(Sentence)} | {
    name.replace("_", "-"): attrgetter(name)
    for name, value in vars(Word).items()
    if isinstance(value, property) and name not in TOKENS
}
"""What conditions may name."""


@cache
def tables() -> Tables:
    """Return the tables of ``data/pos.yaml``."""
    return Tables(data_text("pos.yaml"), "pos.yaml", FEATURES)


def tag(tokens: list[Token], lexicon: Lexicon, trace: list[str] | None = None) -> list[Token]:
    """Give every token its first class, by lists; fold phrases and runs of words that are one.

    Args:
        tokens: The words of a text.
        lexicon: The words of the domain.
        trace: Where the ids of the rows go that decided something.
    """
    fired: list[tuple[Token, Row]] = []
    tagged: list[Token] = []
    position = 0
    while position < len(tokens):
        row, merged, used = _phrase(tokens, position, lexicon) or _run(tokens, position) or (None, tokens[position], 1)
        if row is not None:
            fired.append((merged, row))
        elif merged.kind is Kind.WORD:
            starts = not tagged or tagged[-1].kind in (Kind.STOP, Kind.CC)
            _tag_word(merged, lexicon, starts, fired)
        if merged.kind is Kind.NUM and used == 1 and _range(tokens, position, tagged):
            merged, used = fold(tokens[position : position + 3], Kind.NUM), 3
            merged.text = merged.inner[0].text  # "two or three eggs": as few as will do
        tagged.append(merged)
        position += used
    _each("things", tagged, lexicon, fired)
    _compounds(tagged, lexicon)
    for token in tagged:
        token.first = token.kind, token.form
    if trace is not None:
        trace += [row.id for _, row in fired]
    return tagged


def _each(table: str, tokens: list[Token], lexicon: Lexicon, fired: list[tuple[Token, Row]]) -> None:
    """Give tokens another first class where a row of a table holds; what they were as verbs is forgotten."""
    rows = tables().tables[table]
    for at, token in enumerate(tokens):
        if not rows.open and token.text not in rows.named:
            continue
        row = rows.first(Word(tokens, at, lexicon, _EDGE, _NEW))
        if row is not None:
            token.kind, token.stem, token.strength = row.kind, "", 0
            fired.append((token, row))


def _compounds(tokens: list[Token], lexicon: Lexicon) -> None:
    """Keep all words of names of the domain with a particle inside."""
    texts = [t.text for t in tokens]
    for at in range(len(texts) if lexicon.compounds else 0):
        for length in lexicon.compound_lengths.get(texts[at], ()):
            words = (*texts[at : at + length - 1], singular(texts[min(at + length, len(texts)) - 1]))
            if words in lexicon.compounds:
                for token in tokens[at : at + length]:
                    token.kind, token.stem, token.strength = Kind.N, "", 0


@cache
def _with_phrases() -> tuple[Row, ...]:
    return tuple(row for row in tables().rows if row.phrases)


def _phrase(tokens: list[Token], at: int, lexicon: Lexicon) -> tuple[Row, Token, int] | None:
    """The longest phrase of ``words.txt`` that begins here."""
    best, most = None, 1
    for row in _with_phrases():
        for words in phrases(row.phrases).get(tokens[at].text, ()):
            run = tokens[at : at + len(words)]
            if len(words) > most and tuple(t.text for t in run) == words:
                token = fold(run, row.kind)
                word = Word([token], 0, lexicon, _EDGE, _NEW)
                word.right, word.beyond = [*tokens[at + len(words) :][:2], _EDGE, _EDGE][:2]
                if not row.unless.holds(word):
                    token.text = pairs("joined").get(token.text, token.text)
                    best, most = (row, token, len(words)), len(words)
    return best


def _run(tokens: list[Token], at: int) -> tuple[Row, Token, int] | None:
    """Fold what a row has a pattern of: "for about 3 minutes", "to 180 degrees", "at 6 pm"."""
    if not _begins_run(tokens[at].text):
        return None
    words = "".join(f"{token.text.replace(' ', '_')} " for token in tokens[at : at + _LONGEST_RUN])
    for row in tables().tables["runs"].rows:
        if match := row.pattern.match(words):
            used = match.group().count(" ")
            return row, fold(tokens[at : at + used], row.kind, " ", row.form), used
    return None


def _first(table: str, word: Word) -> Row | None:
    """The first row of a table that holds for a word."""
    rows = tables().tables.get(table)
    return rows.first(word) if rows else None


@lru_cache(maxsize=1 << 14)
def _begins_run(word: str) -> bool:
    return re.match(tables().parts["begin"], f"{word} ") is not None


@lru_cache(maxsize=1 << 14)
def _first_class(word: str) -> Row:
    """The row that gives a word its first class."""
    row = _first("first", Word([Token(Kind.WORD, word, NOWHERE)], 0, builtin(), _EDGE, _NEW))
    assert row is not None, "the last row holds for any word"
    return row


def _is_number(word: str) -> bool:
    return (word[0].isdigit() and not word.endswith(("st", "nd", "rd", "th"))) or word in section("numbers")


def _range(tokens: list[Token], at: int, before: list[Token]) -> bool:
    """Tell "take two or three eggs" and "3-4 plates" from "take cup 1 or 2"."""
    words = [t.text for t in tokens[at + 1 : at + 4]]
    spoken = not before or before[-1].kind is not Kind.WORD or before[-1].strength == 3
    joined = len(words) == 3 and words[0] in section("ranges") and _is_number(words[1])
    is_open = joined and _first_class(words[2]).kind in (Kind.WORD, Kind.ADJ)
    return is_open and spoken and tokens[at + 3].kind is Kind.WORD


def _tag_word(token: Token, lexicon: Lexicon, starts: bool, fired: list[tuple[Token, Row]]) -> None:
    word = token.text
    if word.endswith("'s") and word not in section("be") | section("whole"):
        word, token.form = word[:-2], "possessive"
    word = token.text = slips().get(word, word).rstrip("'")
    if word.endswith(sections()["contracted"]):
        token.kind = Kind.SUBJECT
        return
    corrected = lexicon.correct(word) if word.isalpha() and not token.capital else None
    word = token.text = (corrected or word).replace("-", "_")
    row = _first_class(word)
    token.kind = row.kind
    fired.append((token, row))
    if token.kind is Kind.WORD:
        _tag_open(token, lexicon)
    if token.kind is Kind.SUB and starts and word in lexicon.verbs:
        # "Till the bed": the domain has such a verb
        token.kind, token.stem, token.form, token.strength = Kind.WORD, word, "base", 2
    elif token.kind in (Kind.WORD, Kind.ADJ):
        if reading := _reading(word, lexicon):
            token.stem, token.form, token.strength = reading[0], token.form or reading[1], reading[2]
    elif token.kind is Kind.LET:
        token.stem, token.form, token.strength = word, "base", 3


def _tag_open(token: Token, lexicon: Lexicon) -> None:
    """Tell adverbs and names among words of no list."""
    if token.text.endswith("ly") and len(token.text) > _LONG and not lexicon.is_noun(token.text):
        token.kind = Kind.ADV
    elif token.capital and not lexicon.knows(singular(token.text)):
        token.form = NAME


def _reading(word: str, lexicon: Lexicon) -> tuple[str, str, int] | None:
    """What a word is as a verb; one with a hyphen may end in it."""
    reading = lexicon.verb(word)
    if reading is None and "_" in word:
        if lexicon.particle(*word.split("_", 1)) is not None:
            return word, "base", 3  # "pick-up the plate"
        # "deep-fry", "hard-boil": what stands before the hyphen says how
        last = lexicon.verb(word.rpartition("_")[2])
        return last if last is not None and last[1:] == ("base", 3) else None
    return reading


def decide(tokens: list[Token], lexicon: Lexicon, trace: list[str] | None = None) -> list[tuple[Token, Row]]:
    """Set the class of every token that its neighbours decide, in place, in one pass.

    Args:
        tokens: The words of a text with their first classes.
        lexicon: The words of the domain.
        trace: Where the ids of the rows go that decided something.

    Returns:
        The tokens that were decided, each with the row that did it.
    """
    sentence, left = Sentence(), _EDGE
    fired: list[tuple[Token, Row]] = []
    _each("clauses", tokens, lexicon, fired)
    ahead = _ahead(tokens)
    for at, token in enumerate(tokens):
        if token.kind is Kind.TO:
            token.form = ""  # the words of a statement are decided twice
        word = Word(tokens, at, lexicon, left, sentence)
        word.right, word.beyond = ahead[at]
        row = _decide(word)
        if row is not None:
            token.kind, token.form = row.kind, row.form or token.form
            fired.append((token, row))
        if token.kind is Kind.STOP:
            sentence = Sentence()
        _remember(word, sentence)
        if token.kind not in (Kind.ADV, Kind.FILLER):
            left = token
    if trace is not None:
        trace += [row.id for _, row in fired]
    return fired


def _ahead(tokens: list[Token]) -> list[tuple[Token, Token]]:
    """The next two tokens behind each that are no adverbs."""
    found: list[tuple[Token, Token]] = []
    right = beyond = _EDGE
    for token in reversed(tokens):
        found.append((right, beyond))
        if token.kind is not Kind.ADV:
            right, beyond = token, right
    found.reverse()
    return found


def _decide(word: Word) -> Row | None:
    """The first row that holds for a word; ``None`` leaves it as it is."""
    token, rows = word.word, tables()
    if token.kind is not Kind.WORD:
        return _first(token.kind, word)
    table = (token.form if token.form in rows.tables else "base") if token.stem else "unknown"
    row = _first(table, word)
    if table == "base" and row is not None and row.kind is Kind.N:
        return _first("adjective", word) or row
    return row


def _remember(word: Word, sentence: Sentence) -> None:
    """Note what a decided word says of the sentence."""
    token, kind, terms = word.word, word.word.kind, tables().terms
    if kind in (Kind.SUB, Kind.REL, Kind.PURP):
        if not terms["timed"].holds(word):
            sentence.sub, sentence.nominal = True, kind is Kind.REL
    elif kind is Kind.LET:
        if word.left.kind in (Kind.CC, Kind.COMMA):
            sentence.sub = sentence.nominal = False
        sentence.let = not terms["leaving"].holds(word)
    elif kind is Kind.SUBJECT and token.text in section("subjects"):
        sentence.narrative = terms["narrator"].holds(word)
    elif kind in (Kind.N, Kind.PRON):
        sentence.nominal = True
    elif kind in (Kind.FINITE, Kind.AUX):
        sentence.sub = sentence.nominal = False
    elif kind is Kind.V:
        if not token.stem:  # a verb that no list has is its own stem
            known = word.lexicon.verb(token.text)
            token.stem, token.form = known[0] if known else token.text, "base"
        sentence.sub = sentence.nominal = sentence.let = False
        sentence.verb = True
        sentence.narrative = sentence.narrative or token.form == "s"
        if terms["serial"].holds(word):
            word.left.kind = Kind.FILLER
        elif terms["helped"].holds(word):
            word.last.kind = word.last2.kind = Kind.ADV
