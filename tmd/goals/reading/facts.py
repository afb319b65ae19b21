"""The facts of one environment as words say them: adjectives of things, and relations between things."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from functools import cached_property

from tmd.goals.grounder import Grounder, Moments
from tmd.goals.sources.actions import actor_types, participle, plain_words
from tmd.goals.sources.table import RELATION, GoalTable
from tmd.goals.words import (
    BE,
    CONTRARY,
    NEGATED,
    PREPOSITIONS,
    is_relation,
    relations_said,
    state_words,
    table,
    the_word,
    words_of,
)
from tmd.language.lexicon.lexicon import section
from tmd.language.lexicon.names import split_name, states_in_name, words_in_name
from tmd.pddl.ground_formula import FALSE, TRUE, disjunction, negation
from tmd.pddl.model import OBJECT, Atom, Formula, GroundAtom, hierarchy
from tmd.pddl.task import Bits
from tmd.world.world import World

_KNOWN = frozenset(word for members in PREPOSITIONS.values() for word in members)


class Facts:
    """The facts of one environment.

    Args:
        world: The environment.
        table: The meanings of adjectives, and of being somewhere.
        grounder: Grounds their conditions.
    """

    def __init__(self, world: World, table: GoalTable, grounder: Grounder) -> None:
        self.world = world
        self.table = table
        self.grounder = grounder
        self._of_object: dict[str, list[GroundAtom]] = {}
        for atom in (*world.task.atoms, *sorted(world.task.static)):
            for name in dict.fromkeys(atom.args):
                self._of_object.setdefault(name, []).append(atom)

    def is_constant(self, name: str) -> bool:
        """Return whether a name is a constant of the domain: a substance, a setting or a relation."""
        return name in self.world.profiles.constants

    def facts_about(self, name: str) -> Sequence[GroundAtom]:
        """Return the atoms that may hold and have ``name`` among their arguments."""
        return self._of_object.get(name, ())

    def turns_into(self, constant: str) -> tuple[str, ...]:
        """Return the constants that a fact that never changes leads to from ``constant``: what ramen cooks into."""
        pairs = (a for a in self.facts_about(constant) if a in self.world.task.static and len(a.args) == 2)
        return tuple(atom.args[1] for atom in pairs if atom.args[0] == constant)

    def contents(self, thing: str, state: Bits) -> tuple[str, ...]:
        """Return the constants beside ``thing`` in facts of two that hold now and may change."""
        pairs = (
            a for a in self._pairs(thing) if a.predicate in self.grounder.changing and self.grounder.holds(a, state)
        )
        return tuple(dict.fromkeys(atom.args[1] for atom in pairs))

    def _pairs(self, thing: str) -> Iterable[GroundAtom]:
        pairs = (a for a in self.facts_about(thing) if len(a.args) == 2 and a.args[0] == thing)
        return (atom for atom in pairs if self.is_constant(atom.args[1]))

    def is_supply(self, thing: str) -> bool:
        """Return whether a thing has what it contains from the start, and never anything else: a bottle of syrup."""
        inside = {atom.args[1] for atom in self._pairs(thing)}
        return len(inside) == 1 and set(self.contents(thing, self.world.task.init)) == inside

    def attribute(self, word: str, name: str, moments: Moments) -> Formula | None:
        """Return that ``name`` is as an adjective says; ``None`` for an adjective that nothing here explains."""
        if word.startswith(NEGATED):
            inner = self.attribute(word.removeprefix(NEGATED), name, moments)
            return None if inner is None else negation(inner)
        if word in self.table.attributes:
            condition = self.table.attributes[word]
            ways = (self.grounder.ground(condition, {"?x": one}, ("?x",), moments) for one in self._with_near(name))
            return next((way for way in ways if way != FALSE), FALSE)  # a lamp is brighter by its knob
        found = self.state_of(state_words(word), name)
        if found is None and word in words_of("empty"):
            return self._emptied(name)
        prefix = next(filter(word.startswith, sorted(section("undoing"))), "") if found is None else ""
        undone = self.attribute(word.removeprefix(prefix), name, moments) if prefix else None
        return found if undone is None else negation(undone)  # "unopened"

    def is_so(self, word: str, name: str, moments: Moments) -> bool | None:
        """Return whether ``name`` is as an adjective says now; ``None`` for one that nothing here explains."""
        formula = self.attribute(word, name, moments)
        return None if formula is None else self.grounder.truth(formula, moments.now)

    def _emptied(self, name: str) -> Formula | None:
        """Return that nothing is in a thing; ``None`` where nothing ever is."""
        inside = disjunction(self._related_by_facts("in", other, name) for other in self.world.profiles.objects)
        return None if inside == FALSE else negation(inside)

    def state_of(self, words: Iterable[str], name: str) -> Formula | None:
        """Return that ``name`` is in a state that one of ``words`` names, by a predicate or a constant.

        Words with a minus say that it is not in such a state. ``None`` where no fact here has such a word.
        """
        listed = sorted(words, key=lambda word: word.startswith(CONTRARY))
        for candidate in self._with_near(name):
            for word in listed:
                found = self._named_state(word.removeprefix(CONTRARY), candidate)
                if found is not None:
                    return negation(found) if word.startswith(CONTRARY) else found
        never = next((word for word in listed if self._is_never(word.removeprefix(CONTRARY), name)), None)
        return None if never is None else TRUE if never.startswith(CONTRARY) else FALSE

    def _is_never(self, word: str, name: str) -> bool:
        """Return whether a predicate is for such things, is named so, and holds of this one in no state."""
        kinds = {OBJECT, *self.world.mentions.types.get(name, ())}
        domain = self.world.domain
        unary = (p for p in domain.predicates if len(p.parameters) == 1 and not kinds.isdisjoint(p.parameters[0].types))
        return any(plain_words(p, hierarchy(domain)) == (word,) for p in unary)

    def _with_near(self, name: str) -> Iterator[str]:
        """Yield a thing and, where they are asked for, its nearest relatives."""
        yield name
        yield from self.grounder.near(name)

    def _named_state(self, word: str, name: str) -> Formula | None:
        atoms = [a for a in self.facts_about(name) if self._says_state(a, word, name)]
        if any(a not in self.world.task.index for a in atoms):
            return TRUE
        return disjunction(Atom(a.predicate, a.args) for a in atoms) if atoms else None

    def _says_state(self, atom: GroundAtom, word: str, name: str) -> bool:
        others = [a for a in atom.args if a != name]
        if others == [word] and (self.is_constant(word) or self._is_value(word, name)):
            return True
        return word in states_in_name(atom.predicate) and all(self.is_constant(n) or self.acts(n) for n in others)

    def acts(self, name: str) -> bool:
        """Return whether a thing is one of those who act: Rex is ``on-lead``, whoever holds it."""
        return not self.actors.isdisjoint(self.world.mentions.types.get(name, ()))

    @cached_property
    def actors(self) -> frozenset[str]:
        """The types of those who act."""
        return actor_types(self.world.domain)

    def _is_value(self, word: str, name: str) -> bool:
        """Return whether an object says how another one is: "blue" of (painted table blue), but no block of another."""
        kinds = self.world.mentions.types
        return set(kinds.get(word, ())).isdisjoint(set(kinds.get(name, ())) - {OBJECT})

    def related(self, relation: str, name: str, target: str, moments: Moments) -> Formula:
        """Return that ``name`` is in a relation to ``target``: as the table says it, or as the facts themselves do."""
        if self._always_related(relation, name, target):
            return TRUE
        rows = [(row, row.direct, row.places[0]) for row in self.table.of(BE) if row.direct and len(row.places) == 1]
        inverse = table("inverse").get(relation)
        if inverse and not any(relations_said(relation, place.prepositions) for _, _, place in rows):
            return self.related(inverse[0], target, name, moments)
        for row, direct, place in rows:
            assert direct is not None
            ends = {direct.variable: name, place.variable: target}
            found = disjunction(
                self.grounder.ground(row.condition, {**ends, RELATION: one}, ends, moments)
                for one in relations_said(relation, place.prepositions)
            )
            if found != FALSE:
                return found
        return self._related_by_facts(relation, name, target)

    def _related_by_facts(self, relation: str, name: str, target: str) -> Formula:
        """Return the facts that have both, and the relation's name as a constant or in the predicate."""
        things = not (self.is_constant(target) or self.is_constant(name))
        words = {group for group, members in PREPOSITIONS.items() if relation in members} | {relation}
        inside = bool(words & words_of("relations", "contents"))
        says = _Says(words, things=things, inside=inside)
        # (on a b) says where a is, not where b is
        ordered = things and not inside and not is_relation(relation, "locating")
        for end in (target, *(other for level in range(3) for other in self.grounder.relatives(target, level))):
            joining = self._joining(name, end, ordered=ordered)
            found = [atom for atom in joining if says.so(atom, {name, end}, atom in self.world.task.index)]
            if found:
                return disjunction(Atom(a.predicate, a.args) for a in found)
        return FALSE

    def _always_related(self, relation: str, name: str, target: str) -> bool:
        """Return whether a thing is a part of another one, or is named after it."""
        if is_relation(relation, "part") and self.world.profiles.wholes.get(name) == target:
            return True  # "the button on the microwave"
        if is_relation(relation, "partitive") and _called_after(name, target):
            return True  # racing_front, "the front wheel of the racing bike"
        # ``hall-heater`` is in the hall, if it stands nowhere else
        apart = is_relation(relation, "resting") and name not in self.world.profiles.wholes
        nowhere = apart and all(len(fact.args) == 1 for fact in self.facts_about(name))
        return nowhere and set(split_name(target)) < set(split_name(name))

    def _joining(self, name: str, end: str, *, ordered: bool) -> Iterable[GroundAtom]:
        """Return the facts that join two things and say something of these two; in this order, if ``ordered``."""
        facts = (a for a in self.facts_about(name) if end in a.args and a.predicate not in self.grounder.reflexive)
        return (atom for atom in facts if not ordered or atom.args.index(name) <= atom.args.index(end))

    def related_now(
        self, names: Iterable[str], relation: str, targets: Sequence[str], moments: Moments
    ) -> tuple[str, ...]:
        """Return those of ``names`` that are in a relation to one of ``targets`` when the clause begins."""
        partitive = the_word("relations", "partitive")
        accompanied = is_relation(relation, "accompanying")  # "the bike with the flat wheel"

        def holds(name: str, target: str) -> bool:
            said = [self.related(relation, name, target, moments)]
            said += [self._related_by_facts(partitive, name, target)] if accompanied else []
            return name != target and any(self.grounder.truth(formula, moments.now) for formula in said)

        return tuple(name for name in names if any(holds(name, target) for target in targets))


