"""Verb clauses, C = (ν, [obj], ρ) of section III-A, which the language package gives to the others.

Their notation is the paper's, ``(take, [cup, water], with: cup -> water)``, and JSON.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any, NamedTuple

from tmd.diagnostics import Location, TmdError


class Span(NamedTuple):
    """Character offsets into the text: ``text[start:end]``."""

    start: int
    end: int


NOWHERE = Span(0, 0)
"""The span of a clause that comes from no text."""


PERSONS = frozenset({"me", "us", "him", "her", "you", "yourself", "everyone", "everybody", "someone"})
"""Words for people: objects of a clause ("bring me the cup"), but no things to be found in an environment."""


BE = "be"
"""The verb of a clause that says in what state something is."""


class Relation(NamedTuple):
    """One entry of the relation matrix ρ: ``on: cup -> stove``.

    ``source`` is ``None`` where the related object is elided ("put in the microwave").
    """

    relation: str
    source: str | None
    target: str


class Quantifier(StrEnum):
    """How many of the things that a noun may name are meant."""

    PLAIN = "plain"
    """Nothing was said of it: *a cup*, *the cups*, *milk*."""
    SOME = "some"
    """One or some of them: *some cups*, *any cup*."""
    ALL = "all"
    """Every one: *all the cups*, *both cups*, *each cup*, *the cups*."""
    NUMBER = "number"
    """So many of them as :attr:`NounPhrase.number` says."""
    OTHER = "other"
    """One that was not spoken of before: *another cup*, *the other cup*."""
    NONE = "none"
    """None of them: *no sugar*."""


@dataclass(frozen=True, slots=True)
class NounPhrase:
    """How a language-object was said.

    Attributes:
        name: The language-object.
        quantifier: How many are meant.
        number: The number, where one was said.
        definite: Said with *the*, *this* or a possessive.
        plural: Said in the plural.
        attributes: Adjectives, in order: ``empty``, ``dirty``.
        either: The language-objects of which any one will do: *the cup or the mug*.
        each: Said of every one by itself: *each cup*.
    """

    name: str
    quantifier: Quantifier = Quantifier.PLAIN
    number: int | None = None
    definite: bool = False
    plural: bool = False
    attributes: tuple[str, ...] = ()
    either: tuple[str, ...] = ()
    each: bool = False


class Mood(StrEnum):
    """What is asked of a clause."""

    DO = "do"
    AVOID = "avoid"
    """It must not be done: *don't open the window*."""
    KEEP = "keep"
    """Things shall stay as they are: *leave the cup where it is*."""


@dataclass(frozen=True, slots=True)
class Condition:
    """A subordinate clause that says when, or whether, another one is done.

    Attributes:
        word: What opens it: ``if``, ``unless``, ``when``, ``before``, ``until``, ``to`` (a purpose) …
        clauses: What it says; a state is a clause with the verb ``be``.
        negated: It says that the state does not hold.
        text: As written.
        carried: It was said with the clause before: *if it is on, turn it off and bring it*.
    """

    word: str
    clauses: tuple[Clause, ...]
    negated: bool = False
    text: str = ""
    carried: bool = False


