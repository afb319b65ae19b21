"""Conditions on a word and what stands around it, as rows of data files have them.

A condition joins atoms by ``&`` and ``|`` (between blanks); ``!`` negates, parentheses group. An atom is a term that
the file defines, a feature that the program computes, or one of these, in which ``|`` joins alternatives:

=====================  ==================================================================================
``left=DET|ADJ``       the class of the token before; the file may give several classes one name
``right:the|a``        its text
``word@nouns|verbs``   its text is in a section of ``words.txt``
``word~er|or``         its text ends so
``left.stem:go|run``   the same of its stem or its form: also ``right.form:s``, ``stem@intransitive``
``sure>=2``            its strength as a verb, with ``=``, ``>=`` or ``<``: also ``right.sure=3``
``right.capital``      it is written with a capital; ``stem``: it has one
=====================  ==================================================================================

The tokens are ``word``, which may be left out before an attribute, ``left`` and ``right`` (the nearest that are no
adverbs), ``beyond`` (behind *right*), and the very next ones: ``last``, ``last2`` (before *last*) and ``next``.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Mapping, Sequence
from operator import attrgetter
from typing import Any, NamedTuple

from tmd.language.lexicon.lexicon import section, sections
from tmd.language.syntax.tokens import Kind

Test = Callable[[Any], bool]

_PIECE = re.compile(r"\s*([()&!]|\|(?=\s)|[^\s()&!]+)")
TOKENS = ("word", "left", "right", "beyond", "last", "last2", "next")
_ATOM = re.compile(
    rf"(?:(?P<token>{'|'.join(TOKENS)})(?:\.|(?=[=:@~])))?(?P<attribute>stem|form|sure|capital)?"
    r"(?:(?P<sign>>=|[=<:@~])(?P<values>.*))?"
)
_NUMBERS: Mapping[str, Callable[[int, int], bool]] = {"=": operator.eq, ">=": operator.ge, "<": operator.lt}


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
        pieces = _PIECE.findall(text)
        pieces.reverse()
        found = self._any(pieces)
        if pieces:
            raise ValueError(f"'{pieces[-1]}' is not expected here")
        return found

    def kinds(self, names: str) -> frozenset[Kind]:
        """Return classes by their names and names of groups, joined by ``|``."""
        found: frozenset[Kind] = frozenset()
        for name in names.split("|"):
            if name not in self.groups and name not in Kind.__members__:
                raise ValueError(f"'{name}' is no class of words")
            found |= self.groups.get(name) or {Kind[name]}
        return found

    def _any(self, pieces: list[str]) -> Condition:
        parts = [self._all(pieces)]
        while pieces and pieces[-1] == "|":
            pieces.pop()
            parts.append(self._all(pieces))
        return parts[0] if len(parts) == 1 else _either(parts)

    def _all(self, pieces: list[str]) -> Condition:
        parts = [self._one(pieces)]
        while pieces and pieces[-1] == "&":
            pieces.pop()
            parts.append(self._one(pieces))
        return parts[0] if len(parts) == 1 else _both(parts)

    def _one(self, pieces: list[str]) -> Condition:
        piece = pieces.pop() if pieces else ""
        if piece == "!":
            inner = self._one(pieces).holds
            return Condition(lambda word: not inner(word))
        if piece == "(":
            found = self._any(pieces)
            if not pieces or pieces.pop() != ")":
                raise ValueError("a parenthesis is not closed")
            return found
        if piece in self.terms:
            return self.terms[piece]
        if piece in self.features:
            return Condition(self.features[piece])
        return self._atom(piece)

    def _atom(self, piece: str) -> Condition:
        match = _ATOM.fullmatch(piece)
        if not piece or match is None or not (match["attribute"] or match["sign"]):
            raise ValueError(f"'{piece}' is no term, no feature and no comparison" if piece else "a condition ends early")
        token, attribute, sign, values = match["token"] or "word", match["attribute"], match["sign"], match["values"]
        if attribute == "capital" or not sign:
            return Condition(_true(attrgetter(f"{token}.{attribute}")))
        if attribute == "sure":
            if sign not in _NUMBERS or not values.isdigit():
                raise ValueError(f"'{piece}' does not compare with a number")
            return Condition(_compared(attrgetter(f"{token}.strength"), _NUMBERS[sign], int(values)))
        if sign == "=" and not attribute:
            kinds = self.kinds(values)
            return Condition(_among(attrgetter(f"{token}.kind"), kinds), lefts=kinds if token == "left" else None)
        get = attrgetter(f"{token}.{attribute or 'text'}")
        if sign == "~":
            endings = tuple(values.split("|"))
            return Condition(lambda word: get(word).endswith(endings))
        words = frozenset(values.split("|")) if sign == ":" else of_sections(values) if sign == "@" else None
        if words is None:
            raise ValueError(f"'{piece}' compares no number")
        return Condition(_among(get, words), words if (token, attribute) == ("word", None) else None)


def of_sections(names: str) -> frozenset[str]:
    """Return the words of sections of ``words.txt``, their names joined by ``|``."""
    unknown = [name for name in names.split("|") if name not in sections()]
    if unknown:
        raise ValueError(f"'{unknown[0]}' is no section of words.txt")
    return frozenset().union(*(section(name) for name in names.split("|")))


def _true(get: Callable[[Any], object]) -> Test:
    return lambda word: bool(get(word))


def _compared(get: Callable[[Any], int], compare: Callable[[int, int], bool], number: int) -> Test:
    return lambda word: compare(get(word), number)


def _among(get: Callable[[Any], str], values: frozenset[str] | frozenset[Kind]) -> Test:
    return lambda word: get(word) in values


def _both(parts: Sequence[Condition]) -> Condition:
    words, lefts = [p.words for p in parts if p.words is not None], [p.lefts for p in parts if p.lefts is not None]
    tests = tuple(part.holds for part in parts)

    def holds(word: object) -> bool:
        for test in tests:  # noqa: SIM110 - all() takes twice the time
            if not test(word):
                return False
        return True

    return Condition(
        holds,
        frozenset.intersection(*words) if words else None,
        frozenset.intersection(*lefts) if lefts else None,
    )


def _either(parts: Sequence[Condition]) -> Condition:
    words, lefts = [p.words for p in parts if p.words is not None], [p.lefts for p in parts if p.lefts is not None]
    tests = tuple(part.holds for part in parts)

    def holds(word: object) -> bool:
        for test in tests:  # noqa: SIM110 - any() takes twice the time
            if test(word):
                return True
        return False

    return Condition(
        holds,
        frozenset.union(*words) if len(words) == len(parts) else None,
        frozenset.union(*lefts) if len(lefts) == len(parts) else None,
    )
