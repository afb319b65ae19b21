"""What noun phrases ask for besides the row of their clause: contents, *without*, places, tools, states."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TypeAlias

from tmd.diagnostics import Refusal, RefusalKind
from tmd.goals.clause_goal import ClauseReading, text_of
from tmd.goals.grounder import Moments
from tmd.goals.reading.noun_phrases import Mode, Referent
from tmd.goals.reading.referents import EXCEPTING, Referents
from tmd.goals.sources.table import (
    PREPOSITIONS,
    RELATION,
    GoalRow,
    Slot,
    results,
)
from tmd.language.clause import PERSONS, Quantifier
from tmd.language.syntax.antecedents import is_pronoun
from tmd.pddl.ground_formula import FALSE, TRUE, atoms_of, conjunction, disjunction
from tmd.pddl.model import Atom, Formula, Not

Requirement: TypeAlias = Callable[[Mapping[str, str]], Formula]
"""Given what the slots are filled with, what must hold besides."""
_SELECTING = frozenset({"except", "besides", "apart_from", "for", "where", "from", "out_of", "off"})
"""Relations that only tell which thing is meant."""
_RESTRICTING = frozenset({"of", "with", "where", "containing"})
"""Relations of what is acted on that are no place where it is done."""


class Requirements:
    """Finds what must hold besides.

    Args:
        referents: What nouns mean.
    """

    def __init__(self, referents: Referents) -> None:
        self.referents = referents
        self.world = referents.world
        self.grounder = referents.grounder
        self.nouns = referents.nouns

    def further(
        self,
        row: GoalRow,
        pairs: Sequence[tuple[str, Referent]],
        direct: str | None,
        leftover: Sequence[tuple[str, str]],
        reading: ClauseReading,
    ) -> list[Requirement]:
        """What must hold besides: contents, *without*, adjectives of a substance, where further nouns are."""
        found: list[Requirement] = []
        if row.direct is None:  # the noun stands in the pattern: "have coffee"
            for relation, target in leftover:
                if relation == "without" or reading.clause.phrase(target).quantifier is Quantifier.NONE:
                    found.append(self._without(row, pairs, self.referents.targets(target, reading), reading))
                elif relation == "with" and self.nouns.constants(target, ("object",), reading.state):
                    reading.notes.append(f"'with {target.replace('_', ' ')}' says nothing here that could be checked")
        for variable, referent in pairs:
            # a pronoun goes by the name of what it stands for, and what was said of it is said of the direct object
            noun = direct if row.direct is not None and variable == row.direct.variable else referent.noun
            relations = leftover if noun == direct else self.referents.relations_of(referent.noun, reading.clause)
            for relation, target in relations:
                if relation in _SELECTING or relation.startswith("not_"):
                    continue
                names = self.referents.targets(target, reading)
                if relation == "without" or reading.clause.phrase(target).quantifier is Quantifier.NONE:
                    found.append(self._without(row, pairs, names, reading))
                    continue
                if not names or set(names) <= set(referent.names):
                    continue
                if relation == "of" and self._of_another_kind(referent, names, target, reading):
                    names = (*names, *self.nouns.substances(target))  # a jar of coffee holds powder, not the drink
                meant = reading.clause.meant(target)[:1]  # "coffee with it", of the water
                beside = tuple(n for noun in meant for n in self.nouns.constants(noun, ("object",), reading.state))
                supplied = any(n in self.world.profiles.constants for n in names) or all(
                    map(self.nouns.is_supply, names)
                )
                if relation in ("with", "and") and beside and supplied and self._is_substance(referent):
                    both = reading.clause.phrase(target).quantifier is Quantifier.ALL  # "with both syrups"
                    found += [self._beside(row, variable, part) for part in (zip(beside) if both else (beside,))]
                    continue
                if self.referents.described(referent, relation, names, reading):
                    continue
                never = self._never(referent, relation, names, reading)
                tool = (noun == direct or never) and relation in ("with", "using", "via", "through")
                if tool and self._tool(row, variable, referent, (relation, names), reading):
                    continue
                if noun == direct and relation not in _RESTRICTING:
                    inside = relation in (*PREPOSITIONS["in"], *PREPOSITIONS["on"])
                    thing = not (self.nouns.guess or self._is_substance(referent))
                    if never and inside and thing and self._takes_others(relation, names, reading):
                        found.append(lambda _: FALSE)  # no kettle is heated in the microwave
                    self._approach(row, variable, referent, (relation, names), reading)
                    continue
                if never and relation in PREPOSITIONS["next_to"]:
                    reading.notes.append(f"'{relation.replace('_', ' ')} {target.replace('_', ' ')}' says nothing here")
                    continue
                each = reading.clause.phrase(target).quantifier is Quantifier.ALL
                found += [
                    self._relation_goal(variable, relation, part, reading)
                    for part in (zip(beside or names) if each else (names,))
                ]
        found += self._substance_attributes(row, pairs, reading)
        for variable, referent in pairs:
            if referent.noun in reading.wanted:
                found.append(self._state_wanted(variable, reading.wanted[referent.noun], reading))
        return found

    def _of_another_kind(self, referent: Referent, names: Sequence[str], noun: str, reading: ClauseReading) -> bool:
        """Whether what is meant is *of* what a noun may mean as well, and not of ``names``, be it now or ever."""
        if self._never(referent, "of", names, reading):
            return True

        def held(substances: Sequence[str]) -> bool:
            return bool(self.nouns.related_now(referent, "of", tuple(substances), reading.state, reading.moments))

        return held(self.nouns.substances(noun)) and not held(names)

    def _never(self, referent: Referent, relation: str, names: Sequence[str], reading: ClauseReading) -> bool:
        """Whether nothing that is meant may ever stand in a relation to one of ``names``."""
        return all(
            self.nouns.related(relation, name, target, reading.moments) == FALSE
            for name in referent.names
            for target in names
        )

    def _takes_others(self, relation: str, places: Sequence[str], reading: ClauseReading) -> bool:
        """Whether other things may ever be in, or on, one of some places."""
        return any(
            self.nouns.related(relation, name, place, reading.moments) != FALSE
            for place in places
            for name in self.world.profiles.objects
            if name != place
        )

    def _state_wanted(self, variable: str, words: Sequence[str], reading: ClauseReading) -> Requirement:
        def goal(binding: Mapping[str, str]) -> Formula:
            said = (self.nouns.attribute(word, binding[variable], reading.moments) for word in words)
            return conjunction(formula for formula in said if formula is not None)

        return goal

    def _relation_goal(self, variable: str, relation: str, names: Sequence[str], reading: ClauseReading) -> Requirement:
        def goal(binding: Mapping[str, str]) -> Formula:
            return disjunction(
                self.nouns.related(relation, binding[variable], name, reading.moments)
                for name in names
                if name != binding[variable]
            )

        return goal

    def _approach(
        self, row: GoalRow, variable: str, referent: Referent, said: tuple[str, Sequence[str]], reading: ClauseReading
    ) -> None:
        """Do it there, or with that: a place or a tool that no slot takes; a substance is where its vessel is."""
        relation, names = said
        self._on_the_way(self._beside_it(row, variable, referent, (relation,), names, reading), reading)
        reading.meant.setdefault(f"{relation} {names[0]}", tuple(names))

    def _beside_it(
        self,
        row: GoalRow,
        variable: str,
        referent: Referent,
        relations: Sequence[str],
        names: Sequence[str],
        reading: ClauseReading,
    ) -> Formula:
        """That what is meant, or the vessel that a substance is in, stands in a relation to one of ``names``."""
        substance = self._is_substance(referent)
        carriers = self._vessels(row, variable, referent, reading) if substance else self._filled(referent, reading)
        return disjunction(
            conjunction((held, self.nouns.related(relation, name, target, reading.moments)))
            for name, held in carriers
            for target in names
            if name != target
            for relation in relations
        )

    def _on_the_way(self, formula: Formula, reading: ClauseReading) -> None:
        if formula not in (FALSE, TRUE):
            reading.approach.append(formula)

    def _filled(self, referent: Referent, reading: ClauseReading) -> list[tuple[str, Formula]]:
        """The things meant, each with what must be in it: *a mug of water* is one with the water in it."""
        said = self.referents.relations_of(referent.noun, reading.clause)
        contents = [t for r, noun in said if r == "of" for t in self.referents.targets(noun, reading)]
        if not contents:
            return [(name, TRUE) for name in referent.names]
        return [
            (name, disjunction(self.nouns.related("of", name, t, reading.moments) for t in contents))
            for name in referent.names
        ]

    def _vessels(
        self, row: GoalRow, variable: str, referent: Referent, reading: ClauseReading
    ) -> list[tuple[str, Formula]]:
        """What a substance is in where the goal is reached, each with the fact that it is in there."""
        found: list[tuple[str, Formula]] = []
        for name in referent.names:
            goal = self.grounder.ground(row.condition, {variable: name, RELATION: "in"}, [variable], reading.moments)
            inside = [atom for atom in sorted(atoms_of(goal)) if atom.args[1:] == (name,)]
            found += [(atom.args[0], Atom(atom.predicate, atom.args)) for atom in inside]
        return found

    def _is_substance(self, referent: Referent) -> bool:
        return bool(referent.names) and all(name in self.world.profiles.constants for name in referent.names)

    def _beside(self, row: GoalRow, variable: str, names: Sequence[str]) -> Requirement:
        """*Coffee with milk*: what the goal says of the one shall hold of the other as well, of the same thing."""

        def goal(binding: Mapping[str, str]) -> Formula:
            now = Moments(0, 0)
            own = self.grounder.ground(row.condition, {**binding, RELATION: "in"}, binding, now)
            ways = []
            for atom in sorted(atoms_of(own)):
                if binding[variable] not in atom.args:
                    continue
                for name in names:
                    other = atom._replace(args=tuple(name if a == binding[variable] else a for a in atom.args))
                    if other in self.world.task.index:
                        both = (Atom(atom.predicate, atom.args), Atom(other.predicate, other.args))
                        ways.append(conjunction(both))
            return disjunction(ways) if ways else FALSE

        return goal

    def _tool(
        self, row: GoalRow, variable: str, referent: Referent, said: tuple[str, Sequence[str]], reading: ClauseReading
    ) -> bool:
        """Whether things are said to be used: they are taken first; what cannot be taken is where it is done.

        *Heat the milk using the microwave*: its cup is in there on the way.
        """
        relation, names = said
        if any(name in self.world.profiles.constants for name in names):
            return False
        contents = [n for n in names if self.nouns.contents(n, reading.state)]
        held = [self.nouns.state_of(results("hold"), name) for name in names]
        formula = disjunction(f for f in held if f is not None)
        if formula in (FALSE, TRUE) and relation != "with":
            whole = [other for name in names for other in (name, *self.grounder.relatives(name, 0))]
            self._on_the_way(self._beside_it(row, variable, referent, ("in", "on"), whole, reading), reading)
        if formula in (FALSE, TRUE):
            return not contents
        reading.approach.append(formula)
        reading.meant.setdefault(f"with {names[0]}", tuple(names))
        return True

    def _without(
        self, row: GoalRow, pairs: Sequence[tuple[str, Referent]], names: Sequence[str], reading: ClauseReading
    ) -> Requirement:
        """None of ``names`` where the goal puts something else of their kind."""

        def goal(binding: Mapping[str, str]) -> Formula:
            own = self.grounder.ground(row.condition, {**binding, RELATION: "in"}, binding, reading.moments)
            found = []
            for atom in sorted(atoms_of(own)):
                for place, argument in enumerate(atom.args):
                    for name in names:
                        other = atom._replace(args=(*atom.args[:place], name, *atom.args[place + 1 :]))
                        alike = self.world.mentions.types[name][1:2] == self.world.mentions.types.get(argument, ())[1:2]
                        same = self.world.mentions.types[name][0] == self.world.mentions.types.get(argument, ("",))[0]
                        if (alike or same) and other in self.world.task.index:
                            found.append(Not(Atom(other.predicate, other.args)))
            return conjunction(found)

        return goal

    def _substance_attributes(
        self, row: GoalRow, pairs: Sequence[tuple[str, Referent]], reading: ClauseReading
    ) -> list[Requirement]:
        """*Hot milk*: what contains the milk in the end shall be hot."""
        found: list[Requirement] = []
        for variable, referent in pairs:
            words = reading.clause.phrase(referent.noun).attributes
            if not words or not all(name in self.world.profiles.constants for name in referent.names):
                continue

            def goal(binding: Mapping[str, str], variable: str = variable, words: tuple[str, ...] = words) -> Formula:
                own = self.grounder.ground(row.condition, {**binding, RELATION: "in"}, binding, reading.moments)
                ways = []
                for atom in sorted(atoms_of(own)):
                    things = [a for a in atom.args if a not in self.world.profiles.constants]
                    said = [self.nouns.attribute(word, things[0], reading.moments) for word in words] if things else []
                    if binding[variable] in atom.args and things and all(f is not None for f in said):
                        ways.append(conjunction((Atom(atom.predicate, atom.args), *(f for f in said if f is not None))))
                return disjunction(ways) if ways else TRUE

            found.append(goal)
        return found


BE = "be"
"""The verb of a state."""
LEAVING = frozenset({"leave", "keep"})
"""The verbs of a state that something is in by then: *leave it open* is about what is open."""


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

    def read(self, reading: ClauseReading) -> Formula | Refusal:
        """What is to be so: *the door is open*, *get the water boiling*, *there is milk in the cup*."""
        clause = reading.clause
        names = [n for n in (clause.direct or clause.objects[:1]) if n not in PERSONS] or [""]
        formulas = []
        for noun in names:
            found = self._state_of(noun, reading)
            if isinstance(found, Refusal):
                return found
            formulas.append(found)
        return conjunction(formulas)

    def _state_of(self, noun: str, reading: ClauseReading) -> Formula | Refusal:
        clause = reading.clause
        relations = self.referents.relations_of(noun, clause)
        excepted = [r for r in relations if r[0] in EXCEPTING]
        relations = [r for r in relations if r not in excepted]
        constants = self._substance(noun, reading) if noun and not is_pronoun(noun) else ()
        if constants:
            return self._substance_state(noun, constants, relations, reading)
        row = GoalRow((BE,), (Slot("?x"),), TRUE, BE)
        failure: Refusal | None = None
        found: list[tuple[Formula, Referent]] = []
        for referent in self.referents.referents(noun, row, row.slots[0], excepted, reading):
            if not referent.names:
                failure = failure or self.referents.missing(referent, reading)
                continue
            said = self._thing_state(referent, relations, reading)
            if isinstance(said, Refusal):
                failure = failure or said
            else:
                found.append((said, referent))
        if found:
            formula, referent = self._likeliest(found, reading) if is_pronoun(noun) else found[0]
            reading.meant[referent.noun] = referent.names
            return formula
        return failure or self.referents.missing(Referent(noun or "it", ()), reading)

    def _likeliest(self, found: Sequence[tuple[Formula, Referent]], reading: ClauseReading) -> tuple[Formula, Referent]:
        """Of what a pronoun may mean what can be so and otherwise; and where it is to be left so, what is by now."""
        fitting = [each for each in found if each[0] not in (TRUE, FALSE)] or found
        clause = reading.clause
        if clause.verb in LEAVING:
            so = not (clause.result or "").startswith("not_")
            by_now = [each for each in fitting if self.grounder.truth(each[0], reading.state) == so]
            fitting = by_now or fitting
        return fitting[0]

    def _substance(self, noun: str, reading: ClauseReading) -> tuple[str, ...]:
        """The constants that a noun names where it names no object."""
        objects = [n for n in self.nouns.things(noun, reading.state) if n not in self.world.profiles.constants]
        matches = self.world.mentions.of(noun, reading.state)
        contained = bool(matches) and all(match.how == "contained" for match in matches)
        return self.nouns.constants(noun, ("object",), reading.state) if contained or not objects else ()

    def _thing_state(
        self, referent: Referent, relations: Sequence[tuple[str, str]], reading: ClauseReading
    ) -> Formula | Refusal:
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
            return Refusal(
                RefusalKind.NOT_UNDERSTOOD,
                f"nothing here says whether {referent.noun.replace('_', ' ')} is {str(result).replace('_', ' ')}",
                "declare the adjective under 'attributes' in lexicon.yaml",
            )
        return conjunction(alive) if referent.mode is Mode.ALL else disjunction(alive)

    def _there(self, thing: str, relation: str, places: Sequence[str], reading: ClauseReading) -> Formula:
        """That what holds a substance is where that is said to be: *the beer on the shelf*."""
        return disjunction(self.nouns.related(relation, thing, p, reading.moments) for p in places if p != thing)

    def _substance_state(
        self, noun: str, constants: Sequence[str], relations: Sequence[tuple[str, str]], reading: ClauseReading
    ) -> Formula | Refusal:
        """A substance is where it is contained, and as that is."""
        result = reading.clause.result
        attributes = [*([result] if result else []), *reading.clause.phrase(noun).attributes]
        targets = [(relation, self.referents.targets(target, reading)) for relation, target in relations]
        bound = reading.memory.bound.get(noun)
        ways = []
        for constant in constants:
            for atom in self.nouns.facts_about(constant):
                things = [a for a in atom.args if a not in self.world.profiles.constants]
                changes = atom in self.world.task.index
                if len(things) != 1 or not (changes or (targets and atom in self.world.task.static)):
                    continue
                placed = [
                    TRUE if things[0] in names else self._there(things[0], r, names, reading) for r, names in targets
                ]
                if FALSE in placed:
                    continue
                if not targets and bound is not None and bound.containers and things[0] not in bound.containers:
                    continue
                said = [self.nouns.attribute(word, things[0], reading.moments) for word in attributes]
                if all(f is not None for f in said):
                    held = Atom(atom.predicate, atom.args) if changes else TRUE
                    ways.append(conjunction((held, *placed, *(f for f in said if f is not None))))
        if not ways:
            return Refusal(
                RefusalKind.NOT_UNDERSTOOD, f"'{text_of(reading.clause)}' says nothing that could be checked here"
            )
        reading.meant[noun] = tuple(constants)
        return disjunction(ways)
