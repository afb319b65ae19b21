"""Looking at conditions before they are ground: their conjuncts, predicates and free variables."""

from __future__ import annotations

from tmd.pddl.model import And, Atom, Equals, Exists, Forall, Formula, Imply, Not, Or


def conjuncts(formula: Formula) -> list[Formula]:
    """The parts of a conjunction, however nested."""
    if isinstance(formula, And):
        return [inner for part in formula.parts for inner in conjuncts(part)]
    return [formula]


def signed_atoms(formula: Formula) -> tuple[tuple[Atom, int], ...] | None:
    """The atoms of a conjunction of literals, 1 for negated ones; ``None`` for any other formula."""
    found: list[tuple[Atom, int]] = []
    for part in conjuncts(formula):
        inner = part.part if isinstance(part, Not) else part
        if not isinstance(inner, Atom):
            return None
        found.append((inner, int(isinstance(part, Not))))
    return tuple(found)


def predicates_of(formula: Formula) -> frozenset[str]:
    """The predicates that ``formula`` speaks of."""
    match formula:
        case Atom(predicate):
            return frozenset((predicate,))
        case Equals():
            return frozenset()
        case Not(part) | Forall(_, part) | Exists(_, part):
            return predicates_of(part)
        case And(parts) | Or(parts):
            return frozenset[str]().union(*(predicates_of(p) for p in parts))
        case Imply(left, right):
            return predicates_of(left) | predicates_of(right)


def free_variables(formula: Formula) -> frozenset[str]:
    """The variables of ``formula`` that no quantifier within it binds."""
    if isinstance(formula, Atom):
        return frozenset(t for t in formula.terms if t.startswith("?"))
    if isinstance(formula, Equals):
        return frozenset(t for t in (formula.left, formula.right) if t.startswith("?"))
    if isinstance(formula, Not):
        return free_variables(formula.part)
    if isinstance(formula, Imply):
        return free_variables(formula.left) | free_variables(formula.right)
    if isinstance(formula, Forall | Exists):
        return free_variables(formula.part) - {p.name for p in formula.parameters}
    return frozenset[str]().union(*(free_variables(p) for p in formula.parts))
