"""Which rows fit what was said, and in which order they are tried."""

from __future__ import annotations

from collections.abc import Sequence

from tmd.goals.clause_goal import ClauseReading, Unit
from tmd.goals.reading.nouns import relations_said
from tmd.goals.reading.referents import Referents
from tmd.goals.sources.senses import family
from tmd.goals.sources.table import ACTIONS, PREPOSITIONS, GoalRow, Slot, slot_predicate, slot_types
from tmd.language.clause import PERSONS, Quantifier

_PARTICLES = {"in": "in", "on": "on", "into": "in", "onto": "on"}


class Fitting:
    """Chooses among the rows of a verb.

    Args:
        referents: What nouns mean.
    """

    def __init__(self, referents: Referents) -> None:
        self.referents = referents
        self.domain = referents.domain
        self.grounder = referents.grounder
        self.nouns = referents.nouns

    def of(self, rows: Sequence[GoalRow], unit: Unit, reading: ClauseReading) -> list[GoalRow]:
        """The rows that fit, those first that take more of what was said, and that just as it was said."""
        counted = reading.clause.phrase(unit.direct or "").quantifier in (Quantifier.ALL, Quantifier.NUMBER)
        return sorted(
            (row for row in rows if self._fits(row, unit, reading)),
            key=lambda row: (
                not (row.looks_back and not unit.relations),  # "put it back": where it was
                -len(row.slots) - (row.noun is not None),
                -self._latest(row, unit, reading),
                counted and not self._takes_things(row, unit, reading),
                row.source == ACTIONS and not self._takes_named(row, unit),
            ),
        )

    def may_tell_which(self, row: GoalRow, unit: Unit, reading: ClauseReading) -> bool:
        """Whether a place that a row takes is where one of the things is now: *the bottle on the table*."""
        none = unit.direct is not None and reading.clause.phrase(unit.direct).quantifier is Quantifier.NONE
        if none or reading.clause.verb in ("put", "place", "set", "make_sure"):
            return False  # they say where something shall be, or nothing
        said = [pair for slot in row.places for pair in self.fillers(slot, unit, reading)]
        where = any(said[:1] and said[0][0] in PREPOSITIONS[p] for p in ("in", "on", "next_to", "under"))
        if not where or len(said) != 1 or len(unit.relations) != 1 or said[0][1] is None:
            return False
        return self.referents.tells_which(unit, said[0][0], said[0][1], reading)

    def _takes_things(self, row: GoalRow, unit: Unit, reading: ClauseReading) -> bool:
        """Whether what the verb acts on may be an object, not only something that objects contain."""
        if row.direct is None or unit.direct is None:
            return False
        types = slot_types(row.condition, row.direct.variable, self.domain)
        return any(self.grounder.is_a(name, types) for name in self.nouns.things(unit.direct, reading.state))

    def takes_all(self, row: GoalRow, unit: Unit, reading: ClauseReading) -> bool:
        """Whether what stands behind the prepositions of a row was said, and may ever be there.

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
        """How late what a row takes was said: *the book on the table in the box* says last where it shall go."""
        taken = [pair for slot in row.places for pair in self.fillers(slot, unit, reading)]
        return max((unit.relations.index(pair) for pair in taken if pair in unit.relations), default=0)

    def _takes_named(self, row: GoalRow, unit: Unit) -> bool:
        """Whether what the verb acts on may be what the noun names, not only what holds it: *manure*, the barrow."""
        if row.direct is None or not unit.direct:
            return True
        types = slot_types(row.condition, row.direct.variable, self.domain)
        ranked = self.referents.world.mentions.ranked(unit.direct)
        return not ranked or any(self.grounder.is_a(m.name, types) for m in ranked if m.how == ranked[0].how)

    def _fits(self, row: GoalRow, unit: Unit, reading: ClauseReading) -> bool:
        if (row.result or None) != (reading.clause.result if row.result else None):
            return False
        if row.noun is not None and not self._same(row.noun, unit.direct, reading):
            return False
        if row.noun is None and (row.direct is None) != (unit.direct is None):
            return False
        return all(self.fillers(slot, unit, reading) for slot in row.places)

    def _same(self, noun: str, said: str | None, reading: ClauseReading) -> bool:
        """Whether two nouns are the same, or name the same things here: *kettle*, *kettel*."""
        if noun == said or said is None or noun.endswith("s"):
            return noun == said
        named = self.nouns.things(noun, reading.state)
        return bool(named) and named == self.nouns.things(said, reading.state)

    def fillers(self, slot: Slot, unit: Unit, reading: ClauseReading) -> list[tuple[str, str | None]]:
        """What was said in a slot: relation and noun; a particle alone leaves the noun to what was spoken of."""
        said = [
            (r, t)
            for r, t in unit.relations
            if relations_said(r, slot.prepositions)
            and not (r == "with" and reading.clause.phrase(t).quantifier is Quantifier.NONE)
        ]
        if len({r for r, _ in said}) > 1 or len(said) > 1:
            # "the mug in the sink on the shelf": what holds already tells which mug, the rest where it shall go
            said = [pair for pair in said if not self.referents.tells_which(unit, *pair, reading)] or said[-1:]
        if said:
            first = said[0][0]
            return [(r, t) for r, t in said if r == first]
        if not reading.memory.recent or any(r.target in PERSONS for r in reading.clause.relations):
            return []  # "bring me the milk" says where
        particle = _PARTICLES.get(reading.clause.verb.rpartition("_")[2])
        if particle in slot.prepositions:
            return [(particle, None)]
        # "take a cup, add sugar": into what was spoken of last
        verbs = (reading.clause.verb, self.referents.lexicon.canonical_verb(reading.clause.verb))
        wants_place = {"put", "add", "pour"} & {*verbs, *(name for verb in verbs for name in family(verb))}
        either = {"in", "on"} <= set(slot.prepositions)
        into = "to" if either else next((p for p in slot.prepositions if p in ("in", "on")), None)
        return [(into, None)] if wants_place and into and not unit.relations else []
