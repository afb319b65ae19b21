"""The ``:requirements`` that a domain or problem uses, and those of them that it does not declare."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from tmd.diagnostics import Location, TmdError
from tmd.pddl.model import (
    OBJECT,
    TRUE,
    Atom,
    Domain,
    Equals,
    Exists,
    Forall,
    Formula,
    Imply,
    Not,
    Or,
    Problem,
    TypedName,
    subformulas,
)

_QUANTIFIED = (":existential-preconditions", ":universal-preconditions")
_IMPLIED = {
    ":domain-axioms": (":derived-predicates",),
    ":fluents": (":action-costs",),
    ":numeric-fluents": (":action-costs",),
    ":quantified-preconditions": _QUANTIFIED,
    ":adl": (
        ":typing",
        ":negative-preconditions",
        ":disjunctive-preconditions",
        ":equality",
        ":quantified-preconditions",
        ":conditional-effects",
        *_QUANTIFIED,
    ),
}

# Needs :negative-preconditions to the letter. Most domains do without, so its lack is not a fault; we write it.
_OTHER_NOT = '"not" around something else than an atom'

# A requirement, the feature that needs it, and where that stands.
_Use = tuple[str, str, Location | None]


def missing_requirements(domain: Domain, problem: Problem | None = None) -> list[TmdError]:
    """Return a fault for each requirement that is used and not declared, at its first use.

    Without ``problem`` the domain is checked; with it, the problem, which inherits the requirements of its domain.
    Those that the domain lacks itself are not repeated.
    """
    of_the_domain = {name for name, _, _ in _undeclared(domain, None)} if problem else set[str]()
    return [
        TmdError(
            f"{feature} needs {name}",
            location=place,
            hint=f"add {name} to (:requirements ...)",
            code="missing-requirement",
        )
        for name, feature, place in _undeclared(domain, problem)
        if name not in of_the_domain
    ]


def undeclared_requirements(problem: Problem) -> tuple[str, ...]:
    """Return the requirements that ``problem`` uses and neither it nor its domain declares."""
    return tuple(name for name, _, _ in _undeclared(problem.domain, problem))


def _undeclared(domain: Domain, problem: Problem | None) -> list[_Use]:
    declared = set(domain.requirements) | set(problem.requirements if problem else ())
    for name in tuple(declared):
        declared.update(_IMPLIED.get(name, ()))
    first: dict[str, _Use] = {}
    for use in _problem_uses(problem) if problem else _domain_uses(domain):
        if use[1] == _OTHER_NOT:
            continue
        before = first.get(use[0])
        if before is None or (use[2] and before[2] and use[2] < before[2]):
            first[use[0]] = use
    return [use for use in first.values() if use[0] not in declared]


def used_requirements(domain: Domain, problem: Problem | None = None) -> tuple[str, ...]:
    """Return the requirements that ``domain`` (and ``problem``) use, each once, in the usual order."""
    used = {requirement for requirement, _, _ in _domain_uses(domain)}
    if problem:
        used |= {requirement for requirement, _, _ in _problem_uses(problem)}
    others = (":conditional-effects", ":action-costs", ":derived-predicates")
    usual = (":typing", *_IMPLIED[":adl"][1:4], *_QUANTIFIED, *others)
    return (":strips", *(name for name in usual if name in used))


def _domain_uses(domain: Domain) -> Iterator[_Use]:
    for declared in domain.types:
        yield ":typing", f'the type "{declared.name}"', declared.location
    yield from _typed(domain.constants)
    for signature in (*domain.predicates, *domain.functions):
        yield from _typed(signature.parameters)
    for function in domain.functions:
        yield ":action-costs", f'the function "{function.name}"', function.location
    for axiom in domain.derived:
        yield ":derived-predicates", '":derived"', axiom.location
        yield from _typed(axiom.parameters)
        yield from _formula_uses(axiom.condition)
    for action in domain.actions:
        yield from _typed(action.parameters)
        yield from _formula_uses(action.precondition)
        for effect in action.effects:
            if effect.parameters:
                yield ":conditional-effects", '"forall" in an effect', effect.location
            if effect.condition != TRUE:
                yield ":conditional-effects", '"when"', effect.location
            yield from _typed(effect.parameters)
            yield from _formula_uses(effect.condition)
        if action.cost is not None:
            place = action.cost.location if isinstance(action.cost, Atom) else action.location
            yield ":action-costs", '"increase"', place


def _problem_uses(problem: Problem) -> Iterator[_Use]:
    yield from _typed(problem.objects)
    yield from _formula_uses(problem.goal)
    if problem.minimize_cost:
        yield ":action-costs", "the metric", problem.metric_location or problem.location


def _typed(names: Iterable[TypedName]) -> Iterator[_Use]:
    for name in names:
        if name.types != (OBJECT,):
            yield ":typing", f'the type of "{name.name}"', name.location


def _formula_uses(formula: Formula) -> Iterator[_Use]:
    for part in subformulas(formula):
        match part:
            case Equals():
                yield ":equality", '"="', part.location
            case Not(inner):
                yield ":negative-preconditions", '"not"' if isinstance(inner, Atom) else _OTHER_NOT, part.location
                if not isinstance(inner, Atom | Equals):
                    yield ":disjunctive-preconditions", '"not" around a compound condition', part.location
            case Or():
                yield ":disjunctive-preconditions", '"or"', part.location
            case Imply():
                yield ":disjunctive-preconditions", '"imply"', part.location
            case Forall(parameters) | Exists(parameters):
                kind, word = (":universal", "forall") if isinstance(part, Forall) else (":existential", "exists")
                yield f"{kind}-preconditions", f'"{word}"', part.location
                yield from _typed(parameters)
