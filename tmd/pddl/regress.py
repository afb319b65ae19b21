"""The inverse of Φ on the ground form: what must hold before an operator for a condition to hold after it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache

from tmd.pddl.task import Bits, Cube, Operator


def regress(cube: Cube, operator: Operator) -> tuple[Cube, ...]:
    """The weakest precondition of ``cube`` under ``operator``, exactly, the operator's own included.

    ``operator`` applies in a state and leads to one that satisfies ``cube`` if and only if one of the
    returned cubes holds in that state. No returned cube contradicts itself or is implied by another. They
    are sorted.
    """
    positive, negative = cube
    if positive & negative or negative & operator.add:
        return ()
    before = Cube(
        operator.precondition.positive | (positive & ~operator.add),
        operator.precondition.negative | (negative & ~operator.delete),
    )
    clauses: list[Sequence[Cube]] = [_opposite(f) for f in operator.forbidden]
    if operator.conditional:
        kept_positive, kept_negative, more = _conditional_clauses(positive, negative, operator)
        before = Cube(operator.precondition.positive | kept_positive, operator.precondition.negative | kept_negative)
        clauses += more
    elif positive & ~operator.add & operator.delete:
        return ()
    return _conjoin(before, clauses)


def _conditional_clauses(positive: Bits, negative: Bits, operator: Operator) -> tuple[Bits, Bits, list[Sequence[Cube]]]:
    """Literals that must hold before, and disjunctions of which one must, where effects have conditions."""
    clauses: list[Sequence[Cube]] = []
    wanted = positive & ~operator.add
    unwanted = negative & ~operator.delete
    may_add = may_delete = 0
    for condition, add, delete in operator.conditional:
        may_add |= add
        may_delete |= delete & ~add
        if add & negative:
            clauses.append(_opposite(condition))
    for bit in _bits(wanted & (may_add | may_delete | operator.delete)):
        wanted &= ~bit
        clauses.append(_made_true(bit, operator))
    for bit in _bits(unwanted & may_delete):
        unwanted &= ~bit
        made_false = [c for c, _, delete in operator.conditional if delete & bit]
        clauses.append([*made_false, Cube(0, bit)])
    return wanted, unwanted, clauses


def _made_true(bit: Bits, operator: Operator) -> Sequence[Cube]:
    """The ways in which the atom ``bit``, which is not added in any case, holds afterwards."""
    ways = [condition for condition, add, _ in operator.conditional if add & bit]
    if not operator.delete & bit:
        threats = [_opposite(c) for c, add, delete in operator.conditional if delete & bit and not add & bit]
        ways.extend(_conjoin(Cube(bit, 0), threats))
    return ways


@lru_cache(maxsize=65536)
def _opposite(cube: Cube) -> tuple[Cube, ...]:
    """The negation of ``cube``, as a disjunction of single literals."""
    return (*(Cube(0, b) for b in _bits(cube.positive)), *(Cube(b, 0) for b in _bits(cube.negative)))


def _conjoin(start: Cube, clauses: Iterable[Sequence[Cube]]) -> tuple[Cube, ...]:
    """The conjunction of ``start`` and of ``clauses`` (disjunctions), as a minimal disjunction of cubes."""
    if start.positive & start.negative:
        return ()
    found = [start]
    for clause in sorted(clauses, key=len):
        grown: set[Cube] = set()
        for positive, negative in found:
            if any(p & ~positive == 0 and n & ~negative == 0 for p, n in clause):
                grown.add(Cube(positive, negative))
                continue
            for more_positive, more_negative in clause:
                both = Cube(positive | more_positive, negative | more_negative)
                if not both.positive & both.negative:
                    grown.add(both)
        found = minimal(grown) if len(grown) > 1 else list(grown)
        if not found:
            return ()
    return tuple(sorted(found))


def minimal(cubes: Iterable[Cube]) -> list[Cube]:
    """``cubes`` without those that another one of them implies, the shortest first."""
    kept: list[Cube] = []
    for cube in sorted(cubes, key=lambda c: (c.positive.bit_count() + c.negative.bit_count(), c)):
        if not any(k.positive & ~cube.positive == 0 and k.negative & ~cube.negative == 0 for k in kept):
            kept.append(cube)
    return kept


def _bits(bits: Bits) -> Iterable[Bits]:
    while bits:
        low = bits & -bits
        yield low
        bits ^= low