class _Says:
    """The test of whether a fact that joins two things says a relation.

    Args:
        words: The relation, and its name in patterns.
        things: Neither end is a constant.
        inside: It is about contents.
    """

    def __init__(self, words: set[str], *, things: bool, inside: bool) -> None:
        self.words = words
        self.named = {w for word in words for w in PREPOSITIONS.get(word, ())} | words
        belongs = inside and things and bool(words & words_of("relations", "partitive"))
        self.anywhere = belongs or bool(words & words_of("relations", "anchored"))
        self.things = things
        self.inside = inside

    def so(self, atom: GroundAtom, ends: set[str], changes: bool) -> bool:
        """Return whether an atom says it of two things."""
        others = [argument for argument in atom.args if argument not in ends]
        known = set(others).intersection(PREPOSITIONS)
        if known:
            return self.anywhere or bool(known & self.words)
        return self._named(words_in_name(atom.predicate), alone=not others, changes=changes)

    def _named(self, parts: Collection[str], *, alone: bool, changes: bool) -> bool:
        """Return whether the words of a predicate's name say it."""
        parts = set(parts)
        if parts & self.named:
            return True
        if parts & words_of("located"):
            return self.anywhere or bool(self.words & words_of("relations", "resting"))
        if parts & _KNOWN:
            return self.anywhere or self._owned(parts, changes=changes)
        if self.inside and not (self.things and self.words & words_of("relations", "partitive")):
            return not self.things and alone
        joins = bool(self.words & words_of("relations", "joining")) and self.things  # "the door to the hall"
        return (changes and self._fastened(parts)) or (self.anywhere and (changes or joins))

    def _owned(self, parts: Collection[str], *, changes: bool) -> bool:
        """Return whether a predicate says for ever what one thing is of: "the window in the hall" is of the hall."""
        resting = self.things and not changes and bool(self.words & words_of("relations", "resting"))
        return resting and not words_of("relations", "partitive").isdisjoint(parts)

    def _fastened(self, parts: Collection[str]) -> bool:
        """Return whether a predicate says that one thing was fastened to another: "the battery in the van"."""
        resting = self.things and bool(self.words & words_of("relations", "resting"))
        return resting and any(participle(part) for part in parts)


def _called_after(name: str, target: str) -> bool:
    """Return whether a name has the words that tell another thing from those of its class."""
    *modifiers, head = [word for word in split_name(target) if not word.isdigit()] or [target]
    words = set(split_name(name))
    return bool(modifiers) and set(modifiers) <= words and head not in words
