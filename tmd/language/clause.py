"""Verb clauses, C = (ν, [obj], ρ) of section III-A, which the language package gives to the others.

Their notation is the paper's, ``(take, [cup, water], with: cup -> water)``, and JSON.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import MISSING, dataclass, field, fields, replace
from enum import StrEnum
from typing import Any, NamedTuple

from tmd.diagnostics import Location, TmdError
from tmd.language.lexicon.lexicon import section
from tmd.short_repr import short_repr


class Span(NamedTuple):
    """Character offsets into the text: ``text[start:end]``."""

    start: int
    end: int


def hull(spans: Iterable[Span]) -> Span:
    """Return the smallest span that covers some spans."""
    starts, ends = zip(*spans, strict=True)
    return Span(min(starts), max(ends))


NOWHERE = Span(0, 0)
"""The span of a clause that comes from no text."""

PERSONS = section("persons")
"""Words for people: objects of a clause ("bring me the cup"), but no things to be found in an environment."""

NEGATED = "not_"
"""Before a state or a relation: it is not so."""
BE = "be"
"""The verb of a clause that says in what state something is."""
HAVE = "have"
PUT = "put"
SET = "set"
BRING = "bring"
"""Verbs of requests without one: to have, put, set or bring something."""
AGENT = "agent"
EXCEPT = "except"
OF = "of"
TO = "to"
WITH = "with"
WHERE = "where"
"""Relations that are not always written."""


class Relation(NamedTuple):
    """One entry of the relation matrix ρ: ``on: cup -> stove``.

    ``source`` is ``None`` where the related object is elided ("put in the microwave").
    """

    relation: str
    source: str | None
    target: str


class Quantifier(StrEnum):
    """The number of things that a noun phrase means, of all that its noun may name."""

    PLAIN = "plain"
    """No number is given: *a cup*, *the cups*, *milk*."""
    SOME = "some"
    """One or some of them: *some cups*, *any cup*."""
    ALL = "all"
    """Every one: *all the cups*, *both cups*, *each cup*, *the cups*."""
    NUMBER = "number"
    """So many of them as :attr:`NounPhrase.number` says."""
    NONE = "none"
    """None of them: *no sugar*."""


@dataclass(frozen=True, slots=True)
class NounPhrase:
    """A language-object with its determiners and modifiers.

    Attributes:
        name: The language-object.
        quantifier: How many are meant.
        number: The number, where one is given.
        definite: It has *the*, *this* or a possessive.
        plural: It is in the plural.
        attributes: Adjectives, in order: ``empty``, ``dirty``.
        either: The language-objects of which any one will do: *the cup or the mug*.
        each: Every one by itself is meant: *each cup*.
        undetermined: It is in the singular without any determiner: *cup*.
        other: None that was mentioned before is meant: *another cup*, *every other cup*.
    """

    name: str
    quantifier: Quantifier = Quantifier.PLAIN
    number: int | None = None
    definite: bool = False
    plural: bool = False
    attributes: tuple[str, ...] = ()
    either: tuple[str, ...] = ()
    each: bool = False
    undetermined: bool = False
    other: bool = False


class Mood(StrEnum):
    """The request of a clause: do it, avoid it, or keep things as they are."""

    DO = "do"
    AVOID = "avoid"
    """It must not be done: *don't open the window*."""
    KEEP = "keep"
    """Things should stay as they are: *leave the cup where it is*."""


@dataclass(frozen=True, slots=True)
class Condition:
    """A subordinate clause that says when, or whether, another one is done.

    Attributes:
        word: What opens it: ``if``, ``unless``, ``when``, ``before``, ``until``, ``to`` (a purpose) …
        clauses: What it says; a state is a clause with the verb ``be``.
        negated: It says that the state does not hold.
        text: As written.
        carried: It comes from the clause before: *if it is on, turn it off and bring it*.
    """

    word: str
    clauses: tuple[Clause, ...]
    negated: bool = False
    text: str = ""
    carried: bool = False


