"""Derived predicates: in which order they follow from each other, and the same problem without them.

A predicate is derived where ``(:derived (p ?x) condition)`` says when it holds (PDDL 2.2). What follows in a state
is told by :func:`tmd.pddl.semantics.close`; planners that know nothing of it get :func:`unfolded`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
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
    Imply,
    Not,
    Or,
    Problem,
    TypedName,
    TypeHierarchy,
    hierarchy,
)


@lru_cache(maxsize=64)
def strata(axioms: tuple[Axiom, ...]) -> tuple[tuple[Axiom, ...], ...] | None:
    """``axioms`` in groups: what a condition negates is derived in an earlier group, all else no later.

    ``None`` where there is no such order, because a predicate depends on its own negation.
    """
    level = {axiom.head.predicate: 0 for axiom in axioms}
    for _ in range(len(level) + 1):
        changed = False
        for axiom in axioms:
            head = axiom.head.predicate
            for predicate, positive in _signed(axiom.condition, True):
                least = level[predicate] + (not positive) if predicate in level else 0
                if least > level[head]:
                    level[head], changed = least, True
        if not changed:
            numbers = sorted(set(level.values()))
            return tuple(tuple(a for a in axioms if level[a.head.predicate] == number) for number in numbers)
    return None


def _signed(formula: Formula, positive: bool) -> Iterator[tuple[str, bool]]:
    """The predicates of ``formula``, each with whether it stands there unnegated."""
    match formula:
        case Atom(predicate):
            yield predicate, positive
        case Not(part):
            yield from _signed(part, not positive)
        case And(parts) | Or(parts):
            for part in parts:
                yield from _signed(part, positive)
        case Imply(left, right):
            yield from _signed(left, not positive)
            yield from _signed(right, positive)
        case Forall(_, part) | Exists(_, part):
            yield from _signed(part, positive)
        case Equals():
            pass


def unfolded(problem: Problem) -> Problem:
    """``problem`` with what is derived written out where conditions ask for it; the same where nothing is.

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
    """``formula`` with what ``domain`` derives written out.

    Raises:
        TmdError: As :func:`unfolded`.
    """
    return _Unfolding(domain).formula(formula) if domain.derived else formula


def without_derived(problem: Problem) -> Problem:
    """:func:`unfolded`, and nothing is derived or declared as derived any more: for what does not know the word.

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
    """``domain`` with each rule as an action that adds what it derives: for what may ever hold, that is the same."""
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
        match formula:
            case Atom(predicate) if predicate in self._axioms:
                return self._atom(formula)
            case Not(part):
                return replace(formula, part=self.formula(part))
            case And(parts) | Or(parts):
                return replace(formula, parts=tuple(map(self.formula, parts)))
            case Imply(left, right):
                return replace(formula, left=self.formula(left), right=self.formula(right))
            case Forall(_, part) | Exists(_, part):
                return replace(formula, part=self.formula(part))
            case _:
                return formula

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
        """The condition of ``axiom`` for ``atom``; a variable of its own where it is about fewer objects."""
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
        """``formula`` with its variables replaced; those that it binds get new names, so that none is captured."""
        match formula:
            case Atom(_, terms):
                return replace(formula, terms=tuple(binding.get(t, t) for t in terms))
            case Equals(left, right):
                return replace(formula, left=binding.get(left, left), right=binding.get(right, right))
            case Not(part):
                return replace(formula, part=self._substituted(part, binding))
            case And(parts) | Or(parts):
                return replace(formula, parts=tuple(self._substituted(part, binding) for part in parts))
            case Imply(left, right):
                return replace(formula, left=self._substituted(left, binding), right=self._substituted(right, binding))
            case Forall(parameters, part) | Exists(parameters, part):
                renamed = {p.name: f"{p.name}-{next(self._fresh)}" for p in parameters}
                named = tuple(replace(p, name=renamed[p.name]) for p in parameters)
                return replace(formula, parameters=named, part=self._substituted(part, {**binding, **renamed}))
