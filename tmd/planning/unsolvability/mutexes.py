"""Pairs of literals that never hold together, found by reachability over pairs (h², Haslum and Geffner 2000).

A goal that asks for such a pair is impossible, and no search has to find that out: one item in two places, two
positions of one knob. Conditional effects are treated conservatively: an effect may fire wherever its condition
is not excluded, and a literal is lost only where an effect that takes it away fires for certain. So a pair that is
called exclusive is exclusive; the converse is not claimed.

Sets of literals are integers: bit ``i`` is atom ``i``, bit ``n + i`` its negation, for ``n`` atoms.
"""

from __future__ import annotations

from dataclasses import dataclass

from tmd.pddl.task import Bits, Cube, Operator, Task
from tmd.planning.search.flat_task import ones

Literals = int


@dataclass(frozen=True, slots=True)
class _Effect:
    """What happens under a condition. ``kills`` is what does not survive it, unless another effect makes it."""

    condition: Literals
    makes: Literals
    kills: Literals


@dataclass(frozen=True, slots=True)
class _Action:
    precondition: Literals
    effects: tuple[_Effect, ...]


class Mutexes:
    """The pairs of literals that hold together in no state reachable from ``start``.

    Args:
        task: The ground problem.
        start: The state to begin in.
    """

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
        """Whether no pair of literals of ``state`` is exclusive, so that what is proven here holds from there."""
        return self._compatible(self._literals(Cube(state, self._all & ~state)))

    def clash(self, cube: Cube) -> str | None:
        """A pair of literals of ``cube`` that exclude each other, in words; ``None`` if there is none."""
        wanted = self._literals(cube)
        for literal in ones(wanted):
            if not self._with[literal]:
                return f"{self._name(literal)} cannot be reached"
            for other in ones(wanted & ~self._with[literal]):
                return f"{self._name(literal)} and {self._name(other)} exclude each other"
        return None

    def exclusive(self, one: Cube, other: Cube) -> bool:
        """Whether two cubes cannot hold together."""
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
        """An operator as effects under conditions; unconditional ones first, under none."""
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
        """What may hold together with all of ``literals``; 0 where they exclude each other."""
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
                contexts = (
                    context,
                    *(self._context(effect.condition, context) for effect in action.effects[1:]),
                )
                if contexts != seen[number]:
                    seen[number] = contexts
                    changed = self._apply(action, contexts) or changed

    def _apply(self, action: _Action, contexts: tuple[Literals, ...]) -> bool:
        """Record the pairs after an action; whether any is new."""
        new = False
        live = [
            (effect, context)
            for effect, context in zip(action.effects, contexts, strict=True)
            if context or not effect.condition
        ]
        for effect, context in live:
            if not effect.makes:
                continue
            given = action.precondition | effect.condition
            after = context & ~self._lost(action, given)
            for other, _ in live:
                if not other.condition & ~context:
                    after |= other.makes
            new = self._record(effect.makes, after | effect.makes) or new
        return new

    @staticmethod
    def _lost(action: _Action, given: Literals) -> Literals:
        """The literals that cannot survive an action where ``given`` holds."""
        lost = 0
        for effect in action.effects:
            missing = effect.condition & ~given
            if not missing:
                lost |= effect.kills
            elif not missing & (missing - 1):
                lost |= effect.kills & missing  # it is guarded by what it takes away
        return lost

    def _record(self, made: Literals, after: Literals) -> bool:
        """Every literal of ``made`` may now hold together with every one of ``after``."""
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
