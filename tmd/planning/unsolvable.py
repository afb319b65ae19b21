"""Goals that no plan can reach: exclusive pairs, broken counts, relaxed reachability."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, reduce
from itertools import combinations, product
from math import gcd, lcm
from operator import or_

from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.model import Problem
from tmd.pddl.task import Bits, Cube, Operator, Task
from tmd.planning.search.flat_task import ones


def relaxed_literals(task: Task, state: Bits) -> Cube:
    """Return the atoms that may come to hold and those that may come not to hold, where nothing is ever lost."""
    everything = (1 << len(task.atoms)) - 1
    true, false = state, everything & ~state
    changed = True
    while changed:
        before = true, false
        for operator in task.operators:
            positive, negative = operator.precondition
            if positive & ~true or negative & ~false:
                continue
            if any(not p & false and not n & true for p, n in operator.forbidden):
                continue
            true |= operator.add
            false |= operator.delete & ~operator.add
            for (p, n), add, delete in operator.conditional:
                if not p & ~true and not n & ~false:
                    true |= add
                    false |= delete & ~add
        changed = (true, false) != before
    return Cube(true, false)


def reachable(cube: Cube, may_hold: Cube) -> bool:
    """Return whether every literal of ``cube`` is among :func:`relaxed_literals`."""
    return not cube.positive & ~may_hold.positive and not cube.negative & ~may_hold.negative


def unreachable_reason(task: Task, state: Bits, goal: Sequence[Cube]) -> str:
    """Return the reason why no plan from ``state`` reaches ``goal``, which is known to be out of reach."""
    if not goal:
        return "no state can satisfy the goal: it contradicts itself or what never changes"
    true, false = relaxed_literals(task, state)
    for positive, negative in goal:
        for atom in task.names(positive & negative):
            return f"{atom} would have to hold and not to hold"
        for atom in task.names(positive & ~true):
            return f"{atom} cannot be reached"
        for atom in task.names(negative & ~false):
            return f"(not {atom}) cannot be reached"
    wanted = [*map(str, task.names(goal[0].positive))]
    wanted += [f"(not {atom})" for atom in task.names(goal[0].negative)]
    return f"{', '.join(wanted)} cannot hold together"


_TOLD = 2
"""Maximum number of reasons of one proof that are given."""

Literals = int


@dataclass(frozen=True, slots=True)
class _Effect:
    """An effect under a condition. ``kills`` are literals that do not survive it, unless another effect makes them."""

    condition: Literals
    makes: Literals
    kills: Literals


@dataclass(frozen=True, slots=True)
class _Action:
    """An operator as effects under conditions; the unconditional ones come first."""

    precondition: Literals
    effects: tuple[_Effect, ...]


class Mutexes:
    """The pairs of literals that hold together in no state reachable from ``start``."""

    def __init__(self, task: Task, start: Bits) -> None:
        self.task = task
        self._size = len(task.atoms)
        self._all = (1 << self._size) - 1
        self._with = [0] * (2 * self._size)
        here = self._literals(Cube(start, self._all & ~start))
        for literal in ones(here):
            self._with[literal] = here
        self._reached = here
        self._spread([self._action(operator) for operator in task.operators])

    def covers(self, state: Bits) -> bool:
        """Return whether no pair of literals of ``state`` is exclusive, so that proofs from here hold from there."""
        return self._compatible(self._literals(Cube(state, self._all & ~state)))

    def clash(self, cube: Cube) -> str | None:
        """Return a pair of literals of ``cube`` that exclude each other, in words; ``None`` if there is none."""
        wanted = self._literals(cube)
        for literal in ones(wanted):
            if not self._with[literal]:
                return f"{self._name(literal)} cannot be reached"
            for other in ones(wanted & ~self._with[literal]):
                return f"{self._name(literal)} and {self._name(other)} exclude each other"
        return None

    def exclusive(self, one: Cube, other: Cube) -> bool:
        """Return whether two cubes cannot hold together."""
        both = self._literals(Cube(one.positive | other.positive, one.negative | other.negative))
        return not self._compatible(both)

    def _name(self, literal: int) -> str:
        atom = self.task.atoms[literal % self._size]
        return str(atom) if literal < self._size else f"(not {atom})"

    def _literals(self, cube: Cube) -> Literals:
        return cube.positive | cube.negative << self._size

    def _opposite(self, literals: Literals) -> Literals:
        return literals >> self._size | (literals & self._all) << self._size

    def _compatible(self, literals: Literals) -> bool:
        return all(not literals & ~self._with[literal] for literal in ones(literals))

    def _action(self, operator: Operator) -> _Action:
        """Return an operator as effects under conditions; unconditional ones first, under none."""
        merged: dict[Literals, tuple[Bits, Bits]] = {0: (operator.add, operator.delete)}
        for effect in operator.conditional:
            condition = self._literals(effect.condition) & ~self._literals(operator.precondition)
            add, delete = merged.get(condition, (0, 0))
            merged[condition] = add | effect.add, delete | effect.delete
        effects = []
        for condition, (add, delete) in merged.items():
            makes = self._literals(Cube(add, delete & ~add))
            effects.append(_Effect(condition, makes, self._opposite(makes)))
        return _Action(self._literals(operator.precondition), tuple(effects))

    def _context(self, literals: Literals, within: Literals) -> Literals:
        """Return the literals that may hold together with all of ``literals``; 0 where they exclude each other."""
        for literal in ones(literals):
            within &= self._with[literal]
        return within if not literals & ~within else 0

    def _spread(self, actions: list[_Action]) -> None:
        """Apply every action until no pair is new."""
        seen: list[tuple[Literals, ...] | None] = [None] * len(actions)
        changed = True
        while changed:
            changed = False
            for number, action in enumerate(actions):
                context = self._context(action.precondition, self._reached)
                if context == 0 and (action.precondition or not self._reached):
                    continue
                contexts = (context, *(self._context(e.condition, context) for e in action.effects[1:]))
                if contexts != seen[number]:
                    changed = self._apply(action, contexts, seen[number]) or changed
                    seen[number] = contexts

    def _apply(self, action: _Action, contexts: tuple[Literals, ...], before: tuple[Literals, ...] | None) -> bool:
        """Record the pairs after an action; whether any is new.

        What an effect leads to depends on its own context and on which effects may happen at all: where neither is
        other than ``before``, there is nothing new.
        """
        new = False
        may = [bool(context) or not e.condition for e, context in zip(action.effects, contexts, strict=True)]
        live = [(e.condition, e.makes) for e, happens in zip(action.effects, may, strict=True) if happens]
        same = before is not None and all(
            bool(old) or not effect.condition or not happens
            for effect, old, happens in zip(action.effects, before, may, strict=True)
        )
        for number, effect in enumerate(action.effects):
            context = contexts[number]
            if not may[number] or not effect.makes or (same and before is not None and before[number] == context):
                continue
            # what excludes all that may hold with its opposite is certain: cooked food has water around it
            after = context & ~_lost(action.effects, context & ~self._opposite(context))
            without = ~context
            for condition, makes in live:
                if not condition & without:
                    after |= makes
            new = self._record(effect.makes, after | effect.makes) or new
        return new

    def _record(self, made: Literals, after: Literals) -> bool:
        """Return every literal of ``made`` may now hold together with every one of ``after``."""
        new = False
        for literal in ones(made):
            fresh = after & ~self._with[literal] & ~self._opposite(1 << literal)
            if fresh:
                self._with[literal] |= fresh
                for other in ones(fresh):
                    self._with[other] |= 1 << literal
                self._reached |= 1 << literal
                new = True
        return new


def _lost(effects: Sequence[_Effect], given: Literals) -> Literals:
    """Return the literals that cannot survive an action with ``effects`` where ``given`` holds."""
    lost = 0
    for effect in effects:
        missing = effect.condition & ~given
        if not missing:
            lost |= effect.kills
        elif not missing & (missing - 1):
            lost |= effect.kills & missing  # it is guarded by what it takes away
    return lost


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

    The laws are found as the least fixed point of an affine analysis (Karr 1976): at first every count is taken to be
    constant; then each change that can occur where the present laws hold weakens them. They keep the counts of the
    state ``start``.
    """

    def __init__(self, task: Task, start: Bits) -> None:
        self.mutexes = Mutexes(task, start)
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
        """Return the law that a goal breaks, in words; ``None`` if it breaks none."""
        bounds = self._bounds(cube)
        for law, vector in zip(self.laws, self._vectors, strict=True):
            if not self._feasible(vector, bounds):
                return f"it breaks a law of this domain, {law}"
        return None

    def reason(self, goal: Sequence[Cube]) -> str | None:
        """Return the reason why every cube of a goal is out of reach; ``None`` where that is not known of all."""
        reasons = [self.mutexes.clash(cube) or self.clash(cube) for cube in goal]
        known = list(dict.fromkeys(reason for reason in reasons if reason is not None))
        more = f"; and {len(known) - _TOLD} more reasons" if len(known) > _TOLD + 1 else ""
        told = known[:_TOLD] if more else known
        return "; ".join(told) + more if known and None not in reasons else None

    def _total(self, vector: Sequence[int]) -> int:
        return sum(weight * count for weight, count in zip(vector, self._start, strict=True))

    def _law(self, vector: Sequence[int]) -> Law:
        pairs = tuple((name, weight) for name, weight in zip(self._names, vector, strict=True) if weight)
        return Law(pairs, self._total(vector))

    def _bounds(self, cube: Cube) -> tuple[tuple[int, int], ...]:
        """Return the least and the most atoms of each predicate in a state that satisfies ``cube``."""
        return tuple(((cube.positive & mask).bit_count(), (mask & ~cube.negative).bit_count()) for mask in self._masks)

    def _cases(self, operator: Operator) -> Iterator[_Case]:
        """Yield the ways in which ``operator`` may change the counts."""
        unknown = reduce(or_, (_unknown(operator, mask) for mask in self._masks), 0)
        positive, negative = operator.precondition
        for chosen in subsets(unknown):
            case = Cube(positive | chosen, negative | (unknown & ~chosen))
            if not self.mutexes.exclusive(case, Cube()):
                after = operator.apply(case.positive)
                change = tuple((after & mask).bit_count() - (case.positive & mask).bit_count() for mask in self._masks)
                yield _Case(change, self._bounds(case))

    def _feasible(self, vector: Sequence[int], bounds: Sequence[tuple[int, int]]) -> bool:
        """Return whether counts within ``bounds`` may keep a law."""
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
            if low + more <= total <= high + more and not self.mutexes.exclusive(Cube(chosen), Cube()):
                return True
        return False


