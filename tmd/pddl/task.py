"""The ground form of a problem that searching uses: states and conditions are bit sets.

Bit ``i`` of a state is the fluent atom ``task.atoms[i]``. Facts that never change are compiled away and
operators that can never apply are left out, so everything here is small and an application costs
microseconds. The meaning is that of :mod:`tmd.pddl.semantics`, and tests hold the two against each other.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import reduce
from operator import or_
from typing import NamedTuple, TypeAlias

from tmd.pddl.model import GroundAtom, Instruction, Problem, State
from tmd.short_repr import short_repr

Bits: TypeAlias = int
"""A set of fluent atoms, bit ``i`` for ``task.atoms[i]``."""


def single_bits(bits: Bits) -> Iterator[Bits]:
    """Yield each bit of a set by itself, lowest first."""
    while bits:
        low = bits & -bits
        yield low
        bits ^= low


class Cube(NamedTuple):
    """A conjunction of literals: all of ``positive`` hold and none of ``negative``."""

    positive: Bits = 0
    negative: Bits = 0

    def holds(self, state: Bits) -> bool:
        """Return whether ``state`` satisfies every literal."""
        return state & self.positive == self.positive and not state & self.negative

    def literals(self) -> list[Cube]:
        """Return its literals, each as a cube, the positive ones first."""
        return [
            *(Cube(bit, 0) for bit in single_bits(self.positive)),
            *(Cube(0, b) for b in single_bits(self.negative)),
        ]

    def joined(self, other: Cube) -> Cube | None:
        """Return the conjunction with another cube; ``None`` where they contradict each other."""
        positive, negative = self.positive | other.positive, self.negative | other.negative
        return None if positive & negative else Cube(positive, negative)


def atoms_in(cubes: Iterable[Cube]) -> Bits:
    """Return the atoms that cubes speak of."""
    return reduce(or_, (cube.positive | cube.negative for cube in cubes), 0)


class ConditionalEffect(NamedTuple):
    """``when condition``, ``add`` and ``delete``; the condition reads the state before the action."""

    condition: Cube
    add: Bits
    delete: Bits


@short_repr(lambda operator: operator.instruction)
@dataclass(frozen=True, slots=True)
class Operator:
    """A ground action.

    It applies where ``precondition`` holds and none of the ``forbidden`` cubes does (each cube is the
    negation of one disjunctive clause). Where an atom is both deleted and added, it is added (PDDL
    semantics).
    """

    instruction: Instruction
    precondition: Cube
    add: Bits
    delete: Bits
    conditional: tuple[ConditionalEffect, ...] = ()
    forbidden: tuple[Cube, ...] = ()
    cost: int = 1

    def applicable(self, state: Bits) -> bool:
        """Return whether the precondition holds in ``state``."""
        positive, negative = self.precondition
        if state & positive != positive or state & negative:
            return False
        return not any(cube.holds(state) for cube in self.forbidden)

    def apply(self, state: Bits) -> Bits:
        """Return the state after this operator (the paper's Φ for one instruction); preconditions are not read."""
        add, delete = self.add, self.delete
        for (positive, negative), also_add, also_delete in self.conditional:
            if state & positive == positive and not state & negative:
                add |= also_add
                delete |= also_delete
        return state & ~delete | add


@short_repr(lambda task: task.problem.name)
@dataclass(frozen=True, slots=True, eq=False)
class Task:
    """A ground problem; equal to nothing but itself, since comparing tasks takes long.

    Attributes:
        atoms: The fluent atoms, sorted; an atom's bit is its index.
        goal: The goal as a disjunction of cubes; empty where no reachable state can satisfy it.
        operators: Every operator that relaxed reachability from ``init`` admits, sorted by instruction.
    """

    problem: Problem
    atoms: tuple[GroundAtom, ...]
    static: State
    init: Bits
    goal: tuple[Cube, ...]
    operators: tuple[Operator, ...]
    index: Mapping[GroundAtom, int] = field(repr=False)
    by_instruction: Mapping[Instruction, Operator] = field(repr=False)

    def trace(self, state: Bits, instructions: Iterable[Instruction]) -> list[Bits]:
        """Return the states before, between and after instructions; their preconditions are not read."""
        states = [state]
        for instruction in instructions:
            states.append(self.by_instruction[instruction].apply(states[-1]))
        return states

    def encode(self, state: Iterable[GroundAtom]) -> Bits:
        """Return the bits of atoms; those that are not fluent here are left out."""
        return reduce(or_, (1 << self.index[atom] for atom in state if atom in self.index), 0)

    def where(self, chosen: Callable[[GroundAtom], bool]) -> Bits:
        """Return the atoms that are ``chosen``."""
        return sum(1 << bit for bit, atom in enumerate(self.atoms) if chosen(atom))

    def decode(self, bits: Bits) -> State:
        """Return the full state (static atoms included) of ``bits``."""
        return self.static | frozenset(self.names(bits))

    def names(self, bits: Bits) -> list[GroundAtom]:
        """Return the atoms of ``bits``, sorted."""
        return [self.atoms[bit.bit_length() - 1] for bit in single_bits(bits)]