@dataclass(frozen=True, slots=True)
class Clause:
    """A verb clause.

    Attributes:
        verb: The stem, with its particle: ``take``, ``turn_on``.
        objects: Language-objects in order of mention: singular heads with their modifiers collapsed
            (``raspberry_syrup``). Pronouns stand as they were written.
        relations: The relation matrix, as its entries.
        span: Where the clause stands in the text.
        text: What stands there.
        antecedents: For each pronoun in ``objects`` (and ``""`` for an elided object) what it may mean,
            likeliest first.
        together: For each entry of ``antecedents``, how many of its first names are meant together ("them").
        quantities: For objects said with a number, the number as written (``two``, ``3``).
        condition: A condition ("until it boils"), as written.
        duration: A duration ("for 3 minutes"), as written.
        purpose: A purpose ("to make tea"), as written.
        direct: Those of ``objects`` that the verb acts on.
        phrases: How each of ``objects`` was said.
        result: The state that something shall be in: ``open``, ``hot``, ``louder``.
        conditions: What was said about when, whether and what for.
        otherwise: It is done where the condition before it does not hold.
        mood: Whether it is to be done, or avoided, or things are to be kept.
        implied: The verb was not said: *A glass of milk, please.*
        alternative: It need not be done where the clause before it was: *or throw it away*.
        setting: A setting, as written: *to low*.
        heading: What follows says how: *make ramen: fill the pot, …*.
    """

    verb: str
    objects: tuple[str, ...] = ()
    relations: tuple[Relation, ...] = ()
    span: Span = NOWHERE
    text: str = field(default="", compare=False)
    antecedents: Mapping[str, tuple[str, ...]] = field(default_factory=dict, compare=False)
    together: Mapping[str, int] = field(default_factory=dict, compare=False)
    quantities: Mapping[str, str] = field(default_factory=dict, compare=False)
    condition: str | None = field(default=None, compare=False)
    duration: str | None = field(default=None, compare=False)
    purpose: str | None = field(default=None, compare=False)
    direct: tuple[str, ...] = field(default=(), compare=False)
    phrases: Mapping[str, NounPhrase] = field(default_factory=dict, compare=False)
    result: str | None = field(default=None, compare=False)
    conditions: tuple[Condition, ...] = field(default=(), compare=False)
    otherwise: bool = field(default=False, compare=False)
    mood: Mood = field(default=Mood.DO, compare=False)
    implied: bool = field(default=False, compare=False)
    alternative: bool = field(default=False, compare=False)
    setting: str | None = field(default=None, compare=False)
    heading: bool = field(default=False, compare=False)

    def phrase(self, name: str) -> NounPhrase:
        """How one of its language-objects was said."""
        return self.phrases.get(name) or NounPhrase(name)

    def resolved(self) -> tuple[str, ...]:
        """The objects with each pronoun replaced by its likeliest antecedents, each name once, without persons."""
        names: dict[str, None] = {}
        for name in (n for n in self.objects if n not in PERSONS):
            names.update(dict.fromkeys(self.meant(name)))
        names.update(dict.fromkeys(self.meant("") if "" in self.antecedents else ()))
        return tuple(names)

    def resolved_relations(self) -> list[Relation]:
        """The relations with each pronoun replaced by its likeliest antecedent."""

        def resolved(name: str | None) -> str | None:
            likeliest = self.antecedents.get(name or "", ())
            return likeliest[0] if likeliest else name

        return [Relation(r.relation, resolved(r.source), resolved(r.target) or r.target) for r in self.relations]

    def meant(self, name: str) -> tuple[str, ...]:
        """What one language-object most likely means: itself unless it is a pronoun (``""``: the elided one)."""
        likeliest = tuple(self.antecedents.get(name, ()))[: self.together.get(name, 1)]
        return likeliest or (name,)


class Skipped(NamedTuple):
    """A piece of text that no clause accounts for."""

    text: str
    span: Span
    reason: str


@dataclass(frozen=True, slots=True)
class Parsed:
    """A text as clauses. Nothing of the text is silently lost: what no clause covers is in ``skipped``.

    Attributes:
        text: The text.
        clauses: What is to be done, in the order of the text.
        skipped: What no clause accounts for.
        constraints: What must not be done, and what must stay as it is.
    """

    text: str
    clauses: tuple[Clause, ...]
    skipped: tuple[Skipped, ...] = ()
    constraints: tuple[Clause, ...] = ()


_CLAUSE = re.compile(r"\(\s*([\w'-]+)\s*,\s*\[([^\]]*)\]\s*((?:,[^()]*)?)\)\s*$")
_RELATION = re.compile(r"\s*([\w-]+)\s*:\s*([\w'-]*)\s*->\s*([\w'-]+)\s*$")


