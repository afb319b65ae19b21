"""The types of an untyped problem: its static predicates of one thing, as ``(garment ?g)``, that actions require.

An action without types says by its precondition what its parameters are. Read as types, these predicates tell as much
as a typed domain does, and the problem stays the same: the predicates and the preconditions are kept.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from tmd.pddl.model import (
    OBJECT,
    ActionSchema,
    Atom,
    Domain,
    Predicate,
    Problem,
    TypeDeclaration,
    TypedName,
    conjuncts,
    hierarchy,
    walk,
)

Extents = Mapping[str, frozenset[str]]
"""For each predicate that may be a type the objects that it holds of."""
_UNTYPED = (OBJECT,)


def with_inferred_types(problem: Problem) -> Problem:
    """Return an untyped problem with types; a problem with types, or without such predicates, as it is."""
    domain = problem.domain
    if domain.types or any(p.types != _UNTYPED for a in domain.actions for p in a.parameters):
        return problem
    extents = _extents(problem)
    required = {kind for action in domain.actions for kind in _required(action, extents).values()}
    if not required:
        return problem
    types = _declared({kind: extents[kind] for kind in required | _dividing(required, extents)})
    kinds = {name: kind for kind in types for name in extents[kind]}  # the narrowest comes last
    typed = _Typed(types, extents, kinds)
    actions = tuple(typed.action(action) for action in domain.actions)
    predicates = typed.predicates(domain, actions, problem)
    constants, objects = map(typed.objects, (domain.constants, problem.objects))
    declared = tuple(TypeDeclaration(kind, parent) for kind, parent in types.items())
    domain = replace(domain, types=declared, constants=constants, predicates=predicates, actions=actions)
    return replace(problem, domain=domain, objects=objects)


def _extents(problem: Problem) -> Extents:
    """Return the objects of each predicate of one thing that no action changes, where there are any."""
    domain = problem.domain
    changing = {e.atom.predicate for action in domain.actions for e in action.effects}
    changing |= {axiom.head.predicate for axiom in domain.derived}
    single = [p.name for p in domain.predicates if len(p.parameters) == 1 and p.name not in changing]
    found = {name: frozenset(a.args[0] for a in problem.init if a.predicate == name) for name in single}
    return {name: objects for name, objects in found.items() if objects and name != OBJECT}


def _required(action: ActionSchema, extents: Extents) -> dict[str, str]:
    """Return the widest of the predicates that an action requires of each parameter."""
    found: dict[str, str] = {}
    for part in conjuncts(action.precondition):
        if isinstance(part, Atom) and part.predicate in extents:
            known = found.get(part.terms[0])
            if known is None or len(extents[known]) < len(extents[part.predicate]):
                found[part.terms[0]] = part.predicate
    return found


def _dividing(required: set[str], extents: Extents) -> set[str]:
    """Return the other predicates that divide a type among themselves: suitcases and crates are all the baggage."""
    found: set[str] = set()
    for whole in sorted(required):
        parts = [kind for kind in extents if extents[kind] < extents[whole]]
        widest = [kind for kind in parts if not any(extents[kind] < extents[other] for other in parts)]
        members = [name for kind in widest for name in extents[kind]]
        if len(members) == len(extents[whole]) and set(members) == extents[whole]:
            found.update(widest)
    return found


def _declared(extents: Extents) -> dict[str, str]:
    """Return the types with their parents, parents first; without those that cut through a wider one."""
    types: dict[str, str] = {}
    for kind in sorted(extents, key=lambda kind: (-len(extents[kind]), kind)):
        wider = [other for other in types if not extents[other].isdisjoint(extents[kind])]
        if all(extents[kind] <= extents[other] for other in wider):
            types[kind] = wider[-1] if wider else OBJECT
    return types


@dataclass(frozen=True)
class _Typed:
    """Gives the parts of a problem their types.

    Attributes:
        types: Each type with its parent.
        extents: The objects of the types.
        kinds: The narrowest type of each object.
    """

    types: Mapping[str, str]
    extents: Extents
    kinds: Mapping[str, str]

    def objects(self, objects: Sequence[TypedName]) -> tuple[TypedName, ...]:
        return tuple(replace(o, types=(self.kinds.get(o.name, OBJECT),)) for o in objects)

    def action(self, action: ActionSchema) -> ActionSchema:
        required = _required(action, self.extents)
        known = {variable: kind for variable, kind in required.items() if kind in self.types}
        typed = tuple(replace(p, types=(known.get(p.name, OBJECT),)) for p in action.parameters)
        return replace(action, parameters=typed)

    def predicates(self, domain: Domain, actions: Sequence[ActionSchema], problem: Problem) -> tuple[Predicate, ...]:
        """Return the predicates with the narrowest types that all their uses have."""
        used: dict[tuple[str, int], set[str]] = {}
        for action in actions:
            kinds = {**self.kinds, **{p.name: p.types[0] for p in action.parameters}}
            for atom in (part for part in walk((action.precondition, action.effects)) if isinstance(part, Atom)):
                for place, term in enumerate(atom.terms):
                    kind = kinds.get(term, OBJECT)
                    if kind != OBJECT or not term.startswith("?"):  # a variable without a type tells none
                        used.setdefault((atom.predicate, place), set()).add(kind)
        for fact in problem.init:
            for place, name in enumerate(fact.args):
                used.setdefault((fact.predicate, place), set()).add(self.kinds.get(name, OBJECT))
        types = hierarchy(replace(domain, types=tuple(TypeDeclaration(k, p) for k, p in self.types.items())))

        def common(kinds: Iterable[str]) -> str:
            lines = [types.ancestors(kind) for kind in kinds]
            return next((kind for kind in lines[0] if all(kind in line for line in lines)), OBJECT) if lines else OBJECT

        return tuple(
            replace(
                p,
                parameters=tuple(
                    replace(parameter, types=(common(sorted(used.get((p.name, place), ()))),))
                    for place, parameter in enumerate(p.parameters)
                ),
            )
            for p in domain.predicates
        )
