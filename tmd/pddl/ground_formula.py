"""Formulas over ground atoms: their algebra, and the cubes that planners search for."""

from __future__ import annotations

from collections.abc import Iterable

from tmd.diagnostics import TmdError
from tmd.pddl.derived import unfolded_condition
from tmd.pddl.grounding.ground_action import Work
from tmd.pddl.grounding.ground_task import ground_condition
from tmd.pddl.model import (
    And,
    Atom,
    Equals,
    Exists,
    Forall,
    Formula,
    GroundAtom,
    Imply,
    Not,
    Or,
    Universe,
    universe,
)
from tmd.pddl.semantics import Binding, bindings, instantiate, size
from tmd.pddl.task import Bits, Cube, Task

TRUE, FALSE = And(), Or()
"""The formulas that hold in every state, and in none."""
# Limits on the alternatives of a disjunction, tried in turn where a formula has too many cases.
_MOST_ALTERNATIVES = (8, 3, 1)


def goal_cubes(task: Task, formula: Formula) -> tuple[Cube, ...]:
    """Compile a ground formula to cubes; where there are too many cases, only the first alternatives are kept.

    Raises:
        TmdError: There are too many cases even with one alternative for each disjunction.
    """
    try:
        return ground_condition(task, formula)
    except TmdError:
        *more, last = _MOST_ALTERNATIVES
    for most in more:
        try:
            return ground_condition(task, fewer(formula, most))
        except TmdError:
            continue
    return ground_condition(task, fewer(formula, last))


def instantiated(task: Task, formula: Formula) -> Formula:
    """Spread the quantifiers of a closed formula out, over atoms that may change; everything else is evaluated.

    Raises:
        LimitError: The formula is too large.
    """
    formula = unfolded_condition(formula, task.problem.domain)
    objects = universe(task.problem)
    Work().spend(size(formula, objects), "a condition")
    return _instantiated(formula, {}, task, objects)


def _instantiated(formula: Formula, binding: Binding, task: Task, objects: Universe) -> Formula:
    def inner(part: Formula, further: Binding = binding) -> Formula:
        return _instantiated(part, further, task, objects)

    match formula:
        case Atom():
            atom = instantiate(formula, binding)
            if atom in task.index:
                return Atom(atom.predicate, atom.args)
            return TRUE if atom in task.static else FALSE
        case Equals(left, right):
            return TRUE if binding.get(left, left) == binding.get(right, right) else FALSE
        case Not(part):
            return negation(inner(part))
        case And(parts):
            return conjunction(map(inner, parts))
        case Or(parts):
            return disjunction(map(inner, parts))
        case Imply(left, right):
            return inner(Or((Not(left), right)))
        case Forall(parameters, part):
            return conjunction(inner(part, each) for each in bindings(parameters, objects, binding))
        case Exists(parameters, part):
            return disjunction(inner(part, each) for each in bindings(parameters, objects, binding))


def holds_in(task: Task, formula: Formula, state: Bits) -> bool:
    """Return whether a ground formula over atoms that may change holds in a state."""
    match formula:
        case Atom(predicate, terms):
            return bool(state >> task.index[GroundAtom(predicate, terms)] & 1)
        case Not(part):
            return not holds_in(task, part, state)
        case And(parts):
            return all(holds_in(task, part, state) for part in parts)
        case Or(parts):
            return any(holds_in(task, part, state) for part in parts)
    raise TypeError(f"not ground: {formula}")


def negation(formula: Formula) -> Formula:
    """Negate a ground formula; ``not`` stands at atoms only."""
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
    kept: dict[Formula, None] = {}
    for part in parts:
        if part == FALSE:
            return FALSE
        kept.update(dict.fromkeys(part.parts if isinstance(part, And) else (part,)))
    return next(iter(kept)) if len(kept) == 1 else And(tuple(kept))


def disjunction(parts: Iterable[Formula]) -> Formula:
    """Disjoin formulas, flattened and without those that never hold."""
    kept: dict[Formula, None] = {}
    for part in parts:
        if part == TRUE:
            return TRUE
        kept.update(dict.fromkeys(part.parts if isinstance(part, Or) else (part,)))
    return next(iter(kept)) if len(kept) == 1 else Or(tuple(kept))


def atoms_of(formula: Formula) -> frozenset[GroundAtom]:
    """Return the atoms of a ground formula."""
    match formula:
        case Atom(predicate, terms):
            return frozenset((GroundAtom(predicate, terms),))
        case Not(part):
            return atoms_of(part)
        case And(parts) | Or(parts):
            return frozenset[GroundAtom]().union(*(atoms_of(part) for part in parts))
    raise TypeError(f"not ground: {formula}")


def only_negative(formula: Formula) -> bool:
    """Return whether every atom of a ground formula is negated."""
    match formula:
        case Atom():
            return False
        case Not():
            return True
        case And(parts) | Or(parts):
            return all(only_negative(part) for part in parts)
    return False


def fewer(formula: Formula, most: int) -> Formula:
    """Keep at most ``most`` alternatives of each disjunction."""
    match formula:
        case And(parts):
            return conjunction(fewer(part, most) for part in parts)
        case Or(parts):
            return disjunction(fewer(part, most) for part in parts[:most])
    return formula
