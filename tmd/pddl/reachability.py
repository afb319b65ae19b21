"""Relaxed reachability over ground rules: which atoms may ever hold, and which rules may ever fire.

Deleting is ignored and a negated atom counts as reachable, so what is not reached here never holds.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from tmd.pddl.normal_form import Literals

Tag: TypeAlias = tuple[int, int]
"""Which rule: the operator's number, and its conditional effect's or -1 for the operator itself."""


@dataclass(frozen=True, slots=True)
class Rule:
    """When every clause can hold, the atoms ``heads`` may, and the rules ``then`` come into being."""

    tag: Tag
    clauses: Sequence[Literals]
    heads: Sequence[int]
    then: Sequence[Rule] = ()


class Reachability:
    """A fixpoint that can be extended by more rules while it runs.

    Args:
        atoms: What holds at the start.
        always: Atoms that are known never to cease to hold, so their negation counts as false.
    """

    def __init__(self, atoms: Iterable[int], always: frozenset[int] = frozenset()) -> None:
        self.reached: dict[int, None] = {}
        self.fired: set[Tag] = set()
        self._always = always
        self._queue: list[int] = []
        self._watchers: dict[int, list[list[int]]] = {}
        self._rules: list[Rule] = []
        self._missing: list[int] = []
        self._new: list[int] = []
        self._reach(atoms)

    def add(self, rule: Rule) -> None:
        """Let ``rule`` take part; call :meth:`run` afterwards."""
        waiting = [c for c in rule.clauses if not any(self._open(literal) for literal in c)]
        if not waiting:
            self._fire(rule)
            return
        number = len(self._rules)
        self._rules.append(rule)
        self._missing.append(len(waiting))
        for clause in waiting:
            watcher = [number, 0]
            for literal in clause:
                if not literal & 1:
                    self._watchers.setdefault(literal >> 1, []).append(watcher)

    def run(self) -> list[int]:
        """Follow all rules to the end; the atoms reached since the last call, in order."""
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

    def _open(self, literal: int) -> bool:
        """Whether ``literal`` can hold, as far as is known now."""
        if literal & 1:
            return literal >> 1 not in self._always
        return literal >> 1 in self.reached

    def _reach(self, atoms: Iterable[int]) -> None:
        for atom in atoms:
            if atom not in self.reached:
                self.reached[atom] = None
                self._queue.append(atom)
                self._new.append(atom)

    def _fire(self, rule: Rule) -> None:
        pending = [rule]
        while pending:
            now = pending.pop()
            self.fired.add(now.tag)
            self._reach(now.heads)
            for inner in now.then:
                self.add(inner)
