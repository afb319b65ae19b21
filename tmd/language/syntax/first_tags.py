"""First tags: classes of words by lists, phrases of several words, durations and measures, typos, verb readings.

What is decided is in tables: of :data:`CLASSES` and :data:`RUNS` the first row that holds counts. Each row has its
reason and an example, to which ``tests/language/test_part_of_speech.py`` holds it.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from itertools import pairwise
from typing import NamedTuple

from tmd.language.clause import Span
from tmd.language.lexicon.lexicon import Lexicon
from tmd.language.lexicon.words import comparative_root, phrases, positive, section, singular, slips
from tmd.language.syntax.tokens import NAME, Kind, Token

_PHRASES = (
    ("multiword_prepositions", Kind.P),
    ("multiword_adverbs", Kind.ADV),
    ("purposes", Kind.PURP),
    ("conditions", Kind.SUB),
    ("ensure", Kind.ENSURE),
)
_SPELLING = {"in_to": "into", "on_to": "onto"}
_TITLES = frozenset({"mr", "mrs", "ms", "miss", "dr", "doctor", "nurse", "professor", "sister", "captain"})
_CONTRACTED = ("'ll", "'d", "'ve")


class ClassRule(NamedTuple):
    """One row of :data:`CLASSES`: the class of a word, why, when, and an example of such a word."""

    tag: Kind
    reason: str
    when: Callable[[str], bool]
    example: str


class RunRule(NamedTuple):
    """One row of :data:`RUNS`: the form of the fold, why, its words as a pattern, and an example.

    In a pattern a blank stands behind each word.
    """

    form: str
    reason: str
    pattern: str
    example: str


def _in(*names: str) -> Callable[[str], bool]:
    """Tell whether one of these sections of ``words.txt`` has a word."""
    words = frozenset().union(*(section(name) for name in names))
    return lambda word: word in words


def _is_number(word: str) -> bool:
    return (word[0].isdigit() and not word.endswith(("st", "nd", "rd", "th"))) or word in section("numbers")


def _is_superlative(word: str) -> bool:
    root = positive(word)
    return root != word and not section("drop_adjectives").isdisjoint((root, root + "e"))


def _is_comparative(word: str) -> bool:
    return not section("drop_adjectives").isdisjoint(comparative_root(word)) and word not in section("nouns")


# fmt: off
CLASSES = (
    ClassRule(Kind.CC, "joins words or clauses", lambda w: w in ("and", "or", "plus", "but", "then"), "and"),
    ClassRule(Kind.TO, "before a verb or a place", lambda w: w == "to", "to"),
    ClassRule(Kind.NUM, "a number, in figures or in words", _is_number, "two"),
    ClassRule(Kind.DET, "how many", _in("quantifiers"), "some"),
    ClassRule(Kind.AUX, "an auxiliary", _in("be", "modals"), "should"),
    ClassRule(Kind.NEG, "a negation", _in("negations"), "don't"),
    ClassRule(Kind.DET, "which", _in("determiners"), "the"),
    ClassRule(Kind.PRON, "stands for a thing or a person", _in("pronouns"), "it"),
    ClassRule(Kind.SUB, "opens a condition", _in("conditions"), "if"),
    ClassRule(Kind.ENSURE, "asks for a state", _in("ensure"), "ensure"),
    ClassRule(Kind.LET, "lets something be done", _in("let_verbs"), "let"),
    ClassRule(Kind.REL, "opens a relative clause", _in("relatives"), "which"),
    ClassRule(Kind.ADJ, "an adjective that is dropped, and no verb", lambda w: w in section("drop_adjectives")
              and w not in section("verbs") | section("noun_verbs"), "big"),
    ClassRule(Kind.ADJ, "its superlative", _is_superlative, "dirtiest"),
    ClassRule(Kind.ADJ, "its comparative", _is_comparative, "louder"),
    ClassRule(Kind.P, "a preposition", _in("prepositions"), "under"),
    ClassRule(Kind.ADV, "an adverb, and no verb", lambda w: w in section("adverbs") - section("verbs"), "slowly"),
    ClassRule(Kind.WORD, "its neighbours decide (part_of_speech.py)", lambda _: True, "cup"),
)
# fmt: on
"""The first tag of a word."""


def _words(*names: str) -> str:
    """The pattern of a word of these sections of ``words.txt``."""
    words = sorted(frozenset().union(*(section(name) for name in names)), key=lambda word: (-len(word), word))
    return f"(?:{'|'.join(map(re.escape, words))}) "


# atomic groups, not possessive quantifiers: these Python 3.11.2 matches wrongly around alternatives
_LEAD = f"(?>(?:{_words('before_measure')})*)"
_NUMBER = rf"(?:\d[^ ]*(?<!st)(?<!nd)(?<!rd)(?<!th) |{_words('numbers')})"
_NUMBERS = f"(?>(?:{_NUMBER})+)(?>(?:(?<=half )an? )?)"
_FRACTION = r"(?:\d[^ ]*/[^ ]*|half|quarters?|thirds?) "
_FEW = "(?![^ ]+ of )(?>(?:(?:more|full) (?!$))?)"
"""Not "two minutes of it"; but "two more minutes"."""
_SCALES = "(?>(?:(?:celsius|celcius|fahrenheit|c|f|full|the|way) )*)"
_CLOCK = "(?:am|pm|o'clock) "
_NO_THING = f"(?!{_words('nouns')}|of )"
"""Not "in the evening dress"."""
RUNS = (
    RunRule("setting", "how full", rf"{_LEAD}(?:{_NUMBER})*{_FRACTION}full ", "three quarters full"),
    RunRule("setting", "how far", rf"{_LEAD}{_NUMBERS}of the way ", "to two thirds of the way"),
    RunRule("duration", "how long", rf"{_LEAD}{_NUMBERS}{_FEW}{_words('units_time')}", "for about 3 minutes"),
    RunRule(
        "duration",
        'how long; not "a bit"',
        rf"(?!an? (?:(?:more|full) )?bit ){_LEAD}an? {_FEW}{_words('units_time')}",
        "for an hour",
    ),
    RunRule(
        "setting",
        "how much",
        rf"{_LEAD}{_NUMBERS}{_FEW}(?:{_words('units')}|quarters |thirds ){_SCALES}",
        "to 180 degrees",
    ),
    RunRule(
        "setting",
        "at what time",
        rf"(?:(?:at|by) \d[^ ]* |{_words('before_time')}\d[^ ]* (?={_CLOCK}))(?>(?:{_CLOCK})?){_NO_THING}",
        "before 6 pm",
    ),
    RunRule(
        "setting",
        "when",
        rf"{_words('before_time')}(?>(?:{_words('determiners', 'drop_adjectives')})*){_words('time_nouns')}{_NO_THING}",
        "in the morning",
    ),
)
"""Runs of words that say how long, how much or when."""
_PATTERNS = tuple((rule.form, re.compile(rule.pattern)) for rule in RUNS)
_LONGEST_RUN = 8


def fold(tokens: list[Token], kind: Kind, joint: str = "_", form: str = "") -> Token:
    """Make one token of a run."""
    span = Span(min(t.span.start for t in tokens), max(t.span.end for t in tokens))
    return Token(kind, joint.join(t.text for t in tokens), span, form=form, inner=tokens)


def tag(tokens: list[Token], lexicon: Lexicon) -> list[Token]:
    """Give every token its first tag."""
    tagged: list[Token] = []
    position = 0
    while position < len(tokens):
        merged, used = _phrase(tokens, position)
        if merged is None:
            merged, used = _run(tokens, position)
        if merged is None:
            merged, used = tokens[position], 1
            if merged.kind is Kind.WORD:
                _tag_word(merged, lexicon)
            starts = not tagged or tagged[-1].kind in (Kind.STOP, Kind.CC)
            if merged.kind is Kind.SUB and merged.text in lexicon.verbs and starts:
                # "Till the bed": the domain has such a verb
                merged.kind, merged.stem, merged.form, merged.strength = Kind.WORD, merged.text, "base", 2
        tagged.append(merged)
        position += used
    _compounds(tagged)
    _misspelt_from(tagged)
    return tagged


def _compounds(tokens: list[Token]) -> None:
    """Keep the first word of "light bulb", which is dropped elsewhere, and of names ("Canada Dry")."""
    for before, first, second in zip(tokens, tokens[1:], tokens[2:], strict=False):
        if before.kind is Kind.DET and first.text in ("third", "quarter") and second.kind is Kind.WORD:
            first.kind, first.stem, first.strength = Kind.N, "", 0  # "the third burner" is no fraction
    for first, second in pairwise(tokens):
        if first.text in _TITLES and second.capital:
            for word in (first, second):
                word.kind, word.stem, word.strength = Kind.N, "", 0
        elif f"{first.text}_{singular(second.text)}" in section("compounds"):
            first.kind, first.stem, first.strength = Kind.N, "", 0
        elif second.kind is Kind.ADJ and first.capital and second.capital:
            second.kind = Kind.N


def _misspelt_from(tokens: list[Token]) -> None:
    """Read "get the bowl form the shelf" as "from"."""
    for before, token, after in zip(tokens, tokens[1:], tokens[2:], strict=False):
        if token.text == "form" and before.kind in (Kind.WORD, Kind.PRON, Kind.N) and after.kind is Kind.DET:
            token.kind, token.text, token.stem, token.strength = Kind.P, "from", "", 0


def _phrase(tokens: list[Token], at: int) -> tuple[Token | None, int]:
    best: tuple[Token | None, int] = (None, 0)
    for name, kind in _PHRASES:
        for words in phrases(name).get(tokens[at].text, ()):
            run = tokens[at : at + len(words)]
            measured = kind is Kind.ADV and tokens[at + len(words) :][:1] and tokens[at + len(words)].text == "of"
            if measured:
                continue
            if len(words) > max(1, best[1]) and tuple(t.text for t in run) == words:
                token = fold(run, kind)
                token.text = _SPELLING.get(token.text, token.text)
                best = token, len(words)
    return best


def _run(tokens: list[Token], at: int) -> tuple[Token | None, int]:
    """Fold what :data:`RUNS` has: "for about 3 minutes", "to 180 degrees", "at 6 pm"."""
    words = "".join(f"{token.text.replace(' ', '_')} " for token in tokens[at : at + _LONGEST_RUN])
    for form, pattern in _PATTERNS:
        if match := pattern.match(words):
            used = match.group().count(" ")
            return fold(tokens[at : at + used], Kind.MOD, " ", form), used
    return None, 0


def _tag_word(token: Token, lexicon: Lexicon) -> None:
    word = token.text
    if word.endswith("'s") and word not in section("be") and word != "let's":
        word = token.text = word[:-2]
        token.form = "possessive"
    word = token.text = slips().get(word, word).rstrip("'")
    if word.endswith(_CONTRACTED):
        token.kind = Kind.SUBJECT
        return
    corrected = lexicon.correct(word) if word.isalpha() and not token.capital else None
    word = token.text = (corrected or word).replace("-", "_")
    token.kind = next(rule.tag for rule in CLASSES if rule.when(word))
    if token.kind is Kind.WORD and word.endswith("ly") and len(word) > 5 and not lexicon.is_noun(word):
        token.kind = Kind.ADV
    if token.capital and token.kind is Kind.WORD and not lexicon.knows(singular(word)):
        token.form = NAME
    if token.kind in (Kind.WORD, Kind.ADJ):
        reading = lexicon.verb(word)
        if reading is None and "_" in word:
            # "deep-fry", "hard-boil": what stands before the hyphen says how
            last = lexicon.verb(word.rpartition("_")[2])
            reading = last if last is not None and last[1:] == ("base", 3) else None
        if reading:
            token.stem, token.form, token.strength = reading[0], token.form or reading[1], reading[2]
    elif token.kind is Kind.LET:
        token.stem, token.form, token.strength = word, "base", 3
