"""Atoms that may hold and actions that may apply in a problem, found without grounding it.

An over-approximation in time linear in the problem: of each predicate the objects are kept that the initial state has
at each of its places, and whether some possible action adds it. What is impossible here is impossible.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from tmd.pddl.derived import as_actions
from tmd.pddl.model import (
    ActionSchema,
    Atom,
    Effect,
    GroundAtom,
    Problem,
    TypedName,
    TypeHierarchy,
    Universe,
    conjuncts,
    universe,
)

# The types of variables.
Scope = Mapping[str, tuple[str, ...]]


@dataclass(slots=True)
class Possible:
    """Possible atoms and actions of one problem.

    Attributes:
        problem: The problem.
        objects: Its objects by type.
        actions: The names of the actions that may apply.
        blocked: For each other action what it lacks: a type without objects, or an atom of its precondition.
        adding: The effects that may add an atom of a predicate, each with the types of its variables.
        assumed: Predicates whose atoms are taken to be possible.
    """

    problem: Problem
    objects: Universe
    actions: set[str] = field(default_factory=set)
    blocked: dict[str, str | Atom] = field(default_factory=dict)
    adding: dict[str, list[tuple[Effect, Scope]]] = field(default_factory=dict)
    assumed: frozenset[str] = frozenset()
    _columns: dict[str, list[dict[str, None]]] = field(default_factory=dict)
    _fitting: dict[tuple[str, int, tuple[str, ...]], bool] = field(default_factory=dict)

    @property
    def hierarchy(self) -> TypeHierarchy:
        """The types of the domain."""
        return self.objects.hierarchy

    def reaches(self, atom: GroundAtom) -> bool:
        """Return whether ``atom`` holds at the start, or some possible action may add it."""
        if atom in self.problem.init or atom.predicate in self.assumed:
            return True
        return any(self._may_add(effect.atom, scope, atom) for effect, scope in self.adding.get(atom.predicate, ()))

    def _may_add(self, pattern: Atom, scope: Scope, atom: GroundAtom) -> bool:
        objects = self.objects
        bound: dict[str, str] = {}
        for term, name in zip(pattern.terms, atom.args, strict=True):
            if term.startswith("?"):
                if bound.setdefault(term, name) != name or not objects.is_a(name, scope[term]):
                    return False
            elif term != name:
                return False
        return True

    def may_hold(self, atom: Atom, scope: Scope) -> bool:
        """Return whether some atom of this form holds at the start or may be added."""
        if atom.predicate in self.assumed or self._in_init(atom, scope):
            return True
        return any(
            self._unify(atom, scope, effect.atom, inner) for effect, inner in self.adding.get(atom.predicate, ())
        )

    def _in_init(self, atom: Atom, scope: Scope) -> bool:
        columns = self._columns.get(atom.predicate)
        if columns is None:
            return False
        for place, term in enumerate(atom.terms):
            if term.startswith("?"):
                if not self._fits(atom.predicate, place, scope[term]):
                    return False
            elif term not in columns[place]:
                return False
        return True

    def _fits(self, predicate: str, place: int, types: tuple[str, ...]) -> bool:
        """Return whether the initial state has an object of ``types`` at that place of the predicate."""
        key = predicate, place, types
        if key not in self._fitting:
            objects = self.objects
            self._fitting[key] = any(objects.is_a(name, types) for name in self._columns[predicate][place])
        return self._fitting[key]

    def _unify(self, atom: Atom, scope: Scope, other: Atom, inner: Scope) -> bool:
        objects = self.objects
        for one, two in zip(atom.terms, other.terms, strict=True):
            if one.startswith("?") and two.startswith("?"):
                if not self._overlap(scope[one], inner[two]):
                    return False
            elif one.startswith("?"):
                if not objects.is_a(two, scope[one]):
                    return False
            elif two.startswith("?"):
                if not objects.is_a(one, inner[two]):
                    return False
            elif one != two:
                return False
        return True

    def _overlap(self, one: Sequence[str], other: Sequence[str]) -> bool:
        ancestors = self.hierarchy.ancestors
        return any(a in ancestors(b) or b in ancestors(a) for a in one for b in other)

    def collect_init(self) -> None:
        """Note which objects stand at which place of which predicate at the start."""
        for atom in self.problem.init:
            columns = self._columns.setdefault(atom.predicate, [{} for _ in atom.args])
            for column, name in zip(columns, atom.args, strict=True):
                column[name] = None

    def lacks(self, action: ActionSchema) -> str | Atom | None:
        """Return the first thing that keeps ``action`` from applying, as far as is known now."""
        objects = self.objects
        for parameter in action.parameters:
            if not objects.of(parameter.types):
                return parameter.types[0]
        scope = types_of(action.parameters)
        for part in conjuncts(action.precondition):
            if isinstance(part, Atom) and not self.may_hold(part, scope):
                return part
        return None


def possible(problem: Problem, assumed: Iterable[str] = ()) -> Possible:
    """Return the possible atoms and actions of a sound problem, if any atom of the predicates ``assumed`` may hold."""
    found = Possible(problem, universe(problem), assumed=frozenset(assumed))
    found.collect_init()
    waiting: dict[str, list[ActionSchema]] = {}
    ready = list(reversed(as_actions(problem.domain).actions))
    while ready:
        action = ready.pop()
        lack = found.lacks(action)
        if lack is None:
            found.blocked.pop(action.name, None)
            for predicate in _admit(found, action):
                ready += waiting.pop(predicate, ())
        else:
            found.blocked[action.name] = lack
            if isinstance(lack, Atom):
                waiting.setdefault(lack.predicate, []).append(action)
    return found


def types_of(parameters: Iterable[TypedName]) -> dict[str, tuple[str, ...]]:
    """Return the types of each parameter."""
    return {parameter.name: parameter.types for parameter in parameters}


def _admit(found: Possible, action: ActionSchema) -> list[str]:
    """Let the effects of ``action`` count; the predicates that it adds."""
    found.actions.add(action.name)
    scope = types_of(action.parameters)
    for effect in action.effects:
        if effect.positive:
            inner = scope | types_of(effect.parameters)
            found.adding.setdefault(effect.atom.predicate, []).append((effect, inner))
    return list(dict.fromkeys(effect.atom.predicate for effect in action.effects if effect.positive))
