"""Requirements of noun phrases beside the row of their clause: contents, *without*, places, tools, states."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TypeAlias

from tmd.goals.clause_goal import ClauseReading, RowUse, words
from tmd.goals.reading.noun_phrases import Referent
from tmd.goals.reading.referents import ANY_TYPE, Referents, is_none
from tmd.goals.sources.table import ACTIONS, RELATION, GoalRow, split_predicate
from tmd.goals.words import NEGATED, PREPOSITIONS, is_relation, results, words_of
from tmd.language.clause import Quantifier
from tmd.pddl.ground_formula import FALSE, TRUE, atoms_of, conjunction, disjunction
from tmd.pddl.model import Atom, Formula, GroundAtom, Not, TypedName, predicates_of

Requirement: TypeAlias = Callable[[Mapping[str, str]], Formula]
"""The further condition, given what the slots are filled with."""
Pairs: TypeAlias = Sequence[tuple[str, Referent]]
"""The slots of a row, with what stands in them."""


@dataclass(frozen=True, slots=True)
class _Said:
    """One relation of what stands in a slot that no slot takes.

    Attributes:
        row: The row of the clause.
        variable: The slot.
        referent: What stands in it.
        relation: The relation.
        target: What it is related to.
        names: What that may mean.
        acted_on: Whether the slot is for what the verb acts on.
        reading: The clause.
    """

    row: GoalRow
    variable: str
    referent: Referent
    relation: str
    target: str
    names: tuple[str, ...]
    acted_on: bool
    reading: ClauseReading


class Requirements:
    """Finds the further conditions of a clause.

    Args:
        referents: Finds what nouns mean.
    """

    def __init__(self, referents: Referents) -> None:
        self.referents = referents
        self.world = referents.world
        self.grounder = referents.grounder
        self.nouns = referents.nouns

    def further(self, use: RowUse, pairs: Pairs) -> list[Requirement]:
        """Return what must hold besides: contents, *without*, adjectives of a substance, where further nouns are."""
        row, reading = use.row, use.reading
        found: list[Requirement] = []
        if row.direct is None:  # the noun stands in the pattern: "have coffee"
            for relation, target in use.leftover:
                if is_relation(relation, "lacking") or is_none(target, reading.clause):
                    found.append(partial(self._without, row, self.referents.targets(target, reading), reading))
        for said in self._relations(use, pairs):
            found += self._of_relation(said)
        for variable, referent in pairs:
            adjectives = reading.clause.phrase(referent.noun).attributes
            if adjectives and all(map(self.nouns.is_constant, referent.names)):
                found.append(partial(self._vessel_is, row, variable, adjectives, reading))
        for variable, referent in pairs:
            if referent.noun in reading.wanted:
                found.append(partial(self._state_wanted, variable, reading.wanted[referent.noun], reading))
        return found

    def _relations(self, use: RowUse, pairs: Pairs) -> Iterator[_Said]:
        row, reading = use.row, use.reading
        for variable, referent in pairs:
            # a pronoun goes by the name of what it stands for, and what was said of it is said of the direct object
            noun = use.direct if row.direct is not None and variable == row.direct.variable else referent.noun
            acted_on = noun == use.direct
            relations = use.leftover if acted_on else self.referents.relations_of(referent.noun, reading.clause)
            for relation, target in relations:
                if target == noun:
                    continue  # the gate of what was spoken of
                names = self.referents.targets(target, reading)
                yield _Said(row, variable, referent, relation, target, names, acted_on, reading)

    def _of_relation(self, said: _Said) -> list[Requirement]:
        """Return what a relation asks for, by the first kind of relations that it is of."""
        if is_relation(said.relation, "selecting") or said.relation.startswith(NEGATED):
            return []
        if is_relation(said.relation, "lacking") or is_none(said.target, said.reading.clause):
            return [partial(self._without, said.row, said.names, said.reading)]
        if set(said.names) <= set(said.referent.names):
            return []
        if self._is_mixed(said):
            return [partial(self._beside, said, part) for part in self._dealt(said, self._as_constants(said))]
        if self.referents.described(said.referent, said.relation, self._wider(said), said.reading):
            return []  # it is so already
        for kind in (self._with_tool, self._there, self._beside_place):
            found = kind(said)
            if found is not None:
                return found
        parts = self._dealt(said, self._as_constants(said) or self._wider(said))
        return [partial(self._relation_goal, said, part) for part in parts]

    # ------------------------------------------------------------------ kinds of relations

    def _is_mixed(self, said: _Said) -> bool:
        """Return whether the goal is to hold of another substance as well: *coffee with milk*."""
        supplied = any(map(self.nouns.is_constant, said.names)) or all(map(self.nouns.is_supply, said.names))
        mixing = is_relation(said.relation, "mixing") and bool(self._as_constants(said))
        return mixing and supplied and self._is_substance(said.referent)

    def _with_tool(self, said: _Said) -> list[Requirement] | None:
        """Require that a tool is taken first, or that it is done in there: *heat the milk using the microwave*."""
        instrument = is_relation(said.relation, "tool") and (said.acted_on or self._never(said))
        if not instrument or any(map(self.nouns.is_constant, said.names)):
            return None
        if self._is_idle(said):
            return [lambda _: FALSE]  # "milk the cow with the shears"
        held = (self.nouns.state_of(results("hold"), name) for name in said.names)
        formula = disjunction(f for f in held if f is not None)
        if formula not in (FALSE, TRUE):
            said.reading.approach.append(formula)
            said.reading.meant.setdefault(f"with {said.names[0]}", said.names)
            return []
        if not is_relation(said.relation, "accompanying"):
            whole = [other for name in said.names for other in (name, *self.grounder.relatives(name, 0))]
            self._on_the_way(said, sorted(words_of("relations", "resting")), whole)
        return None if any(self.nouns.contents(n, said.reading.state) for n in said.names) else []

    def _is_idle(self, said: _Said) -> bool:
        """Return whether no action with the outcome of a verb takes such a thing beside what it is about.

        Where something is put, a tool is for what was done before: "use the microwave, then leave it on the counter".
        """
        if said.row.source != ACTIONS or any(slot.is_place for slot in said.row.places):
            return False
        return not any(self.grounder.is_a(name, p.types) for p in self._means(said.row) for name in said.names)

    def _means(self, row: GoalRow) -> Iterator[TypedName]:
        """Yield the parameters, beside what a row is about, of the actions that bring its condition about."""
        wanted = {split_predicate(name)[0] for name in predicates_of(row.condition)}
        for action in self.world.task.problem.domain.actions:
            made = [effect.atom for effect in action.effects if effect.atom.predicate in wanted]
            about = {term for atom in made for term in atom.terms}
            yield from (p for p in action.parameters if made and p.name not in about)

    def _there(self, said: _Said) -> list[Requirement] | None:
        """Require a place or a tool that no slot takes on the way; a substance is where its vessel is."""
        if not said.acted_on or is_relation(said.relation, "restricting"):
            return None
        self._on_the_way(said, (said.relation,), said.names)
        said.reading.meant.setdefault(f"{said.relation} {said.names[0]}", said.names)
        inside = said.relation in (*PREPOSITIONS["in"], *PREPOSITIONS["on"])
        thing = not (self.nouns.guess or self._is_substance(said.referent))
        never = inside and thing and self._never(said) and self._takes_others(said)
        # "water in the glass on the table" is not the cup of water that is somewhere else
        poured = thing and is_relation(said.relation, "inside") and self.nouns.substances(said.referent.noun)
        never = never or (bool(poured) and set(said.names).isdisjoint(said.referent.names))
        if thing and not inside:
            self._note_idle(said)
        return [lambda _: FALSE] if never else []  # no kettle is heated in the microwave

    def _beside_place(self, said: _Said) -> list[Requirement] | None:
        if said.relation not in PREPOSITIONS["next_to"] or not self._never(said):
            return None
        said.reading.notes.append(self._says_nothing(said))
        return []

    def _note_idle(self, said: _Said) -> None:
        """Note a place where a thing never is: "the lamp at the sofa", of the ceiling lamp."""
        if not is_relation(said.relation, "origin") and self._never(said):
            said.reading.notes.append(self._says_nothing(said))

    @staticmethod
    def _says_nothing(said: _Said) -> str:
        return f"'{words(said.relation)} {words(said.target)}' says nothing here"

    # ------------------------------------------------------------------ conditions

    def _dealt(self, said: _Said, names: Sequence[str]) -> Sequence[Sequence[str]]:
        """Return names one by one where each is meant, otherwise together."""
        each = said.reading.clause.phrase(said.target).quantifier is Quantifier.ALL  # "with both syrups"
        return list(zip(names)) if each else [names]

    def _as_constants(self, said: _Said) -> tuple[str, ...]:
        phrase = said.reading.clause.phrase(said.target)
        meant = said.reading.clause.meant(said.target)[:1]  # "coffee with it", of the water
        phrases = (replace(phrase, name=noun) for noun in meant)
        return tuple(n for each in phrases for n in self.referents.substances(each, ANY_TYPE, said.reading))

    def _wider(self, said: _Said) -> tuple[str, ...]:
        """Return what may be in a thing as well, under the same noun: a jar of coffee holds powder, not the drink."""
        if not is_relation(said.relation, "partitive"):
            return said.names
        others = self.nouns.substances(said.target)

        def held(substances: Sequence[str]) -> bool:
            return bool(self.nouns.related_now(said.referent.names, said.relation, substances, said.reading.moments))

        wide = self._never(said) or (held(others) and not held(said.names))
        return (*said.names, *others) if wide else said.names

    def _never(self, said: _Said) -> bool:
        """Return whether nothing that is meant may ever stand in the relation."""
        return all(
            self.nouns.related(said.relation, name, target, said.reading.moments) == FALSE
            for name in said.referent.names
            for target in said.names
        )

    def _takes_others(self, said: _Said) -> bool:
        """Return whether other things may ever be in, or on, the place."""
        return any(
            self.nouns.related(said.relation, name, place, said.reading.moments) != FALSE
            for place in said.names
            for name in self.world.profiles.objects
            if name != place
        )

    def _state_wanted(
        self, variable: str, adjectives: Sequence[str], reading: ClauseReading, binding: Mapping[str, str]
    ) -> Formula:
        said = (self.nouns.attribute(word, binding[variable], reading.moments) for word in adjectives)
        return conjunction(formula for formula in said if formula is not None)

    def _relation_goal(self, said: _Said, names: Sequence[str], binding: Mapping[str, str]) -> Formula:
        own = binding[said.variable]
        return disjunction(self.nouns.related(said.relation, own, n, said.reading.moments) for n in names if n != own)

    def _on_the_way(self, said: _Said, relations: Sequence[str], names: Sequence[str]) -> None:
        """Ask that what is meant, or what a substance is in, stands in a relation to one of ``names`` on the way."""
        carriers = self._vessels(said) if self._is_substance(said.referent) else self._filled(said)
        formula = disjunction(
            conjunction((held, self.nouns.related(relation, name, target, said.reading.moments)))
            for name, held in carriers
            for target in names
            if name != target
            for relation in relations
        )
        if formula not in (FALSE, TRUE):
            said.reading.approach.append(formula)

    def _filled(self, said: _Said) -> list[tuple[str, Formula]]:
        """Return the things meant, each with what must be in it: *a mug of water* is one with the water in it."""
        relations = self.referents.relations_of(said.referent.noun, said.reading.clause)
        inside = [n for r, n in relations if is_relation(r, "partitive")]
        contents = [t for noun in inside for t in self.referents.targets(noun, said.reading)]
        moments = said.reading.moments
        return [
            (name, disjunction(self.nouns.related("of", name, t, moments) for t in contents) if contents else TRUE)
            for name in said.referent.names
        ]

    def _vessels(self, said: _Said) -> list[tuple[str, Formula]]:
        """Return what a substance is in where the goal is reached, each with the fact that it is in there."""
        goals = ((name, self._own(said.row, {said.variable: name}, said.reading)) for name in said.referent.names)
        inside = ((atom.args[0], atom) for name, own in goals for atom in own if atom.args[1:] == (name,))
        return [(vessel, Atom(atom.predicate, atom.args)) for vessel, atom in inside]

    def _own(self, row: GoalRow, binding: Mapping[str, str], reading: ClauseReading) -> list[GroundAtom]:
        """Return the atoms of a row's condition."""
        goal = self.grounder.ground(row.condition, {**binding, RELATION: "in"}, binding, reading.moments)
        return sorted(atoms_of(goal))

    def _is_substance(self, referent: Referent) -> bool:
        return bool(referent.names) and all(map(self.nouns.is_constant, referent.names))

    def _beside(self, said: _Said, names: Sequence[str], binding: Mapping[str, str]) -> Formula:
        """Return that what the goal says of a substance holds of one of ``names`` as well."""
        one = binding[said.variable]
        pairs = (
            (atom, atom._replace(args=tuple(name if a == one else a for a in atom.args)))
            for atom in self._own(said.row, binding, said.reading)
            if one in atom.args
            for name in names
        )
        known = (pair for pair in pairs if pair[1] in self.world.task.index)
        return disjunction(conjunction(Atom(a.predicate, a.args) for a in pair) for pair in known)

    def _without(
        self, row: GoalRow, names: Sequence[str], reading: ClauseReading, binding: Mapping[str, str]
    ) -> Formula:
        """Return that none of ``names`` is where the goal puts something else of their kind."""
        types = self.world.mentions.types

        def alike(one: str, other: str) -> bool:
            own, its = types[one], types.get(other, ("",))
            return own[:1] == its[:1] or own[1:2] == its[1:2]

        others = (
            atom._replace(args=(*atom.args[:place], name, *atom.args[place + 1 :]))
            for atom in self._own(row, binding, reading)
            for place, argument in enumerate(atom.args)
            for name in names
            if alike(name, argument)
        )
        return conjunction(Not(Atom(a.predicate, a.args)) for a in others if a in self.world.task.index)

    def _vessel_is(
        self,
        row: GoalRow,
        variable: str,
        adjectives: Sequence[str],
        reading: ClauseReading,
        binding: Mapping[str, str],
    ) -> Formula:
        """Return that what contains *hot milk* in the end is hot."""
        ways = []
        for atom in self._own(row, binding, reading):
            things = [a for a in atom.args if not self.nouns.is_constant(a)][:1]
            said = [self.nouns.attribute(word, thing, reading.moments) for thing in things for word in adjectives]
            known = [f for f in said if f is not None]
            if binding[variable] in atom.args and things and len(known) == len(said):
                ways.append(conjunction((Atom(atom.predicate, atom.args), *known)))
        return disjunction(ways) if ways else TRUE
