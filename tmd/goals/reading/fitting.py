"""The rows of a verb that fit what was said."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tmd.goals.clause_goal import ClauseReading, Unit, words
from tmd.goals.reading.referents import Referents, is_none
from tmd.goals.reasons import placed
from tmd.goals.sources.table import ACTIONS, GoalRow, Slot, slot_predicate, slot_types
from tmd.goals.words import (
    PREPOSITIONS,
    ends_as,
    family,
    is_noun,
    is_relation,
    is_verb,
    relations_said,
    table,
    words_of,
)
from tmd.language.clause import PERSONS, Quantifier, Relation
from tmd.pddl.model import predicates_of


class Fitting:
    """Chooses among the rows of a verb.

    Args:
        referents: Finds what nouns mean.
    """

    def __init__(self, referents: Referents) -> None:
        self.referents = referents
        self.domain = referents.domain
        self.grounder = referents.grounder
        self.nouns = referents.nouns

    def of(self, rows: Sequence[GoalRow], unit: Unit, reading: ClauseReading) -> list[GoalRow]:
        """Return the rows that fit, those first that take more of what was said, and that just as it was said."""
        counted = reading.clause.phrase(unit.direct or "").quantifier in (Quantifier.ALL, Quantifier.NUMBER)
        return sorted(
            (row for row in rows if not self._misfit(row, unit, reading)),
            key=lambda row: (
                not (row.looks_back and not unit.relations),  # "put it back": where it was
                -len(row.slots) - (row.noun is not None),
                -self._latest(row, unit, reading),
                counted and not self.takes_things(row, unit, reading),
                (row.source == ACTIONS or self._names_no_substance(unit)) and not self._takes_named(row, unit),
            ),
        )

    def _names_no_substance(self, unit: Unit) -> bool:
        return bool(unit.direct) and not self.nouns.substances(unit.direct or "")

    def may_tell_which(self, row: GoalRow, unit: Unit, reading: ClauseReading) -> bool:
        """Return whether a place that a row takes is where one of the things is now: *the bottle on the table*."""
        clause = reading.clause
        none = unit.direct is not None and is_none(unit.direct, clause)
        if none or is_verb(clause.verb, "placing"):
            return False  # they say where something shall be, or nothing
        said = [pair for slot in row.places for pair in self.fillers(slot, unit, reading)]
        if len(said) != 1 or len(unit.relations) != 1 or said[0][1] is None:
            return False
        relation, target = said[0]
        where = any(relation in PREPOSITIONS[p] for p in words_of("relations", "standing"))
        definite = unit.direct is not None and clause.phrase(unit.direct).definite  # "take the cup of water"
        where = where or (definite and is_relation(relation, "partitive"))
        return where and self.referents.tells_which(unit.direct, relation, target or "", reading)

    def takes_things(self, row: GoalRow, unit: Unit, reading: ClauseReading) -> bool:
        """Return whether what the verb acts on may be an object, not only something that objects contain."""
        if row.direct is None or unit.direct is None:
            return False
        types = slot_types(row, row.direct, self.domain)
        return any(self.grounder.is_a(name, types) for name in self.nouns.things(unit.direct, reading.state))

    def takes_all(self, row: GoalRow, unit: Unit, reading: ClauseReading) -> bool:
        """Return whether what stands behind the prepositions of a row was said, and may ever be there.

        An oven holds no milk: *heat the milk in the oven* says where it is done.
        """
        for slot in row.places:
            predicate, place = slot_predicate(row.condition, slot.variable)
            for _, target in self.fillers(slot, unit, reading):
                names = self.referents.targets(target, reading) if target else ()
                facts = (fact for name in names for fact in self.nouns.facts_about(name))
                if not any(fact.predicate == predicate and fact.args[place] in names for fact in facts):
                    return False
        return True

    def _latest(self, row: GoalRow, unit: Unit, reading: ClauseReading) -> int:
        """Return how late what a row takes was said: *the book on the table in the box* says last where it shall go."""
        taken = [pair for slot in row.places for pair in self.fillers(slot, unit, reading)]
        return max((unit.relations.index(pair) for pair in taken if pair in unit.relations), default=0)

    def _takes_named(self, row: GoalRow, unit: Unit) -> bool:
        """Return whether what the verb acts on may be what the noun names, not only what holds it."""
        if row.direct is None or not unit.direct:
            return True
        types = slot_types(row, row.direct, self.domain)
        ranked = self.referents.world.mentions.ranked(unit.direct)
        return not ranked or any(self.grounder.is_a(m.name, types) for m in ranked if m.how == ranked[0].how)

    def unfit(self, rows: Sequence[GoalRow], unit: Unit, reading: ClauseReading) -> list[str]:
        """Return the other rows, each with its place and why it does not fit, for authors."""
        return [f"{placed(row)}: {why}" for row in rows if (why := self._misfit(row, unit, reading))]

    def _misfit(self, row: GoalRow, unit: Unit, reading: ClauseReading) -> str:
        """Return why a row does not fit the clause; empty where it does."""
        if row.result is not None and row.result != reading.clause.result:
            return f"it is for '{words(row.result)}'"
        if row.noun is not None:
            if not self._same(row.noun, unit.direct, reading):
                return f"it is for '{words(row.noun)}'"
        elif row.direct is None and unit.direct is not None:
            return f"no slot takes '{words(unit.direct)}'"
        if unit.direct and not self._speaks_of(row, unit.direct):
            return f"no predicate of the row speaks of '{words(unit.direct)}'"
        empty = [slot for slot in row.places if not self.fillers(slot, unit, reading)]
        if row.noun is None and row.direct is not None and unit.direct is None:
            empty.insert(0, row.direct)
        return "; ".join(f"nothing fills slot {slot.variable.removeprefix('?').upper()}" for slot in empty)

    def _speaks_of(self, row: GoalRow, noun: str) -> bool:
        """Return whether a row may be meant by what is acted on: a door is not lowered like a load at its dock."""
        if row.source != ACTIONS or row.noun is not None or not self.nouns.is_only_told_of(noun):
            return True
        return any(self.nouns.speaks_of(name, noun) for name in predicates_of(row.condition))

    def _same(self, noun: str, said: str | None, reading: ClauseReading) -> bool:
        """Return whether two nouns are the same, or name the same things here: *kettle*, *kettel*."""
        said = self.referents.likeliest(said, reading.clause) if said else said
        if noun == said or said is None or ends_as(noun, "plural"):
            return noun == said
        named = self.nouns.things(noun, reading.state)
        return bool(named) and named == self.nouns.things(said, reading.state)

    def fillers(self, slot: Slot, unit: Unit, reading: ClauseReading) -> list[tuple[str, str | None]]:
        """Return what was said in a slot: relation and noun; the noun is left out where it points back."""
        clause = reading.clause
        whither = not any(is_relation(p, "origin") for p in slot.prepositions)  # "tip out the water that is in the pot"
        said = [
            (relation, target)
            for relation, target in unit.relations
            if relations_said(relation, slot.prepositions)
            and not (whither and self._is_told(relation, target, unit, reading))
            and not (is_relation(relation, "accompanying") and is_none(target, clause))
        ]
        if said:
            return list(self._chosen(said, slot, unit, reading))
        elided = self._elided(slot, unit, reading)
        return [(elided, None)] if elided else []

    def _chosen(
        self, said: Sequence[tuple[str, str]], slot: Slot, unit: Unit, reading: ClauseReading
    ) -> Iterator[tuple[str, str]]:
        """Yield those of several places that are for a slot."""
        if len(said) > 1:
            said = [p for p in said if self._is_for(slot, p[1], reading)] or said
        part = bool(unit.direct) and self.nouns.is_only_told_of(unit.direct or "")
        if len(said) > 1 and not part:  # the beds in two rooms are those of both
            # "the mug in the sink on the shelf": what holds already tells which mug, the rest where it shall go
            said = [p for p in said if not self.referents.tells_which(unit.direct, *p, reading)] or said[-1:]
        yield from ((relation, target) for relation, target in said if relation == said[-1][0])

    def _is_for(self, slot: Slot, target: str, reading: ClauseReading) -> bool:
        """Return whether a noun names something of the types of a slot: Mars, and not infrared, of an image."""
        return any(self.grounder.is_a(name, slot.types) for name in self.nouns.things(target, reading.state))

    def _is_told(self, relation: str, target: str, unit: Unit, reading: ClauseReading) -> bool:
        """Return whether a clause states a place where something is, or nothing that it may mean: nothing goes there.

        "Bring me the book that is on the shelf."
        """
        if is_noun(unit.direct or "", "everything"):
            return False  # "what is in the pot" may be a substance
        stated = Relation(relation, unit.direct, target) in reading.clause.stated
        given = any(r.target in PERSONS for r in reading.clause.relations)
        return stated and (given or not self.referents.tells_which(unit.direct, relation, target, reading))

    def _elided(self, slot: Slot, unit: Unit, reading: ClauseReading) -> str | None:
        """Return the relation of a place that was not said: "take a cup, add sugar" is into what was spoken of last."""
        clause = reading.clause
        if not reading.memory.recent or any(r.target in PERSONS for r in clause.relations):
            return None  # "bring me the milk" says where
        if self.referents.puts_back(reading):
            return None  # to where it was
        particle = table("particles").get(clause.verb.rpartition("_")[2], ("",))[0]
        if particle in slot.prepositions:
            return particle
        verbs = (clause.verb, self.referents.lexicon.canonical_verb(clause.verb))
        alike = {*verbs, *(name for verb in verbs for name in family(verb))}
        if unit.relations or alike.isdisjoint(words_of("verbs", "elliptic")):
            return None
        resting = [p for p in slot.prepositions if is_relation(p, "resting")]
        return "to" if len(resting) > 1 else next(iter(resting), None)