def _unknown(operator: Operator, mask: Bits) -> Bits:
    """Return the atoms that decide by how much ``operator`` changes the count of the atoms in ``mask``."""
    found = (operator.add | operator.delete) & mask
    for (positive, negative), add, delete in operator.conditional:
        changed = (add | delete) & mask
        if changed:
            found |= changed | positive | negative
    return found & ~(operator.precondition.positive | operator.precondition.negative)


def _wild(operators: Sequence[Operator], masks: Mapping[str, Bits]) -> set[str]:
    """Return the predicates to leave out, those with the most unknown atoms first, so that few atoms are unknown."""
    wild: set[str] = set()
    for operator in operators:
        unknown = {name: _unknown(operator, mask) for name, mask in masks.items() if name not in wild}
        while reduce(or_, unknown.values(), 0).bit_count() > MOST_ATOMS:
            worst = max(unknown, key=lambda name: (unknown[name].bit_count(), name))
            wild.add(worst)
            del unknown[worst]
    return wild


def subsets(bits: Bits) -> Iterator[Bits]:
    """Yield every subset of ``bits``."""
    parts = [1 << number for number in ones(bits)]
    for choice in product((0, 1), repeat=len(parts)):
        yield sum(part for part, taken in zip(parts, choice, strict=True) if taken)


