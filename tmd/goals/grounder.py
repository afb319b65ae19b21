"""Conditions of rows, ground in one environment: slots filled, ``was`` and ``first`` looked up, parts stood in for.

Where a fact can never hold of a thing, the nearest things that it can hold of stand in: parts, then what the thing or
its parts control, then the whole and its other parts. *Open the fridge* opens its door, *turn on the stove* a burner.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from tmd.goals.sources.table import FIRST, WAS, split_predicate
from tmd.pddl.ground_formula import FALSE, TRUE, conjunction, disjunction, negation
from tmd.pddl.model import And, Atom, Equals, Exists, Forall, Formula, GroundAtom, Imply, Not, Or, conjuncts, universe
from tmd.pddl.semantics import bindings, holds
from tmd.pddl.task import Bits, Task
from tmd.pddl.writer import format_formula
from tmd.veil.world import PART_OF, World


@dataclass(frozen=True, slots=True)
class Moments:
    """The states that a condition may speak of: when its clause begins, and before the whole text."""

    now: Bits
    first: Bits


class Grounder:
    """Grounds conditions in one environment.

    Args:
        world: The environment.
    """

    def __init__(self, world: World) -> None:
        self.world = world
        self.task = world.task
        self._objects = universe(world.task.problem)
        self._relatives: dict[str, tuple[tuple[str, ...], ...]] = {}
        self.exact = False
        """Nothing stands in for what was named."""
        self.excepted: frozenset[str] = frozenset()
        """Objects that ``forall`` leaves out: *clear the table except the cup*."""
        self.live = 0
        """How many atoms of the conditions ground last may hold, counted by who asks."""

    def can_hold(self, atom: GroundAtom) -> bool:
        """Whether an atom may hold at all, as far as relaxed reachability tells."""
        return atom in self.task.index or atom in self.task.static

    def holds(self, atom: GroundAtom, state: Bits) -> bool:
        """Whether an atom holds in ``state``."""
        bit = self.task.index.get(atom)
        return bool(state >> bit & 1) if bit is not None else atom in self.task.static

    def is_a(self, name: str, types: tuple[str, ...]) -> bool:
        """Whether an object is of one of ``types``."""
        return self._objects.is_a(name, types)

    def fits(self, name: str, types: tuple[str, ...]) -> bool:
        """Whether an object, a part of it or what it controls is of one of ``types``: it may stand where they do."""
        return self.is_a(name, types) or any(
            self.is_a(other, types) for level in range(2) for other in self.relatives(name, level)
        )

    def of_types(self, types: tuple[str, ...]) -> tuple[str, ...]:
        """The objects of any of ``types``."""
        return self._objects.of(types)

    def truth(self, formula: Formula, state: Bits) -> bool:
        """Whether a ground condition without operators of ours holds in ``state``."""
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
        """``formula`` over ground atoms that may hold, joined by ``and``, ``or`` and ``not``.

        Args:
            formula: The condition.
            binding: Objects for its variables.
            slots: The variables for which relatives may stand in.
            moments: What ``was`` and ``first`` look at.
        """
        return self._ground(formula, dict(binding), frozenset(slots), moments)

    def _ground(self, formula: Formula, binding: dict[str, str], slots: frozenset[str], moments: Moments) -> Formula:
        match formula:
            case Atom():
                return self._atom(formula, binding, slots, moments)
            case Equals(left, right):
                return TRUE if binding.get(left, left) == binding.get(right, right) else FALSE
            case Not(part):
                return negation(self._ground(part, binding, slots, moments))
            case And(parts):
                return conjunction(self._ground(part, binding, slots, moments) for part in parts)
            case Or(parts):
                return self._any_way(parts, binding, slots, moments)
            case Imply(left, right):
                unless = negation(self._ground(left, binding, slots, moments))
                return unless if unless == TRUE else disjunction((unless, self._ground(right, binding, slots, moments)))
            case Forall(parameters, part):
                every = bindings(parameters, self._objects, binding)
                meant = (b for b in every if not any(b[p.name] in self.excepted for p in parameters))
                return conjunction(self._ground(part, dict(b), slots, moments) for b in meant)
            case Exists(parameters, part):
                found = bindings(parameters, self._objects, binding)
                return disjunction(self._ground(part, dict(b), slots, moments) for b in found)

    def _any_way(
        self, parts: Sequence[Formula], binding: dict[str, str], slots: frozenset[str], moments: Moments
    ) -> Formula:
        """A disjunction: where one way is open for what was named itself, nothing stands in for it in another."""
        before, self.exact = self.exact, True
        try:
            plain = [self._ground(part, binding, slots, moments) for part in parts]
        finally:
            self.exact = before
        if self.exact or any(part != FALSE for part in plain):
            return disjunction(plain)
        return disjunction(self._ground(part, binding, slots, moments) for part in parts)

    def _atom(self, formula: Atom, binding: dict[str, str], slots: frozenset[str], moments: Moments) -> Formula:
        predicate, operator = split_predicate(formula.predicate)
        atom = GroundAtom(predicate, tuple(binding.get(term, term) for term in formula.terms))
        meant = self._standing_in(atom, [place for place, term in enumerate(formula.terms) if term in slots])
        self.live += len(meant)
        if operator:
            state = moments.now if operator == WAS else moments.first
            assert operator in (WAS, FIRST)
            return TRUE if any(self.holds(one, state) for one in meant) else FALSE
        if any(one in self.task.static and one not in self.task.index for one in meant):
            return TRUE
        return disjunction(Atom(one.predicate, one.args) for one in meant)

    def _standing_in(self, atom: GroundAtom, places: list[int]) -> list[GroundAtom]:
        """The atom, if it can hold; otherwise those of the nearest relatives that can."""
        if self.can_hold(atom):
            return [atom]
        for level in range(4):
            for place in reversed(places):
                found = []
                for other in self.relatives(atom.args[place], level):
                    changed = GroundAtom(atom.predicate, (*atom.args[:place], other, *atom.args[place + 1 :]))
                    if self.can_hold(changed) and len(set(changed.args)) == len(changed.args):
                        found.append(changed)
                if found:
                    return found
        return []

    def relatives(self, name: str, level: int) -> tuple[str, ...]:
        """What may stand in for a thing: 0 its parts, 1 what it is linked to, 2 its whole, 3 other parts."""
        if self.exact:
            return ()
        if name not in self._relatives:
            self._relatives[name] = self._find_relatives(name)
        return self._relatives[name][level]

    def _find_relatives(self, name: str) -> tuple[tuple[str, ...], ...]:
        """Parts; what the thing or its parts are linked to by an edge; the whole; the whole's other parts."""
        profiles = self.world.profiles
        parts = tuple(part for _, part in profiles.parts.get(name, ()))
        own = {name, *parts}
        linked: dict[str, None] = {}
        for (tail, head), predicates in sorted(profiles.links.items()):
            if tail in own and head not in own and not self._tells_nothing(predicates):
                linked[head] = None
        if not linked:
            for (tail, head), predicates in sorted(profiles.links.items()):
                if head in own and tail not in own and not self._tells_nothing(predicates):
                    linked[tail] = None
        whole = profiles.wholes.get(name)
        siblings = tuple(p for _, p in profiles.parts.get(whole, ()) if p != name) if whole else ()
        return parts, tuple(linked), (whole,) if whole else (), siblings

    def _tells_nothing(self, predicates: Iterable[str]) -> bool:
        """Whether only predicates that hold of everything with itself, or may change, join two things.

        These tell nothing of what belongs together: where a fixture stands is said as where a cup stands.
        """
        return all(predicate in self.reflexive or predicate in self._changing for predicate in predicates)

    @cached_property
    def _changing(self) -> frozenset[str]:
        return frozenset(atom.predicate for atom in self.task.atoms)

    @cached_property
    def reflexive(self) -> frozenset[str]:
        """The predicates that join things with themselves, or parts with their whole: they say nothing of two."""
        return frozenset(a.predicate for a in self.task.static if len(a.args) == 2 and a.args[0] == a.args[1]) | {
            PART_OF
        }


