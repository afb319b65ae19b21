"""What the noun phrases of a clause mean: which things of the environment, and how many of them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import pairwise

from tmd.diagnostics import Refusal, RefusalKind
from tmd.goals.clause_goal import ClauseReading, Unit
from tmd.goals.grounder import Grounder, Moments
from tmd.goals.reading.noun_phrases import EVERYTHING, INVERSE, PART_OF, Memory, Mode, Nouns, Referent, mode_of
from tmd.goals.sources.table import (
    GoalRow,
    GoalTable,
    Slot,
    slot_types,
    state_words,
    words_of,
)
from tmd.language.clause import PERSONS, Clause, Mood, NounPhrase, Quantifier, Relation
from tmd.language.lexicon.lexicon import Lexicon, section
from tmd.language.lexicon.nouns import split_name
from tmd.language.syntax.antecedents import is_one, is_pronoun
from tmd.pddl.task import Bits
from tmd.veil.world import World

PLACES = frozenset({"in", "into", "inside", "on", "onto", "to", "next_to", "under", "at"})
"""Relations to where something is, or shall be."""
EXCEPTING = frozenset({"except", "besides", "apart_from"})
"""Relations to what is left out."""


class Referents:
    """Finds what noun phrases mean in one environment.

    Args:
        world: The environment.
        table: What adjectives and groups mean.
        lexicon: The domain's words.
        guess: Whether a thing may be taken for what a noun is only like in meaning.
    """

    def __init__(self, world: World, table: GoalTable, lexicon: Lexicon, *, guess: bool = False) -> None:
        self.world = world
        self.lexicon = lexicon
        self.domain = world.task.problem.domain
        self.grounder = Grounder(world)
        self.nouns = Nouns(world, table, self.grounder, guess=guess)

    def relations_of(self, name: str, clause: Clause) -> list[tuple[str, str]]:
        """The relations in which a noun stands, each with what it is related to."""
        said = self._without_rooms(clause)
        found = [(r.relation, r.target) for r in said if r.source == name or (r.source is None and not name)]
        if clause.setting and name in (*clause.direct, ""):
            found.append(("to", clause.setting.split()[-1]))
        contents = {r.source: r.target for r in clause.relations if r.relation == "of"}
        measures = words_of("measures")
        # "coffee with two spoons of sugar" is with sugar
        found = [(r, contents.get(t, t) if r == "with" or (t in measures and r != "of") else t) for r, t in found]
        return [(r, t) for r, t in found if t not in PERSONS]

    def _without_rooms(self, clause: Clause) -> Sequence[Relation]:
        """All relations but that to the room, where everything is: "in the room on the shelf" is on the shelf.

        Where a thing is to be put nowhere else, the room stays, and nothing is called so.
        """
        rooms = words_of("rooms")
        inside = {
            r.target: r.source
            for r in clause.relations
            if r.relation in ("in", "inside") and r.target in rooms and not self.nouns.things(r.target, 0)
        }
        others = [r for r in clause.relations if r.target not in inside]
        if not others and clause.verb in section("placing"):
            return clause.relations
        return [r._replace(source=inside.get(r.source, r.source) if r.source else None) for r in others]

    def units(self, reading: ClauseReading) -> list[Unit]:
        """What the verb acts on, one by one, with the relations of each; measures make room for what they measure."""
        clause = reading.clause
        direct = [name for name in clause.direct if name not in PERSONS]
        if not direct:
            direct = [""] if "" in clause.antecedents else []
        none = [name for name in direct if clause.phrase(name).quantifier is Quantifier.NONE]
        if 0 < len(none) < len(direct):
            direct = [name for name in direct if name not in none]  # "coffee, no sugar"
        units = [Unit(name, self.relations_of(name, clause)) for name in direct]
        for unit in units if len(none) and none != direct else ():
            unit.relations += [("without", name) for name in none if name not in direct]
        for unit in units:
            # "in the bowl, no raspberry": joined to a place, and no place
            places = {r for r, t in unit.relations if clause.phrase(t).quantifier is not Quantifier.NONE}
            joined = (clause.phrase(t).quantifier is Quantifier.NONE and r in places for r, t in unit.relations)
            unit.relations = [("without" if no else r, t) for (r, t), no in zip(unit.relations, joined, strict=True)]
            measured = next((t for r, t in unit.relations if r == "of"), None)
            if unit.direct in words_of("measures") and measured is not None:
                unit.relations = [(r, t) for r, t in unit.relations if r != "of"] + self.relations_of(measured, clause)
                unit.direct = measured
        for unit in units:
            unit.relations = [p for pair in unit.relations for p in self._whereabouts(*pair, reading)]
        if clause.implied:
            # "pillows and blanket on the sofa": what has no place of its own goes where the next one does
            for unit, following in reversed(list(pairwise(units))):
                unit.relations = unit.relations or list(following.relations)
        return units or [Unit(None, [(r.relation, r.target) for r in clause.relations if r.source is None])]

    def _whereabouts(self, relation: str, target: str, reading: ClauseReading) -> list[tuple[str, str]]:
        """Where something is now, for "where the plate is"; any other relation is as it was said."""
        if relation != "where" or reading.clause.mood is Mood.KEEP:
            return [(relation, target)]
        places: list[tuple[str, str]] = [
            (where, other)
            for name in self.targets(target, reading)[:1]
            for fact in self.nouns.facts_about(name)
            if self.grounder.holds(fact, reading.state) and fact.args[0] == name
            for other in fact.args[1:]
            for where in ("in", "on")
            if (other not in self.world.profiles.constants or other in self.nouns.places)
            and where in fact.args
            and self.grounder.truth(self.nouns.related(where, name, other, reading.moments), reading.state)
        ]
        return places[:1] or [(relation, target)]

    def reattached(self, reading: ClauseReading) -> Clause:
        """The clause with the last of two places as where its thing shall be: "the cup on the table in the sink".

        The parser takes that for a table in the sink. It is not where the first place tells which cup is meant, and the
        table is in no sink.
        """
        clause = reading.clause
        found = list(clause.relations)
        if clause.verb not in section("placing"):
            return clause
        for number, relation in enumerate(clause.relations):
            source = relation.source or ""
            hosts = [r for r in clause.relations if r.target == source and r.source in clause.direct]
            if relation.relation not in PLACES or not hosts or source in clause.direct:
                continue
            target = self.targets(relation.target, reading)
            now = self.nouns.related_now(
                Referent(source, self.targets(source, reading)),
                relation.relation, target, reading.state, reading.moments,
            )  # fmt: skip
            units = [Unit(host.source, []) for host in hosts]
            tells = all(self.tells_which(u, h.relation, h.target, reading) for u, h in zip(units, hosts, strict=True))
            if target and not now and tells:
                found[number] = relation._replace(source=hosts[0].source)
                found += [relation._replace(source=host.source) for host in hosts[1:]]
        return replace(clause, relations=tuple(found)) if found != list(clause.relations) else clause

    def tells_which(self, unit: Unit, relation: str, target: str, reading: ClauseReading) -> bool:
        """Whether a relation of what is acted on holds now of one of its candidates."""
        if not unit.direct:
            return False
        noun = unit.direct
        if is_one(noun) and self._is_pronoun(noun):  # "the one in the sink goes on the shelf", of mugs
            noun = next(iter(reading.clause.antecedents.get(noun, ())), noun)
        referent = Referent(noun, self.nouns.things(noun, reading.state))
        return bool(self.described(referent, relation, self.targets(target, reading), reading))

    def described(
        self, referent: Referent, relation: str, targets: Sequence[str], reading: ClauseReading
    ) -> tuple[str, ...]:
        """The candidates that stand in a relation now, or where none does any more, that stood in it at first.

        *Clear the table. What is on it goes on the shelf.* Of several things that one is meant that stood there all
        along: *The mug in the sink goes on the shelf, and the mug on the shelf in the sink.*
        """
        first = reading.memory.first
        then = self.nouns.related_now(referent, relation, targets, first, Moments(first, first))
        now = self.nouns.related_now(referent, relation, targets, reading.state, reading.moments)
        one = referent.definite and referent.mode is Mode.ANY
        return (tuple(n for n in now if n in then) if one else ()) or now or then

    def unplaced(self, unit: Unit, relation: str, target: str, reading: ClauseReading) -> bool:
        """Whether a relation says a place where what is acted on is not yet."""
        place = relation in ("in", "into", "inside", "on", "onto", "to", "next_to", "on_top_of", "over", "beside")
        return place and bool(self.targets(target, reading)) and not self.tells_which(unit, relation, target, reading)

    def points_back(self, noun: str) -> bool:
        """Whether a noun, or its absence, stands for something that was spoken of."""
        return not noun or self._is_pronoun(noun) or noun in words_of("anaphors")

    def _is_pronoun(self, noun: str) -> bool:
        """Whether a noun is a pronoun, and no name that the domain has for something: ``red_one: [red_block]``."""
        return is_pronoun(noun) and noun not in self.lexicon.nouns

    def antecedents(self, noun: str, reading: ClauseReading) -> list[tuple[str, bool]]:
        """What a pronoun may mean, likeliest first: nouns, then (marked) objects that were spoken of."""
        clause, memory = reading.clause, reading.memory
        if noun in clause.antecedents and clause.together.get(noun, 1) > 1:
            return [(noun, False)]
        nouns = [(name, False) for name in clause.antecedents.get(noun, ())]
        if self._puts_back(reading):  # "pour some milk in the bowl and put it back in the fridge": it was in the fridge
            nouns.sort(key=lambda each: not self._was_there(each[0], noun, reading))
        seen = {n for name, _ in nouns for n in (memory.bound[name].names if name in memory.bound else ())}
        return [*nouns, *((name, True) for name in memory.recent if name not in seen)]

    def _was_there(self, antecedent: str, pronoun: str, reading: ClauseReading) -> bool:
        """Whether what was spoken of was, before anything was done, where the pronoun shall be put."""
        things = Referent(antecedent, self.nouns.things(antecedent, reading.state))
        return any(
            self.nouns.related_now(
                things, relation, self.targets(place, reading), reading.memory.first, reading.moments
            )
            for relation, place in self.relations_of(pronoun, reading.clause)
            if relation in PLACES
        )

    def referents(
        self, noun: str, row: GoalRow, slot: Slot, relations: Iterable[tuple[str, str]], reading: ClauseReading
    ) -> list[Referent]:
        """What may stand in a slot, likeliest first: one reading for a noun, one for each antecedent of a pronoun."""
        types = slot_types(row.condition, slot.variable, self.domain)
        clause = reading.clause
        phrase = clause.phrase(noun)
        if not self.points_back(noun):
            plain = noun in EVERYTHING and phrase.quantifier is Quantifier.ALL and not (phrase.attributes or relations)
            mixed = self._brought_together(types, reading) if plain else ()
            first = [Referent(noun, mixed, definite=True)] if mixed else []
            return [*first, self._named(noun, phrase, types, list(relations), reading, place=slot.is_place)]
        if noun in clause.antecedents and clause.together.get(noun, 1) > 1:
            return [self._together(clause.antecedents[noun][: clause.together[noun]], noun, types, reading)]
        options = self.antecedents(noun, reading)
        if reading.antecedent is not None and noun == reading.pronoun:
            options = options[reading.antecedent : reading.antecedent + 1]
        found = []
        for name, is_object in options:
            if not is_object:
                found.append(self._antecedent(name, noun, types, reading))
            elif self.grounder.is_a(name, types):
                found.append(Referent(noun or "it", (name,), definite=True))
            else:
                inside = tuple(c for c in self.nouns.contents(name, reading.state) if self.grounder.is_a(c, types))
                found.append(Referent(noun or "it", inside))
        return [referent for referent in found if referent.names] or [Referent(noun or "it", ())]

    def _antecedent(self, antecedent: str, pronoun: str, types: tuple[str, ...], reading: ClauseReading) -> Referent:
        """What a pronoun means if it stands for ``antecedent``: what that turned out to be."""
        if is_one(pronoun):
            said = reading.clause.phrase(pronoun)
            relations = self.relations_of(pronoun, reading.clause)
            spoken = reading.memory.bound.get(antecedent)
            same = said.definite and said.quantifier is Quantifier.PLAIN and not (said.attributes or relations)
            within = antecedent in reading.clause.phrases and antecedent not in reading.taken
            if said.quantifier is Quantifier.OTHER and within:  # "from the table with the mug to the other one"
                first, whole = self.targets(antecedent, reading), self._antecedent_of_kind(antecedent, types, reading)
                if first and set(first) < set(whole.names):
                    return replace(whole, noun=pronoun, names=tuple(n for n in whole.names if n not in first))
            if pronoun == "one" and same and spoken is not None:  # "… the other plate. Put that one in the sink."
                return self._antecedent(antecedent, "it", types, reading)
            return replace(
                self._named(antecedent, replace(said, name=antecedent), types, relations, reading), noun=pronoun
            )
        bound = reading.memory.bound.get(antecedent)
        if bound is not None and bound.containers and self._puts_back(reading):
            things = self._named(antecedent, NounPhrase(antecedent, definite=True), types, [], reading)
            if things.names:
                return things
        many = pronoun in ("them", "they", "these", "those", "both", "all") or self.nouns.is_group(antecedent)
        if bound is not None:
            names = tuple(n for n in (*bound.names, *bound.containers) if self.grounder.is_a(n, types))
            if not names:
                inside = (c for n in (*bound.names, *bound.containers) for c in self.nouns.contents(n, reading.state))
                names = tuple(dict.fromkeys(c for c in inside if self.grounder.is_a(c, types)))
                return Referent(antecedent, names)
            names = self._by_now(names, types, reading)
            mode = Mode.ALL if many and len(names) > 1 else Mode.ANY
            return Referent(antecedent, names if mode is Mode.ALL else names[:1] or names, mode, definite=True)
        return self._named(antecedent, NounPhrase(antecedent, definite=True, plural=many), types, [], reading)

    def _antecedent_of_kind(self, noun: str, types: tuple[str, ...], reading: ClauseReading) -> Referent:
        """All that a noun may mean, whatever else was said of it."""
        return self._named(noun, NounPhrase(noun), types, [], reading)

    def _together(self, nouns: Sequence[str], pronoun: str, types: tuple[str, ...], reading: ClauseReading) -> Referent:
        names: dict[str, None] = {}
        for noun in nouns:
            names.update(dict.fromkeys(self._antecedent(noun, "them", types, reading).names))
        return Referent(pronoun, tuple(names), Mode.ALL)

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
        """The candidates of a noun of the wanted type, but for those that adjectives and relations leave out."""
        likely = self.nouns.things(noun, reading.state, place=place, types=types)
        things = tuple(n for n in likely if self.grounder.fits(n, types))
        if phrase.definite and not phrase.plural and not relations:
            things = self._part_of(reading.memory.recent, noun) or things
        for relation, target in relations:
            if relation in PART_OF:
                things = self._part_of(self.targets(target, reading), noun) or things
            if relation == "of":
                held = self.nouns.holders(noun, self.targets(target, reading), reading.state, reading.moments)
                things = tuple(n for n in held if self.grounder.fits(n, types)) or things
        if not likely and noun in words_of("parts"):
            # "the lid", where lids are no things of their own, is that of what was spoken of
            spoken = [n for n in reading.memory.recent if self.grounder.is_a(n, types)]
            opened = [n for n in spoken if self.nouns.state_of(state_words("open"), n) is not None]
            things = tuple(opened or spoken)[:1]
        plain = phrase.quantifier is Quantifier.PLAIN and not self._puts_back(reading)
        inside = self._by_now_in(noun, types, reading) if plain else ()
        if inside and place:
            return Referent(noun, inside, definite=True)
        if inside and phrase.definite:
            things = tuple(n for n in things if n in inside) or things  # "until the water boils": the water in the pot
        wanted_constants = self._constants(noun, phrase, types, reading)
        for target in (target for relation, target in relations if relation == "of"):
            inside = self.nouns.constants(target, types, reading.state)  # "a bottle of raspberry syrup": of all bottles
            wanted_constants = tuple(c for c in wanted_constants if c in inside) or wanted_constants
        objects = tuple(n for n in things if n not in self.world.profiles.constants)
        group = self.nouns.is_group(noun) and not (place and noun in self.lexicon.nouns)
        if not objects and wanted_constants:
            few = self.nouns.too_few(phrase, wanted_constants, reading.state)
            mode, number = mode_of(phrase, group=False, thing=bool(few))
            return Referent(noun, few or wanted_constants, mode, number, phrase.definite)
        mode, number = mode_of(phrase, group=group, thing=True, place=place)
        among = phrase.quantifier in (Quantifier.SOME, Quantifier.OTHER) and len(objects) == 1 and things == likely
        several = mode is not Mode.ANY or (among and not relations and not phrase.attributes)
        if several and not group:  # "one of the lamps", "the other lamp": where there is but one lamp, a floor lamp
            objects, group = self._all_kinds(noun, objects, types, reading.state, all_of_it=mode is Mode.ALL)
        if phrase.number == 2 and mode is Mode.ALL:
            mode, number, group = Mode.NUMBER if len(objects) != 2 else mode, 2, False
        definite = phrase.definite and phrase.quantifier is not Quantifier.SOME  # "one of the lamps": any of them
        referent = Referent(noun, objects, mode, number, definite, group, phrase.each)
        whole = referent.names
        referent, unknown = self.nouns.narrowed(referent, phrase, reading.state, reading.moments)
        if (
            whole
            and not referent.names
            and any(r.source == noun and r.relation == "of" for r in reading.clause.relations)
        ):
            # "a hot cup of coffee": the cup shall be so, with what is in it
            reading.wanted[noun] = phrase.attributes
            referent = replace(referent, names=whole)
        if any(word.startswith(("that_", "which_", "who_")) for word in unknown) and len(referent.names) > 1:
            referent = replace(referent, names=())
        reading.notes += [f"'{word.replace('_', ' ')}' says nothing here that could be checked" for word in unknown]
        referent = self._restricted(referent, relations, reading, replace(referent, names=whole))
        if referent.mode is Mode.ALL and noun in reading.clause.direct:  # "all of it to the table, but leave the bowl"
            free = tuple(n for n in referent.names if n not in reading.memory.left)
            referent = replace(referent, names=free or referent.names)
        if noun in reading.taken:
            other, one = phrase.quantifier is Quantifier.OTHER, reading.taken[noun]
            return replace(referent, names=tuple(n for n in referent.names if (n == one) != other))
        bound = reading.memory.bound.get(noun)
        if bound is not None and phrase.quantifier is Quantifier.OTHER:
            return replace(referent, names=tuple(n for n in referent.names if n not in bound.names))
        if place and phrase.quantifier is Quantifier.OTHER:
            left = set(self._places_now(referent, reading))  # "to the other table": not the one where it is
            return replace(referent, names=tuple(n for n in referent.names if n not in left) or referent.names)
        if bound is not None and phrase.definite and mode is Mode.ANY and set(bound.names) & set(referent.names):
            return replace(referent, names=tuple(n for n in referent.names if n in bound.names))
        return referent

    def _constants(
        self, noun: str, phrase: NounPhrase, types: tuple[str, ...], reading: ClauseReading
    ) -> tuple[str, ...]:
        """The constants that a noun names; *everything* is what is in the things that were spoken of, not all there is.

        *Cook the noodles with an egg and serve everything in the bowl.*
        """
        if noun in EVERYTHING:
            inside = (c for name in reading.memory.recent for c in self.nouns.contents(name, reading.state))
            names = tuple(dict.fromkeys(c for c in inside if self.grounder.is_a(c, types)))
        else:
            names = self.nouns.constants(noun, types, reading.state)
        spoken_of = noun in reading.memory.bound and phrase.quantifier is not Quantifier.OTHER
        return self._by_now(names, types, reading) if spoken_of else names

    def _puts_back(self, reading: ClauseReading) -> bool:
        """Whether things go where they were: the milk is its carton then, and not the cup that has some by now."""
        verb = reading.clause.verb
        return any(name.endswith("_back") for name in (verb, self.lexicon.canonical_verb(verb)))

    def _places_now(self, places: Referent, reading: ClauseReading) -> tuple[str, ...]:
        """Those of some places where what the clause acts on is now."""
        moved = [n for direct in reading.clause.direct[:1] for n in self.targets(direct, reading)]
        return tuple(
            place
            for place in places.names
            if any(
                self.grounder.truth(self.nouns.related(where, name, place, reading.moments), reading.state)
                for where in ("on", "in")
                for name in moved
            )
        )

    def _by_now_in(self, noun: str, types: tuple[str, ...], reading: ClauseReading) -> tuple[str, ...]:
        """What contains the substance that was spoken of: *over the noodles* is over what they are in by now."""
        named = set(self.nouns.substances(noun))
        for bound in reversed(tuple(reading.memory.bound.values())):
            if bound.containers and named & set(bound.names):
                return tuple(n for n in bound.containers if self.grounder.is_a(n, types))
        return ()

    def _brought_together(self, types: tuple[str, ...], reading: ClauseReading) -> tuple[str, ...]:
        """What holds several things that were spoken of: *water in a bowl, add the noodles, microwave everything*."""
        held: dict[str, int] = {}
        for bound in reading.memory.bound.values():
            for name in bound.containers:
                held[name] = held.get(name, 0) + 1
        return tuple(n for n, count in held.items() if count > 1 and self.grounder.is_a(n, types))[-1:]

    def _by_now(self, names: tuple[str, ...], types: tuple[str, ...], reading: ClauseReading) -> tuple[str, ...]:
        """What was spoken of, as that which it turned into since: the noodles, when they are cooked."""

        def now(name: str) -> str:
            for later in self.nouns.turns_into(name) if name in self.world.profiles.constants else ():
                fresh = (a for a in self.nouns.facts_about(later) if self.grounder.holds(a, reading.state))
                if self.grounder.is_a(later, types) and any(
                    not self.grounder.holds(a, reading.memory.first) for a in fresh
                ):
                    return later
            return name

        return tuple(dict.fromkeys(map(now, names)))

    def _part_of(self, wholes: Iterable[str], noun: str) -> tuple[str, ...]:
        """*The door*, after the microwave was spoken of, is its door."""
        profiles = self.world.profiles
        for name in wholes:
            for whole in dict.fromkeys((name, profiles.wholes.get(name, name))):
                found = tuple(p for short, p in profiles.parts.get(whole, ()) if split_name(short)[-1:] == (noun,))
                if found:
                    return found
        return ()

    def _all_kinds(
        self, noun: str, objects: tuple[str, ...], types: tuple[str, ...], state: Bits, *, all_of_it: bool = False
    ) -> tuple[tuple[str, ...], bool]:
        """*All the lights*, where no class has that name, are the things of every class that the noun may mean.

        *Every lamp* is the floor lamp as well, which is called so; *every cup* is no bowl, which only stands in for one
        where there is none.
        """
        matches = self.world.mentions.of(noun, state)
        if len(objects) == 1 and noun in self.lexicon.nouns:
            called = all_of_it and self._is_kind(noun, objects)
            wider = {kind for kind in self.lexicon.nouns[noun] if not called or noun in split_name(kind)}
            kinds = self.world.mentions.kinds
            names = [n for n in self.world.profiles.objects if kinds.get(n) in wider and self.grounder.is_a(n, types)]
            return (tuple(names), True) if len(names) > 1 else (objects, False)
        if not matches or matches[0].how != "alias":
            return objects, False
        names = [m.name for m in matches if m.how == "alias" and m.name not in self.world.profiles.constants]
        return tuple(n for n in names if self.grounder.is_a(n, types)), True

    def every_kind(self, noun: str, state: Bits) -> tuple[str, ...]:
        """All that a noun may mean: vanilla and chocolate, where it is *ice cream*."""
        return self._all_kinds(noun, self.nouns.things(noun, state), ("object",), state)[0]

    def _any_one(self, noun: str, reading: ClauseReading) -> bool:
        """Whether any one will do: nothing was said that tells which."""
        said = reading.clause.phrase(noun)
        return not (said.definite or said.plural or said.attributes or self.relations_of(noun, reading.clause))

    def _restricted(
        self,
        referent: Referent,
        relations: Sequence[tuple[str, str]],
        reading: ClauseReading,
        whole: Referent | None = None,
    ) -> Referent:
        """The candidates that stand in the relations that were said, where some do; *except* takes some away.

        None are left where only such do that adjectives left out of the ``whole``: "the full cup on the table", where
        the cup on the table is empty.
        """
        for relation, target in relations:
            names = self.targets(target, reading)
            if relation in EXCEPTING and is_one(target) and self._any_one(target, reading) and referent.names:
                number = len(referent.names) - 1  # "all but one"
                referent = replace(referent, mode=Mode.NUMBER, number=number)
                continue
            if relation in EXCEPTING:
                left = self.excepted([(relation, target)], reading)
                referent = replace(referent, names=tuple(n for n in referent.names if n not in left))
                continue
            if relation.startswith("not_"):
                now = self.nouns.related_now(
                    referent, relation.removeprefix("not_"), names, reading.state, reading.moments
                )
                referent = replace(referent, names=tuple(n for n in referent.names if n not in now))
                continue
            if reading.clause.phrase(target).quantifier is Quantifier.NONE:  # "the chair that has no pillow"
                now = self.nouns.related_now(referent, relation, names, reading.state, reading.moments)
                referent = replace(referent, names=tuple(n for n in referent.names if n not in now))
                continue
            if relation in ("without", "for") or not names:
                continue
            now = self.described(referent, relation, names, reading)
            tells = relation in INVERSE or relation == "where"  # what stands on nothing has no burner under it
            if now or tells or (whole is not None and self.described(whole, relation, names, reading)):
                referent = replace(referent, names=now)
        return referent

    def excepted(self, relations: Iterable[tuple[str, str]], reading: ClauseReading) -> tuple[str, ...]:
        """What *except* takes away."""
        found: dict[str, None] = {}
        for relation, target in relations:
            if relation in EXCEPTING:
                names = self._where_it_was_said(target, self.targets(target, reading), reading)
                phrase = reading.clause.phrase(target)
                one = is_one(target) or (phrase.definite and not phrase.plural and self._is_kind(target, names))
                wide = (n for noun in reading.clause.meant(target) for n in self.every_kind(noun, reading.state))
                found.update(dict.fromkeys((*names, *(() if one else wide))))
        return tuple(found)

    def _where_it_was_said(self, noun: str, names: tuple[str, ...], reading: ClauseReading) -> tuple[str, ...]:
        """Those things that are where the clause says: where no mug is on the table, *the one on it* is none."""
        for relation, place in self.relations_of(noun, reading.clause):
            where = self.targets(place, reading)
            if relation in PLACES and where:
                names = self.described(Referent(noun, names), relation, where, reading)
        return names

    def _is_kind(self, noun: str, names: Iterable[str]) -> bool:
        """Whether things are of the very class that a noun names."""
        return any(self.grounder.is_a(name, (noun,)) for name in names)

    def targets(self, noun: str, reading: ClauseReading) -> tuple[str, ...]:
        """The objects or constants that a noun behind a preposition may mean."""
        if noun in reading.asked:
            return ()
        reading.asked.add(noun)
        try:
            return self._meant_by(noun, reading)
        finally:
            reading.asked.discard(noun)

    def _meant_by(self, noun: str, reading: ClauseReading) -> tuple[str, ...]:
        if self._is_pronoun(noun):
            nouns = reading.clause.antecedents.get(noun, ())[:1]
            names = tuple(n for a in nouns for n in self._one_called(noun, a, reading) or self.targets(a, reading))
            names = names or tuple(
                n for a in reading.clause.direct[:1] if is_one(noun) for n in self.targets(a, reading)
            )
            for relation, target in self.relations_of(noun, reading.clause):
                ends = self.targets(target, reading)
                referent = Referent(noun, names)
                names = self.nouns.related_now(referent, relation, ends, reading.state, reading.moments) or names
            return names
        bound = reading.memory.bound.get(noun)
        things = self.nouns.things(noun, reading.state)
        if bound is not None and set(bound.names) & set(things):
            return tuple(n for n in things if n in bound.names)
        constants = self.nouns.constants(noun, ("object",), reading.state)
        names = tuple(dict.fromkeys((*things, *constants)))
        relations = self.relations_of(noun, reading.clause) if noun not in reading.clause.direct else []
        said = [(r, t) for r, t in relations if r == "with"]  # "from the table with the ramen on it"
        return self._restricted(Referent(noun, names), said, reading).names or names if said else names

    def _one_called(self, pronoun: str, antecedent: str, reading: ClauseReading) -> tuple[str, ...]:
        """What *the ceiling one* means where lamps were spoken of: a ceiling lamp."""
        modifier = pronoun.removesuffix("_one")
        if modifier == pronoun:
            return ()
        whole = self.nouns.things(antecedent, reading.state)
        found = self.nouns.things(f"{modifier}_{antecedent}", reading.state)
        return found if set(found) != set(whole) else ()

    def not_there(self, clause: Clause) -> Refusal:
        """That the thing a clause acts on is not there."""
        reading = ClauseReading(clause, 0, Moments(0, 0), Memory())
        return self.missing(Referent(clause.direct[0] if clause.direct else "it", ()), reading)

    def missing(self, referent: Referent, reading: ClauseReading) -> Refusal:
        """RefusalKind a noun means nothing here."""
        phrase = reading.clause.phrase(referent.noun)
        words = " ".join((*phrase.attributes, referent.noun.replace("_", " ")))
        known = self.nouns.things(referent.noun, reading.state)
        if known and phrase.attributes:
            what = "nothing" if referent.noun in EVERYTHING else f"no {referent.noun.replace('_', ' ')}"
            return Refusal(RefusalKind.NO_SUCH_THING, f"{what} that is meant here is {' and '.join(phrase.attributes)}")
        if known and any(r in EXCEPTING for r, _ in self.relations_of(referent.noun, reading.clause)):
            return Refusal(RefusalKind.NO_SUCH_THING, f"every '{words}' that is meant here is excepted")
        if known:
            return Refusal(
                RefusalKind.NOT_UNDERSTOOD,
                f"'{words}' is nothing that '{reading.clause.verb.replace('_', ' ')}' can be said of here",
            )
        return Refusal(
            RefusalKind.NO_SUCH_THING,
            f"nothing here is called '{words}'",
            "name a thing that is there, or allow guesses",
        )
