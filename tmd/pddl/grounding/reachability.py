"""Relaxed reachability over ground rules: which literals may ever hold, and which rules may ever fire.

An atom and its negation are two facts that do not exclude each other. What is not reached here never holds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from tmd.pddl.grounding.normal_form import Literals

Tag: TypeAlias = tuple[int, int]
"""Which rule: the action's number, and the number of its effect or -1 for the action itself."""


@dataclass(frozen=True, slots=True)
class Rule:
    """When every clause can hold, so can the literals ``heads``, and the rules ``then`` come into being."""

    tag: Tag
    clauses: Sequence[Literals]
    heads: Sequence[int]
    then: Sequence[Rule] = ()


class Reachability:
    """A fixpoint that can be extended by more rules while it runs.

    Args:
        literals: What holds at the start.
        starts_false: Whether an atom is false in some initial state.
    """

    def __init__(self, literals: Iterable[int], starts_false: Callable[[int], bool]) -> None:
        self.reached: dict[int, None] = {}
        self.fired: set[Tag] = set()
        self._starts_false = starts_false
        self._queue: list[int] = []
        self._watchers: dict[int, list[list[int]]] = {}
        self._rules: list[Rule] = []
        self._missing: list[int] = []
        self._new: list[int] = []
        self._reach(literals)

    def holds(self, literal: int) -> bool:
        """Whether ``literal`` can hold, as far as is known now."""
        return literal in self.reached or bool(literal & 1 and self._starts_false(literal >> 1))

    def add(self, rule: Rule) -> None:
        """Let ``rule`` take part; call :meth:`run` afterwards."""
        waiting = [c for c in rule.clauses if not any(self.holds(literal) for literal in c)]
        if not waiting:
            self._fire(rule)
            return
        number = len(self._rules)
        self._rules.append(rule)
        self._missing.append(len(waiting))
        for clause in waiting:
            watcher = [number, 0]
            for literal in clause:
                self._watchers.setdefault(literal, []).append(watcher)

    def run(self) -> list[int]:
        """Follow all rules to the end; the literals reached since the last call, in order."""
        while self._queue:
            for watcher in self._watchers.pop(self._queue.pop(), ()):
                number, done = watcher
                if done:
                    continue
                watcher[1] = 1
                self._missing[number] -= 1
                if not self._missing[number]:
                    self._fire(self._rules[number])
        new, self._new = self._new, []
        return new

    def _reach(self, literals: Iterable[int]) -> None:
        for literal in literals:
            if literal not in self.reached:
                self.reached[literal] = None
                self._queue.append(literal)
                self._new.append(literal)

    def _fire(self, rule: Rule) -> None:
        self.fired.add(rule.tag)
        self._reach(rule.heads)
        for inner in rule.then:
            self.add(inner)
