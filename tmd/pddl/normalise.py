"""The form of a problem that other planners read: no ``either``, and every requirement by its own name.

Fast Downward takes ``either`` in predicates only, and unified-planning nowhere. Types that stand together in
an ``either`` get a common parent of their own, which changes neither objects nor actions.
The ``pddl`` package does not take ``:adl`` for what it stands for, so what is used is named.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from tmd.diagnostics import TmdError
from tmd.pddl.model import (
    OBJECT,
    ActionSchema,
    Domain,
    Exists,
    Forall,
    Formula,
    Predicate,
    Problem,
    TypeDeclaration,
    TypedName,
    TypeHierarchy,
    parents_first,
    subformulas,
    with_parts,
)
from tmd.pddl.reading.checking import used_requirements


def portable(problem: Problem) -> Problem:
    """Return ``problem`` with the same states, instructions and plans, in the form that other planners read.

    Raises:
        TmdError: As :func:`without_either`.
    """
    plain = without_either(_each_object_once(problem))
    requirements = used_requirements(plain.domain, plain)
    return replace(plain, domain=replace(plain.domain, requirements=requirements), requirements=())


def _each_object_once(problem: Problem) -> Problem:
    """Remove objects that are constants of the domain as well: some readers refuse them."""
    constants = {constant.name for constant in problem.domain.constants}
    if not any(named.name in constants for named in problem.objects):
        return problem
    return replace(problem, objects=tuple(named for named in problem.objects if named.name not in constants))


def without_either(problem: Problem) -> Problem:
    """Replace each ``either`` by a new parent type; without any the problem is returned as it is.

    Raises:
        TmdError: The types of an ``either`` do not share their parent, or two of them overlap.
    """
    domain = problem.domain
    hierarchy = TypeHierarchy(domain.types)
    wanted: dict[tuple[str, ...], TypedName] = {}
    for name in _typed_names(problem):
        types = _reduced(name.types, hierarchy)
        if len(types) > 1:
            wanted.setdefault(types, name)
    if not any(len(name.types) > 1 for name in _typed_names(problem)):
        return problem
    parents = {t.name: t.parent for t in domain.types}
    new: dict[tuple[str, ...], str] = {}
    for types in sorted(wanted, key=lambda t: (-len(t), t)):
        new[types] = _join(types, parents, wanted[types])
    rewriting = _Rewriting(hierarchy, new)
    return replace(problem, domain=rewriting.domain(domain, parents), goal=rewriting.formula(problem.goal))


def _reduced(types: tuple[str, ...], hierarchy: TypeHierarchy) -> tuple[str, ...]:
    """Return ``types`` without those that another one of them covers; sorted."""
    own = set(types)
    return tuple(sorted(t for t in own if not own & set(hierarchy.ancestors(t)[1:])))


def _join(types: tuple[str, ...], parents: dict[str, str], example: TypedName) -> str:
    """Put a new type between ``types`` and their parent, and name it."""
    above = {parents.get(t, OBJECT) for t in types}
    if len(above) != 1:
        raise TmdError(
            f"(either {' '.join(types)}) cannot be written for other planners",
            location=example.location,
            hint="give these types one common parent, and use that",
        )
    name = "-or-".join(types)
    while name in parents:
        name += "-1"
    parents[name] = above.pop()
    parents.update(dict.fromkeys(types, name))
    return name


def _typed_names(problem: Problem) -> Iterator[TypedName]:
    domain = problem.domain
    yield from _quantified(problem.goal)
    yield from domain.constants
    for signature in (*domain.predicates, *domain.functions):
        yield from signature.parameters
    for axiom in domain.derived:
        yield from axiom.parameters
        yield from _quantified(axiom.condition)
    for action in domain.actions:
        yield from action.parameters
        yield from _quantified(action.precondition)
        for effect in action.effects:
            yield from effect.parameters
            yield from _quantified(effect.condition)


def _quantified(formula: Formula) -> Iterator[TypedName]:
    for part in subformulas(formula):
        if isinstance(part, Forall | Exists):
            yield from part.parameters


class _Rewriting:
    """Replaces each ``either`` by its new type."""

    def __init__(self, hierarchy: TypeHierarchy, new: dict[tuple[str, ...], str]) -> None:
        self.hierarchy = hierarchy
        self.new = new

    def domain(self, domain: Domain, parents: dict[str, str]) -> Domain:
        places = {t.name: t.location for t in domain.types}
        declared = [TypeDeclaration(name, parent, places.get(name)) for name, parent in parents.items()]
        return replace(
            domain,
            types=parents_first(declared),
            constants=self.names(domain.constants),
            predicates=tuple(self.signature(p) for p in domain.predicates),
            functions=tuple(self.signature(f) for f in domain.functions),
            actions=tuple(self.action(a) for a in domain.actions),
            derived=tuple(
                replace(a, parameters=self.names(a.parameters), condition=self.formula(a.condition))
                for a in domain.derived
            ),
        )

    def names(self, names: tuple[TypedName, ...]) -> tuple[TypedName, ...]:
        found = []
        for name in names:
            types = _reduced(name.types, self.hierarchy)
            found.append(replace(name, types=(self.new.get(types, types[0]),)))
        return tuple(found)

    def signature(self, predicate: Predicate) -> Predicate:
        return replace(predicate, parameters=self.names(predicate.parameters))

    def action(self, action: ActionSchema) -> ActionSchema:
        effects = tuple(
            replace(e, parameters=self.names(e.parameters), condition=self.formula(e.condition)) for e in action.effects
        )
        return replace(
            action,
            parameters=self.names(action.parameters),
            precondition=self.formula(action.precondition),
            effects=effects,
        )

    def formula(self, formula: Formula) -> Formula:
        found = with_parts(formula, self.formula)
        return replace(found, parameters=self.names(found.parameters)) if isinstance(found, Forall | Exists) else found
