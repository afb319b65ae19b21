"""Conditions on a word and what stands around it, as rows of data files have them.

A condition joins atoms by ``&`` and ``|`` (between blanks); ``!`` negates, parentheses group. An atom is a term that
the file defines, a feature that the program computes, or one of these, in which ``|`` joins alternatives:

=====================  ===================================================================================
``left=DET|ADJ``       the class of the token before; the file may give several classes one name
``right:the|a``        its text
``word@nouns|verbs``   its text is in a section of ``words.txt``
``word~er|or``         its text ends so
``left.stem:go|run``   the same of its stem or its form: also ``right.form:s``, ``stem@intransitive``
``sure>=2``            its strength as a verb, with ``=``, ``>=`` or ``<``: also ``right.sure=3``
``right.capital``      it is written with a capital
=====================  ===================================================================================

The tokens are ``word``, which may be left out before an attribute, ``left`` and ``right`` (the nearest that are no
adverbs), ``beyond`` (behind *right*), and the very next ones: ``last``, ``last2`` (before *last*) and ``next``.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Mapping, Sequence
from operator import attrgetter
from typing import Any, NamedTuple, TypeVar

from tmd.language.lexicon.lexicon import section, sections
from tmd.language.syntax.tokens import Kind

Test = Callable[[Any], bool]
_Item = TypeVar("_Item")

TOKENS = tuple(["word", "left", "right", "beyond", "last", "last2", "next"])
_PIECE = re.compile(r"\s*([()&!]|\|(?=\s)|[^\s()&!]+)")
_ATOM = re.compile(
    rf"(?:(?P<token>{'|'.join(TOKENS)})(?:\.|(?=[=:@~])))?"
    r"(?:(?P<text>stem|form)?(?P<sign>[:@~])|(?P<strength>sure)(?P<compared>>=|=|<)(?=\d)|(?P<kind>)=|(?P<capital>capital)\Z)"
    r"(?P<values>.*)"
)
_COMPARED: Mapping[str, Callable[[int, int], bool]] = {">=": operator.ge, "=": operator.eq, "<": operator.lt}
_STRONGEST = 3


class Condition(NamedTuple):
    """A condition ready for use.

    Attributes:
        holds: Tell whether it holds for a word.
        words: It holds for none but these words; ``None``: for any.
        lefts: It holds behind none but these classes; ``None``: behind any.
    """

    holds: Test
    words: frozenset[str] | None = None
    lefts: frozenset[Kind] | None = None

    def possible(self, text: str, left: Kind) -> bool:
        """Tell whether it may hold for such a word behind such a class."""
        return (self.words is None or text in self.words) and (self.lefts is None or left in self.lefts)


class Vocabulary:
    """What conditions may speak of.

    Attributes:
        features: What the program computes, by name.
        groups: Names of several classes.
        terms: Conditions that have a name.
    """

    def __init__(self, features: Mapping[str, Test]) -> None:
        """Begin without groups and terms."""
        self.features = features
        self.groups: dict[str, frozenset[Kind]] = {}
        self.terms: dict[str, Condition] = {}

    def condition(self, text: str) -> Condition:
        """Compile a condition.

        Raises:
            ValueError: It is not well-formed, or speaks of something unknown; in one line.
        """
        pieces = _PIECE.findall(text)[::-1]
        found = self._joined(pieces, "|")
        if pieces:
            raise ValueError(f"'{pieces[-1]}' is not expected here")
        return found

    def kinds(self, names: str) -> frozenset[Kind]:
        """Return classes by their names and names of groups, joined by ``|``."""
        unknown = [name for name in names.split("|") if name not in self.groups and name not in Kind.__members__]
        if unknown:
            raise ValueError(f"'{unknown[0]}' is no class of words")
        return frozenset().union(*(self.groups.get(name) or {Kind[name]} for name in names.split("|")))

    def _joined(self, pieces: list[str], sign: str) -> Condition:
        parts: list[Condition] = []
        while not parts or (pieces and pieces[-1] == sign and pieces.pop()):
            parts.append(self._joined(pieces, "&") if sign == "|" else self._one(pieces))
        if len(parts) == 1:
            return parts[0]
        tests = tuple(part.holds for part in parts)
        words, lefts = [part.words for part in parts], [part.lefts for part in parts]
        if sign == "|":
            return Condition(lambda word: any(test(word) for test in tests), _either(words), _either(lefts))
        return Condition(lambda word: all(test(word) for test in tests), _both(words), _both(lefts))

    def _one(self, pieces: list[str]) -> Condition:
        piece = pieces.pop() if pieces else ""
        if piece == "!":
            inner = self._one(pieces).holds
            return Condition(lambda word: not inner(word))
        if piece == "(":
            found = self._joined(pieces, "|")
            if not pieces or pieces.pop() != ")":
                raise ValueError("a parenthesis is not closed")
            return found
        if piece in self.features:
            return Condition(self.features[piece])
        return self.terms[piece] if piece in self.terms else self._atom(piece)

    def _atom(self, piece: str) -> Condition:
        match = _ATOM.fullmatch(piece)
        if match is None:
            raise ValueError(
                f"'{piece}' is no term, no feature and no comparison" if piece else "a condition ends early"
            )
        token, values = match["token"] or "word", match["values"]
        if match["strength"]:
            numbers = [n for n in range(_STRONGEST + 1) if _COMPARED[match["compared"]](n, int(values))]
            return _among(f"{token}.strength", numbers)
        if match["capital"]:
            return _among(f"{token}.capital", [True])
        if match["kind"] is not None:
            kinds = self.kinds(values)
            return _among(f"{token}.kind", kinds)._replace(lefts=kinds if token == "left" else None)
        path = f"{token}.{match['text'] or 'text'}"
        if match["sign"] == "~":
            get, endings = attrgetter(path), tuple(values.split("|"))
            return Condition(lambda word: get(word).endswith(endings))
        words = of_sections(values) if match["sign"] == "@" else frozenset(values.split("|"))
        return _among(path, words)._replace(words=words if path == "word.text" else None)


def of_sections(names: str) -> frozenset[str]:
    """Return the words of sections of ``words.txt``, their names joined by ``|``."""
    unknown = [name for name in names.split("|") if name not in sections()]
    if unknown:
        raise ValueError(f"'{unknown[0]}' is no section of words.txt")
    return frozenset().union(*(section(name) for name in names.split("|")))


def _among(path: str, values: Sequence[Any] | frozenset[Any]) -> Condition:
    get, allowed = attrgetter(path), frozenset(values)
    return Condition(lambda word: get(word) in allowed)


def _both(sets: list[frozenset[_Item] | None]) -> frozenset[_Item] | None:
    known = [some for some in sets if some is not None]
    return frozenset.intersection(*known) if known else None


def _either(sets: list[frozenset[_Item] | None]) -> frozenset[_Item] | None:
    known = [some for some in sets if some is not None]
    return frozenset().union(*known) if len(known) == len(sets) else None
