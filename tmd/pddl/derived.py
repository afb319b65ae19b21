"""Derived predicates: the order in which they follow from each other, and the same problem without them.

A predicate is derived where ``(:derived (p ?x) condition)`` says when it holds (PDDL 2.2). The atoms that
follow in a state are computed by :func:`tmd.pddl.semantics.close`; planners without axioms get :func:`unfolded`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from itertools import count

from tmd.diagnostics import TmdError
from tmd.pddl.model import (
    ActionSchema,
    And,
    Atom,
    Axiom,
    Domain,
    Effect,
    Equals,
    Exists,
    Forall,
    Formula,
    Or,
    Problem,
    TypedName,
    TypeHierarchy,
    hierarchy,
    signed_subformulas,
    with_parts,
)


@lru_cache(maxsize=64)
def strata(axioms: tuple[Axiom, ...]) -> tuple[tuple[Axiom, ...], ...] | None:
    """Group axioms: negated predicates are derived in an earlier group than their conditions, others no later.

    ``None`` where there is no such order, because a predicate depends on its own negation.
    """
    level = {axiom.head.predicate: 0 for axiom in axioms}
    for _ in range(len(level) + 1):
        changed = False
        for axiom in axioms:
            head = axiom.head.predicate
            for part, positive in signed_subformulas(axiom.condition):
                if not isinstance(part, Atom) or part.predicate not in level:
                    continue
                least = level[part.predicate] + (not positive)
                if least > level[head]:
                    level[head], changed = least, True
        if not changed:
            numbers = sorted(set(level.values()))
            return tuple(tuple(a for a in axioms if level[a.head.predicate] == number) for number in numbers)
    return None


def unfolded(problem: Problem) -> Problem:
    """Write out the derived predicates in conditions; a problem without any is returned as it is.

    The predicates stay declared, and nothing asks for them any more.

    Raises:
        TmdError: A predicate that is asked for is derived from itself: that cannot be written out.
    """
    domain = problem.domain
    if not domain.derived:
        return problem
    unfolding = _Unfolding(domain)
    actions = tuple(
        replace(
            action,
            precondition=unfolding.formula(action.precondition),
            effects=tuple(replace(e, condition=unfolding.formula(e.condition)) for e in action.effects),
        )
        for action in domain.actions
    )
    names = {axiom.head.predicate for axiom in domain.derived}
    return replace(
        problem,
        domain=replace(domain, actions=actions),
        goal=unfolding.formula(problem.goal),
        init=frozenset(atom for atom in problem.init if atom.predicate not in names),
    )


def unfolded_condition(formula: Formula, domain: Domain) -> Formula:
    """Write out the derived predicates of ``domain`` in a formula.

    Raises:
        TmdError: As :func:`unfolded`.
    """
    return _Unfolding(domain).formula(formula) if domain.derived else formula


def without_derived(problem: Problem) -> Problem:
    """Unfold a problem (:func:`unfolded`) and remove derived predicates, for planners that do not know them.

    Raises:
        TmdError: As :func:`unfolded`.
    """
    if not problem.domain.derived:
        return problem
    plain = unfolded(problem)
    names = {axiom.head.predicate for axiom in plain.domain.derived}
    kept = tuple(p for p in plain.domain.predicates if p.name not in names)
    requirements = tuple(r for r in plain.domain.requirements if r not in (":derived-predicates", ":domain-axioms"))
    return replace(plain, domain=replace(plain.domain, predicates=kept, derived=(), requirements=requirements))


def as_actions(domain: Domain) -> Domain:
    """Turn each axiom into an action that adds its head: the atoms that may ever hold are the same."""
    rules = tuple(
        ActionSchema(f":derived {n}", axiom.parameters, axiom.condition, (Effect(axiom.head),))
        for n, axiom in enumerate(domain.derived)
    )
    return replace(domain, actions=(*domain.actions, *rules), derived=()) if rules else domain


class _Unfolding:
    """Writes out the derived atoms of formulas."""

    def __init__(self, domain: Domain) -> None:
        self._types: TypeHierarchy = hierarchy(domain)
        self._declared = {p.name: p.parameters for p in domain.predicates}
        self._axioms: dict[str, list[Axiom]] = {}
        for axiom in domain.derived:
            self._axioms.setdefault(axiom.head.predicate, []).append(axiom)
        self._open: list[str] = []
        self._fresh = count(1)

    def formula(self, formula: Formula) -> Formula:
        if isinstance(formula, Atom) and formula.predicate in self._axioms:
            return self._atom(formula)
        return with_parts(formula, self.formula)

    def _atom(self, atom: Atom) -> Formula:
        axioms = self._axioms[atom.predicate]
        if atom.predicate in self._open:
            raise TmdError(
                f'not supported here: "{atom.predicate}" is derived from itself',
                location=axioms[0].location,
                hint="`tmd plan` takes it",
                code="not-supported",
            )
        self._open.append(atom.predicate)
        cases = tuple(self._case(axiom, atom) for axiom in axioms)
        self._open.pop()
        return cases[0] if len(cases) == 1 else Or(cases, atom.location)

    def _case(self, axiom: Axiom, atom: Atom) -> Formula:
        """Return the condition of ``axiom`` for ``atom``; a variable of its own where it is about fewer objects."""
        binding: dict[str, str] = {}
        own: list[TypedName] = []
        equal: list[Formula] = []
        by_name = {p.name: p for p in axiom.parameters}
        for variable, term, declared in zip(axiom.head.terms, atom.terms, self._declared[atom.predicate], strict=True):
            if variable in binding:
                equal.append(Equals(binding[variable], term))
            elif self._types.accepts(by_name[variable].types, declared.types):
                binding[variable] = term
            else:
                binding[variable] = f"{variable}-{next(self._fresh)}"
                own.append(TypedName(binding[variable], by_name[variable].types))
                equal.append(Equals(binding[variable], term))
        condition = self.formula(self._substituted(axiom.condition, binding))
        case: Formula = And((*equal, condition)) if equal else condition
        return Exists(tuple(own), case) if own else case

    def _substituted(self, formula: Formula, binding: Mapping[str, str]) -> Formula:
        """Replace variables; those that the formula binds get new names, so that none is captured."""
        match formula:
            case Atom(_, terms):
                return replace(formula, terms=tuple(binding.get(t, t) for t in terms))
            case Equals(left, right):
                return replace(formula, left=binding.get(left, left), right=binding.get(right, right))
            case Forall(parameters, part) | Exists(parameters, part):
                renamed = {p.name: f"{p.name}-{next(self._fresh)}" for p in parameters}
                named = tuple(replace(p, name=renamed[p.name]) for p in parameters)
                return replace(formula, parameters=named, part=self._substituted(part, {**binding, **renamed}))
            case _:
                return with_parts(formula, lambda part: self._substituted(part, binding))