def clause_json(clause: Clause) -> dict[str, Any]:
    """Return a clause as JSON: what is empty of the optional parts, or as it mostly is, is left out."""
    result: dict[str, Any] = {
        "verb": clause.verb,
        "objects": list(clause.objects),
        "relations": [list(r) for r in clause.relations],
        "text": clause.text,
    }
    if clause.antecedents:
        result["antecedents"] = {name: list(names) for name, names in clause.antecedents.items()}
        result["together"] = dict(clause.together)
    if clause.quantities:
        result["quantities"] = dict(clause.quantities)
    said = {name: getattr(clause, name) for name in ("condition", "duration", "purpose", "setting", "result")}
    result |= {name: value for name, value in said.items() if value is not None}
    if clause.direct:
        result["direct"] = list(clause.direct)
    phrases = {name: _phrase_json(phrase) for name, phrase in clause.phrases.items()}
    if any(phrases.values()):
        result["phrases"] = {name: said for name, said in phrases.items() if said}
    if clause.conditions:
        result["conditions"] = [_condition_json(condition) for condition in clause.conditions]
    if clause.mood is not Mood.DO:
        result["mood"] = clause.mood.value
    return result | {name: True for name in ("otherwise", "implied", "alternative", "heading") if getattr(clause, name)}


def _phrase_json(phrase: NounPhrase) -> dict[str, Any]:
    """How a noun was said, but for its name and what is as it mostly is."""
    result: dict[str, Any] = {}
    if phrase.quantifier is not Quantifier.PLAIN:
        result["quantifier"] = phrase.quantifier.value
    if phrase.number is not None:
        result["number"] = phrase.number
    result |= {name: True for name in ("definite", "plural", "each") if getattr(phrase, name)}
    lists = {"attributes": phrase.attributes, "either": phrase.either}
    return result | {name: list(words) for name, words in lists.items() if words}


def _condition_json(condition: Condition) -> dict[str, Any]:
    """A condition; the clauses of what it says have no text of their own."""
    clauses = [clause_json(clause) for clause in condition.clauses]
    result: dict[str, Any] = {"word": condition.word, "text": condition.text}
    result["clauses"] = [{name: value for name, value in clause.items() if name != "text"} for clause in clauses]
    return result | ({"negated": True} if condition.negated else {})


def print_clause(clause: Clause) -> str:
    """Return a clause in the paper's notation; an elided source is left empty: ``in: -> microwave``."""
    relations = [f"{r.relation}: {r.source + ' ' if r.source else ''}-> {r.target}" for r in clause.relations]
    return f"({', '.join([clause.verb, '[' + ', '.join(clause.objects) + ']', *relations])})"


def read_clause(text: str, file: str = "<clause>", line: int = 1) -> Clause:
    """Read the paper's notation, as :func:`print_clause` writes it.

    Raises:
        TmdError: The text is not a clause; the place is the first sign that cannot be read.
    """
    match = _CLAUSE.match(text.strip())
    if match is None:
        raise _error("not a clause", text, file, line, 1)
    objects = tuple(name.strip() for name in match[2].split(",") if name.strip())
    relations = []
    for part in (p for p in match[3].split(",") if p.strip()):
        found = _RELATION.match(part)
        if found is None:
            raise _error(f"not a relation: {part.strip()}", text, file, line, text.find(part.strip()) + 1)
        relations.append(Relation(found[1], found[2] or None, found[3]))
    return Clause(match[1], objects, tuple(relations))


def _error(message: str, text: str, file: str, line: int, column: int) -> TmdError:
    hint = "write (verb, [object, object], relation: object -> object)"
    return TmdError(message, location=Location(file, line, column), hint=hint, source=text)


_MARK = "|"


def segments(text: str) -> tuple[Span, ...]:
    """Return the spans between the marks, in order; empty ones too."""
    spans, start = [], 0
    for place in (i for i, sign in enumerate(text) if sign == _MARK):
        spans.append(Span(start, place))
        start = place + 1
    return (*spans, Span(start, len(text)))


def by_segment(text: str, clauses: Sequence[Clause]) -> tuple[tuple[Clause, ...], ...]:
    """Return for each segment of a text the clauses that begin in it.

    Args:
        text: The text with its marks.
        clauses: The clauses of that very text, in order.
    """
    spans = segments(text)
    dealt: list[list[Clause]] = [[] for _ in spans]
    place = 0
    for clause in sorted(clauses, key=lambda c: c.span.start):
        while place + 1 < len(spans) and clause.span.start > spans[place].end:
            place += 1
        dealt[place].append(clause)
    return tuple(tuple(group) for group in dealt)