def null_space(rows: Sequence[Sequence[int]], width: int) -> list[list[int]]:
    """Return integer vectors that span everything orthogonal to ``rows``."""
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
    """Add every pair of vectors with a shared entry eliminated: sparser laws refute more."""
    found = dict.fromkeys(_signed(vector) for vector in basis)
    for one, other in combinations(basis, 2):
        for a, b in zip(one, other, strict=True):
            if a and b:
                mixed = [b * x - a * y for x, y in zip(one, other, strict=True)]
                found[_signed(_integers([Fraction(value) for value in mixed]))] = None
    return list(found)


def _signed(vector: Sequence[int]) -> tuple[int, ...]:
    """Return the vector or its opposite, so that the first entry that counts is positive."""
    lead = next((value for value in vector if value), 1)
    return tuple(value if lead > 0 else -value for value in vector)


def _integers(vector: Sequence[Fraction]) -> list[int]:
    """Return the shortest integer vector in the direction of ``vector``."""
    scale = lcm(*(value.denominator for value in vector))
    whole = [int(value * scale) for value in vector]
    shared = gcd(*whole) or 1
    return [value // shared for value in whole]


# Pairs of effects, over all operators, that are looked at: a few seconds' work. A kitchen of 20 things has 40,000.
_MOST_PAIRS = 2_000_000


class Impossible:
    """Recognises impossible goals of one task. In a task of very many things it knows of none.

    What is derived from a state holds in every state reachable from it. It is derived from the task's initial
    state when first asked, and again from states that are out of its reach (forced instructions lead there).
    """

    def __init__(self, task: Task) -> None:
        self.task = task
        self._too_large = sum((1 + len(o.conditional)) ** 2 for o in task.operators) > _MOST_PAIRS

    @cached_property
    def general(self) -> Counts:
        """The proofs that hold from the initial state."""
        return Counts(self.task, self.task.init)

    def reason(self, state: Bits, goal: Sequence[Cube]) -> str | None:
        """Return the reason why ``goal`` cannot be reached from ``state``; ``None`` where that is not known."""
        if self._too_large:
            return None
        covered = self.general.mutexes.covers(state)
        return self.general.reason(goal) if covered else self.reason_from(state, goal)

    def reason_from(self, state: Bits, goal: Sequence[Cube]) -> str | None:
        """Return the reason as derived from ``state`` itself: slower, and it sees more (what is used up)."""
        return None if self._too_large else Counts(self.task, state).reason(goal)


def proof(problem: Problem) -> str | None:
    """Return the reason why a whole problem has no plan, if that can be proven.

    Raises:
        TmdError: It cannot be instantiated.
    """
    task = ground(problem)
    if any(reachable(cube, relaxed_literals(task, task.init)) for cube in task.goal):
        return Impossible(task).reason(task.init, task.goal)
    return unreachable_reason(task, task.init, task.goal)
