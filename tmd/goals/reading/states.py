"""States that a clause says to be so, or to become so."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tmd.diagnostics import Refusal, RefusalKind
from tmd.goals.clause_goal import ClauseReading, text_of, words
from tmd.goals.grounder import Moments
from tmd.goals.reading.noun_phrases import Bound, Mode, Referent, so_many_of
from tmd.goals.reading.referents import ANY_TYPE, Referents
from tmd.goals.sources.table import GoalRow, Slot
from tmd.goals.words import BE, IT, NEGATED, is_noun, is_pronoun, is_relation, is_verb, the_word
from tmd.language.clause import PERSONS, Relation
from tmd.pddl.ground_formula import FALSE, TRUE, conjunction, disjunction, negation
from tmd.pddl.model import Atom, Formula
from tmd.world.world import CONTAINED

_ROW = GoalRow((BE,), (Slot("?x"),), TRUE, BE)


class States:
    """Reads states as conditions.

    Args:
        referents: Finds what nouns mean.
    """

    def __init__(self, referents: Referents) -> None:
        self.referents = referents
        self.world = referents.world
        self.grounder = referents.grounder
        self.nouns = referents.nouns

    def read(self, reading: ClauseReading) -> Formula | Refusal:
        """Return what is to be so: *the door is open*, *get the water boiling*, *there is milk in the cup*."""
        clause = reading.clause
        formulas = []
        for noun in [n for n in (clause.direct or clause.objects[:1]) if n not in PERSONS] or [""]:
            found = self._state_of(noun, reading)
            if isinstance(found, Refusal):
                return found
            formulas.append(found)
        return conjunction(formulas)

    def _state_of(self, noun: str, reading: ClauseReading) -> Formula | Refusal:
        said = self.referents.relations_of(noun, reading.clause)
        relations = [pair for pair in said if not is_relation(pair[0], "excepting")]
        if is_noun(noun, "some") and relations and not reading.clause.result:
            return conjunction(self._something_at(relation, target, reading) for relation, target in relations)
        constants = self._substance(noun, reading) if noun and not is_pronoun(noun) else ()
        if constants and any(self._contained(constants, fixed=True)):
            return self._substance_state(noun, constants, relations, reading)
        # where "every book on the desk" is tells which books; it is not what is asked for
        relations = [(r, t) for r, t in relations if Relation(r, noun, t) not in reading.clause.stated]
        return self._object_state(noun, relations, [pair for pair in said if pair not in relations], reading)

    def _object_state(
        self,
        noun: str,
        relations: Sequence[tuple[str, str]],
        excepted: Sequence[tuple[str, str]],
        reading: ClauseReading,
    ) -> Formula | Refusal:
        """Return that an object is as the clause says."""
        failure: Refusal | None = None
        found: list[tuple[Formula, Referent]] = []
        for referent in self.referents.referents(noun, _ROW, _ROW.slots[0], excepted, reading):
            referent, left = self._called_by(referent, relations, reading)
            state = self._thing_state(referent, left, reading)
            if isinstance(state, Refusal):
                failure = failure or state
            else:
                found.append((state, referent))
        if not found:
            return failure or self.referents.missing(Referent(noun or IT, ()), reading)
        back = self.referents.points_back(noun)
        formula, referent = self._likeliest(found, reading) if back else found[0]
        if back and formula == TRUE and reading.clause.result:
            return self._unsaid(referent, reading)  # nothing that a pronoun may mean can be otherwise
        reading.meant[referent.noun] = referent.names
        return formula

    def _likeliest(self, found: Sequence[tuple[Formula, Referent]], reading: ClauseReading) -> tuple[Formula, Referent]:
        """Return of what a pronoun may mean what can be so and otherwise; what is so by now, if it is left so."""
        fitting = [each for each in found if each[0] not in (TRUE, FALSE)] or found
        clause = reading.clause
        if is_verb(clause.verb, "leaving"):
            so = not (clause.result or "").startswith(NEGATED)
            fitting = [each for each in fitting if self.grounder.truth(each[0], reading.state) == so] or fitting
            inner, then = fitting[0][1].names, Moments(reading.memory.first, reading.memory.first)
            inside = the_word("relations", "inside")
            held = (each for each in fitting[1:] if self.nouns.related_now(inner, inside, each[1].names, then))
            return next(held, fitting[0])  # "take the milk out of the fridge and leave it open"
        return fitting[0]

    def _substance(self, noun: str, reading: ClauseReading) -> tuple[str, ...]:
        """Return the constants that a noun names where it names no object."""
        matches = self.world.mentions.of(noun, reading.state)
        contained = bool(matches) and all(match.how == CONTAINED for match in matches)
        named = any(not self.nouns.is_constant(n) for n in self.nouns.things(noun, reading.state))
        return self.nouns.constants(noun, ANY_TYPE, reading.state) if contained or not named else ()

    def _thing_state(
        self, referent: Referent, relations: Sequence[tuple[str, str]], reading: ClauseReading
    ) -> Formula | Refusal:
        if not referent.names:
            return self.referents.missing(referent, reading)
        result = reading.clause.result
        alive: list[Formula] = []
        for name in referent.names:
            state = self.nouns.attribute(result, name, reading.moments) if result else TRUE
            if state is not None:
                related = list(self._all_related(name, relations, reading))
                if referent.mode is Mode.NONE and FALSE in related:
                    continue  # "no tube without a label": nothing that can be looked at
                alive.append(conjunction((state, *related)))
        if not alive:
            return self._unsaid(referent, reading)
        if referent.mode is Mode.NUMBER:  # "two lamps are on"
            return so_many_of(alive, referent.number)
        return conjunction(alive) if referent.mode is Mode.ALL else disjunction(alive)

    def _all_related(
        self, name: str, relations: Sequence[tuple[str, str]], reading: ClauseReading
    ) -> Iterator[Formula]:
        """Yield that a thing is in each relation that was said."""
        for relation, target in relations:
            if is_noun(target, "some"):
                yield self._something(relation, name, reading)
                continue
            ends = self._ends(name, relation, target, reading)
            if ends or not is_relation(relation, "benefit"):  # "for my mother"
                yield self._stands(name, relation, ends, reading)

    def _called_by(
        self, referent: Referent, relations: Sequence[tuple[str, str]], reading: ClauseReading
    ) -> tuple[Referent, list[tuple[str, str]]]:
        """Return the candidates that relations single out, and the others: "if the window in room 3 is open"."""
        left = []
        for said in relations:
            called = self.referents.called_by(referent, said, reading)
            referent = referent.only(called) if called else referent
            left += [] if called else [said]
        return referent, left

    def _ends(self, thing: str, relation: str, target: str, reading: ClauseReading) -> tuple[str, ...]:
        """Return what a thing is related to: of what a pronoun may mean, the first that it can be related to."""
        options = list(self.referents.target_options(target, reading))
        fitting = (names for names in options if self._related(thing, relation, names, reading) != FALSE)
        return next(fitting, options[0] if options else ())

    def _unsaid(self, referent: Referent, reading: ClauseReading) -> Refusal:
        message = f"nothing here says whether {words(referent.noun)} is {words(str(reading.clause.result))}"
        hint = "declare the adjective under 'attributes' in lexicon.yaml"
        return Refusal(RefusalKind.NOT_UNDERSTOOD, message, hint)

    def _something_at(self, relation: str, target: str, reading: ClauseReading) -> Formula:
        """Return that anything is at what a noun means; a pronoun means the first that can hold things."""
        found = (
            disjunction(
                self._something(relation, place, reading) for place in places if not self.nouns.is_constant(place)
            )
            for places in self.referents.target_options(target, reading)
        )
        return next((formula for formula in found if formula != FALSE), FALSE)

    def _something(self, relation: str, place: str, reading: ClauseReading) -> Formula:
        """Return that there is anything in or on a place: an object that is no part of it, or a substance."""
        profiles, inside = self.world.profiles, the_word("relations", "inside")
        relation = inside if is_relation(relation, "accompanying") else relation  # "the cup has something in it"
        others = (n for n in profiles.objects if n != place and profiles.wholes.get(n) != place)
        related = (self.nouns.related(relation, other, place, reading.moments) for other in others)
        held = (a for a in self.nouns.facts_about(place) if a.args[0] == place and a in self.world.task.index)
        contents = [Atom(a.predicate, a.args) for a in held if len(a.args) == 2 and self.nouns.is_constant(a.args[1])]
        things = [formula for formula in related if formula != TRUE]
        return disjunction((*things, *(contents if is_relation(relation, "inside") else ())))

    def _stands(self, thing: str, relation: str, places: Sequence[str], reading: ClauseReading) -> Formula:
        """Return that a thing is at one of some places; that it is at none of those it is out of."""
        there = self._related(thing, relation, places, reading)
        return negation(there) if places and is_relation(relation, "origin") else there

    def _related(self, thing: str, relation: str, places: Sequence[str], reading: ClauseReading) -> Formula:
        return disjunction(self.nouns.related(relation, thing, p, reading.moments) for p in places if p != thing)

    def _substance_state(
        self, noun: str, constants: Sequence[str], relations: Sequence[tuple[str, str]], reading: ClauseReading
    ) -> Formula | Refusal:
        """Return that a substance is where it is contained, and as that is: *the beer on the shelf*."""
        result = reading.clause.result
        adjectives = [*filter(None, [result]), *reading.clause.phrase(noun).attributes]
        targets = [(relation, self.referents.targets(target, reading)) for relation, target in relations]
        bound = reading.memory.bound.get(noun, Bound(()))
        known = () if targets else bound.containers
        # "if there is any sugar", in the bowl that always has some
        contained = self._contained(constants, fixed=bool(targets) or not adjectives)
        ways = []
        for thing, held in contained:
            placed = [TRUE if thing in names else self._stands(thing, r, names, reading) for r, names in targets]
            said = [self.nouns.attribute(word, thing, reading.moments) for word in adjectives]
            told = [f for f in said if f is not None]
            if thing in (known or (thing,)) and FALSE not in placed and len(told) == len(said):
                ways.append(conjunction((held, *placed, *told)))
        if not ways:
            message = f"'{text_of(reading.clause)}' says nothing that could be checked here"
            return Refusal(RefusalKind.NOT_UNDERSTOOD, message)
        reading.meant[noun] = tuple(constants)
        return disjunction(ways)

    def _contained(self, constants: Sequence[str], *, fixed: bool) -> Iterator[tuple[str, Formula]]:
        """Yield the things that may contain one of some substances, each with the fact that it does."""
        for atom in (atom for constant in constants for atom in self.nouns.facts_about(constant)):
            things = [a for a in atom.args if not self.nouns.is_constant(a)]
            changes = atom in self.world.task.index
            if len(things) == 1 and (changes or (fixed and atom in self.world.task.static)):
                yield things[0], Atom(atom.predicate, atom.args) if changes else TRUE
