"""Warnings on domains that are legal PDDL and hardly ever meant."""

from __future__ import annotations

from collections.abc import Iterator

from tmd.diagnostics import TmdError
from tmd.pddl.model import (
    TRUE,
    ActionSchema,
    Atom,
    Domain,
    Effect,
    Equals,
    Formula,
    Not,
    Or,
    conjuncts,
    free_variables,
    walk,
)
from tmd.pddl.reading.syntax import Source
from tmd.pddl.writer import format_formula


def lint_domain(domain: Domain, source: Source) -> list[TmdError]:
    """Return the warnings for a domain that has no faults."""
    found = list(_unused_predicates(domain, source))
    for action in domain.actions:
        found += _contradictory_effects(action, source)
        found += _never_applies(action, source)
        found += said_twice(action.precondition, f'the precondition of action "{action.name}"', source)
        found += _effects_twice(action, source)
        found += _unused_parameters(action, source)
        if not action.effects and action.cost is None:
            hint = "write its :effect, or remove it"
            found.append(source.error(f'action "{action.name}" changes nothing', action.location, hint, "no-effect"))
    return found


def _unused_predicates(domain: Domain, source: Source) -> Iterator[TmdError]:
    used = {part.predicate for part in walk((domain.actions, domain.derived)) if isinstance(part, Atom)}
    for predicate in domain.predicates:
        if predicate.name not in used and domain.actions and predicate.name != "=":
            yield source.error(
                f'no action speaks of the predicate "{predicate.name}"',
                source.word(predicate.location, 0),
                "use it, or remove it",
                "unused-predicate",
            )


def _contradictory_effects(action: ActionSchema, source: Source) -> Iterator[TmdError]:
    """Yield the same atom added and deleted under the same condition: adding wins."""
    added = {(e.atom, e.condition, e.parameters) for e in action.effects if e.positive}
    for effect in action.effects:
        if not effect.positive and (effect.atom, effect.condition, effect.parameters) in added:
            atom = " ".join((effect.atom.predicate, *effect.atom.terms))
            yield source.error(
                f'action "{action.name}" adds and deletes ({atom}); adding wins',
                effect.location,
                "remove one of the two",
                "contradictory-effects",
            )


def said_twice(formula: Formula, what: str, source: Source) -> Iterator[TmdError]:
    """Yield the conjuncts of ``formula`` that stand in it twice, ``and`` within ``and`` spread out."""
    seen: set[Formula] = set()
    for part in conjuncts(formula):
        if part in seen:
            message = f"{format_formula(part)} stands twice in {what}"
            yield source.error(message, part.location, "remove one of the two", "said-twice")
        seen.add(part)


def _effects_twice(action: ActionSchema, source: Source) -> Iterator[TmdError]:
    seen: set[Effect] = set()
    for effect in action.effects:
        if effect in seen:
            atom = format_formula(effect.atom if effect.positive else Not(effect.atom))
            message = f'{atom} stands twice among the effects of action "{action.name}"'
            yield source.error(message, effect.location, "remove one of the two", "said-twice")
        seen.add(effect)


def _never_applies(action: ActionSchema, source: Source) -> Iterator[TmdError]:
    """Yield a precondition that no state satisfies, as far as one can tell by looking at it."""
    parts = conjuncts(action.precondition)
    stated = set(parts)
    for part in parts:
        if _is_false(part) or (isinstance(part, Not) and part.part in stated):
            yield source.error(
                f'action "{action.name}" can never apply: its precondition contradicts itself here',
                part.location or action.location,
                "remove one of the conditions",
                "never-applies",
            )


def _is_false(formula: Formula) -> bool:
    if isinstance(formula, Or):
        return not formula.parts
    if isinstance(formula, Not):
        inner = formula.part
        return inner == TRUE or (isinstance(inner, Equals) and inner.left == inner.right)
    return (
        isinstance(formula, Equals) and formula.left != formula.right and "?" not in formula.left[0] + formula.right[0]
    )


def _unused_parameters(action: ActionSchema, source: Source) -> Iterator[TmdError]:
    used = set(free_variables(action.precondition))
    for effect in action.effects:
        used.update(effect.atom.terms)
        used |= free_variables(effect.condition)
    if isinstance(action.cost, Atom):
        used.update(action.cost.terms)
    for parameter in action.parameters:
        if parameter.name not in used:
            yield source.error(
                f'action "{action.name}" does not speak of its parameter "{parameter.name}"',
                parameter.location,
                "use it, or remove it",
                "unused-parameter",
            )
