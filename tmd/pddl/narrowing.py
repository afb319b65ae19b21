"""Quantified conditions over many objects in a form that planners instantiate: variable by variable.

Planners try every choice of objects for the variables of an ``exists``: 75 objects for five variables are two billion.
Variables that few parts of the condition join are eliminated one after another (bucket elimination, Dechter 1999): what
says something of a variable becomes a derived predicate of the variables beside it. Plans stay the same.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace

from tmd.pddl.model import (
    ActionSchema,
    And,
    Atom,
    Axiom,
    Exists,
    Forall,
    Formula,
    Not,
    Predicate,
    Problem,
    TypedName,
    free_variables,
    predicates_of,
    universe,
    with_parts,
)
from tmd.pddl.semantics import signed_conjuncts, size

# Atoms and equations of a condition with its quantifiers spread out; smaller ones are left as they are.
_LARGE = 1_000_000


def narrowed(problem: Problem) -> Problem:
    """Return a problem with the same plans, whose large quantified conditions are divided by derived predicates."""
    return _Narrowing(problem).run()


class _Narrowing:
    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.objects = universe(problem)
        self.names = {p.name for p in problem.domain.predicates}
        self.derived: list[Axiom] = []

    def run(self) -> Problem:
        domain = self.problem.domain
        actions = tuple(self.action(action) for action in domain.actions)
        goal = self.formula(self.problem.goal, {})
        axioms = tuple(map(self.axiom, domain.derived))
        if not self.derived:
            return self.problem
        declared = tuple(Predicate(axiom.head.predicate, axiom.parameters) for axiom in self.derived)
        domain = replace(
            domain,
            actions=actions,
            predicates=(*domain.predicates, *declared),
            derived=(*axioms, *self.derived),
        )
        return replace(self.problem, domain=domain, goal=goal)

    def axiom(self, axiom: Axiom) -> Axiom:
        """Return an axiom; one of derived predicates stays, for these must not come to depend on their negation."""
        if predicates_of(axiom.condition) & {other.head.predicate for other in self.problem.domain.derived}:
            return axiom
        return replace(axiom, condition=self.formula(axiom.condition, {p.name: p for p in axiom.parameters}))

    def action(self, action: ActionSchema) -> ActionSchema:
        types = {p.name: p for p in action.parameters}
        effects = tuple(
            replace(each, condition=self.formula(each.condition, types | {p.name: p for p in each.parameters}))
            for each in action.effects
        )
        return replace(action, precondition=self.formula(action.precondition, types), effects=effects)

    def formula(self, formula: Formula, types: Mapping[str, TypedName]) -> Formula:
        """Return a condition whose variables are declared by ``types``."""
        if not isinstance(formula, Forall | Exists):
            return with_parts(formula, lambda part: self.formula(part, types))
        inner = {**types, **{p.name: p for p in formula.parameters}}
        formula = with_parts(formula, lambda part: self.formula(part, inner))
        if not isinstance(formula, Forall | Exists) or size(formula, self.objects) <= _LARGE:
            return formula
        some = isinstance(formula, Exists)
        parts = [part if wanted else Not(part) for part, wanted, _ in signed_conjuncts(formula.part, some)]
        found = self.eliminated([p.name for p in formula.parameters], parts, inner)
        if found is None:
            return formula
        return found if some else Not(found)

    def eliminated(self, left: list[str], parts: list[Formula], types: Mapping[str, TypedName]) -> Formula | None:
        """Return the conjunction of ``parts`` without the variables ``left``, ``None`` where every two are joined."""
        before, most = len(self.derived), len(left)
        while left:
            scopes = {name: _beside(name, parts) for name in left}
            name = min(left, key=lambda each: len(scopes[each]))
            if len(scopes[name]) + 1 >= most:
                del self.derived[before:]
                return None
            left.remove(name)
            about = [part for part in parts if name in free_variables(part)]
            scope = tuple(types[other] for other in sorted(scopes[name]))
            parts = [part for part in parts if part not in about]
            parts.append(self.derive(scope, Exists((types[name],), And(tuple(about)))))
        return And(tuple(parts))

    def derive(self, scope: tuple[TypedName, ...], condition: Formula) -> Atom:
        """Return the atom of a new predicate of ``scope`` that holds where ``condition`` does."""
        number = len(self.derived) + 1
        while (name := f"some-{number}") in self.names:
            number += 1
        self.names.add(name)
        head = Atom(name, tuple(p.name for p in scope))
        self.derived.append(Axiom(head, scope, condition))
        return head


def _beside(name: str, parts: Collection[Formula]) -> frozenset[str]:
    """Return the variables that share a part with ``name``."""
    found = [names for names in map(free_variables, parts) if name in names]
    return frozenset[str]().union(*found) - {name}
