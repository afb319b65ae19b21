"""Conditions of rows, ground in one environment: slots filled, ``was`` and ``first`` looked up, parts stood in for.

Where a fact can never hold of a thing, the nearest things that it can hold of stand in: parts, then what the thing or
its parts control, then the whole and its other parts. *Open the fridge* opens its door, *turn on the stove* a burner.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from tmd.goals.sources.table import WAS, split_predicate
from tmd.pddl.ground_formula import FALSE, TRUE, conjunction, disjunction, negation
from tmd.pddl.model import (
    And,
    Atom,
    Equals,
    Exists,
    Forall,
    Formula,
    GroundAtom,
    Imply,
    Not,
    Or,
    TypedName,
)  # fmt: skip
from tmd.pddl.semantics import bindings
from tmd.pddl.task import Bits
from tmd.world.world import PART_OF, World

_LEVELS = 4
"""The kinds of relatives: parts, what the thing is linked to, its whole, the other parts of that."""


@dataclass(frozen=True, slots=True)
class Moments:
    """The states that a condition may speak of, and what it does not speak of.

    Attributes:
        now: The state when its clause begins.
        first: The state before the whole text.
        excepted: Objects that ``forall`` leaves out: *clear the table except the cup*.
    """

    now: Bits
    first: Bits
    excepted: frozenset[str] = frozenset()


class Grounder:
    """Grounds conditions in one environment.

    Args:
        world: The environment.
        exact: Nothing stands in for what was named.

    Attributes:
        known: Atoms that were ground without exceptions, by predicate, objects and the places of slots: how many atoms
            may hold, and the formula.
    """

    def __init__(self, world: World, *, exact: bool = False) -> None:
        self.world = world
        self.task = world.task
        self.exact = exact
        self.objects = world.objects
        self._relatives: dict[str, tuple[tuple[str, ...], ...]] = {}
        self.known: dict[tuple[str, tuple[str, ...], tuple[int, ...]], tuple[int, Formula]] = {}

    @cached_property
    def exactly(self) -> Grounder:
        """The same without stand-ins."""
        return self if self.exact else Grounder(self.world, exact=True)

    def can_hold(self, atom: GroundAtom) -> bool:
        """Return whether an atom may hold at all, as far as relaxed reachability tells."""
        return atom in self.task.index or atom in self.task.static

    def holds(self, atom: GroundAtom, state: Bits) -> bool:
        """Return whether an atom holds in ``state``."""
        bit = self.task.index.get(atom)
        return bool(state >> bit & 1) if bit is not None else atom in self.task.static

    def is_a(self, name: str, types: tuple[str, ...]) -> bool:
        """Return whether an object is of one of ``types``."""
        return self.objects.is_a(name, types)

    def fits(self, name: str, types: tuple[str, ...]) -> bool:
        """Return whether an object, a part of it or what it controls is of one of ``types``."""
        return any(self.is_a(other, types) for other in (name, *self.near(name)))

    def truth(self, formula: Formula, state: Bits) -> bool:
        """Return whether a ground condition without operators of ours holds in ``state``."""
        match formula:
            case Atom(predicate, terms):
                return self.holds(GroundAtom(predicate, terms), state)
            case Not(part):
                return not self.truth(part, state)
            case And(parts):
                return all(self.truth(part, state) for part in parts)
            case Or(parts):
                return any(self.truth(part, state) for part in parts)
        raise TypeError(f"not ground: {formula}")

    def ground(self, formula: Formula, binding: Mapping[str, str], slots: Iterable[str], moments: Moments) -> Formula:
        """Return ``formula`` over ground atoms that may hold, joined by ``and``, ``or`` and ``not``.

        Args:
            formula: The condition.
            binding: Objects for its variables.
            slots: The variables for which relatives may stand in.
            moments: What ``was`` and ``first`` look at.
        """
        return _Grounding(self, frozenset(slots), moments).of(formula, binding)

    def ground_live(
        self, formula: Formula, binding: Mapping[str, str], slots: Iterable[str], moments: Moments
    ) -> tuple[Formula, bool]:
        """Return the same, and whether any of its atoms may hold."""
        grounding = _Grounding(self, frozenset(slots), moments)
        return grounding.of(formula, binding), grounding.live > 0

    def standing_in(self, atom: GroundAtom, places: Sequence[int]) -> list[GroundAtom]:
        """Return the atom, if it can hold; otherwise those of the nearest relatives that can."""
        if self.can_hold(atom):
            return [atom]
        for level in range(_LEVELS):
            for place in reversed(places):
                others = (
                    atom._replace(args=(*atom.args[:place], other, *atom.args[place + 1 :]))
                    for other in self.relatives(atom.args[place], level)
                )
                found = [one for one in others if self.can_hold(one) and len(set(one.args)) == len(one.args)]
                if found:
                    return found
        return []

    def near(self, name: str) -> tuple[str, ...]:
        """Return the parts of a thing and what it is linked to."""
        return (*self.relatives(name, 0), *self.relatives(name, 1))

    def relatives(self, name: str, level: int) -> tuple[str, ...]:
        """Return what may stand in for a thing: 0 its parts, 1 what it is linked to, 2 its whole, 3 other parts."""
        if self.exact:
            return ()
        if name not in self._relatives:
            self._relatives[name] = self._find_relatives(name)
        return self._relatives[name][level]

    def _find_relatives(self, name: str) -> tuple[tuple[str, ...], ...]:
        profiles = self.world.profiles
        parts = tuple(part for _, part in profiles.parts.get(name, ()))
        linked = self._linked({name, *parts})
        whole = profiles.wholes.get(name)
        siblings = tuple(p for _, p in profiles.parts.get(whole, ()) if p != name) if whole else ()
        if whole is None:  # a knob stands in for its burner, but no pod for its machine, and no hat for its owner
            linked = tuple(other for other in linked if other in profiles.wholes)
        return parts, linked, (whole,) if whole else (), siblings

    def _linked(self, own: Collection[str]) -> tuple[str, ...]:
        """Return what a thing or its parts are linked to, or else what is linked to them."""
        heads = dict.fromkeys(head for tail, head in self.links if tail in own and head not in own)
        return tuple(heads or dict.fromkeys(t for t, h in self.links if h in own and t not in own))

    @cached_property
    def links(self) -> tuple[tuple[str, str], ...]:
        """Pairs of things that the environment links for good: a knob and its burner."""
        links = sorted(self.world.profiles.links.items())
        return tuple(pair for pair, predicates in links if not self._tells_nothing(predicates))

    def _tells_nothing(self, predicates: Iterable[str]) -> bool:
        """Return whether only predicates that hold of everything with itself, or may change, join two things.

        These tell nothing of what belongs together: where a fixture is says as much as where a cup is.
        """
        return all(predicate in self.reflexive or predicate in self.changing for predicate in predicates)

    @cached_property
    def changing(self) -> frozenset[str]:
        """The predicates of facts that may change."""
        return frozenset(atom.predicate for atom in self.task.atoms)

    @cached_property
    def reflexive(self) -> frozenset[str]:
        """The predicates that join things with themselves, or parts with their whole."""
        twice = (a.predicate for a in self.task.static if len(a.args) == 2 and a.args[0] == a.args[1])
        return frozenset((*twice, PART_OF))


@dataclass(slots=True)
class _Grounding:
    """The work of grounding one condition; it counts the atoms that may hold."""

    grounder: Grounder
    slots: frozenset[str]
    moments: Moments
    live: int = 0

    def of(self, formula: Formula, binding: Mapping[str, str]) -> Formula:
        match formula:
            case Atom():
                return self._atom(formula, binding)
            case Equals(left, right):
                return TRUE if binding.get(left, left) == binding.get(right, right) else FALSE
            case Not(Exists(parameters, part)):  # "nothing is in it", but for what is excepted
                return self.of(Forall(parameters, Not(part)), binding)
            case Not(part):
                return negation(self.of(part, binding))
            case And(parts):
                return conjunction(self.of(part, binding) for part in parts)
            case Or(parts):
                return self._any_way(parts, binding)
            case Imply(left, right):
                unless = negation(self.of(left, binding))
                return unless if unless == TRUE else disjunction((unless, self.of(right, binding)))
            case Forall(parameters, part):
                return conjunction(self._each(part, self._meant(parameters, binding)))
            case Exists(parameters, part):
                return disjunction(self._each(part, bindings(parameters, self.grounder.objects, binding)))

    def _each(self, part: Formula, ways: Iterable[Mapping[str, str]]) -> Iterator[Formula]:
        return (self.of(part, binding) for binding in ways)

    def _meant(self, parameters: tuple[TypedName, ...], binding: Mapping[str, str]) -> Iterable[Mapping[str, str]]:
        """Return the bindings of variables to what is not excepted."""
        names = [parameter.name for parameter in parameters]
        every = bindings(parameters, self.grounder.objects, binding)
        return (each for each in every if self.moments.excepted.isdisjoint(each[name] for name in names))

    def _any_way(self, parts: Sequence[Formula], binding: Mapping[str, str]) -> Formula:
        """Return a disjunction: where one way is open for what was named, nothing stands in for it in another."""
        exactly = _Grounding(self.grounder.exactly, self.slots, self.moments)
        plain = [exactly.of(part, binding) for part in parts]
        self.live += exactly.live
        if self.grounder.exact or any(part != FALSE for part in plain):
            return disjunction(plain)
        return disjunction(self.of(part, binding) for part in parts)

    def _atom(self, formula: Atom, binding: Mapping[str, str]) -> Formula:
        args = tuple([binding.get(term, term) for term in formula.terms])
        places = tuple([place for place, term in enumerate(formula.terms) if term in self.slots])
        key = formula.predicate, args, places
        known = self.grounder.known.get(key)
        if known is None or self.moments.excepted:
            predicate, operator = split_predicate(formula.predicate)
            known = self._new_atom(GroundAtom(predicate, args), operator, places)
            if not operator and not self.moments.excepted:
                self.grounder.known[key] = known
        self.live += known[0]
        return known[1]

    def _new_atom(self, atom: GroundAtom, operator: str, places: Sequence[int]) -> tuple[int, Formula]:
        spared = self.moments.excepted
        meant = [a for a in self.grounder.standing_in(atom, places) if a == atom or spared.isdisjoint(a.args)]
        if operator:
            state = self.moments.now if operator == WAS else self.moments.first
            return len(meant), TRUE if any(self.grounder.holds(one, state) for one in meant) else FALSE
        task = self.grounder.task
        if any(one in task.static and one not in task.index for one in meant):
            return len(meant), TRUE
        return len(meant), disjunction(Atom(one.predicate, one.args) for one in meant)
