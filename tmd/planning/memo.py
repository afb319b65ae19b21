"""Answers remembered, and plans carried over to every state that meets the same needs.

**Exact.** The answer for a state and a goal, failures included; each filler has one cap, so a failure is always
remembered under the cap it happened with.

**Generalised.** A plan that was found from one state works from every state in which its needs hold. The needs
are computed backwards through the plan: a cube of the exact weakest precondition
(:func:`tmd.pddl.semantics.regress`) that contains the state the plan was found in. A hit is valid from any
matching state, but it need not be the cheapest there, and which plan is remembered depends on what was asked before.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tmd.pddl.task import Bits, Cube, Operator
from tmd.planning.result import Answer, Filled

Goal = tuple[Cube, ...]


@dataclass(frozen=True, slots=True)
class MemoEntry:
    """A plan, and the states from which it reaches the goal."""

    needs: Cube
    steps: tuple[int, ...]
    cost: int


class Memo:
    """What a filler remembers.

    Args:
        operators: The operators of the task; plans are remembered by their numbers.
        generalise: Whether plans are carried over to other states.
    """

    def __init__(self, operators: Sequence[Operator], generalise: bool) -> None:
        self._operators = operators
        self._generalise = generalise
        self._exact: dict[tuple[Bits, Goal], Answer] = {}
        self._entries: dict[Goal, list[MemoEntry]] = {}

    def exact(self, state: Bits, goal: Goal) -> Answer | None:
        """The answer that was given for the very same question."""
        return self._exact.get((state, goal))

    def matching(self, state: Bits, goal: Goal) -> MemoEntry | None:
        """The cheapest remembered plan that works from ``state``; the oldest among equals."""
        for entry in self._entries.get(goal, ()):
            if entry.needs.holds(state):
                return entry
        return None

    def store(self, state: Bits, goal: Goal, answer: Answer, steps: Sequence[int] = ()) -> None:
        """Remember an answer; ``steps`` is the plan of a new one by operator numbers."""
        self._exact[state, goal] = answer
        if self._generalise and isinstance(answer, Filled) and steps:
            cube = next(cube for cube in goal if cube.holds(answer.state))
            needs = needs_of([self._operators[step] for step in steps], state, cube)
            entries = self._entries.setdefault(goal, [])
            entries.append(MemoEntry(needs, tuple(steps), answer.cost))
            entries.sort(key=lambda entry: entry.cost)

    def clear(self) -> None:
        """Forget everything."""
        self._exact.clear()
        self._entries.clear()


def needs_of(plan: Sequence[Operator], state: Bits, goal: Cube) -> Cube:
    """What must hold for ``plan`` to reach ``goal`` the way it does from ``state``."""
    passed = []
    for operator in plan:
        passed.append(state)
        state = operator.apply(state)
    needs = goal
    for operator, before in zip(reversed(plan), reversed(passed), strict=True):
        needs = needs_before(operator, before, needs)
    return needs


def needs_before(operator: Operator, state: Bits, goal: Cube) -> Cube:
    """A cube that holds in ``state`` and from all of whose states ``operator`` leads into ``goal``.

    ``operator`` must apply in ``state`` and lead from it into ``goal``.
    """
    fired = [effect for effect in operator.conditional if effect.condition.holds(state)]
    positive, negative = operator.precondition
    wanted, unwanted = goal.positive & ~operator.add, goal.negative & ~operator.delete
    for effect in fired:
        (true, false), add, delete = effect
        if wanted & add or unwanted & delete:
            positive, negative = positive | true, negative | false
            wanted, unwanted = wanted & ~add, unwanted & ~delete
    positive, negative = positive | wanted, negative | unwanted
    silent = list(operator.forbidden)
    for effect in operator.conditional:
        (_, _), add, delete = effect
        if not effect.condition.holds(state) and (add & goal.negative or delete & ~add & wanted):
            silent.append(effect.condition)
    for true, false in silent:
        if true & negative or false & positive:
            continue
        absent, present = true & ~state, false & state
        if absent:
            negative |= absent & -absent
        else:
            positive |= present & -present
    return Cube(positive, negative)
