"""States that are asked for or about: *the door is open*, *get the water boiling*, *there is milk in the cup*."""

from __future__ import annotations

from collections.abc import Sequence

from tmd.goals.clause_goal import ClauseReading, Refused, Why, text_of
from tmd.goals.grounder import TRUE, conjunction, disjunction
from tmd.goals.reading.nouns import Mode, Referent
from tmd.goals.reading.referents import Referents
from tmd.goals.sources.table import GoalRow, Slot
from tmd.language.clause import PERSONS
from tmd.language.syntax.pronouns import is_pronoun
from tmd.pddl.model import Atom, Formula

BE = "be"
"""The verb of a state."""


class States:
    """Reads states as conditions.

    Args:
        referents: What nouns mean.
    """

    def __init__(self, referents: Referents) -> None:
        self.referents = referents
        self.world = referents.world
        self.grounder = referents.grounder
        self.nouns = referents.nouns

    def read(self, reading: ClauseReading) -> Formula | Refused:
        """What is to be so: *the door is open*, *get the water boiling*, *there is milk in the cup*."""
        clause = reading.clause
        names = [n for n in (clause.direct or clause.objects[:1]) if n not in PERSONS] or [""]
        formulas = []
        for noun in names:
            found = self._state_of(noun, reading)
            if isinstance(found, Refused):
                return found
            formulas.append(found)
        return conjunction(formulas)

    def _state_of(self, noun: str, reading: ClauseReading) -> Formula | Refused:
        clause = reading.clause
        relations = self.referents.relations_of(noun, clause)
        constants = self._substance(noun, reading) if noun and not is_pronoun(noun) else ()
        if constants:
            return self._substance_state(noun, constants, relations, reading)
        row = GoalRow((BE,), (Slot("?x"),), TRUE, BE)
        failure: Refused | None = None
        for referent in self.referents.referents(noun, row, row.slots[0], (), reading):
            if not referent.names:
                failure = failure or self.referents.missing(referent, reading)
                continue
            found = self._thing_state(referent, relations, reading)
            if not isinstance(found, Refused):
                reading.meant[referent.noun] = referent.names
                return found
            failure = failure or found
        return failure or self.referents.missing(Referent(noun or "it", ()), reading)

    def _substance(self, noun: str, reading: ClauseReading) -> tuple[str, ...]:
        """The constants that a noun names where it names no object."""
        objects = [n for n in self.nouns.things(noun, reading.state) if n not in self.world.profiles.constants]
        matches = self.world.mentions.of(noun, reading.state)
        contained = bool(matches) and all(match.how == "contained" for match in matches)
        return self.nouns.constants(noun, ("object",), reading.state) if contained or not objects else ()

    def _thing_state(
        self, referent: Referent, relations: Sequence[tuple[str, str]], reading: ClauseReading
    ) -> Formula | Refused:
        result = reading.clause.result
        parts: dict[str, list[Formula]] = {name: [] for name in referent.names}
        for name, said in parts.items():
            if result:
                formula = self.nouns.attribute(result, name, reading.moments)
                if formula is None:
                    continue
                said.append(formula)
            for relation, target in relations:
                targets = self.referents.targets(target, reading)
                said.append(
                    disjunction(self.nouns.related(relation, name, t, reading.moments) for t in targets if t != name)
                )
            if not result and not relations:
                said.append(TRUE)
        alive = [conjunction(said) for said in parts.values() if said]
        if not alive:
            return Refused(
                Why.NOT_UNDERSTOOD,
                f"nothing here says whether {referent.noun.replace('_', ' ')} is {str(result).replace('_', ' ')}",
                "declare the adjective under 'attributes' in lexicon.yaml",
            )
        return conjunction(alive) if referent.mode is Mode.ALL else disjunction(alive)

    def _substance_state(
        self, noun: str, constants: Sequence[str], relations: Sequence[tuple[str, str]], reading: ClauseReading
    ) -> Formula | Refused:
        """A substance is where it is contained, and as that is."""
        result = reading.clause.result
        attributes = [*([result] if result else []), *reading.clause.phrase(noun).attributes]
        targets = [self.referents.targets(target, reading) for relation, target in relations]
        bound = reading.memory.bound.get(noun)
        ways = []
        for constant in constants:
            for atom in self.nouns.facts_about(constant):
                things = [a for a in atom.args if a not in self.world.profiles.constants]
                if len(things) != 1 or atom not in self.world.task.index:
                    continue
                if any(things[0] not in names for names in targets):
                    continue
                if not targets and bound is not None and bound.containers and things[0] not in bound.containers:
                    continue
                said = [self.nouns.attribute(word, things[0], reading.moments) for word in attributes]
                if all(f is not None for f in said):
                    ways.append(conjunction((Atom(atom.predicate, atom.args), *(f for f in said if f is not None))))
        if not ways:
            return Refused(Why.NOT_UNDERSTOOD, f"'{text_of(reading.clause)}' says nothing that could be checked here")
        reading.meant[noun] = tuple(constants)
        return disjunction(ways)
