"""Properties of a domain's predicates that its actions imply."""

from __future__ import annotations

from functools import lru_cache

from tmd.pddl.model import Atom, Domain, Formula, conjuncts, signed_atoms


@lru_cache(maxsize=32)
def transformations(domain: Domain) -> tuple[tuple[str, str, int], ...]:
    """Return the triples (c, p, i) such that an action replaces p(… s …) by p(… t …) at place i where c(s, t) holds.

    c never changes. Cooking is one: ``(cooks raw_egg boiled_egg)`` turns ``(contains pot raw_egg)`` into
    ``(contains pot boiled_egg)``.
    """
    changing = {effect.atom.predicate for action in domain.actions for effect in action.effects}
    found: dict[tuple[str, str, int], None] = {}
    for action in domain.actions:
        for lost in (e for e in action.effects if not e.positive):
            for gained in (e for e in action.effects if e.positive and e.atom.predicate == lost.atom.predicate):
                differing = [
                    i for i, (a, b) in enumerate(zip(lost.atom.terms, gained.atom.terms, strict=True)) if a != b
                ]
                if len(differing) != 1 or lost.condition != gained.condition:
                    continue
                pair = lost.atom.terms[differing[0]], gained.atom.terms[differing[0]]
                for atom, negated in _literals_within(lost.condition):
                    if not negated and atom.terms == pair and atom.predicate not in changing:
                        found[(atom.predicate, lost.atom.predicate, differing[0])] = None
    return tuple(found)


def _literals_within(condition: Formula) -> list[tuple[Atom, int]]:
    """Return the literals among the conjuncts of a condition."""
    return [literal for part in conjuncts(condition) for literal in signed_atoms(part) or ()]


@lru_cache(maxsize=32)
def passing_predicates(domain: Domain) -> frozenset[str]:
    """Return the predicates that some action deletes for every object at once, such as ``near``.

    A deletion that is limited to objects related to an argument of the action does not count: a knob's own burner.
    """
    constants = {c.name for c in domain.constants}
    found = set()
    for action in domain.actions:
        for effect in action.effects:
            quantified = {p.name for p in effect.parameters}
            own = [t for t in effect.atom.terms if t not in constants]
            if effect.positive or not own or not all(t in quantified for t in own):
                continue
            given = {p.name for p in action.parameters}
            related = (atom for atom, negated in _literals_within(effect.condition) if not negated)
            if not any(set(atom.terms) & quantified and set(atom.terms) & given for atom in related):
                found.add(effect.atom.predicate)
    return frozenset(found)


@lru_cache(maxsize=16)
def single_valued(domain: Domain) -> frozenset[str]:
    """Return the predicates that are true of one value of a thing at a time: adding one value deletes another."""
    found: set[str] = set()
    others: set[str] = set()
    for action in domain.actions:
        deleted = {(e.atom.predicate, e.atom.terms[:1]) for e in action.effects if not e.positive}
        for effect in action.effects:
            if effect.positive and len(effect.atom.terms) > 1:
                replaced = (effect.atom.predicate, effect.atom.terms[:1]) in deleted
                (found if replaced else others).add(effect.atom.predicate)
    return frozenset(found - others)
