"""Goals that no plan can reach, recognised before or beside the search: exclusive pairs and broken counts."""

from __future__ import annotations

from collections.abc import Sequence

from tmd.pddl.task import Bits, Cube, Task
from tmd.planning.unsolvability.invariants import Counts
from tmd.planning.unsolvability.mutexes import Mutexes


class Impossible:
    """Recognises impossible goals of one task.

    What is derived from a state holds in every state reachable from it. It is derived from the task's initial
    state when first asked, and anew from states that are out of its reach (forced instructions lead there).

    Args:
        task: The ground problem.
    """

    def __init__(self, task: Task) -> None:
        self.task = task
        self._general: _Derived | None = None

    def reason(self, state: Bits, goal: Sequence[Cube]) -> str | None:
        """Why ``goal`` cannot be reached from ``state``; ``None`` where that is not known."""
        if self._general is None:
            self._general = _Derived(self.task, self.task.init)
        derived = self._general if self._general.mutexes.covers(state) else _Derived(self.task, state)
        return derived.reason(state, goal)

    def reason_from(self, state: Bits, goal: Sequence[Cube]) -> str | None:
        """As :meth:`reason`, derived from ``state`` itself: slower, and it sees more (what is used up)."""
        return _Derived(self.task, state).reason(state, goal)


class _Derived:
    """What is derived from one state."""

    def __init__(self, task: Task, start: Bits) -> None:
        self.mutexes = Mutexes(task, start)
        self.counts = Counts(task, self.mutexes, start)

    def reason(self, state: Bits, goal: Sequence[Cube]) -> str | None:
        """Why every cube is out of reach, or ``None``."""
        reasons = [self.mutexes.clash(cube) or self.counts.clash(cube) for cube in goal]
        known = [reason for reason in reasons if reason is not None]
        return "; ".join(dict.fromkeys(known)) if known and len(known) == len(goal) else None
