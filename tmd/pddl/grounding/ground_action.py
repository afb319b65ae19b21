"""Actions over numbered atoms, as they are while grounding: clauses, and effects grouped by condition."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

from tmd.pddl.grounding.normal_form import Literals
from tmd.pddl.grounding.reachability import Rule
from tmd.pddl.model import Instruction


class GroundEffect(NamedTuple):
    """One literal, and the cube under which it comes about (empty: always)."""

    condition: Literals
    literal: int


class Conditional(NamedTuple):
    """A cube, and the atoms that are added and deleted where it holds."""

    condition: Literals
    add: frozenset[int]
    delete: frozenset[int]

    def literals(self) -> tuple[int, ...]:
        """The literals that come about, sorted."""
        return (*sorted(2 * atom for atom in self.add), *sorted(2 * atom + 1 for atom in self.delete))


@dataclass(frozen=True, slots=True)
class GroundAction:
    """An instantiated action: its clauses must all hold; a ``forced`` one counts even if they cannot."""

    instruction: Instruction
    clauses: tuple[Literals, ...]
    effects: tuple[Conditional, ...]
    cost: int
    forced: bool = False

    def rule(self, number: int) -> Rule:
        """What this action means for reachability: one rule for it, and one within for each condition."""
        inner = tuple(
            Rule((number, place), [frozenset((literal,)) for literal in effect.condition], effect.literals())
            for place, effect in enumerate(self.effects)
        )
        return Rule((number, -1), () if self.forced else self.clauses, (), inner)

    def flat(self) -> Iterator[GroundEffect]:
        """The effects, one literal each."""
        for effect in self.effects:
            yield from (GroundEffect(effect.condition, literal) for literal in effect.literals())


def grouped(effects: Iterable[GroundEffect]) -> tuple[Conditional, ...]:
    """``effects`` by condition, without those that change nothing; adding wins over deleting throughout.

    Deleting an atom where it does not hold changes nothing, and deleting it where it holds is deleting it.
    """
    adds: dict[Literals, set[int]] = {}
    deletes: dict[Literals, set[int]] = {}
    for condition, literal in effects:
        atom = literal >> 1
        if not literal & 1:
            adds.setdefault(condition, set()).add(atom)
        elif literal not in condition:
            where = frozenset[int]() if condition == {2 * atom} else condition
            deletes.setdefault(where, set()).add(atom)
    always = frozenset[int]()
    add = frozenset(adds.get(always, ()))
    delete = frozenset(deletes.get(always, ())) - add
    found = [Conditional(always, add, delete)] if add or delete else []
    for condition in dict.fromkeys((*adds, *deletes)):
        also_add = frozenset(adds.get(condition, ())) - add
        also_delete = frozenset(deletes.get(condition, ())) - add - delete - also_add
        if condition and (also_add or also_delete):
            found.append(Conditional(condition, also_add, also_delete))
    return tuple(found)
