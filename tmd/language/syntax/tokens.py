"""Text to tokens with character offsets, repeated runs removed, and patterns over the classes of words.

Segment marks (``|``), line breaks and control characters are blanks. Numbers glued to units are cut
("10minutes"); hyphens inside words are part of the word.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import cache
from itertools import pairwise, takewhile

from tmd.language.clause import Span, hull
from tmd.language.lexicon.lexicon import first_of, pairs, section, sections, sections_of


class Kind(StrEnum):
    """The class of a token. The grammar sees the first group only."""

    __hash__ = str.__hash__  # that of an enumeration is far slower

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
    """A verb with its own subject, inside a folded span or a statement."""
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
    """A state that something is in or should be in: "leave it open"."""
    EXC = "EXC"
    """Opens an exception."""
    WITHOUT = "WITHOUT"
    """Opens what must be avoided on the way: "without spilling it"."""
    SAY = "SAY"
    """Opens a statement."""
    END = "END"
    """Closes a subordinate clause."""
    LINK = "LINK"
    """Joins the parts of a subordinate clause."""


EXISTS = "exists"
"""The form of *be* in "there is"."""
IMPLIED = "implied"
"""The form of a verb that the text leaves out: "A glass of milk, please."."""
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
        participle: For a verb *be*: the stem of the participle behind it.
        sentence: The number of the sentence that a verb stands in.
        otherwise: For a verb: "otherwise" stands before it.
        early: For a verb: "first" behind it says that it comes before what was said in front.
        heading: For a verb: what follows a colon says how it is done.
        told: For a verb: its subject is not the addressee.
        negated: For the opener of a subordinate clause: a negation stands in it.
        first: Its class and form by lists, before its neighbours decided.
        arrow: Written as an arrow.
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
    participle: str = ""
    sentence: int = 0
    otherwise: bool = False
    early: bool = False
    heading: bool = False
    told: bool = False
    negated: bool = False
    first: tuple[Kind, str] | None = None
    arrow: bool = False


_TOKEN = re.compile(
    r"(?P<abbr>[-=]+>|(?<= )=(?= )|\u2192|\u21d2|\bw/(?:o\b)?)"
    r"|(?P<markup></?[a-z][^<>]*>|&(?:[a-z]+|#\d+);|[\U0001F000-\U0001FAFF\u2600-\u27BF\uFE0F\u200D]+)"
    r"|(?P<ordinal>\d+(?:st|nd|rd|th)\b)|(?P<num>\d+(?:[.,/:]\d+)*)"
    r"|(?P<word>[^\W\d_]+(?:['\u2019\-_\u00ad\u200b-\u200d\u2060\ufeff]+[^\W\d_]+)*['\u2019]?)"
    r"|(?P<stop>[.!?;:…]+)|(?P<comma>[,\u2013\u2014()\[\]/]|-)|(?P<cc>[&+])|(?P<unit>[%°])",
    re.UNICODE | re.IGNORECASE,
)

_KINDS = {
    "markup": Kind.SKIP, "num": Kind.NUM, "stop": Kind.STOP, "comma": Kind.COMMA, "cc": Kind.CC,
}  # fmt: skip
"""The classes of matches by the names of their groups."""
_AMPERSAND = "&amp;"
MARKUP = "a sign, not a word"
"""Why HTML, entities and pictures are skipped."""
ADDRESS = "addresses somebody"
CLOSING = "closes a letter"
_RUN = 3
"""Repeated runs of at least this many words are slips."""
_LONGEST_RUN = 120

_UNSEEN = {0x2019: "'"} | dict.fromkeys((0xAD, 0x200B, 0x200C, 0x200D, 0x2060, 0xFEFF))
"""Invisible signs, such as a soft hyphen, do not belong to a word."""
_UNITS = frozenset("%°")
_LONG_WORD = 60
_LABEL = 4
"""Maximum number of words before the colon of a note."""
_SALUTATION = 5
"""Maximum number of words and signs of a salutation, or of a closing: "Dear all,", "Kind regards,"."""
_NOTE = 12
"""Tokens on each side of the colon that are looked at."""
_TITLE_SHARE = 0.4
"""A text with more capitals than this says nothing by them."""


def tokenise(text: str) -> list[Token]:
    """Cut a text into tokens. Everything between them is blank or a sign without meaning here."""
    tokens: list[Token] = []
    for match in _TOKEN.finditer(text):
        token = _token(match)
        last = tokens[-1] if tokens and tokens[-1].kind is Kind.WORD else None
        clitic = pairs("clitics").get(token.text)
        if clitic and last and text[token.span.start - 1] in ("'\u2019 " if clitic == token.text else "'\u2019"):
            # "let's", "do n't": cut by a program
            tokens[-1] = replace(last, text=last.text + clitic, span=Span(last.span.start, token.span.end))
            continue
        timed = token.text in section("after_its") and len(tokens) > 1 and tokens[-2].text in section("before_its")
        if timed or (token.text in section("its_places") and tokens):
            tokens[-1:] = _cut(tokens[-1], pairs("its"))  # as people write it: "when its done"
        tokens += _cut(token, pairs("two_words"))
    tokens = _dictated(tokens)
    _letter(tokens, text)
    _units(tokens)
    _enumeration(tokens, text)
    tokens = _labelled(tokens)
    _capitals(tokens, text)
    _articles(tokens, text)
    return tokens


def _letter(tokens: list[Token], text: str) -> None:
    """Set the salutation and the closing of a letter aside: lines of their own that begin with such a word."""
    lines = text.splitlines(keepends=True)
    start, closed = 0, False
    for number, line in enumerate(lines if len(lines) > 1 else []):
        words = [t for t in tokens if start <= t.span.start < start + len(line)]
        first, short = words[0].text if words else "", len(words) <= _SALUTATION
        closed = closed or (number > 0 and short and first in section("closings"))
        if closed or (not number and short and first in section("salutations")):
            for token in words:
                token.kind, token.note = Kind.SKIP, CLOSING if closed else ADDRESS
        start += len(line)


def _dictated(tokens: list[Token]) -> list[Token]:
    """Read signs that are spelled out as what they are: "wash the cup comma then dry it full stop"."""
    signs = pairs("spoken_signs")
    found: list[Token] = []
    for token in tokens:
        name = f"{found[-1].text}_{token.text}" if found else ""
        if name in signs:
            found[-1] = replace(found[-1], text=signs[name], kind=Kind.STOP)
        elif token.text in signs and found:
            found.append(replace(token, text=signs[token.text], kind=Kind.COMMA))
        else:
            found.append(token)
    return found


def _units(tokens: list[Token]) -> None:
    """Set aside the sign of a unit behind no number."""
    for before, token in pairwise([mark(Kind.STOP, 0), *tokens]):
        if token.text in _UNITS and before.kind is not Kind.NUM:
            token.kind, token.note = Kind.SKIP, MARKUP


def _labelled(tokens: list[Token]) -> list[Token]:
    """Read notes: "tv: off" as "tv off", and "book: shelf -> box" as "book from shelf to box"."""
    found: list[Token] = []
    for at, token in enumerate(tokens):
        if token.text == ":" and token.kind is Kind.STOP:
            ahead = _until_sign(tokens[at + 1 : at + 1 + _NOTE])
            label = 0 < len(_until_sign(reversed(tokens[max(at - _NOTE, 0) : at]))) <= _LABEL
            if label and any(t.arrow for t in ahead):
                token = replace(token, kind=Kind.WORD, text=sections()["arrows"][1], arrow=True)
            elif label and _is_state(ahead):
                continue
        found.append(token)
    return found


def _is_state(words: Sequence[Token]) -> bool:
    """Return whether words are a state and perhaps "please"; in "it is late: lights off" there is more."""
    *front, last = words or (mark(Kind.STOP, 0),)
    return last.text in section("noted_states") and all(token.text in section("polite") for token in front)


def _until_sign(tokens: Iterable[Token]) -> list[Token]:
    """Return the words before the next sign."""
    return list(takewhile(lambda token: token.kind in (Kind.WORD, Kind.NUM), tokens))


def _articles(tokens: list[Token], text: str) -> None:
    """Read "an" as "and" where no article stands before such a sound: "warm it up an pour it out"."""
    for token, after in pairwise(tokens):
        if token.text in pairs("before_consonants") and after.kind is Kind.WORD and after.text[0] not in "aeioux":
            spelled = text[after.span.start : after.span.end].isupper()  # "an HDMI cable"
            if not spelled and after.text not in section("silent_h"):
                token.text = pairs("before_consonants")[token.text]


def _token(match: re.Match[str]) -> Token:
    span, word = Span(*match.span()), match.group().lower().translate(_UNSEEN)
    kind = _KINDS.get(match.lastgroup or "", Kind.WORD)
    if word == _AMPERSAND:
        return Token(Kind.CC, "&", span)
    if kind is Kind.SKIP:
        return Token(kind, word, span, note=MARKUP)
    if match.lastgroup == "abbr":
        short = pairs("written_signs").get(word)
        return Token(kind, short or first_of("arrows"), span, arrow=short is None)
    word = word[:_LONG_WORD]
    if kind is Kind.NUM:
        word = word.replace(",", ".")  # a name of a thing has no comma
    return Token(kind, pairs("unmarked").get(word, word), span)


def _cut(token: Token, where: Mapping[str, str]) -> list[Token]:
    """Make two words of one that is two: "that's"."""
    if token.text not in where:
        return [token]
    first, _, second = where[token.text].partition("_")
    middle = min(token.span.start + len(first), token.span.end)
    return [
        Token(token.kind, first, Span(token.span.start, middle)),
        Token(token.kind, second, Span(middle, token.span.end)),
    ]


def _enumeration(tokens: list[Token], text: str) -> None:
    """Read the marks of a numbered list, "1) take ... 2) put ...", as stops."""
    sign, number = "", 1
    for token, after in pairwise(tokens):
        if token.kind is not Kind.NUM or token.text != str(number) or after.text not in (".", ")", ":"):
            continue
        ahead = text[: token.span.start].strip(" (|\n\t")
        line = text[: token.span.start].rstrip(" (|\t")
        opens = number > 1 or not ahead or ahead.endswith(":") or line.endswith("\n")
        if opens and sign in ("", after.text):
            token.kind = after.kind = Kind.STOP
            sign, number = after.text, number + 1


def _capitals(tokens: list[Token], text: str) -> None:
    """Mark names: capitals inside a sentence."""
    words = [t for t in tokens if t.kind is Kind.WORD]
    capitals = [t for t in words if text[t.span.start].isupper()]
    if sum(len(t.text) > 1 for t in capitals) > _TITLE_SHARE * len(words):  # "box A and box B" is no title
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
        length = position - last_seen.get(key, position)
        last_seen[key] = position
        run = _RUN <= length <= _LONGEST_RUN
        if not run or words[position - length : position] != words[position : position + length]:
            length = 2 if _doubled(tokens, position) else 0
        if not length and kept and token.kind is Kind.WORD is kept[-1].kind and kept[-1].text == token.text:
            length = 1
        dropped += tokens[position : position + length]
        kept += [] if length else [token]
        position += length or 1
    return kept, noted(dropped, "repeats what was just said")


def drop_endearments(tokens: list[Token]) -> tuple[list[Token], list[Token]]:
    """Remove who is addressed between commas, and sounds: "shut the gate, my dear, and, er, lock it".

    Returns:
        The tokens that stay and the tokens removed.
    """
    gone: set[int] = set()
    dropped: list[Token] = []
    for at, token in enumerate(tokens):
        begin = at - (at > 0 and tokens[at - 1].text == first_of("address"))
        opened = begin > 0 and tokens[begin - 1].kind is Kind.COMMA and id(tokens[begin - 1]) not in gone
        after = tokens[at + 1].kind if at + 1 < len(tokens) else Kind.STOP
        if token.text in section("endearments") and opened and after in (Kind.COMMA, Kind.STOP):
            dropped += tokens[begin : at + 1]
            gone.update(map(id, tokens[begin - 1 : at + 1]))  # without the comma before
        if token.text in section("hesitations"):
            broken = at > 1 and tokens[at - 2].text in section("determiners") | section(
                "prepositions"
            )  # "the, er, box"
            gone.update(map(id, tokens[at - broken : at + 1 + (after is Kind.COMMA)]))
    return [token for token in tokens if id(token) not in gone], noted(dropped, ADDRESS)


def noted(tokens: list[Token], note: str) -> list[Token]:
    """Return tokens with the reason for which they are set aside."""
    for token in tokens:
        token.note = note
    return tokens


def _doubled(tokens: list[Token], at: int) -> bool:
    """Return whether two words come twice: "in the in the"."""
    pair, after = tokens[at : at + 2], [token.text for token in tokens[at + 2 : at + 4]]
    texts = [token.text for token in pair]
    return texts == after and len(set(texts)) == 2 and all(token.kind is Kind.WORD for token in pair)


def fold(tokens: list[Token], kind: Kind, joint: str = "_", form: str = "") -> Token:
    """Make one token of a run."""
    return Token(kind, joint.join(t.text for t in tokens), hull(t.span for t in tokens), form=form)


# -- patterns over the classes of words --------------------------------------------------------------------------------

K = Kind
INF, ONE = "INF", "ONE"
"""Names in patterns for "to" before a verb, and for *one* as a pronoun."""
GROUPS: dict[str, tuple[str, ...]] = {
    "NP": (K.DET, K.NUM, K.ADJ, K.N, K.PRON, ONE),
    "HEAD": (K.N, K.PRON, ONE),
    "IDLE": (K.ADV, K.FILLER, K.SKIP),
    "LINKS": (K.COMMA, K.CC),
    "BREAK": (K.STOP, K.COMMA, K.CC, K.SEP),
    "PLACE": (K.P, K.TO, K.EXC),
    "VERBAL": (K.AUX, K.FINITE, K.PARTICIPLE, K.ING, K.V),
    "OPENER": (K.SUB, K.PURP, K.REL, K.NEG, K.WITHOUT, K.ENSURE, K.SAY),
}
"""Names for several classes in patterns."""
NP, HEADS, IDLE, LINKS, BREAKS, VERBAL, OPENERS = (
    frozenset(GROUPS[name]) for name in ("NP", "HEAD", "IDLE", "LINKS", "BREAK", "VERBAL", "OPENER")
)
_CODES = {name: chr(0x4E00 + place) for place, name in enumerate((*Kind, INF, ONE))}


@cache
def _compiled(pattern: str) -> re.Pattern[str]:
    """Compile a pattern: a regular expression with names of classes and groups for letters; blanks do not count."""

    def letters(name: re.Match[str]) -> str:
        return "[" + "".join(_CODES[kind] for kind in GROUPS.get(name[0], (name[0],))) + "]"

    return re.compile(re.sub(r"[A-Z]+", letters, pattern).replace(" ", ""))


class Words:
    """The words of a text in a row.

    Attributes:
        tokens: The words.
    """

    def __init__(self, tokens: list[Token]) -> None:
        """Take the words; patterns look at the classes that they have now."""
        self.tokens = tokens
        self._codes = "".join(_CODES[_name(token)] for token in tokens) + _CODES[K.STOP]

    def kind(self, at: int) -> Kind:
        """Return the class of the word at a place; that of a full stop outside of the text."""
        return self.tokens[at].kind if 0 <= at < len(self.tokens) else K.STOP

    def among(self, at: int, *names: str) -> bool:
        """Return whether the word at a place is in one of these sections of ``words.txt``."""
        return 0 <= at < len(self.tokens) and not sections_of(self.tokens[at].text).isdisjoint(names)

    def stem_among(self, at: int, *names: str) -> bool:
        """Return whether the stem of the word at a place is in one of these sections of ``words.txt``."""
        return 0 <= at < len(self.tokens) and not sections_of(self.tokens[at].stem).isdisjoint(names)

    def follows(self, at: int, pattern: str) -> bool:
        """Return whether a pattern of classes matches from a place."""
        return _compiled(pattern).match(self._codes, at) is not None

    def past(self, at: int, pattern: str) -> int:
        """Return the place behind what a pattern of classes matches; ``at`` where it does not."""
        match = _compiled(pattern).match(self._codes, at)
        return min(match.end(), len(self.tokens)) if match else at

    def peek(self, at: int, skip: str = "IDLE*") -> int:
        """Return the place of the next word behind ``at`` that is none of those to skip."""
        return self.past(at + 1, skip)

    def back(self, at: int) -> int:
        """Return the place of the nearest word before ``at`` that is not idle; the first place where there is none."""
        before = max(at - 1, 0)
        while before and self.kind(before) in IDLE:
            before -= 1
        return before

    def asked(self, at: int) -> bool:
        """Return whether the sentence of a place ends with a question mark."""
        end = self.first(at, "STOP")
        return end < len(self.tokens) and "?" in self.tokens[end].text

    def first(self, at: int, pattern: str) -> int:
        """Return the first place from ``at`` on where a pattern matches; the end where there is none."""
        match = _compiled(pattern).search(self._codes, at)
        return min(match.start(), len(self.tokens)) if match else len(self.tokens)


def _name(token: Token) -> str:
    if token.kind is K.TO and token.form == INF.lower():
        return INF
    return ONE if token.kind is K.PRON and token.text in section("one_words") else token.kind


def mark(kind: Kind, at: int) -> Token:
    """Return a token without a word, of a class, at a place of the text."""
    return Token(kind, "", Span(at, at))