@short_repr(lambda clause: f"{clause.verb}({', '.join(clause.objects)}) in {clause.text!r}")
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
        quantities: For objects with a number, the number as written (``two``, ``3``).
        condition: A condition ("until it boils"), as written.
        duration: A duration ("for 3 minutes"), as written.
        purpose: A purpose ("to make tea"), as written.
        direct: Those of ``objects`` that the verb acts on.
        phrases: The noun phrase of each of ``objects``.
        result: The state that something should be in: ``open``, ``hot``, ``louder``.
        conditions: Conditions and purposes.
        otherwise: It is done where the condition before it does not hold.
        mood: Whether it is to be done, or avoided, or things are to be kept.
        implied: The text leaves the verb out: *A glass of milk, please.*
        alternative: It need not be done where the clause before it was: *or throw it away*.
        setting: A setting, as written: *to low*.
        stated: Where its things are now, by relative clauses and by statements before it: *There is a mug on the
            shelf. Wash it.*
        heading: What follows says how: *make ramen: fill the pot, …*.
        told: Its subject is not the addressee: *they are starving*.
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
    stated: tuple[Relation, ...] = field(default=(), compare=False)
    heading: bool = field(default=False, compare=False)
    told: bool = field(default=False, compare=False)

    def phrase(self, name: str) -> NounPhrase:
        """Return the noun phrase of a language-object."""
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
        """Return the likeliest meaning of a language-object: itself unless it is a pronoun (``""``: the elided one)."""
        likeliest = tuple(self.antecedents.get(name, ()))[: self.together.get(name, 1)]
        return likeliest or (name,)

    def renamed(self, old: str, new: str) -> Clause:
        """Return the clause with another name for a language-object; ``self`` where that name is taken."""
        if new in self.objects or new in self.phrases:
            return self
        names = {old: new}

        def moved(value: tuple[str, ...]) -> tuple[str, ...]:
            return tuple(names.get(name, name) for name in value)

        def related(relations: tuple[Relation, ...]) -> tuple[Relation, ...]:
            return tuple(
                Relation(r.relation, names.get(r.source or "", r.source), names.get(r.target, r.target))
                for r in relations
            )

        return replace(
            self,
            objects=moved(self.objects),
            direct=moved(self.direct),
            relations=related(self.relations),
            stated=related(self.stated),
            antecedents={names.get(name, name): meant for name, meant in self.antecedents.items()},
            together={names.get(name, name): count for name, count in self.together.items()},
            phrases={names.get(n, n): replace(p, name=names.get(n, n)) for n, p in self.phrases.items()},
        )


class Skipped(NamedTuple):
    """A piece of text that no clause accounts for."""

    text: str
    span: Span
    reason: str


@short_repr(lambda parsed: f"{parsed.text!r}: {len(parsed.clauses)} clause(s)")
@dataclass(frozen=True, slots=True)
class Parsed:
    """A text as clauses. Nothing of the text is silently lost: what no clause covers is in ``skipped``.

    Attributes:
        text: The text.
        clauses: What is to be done, in the order of the text.
        skipped: What no clause accounts for.
        constraints: What must not be done, and what must stay as it is.
        stated: What is only said to be so.
    """

    text: str
    clauses: tuple[Clause, ...]
    skipped: tuple[Skipped, ...] = ()
    constraints: tuple[Clause, ...] = ()
    stated: tuple[Clause, ...] = ()


_CLAUSE = re.compile(r"\(\s*([\w'-]+)\s*,\s*\[([^\]]*)\]\s*((?:,[^()]*)?)\)\s*$")
# "7:30", "1/2" and "2.5" are names as well
_RELATION = re.compile(r"\s*([\w-]+)\s*:\s*([\w'./:-]*)\s*->\s*([\w'./:-]+)\s*$")


def clause_json(clause: Clause) -> dict[str, Any]:
    """Return a clause as JSON: what is empty of the optional parts, or as it mostly is, is left out."""
    always = {"verb": clause.verb, "objects": list(clause.objects), "relations": [list(r) for r in clause.relations]}
    said: dict[str, Any] = _plain(clause)
    if not clause.antecedents:
        said.pop("together", None)
    phrases = {name: phrase for name, phrase in said.pop("phrases", {}).items() if phrase}
    return always | {"text": clause.text} | said | ({"phrases": phrases} if phrases else {})


_UNSAID = ("span", "name", "undetermined", "told")
"""Fields that are not written."""


def _plain(value: Any) -> Any:  # noqa: ANN401 - any value of JSON
    """Return a value as JSON."""
    if isinstance(value, Condition):
        # the clauses of a condition have no text of their own
        clauses = [{k: v for k, v in clause_json(c).items() if k != "text"} for c in value.clauses]
        said: dict[str, Any] = {"word": value.word, "text": value.text, "clauses": clauses}
        return said | ({"negated": True} if value.negated else {})
    if isinstance(value, Clause | NounPhrase):
        return _said(value)
    if isinstance(value, tuple):
        return [_plain(part) for part in value]
    return {k: _plain(v) for k, v in value.items()} if isinstance(value, Mapping) else value


def _said(value: Clause | NounPhrase) -> dict[str, Any]:
    """Return those fields of a record that are not as they mostly are."""
    usual = {f.name: {} if f.default is MISSING else f.default for f in fields(value) if f.name not in _UNSAID}
    return {name: _plain(getattr(value, name)) for name, least in usual.items() if getattr(value, name) != least}


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
