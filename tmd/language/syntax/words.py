"""The words of a text in a row, and patterns over their classes."""

from __future__ import annotations

import re
from functools import cache

from tmd.language.clause import Span
from tmd.language.lexicon.lexicon import section
from tmd.language.syntax.tokens import Kind, Token

K = Kind
INF, ONE = "INF", "ONE"
"""Names in patterns for "to" before a verb, and for *one* as a pronoun."""
GROUPS: dict[str, tuple[str, ...]] = {
    "NP": (K.DET, K.NUM, K.ADJ, K.N, K.PRON, ONE),
    "HEAD": (K.N, K.PRON, ONE),
    "IDLE": (K.ADV, K.FILLER),
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
        """Tell whether the word at a place is in one of these sections of ``words.txt``."""
        return 0 <= at < len(self.tokens) and any(self.tokens[at].text in section(name) for name in names)

    def stem_among(self, at: int, *names: str) -> bool:
        """Tell whether the stem of the word at a place is in one of these sections of ``words.txt``."""
        return 0 <= at < len(self.tokens) and any(self.tokens[at].stem in section(name) for name in names)

    def follows(self, at: int, pattern: str) -> bool:
        """Tell whether a pattern of classes matches from a place."""
        return _compiled(pattern).match(self._codes, at) is not None

    def past(self, at: int, pattern: str) -> int:
        """Return the place behind what a pattern of classes matches; ``at`` where it does not."""
        match = _compiled(pattern).match(self._codes, at)
        return min(match.end(), len(self.tokens)) if match else at

    def peek(self, at: int, skip: str = "IDLE*") -> int:
        """Return the place of the next word behind ``at`` that is none of those to skip."""
        return self.past(at + 1, skip)

    def first(self, at: int, pattern: str) -> int:
        """Return the first place from ``at`` on where a pattern matches; the end where there is none."""
        match = _compiled(pattern).search(self._codes, at)
        return min(match.start(), len(self.tokens)) if match else len(self.tokens)


def _name(token: Token) -> str:
    if token.kind is K.TO and token.form == INF.lower():
        return INF
    return ONE if token.kind is K.PRON and token.text in section("one_words") else token.kind


def mark(kind: Kind, at: int) -> Token:
    """Return a token of a class that no word stands for, at a place of the text."""
    return Token(kind, "", Span(at, at))
