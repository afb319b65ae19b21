"""Ground conditions: evaluated as far as facts that never change allow, then brought to a normal form.

A literal is a number: ``2 * atom`` for an atom and ``2 * atom + 1`` for its negation.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import product
from typing import TypeAlias

from tmd.diagnostics import TmdError
from tmd.pddl.hierarchy import Universe
from tmd.pddl.model import And, Atom, Equals, Exists, Forall, Formula, GroundAtom, Imply, Not, Or
from tmd.pddl.semantics import Binding, bindings, instantiate

Tree: TypeAlias = "int | tuple[str, tuple[Tree, ...]]"
"""A literal, or ``("and", parts)`` or ``("or", parts)``."""

TRUE: Tree = ("and", ())
FALSE: Tree = ("or", ())

Lookup: TypeAlias = Callable[[GroundAtom], Tree]
"""What is known of an atom: :data:`TRUE`, :data:`FALSE`, or the literal that stands for it."""

Literals: TypeAlias = frozenset[int]

_MOST = 3_000


def expand(formula: Formula, binding: Binding, objects: Universe, lookup: Lookup, positive: bool = True) -> Tree:
    """``formula`` (or its negation) over literals: quantifiers spread out, constants gone."""
    match formula:
        case Atom():
            found = lookup(instantiate(formula, binding))
            if positive:
                return found
            if isinstance(found, int):
                return found ^ 1
            return FALSE if found == TRUE else TRUE
        case Equals(left, right):
            return TRUE if (binding.get(left, left) == binding.get(right, right)) == positive else FALSE
        case Not(part):
            return expand(part, binding, objects, lookup, not positive)
        case And(parts):
            found_parts = (expand(p, binding, objects, lookup, positive) for p in parts)
            return _combine("and" if positive else "or", found_parts)
        case Or(parts):
            found_parts = (expand(p, binding, objects, lookup, positive) for p in parts)
            return _combine("or" if positive else "and", found_parts)
        case Imply(left, right):
            sides = (
                expand(left, binding, objects, lookup, not positive),
                expand(right, binding, objects, lookup, positive),
            )
            return _combine("or" if positive else "and", sides)
        case Forall(parameters, part):
            inner = (expand(part, b, objects, lookup, positive) for b in bindings(parameters, objects, binding))
            return _combine("and" if positive else "or", inner)
        case Exists(parameters, part):
            inner = (expand(part, b, objects, lookup, positive) for b in bindings(parameters, objects, binding))
            return _combine("or" if positive else "and", inner)


def _combine(word: str, parts: Iterable[Tree]) -> Tree:
    neutral, absorbing = (TRUE, FALSE) if word == "and" else (FALSE, TRUE)
    kept: list[Tree] = []
    for part in parts:
        if part == absorbing:
            return absorbing
        if part == neutral:
            continue
        if not isinstance(part, int) and part[0] == word:
            kept.extend(part[1])
        else:
            kept.append(part)
    return kept[0] if len(kept) == 1 else (word, tuple(kept))


def conjunctive(tree: Tree, what: str) -> list[Literals]:
    """``tree`` as clauses, all of which must hold; an empty clause is false.

    Raises:
        TmdError: It has too many clauses; ``what`` says whose condition it is.
    """
    return _normal(tree, "and", what)


def disjunctive(tree: Tree, what: str) -> list[Literals]:
    """``tree`` as cubes, one of which must hold; an empty cube is true.

    Raises:
        TmdError: It has too many cubes; ``what`` says whose condition it is.
    """
    return _normal(tree, "or", what)


def _normal(tree: Tree, outer: str, what: str) -> list[Literals]:
    if isinstance(tree, int):
        return [frozenset((tree,))]
    word, parts = tree
    if word == outer:
        return _absorb({clause for part in parts for clause in _normal(part, outer, what)})
    if all(isinstance(p, int) for p in parts):
        literals = frozenset(p for p in parts if isinstance(p, int))
        return [] if any(p ^ 1 in literals for p in literals) else [literals]
    found: list[Literals] = [frozenset()]
    for part in parts:
        choices = _normal(part, outer, what)
        if len(found) * len(choices) > _MOST:
            raise TmdError(
                f"the condition of {what} has more than {_MOST} cases when written out",
                hint="split it, or name the inner condition by a predicate of its own",
            )
        joined = {a | b for a, b in product(found, choices)}
        found = _absorb({c for c in joined if not any(literal ^ 1 in c for literal in c)})
    return found


def _absorb(clauses: set[Literals]) -> list[Literals]:
    """Without clauses that contain another one; sorted."""
    if len(clauses) < 2:
        return list(clauses)
    kept: list[Literals] = []
    for clause in sorted(clauses, key=lambda c: (len(c), sorted(c))):
        if len(clause) == 1 or not any(k <= clause for k in kept):
            kept.append(clause)
    return kept
