"""Linear laws over how many atoms of each predicate hold, found automatically: why nobody holds three things.

Pairs that exclude each other (:mod:`tmd.planning.unsolvability.mutexes`) cannot say that two things may be held and
three may not. A law such as ``holding = one_hand_used + 2 both_hands_used`` can: every operator, in every case that its
effect conditions allow, changes both sides by the same amount. The laws are the null space of all such changes.
Predicates of which an operator changes an amount that is not known from a few atoms take no part.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from itertools import combinations, product
from math import gcd, lcm
from operator import or_

from tmd.pddl.task import Bits, Cube, Operator, Task
from tmd.planning.search.flat_task import ones
from tmd.planning.unsolvability.mutexes import Mutexes

MOST_ATOMS = 6
"""Unknown atoms of one operator whose combinations are enumerated."""

MOST_FLAGS = 6
"""Single atoms of one law whose combinations are enumerated."""


@dataclass(frozen=True, slots=True)
class Law:
    """``sum(weight * count) == total`` in every state reachable from where it was found."""

    weights: tuple[tuple[str, int], ...]
    total: int

    def __str__(self) -> str:
        terms = " ".join(f"{weight:+d}*{name}" for name, weight in self.weights)
        return f"{terms} = {self.total}"


@dataclass(frozen=True, slots=True)
class _Case:
    """One way in which an operator may change the counts, and the least and most of each count before it."""

    change: tuple[int, ...]
    bounds: tuple[tuple[int, int], ...]


class Counts:
    """The laws of a task, and the goals they rule out.

    The laws are found as the least fixed point of an affine analysis (Karr 1976): at first every count is taken
    to be constant; then each change that can occur where the present laws hold weakens them.

    Args:
        task: The ground problem.
        mutexes: What excludes each other from the same start.
        start: The state whose counts the laws keep.
    """

    def __init__(self, task: Task, mutexes: Mutexes, start: Bits) -> None:
        self._mutexes = mutexes
        masks: dict[str, Bits] = {}
        for number, atom in enumerate(task.atoms):
            masks[atom.predicate] = masks.get(atom.predicate, 0) | 1 << number
        wild = _wild(task.operators, masks)
        self._names = [name for name in masks if name not in wild]
        self._masks = [masks[name] for name in self._names]
        self._start = [(start & mask).bit_count() for mask in self._masks]
        cases = sorted(
            {case for operator in task.operators for case in self._cases(operator)},
            key=lambda case: (case.change, case.bounds),
        )
        self.laws: list[Law] = []
        seen: set[tuple[int, ...]] = set()
        while True:
            basis = null_space(sorted(seen), len(self._names))
            vectors = with_combinations(basis)
            fresh = {
                case.change
                for case in cases
                if any(sum(w * c for w, c in zip(v, case.change, strict=True)) for v in vectors)
                and all(self._feasible(v, case.bounds) for v in vectors)
            }
            if not fresh:
                break
            seen |= fresh
        self._vectors = vectors
        self.laws = [self._law(vector) for vector in vectors]

    def clash(self, cube: Cube) -> str | None:
        """The law that a goal breaks, in words; ``None`` if it breaks none."""
        bounds = self._bounds(cube)
        for law, vector in zip(self.laws, self._vectors, strict=True):
            if not self._feasible(vector, bounds):
                return f"it breaks a law of this domain, {law}"
        return None

    def _total(self, vector: Sequence[int]) -> int:
        return sum(weight * count for weight, count in zip(vector, self._start, strict=True))

    def _law(self, vector: Sequence[int]) -> Law:
        pairs = tuple((name, weight) for name, weight in zip(self._names, vector, strict=True) if weight)
        return Law(pairs, self._total(vector))

    def _bounds(self, cube: Cube) -> tuple[tuple[int, int], ...]:
        """The least and the most atoms of each predicate in a state that satisfies ``cube``."""
        return tuple(((cube.positive & mask).bit_count(), (mask & ~cube.negative).bit_count()) for mask in self._masks)

    def _cases(self, operator: Operator) -> Iterator[_Case]:
        """The ways in which ``operator`` may change the counts."""
        unknown = 0
        for mask in self._masks:
            unknown |= _unknown(operator, mask)
        positive, negative = operator.precondition
        for chosen in subsets(unknown):
            case = Cube(positive | chosen, negative | (unknown & ~chosen))
            if not self._mutexes.exclusive(case, Cube()):
                after = operator.apply(case.positive)
                change = tuple((after & mask).bit_count() - (case.positive & mask).bit_count() for mask in self._masks)
                yield _Case(change, self._bounds(case))

    def _feasible(self, vector: Sequence[int], bounds: Sequence[tuple[int, int]]) -> bool:
        """Whether counts within ``bounds`` may keep a law."""
        low = high = 0
        flags: list[int] = []
        for number, weight in enumerate(vector):
            least, most = bounds[number]
            if weight and self._masks[number].bit_count() == 1 and least < most and len(flags) < MOST_FLAGS:
                flags.append(number)
                continue
            low += weight * (least if weight > 0 else most)
            high += weight * (most if weight > 0 else least)
        fixed = 0
        for number, (least, _) in enumerate(bounds):
            if least == self._masks[number].bit_count() == 1:
                fixed |= self._masks[number]
        total = self._total(vector)
        for choice in product((0, 1), repeat=len(flags)):
            chosen = fixed | sum(self._masks[n] for n, taken in zip(flags, choice, strict=True) if taken)
            more = sum(vector[n] for n, taken in zip(flags, choice, strict=True) if taken)
            if low + more <= total <= high + more and not self._mutexes.exclusive(Cube(chosen), Cube()):
                return True
        return False


def _unknown(operator: Operator, mask: Bits) -> Bits:
    """The atoms that decide by how much ``operator`` changes the count of the atoms in ``mask``."""
    found = (operator.add | operator.delete) & mask
    for (positive, negative), add, delete in operator.conditional:
        changed = (add | delete) & mask
        if changed:
            found |= changed | positive | negative
    return found & ~(operator.precondition.positive | operator.precondition.negative)


def _wild(operators: Sequence[Operator], masks: Mapping[str, Bits]) -> set[str]:
    """The predicates to leave out, those with the most unknown atoms first, so that few atoms are unknown."""
    wild: set[str] = set()
    for operator in operators:
        unknown = {name: _unknown(operator, mask) for name, mask in masks.items() if name not in wild}
        while union(unknown.values()).bit_count() > MOST_ATOMS:
            worst = max(unknown, key=lambda name: (unknown[name].bit_count(), name))
            wild.add(worst)
            del unknown[worst]
    return wild


def union(sets: Iterable[Bits]) -> Bits:
    """All bits that are in any of ``sets``."""
    return reduce(or_, sets, 0)


def subsets(bits: Bits) -> Iterator[Bits]:
    """Every subset of ``bits``."""
    parts = [1 << number for number in ones(bits)]
    for choice in product((0, 1), repeat=len(parts)):
        yield sum(part for part, taken in zip(parts, choice, strict=True) if taken)


def null_space(rows: Sequence[Sequence[int]], width: int) -> list[list[int]]:
    """Integer vectors that span everything orthogonal to ``rows``."""
    matrix = [[Fraction(value) for value in row] for row in rows]
    pivots: list[int] = []
    for column in range(width):
        rank = len(pivots)
        found = next((i for i in range(rank, len(matrix)) if matrix[i][column]), None)
        if found is None:
            continue
        matrix[rank], matrix[found] = matrix[found], matrix[rank]
        lead = matrix[rank][column]
        matrix[rank] = [value / lead for value in matrix[rank]]
        for i, row in enumerate(matrix):
            if i != rank and row[column]:
                factor = row[column]
                matrix[i] = [a - factor * b for a, b in zip(row, matrix[rank], strict=True)]
        pivots.append(column)
    space = []
    for free in (column for column in range(width) if column not in pivots):
        vector = [Fraction(0)] * width
        vector[free] = Fraction(1)
        for i, pivot in enumerate(pivots):
            vector[pivot] = -matrix[i][free]
        space.append(_integers(vector))
    return space


def with_combinations(basis: Sequence[Sequence[int]]) -> list[tuple[int, ...]]:
    """``basis``, and every pair of its vectors with a shared entry eliminated: sparser laws refute more."""
    found = dict.fromkeys(_signed(vector) for vector in basis)
    for one, other in combinations(basis, 2):
        for a, b in zip(one, other, strict=True):
            if a and b:
                mixed = [b * x - a * y for x, y in zip(one, other, strict=True)]
                found[_signed(_integers([Fraction(value) for value in mixed]))] = None
    return list(found)


def _signed(vector: Sequence[int]) -> tuple[int, ...]:
    """The vector or its opposite, so that the first entry that counts is positive."""
    lead = next((value for value in vector if value), 1)
    return tuple(value if lead > 0 else -value for value in vector)


def _integers(vector: Sequence[Fraction]) -> list[int]:
    """The shortest integer vector in the direction of ``vector``."""
    scale = lcm(*(value.denominator for value in vector))
    whole = [int(value * scale) for value in vector]
    shared = gcd(*whole) or 1
    return [value // shared for value in whole]
