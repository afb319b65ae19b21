"""Few types without a hierarchy, for a ground problem: some readers of STRIPS know no types within types.

Types say nothing in a ground problem. They are still worth having: some tools list every atom that the types allow.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from tmd.pddl.model import (
    OBJECT,
    Atom,
    GroundAtom,
    Predicate,
    Problem,
    TypeDeclaration,
    TypedName,
    TypeHierarchy,
    conjuncts,
)


def with_flat_types(problem: Problem) -> Problem:
    """``problem``, which is ground, with as few types as tell its objects apart, and without unused objects.

    Objects that stand in the same place of a predicate are of one type: the nearest one that covers them all. Where
    the problem has no types, or one is enough, there are none.
    """
    classes = _Classes(problem)
    types = {name: classes.type_of(name) for name in classes.objects()}
    several = len(set(types.values())) > 1 and bool(problem.domain.types)
    named = {name: (types[name] if several else OBJECT,) for name in types}
    domain = problem.domain

    def signature(predicate: Predicate) -> Predicate:
        examples = [classes.example(predicate.name, place) for place in range(len(predicate.parameters))]
        return replace(
            predicate,
            parameters=tuple(TypedName(f"?x{n}", named[name]) for n, name in enumerate(examples, start=1)),
        )

    flat = replace(
        domain,
        requirements=(":strips", ":typing") if several else (":strips",),
        types=tuple(TypeDeclaration(name) for name in sorted(set(types.values()) - {OBJECT})) if several else (),
        constants=tuple(TypedName(c.name, named[c.name]) for c in domain.constants if c.name in named),
        predicates=tuple(signature(p) for p in domain.predicates),
    )
    return replace(problem, domain=flat)


def _atoms(problem: Problem) -> Iterator[GroundAtom]:
    yield from sorted(problem.init)
    formulas = [problem.goal, *(action.precondition for action in problem.domain.actions)]
    for formula in formulas:
        yield from (GroundAtom(a.predicate, a.terms) for a in conjuncts(formula) if isinstance(a, Atom))
    for action in problem.domain.actions:
        yield from (GroundAtom(effect.atom.predicate, effect.atom.terms) for effect in action.effects)


class _Classes:
    """The objects of a ground problem, those together that stand in the same place of a predicate."""

    def __init__(self, problem: Problem) -> None:
        self.parents: dict[str, str] = {}
        self.first: dict[tuple[str, int], str] = {}
        self.hierarchy = TypeHierarchy(problem.domain.types)
        self.own = {o.name: o.types[0] for o in problem.all_objects()}
        for atom in _atoms(problem):
            for place, name in enumerate(atom.args):
                self.parents.setdefault(name, name)
                self.join(self.first.setdefault((atom.predicate, place), name), name)

    def objects(self) -> list[str]:
        return list(self.parents)

    def example(self, predicate: str, place: int) -> str:
        """An object that stands in this place."""
        return self.first[(predicate, place)]

    def root(self, name: str) -> str:
        while self.parents[name] != name:
            name = self.parents[name]
        return name

    def join(self, one: str, other: str) -> None:
        self.parents[self.root(one)] = self.root(other)

    def type_of(self, name: str) -> str:
        """The nearest type that covers everything in the class of ``name``."""
        root = self.root(name)
        members = [member for member in self.parents if self.root(member) == root]
        chains = [self.hierarchy.ancestors(self.own[member]) for member in members]
        return next(kind for kind in chains[0] if all(kind in chain for chain in chains))
