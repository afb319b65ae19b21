"""A task as flat lists of integers: the form in which the search kernel reads it.

States are split into words of :data:`WORD` bits, so that every word is a non-negative 64-bit integer and the
same arithmetic is right in plain Python and in compiled code.

The relaxation works on *facts*. Fact ``2 * i`` says that atom ``i`` holds, fact ``2 * i + 1`` that it does not.
Behind them come *clause* facts (one of several literals holds: what a forbidden cube demands). A *relaxed
operator* is an operator with one distinct effect condition; it makes facts true and never false.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import accumulate
from typing import NamedTuple

import numpy as np

from tmd.pddl.task import Bits, Cube, Operator, Task

WORD = 62
"""Bits of a state in one word; two fewer than 64, so that words are never negative."""

Ints = list[int]
FEW = 4
"""Words of a set for each of its bits from which on it is quicker to take the bits one by one."""
MANY = 32
"""Number of bits from which it is quicker to unpack a set than to take its bits one by one."""


class Tables(NamedTuple):
    """A task in flat form. ``*_start`` lists are offsets into the list of the same name.

    Attributes:
        operators: Operators; index ``operators`` means the free operators of the relaxation.
        step: What a step counts for beside its cost; a unit of cost counts for as much as ``step`` steps.
        cost: Cost of each operator in search units, then 0 for the free ones, then all costs again for the
            operators where they have effects under conditions.
        row_start: The relaxed operators of each operator; those of the free one come last.
    """

    words: int
    atoms: int
    operators: int
    facts: int
    step: int
    cost: Ints
    positive: Ints
    negative: Ints
    add: Ints
    delete: Ints
    forbidden_start: Ints
    forbidden_positive: Ints
    forbidden_negative: Ints
    when_start: Ints
    when_positive: Ints
    when_negative: Ints
    when_add: Ints
    when_delete: Ints
    row_start: Ints
    action: Ints
    need_start: Ints
    need: Ints
    guard_start: Ints
    guard: Ints
    make_start: Ints
    make: Ints
    maker_start: Ints
    maker: Ints


def words_of(bits: Bits, words: int) -> Ints:
    """Return ``bits`` as ``words`` words, lowest first."""
    if bits.bit_count() * FEW < words:  # most effects change an atom or two of thousands
        found = [0] * words
        for number in ones(bits):
            found[number // WORD] |= 1 << number % WORD
        return found
    mask = (1 << WORD) - 1
    return [bits >> (WORD * i) & mask for i in range(words)]


def ones(bits: Bits) -> Ints:
    """Return the numbers of the bits that are set, lowest first."""
    if bits.bit_count() > MANY:
        octets = np.frombuffer(bits.to_bytes((bits.bit_length() + 7) // 8, "little"), np.uint8)
        numbers: Ints = np.flatnonzero(np.unpackbits(octets, bitorder="little")).tolist()
        return numbers
    found = []
    while bits:
        low = bits & -bits
        found.append(low.bit_length() - 1)
        bits ^= low
    return found


def literals(cube: Cube) -> Ints:
    """Return the facts that a cube asks for, sorted."""
    return sorted([2 * i for i in ones(cube.positive)] + [2 * i + 1 for i in ones(cube.negative)])


def effect_facts(add: Bits, delete: Bits) -> Ints:
    """Return the facts that an effect makes true; add wins over delete."""
    return literals(Cube(add, delete & ~add))


STEP = 1 << 10
"""By how much the smallest difference in cost outweighs a step; more than any plan has steps."""


def search_costs(operators: Sequence[Operator]) -> Ints:
    """Return the costs of the search: every step counts, and among cheapest plans those with fewest steps win.

    Where all operators cost the same, each counts 1.
    """
    costs = [operator.cost for operator in operators]
    if len(set(costs)) <= 1:
        return [1] * len(costs)
    return [cost * STEP + 1 for cost in costs]


class _Row(NamedTuple):
    """A relaxed operator: where all of ``need`` is true, ``make`` becomes true."""

    action: int
    need: Ints
    guard: Ints
    make: Ints


class _Relaxation:
    """Collects relaxed operators and clause facts."""

    def __init__(self, atoms: int, free: int) -> None:
        self.facts = 2 * atoms
        self.free = free
        self.clauses: dict[tuple[int, ...], int] = {}
        self.rows: list[_Row] = []
        self.free_rows: list[_Row] = []

    def clause(self, cube: Cube) -> int:
        """Return the fact that says that ``cube`` does not hold."""
        parts = tuple(fact ^ 1 for fact in literals(cube))
        if parts not in self.clauses:
            self.clauses[parts] = self.facts
            self.free_rows.extend(_Row(self.free, [part], [], [self.facts]) for part in parts)
            self.facts += 1
        return self.clauses[parts]

    def operator(self, number: int, operator: Operator) -> None:
        """Split an operator by its effect conditions."""
        base = literals(operator.precondition) + [self.clause(cube) for cube in operator.forbidden]
        for condition, makes in _merged(operator).items():
            guard = literals(condition)
            if makes:
                self.rows.append(_Row(number, sorted({*base, *guard}), guard, makes))


def _merged(operator: Operator) -> dict[Cube, Ints]:
    """Return the facts that an operator makes true under each distinct condition; first those under none.

    What the precondition says already is left out of the conditions.
    """
    merged = {Cube(): set(effect_facts(operator.add, operator.delete))}
    given = operator.precondition
    for (positive, negative), add, delete in operator.conditional:
        condition = Cube(positive & ~given.positive, negative & ~given.negative)
        merged.setdefault(condition, set()).update(effect_facts(add, delete))
    return {condition: sorted(makes) for condition, makes in merged.items()}


def offsets(lengths: Iterable[int]) -> Ints:
    """Return the starts of runs of the given lengths, and the end of the last one."""
    return [0, *accumulate(lengths)]


def rows(lists: Iterable[Sequence[int]]) -> tuple[Ints, Ints]:
    """Return offsets and entries of a list of lists."""
    start: Ints = [0]
    entries: Ints = []
    for one in lists:
        entries.extend(one)
        start.append(len(entries))
    return start, entries


def build(task: Task) -> Tables:
    """Return the tables of ``task``."""
    operators = task.operators
    words = max(1, -(-len(task.atoms) // WORD))
    costs = search_costs(operators)
    relaxation = _Relaxation(len(task.atoms), len(operators))
    for number, operator in enumerate(operators):
        relaxation.operator(number, operator)
    return Tables(
        words=words,
        atoms=len(task.atoms),
        operators=len(operators),
        facts=relaxation.facts,
        step=1 if len(set(costs)) <= 1 else STEP,
        cost=[*costs, 0, *costs],
        **_operator_tables(operators, words),
        **_row_tables(relaxation),
    )


def flat(sets: Iterable[Bits], words: int) -> Ints:
    """Return the words of all sets, one after the other."""
    return [word for bits in sets for word in words_of(bits, words)]


def _cube_tables(prefix: str, cubes: Sequence[Cube], words: int) -> dict[str, Ints]:
    return {
        f"{prefix}positive": flat((cube.positive for cube in cubes), words),
        f"{prefix}negative": flat((cube.negative for cube in cubes), words),
    }


def _operator_tables(operators: Sequence[Operator], words: int) -> dict[str, Ints]:
    """Return the tables that say when operators apply, and what they do."""
    forbidden = [cube for operator in operators for cube in operator.forbidden]
    effects = [effect for operator in operators for effect in operator.conditional]
    return {
        **_cube_tables("", [operator.precondition for operator in operators], words),
        **_cube_tables("forbidden_", forbidden, words),
        **_cube_tables("when_", [effect.condition for effect in effects], words),
        "add": flat((operator.add for operator in operators), words),
        "delete": flat((operator.delete for operator in operators), words),
        "forbidden_start": offsets(len(operator.forbidden) for operator in operators),
        "when_start": offsets(len(operator.conditional) for operator in operators),
        "when_add": flat((effect.add for effect in effects), words),
        "when_delete": flat((effect.delete for effect in effects), words),
    }


def _row_tables(relaxation: _Relaxation) -> dict[str, Ints]:
    """Return the tables of the relaxed operators."""
    relaxed = relaxation.rows + relaxation.free_rows
    counts = [0] * (relaxation.free + 1)
    makers: list[Ints] = [[] for _ in range(relaxation.facts)]
    for number, row in enumerate(relaxed):
        counts[row.action] += 1
        for fact in row.make:
            makers[fact].append(number)
    found = {"row_start": offsets(counts), "action": [row.action for row in relaxed]}
    lists = {
        "need": [row.need for row in relaxed],
        "guard": [row.guard for row in relaxed],
        "make": [row.make for row in relaxed],
        "maker": makers,
    }
    for name, own in lists.items():
        found[f"{name}_start"], found[name] = rows(own)
    return found
