"""The gap filler of inference: the cheapest instructions between two that somebody asked for.

This is the planner call of section IV-B of the paper. One utterance asks for thousands of such gaps, so the order
of work is: what holds already, what is remembered, a short search, the proof that a goal is impossible, a long
search.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits, Cube, Operator, Task
from tmd.planning.result import Answer, Filled, GaveUp, Unreachable
from tmd.planning.search.in_process import DEFAULT_CAP, Backend, OptimalSearch, replayed
from tmd.planning.unsolvable import Impossible

BRIEF = 100
"""Generated states after which a search stops to ask whether its goal is impossible."""
QUICK = 2_000
"""A filler with no greater cap does not look further for the reason when it gives up."""


@dataclass
class Counters:
    """How many questions a filler answered, and by what means."""

    held: int = 0
    exact: int = 0
    generalised: int = 0
    searched: int = 0
    generated: int = 0


class GapFiller:
    """Fills gaps of plans for one task.

    Every answer depends on the question alone: the canonical cheapest plan. With ``generalise`` that is given up
    for speed: an answer may be a plan remembered from another state. It is valid, may be dearer than necessary, and
    may depend on what was asked before (see :meth:`forget`).

    Args:
        task: The ground problem. States may be any that its operators reach from where it was ground.
        backend: The form of the search kernel: ``"auto"``, ``"numba"`` or ``"python"``; plans are the same.
        memo: Whether answers are remembered.
        generalise: Whether remembered plans are used in other states that meet their needs.
        cap: Give up after this many generated states.

    Attributes:
        counters: What was asked and how it was answered.

    Raises:
        MissingToolError: ``backend`` is ``"numba"`` and numba is not installed.
        TmdError: There is no such back-end, or the cap is not positive.
    """

    def __init__(
        self,
        task: Task,
        *,
        backend: Backend = "auto",
        memo: bool = True,
        generalise: bool = False,
        cap: int = DEFAULT_CAP,
    ) -> None:
        self.task = task
        self.counters = Counters()
        self._search = OptimalSearch(task, backend=backend, cap=cap)
        self._impossible = Impossible(task)
        self._memo = Memo(task.operators, generalise) if memo else None

    def fill(self, state: Bits, goal: Sequence[Cube]) -> Answer:
        """The missing instructions from ``state`` to any cube of ``goal``."""
        cubes = tuple(goal)
        if any(cube.holds(state) for cube in cubes):
            self.counters.held += 1
            return Filled((), state, 0)
        if self._memo is None:
            return self._searched(state, cubes)[0]
        known = self._memo.exact(state, cubes)
        if known is not None:
            self.counters.exact += 1
            return known
        entry = self._memo.matching(state, cubes)
        if entry is not None:
            self.counters.generalised += 1
            answer: Answer = replayed(self.task, state, entry.steps)
            self._memo.store(state, cubes, answer)
            return answer
        answer, steps = self._searched(state, cubes)
        self._memo.store(state, cubes, answer, steps)
        return answer

    def forget(self) -> None:
        """Empty the memo, so that later answers do not depend on earlier questions."""
        if self._memo is not None:
            self._memo.clear()

    def _searched(self, state: Bits, goal: tuple[Cube, ...]) -> tuple[Answer, Sequence[int]]:
        self.counters.searched += 1
        search = self._search
        answer = search.fill(state, goal, min(BRIEF, search.cap))
        self.counters.generated += search.generated
        if not isinstance(answer, GaveUp):
            return answer, search.steps
        reason = self._impossible.reason(state, goal)
        if reason is not None:
            return Unreachable(reason), ()
        if search.cap > BRIEF:
            answer = search.fill(state, goal)
            self.counters.generated += search.generated
        if isinstance(answer, GaveUp) and search.cap > QUICK:
            reason = self._impossible.reason_from(state, goal)
            if reason is not None:
                return Unreachable(reason), ()
        return answer, search.steps


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


def eliminate(plan: Sequence[Instruction], task: Task, state: Bits, goal: Sequence[Cube]) -> tuple[Instruction, ...]:
    """The plan without what it does not need to get from ``state`` to a cube of ``goal``."""
    kept = tuple(plan)
    place = 0
    while place < len(kept):
        shorter, end = _executable(kept[:place] + kept[place + 1 :], task, state)
        if any(cube.holds(end) for cube in goal):
            kept = shorter
        else:
            place += 1
    return kept


def untouched(
    plan: Sequence[Instruction],
    task: Task,
    state: Bits,
    reached: Callable[[Sequence[Instruction]], bool],
    counted: Bits,
    contents: Bits = 0,
) -> tuple[Instruction, ...]:
    """The plan without the objects that it handles for nothing, and without what it changes for nothing.

    Args:
        plan: The plan.
        task: The ground problem.
        state: Where it starts.
        reached: Whether a plan does what it is for.
        counted: The atoms that count as changes; what is left out must not leave more of them changed.
        contents: Those that count besides, if they become true, where a single instruction is left out: what is poured
            somewhere for nothing; what was poured away was in the way.
    """
    kept = tuple(plan)
    for name in dict.fromkeys(a for i in plan for a in i.args):
        rest = [i for i in kept if name not in i.args]
        shorter, end = _executable(rest, task, state)
        before = _executable(kept, task, state)[1]
        fewer = ((end ^ state) & counted).bit_count() <= ((before ^ state) & counted).bit_count()
        if len(rest) < len(kept) and fewer and reached(shorter):
            kept = shorter

    def changes(end: Bits) -> int:
        return ((end ^ state) & counted | end & ~state & contents).bit_count()

    at = len(kept)
    while at:
        at -= 1
        shorter, end = _executable((*kept[:at], *kept[at + 1 :]), task, state)
        if changes(end) < changes(_executable(kept, task, state)[1]) and reached(shorter):
            kept, at = shorter, min(at, len(shorter))
    return kept


def _executable(plan: Sequence[Instruction], task: Task, state: Bits) -> tuple[tuple[Instruction, ...], Bits]:
    """What of ``plan`` can be executed in its order, and where it ends."""
    done = []
    for instruction in plan:
        operator = task.by_instruction[instruction]
        if operator.applicable(state):
            done.append(instruction)
            state = operator.apply(state)
    return tuple(done), state
