"""The meaning of the noun phrases of a clause: which things of the environment, and how many of them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

from tmd.diagnostics import Refusal, RefusalKind
from tmd.goals.clause_goal import ClauseReading, Unit, words
from tmd.goals.grounder import Grounder, Moments
from tmd.goals.preferences import AS_BEFORE, NOT_LEFT, SUBSTANCES, THINGS, Context, choose
from tmd.goals.reading.noun_phrases import Bound, Memory, Mode, Nouns, Referent, mode_of
from tmd.goals.sources.table import ACTIONS, GoalRow, GoalTable, Slot, slot_types
from tmd.goals.words import (
    IT,
    NEGATED,
    ONE,
    SETTING,
    ends_as,
    is_noun,
    is_one,
    is_pronoun,
    is_relation,
    is_unknown_relation,
    position,
    table,
    the_word,
    words_of,
)
from tmd.language.clause import PERSONS, TO, Clause, Mood, NounPhrase, Quantifier, Relation
from tmd.language.lexicon.lexicon import Lexicon, section
from tmd.language.lexicon.names import split_name, words_in_name
from tmd.language.lexicon.nouns import ALIAS
from tmd.pddl.model import OBJECT
from tmd.pddl.task import Bits
from tmd.world.world import World

ANY_TYPE = (OBJECT,)
_PARTITIVE = words_of("relations", "partitive")


class Referents:
    """Finds what noun phrases mean in one environment.

    Args:
        world: The environment.
        table: The meanings of adjectives and groups.
        lexicon: The domain's words.
        grounder: Grounds conditions.
        guess: Whether a thing may be taken for what a noun is only like in meaning.
    """

    def __init__(
        self, world: World, table: GoalTable, lexicon: Lexicon, grounder: Grounder, *, guess: bool = False
    ) -> None:
        self.world = world
        self.lexicon = lexicon
        self.domain = world.domain
        self.grounder = grounder
        self.nouns = Nouns(world, table, grounder, guess=guess)

    # ------------------------------------------------------------------ relations of a clause

    def relations_of(self, name: str, clause: Clause) -> list[tuple[str, str]]:
        """Return the relations in which a noun stands, each with what it is related to."""
        said = tuple(dict.fromkeys((*self.without_rooms(clause), *clause.stated)))
        found = [(r.relation, r.target) for r in said if r.source == name or (r.source is None and not name)]
        if clause.setting and name in (*clause.direct, ""):
            found.append((SETTING, clause.setting.split()[-1]))
        found = self._measured(found, clause)
        found = [pair for pair in found if not is_relation(pair[0], "excepting")] + _exceptions(name, said, clause)
        return [self._received(r, t, clause) for r, t in found if t not in PERSONS or self._somebody(t, clause)]

    def _received(self, relation: str, target: str, clause: Clause) -> tuple[str, str]:
        """Return "for Ann", where she is here, as to her."""
        name = self._somebody(target, clause) if target in PERSONS else target
        benefit = is_relation(relation, "benefit") and self.is_person(name)
        return (TO if benefit else relation), name

    def _somebody(self, pronoun: str, clause: Clause) -> str:
        """Return the noun of a person who is here that *him* or *her* stands for; empty for nobody."""
        return next(filter(self.is_person, clause.antecedents.get(pronoun, ())), "")

    def is_person(self, noun: str) -> bool:
        """Return whether a noun names somebody who is here."""
        kinds = self.world.mentions.types
        named = self.nouns.things(noun, 0) if noun not in PERSONS else ()
        return any(not section("people").isdisjoint(kinds.get(name, ())) for name in named)

    def _measured(self, relations: Sequence[tuple[str, str]], clause: Clause) -> list[tuple[str, str]]:
        """Return relations to what measures hold: "coffee with two spoons of sugar" is with sugar."""
        contents = {r.source: r.target for r in clause.relations if is_relation(r.relation, "partitive")}
        measures = words_of("measures")
        return [
            (r, contents.get(t, t) if is_relation(r, "accompanying") or (t in measures and r not in _PARTITIVE) else t)
            for r, t in relations
        ]

    def without_rooms(self, clause: Clause) -> Sequence[Relation]:
        """Return all relations but that to the room, where everything is: "in the room on the shelf" is on the shelf.

        So is what is "in here", where nothing was spoken of.

        Where a thing is to be put nowhere else, the room stays, and nothing is called so.
        """
        rooms = [r for r in clause.relations if is_relation(r.relation, "inside") and self._is_here(r.target, clause)]
        inside = {r.target: r.source for r in rooms}
        others = [r for r in clause.relations if r.target not in inside]
        if not others and clause.verb in section("placing"):
            return clause.relations
        return [r._replace(source=inside.get(r.source, r.source) if r.source else None) for r in others]

    def _is_here(self, noun: str, clause: Clause) -> bool:
        if is_noun(noun, "singular"):
            return not clause.antecedents.get(noun)
        return noun in words_of("rooms") and not self.nouns.things(noun, 0)

    def units(self, reading: ClauseReading) -> list[Unit]:
        """Return what the verb acts on, one by one, with the relations of each."""
        clause = reading.clause
        direct, none = self._acted_on(clause)
        units = [unit for name in direct for unit in self._portions(Unit(name, self.relations_of(name, clause)))]
        without = the_word("relations", "lacking")
        for unit in units:
            unit.relations = self._lacking(unit.relations, clause)
            unit.relations += [(without, name) for name in none]
            self._make_room(unit, clause)
            unit.relations = [p for pair in unit.relations for p in self._whereabouts(*pair, reading)]
            unit.relations = self._with_origins(unit, reading)
            unit.relations = unit.relations or self._of_wholes(unit.direct, clause)
        if clause.implied:
            # "pillows and blanket on the sofa": what has no place of its own goes where the next one does
            for unit, following in reversed(list(pairwise(units))):
                unit.relations = unit.relations or list(following.relations)
        return units or [Unit(None, [(r.relation, r.target) for r in clause.relations if r.source is None])]

    def _with_origins(self, unit: Unit, reading: ClauseReading) -> list[tuple[str, str]]:
        """Return what holds a substance that goes elsewhere as where it comes from.

        *Pour the water in the pot into the cup* is from the pot.
        """
        origin = table("relations")["origin"][0]
        goes = any(r in section("arrivals") - section("static") for r, _ in unit.relations)
        stuff = self.nouns.substances(unit.direct or "") if goes else ()

        def comes(relation: str, target: str) -> bool:
            inside = is_relation(relation, "inside") and relation in section("static")
            return inside and bool(
                self.nouns.related_now(stuff, relation, self.targets(target, reading), reading.moments)
            )

        return [(origin if stuff and comes(r, t) else r, t) for r, t in unit.relations]

    def _of_wholes(self, noun: str | None, clause: Clause) -> list[tuple[str, str]]:
        """Return that a part belongs to the things that facts speak of by it: the dock doors are those of the docks."""
        part = self.likeliest(noun, clause) if noun else ""
        return [(the_word("relations", "partitive"), part)] if part and self.nouns.is_only_told_of(part) else []

    def likeliest(self, noun: str, clause: Clause) -> str:
        """Return the noun that a pronoun most likely stands for; a noun itself."""
        return next(iter(clause.antecedents.get(noun, ())), noun) if self._is_pronoun(noun) else noun

    @staticmethod
    def _portions(unit: Unit) -> list[Unit]:
        """Return a measure of several things as one of each: "a scoop of vanilla and a scoop of chocolate"."""
        inner = [pair for pair in unit.relations if is_relation(pair[0], "partitive")]
        if len(inner) < 2 or unit.direct not in words_of("measures"):
            return [unit]
        others = [pair for pair in unit.relations if pair not in inner]
        return [Unit(unit.direct, [pair, *others]) for pair in inner]

    def _acted_on(self, clause: Clause) -> tuple[list[str], list[str]]:
        """Return what the verb acts on, and what shall not be there: "coffee, no sugar"."""
        named = [name for name in clause.direct if name not in PERSONS]
        some = [name for name in named if not is_none(name, clause)]
        if not named and "" in clause.antecedents:
            return [""], []
        return (some, [name for name in named if name not in some]) if some else (named, [])

    def _make_room(self, unit: Unit, clause: Clause) -> None:
        """Let a measure make room for what it measures: *a spoon of sugar* is sugar, *the contents* are all of it."""
        measured = self.measured(unit, clause)
        noun = unit.direct or ""
        if measured is not None and is_noun(noun, "content") and not self.nouns.things(noun, 0):
            inside, unit.direct = the_word("relations", "inside"), the_word("nouns", "whole")
            unit.relations = [(inside if is_relation(r, "partitive") else r, t) for r, t in unit.relations]
        if unit.direct in words_of("measures") and measured is not None:
            unit.direct, unit.relations = measured.direct, measured.relations

    def measured(self, unit: Unit, clause: Clause) -> Unit | None:
        """Return what is measured, *sugar* of *a spoon of sugar*, with all that is said of both."""
        inner = next((t for r, t in unit.relations if is_relation(r, "partitive")), None)
        others = [(r, t) for r, t in unit.relations if not is_relation(r, "partitive")]
        return Unit(inner, others + self.relations_of(inner, clause)) if inner is not None else None

    def _lacking(self, relations: Sequence[tuple[str, str]], clause: Clause) -> list[tuple[str, str]]:
        """Return relations with *without* for what is joined to a place: "in the bowl, no raspberry"."""
        none = {t for _, t in relations if is_none(t, clause)}
        places = {r for r, t in relations if t not in none}
        without = the_word("relations", "lacking")
        return [(without if t in none and r in places else r, t) for r, t in relations]

    def _whereabouts(self, relation: str, target: str, reading: ClauseReading) -> list[tuple[str, str]]:
        """Return where something is now, for "where the plate is"; any other relation as it was said.

        Where there is no plate, that is a place that nothing is known of.
        """
        if not is_relation(relation, "locating") or reading.clause.mood is Mood.KEEP:
            return [(relation, target)]
        names = self.targets(target, reading)[:1]
        places = (place for name in names for place in self._places_of(name, reading))
        return [next(places, (relation if names else the_word("relations", "inside"), target))]

    def _places_of(self, name: str, reading: ClauseReading) -> Iterator[tuple[str, str]]:
        """Yield where a thing is now, as relations and places."""
        resting = sorted(words_of("relations", "resting"))
        about = (f for f in self.nouns.facts_about(name) if f.args[0] == name)
        now = [f for f in about if self.grounder.holds(f, reading.state)]
        for fact, other in [(each, place) for each in now for place in each.args[1:]]:
            is_place = not self.nouns.is_constant(other) or other in self.nouns.places
            for where in [r for r in resting if r in fact.args] or resting:
                if is_place and self.nouns.related_now((name,), where, (other,), reading.moments):
                    yield where, other

    def reattached(self, reading: ClauseReading) -> Clause:
        """Return the clause with the last of two places as the destination: "the cup on the table in the sink".

        The parser takes that for a table in the sink. It is not where the first place tells which cup is meant, and the
        table is in no sink.
        """
        clause = reading.clause
        found = [self._from_there(relation, reading) for relation in clause.relations]
        placing = clause.verb in section("placing")
        for number, relation in enumerate(clause.relations if placing else ()):
            source = relation.source or ""
            hosts = [r for r in clause.relations if r.target == source and r.source in clause.direct]
            if not is_relation(relation.relation, "place") or not hosts or source in clause.direct:
                continue
            if self._goes_elsewhere(relation, hosts, reading):
                found[number] = relation._replace(source=hosts[0].source)
                found += [relation._replace(source=host.source) for host in hosts[1:]]
        return replace(clause, relations=tuple(found)) if found != list(clause.relations) else clause

    def _from_there(self, origin: Relation, reading: ClauseReading) -> Relation:
        """Return an origin as that of the place before it, if only that is there: "into the mug from the shelf"."""
        if not is_relation(origin.relation, "origin"):
            return origin
        own = [r for r in reading.clause.relations if r.source == origin.source and is_relation(r.relation, "place")]
        hosts = (origin.source, *(r.target for r in own))
        there = (host for host in hosts if self.tells_which(host, origin.relation, origin.target, reading))
        return origin._replace(source=next(there, origin.source))

    def _goes_elsewhere(self, relation: Relation, hosts: Sequence[Relation], reading: ClauseReading) -> bool:
        """Return whether a place is no place of its host, which tells already which thing is meant."""
        target = self.targets(relation.target, reading)
        places = self.targets(relation.source or "", reading)
        now = self.nouns.related_now(places, relation.relation, target, reading.moments)
        tells = all(self.tells_which(h.source, h.relation, h.target, reading) for h in hosts)
        return bool(target) and not now and tells

    def tells_which(self, noun: str | None, relation: str, target: str, reading: ClauseReading) -> bool:
        """Return whether a relation of what is acted on holds now of one of its candidates."""
        if not noun:
            return False
        if is_one(noun) and self._is_pronoun(noun):  # "the one in the sink goes on the shelf", of mugs
            antecedent = next(iter(reading.clause.antecedents.get(noun, ())), noun)
            noun = self._kind_of_one(antecedent, [(relation, target)], reading)
        return self._tells(noun, relation, target, reading)

    def _tells(self, noun: str, relation: str, target: str, reading: ClauseReading) -> bool:
        said, referent = (relation, target), Referent(noun, self.nouns.things(noun, reading.state))
        if relation in section("arrivals") - section("static"):  # "into the bowl" says where something goes
            return bool(self.called_by(referent, said, reading))
        return bool(self._described(referent, said, reading))

    def _described(self, referent: Referent, said: tuple[str, str], reading: ClauseReading) -> tuple[str, ...]:
        """Return the candidates that stand in a relation, or else those whose names have its target."""
        found = self.described(referent, said[0], self.targets(said[1], reading), reading)
        return found or self.called_by(referent, said, reading)

    def called_by(self, referent: Referent, said: tuple[str, str], reading: ClauseReading) -> tuple[str, ...]:
        """Return the candidates that are the target: by a word of their names, or because only they have such a part.

        *The letter to Smith* is ``letter-smith``.
        """
        relation, target = said
        names = self.targets(target, reading)
        unlike = is_relation(relation, "excepting") or is_relation(relation, "lacking")
        if unlike or not set(names) <= set(referent.names):
            return ()
        told_of = self.nouns.is_only_told_of(referent.noun)  # "the lamps in all rooms", of which facts say `lamp_on`
        alone = len(names) < len(referent.names) and not self._is_kind(split_name(target)[-1], names)
        return names if told_of or alone else ()

    def described(
        self, referent: Referent, relation: str, targets: Sequence[str], reading: ClauseReading
    ) -> tuple[str, ...]:
        """Return the candidates that stand in a relation now, or where none does, those that stood in it at first.

        *Clear the table. What is on it goes on the shelf.* Of several things that one is meant that stood there all
        along: *The mug in the sink goes on the shelf, and the mug on the shelf in the sink.*
        """
        first = reading.memory.first
        then = self.nouns.related_now(referent.names, relation, targets, Moments(first, first))
        now = self.nouns.related_now(referent.names, relation, targets, reading.moments)
        one = referent.definite and referent.mode is Mode.ANY
        return (tuple(n for n in now if n in then) if one else ()) or now or then

    def unplaced(self, unit: Unit, relation: str, target: str, reading: ClauseReading) -> bool:
        """Return whether a relation says a place where what is acted on is not yet."""
        if relation.startswith(NEGATED):
            return False
        unplaced = is_relation(relation, "unplaced") or is_unknown_relation(relation)
        place = unplaced and bool(self.targets(target, reading))
        return place and not self.tells_which(unit.direct, relation, target, reading)

    # ------------------------------------------------------------------ pronouns

    def points_back(self, noun: str) -> bool:
        """Return whether a noun, or its absence, stands for something that was spoken of."""
        return not noun or self._is_pronoun(noun) or noun in words_of("anaphors")

    def _is_pronoun(self, noun: str) -> bool:
        """Return whether a noun is a pronoun, and no name of the domain: ``red_one: [red_block]``."""
        return is_pronoun(noun) and noun not in self.lexicon.nouns

    def puts_back(self, reading: ClauseReading) -> bool:
        """Return whether things go where they were: the milk is its carton then, and not the cup that has some."""
        verb = reading.clause.verb
        return any(ends_as(name, "back") for name in (verb, self.lexicon.canonical_verb(verb)))

    def antecedents(self, noun: str, reading: ClauseReading) -> list[tuple[str, bool]]:
        """Return what a pronoun may mean, likeliest first: nouns, then (marked) objects that were spoken of."""
        clause, memory = reading.clause, reading.memory
        if noun in clause.antecedents and clause.together.get(noun, 1) > 1:
            return [(noun, False) for _ in self._groups(noun, clause)]
        nouns = list(clause.antecedents.get(noun, ()))
        if self.puts_back(reading):  # "pour some milk in the bowl and put it back in the fridge": it was in the fridge
            nouns.sort(key=lambda name: not self._were_there(name, noun, reading))
        nouns.sort(key=self.nouns.is_only_told_of)  # "put the cover on the boat and move it": the boat
        seen = {n for name in nouns if name in memory.bound for n in memory.bound[name].names}
        return [*((name, False) for name in nouns), *((name, True) for name in memory.recent if name not in seen)]

    @staticmethod
    def _groups(noun: str, clause: Clause) -> list[tuple[str, ...]]:
        """Return what *them* may mean together: what was acted on, or the other things that were spoken of.

        *Put the milk in the fridge and the noodles in the cupboard, and close them.*
        """
        names, count = clause.antecedents[noun], clause.together[noun]
        return [names[:count], names[count:]] if len(names) > count + 1 else [names[:count]]

    def _were_there(self, antecedent: str, pronoun: str, reading: ClauseReading) -> tuple[str, ...]:
        """Return what was spoken of and was, before anything was done, where the pronoun shall be put."""
        moments = replace(reading.moments, now=reading.memory.first)
        things = self.nouns.things(antecedent, reading.memory.first)
        places = [(r, p) for r, p in self.relations_of(pronoun, reading.clause) if is_relation(r, "place")]
        found = (self.nouns.related_now(things, r, self.targets(place, reading), moments) for r, place in places)
        return next(filter(None, found), ())

    def referents(
        self, noun: str, row: GoalRow, slot: Slot, relations: Sequence[tuple[str, str]], reading: ClauseReading
    ) -> list[Referent]:
        """Return what may stand in a slot, likeliest first: one for a noun, one for each antecedent of a pronoun."""
        types = slot_types(row, slot, self.domain)
        clause = reading.clause
        if not self.points_back(noun):
            phrase = clause.phrase(noun)
            # "the lids on the pots": one on each
            place = slot.is_place and not (row.noun and row.source == ACTIONS)
            found = [self._named(noun, phrase, types, relations, reading, place=place)]
            plain = not (phrase.attributes or relations) and phrase.quantifier is Quantifier.ALL
            mixed = self._brought_together(types, reading) if plain and is_noun(noun, "everything") else ()
            return [Referent(noun, mixed, definite=True), *found] if mixed else found
        if noun in clause.antecedents and clause.together.get(noun, 1) > 1:
            found = [self._together(noun, types, reading)]
        else:
            found = self._meant_by_pronoun(noun, types, reading)
        phrase = clause.phrase(noun)
        if phrase.quantifier in (Quantifier.SOME, Quantifier.NUMBER) and not is_one(noun):  # "one of them"
            mode, number = mode_of(phrase, group=False, thing=True)
            found = [replace(referent, mode=mode, number=number, definite=False) for referent in found]
        return found

    def _meant_by_pronoun(self, noun: str, types: tuple[str, ...], reading: ClauseReading) -> list[Referent]:
        options = self.antecedents(noun, reading)
        if reading.antecedent is not None and noun == reading.pronoun:
            options = options[reading.antecedent : reading.antecedent + 1]
        meant = (
            self._of_object(name, noun, types, reading) if is_object else self._antecedent(name, noun, types, reading)
            for name, is_object in options
        )
        return [referent for referent in meant if referent.names] or [Referent(noun or IT, ())]

    def _of_object(self, name: str, noun: str, types: tuple[str, ...], reading: ClauseReading) -> Referent:
        """Return a pronoun as an object that was spoken of, or what that contains; "the new one" is a noun's."""
        if is_one(noun) and reading.clause.phrase(noun).attributes:
            return Referent(noun, ())
        if self.grounder.is_a(name, types):
            return Referent(noun or IT, (name,), definite=True)
        return Referent(noun or IT, self.nouns.contained((name,), types, reading.state))

    def _antecedent(self, antecedent: str, pronoun: str, types: tuple[str, ...], reading: ClauseReading) -> Referent:
        """Return a pronoun as if it stood for ``antecedent``: what that turned out to be."""
        if is_one(pronoun):
            return replace(self._one_of(antecedent, pronoun, types, reading), noun=pronoun)
        bound = reading.memory.bound.get(antecedent)
        many = not pronoun or is_noun(pronoun, "plural")  # what is left out is all that was acted on
        many = many or self.nouns.is_group(antecedent) or (bound is not None and bound.every)
        if bound is not None:
            return self._bound(antecedent, bound, types, reading, many=many)
        phrase = NounPhrase(antecedent, definite=True, plural=many)
        stated = antecedent not in reading.clause.objects  # "There is a mug on the shelf. Wash it."
        relations = self.relations_of(antecedent, reading.clause) if stated else []
        return self._named(antecedent, phrase, types, relations, reading)

    def _bound(
        self, antecedent: str, bound: Bound, types: tuple[str, ...], reading: ClauseReading, *, many: bool
    ) -> Referent:
        """Return a noun that was bound before: its objects, what they contain, or what they turned into."""
        if bound.containers and self.puts_back(reading):
            things = self._named(antecedent, NounPhrase(antecedent, definite=True), types, [], reading)
            if things.names:
                return things
        known = (*bound.names, *bound.containers)
        names = tuple(n for n in known if self.grounder.is_a(n, types))
        if not names:
            now = self.nouns.contained(known, types, reading.state)
            then = self.nouns.contained(bound.names, types, reading.memory.first)  # the egg that was in its shell
            return Referent(antecedent, now or self._by_now(then, types, reading))
        names = self._by_now(names, types, reading)
        if many and len(names) > 1:
            return Referent(antecedent, names, Mode.ALL, definite=True)
        return Referent(antecedent, names[:1], definite=True)

    def _one_of(self, antecedent: str, pronoun: str, types: tuple[str, ...], reading: ClauseReading) -> Referent:
        """Return *the other one* and *the red one* as one of what was spoken of."""
        said = reading.clause.phrase(pronoun)
        relations = self.relations_of(pronoun, reading.clause)
        bound = reading.memory.bound.get(antecedent)
        order = position(pronoun)
        if order is not None and bound is not None:  # "take both cans, and put the first on the table"
            names = bound.names if order < len(bound.names) else bound.names[:1]
            return Referent(antecedent, names[order:][:1] or names, definite=True)
        other = self._other_one(antecedent, said, types, reading) if said.other else None
        if other is not None:
            return other
        counted = "_".join((*said.attributes, split_name(antecedent)[-1]))
        if order is not None and self.nouns.things(counted, reading.state):  # "from the second shelf to the first one"
            return self._named(counted, replace(said, name=counted, attributes=()), types, relations, reading)
        if (
            pronoun == ONE and bound is not None and not relations and _is_that_one(said)
        ):  # "… the other plate. Wash that one."
            return self._antecedent(antecedent, IT, types, reading)
        return self._of_kind(antecedent, said, relations, types, reading)

    def _classes_of(self, noun: str, state: Bits) -> list[str]:
        """Return the class of what a noun means, as a noun: "wash the taxi, then vacuum the blue one"."""
        kinds = (self.world.mentions.kinds.get(name, "") for name in self.nouns.things(noun, state)[:1])
        return ["_".join(split_name(kind)) for kind in kinds if kind]

    def _of_kind(
        self,
        antecedent: str,
        said: NounPhrase,
        relations: list[tuple[str, str]],
        types: tuple[str, ...],
        reading: ClauseReading,
    ) -> Referent:
        """Return *one* as a thing like its antecedent: "take the front wheel off and put the spare one on"."""
        kind = self._kind_of_one(antecedent, relations, reading)
        told = self.relations_of(antecedent, reading.clause) if antecedent not in reading.clause.objects else []
        state = reading.state
        head = split_name(antecedent)[-1]
        own = "_".join((*said.attributes, head))  # "swap the old disk for the new one": another thing has that name
        called = said.attributes and any(words_in_name(own) <= words_in_name(n) for n in self.nouns.things(own, state))
        kinds = dict.fromkeys((*((own,) if called else ()), kind, head))
        ways = [(each, [*relations, *told]) for each in kinds]
        if told and said.attributes:  # "the battery in the van is dead, fit the new one": that is elsewhere
            ways += [(each, relations) for each in kinds]
        ways += [(each, relations) for each in self._classes_of(antecedent, state) if said.attributes]
        named = (self._named(each, replace(said, name=each), types, related, reading) for each, related in ways)
        found = next((referent for referent in named if referent.names), None)
        return found or Referent(kind, ())

    def _kind_of_one(self, noun: str, relations: Sequence[tuple[str, str]], reading: ClauseReading) -> str:
        """Return what *one* stands for: after "the roof vent", *the one on the side* is another vent."""
        kind = split_name(noun)[-1]
        told = any(self._tells(kind, *said, reading) and not self._tells(noun, *said, reading) for said in relations)
        return kind if told else noun

    def _other_one(
        self, antecedent: str, said: NounPhrase, types: tuple[str, ...], reading: ClauseReading
    ) -> Referent | None:
        """Return *the rest* of what was poured as what it came from, and *the other* as none that the clause names."""
        bound = reading.memory.bound.get(antecedent)
        gone = bound.containers if bound is not None and said.plural else ()
        if not gone and antecedent in reading.clause.phrases and antecedent not in reading.taken:
            gone = self.targets(antecedent, reading)  # "from the table with the mug to the other one"
        for kind in dict.fromkeys((antecedent, split_name(antecedent)[-1])):  # "on the tall shelf and … the other one"
            whole = self._named(kind, NounPhrase(kind, definite=said.plural), types, [], reading)
            left = [n for n in whole.names if n not in gone]
            if gone and (left or said.plural):
                return whole.only(left)
        return None

    def _together(self, pronoun: str, types: tuple[str, ...], reading: ClauseReading) -> Referent:
        groups = self._groups(pronoun, reading.clause)
        nouns = groups[reading.antecedent or 0] if pronoun == reading.pronoun else groups[0]
        all_of_them = the_word("nouns", "plural")
        found = {noun: self._antecedent(noun, all_of_them, types, reading).names for noun in nouns}
        for noun in (each for each, names in found.items() if not (names or self.nouns.guess)):
            if any(self.grounder.is_a(name, types) for name in self.targets(noun, reading)):
                return Referent(noun, ())  # a cushion on the sofa, where none is
        names = (name for each in found.values() for name in each)
        return Referent(pronoun, tuple(dict.fromkeys(names)), Mode.ALL)

    # ------------------------------------------------------------------ nouns

    def _named(
        self,
        noun: str,
        phrase: NounPhrase,
        types: tuple[str, ...],
        relations: Sequence[tuple[str, str]],
        reading: ClauseReading,
        *,
        place: bool = False,
    ) -> Referent:
        """Return the candidates of a noun of the wanted type, but for those that adjectives and relations leave out."""
        likely = self.nouns.things(noun, reading.state, place=place, types=types)
        context = Context(self, reading, noun, phrase, types, relations, place, likely)
        things = choose(THINGS, context.fitting(likely), context)
        constants = choose(SUBSTANCES, self._constants(context), context)
        objects = tuple(n for n in things if not self.nouns.is_constant(n))
        if not objects and constants:
            few = self.nouns.too_few(phrase, constants, reading.state)
            mode, number = mode_of(phrase, group=False, thing=bool(few))
            return Referent(noun, few or constants, mode, number, phrase.definite)
        if place and not objects:
            return Referent(noun, self._within(likely, types, reading))
        referent = self._counted(objects, context, certain=things == likely)
        reading.notes += self._stand_ins(noun, referent.names)
        return self._told_apart(referent, context)

    def _stand_ins(self, noun: str, names: Collection[str]) -> list[str]:
        """Return a warning where a noun is a class of the domain and only things of other classes are here."""
        mentions = self.world.mentions
        kinds = dict.fromkeys(mentions.kinds[name] for name in names if name in mentions.kinds)
        if not kinds or noun not in mentions.classes or any(noun in (n, *mentions.types.get(n, ())) for n in names):
            return []
        called = noun in self.world.profiles.objects or any(noun in kind for kind in kinds)  # a ``dispenser_fridge``
        said = f"there is no {words(noun)} here, so '{words(noun)}' is taken to mean {' or '.join(map(words, kinds))}"
        return [] if called else [said]

    def _within(self, regions: Collection[str], types: tuple[str, ...], reading: ClauseReading) -> tuple[str, ...]:
        """Return the things that always are in what a noun names: "to Paris" is to some place there."""
        names = (n for n in self.world.profiles.objects if regions and self.grounder.is_a(n, types))
        static = {
            fact for region in regions for fact in self.nouns.facts_about(region) if fact in self.world.task.static
        }
        there = {name for fact in static if len(fact.args) == 2 for name in fact.args}
        inside = the_word("relations", "inside")
        return self.nouns.related_now((n for n in names if n in there), inside, tuple(regions), reading.moments)

    def _counted(self, objects: tuple[str, ...], context: Context, *, certain: bool) -> Referent:
        """Return how many of the objects that a noun may mean are meant."""
        noun, phrase = context.noun, context.phrase
        group = self.nouns.is_group(noun) and not (context.place and noun in self.lexicon.nouns)
        mode, number = mode_of(phrase, group=group, thing=True, place=context.place)
        some = phrase.quantifier is Quantifier.SOME or phrase.other
        among = some and len(objects) == 1 and certain and not (context.relations or phrase.attributes)
        several = mode is not Mode.ANY or among
        if several and not group:  # "one of the lamps", "the other lamp": where there is but one lamp, a floor lamp
            every = mode in (Mode.ALL, Mode.NUMBER)
            objects, group = self._all_kinds(noun, objects, context.types, context.reading.state, all_of_it=every)
        if phrase.number == 2 and mode is Mode.ALL:
            mode, number, group = Mode.NUMBER if len(objects) != 2 else mode, 2, False
        return Referent(noun, objects, mode, number, _is_definite(phrase), group, phrase.each)

    def _told_apart(self, whole: Referent, context: Context) -> Referent:
        """Return the candidates that the adjectives, the relations and the rest of the text leave."""
        noun, phrase, reading = context.noun, context.phrase, context.reading
        if phrase.other:  # what was said of the first one does not tell which: "do the same with the other one"
            unspoken = self._unspoken(whole, reading)
            whole = unspoken if unspoken.names else whole
        names, unknown = self.nouns.narrowed(whole.names, phrase, reading.moments)
        clause = reading.clause
        filled = any(r.source == noun and is_relation(r.relation, "partitive") for r in clause.relations)
        if filled and whole.names and not names:
            # "a hot cup of coffee": the cup shall be so, with what is in it
            reading.wanted[noun] = phrase.attributes
            names = whole.names
        referent = self._restricted(whole.only(self._known(names, unknown, reading)), context.relations, reading, whole)
        return self._spoken_of(referent, context)

    def _known(self, names: tuple[str, ...], unknown: Sequence[str], reading: ClauseReading) -> tuple[str, ...]:
        """Return the candidates of adjectives that nothing explains: none, unless guesses are allowed."""
        if unknown and self.nouns.guess:
            reading.notes += [f"'{words(word)}' says nothing here that could be checked" for word in unknown]
        return () if unknown and not self.nouns.guess else names

    def _spoken_of(self, referent: Referent, context: Context) -> Referent:
        """Return the candidates that the rest of the text leaves."""
        noun, phrase, reading = context.noun, context.phrase, context.reading
        if referent.mode is Mode.ALL:  # "all of it to the table, but leave the bowl"
            referent = referent.only(choose(NOT_LEFT, referent.names, context))
        if noun in reading.taken:
            return referent.only(n for n in referent.names if (n == reading.taken[noun]) != phrase.other)
        if phrase.other:
            return self._other(referent, context)
        if (phrase.definite or phrase.undetermined) and referent.mode is Mode.ANY:
            return referent.only(choose(AS_BEFORE, referent.names, context))
        return referent

    def _other(self, referent: Referent, context: Context) -> Referent:
        """Return those of several things that were not spoken of; of places those where the thing is not."""
        bound = context.reading.memory.bound
        unspoken = self._unspoken(referent, context.reading)
        if unspoken.names and unspoken.names != referent.names:
            return unspoken
        if context.noun in bound:
            return referent.only(n for n in referent.names if n not in bound[context.noun].names)
        left = self._places_now(referent, context.reading) if context.place else ()
        return referent.only(n for n in referent.names if n not in left)

    def _unspoken(self, referent: Referent, reading: ClauseReading) -> Referent:
        """Return those of several things that no noun meant: "the red cup in the sink, the other cups on the table"."""
        spoken = {name for each in reading.memory.bound.values() for name in each.names}
        if referent.mode is Mode.ALL:  # "the cup in the sink and everything else on the table"
            spoken |= {name for names in reading.meant.values() for name in names}
        spoken |= {name for each in spoken for name in self.grounder.relatives(each, 1)}  # the burner of a knob
        return referent.only(n for n in referent.names if n not in spoken)

    def _constants(self, context: Context) -> tuple[str, ...]:
        """Return the constants that a noun names; *everything* is what is in something.

        That is what it is said to be in, or else what was spoken of: *Cook the noodles with an egg and serve
        everything in the bowl.*
        """
        noun, types, reading = context.noun, context.types, context.reading
        if is_noun(noun, "everything"):
            inside = (t for r, t in self.relations_of(noun, reading.clause) if is_relation(r, "inside"))
            places = (*context.targets("inside"), reading.memory.recent, *(self.targets(t, reading) for t in inside))
            names = next(filter(None, (self.nouns.contained(p, types, reading.state) for p in places)), ())
        else:
            names = self.substances(replace(context.phrase, name=noun), types, reading)
        spoken_of = noun in reading.memory.bound and not context.phrase.other
        return self._by_now(names, types, reading) if spoken_of else names

    def substances(self, phrase: NounPhrase, types: tuple[str, ...], reading: ClauseReading) -> tuple[str, ...]:
        """Return the substances that a noun phrase names: cooked noodles are another one than noodles."""
        nouns = (*(f"{word}_{phrase.name}" for word in phrase.attributes), phrase.name)
        return next(filter(None, (self.nouns.constants(n, types, reading.state) for n in nouns)), ())

    def _places_now(self, places: Referent, reading: ClauseReading) -> tuple[str, ...]:
        """Return those of some places where what the clause acts on is now."""
        moved = [n for direct in reading.clause.direct[:1] for n in self.targets(direct, reading)]
        resting = sorted(words_of("relations", "resting"))
        return tuple(
            place
            for place in places.names
            if any(self.nouns.related_now(moved, where, (place,), reading.moments) for where in resting)
        )

    def _brought_together(self, types: tuple[str, ...], reading: ClauseReading) -> tuple[str, ...]:
        """Return what holds several things that were spoken of: *add the noodles to the water, heat everything*."""
        held: dict[str, int] = {}
        for bound in reading.memory.bound.values():
            for name in bound.containers:
                held[name] = held.get(name, 0) + 1
        return tuple(n for n, count in held.items() if count > 1 and self.grounder.is_a(n, types))[-1:]

    def _by_now(self, names: tuple[str, ...], types: tuple[str, ...], reading: ClauseReading) -> tuple[str, ...]:
        """Return what was spoken of, as that which it turned into since: the noodles, when they are cooked."""

        def since(later: str) -> bool:
            fresh = (a for a in self.nouns.facts_about(later) if self.grounder.holds(a, reading.state))
            return any(not self.grounder.holds(a, reading.memory.first) for a in fresh)

        def now(name: str) -> str:
            turned = self.nouns.turns_into(name) if self.nouns.is_constant(name) else ()
            return next((n for n in turned if self.grounder.is_a(n, types) and since(n)), name)

        return tuple(dict.fromkeys(map(now, names)))

    def _all_kinds(
        self, noun: str, objects: tuple[str, ...], types: tuple[str, ...], state: Bits, *, all_of_it: bool
    ) -> tuple[tuple[str, ...], bool]:
        """Return *all the lights*, where no class has that name, as all that the noun may mean, and whether it is so.

        *Every lamp* is the floor lamp as well, which is called so; *every cup* is no bowl, which only stands in for one
        where there is none.
        """
        wider = frozenset(self.lexicon.nouns.get(noun, ()))
        if len(objects) == 1 and wider:
            if all_of_it and self._is_kind(noun, objects):
                wider = frozenset(kind for kind in wider if noun in split_name(kind))
            names = self._of_kinds(wider, types)
            return (names, True) if len(names) > 1 else (objects, False)
        matches = self.world.mentions.of(noun, state)
        if not matches or matches[0].how != ALIAS:
            return objects, False
        alike = (m.name for m in matches if m.how == ALIAS and not self.nouns.is_constant(m.name))
        return tuple(n for n in alike if self.grounder.is_a(n, types)), True

    def _of_kinds(self, wanted: frozenset[str], types: tuple[str, ...]) -> tuple[str, ...]:
        kinds = self.world.mentions.kinds
        alike = (n for n in self.world.profiles.objects if kinds.get(n) in wanted)
        return tuple(n for n in alike if self.grounder.is_a(n, types))

    def every_kind_of(self, noun: str, clause: Clause, state: Bits) -> tuple[str, ...]:
        """Return all that a noun or pronoun of a clause may mean: vanilla and chocolate, where it is *ice cream*."""
        found: dict[str, None] = {}
        for one in clause.meant(noun):
            things = self.nouns.things(one, state)
            found.update(dict.fromkeys(self._all_kinds(one, things, ANY_TYPE, state, all_of_it=False)[0]))
        return tuple(found)

    # ------------------------------------------------------------------ relations that tell which

    def _restricted(
        self, referent: Referent, relations: Sequence[tuple[str, str]], reading: ClauseReading, whole: Referent
    ) -> Referent:
        """Return the candidates that stand in the relations that were said, where some do; *except* takes some away.

        None are left where only such do that adjectives left out of the ``whole``: "the full cup on the table", where
        the cup on the table is empty.
        """
        places = self._places_of_part(referent.noun, relations)
        if places:  # "the lamps in the hall and the shed"
            found = [self._restricted(referent, [pair], reading, whole).names for pair in places]
            referent = referent.only(name for names in found for name in names)
        for said in (pair for pair in relations if pair not in places):
            referent = self._as_said(referent, said, reading, whole)
        return referent

    def _as_said(self, referent: Referent, said: tuple[str, str], reading: ClauseReading, whole: Referent) -> Referent:
        """Return the candidates that one relation leaves."""
        relation, target = said
        names = self.targets(target, reading)
        excepting = is_relation(relation, "excepting")
        if excepting and is_one(target) and self._any_one(target, reading) and referent.names:
            return replace(referent, mode=Mode.NUMBER, number=len(referent.names) - 1)  # "all but one"
        left = self._taken_away(referent, relation, target, names, reading)
        if left is not None:
            return referent.only(n for n in referent.names if n not in left)
        if is_relation(relation, "benefit"):  # "the parcel for the tailor"
            return referent.only(self.called_by(referent, said, reading) or referent.names)
        if names and not is_relation(relation, "untelling"):
            stated = Relation(relation, referent.noun, target) in reading.clause.stated
            return self._where(referent, said, reading, whole, stated=stated)
        return referent

    def _places_of_part(self, noun: str, relations: Sequence[tuple[str, str]]) -> list[tuple[str, str]]:
        """Return the places of several parts that only facts speak of; none for other nouns, and for one place."""
        places = [pair for pair in relations if is_relation(pair[0], "resting")]
        return places if len(places) > 1 and self.nouns.is_only_told_of(noun) else []

    def _taken_away(
        self, referent: Referent, relation: str, target: str, names: Sequence[str], reading: ClauseReading
    ) -> Collection[str] | None:
        """Return the candidates that a relation takes away; ``None`` for one that says where they are."""
        if is_relation(relation, "excepting"):
            return self.excepted([(relation, target)], reading)
        if relation.startswith(NEGATED) or is_none(target, reading.clause):  # "the chair that has no pillow"
            plain = relation.removeprefix(NEGATED)
            return self.nouns.related_now(referent.names, plain, names, reading.moments)
        if is_relation(relation, "partitive") and not set(names).isdisjoint(referent.names):
            return set(referent.names) - set(names)  # "the hold of the jet", which is but told of
        return None

    def _where(
        self,
        referent: Referent,
        said: tuple[str, str],
        reading: ClauseReading,
        whole: Referent,
        *,
        stated: bool,
    ) -> Referent:
        now, relation = self._described(referent, said, reading), said[0]
        if relation in table("inverse"):  # "the stove under the kettle" is a burner of it
            parts = [part for name in now for part in self.grounder.relatives(name, 0)]
            now = self.nouns.related_now(parts, relation, self.targets(said[1], reading), reading.moments) or now
        # what stands on nothing has no burner under it
        tells = stated or relation in table("inverse") or is_relation(relation, "locating") or referent.mode is Mode.ALL
        if now or tells or self._described(whole, said, reading):
            return referent.only(now)
        if whole.noun not in reading.clause.direct:  # "in the cup with the spoon", where no cup has one
            reading.notes.append(f"'{words(relation)} {words(said[1])}' says nothing here")
        return referent

    def _any_one(self, noun: str, reading: ClauseReading) -> bool:
        """Return whether any one will do: nothing was said that tells which."""
        said = reading.clause.phrase(noun)
        return not (said.definite or said.plural or said.attributes or self.relations_of(noun, reading.clause))

    def excepted(self, relations: Iterable[tuple[str, str]], reading: ClauseReading) -> tuple[str, ...]:
        """Return what *except* takes away."""
        found: dict[str, None] = {}
        for target in (target for relation, target in relations if is_relation(relation, "excepting")):
            phrase = reading.clause.phrase(target)
            alike, _ = self.nouns.narrowed(self.targets(target, reading), phrase, reading.moments)  # "the full one"
            names = self._where_it_was_said(target, alike, reading)
            if alike and not names:
                reading.notes.append("nothing here is what the exception names")
            placed = any(is_relation(relation, "place") for relation, _ in self.relations_of(target, reading.clause))
            one = is_one(target) or (placed and bool(names))  # "the bottle on the shelf"
            one = one or (phrase.definite and not phrase.plural and self._is_kind(target, names))
            wide = self.every_kind_of(target, reading.clause, reading.state)
            found.update(dict.fromkeys((*names, *(() if one else wide))))
        parts = (part for name in found for part in self.grounder.relatives(name, 0))
        return tuple(dict.fromkeys((*found, *parts)))

    def _where_it_was_said(self, noun: str, names: tuple[str, ...], reading: ClauseReading) -> tuple[str, ...]:
        """Return those things that are where the clause says: where no mug is on the table, *the one on it* is none."""
        named = self.likeliest(noun, reading.clause)
        for relation, place in self.relations_of(noun, reading.clause):
            there = is_relation(relation, "naming")  # "the one of the shed", "the one by the door"
            if there and self.targets(place, reading):
                names = self._described(Referent(named, names), (relation, place), reading)
        return names

    def _is_kind(self, noun: str, names: Iterable[str]) -> bool:
        """Return whether things are of the very class that a noun names."""
        return any(self.grounder.is_a(name, (noun,)) for name in names)

    def targets(self, noun: str, reading: ClauseReading) -> tuple[str, ...]:
        """Return the objects or constants that a noun behind a preposition may mean."""
        if noun in reading.asked:
            return ()
        reading.asked.add(noun)
        try:
            return self._pronoun_target(noun, reading) if self._is_pronoun(noun) else self._target(noun, reading)
        finally:
            reading.asked.discard(noun)

    def target_options(self, noun: str, reading: ClauseReading) -> Iterator[tuple[str, ...]]:
        """Yield what a noun may mean as the end of a relation: for a pronoun, by each of its antecedents."""
        names = self.targets(noun, reading)
        yield names
        for antecedent in reading.clause.antecedents.get(noun, ())[1:] if not is_one(noun) else ():
            yield self.targets(antecedent, reading)

    def _pronoun_target(self, noun: str, reading: ClauseReading) -> tuple[str, ...]:
        nouns = reading.clause.antecedents.get(noun, ())[:1]
        names = tuple(n for a in nouns for n in self._one_called(noun, a, reading) or self.targets(a, reading))
        if not names and is_one(noun):
            names = tuple(n for direct in reading.clause.direct[:1] for n in self.targets(direct, reading))
        for relation, target in self.relations_of(noun, reading.clause):
            ends = self.targets(target, reading)
            names = self.nouns.related_now(names, relation, ends, reading.moments) or names
        return names

    def _target(self, noun: str, reading: ClauseReading) -> tuple[str, ...]:
        bound = reading.memory.bound.get(noun)
        things = self.nouns.things(noun, reading.state)
        if bound is not None and set(bound.names) & set(things):
            return tuple(n for n in things if n in bound.names)
        alike, _ = self.nouns.narrowed(things, reading.clause.phrase(noun), reading.moments)  # "with the bent wheel"
        stuff = self.substances(replace(reading.clause.phrase(noun), name=noun), ANY_TYPE, reading)
        names = tuple(dict.fromkeys((*(alike or things), *stuff)))
        relations = self.relations_of(noun, reading.clause) if noun not in reading.clause.direct else []
        said = [(r, t) for r, t in relations if is_relation(r, "accompanying")]  # "the table with the ramen on it"
        referent = Referent(noun, names)
        return self._restricted(referent, said, reading, referent.only(())).names or names

    def _one_called(self, pronoun: str, antecedent: str, reading: ClauseReading) -> tuple[str, ...]:
        """Return what *the ceiling one* means where lamps were spoken of: a ceiling lamp."""
        modifier = pronoun.removesuffix(f"_{ONE}")
        if modifier == pronoun:
            return ()
        whole = self.nouns.things(antecedent, reading.state)
        found = self.nouns.things(f"{modifier}_{antecedent}", reading.state)
        return found if set(found) != set(whole) else ()

    # ------------------------------------------------------------------ refusals

    def not_there(self, clause: Clause) -> Refusal:
        """Return that the thing a clause acts on is not there."""
        noun = clause.direct[0] if clause.direct else IT
        return self.missing(Referent(noun, ()), ClauseReading(clause, Moments(0, 0), Memory()))

    def missing(self, referent: Referent, reading: ClauseReading) -> Refusal:
        """Return why a noun means nothing here."""
        noun, clause = referent.noun, reading.clause
        attributes = clause.phrase(noun).attributes
        said = words(" ".join((*attributes, noun)))
        known = self.nouns.things(noun, reading.state)
        if known and attributes:
            what = "nothing" if is_noun(noun, "everything") else f"no {words(noun)}"
            return Refusal(RefusalKind.NO_SUCH_THING, f"{what} here is {' and '.join(map(words, attributes))}")
        if known and any(is_relation(r, "excepting") for r, _ in self.relations_of(noun, clause)):
            return Refusal(RefusalKind.NO_SUCH_THING, f"every '{said}' that is meant here is excepted")
        place = next((r for r in clause.stated if r.source == noun), None)
        if known and place is not None:
            return Refusal(
                RefusalKind.NO_SUCH_THING, f"no {said} here is {words(place.relation)} the {words(place.target)}"
            )
        if len(known) == 1 and clause.phrase(noun).other:
            return Refusal(RefusalKind.NO_SUCH_THING, f"there is no other {said} here")
        if known:
            message = f"'{words(clause.verb)}' does not apply to '{said}' here"
            return Refusal(RefusalKind.NOT_UNDERSTOOD, message)
        return self._nothing_called(noun, said, reading)

    def _nothing_called(self, noun: str, said: str, reading: ClauseReading) -> Refusal:
        """Return that nothing has a name, or how many there are where an ordinal goes beyond."""
        first, _, rest = noun.partition("_")
        others = self.nouns.things(rest, reading.state) if rest and first in words_of("ordinals") else ()
        if others:
            count = f"are {len(others)}" if len(others) > 1 else "is one"
            return Refusal(RefusalKind.NO_SUCH_THING, f"there is no {said} here: there {count}")
        hint = "name a thing that is there, or allow guesses"
        return Refusal(RefusalKind.NO_SUCH_THING, f"nothing here is called '{said}'", hint)


def _is_definite(phrase: NounPhrase) -> bool:
    """Return whether a phrase means one particular thing; "one of the lamps" is any of them."""
    return (phrase.definite or phrase.undetermined) and phrase.quantifier is not Quantifier.SOME


def _is_that_one(said: NounPhrase) -> bool:
    """Return whether *one* is just the one that was spoken of."""
    return said.definite and said.quantifier is Quantifier.PLAIN and not (said.attributes or said.other)


def is_none(noun: str, clause: Clause) -> bool:
    """Return whether a noun was said with *no*."""
    return clause.phrase(noun).quantifier is Quantifier.NONE


def _exceptions(noun: str, said: Iterable[Relation], clause: Clause) -> list[tuple[str, str]]:
    """Return what is taken from a noun: from what is acted on, but for "into each cup except the full one".

    *The eggs in the fridge except the one on the shelf* are eggs.
    """
    found = []
    for relation in (r for r in said if is_relation(r.relation, "excepting")):
        whole = relation.source or ""
        placed = whole not in clause.direct and clause.phrase(whole).quantifier is Quantifier.ALL
        if noun == whole if placed else noun in clause.direct:
            found.append((relation.relation, relation.target))
    return found
