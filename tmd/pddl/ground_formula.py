"""Formulas over ground atoms: their algebra, and the cubes that planners search for."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from itertools import chain

from tmd.diagnostics import TmdError
from tmd.pddl.grounding.ground_action import Tree
from tmd.pddl.grounding.ground_task import expand_condition, ground_condition
from tmd.pddl.model import And, Atom, Formula, GroundAtom, Not, Or, signed_subformulas, walk
from tmd.pddl.task import Cube, Task

TRUE, FALSE = And(), Or()
"""The formulas that hold in every state, and in none."""
# Limits on the alternatives of a disjunction, tried in turn where a formula has too many cases.
_MOST_ALTERNATIVES = (8, 3, 1)


def goal_cubes(task: Task, formula: Formula) -> tuple[Cube, ...]:
    """Compile a ground formula to cubes; where there are too many cases, only the first alternatives are kept.

    Raises:
        TmdError: There are too many cases even with one alternative for each disjunction.
    """
    *more, last = _MOST_ALTERNATIVES
    for tried in chain([formula], (fewer(formula, most) for most in more)):
        with suppress(TmdError):
            return ground_condition(task, tried)
    return ground_condition(task, fewer(formula, last))


def instantiated(task: Task, formula: Formula) -> Formula:
    """Spread the quantifiers of a closed formula out, over atoms that may change; everything else is evaluated.

    Raises:
        LimitError: The formula is too large.
    """
    return _formula(expand_condition(task, formula), task)


def _formula(tree: Tree, task: Task) -> Formula:
    """Return the formula that a tree of literals stands for."""
    if isinstance(tree, int):
        atom = task.atoms[tree >> 1]
        found = Atom(atom.predicate, atom.args)
        return Not(found) if tree & 1 else found
    word, parts = tree
    join = conjunction if word == "and" else disjunction
    return join(_formula(part, task) for part in parts)


def negation(formula: Formula) -> Formula:
    """Negate a ground formula; only atoms are negated in the result."""
    match formula:
        case Atom():
            return Not(formula)
        case Not(part):
            return part
        case And(parts):
            return disjunction(negation(part) for part in parts)
        case Or(parts):
            return conjunction(negation(part) for part in parts)
    raise TypeError(f"not ground: {formula}")


def conjunction(parts: Iterable[Formula]) -> Formula:
    """Conjoin formulas, flattened and without those that always hold."""
    return _joined(And, parts, FALSE)


def disjunction(parts: Iterable[Formula]) -> Formula:
    """Disjoin formulas, flattened and without those that never hold."""
    return _joined(Or, parts, TRUE)


def _joined(kind: type[And | Or], parts: Iterable[Formula], decisive: Formula) -> Formula:
    """Join formulas; a ``decisive`` one is the result."""
    kept: dict[Formula, None] = {}
    for part in parts:
        if isinstance(part, kind):
            kept.update(dict.fromkeys(part.parts))
        elif part == decisive:
            return decisive
        else:
            kept[part] = None
    return next(iter(kept)) if len(kept) == 1 else kind(tuple(kept))


def atoms_of(formula: Formula) -> frozenset[GroundAtom]:
    """Return the atoms of a ground formula."""
    atoms = (part for part in walk(formula) if isinstance(part, Atom))
    return frozenset(GroundAtom(atom.predicate, atom.terms) for atom in atoms)


def only_negative(formula: Formula) -> bool:
    """Return whether every atom of a ground formula is negated."""
    return not any(positive and isinstance(part, Atom) for part, positive in signed_subformulas(formula))


def fewer(formula: Formula, most: int) -> Formula:
    """Keep at most ``most`` alternatives of each disjunction."""
    match formula:
        case And(parts):
            return conjunction(fewer(part, most) for part in parts)
        case Or(parts):
            return disjunction(fewer(part, most) for part in parts[:most])
    return formula
