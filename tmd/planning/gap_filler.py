"""The gap filler of inference: the cheapest instructions between two that somebody asked for.

This is the planner call of section IV-B of the paper. One utterance asks for thousands of such gaps, so the order
of work is: goals that hold already, remembered answers, a short search, the proof that a goal is impossible, a long
search.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache, cached_property, reduce
from operator import or_

from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits, Cube, Operator, Task
from tmd.planning.result import Answer, Filled, GaveUp, Unreachable
from tmd.planning.search.in_process import DEFAULT_CAP, Backend, OptimalSearch
from tmd.planning.unsolvable import Impossible

BRIEF = 100
"""Generated states after which a search stops to ask whether its goal is impossible."""
QUICK = 2_000
"""Cap up to which a filler does not look further for the reason when it gives up."""


class GapFiller:
    """Fills gaps of plans for one task.

    Every answer depends on the question alone: the canonical cheapest plan. Answers are remembered, failures too.

    States may be any that the operators of ``task`` reach from where it was instantiated. ``backend`` is the form of
    the search kernel, ``"auto"``, ``"numba"`` or ``"python"``; plans are the same. The search gives up after ``cap``
    generated states.

    Raises:
        MissingToolError: ``backend`` is ``"numba"`` and numba is not installed.
        TmdError: There is no such back-end, or the cap is not positive.
    """

    def __init__(self, task: Task, *, backend: Backend = "auto", cap: int = DEFAULT_CAP) -> None:
        self.task = task
        self._search = OptimalSearch(task, backend=backend, cap=cap)
        self._impossible = Impossible(task)
        self._remembered = cache(self._searched)

    @cached_property
    def careful(self) -> GapFiller:
        """The filler without careless instructions."""
        task = self.task
        operators = tuple(operator for operator in task.operators if not _careless(operator, task))
        known = {operator.instruction: operator for operator in operators}
        return GapFiller(replace(task, operators=operators, by_instruction=known))

    def fill(self, state: Bits, goal: Sequence[Cube]) -> Answer:
        """Return the missing instructions from ``state`` to any cube of ``goal``."""
        cubes = tuple(goal)
        if any(cube.holds(state) for cube in cubes):
            return Filled((), state, 0)
        return self._remembered(state, cubes)

    def soon(self, state: Bits, goal: Sequence[Cube], cap: int) -> Answer:
        """Return what a short search finds, without any proof that there is nothing."""
        return self._search.fill(state, goal, cap)

    def forget(self) -> None:
        """Forget the remembered answers."""
        self._remembered.cache_clear()
        if "careful" in self.__dict__:
            self.careful.forget()

    def _searched(self, state: Bits, goal: tuple[Cube, ...]) -> Answer:
        search = self._search
        answer = search.fill(state, goal, min(BRIEF, search.cap))
        if not isinstance(answer, GaveUp):
            return answer
        reason = self._impossible.reason(state, goal)
        if reason is None and search.cap > BRIEF:
            answer = search.fill(state, goal)
        if reason is None and isinstance(answer, GaveUp) and search.cap > QUICK:
            reason = self._impossible.reason_from(state, goal)
        return answer if reason is None else Unreachable(reason)


def _careless(operator: Operator, task: Task) -> bool:
    """Return whether an instruction puts something in a place that it does not name: it lets it fall."""
    own = set(operator.instruction.args)
    named = own | {constant.name for constant in task.problem.domain.constants}
    add = reduce(or_, (effect.add for effect in operator.conditional), operator.add)
    return any(len(a.args) > 1 and a.args[0] in own and not named.issuperset(a.args) for a in task.names(add))


def eliminate(plan: Sequence[Instruction], task: Task, state: Bits, goal: Sequence[Cube]) -> tuple[Instruction, ...]:
    """Remove the instructions that a plan does not need to get from ``state`` to a cube of ``goal``."""
    kept = tuple(plan)
    place = 0
    while place < len(kept):
        shorter, end = _executable(kept[:place] + kept[place + 1 :], task, state)
        if any(cube.holds(end) for cube in goal):
            kept = shorter
        else:
            place += 1
    return kept


def _executable(plan: Sequence[Instruction], task: Task, state: Bits) -> tuple[tuple[Instruction, ...], Bits]:
    """Return the instructions of ``plan`` that can be executed in its order, and the state in which they end."""
    done = []
    for instruction in plan:
        operator = task.by_instruction[instruction]
        if operator.applicable(state):
            done.append(instruction)
            state = operator.apply(state)
    return tuple(done), state
