"""Text to tokens with character offsets, repeated runs removed, and the first classes of words, by lists.

Segment marks (``|``), line breaks and control characters are blanks. Numbers glued to units are cut
("10minutes"); hyphens inside words are part of the word.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

from tmd.language.clause import Span
from tmd.language.lexicon.lexicon import Lexicon, comparative_root, phrases, positive, section, singular, slips


class Kind(StrEnum):
    """What a token is. The first group is what the grammar sees."""

    V = "V"
    N = "N"
    PRON = "PRON"
    DET = "DET"
    NUM = "NUM"
    P = "P"
    OF = "OF"
    CONJ = "CONJ"
    VCC = "VCC"
    SEP = "SEP"
    MOD = "MOD"
    """A folded span that belongs to a clause: condition, purpose, duration, setting."""

    WORD = "WORD"
    """Not decided yet."""
    ADJ = "ADJ"
    ADV = "ADV"
    AUX = "AUX"
    CC = "CC"
    COMMA = "COMMA"
    STOP = "STOP"
    TO = "TO"
    ING = "ING"
    PARTICIPLE = "PARTICIPLE"
    FINITE = "FINITE"
    """A verb with a subject of its own, inside a folded span or a statement."""
    SUBJECT = "SUBJECT"
    NEG = "NEG"
    SUB = "SUB"
    """Opens a condition."""
    PURP = "PURP"
    REL = "REL"
    ENSURE = "ENSURE"
    LET = "LET"
    SKIP = "SKIP"
    FILLER = "FILLER"

    STATE = "STATE"
    """A state that something is in or shall be in: "leave it open"."""
    EXC = "EXC"
    """Opens an exception."""
    WITHOUT = "WITHOUT"
    """Opens what shall be avoided on the way: "without spilling it"."""
    SAY = "SAY"
    """Opens a statement."""
    END = "END"
    """Closes a subordinate clause."""
    LINK = "LINK"
    """Joins the parts of a subordinate clause."""


IMPLIED = "implied"
"""The form of a verb that was not said: "A glass of milk, please."."""
NAME = "name"
"""The form of a word of no list that is written with a capital."""


@dataclass(slots=True)
class Token:
    """A word or a folded run of words.

    Attributes:
        kind: Its class so far.
        text: Lower case; the words of a fold joined by blanks or underscores.
        span: Where it stands.
        stem: The verb's stem.
        form: ``base``, ``s``, ``ed`` or ``ing`` for verbs; the role of a fold (``condition`` ...).
        strength: How sure a word is a verb, 0 to 3.
        parts: Further places that belong to it (the particle of a split verb).
        note: Why it is skipped.
        capital: Written with a capital where other words are not: a name.
        inner: The tokens a fold was made of.
        lead: The determiners, numerals and adjectives before a noun; for a verb, the word for the state it asks for.
        sentence: The number of the sentence that a verb stands in.
        otherwise: For a verb: "otherwise" stands before it.
        heading: For a verb: what follows a colon says how it is done.
        negated: For the opener of a subordinate clause: a negation stands in it.
        first: Its class and form by lists, before its neighbours decided.
    """

    kind: Kind
    text: str
    span: Span
    stem: str = ""
    form: str = ""
    strength: int = 0
    parts: list[Span] = field(default_factory=list)
    note: str = ""
    capital: bool = False
    inner: list[Token] = field(default_factory=list)
    lead: list[str] = field(default_factory=list)
    sentence: int = 0
    otherwise: bool = False
    heading: bool = False
    negated: bool = False
    first: tuple[Kind, str] | None = None


_TOKEN = re.compile(
    r"(?P<markup></?[a-z][^<>]*>|&(?:[a-z]+|#\d+);|[\U0001F000-\U0001FAFF\u2600-\u27BF\uFE0F\u200D]+)|(?P<ordinal>\d+(?:st|nd|rd|th)\b)|(?P<num>\d+(?:[.,/:]\d+)*)"
    r"|(?P<word>[^\W\d_]+(?:['\u2019\-_\u00ad\u200b-\u200d\u2060\ufeff]+[^\W\d_]+)*['\u2019]?)|(?P<stop>[.!?;:…]+)|(?P<comma>[,\u2013\u2014()\[\]/]|-)"
    r"|(?P<cc>[&+])|(?P<unit>[%°])",
    re.UNICODE | re.IGNORECASE,
)

_COPULA = re.compile(r"(that|which|who|what|it|there|he|she)('s)|(they|you|we)('re)|(i)('m)")
"""Pronouns with a form of *be*, which is a word of its own."""
_CUT = {"'s": "is", "'re": "are", "'m": "am"}

_WHEN = frozenset({"when", "once", "if", "until", "untill", "till", "unless"})
_DONE = frozenset({"done", "ready", "hot", "warm", "boiling", "boiled", "cooked", "cold", "finished", "full", "empty"})

_UNMARKED = {
    "thats": "that's", "theres": "there's", "theyre": "they're", "youre": "you're", "im": "i'm", "ive": "i've",
    "isnt": "isn't", "arent": "aren't", "wasnt": "wasn't", "doesnt": "doesn't", "cant": "can't", "wont": "won't",
}  # fmt: skip
"""Contractions as people write them in a hurry."""

MARKUP = "a sign, not a word"
"""Why HTML, entities and pictures are skipped."""
_CLITICS = frozenset({"s", "n't"})
"""What stands by itself where contractions were cut in two."""

_RUN = 3
"""Repeated runs of at least this many words are slips."""
_LONGEST_RUN = 120

_UNSEEN = {0x2019: "'"} | dict.fromkeys((0xAD, 0x200B, 0x200C, 0x200D, 0x2060, 0xFEFF))
"""Signs that only a printer sees, such as a soft hyphen, are no part of a word."""
_LONG_WORD = 60
_TITLE_SHARE = 0.4
"""A text with more capitals than this says nothing by them."""


def tokenise(text: str) -> list[Token]:
    """Cut a text into tokens. Everything between them is blank or a sign without meaning here."""
    tokens: list[Token] = []
    for match in _TOKEN.finditer(text):
        span, word = Span(*match.span()), match.group().lower().translate(_UNSEEN)
        kind = {"num": Kind.NUM, "stop": Kind.STOP, "comma": Kind.COMMA, "cc": Kind.CC}.get(
            match.lastgroup or "", Kind.WORD
        )
        if match.lastgroup == "markup" and word != "&amp;":
            tokens.append(Token(Kind.SKIP, word, span, note=MARKUP))
            continue
        if word == "&amp;":
            kind, word = Kind.CC, "&"
        if len(word) > _LONG_WORD:
            word = word[:_LONG_WORD]
        if kind is Kind.NUM:
            word = word.replace(",", ".")  # a name of a thing has no comma
        word = _UNMARKED.get(word, word)
        if word in _CLITICS and tokens and tokens[-1].kind is Kind.WORD and text[span.start - 1] in "'\u2019 ":
            before = tokens[-1]  # "let 's", "do n't": cut by a program
            apart = before.text + ("'" if word == "s" else "") + word
            if word != "s" or text[span.start - 1] != " ":
                tokens[-1] = replace(before, text=apart, span=Span(before.span.start, span.end))
                continue
        if word in _DONE and len(tokens) > 1 and tokens[-1].text == "its" and tokens[-2].text in _WHEN:
            its = tokens.pop().span  # as people write it: "when its done"
            tokens += [
                Token(kind, "it", Span(its.start, its.start + 2)),
                Token(kind, "is", Span(its.start + 2, its.end)),
            ]
        copula = _COPULA.fullmatch(word)
        if copula:
            front, ending = (part for part in copula.groups() if part)
            cut = min(span.start + len(front), span.end)
            tokens += [Token(kind, front, Span(span.start, cut)), Token(kind, _CUT[ending], Span(cut, span.end))]
            continue
        tokens.append(Token(kind, word, span))
    _enumeration(tokens, text)
    _capitals(tokens, text)
    for token, after in pairwise(tokens):
        abbreviated = text[after.span.start : after.span.end].isupper()
        if token.text == "an" and after.kind is Kind.WORD and after.text[0] not in "aeioux" and not (abbreviated or after.text in section("silent_h")):
            token.text = "and"  # "warm it up an pour it out": no article stands before such a sound
    return tokens


def _enumeration(tokens: list[Token], text: str) -> None:
    """Read the marks of a numbered list, "1) take ... 2) put ...", as stops."""
    sign, number = "", 1
    for token, after in pairwise(tokens):
        if token.kind is not Kind.NUM or token.text != str(number) or after.text not in (".", ")", ":"):
            continue
        ahead = text[: token.span.start].strip(" (|\n\t")
        opens = number > 1 or not ahead or ahead.endswith(":")
        if opens and sign in ("", after.text):
            token.kind = after.kind = Kind.STOP
            sign, number = after.text, number + 1


def _capitals(tokens: list[Token], text: str) -> None:
    """Mark names: capitals inside a sentence."""
    words = [t for t in tokens if t.kind is Kind.WORD]
    capitals = [t for t in words if text[t.span.start].isupper()]
    if len(capitals) > _TITLE_SHARE * len(words):
        return
    starts = {id(after) for before, after in pairwise(tokens) if before.kind is Kind.STOP}
    for token in capitals:
        token.capital = token is not tokens[0] and id(token) not in starts


def drop_repeats(tokens: list[Token]) -> tuple[list[Token], list[Token]]:
    """Remove the second copy of immediately repeated runs within a sentence, and doubled words.

    Returns:
        The tokens that stay and the tokens removed. Linear in the number of tokens.
    """
    kept: list[Token] = []
    dropped: list[Token] = []
    last_seen: dict[tuple[str, ...], int] = {}
    position = 0
    words = [t.text for t in tokens]
    while position < len(tokens):
        token = tokens[position]
        if token.kind is Kind.STOP:
            last_seen.clear()
        key = tuple(words[position : position + _RUN])
        before = last_seen.get(key)
        if before is not None and len(key) == _RUN and position - before <= _LONGEST_RUN:
            length = position - before
            if length >= _RUN and words[before:position] == words[position : position + length]:
                dropped.extend(tokens[position : position + length])
                last_seen[key] = position
                position += length
                continue
        last_seen[key] = position
        pair = words[position : position + 2]
        plain = all(t.kind is Kind.WORD for t in tokens[position : position + 2])
        if plain and pair == words[position + 2 : position + 4] and len(set(pair)) == 2:
            dropped.extend(tokens[position : position + 2])
            position += 2
            continue
        if kept and token.kind is Kind.WORD and kept[-1].text == token.text and kept[-1].kind is Kind.WORD:
            dropped.append(token)
        else:
            kept.append(token)
        position += 1
    return kept, dropped


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
    ClassRule(Kind.ADV, "an interjection", _in("interjections"), "okay"),
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
_NUMBERS = f"(?>(?:{_NUMBER})+)(?>(?:(?:to|or|-|\u2013) (?:{_NUMBER})+)?)(?>(?:(?<=half )an? )?)"
"""Also "3 to 5"."""
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
_MEASURING = section("before_measure") | section("before_time") | section("numbers") | {"a", "an", "at", "by", "half"}
"""What :data:`RUNS` begin with, beside figures."""
_LONGEST_PHRASE = 8


def fold(tokens: list[Token], kind: Kind, joint: str = "_", form: str = "") -> Token:
    """Make one token of a run."""
    span = Span(min(t.span.start for t in tokens), max(t.span.end for t in tokens))
    return Token(kind, joint.join(t.text for t in tokens), span, form=form, inner=tokens)


def tag(tokens: list[Token], lexicon: Lexicon) -> list[Token]:
    """Give every token its first tag."""
    tagged: list[Token] = []
    position = 0
    while position < len(tokens):
        merged, used = _phrase(tokens, position, lexicon)
        if merged is None:
            merged, used = _run(tokens, position)
        if merged is None:
            merged, used = tokens[position], 1
            if merged.kind is Kind.WORD:
                _tag_word(merged, lexicon)
            if merged.kind is Kind.NUM and _range(tokens, position, tagged):
                merged, used = fold(tokens[position : position + 3], Kind.NUM), 3
                merged.text = merged.inner[0].text  # "two or three eggs": as few as will do
            starts = not tagged or tagged[-1].kind in (Kind.STOP, Kind.CC)
            if merged.kind is Kind.SUB and merged.text in lexicon.verbs and starts:
                # "Till the bed": the domain has such a verb
                merged.kind, merged.stem, merged.form, merged.strength = Kind.WORD, merged.text, "base", 2
        tagged.append(merged)
        position += used
    _compounds(tagged, lexicon)
    _misspelt_from(tagged)
    for token in tagged:
        token.first = token.kind, token.form
    return tagged


def _compounds(tokens: list[Token], lexicon: Lexicon) -> None:
    """Keep the first word of "light bulb", which is dropped elsewhere, and all of names ("Canada Dry")."""
    for before, token, after in zip(tokens, tokens[1:], [*tokens[2:], None], strict=False):
        ends = after is None or after.kind not in (Kind.WORD, Kind.N, Kind.ADJ)
        if before.kind is Kind.DET and ends and token.kind is not Kind.WORD and lexicon.names_thing(token.text):
            token.kind, token.stem, token.strength = Kind.N, "", 0  # "lock the safe", "open the till"
    texts = [t.text for t in tokens]
    for at in range(len(texts) if lexicon.compounds else 0):
        for length in lexicon.compound_lengths.get(texts[at], ()):
            words = (*texts[at : at + length - 1], singular(texts[min(at + length, len(texts)) - 1]))
            if words in lexicon.compounds:
                for token in tokens[at : at + length]:
                    token.kind, token.stem, token.strength = Kind.N, "", 0
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


def _phrase(tokens: list[Token], at: int, lexicon: Lexicon) -> tuple[Token | None, int]:
    best: tuple[Token | None, int] = (None, 0)
    for name, kind in _PHRASES:
        for words in phrases(name).get(tokens[at].text, ()):
            run = tokens[at : at + len(words)]
            if words[:2] == ("take", "care") and [t.text for t in tokens[at + 2 : at + 3]] == ["of"]:
                continue
            if words == ("on", "to") and _infinitive_follows(tokens, at + 2, lexicon):
                continue
            measured = kind is Kind.ADV and tokens[at + len(words) :][:1] and tokens[at + len(words)].text == "of"
            if measured:
                continue
            if len(words) > max(1, best[1]) and tuple(t.text for t in run) == words:
                token = fold(run, kind)
                token.text = _SPELLING.get(token.text, token.text)
                best = token, len(words)
    return best


@lru_cache(maxsize=1 << 14)
def _first_class(word: str) -> Kind:
    """The class that the first row of :data:`CLASSES` that holds gives a word."""
    return next(rule.tag for rule in CLASSES if rule.when(word))


def _is_open(word: str) -> bool:
    """Tell whether no list of closed classes has a word."""
    return _first_class(word) in (Kind.WORD, Kind.ADJ)


def _range(tokens: list[Token], at: int, before: list[Token]) -> bool:
    """Tell "take two or three eggs" and "3-4 plates" from "take cup 1 or 2"."""
    words = [t.text for t in tokens[at + 1 : at + 4]]
    spoken = not before or before[-1].kind is not Kind.WORD or before[-1].strength == 3
    joined = len(words) == 3 and words[0] in ("or", "to", "-", "\u2013") and _is_number(words[1])
    return joined and spoken and tokens[at + 3].kind is Kind.WORD and _is_open(words[2])


def _infinitive_follows(tokens: list[Token], at: int, lexicon: Lexicon) -> bool:
    """Tell "put the kettle on to boil" from "put the book on to the shelf"."""
    verb = lexicon.verb(tokens[at].text) if at < len(tokens) else None
    ends = at + 1 >= len(tokens) or tokens[at + 1].kind in (Kind.STOP, Kind.COMMA)
    return verb is not None and verb[1] == "base" and (verb[2] == 3 or (verb[2] == 2 and ends))


def _run(tokens: list[Token], at: int) -> tuple[Token | None, int]:
    """Fold what :data:`RUNS` has: "for about 3 minutes", "to 180 degrees", "at 6 pm"."""
    first = tokens[at].text
    if not (first[0].isdigit() or first in _MEASURING):
        return None, 0
    words = "".join(f"{token.text.replace(' ', '_')} " for token in tokens[at : at + _LONGEST_PHRASE])
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
    token.kind = _first_class(word)
    if token.kind is Kind.WORD and word.endswith("ly") and len(word) > 5 and not lexicon.is_noun(word):
        token.kind = Kind.ADV
    if token.capital and token.kind is Kind.WORD and not lexicon.knows(singular(word)):
        token.form = NAME
    if token.kind in (Kind.WORD, Kind.ADJ):
        reading = lexicon.verb(word)
        if reading is None and "_" in word and lexicon.particle(*word.split("_", 1)) is not None:
            reading = word, "base", 3  # "pick-up the plate"
        if reading is None and "_" in word:
            # "deep-fry", "hard-boil": what stands before the hyphen says how
            last = lexicon.verb(word.rpartition("_")[2])
            reading = last if last is not None and last[1:] == ("base", 3) else None
        if reading:
            token.stem, token.form, token.strength = reading[0], token.form or reading[1], reading[2]
    elif token.kind is Kind.LET:
        token.stem, token.form, token.strength = word, "base", 3
