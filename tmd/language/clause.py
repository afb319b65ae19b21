"""What the language room hands to the others: verb clauses, C = (ν, [obj], ρ) of section III-A."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple


class Span(NamedTuple):
    """Character offsets into the text: ``text[start:end]``."""

    start: int
    end: int


NOWHERE = Span(0, 0)
"""The span of a clause that comes from no text."""


PERSONS = frozenset({"me", "us", "him", "her", "you", "yourself", "everyone", "everybody", "someone"})
"""Words for people: objects of a clause ("bring me the cup"), but no things to be found in an environment."""


class Relation(NamedTuple):
    """One entry of the relation matrix ρ: ``on: cup -> stove``.

    ``source`` is ``None`` where the related object is elided ("put in the microwave").
    """

    relation: str
    source: str | None
    target: str


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

    def resolved(self) -> tuple[str, ...]:
        """The objects with each pronoun replaced by its likeliest antecedents, each name once, without persons."""
        names: dict[str, None] = {}
        for name in (n for n in self.objects if n not in PERSONS):
            names.update(dict.fromkeys(self.meant(name)))
        names.update(dict.fromkeys(self.meant("") if "" in self.antecedents else ()))
        return tuple(names)

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
    """A text as clauses. Nothing of the text is silently lost: what no clause covers is in ``skipped``."""

    text: str
    clauses: tuple[Clause, ...]
    skipped: tuple[Skipped, ...] = ()
