"""Dropping what can never apply and what never changes from instantiated actions.

What reachability did not reach never holds: actions and effects that need it fall away, and so do the parts
of conditions that are settled by it. The result is exact for all reachable states.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from tmd.pddl.grounding.ground_action import Conditional, GroundAction, grouped
from tmd.pddl.grounding.normal_form import Literals
from tmd.pddl.grounding.reachability import Reachability


@dataclass(frozen=True, slots=True)
class Pruned:
    """What is left: the actions, the atoms that change, and those that hold always."""

    actions: tuple[GroundAction, ...]
    fluent: frozenset[int]
    always: frozenset[int]


def prune(actions: Sequence[GroundAction], reachability: Reachability) -> Pruned:
    """Drop actions, effects and conditions that can play no part."""
    atoms = [literal >> 1 for literal in reachability.reached if not literal & 1]
    fluent = frozenset(atom for atom in atoms if reachability.holds(2 * atom + 1))
    known = _Known(fluent, frozenset(atoms) - fluent)
    left = tuple(
        known.action(action, [e for k, e in enumerate(action.effects) if (number, k) in reachability.fired])
        for number, action in enumerate(actions)
        if (number, -1) in reachability.fired
    )
    return Pruned(left, fluent, known.always)


@dataclass(frozen=True, slots=True)
class _Known:
    """Atoms that are neither ``fluent`` nor ``always`` true are always false."""

    fluent: frozenset[int]
    always: frozenset[int]

    def truth(self, literal: int) -> bool | None:
        """The value of ``literal``; ``None`` where it changes."""
        if literal >> 1 in self.fluent:
            return None
        return (literal >> 1 in self.always) != bool(literal & 1)

    def open(self, literals: Literals) -> Literals:
        if all(literal >> 1 in self.fluent for literal in literals):
            return literals
        return frozenset(literal for literal in literals if literal >> 1 in self.fluent)

    def action(self, action: GroundAction, effects: Sequence[Conditional]) -> GroundAction:
        clauses = (c for c in action.clauses if not any(self.truth(literal) for literal in c))
        kept: list[Conditional] = []
        shortened = False
        for condition, add, delete in effects:
            add, delete = add & self.fluent, delete & self.fluent
            if (add or delete) and not any(self.truth(literal) is False for literal in condition):
                kept.append(Conditional(self.open(condition), add, delete))
                shortened |= len(kept[-1].condition) < len(condition)
        left = tuple(dict.fromkeys(self.open(c) for c in clauses))
        found = GroundAction(action.instruction, left, tuple(kept), action.cost, action.forced)
        # Shorter conditions may coincide or be empty; then adding wins anew.
        return replace(found, effects=grouped(found.flat())) if shortened else found