_OF_TYPE = "it is not of the type"


def why_impossible(condition: Formula, binding: Mapping[str, str], task: Task, grounder: Grounder) -> str:
    """The first fact that can never hold, with what forbids it."""
    reasons = [why_never(atom, task) for atom in _wanted(condition, binding) if not grounder.can_hold(atom)]
    # a broken condition says more than that something is of another type
    broken = [reason for reason in reasons if _OF_TYPE not in reason]
    return next(iter((*broken, *reasons)), "no plan can bring that about")


def why_never(atom: GroundAtom, task: Task) -> str:
    """What forbids that ``atom`` ever becomes true: the broken condition of the action that comes nearest to it."""
    problem = task.problem
    changing = {atom.predicate for atom in task.atoms}
    objects = universe(problem)
    wrong_kind: str | None = None
    for action in problem.domain.actions:
        for effect in action.effects:
            if not effect.positive or effect.atom.predicate != atom.predicate or effect.parameters:
                continue
            binding = {t: a for t, a in zip(effect.atom.terms, atom.args, strict=True) if t.startswith("?")}
            if any(t != a for t, a in zip(effect.atom.terms, atom.args, strict=True) if not t.startswith("?")):
                continue
            wrong = [p for p in action.parameters if p.name in binding and not objects.is_a(binding[p.name], p.types)]
            if wrong:
                wanted = " or ".join(wrong[0].types)
                wrong_kind = wrong_kind or f"{action.name} takes no {binding[wrong[0].name]}: {_OF_TYPE} {wanted}"
                continue
            for part in conjuncts(action.precondition):
                names = {a.predicate for a in _atoms(part)}
                variables = {t for a in _atoms(part) for t in a.terms if t.startswith("?")}
                if names & changing or not variables <= set(binding) | _quantified(part):
                    continue
                if not holds(part, problem.init, objects, binding):
                    return f"{action.name} needs {_said(part, binding)}"
    return wrong_kind or f"no action makes {atom} true"


def _said(part: Formula, binding: Mapping[str, str]) -> str:
    text = format_formula(part)
    for variable, name in sorted(binding.items(), key=lambda pair: -len(pair[0])):
        text = text.replace(variable, name)
    return " ".join(text.split())


def _wanted(condition: Formula, binding: Mapping[str, str]) -> Iterator[GroundAtom]:
    """The ground atoms of a condition whose variables are bound."""
    for atom in _atoms(condition):
        args = tuple(binding.get(term, term) for term in atom.terms)
        if not any(a.startswith("?") for a in args):
            yield GroundAtom(split_predicate(atom.predicate)[0], args)


def _atoms(formula: Formula) -> Iterator[Atom]:
    match formula:
        case Atom():
            yield formula
        case Not(part) | Forall(_, part) | Exists(_, part):
            yield from _atoms(part)
        case And(parts) | Or(parts):
            for part in parts:
                yield from _atoms(part)
        case Imply(left, right):
            yield from _atoms(left)
            yield from _atoms(right)


def _quantified(formula: Formula) -> set[str]:
    match formula:
        case Forall(parameters, part) | Exists(parameters, part):
            return {p.name for p in parameters} | _quantified(part)
        case Not(part):
            return _quantified(part)
        case And(parts) | Or(parts):
            return set().union(*(_quantified(part) for part in parts))
        case Imply(left, right):
            return _quantified(left) | _quantified(right)
    return set()
