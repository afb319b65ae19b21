"""Rules by which the likeliest of several readings is found, with the odds that each finds what is meant.

A preference looks at the things that a noun may mean and at what is known of the clause, and returns those it prefers;
none where it has no opinion. They are asked in the order of their table, each about what the ones before it left. The
other rules are followed by :class:`tmd.goals.reading.row_reader.RowReader`.

The odds are those that ``python -m experiments.language.decisions`` finds, and 3 where hardly any test depends on a
rule.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeAlias

from tmd.goals.clause_goal import ClauseReading
from tmd.goals.grounder import Grounder
from tmd.goals.reading.noun_phrases import Nouns
from tmd.goals.words import is_relation, state_words, words_of
from tmd.language.clause import NounPhrase, Quantifier
from tmd.language.lexicon.names import split_name
from tmd.world.world import World

Names: TypeAlias = tuple[str, ...]


class Finder(Protocol):
    """Finds what nouns mean, as :class:`tmd.goals.reading.referents.Referents` does."""

    world: World
    grounder: Grounder
    nouns: Nouns

    def targets(self, noun: str, reading: ClauseReading) -> Names:
        """Return the objects or constants that a noun behind a preposition may mean."""
        ...

    def puts_back(self, reading: ClauseReading) -> bool:
        """Return whether things go where they were."""
        ...


@dataclass(frozen=True, slots=True)
class Context:
    """A noun phrase in its clause.

    Attributes:
        referents: Finds what other nouns of the clause mean.
        reading: The clause, its state and what was spoken of.
        noun: The noun.
        phrase: How it was said.
        types: The types that its slot takes.
        relations: What it is related to.
        place: Whether it is a place.
        likely: All that it may mean, of whatever type.
    """

    referents: Finder
    reading: ClauseReading
    noun: str
    phrase: NounPhrase
    types: tuple[str, ...]
    relations: Sequence[tuple[str, str]]
    place: bool = False
    likely: Names = ()

    def targets(self, kind: str) -> Iterable[Names]:
        """Yield what stands in relations of a kind, as objects and constants."""
        return (self.referents.targets(t, self.reading) for r, t in self.relations if is_relation(r, kind))

    def fitting(self, names: Iterable[str]) -> Names:
        """Return the names that may stand in the slot."""
        return tuple(n for n in names if self.referents.grounder.fits(n, self.types))

    def of_type(self, names: Iterable[str]) -> Names:
        """Return the names that are of the types of the slot themselves."""
        return tuple(n for n in names if self.referents.grounder.is_a(n, self.types))


@dataclass(frozen=True, slots=True)
class ReadingRule:
    """A named rule by which the likeliest of several readings is found.

    Attributes:
        name: Its name.
        reason: Why what it finds is likelier.
        example: A request that it decides.
        odds: The natural logarithm of the odds that it finds what is meant. Each reading that does not follow it is a
            candidate with that much less belief, but for those below :data:`LEAST`.
    """

    name: str
    reason: str
    example: str
    odds: float


@dataclass(frozen=True, slots=True)
class Preference(ReadingRule):
    """A rule for what a noun means.

    Attributes:
        kept: Returns the preferred candidates, given all and the context; none where it has no opinion.
    """

    kept: Callable[[Names, Context], Names]


def choose(table: Sequence[Preference], names: Names, context: Context) -> Names:
    """Return the candidates that the preferences of a table leave, one after the other."""
    for preference in table:
        kept = preference.kept(names, context)
        if kept and kept != names and not context.reading.decisions.taken(preference.name, context.noun, 2):
            names = kept
    return names


def _part_of_recent(names: Names, c: Context) -> Names:
    """Return the part of what was spoken of last, or the latest thing that facts speak of by that part."""
    if c.referents.nouns.is_only_told_of(c.noun):
        alone = c.phrase.quantifier is Quantifier.PLAIN and all(t == c.noun for _, t in c.relations)
        latest = next((n for n in c.reading.memory.recent if n in names), "") if alone else ""
        together = (b.names for b in c.reading.memory.bound.values() if c.phrase.plural and latest in b.names)
        return next(together, (latest,)) if latest else ()
    single = c.phrase.definite and not c.phrase.plural and not c.relations
    return part_of(c.reading.memory.recent, c.noun, c) if single else ()


def _part_of_whole(_: Names, c: Context) -> Names:
    return next(filter(None, (part_of(names, c.noun, c) for names in c.targets("part"))), ())


def _holding(_: Names, c: Context) -> Names:
    held = (c.referents.nouns.holders(c.noun, names, c.reading.moments) for names in c.targets("partitive"))
    return next(filter(None, map(c.fitting, held)), ())


def _part_for_whole(_: Names, c: Context) -> Names:
    if c.likely or c.noun not in words_of("parts"):
        return ()
    spoken = c.of_type(c.reading.memory.recent)
    opened = tuple(n for n in spoken if c.referents.nouns.state_of(state_words("open"), n) is not None)
    return (opened or spoken)[:1]


def _holder_by_now(names: Names, c: Context) -> Names:
    """Return what contains the substance that was spoken of, by now."""
    if c.phrase.quantifier is not Quantifier.PLAIN or c.referents.puts_back(c.reading):
        return ()
    named = set(c.referents.nouns.substances(c.noun))
    bound = (b for b in reversed(tuple(c.reading.memory.bound.values())) if b.containers and named & set(b.names))
    inside = c.of_type(next((b.containers for b in bound), ()))
    if c.place:
        return inside
    return tuple(n for n in names if n in inside) if c.phrase.definite else ()


def part_of(wholes: Iterable[str], noun: str, context: Context) -> Names:
    """Return the parts of the first of some things, or of its whole, that a noun names."""
    profiles = context.referents.world.profiles
    for name in wholes:
        for whole in dict.fromkeys((name, profiles.wholes.get(name, name))):
            found = tuple(p for short, p in profiles.parts.get(whole, ()) if split_name(short)[-1:] == (noun,))
            if found:
                return found
    return ()


THINGS = (
    Preference(
        "part-of-recent", "a part of what was spoken of last", "Heat the milk. Open the door.", 1.6, _part_of_recent
    ),
    Preference(
        "part-of-whole", "a part of what it is said to belong to", "Shut the door of the fridge.", 3.0, _part_of_whole
    ),
    Preference("holder", "what holds what it is said to be of", "Bring the bag of crisps.", 3.0, _holding),
    Preference(
        "part-for-whole", "what can be opened, for its lid", "Fill the jar and close the lid.", 3.0, _part_for_whole
    ),
    Preference(
        "holder-by-now", "what the substance is in by now", "Cook rice, pour sauce over the rice.", 0.0, _holder_by_now
    ),
)
"""Objects that a noun may mean, before its adjectives and relations are looked at."""


def _within(names: Names, c: Context) -> Names:
    nouns, state = c.referents.nouns, c.reading.state
    for inside in (nouns.constants(t, c.types, state) for r, t in c.relations if is_relation(r, "partitive")):
        names = tuple(n for n in names if n in inside) or names
    return names


SUBSTANCES = (
    Preference("contents", "what the named thing contains", "Add a bottle of raspberry syrup.", 3.0, _within),
)
"""Constants that a noun may mean."""


def _not_left(names: Names, c: Context) -> Names:
    meant = c.noun in c.reading.clause.direct or c.phrase.quantifier is Quantifier.ALL
    return tuple(n for n in names if n not in c.reading.memory.left) if meant else ()


def _as_before(names: Names, c: Context) -> Names:
    bound = c.reading.memory.bound.get(c.noun)
    return tuple(n for n in names if n in bound.names) if bound is not None else ()


def _changed(names: Names, c: Context) -> Names:
    """Return what has been changed, or moved, since the text began."""
    if not c.phrase.definite or c.phrase.plural:
        return ()
    grounder, reading = c.referents.grounder, c.reading
    facts = ((n, fact) for n in names for fact in c.referents.nouns.facts_about(n) if fact.args[0] == n)
    first = reading.memory.first
    changed = {n for n, fact in facts if grounder.holds(fact, first) != grounder.holds(fact, reading.state)}
    return tuple(n for n in names if n in changed)


NOT_LEFT = (Preference("not-left", "what is not to be left alone", "Move all but leave the bowl.", 3.0, _not_left),)
"""Of all things of a kind those that are meant."""
AS_BEFORE = (
    Preference("as-before", "the one that was spoken of", "Take a cup. Wash the cup.", 3.0, _as_before),
    Preference("changed", "the one that something was done to", "Eat some chips. Bin the packet.", 3.0, _changed),
)
"""Of several things the one that is meant."""

ANTECEDENT, PLACE, TELLS_WHICH = "antecedent", "place", "tells-which"
READINGS = (
    ReadingRule(ANTECEDENT, "the noun before that fits, or what undoes something", "Fill the cup and wash it.", 2.5),
    ReadingRule(PLACE, "the noun before where something can be put", "Take a cup, add sugar.", 1.9),
    ReadingRule(TELLS_WHICH, "a place where something is already tells which thing", "Take the cup on the table.", 3.0),
)
ODDS = {rule.name: rule.odds for table in (THINGS, SUBSTANCES, NOT_LEFT, AS_BEFORE, READINGS) for rule in table}
"""The logarithm of the odds of each rule by name."""
LEAST = -1.0
"""The least logarithm of the belief, relative to that in the likeliest reading, of a reading that is a candidate.

With -4 a reading that asks for less often wins by its shorter plan: of 103 requests 85 were right instead of 90.
"""
