"""Dropping what can never apply and what never changes, until nothing more falls away.

An atom that holds in all initial states and that no remaining action deletes holds always. An action that
needs its negation is then dropped, which may make further atoms permanent or unreachable, and so on.
Actions only fall away when they apply in no reachable state, so the result is exact for all reachable states.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from tmd.pddl.instantiate import GroundEffect, GroundInstance, Instances
from tmd.pddl.model import Instruction
from tmd.pddl.normal_form import Literals
from tmd.pddl.reachability import Reachability

Conditional: TypeAlias = tuple[Literals, frozenset[int], frozenset[int]]
"""A cube, and the atoms that are added and deleted where it holds."""


@dataclass(frozen=True, slots=True)
class GroundAction:
    """An action over atom numbers, with its effects grouped by condition."""

    instruction: Instruction
    clauses: tuple[Literals, ...]
    add: frozenset[int]
    delete: frozenset[int]
    conditional: tuple[Conditional, ...]
    cost: int


@dataclass(frozen=True, slots=True)
class Pruned:
    """What is left: the actions, the atoms that change, and those that hold always."""

    actions: tuple[GroundAction, ...]
    fluent: frozenset[int]
    always: frozenset[int]


def prune(instances: Instances) -> Pruned:
    """Drop actions, effects and conditions that can play no part."""
    kept = list(instances.instances)
    always: frozenset[int] = frozenset()
    while True:
        reachability = Reachability(instances.somewhere, always)
        for number, instance in enumerate(kept):
            reachability.add(instance.rule(number))
        reachability.run()
        left = [_fired(i, n, reachability) for n, i in enumerate(kept) if (n, -1) in reachability.fired]
        deleted = {atom for instance in left for atom in _deleted(instance)}
        permanent = instances.everywhere - deleted
        if permanent == always and len(left) == len(kept):
            break
        kept, always = left, permanent
    reached = frozenset(reachability.reached)
    world = _World(reached, always)
    actions = tuple(world.action(instance) for instance in left)
    return Pruned(actions, reached - always, always)


def _fired(instance: GroundInstance, number: int, reachability: Reachability) -> GroundInstance:
    """``instance`` without the conditional effects that can never come about."""
    effects = tuple(
        effect
        for place, effect in enumerate(instance.effects)
        if not effect.condition or (number, place) in reachability.fired
    )
    return GroundInstance(instance.instruction, instance.clauses, effects, instance.cost, instance.forced)


def _grouped(effects: Iterable[GroundEffect]) -> tuple[frozenset[int], frozenset[int], list[Conditional]]:
    """Unconditional adds and deletes, and the conditional ones by condition; adding wins throughout."""
    adds: dict[Literals, set[int]] = {}
    deletes: dict[Literals, set[int]] = {}
    for effect in effects:
        condition = effect.condition
        if not effect.positive:
            if 2 * effect.atom + 1 in condition:
                continue
            if condition == {2 * effect.atom}:
                condition = frozenset()
        (adds if effect.positive else deletes).setdefault(condition, set()).add(effect.atom)
    add = frozenset(adds.pop(frozenset(), set()))
    delete = frozenset(deletes.pop(frozenset(), set())) - add
    conditional: list[Conditional] = []
    for condition in dict.fromkeys((*adds, *deletes)):
        also_add = frozenset(adds.get(condition, ())) - add
        also_delete = frozenset(deletes.get(condition, ())) - add - also_add - delete
        if also_add or also_delete:
            conditional.append((condition, also_add, also_delete))
    return add, delete, conditional


def _deleted(instance: GroundInstance) -> frozenset[int]:
    """The atoms that ``instance`` may make false."""
    _, delete, conditional = _grouped(instance.effects)
    return delete.union(*(also for _, _, also in conditional))


@dataclass(frozen=True, slots=True)
class _World:
    """What is known of atoms: ``reached`` ones may hold, ``always`` ones do."""

    reached: frozenset[int]
    always: frozenset[int]

    def truth(self, literal: int) -> bool | None:
        atom, negated = literal >> 1, bool(literal & 1)
        if atom in self.always:
            return not negated
        if atom not in self.reached:
            return negated
        return None

    def action(self, instance: GroundInstance) -> GroundAction:
        effects = [e for e in map(self.effect, instance.effects) if e is not None]
        add, delete, conditional = _grouped(effects)
        return GroundAction(
            instance.instruction,
            tuple(self.clauses(instance.clauses)),
            add,
            delete,
            tuple(conditional),
            instance.cost,
        )

    def clauses(self, clauses: Sequence[Literals]) -> list[Literals]:
        found: dict[Literals, None] = {}
        for clause in clauses:
            if not any(self.truth(literal) for literal in clause):
                found[frozenset(literal for literal in clause if self.truth(literal) is None)] = None
        return list(found)

    def effect(self, effect: GroundEffect) -> GroundEffect | None:
        """``effect`` without settled literals; ``None`` where it can change nothing."""
        if effect.atom in self.always or effect.atom not in self.reached:
            return None
        if any(self.truth(literal) is False for literal in effect.condition):
            return None
        condition = frozenset(literal for literal in effect.condition if self.truth(literal) is None)
        return GroundEffect(condition, effect.atom, effect.positive)
