"""Planners by name, for the gaps of plans (:func:`make`) and for whole problems (:func:`solve`)."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cache, partial
from importlib.util import find_spec
from typing import TYPE_CHECKING

from tmd.diagnostics import TmdError
from tmd.pddl.model import And, Atom, Formula, Instruction, Not, Problem
from tmd.pddl.reading.syntax import nearest
from tmd.planning.fast_downward import binaries, fast_downward
from tmd.planning.kairos import kairos, kairos_beside
from tmd.planning.processes import Deadline, TimeIsUpError, in_thread, limited, memory_limit
from tmd.planning.result import Answer, Filled, GaveUp, Planner, Solution, Solved, Unreachable, filled
from tmd.planning.up_planners import EngineSpec, fast_downward_engine, require_unified_planning, solve_with_engine

if TYPE_CHECKING:
    from tmd.pddl.task import Bits, Cube, Operator, Task
    from tmd.planning.search.in_process import OptimalSearch

IN_PROCESS = "in-process"
"""The optimal search of this package, the default."""

IN_PROCESS_FIRST = "in-process-first"
"""The greedy search of this package, content with the first plan it finds."""

FAST_DOWNWARD = "fast-downward"
"""Fast Downward: of whole problems on PDDL text, of gaps the reference that unified-planning runs."""

KAIROS = "kairos"
"""kairos, for whole problems, where it is installed."""

AUTO = "auto"
"""For whole problems: kairos where any plan will do, then Fast Downward, or else the search of this package."""

UP_PREFIX = "up:"
"""Prefix of the names of all other engines of unified-planning."""

PLANNERS = (AUTO, FAST_DOWNWARD, KAIROS, IN_PROCESS, f"{UP_PREFIX}ENGINE")
"""The planners of whole problems, by name."""

# Generated states up to which the greedy search's plans are about as cheap as Fast Downward's first ones.
SOON = 2_000

# More than the cost of any part of a goal.
_FAR = 10**9

# Seconds between two looks at whether the search in this process is still wanted.
_LOOK = 0.05

TIME_LIMIT = 300.0
"""Seconds for a whole problem: an impossible goal can keep a planner busy for ever."""

PLAN_CAP = 1_000_000
"""Generated states after which the in-process search gives up on a whole problem; gaps have a smaller cap."""


def make(name: str, task: Task, *, cap: int | None = None) -> Planner:
    """Return the planner ``name`` for the gaps of ``task``.

    ``cap`` is the number of generated states after which the in-process search gives up; the usual cap for gaps by
    default.

    Raises:
        TmdError: There is no such planner, or it refuses the problem.
        MissingToolError: The planner is not installed.
    """
    if name in (IN_PROCESS, IN_PROCESS_FIRST):
        from tmd.planning.gap_filler import GapFiller
        from tmd.planning.search.in_process import DEFAULT_CAP, FirstSearch

        return (GapFiller if name == IN_PROCESS else FirstSearch)(task, cap=DEFAULT_CAP if cap is None else cap)
    if name == FAST_DOWNWARD:
        return fast_downward_for_gaps(task)
    if engine := _engine(name):
        return _gaps_by_engine(task, EngineSpec(engine))
    raise _unknown(name, [IN_PROCESS, IN_PROCESS_FIRST, FAST_DOWNWARD, f"{UP_PREFIX}ENGINE"])


def fast_downward_for_gaps(task: Task, *, time_limit: float = 60.0) -> Planner:
    """Return Fast Downward as the reference planner for the gaps of ``task``, with a time limit for one call.

    Raises:
        MissingToolError: It is not installed.
    """
    binaries()
    return _gaps_by_engine(task, fast_downward_engine(task.problem.domain, time_limit))


def _gaps_by_engine(task: Task, engine: EngineSpec) -> Planner:
    require_unified_planning()
    return GapsAsProblems(task, partial(solve_with_engine, engine=engine))


def _engine(name: str) -> str:
    """Return the engine of unified-planning that a planner's name means; empty for none."""
    return name.removeprefix(UP_PREFIX) if name.startswith(UP_PREFIX) else ""


def _unknown(name: str, known: Sequence[str]) -> TmdError:
    return TmdError(f"there is no planner '{name}'", hint=nearest(name, known, what="planners"))


def last_resort(task: Task) -> Planner:
    """Return the planner, content with any plan, for the goals that the optimal search gave up on."""
    return InTurn((soon(task), PartByPart(task, patient=True)))


def soon(task: Task) -> Planner:
    """Return the planner of this process that is content with any plan, and gives up after some seconds."""
    return InTurn((EachAlone(make(IN_PROCESS_FIRST, task, cap=SOON)), PartByPart(task)))


@dataclass(frozen=True, slots=True)
class TaskPlanners:
    """The planners of one environment, and of its task without what a request forbids.

    Other programs plan for the PDDL problem, which does not have the prohibitions of a request. Only the searches of
    this process plan for a task with prohibitions. ``planner`` fills the gaps of ``task`` and is called ``name``;
    planners for gaps give up after ``cap`` generated states.
    """

    task: Task
    planner: Planner
    name: str = IN_PROCESS
    cap: int | None = None

    def quick(self, task: Task) -> Planner:
        """Return the planner that fills gaps."""
        return self.planner if task is self.task else make(IN_PROCESS, task, cap=self.cap)

    def resort(self, task: Task, *, brief: bool = False) -> Planner:
        """Return the planner that is asked where the quick one gave up; a ``brief`` one gives up after some seconds."""
        if brief:
            return soon(task)
        ours = self.name == IN_PROCESS or task is not self.task
        return last_resort(task) if ours else make(self.name, task)


class GapsAsProblems:
    """Fills gaps with a planner for whole problems, which executes its plans before it returns them.

    Where a goal has several cubes, it is asked cube by cube, and the cheapest answer is taken.
    """

    def __init__(self, task: Task, solver: Callable[[Problem], Solution]) -> None:
        self._task = task
        self._solver = solver

    def fill(self, state: Bits, goal: Sequence[Cube]) -> Answer:
        """Return the instructions from ``state`` to any cube of ``goal`` that the planner finds.

        Raises:
            MissingToolError, PlannerError, TmdError: As the planner.
        """
        if any(cube.holds(state) for cube in goal):
            return Filled((), state, 0)
        wanted = [_formula(self._task, cube) for cube in goal if not cube.positive & cube.negative]
        answer = _best([self._answer(state, formula) for formula in wanted])
        if isinstance(answer, Unreachable):
            from tmd.planning.unsolvable import unreachable_reason  # imports numpy, which whole problems do not need

            return Unreachable(unreachable_reason(self._task, state, goal))
        return answer

    def _answer(self, state: Bits, goal: Formula) -> Answer:
        answer = self._solver(replace(self._task.problem, init=self._task.decode(state), goal=goal))
        if isinstance(answer, Solved):
            return filled(state, [self._task.by_instruction[step] for step in answer.plan])
        return answer


def _best(answers: Sequence[Answer]) -> Answer:
    """Return the cheapest plan, the first one among equals; without any, a limit before a proof."""
    plans = [answer for answer in answers if isinstance(answer, Filled)]
    if plans:
        return min(plans, key=lambda answer: answer.cost)
    limits = (answer for answer in answers if isinstance(answer, GaveUp))
    return next(limits, Unreachable("no alternative can be reached"))


def _formula(task: Task, cube: Cube) -> Formula:
    atoms = [Atom(atom.predicate, atom.args) for atom in task.names(cube.positive)]
    return And((*atoms, *(Not(Atom(atom.predicate, atom.args)) for atom in task.names(cube.negative))))


class EachAlone:
    """A planner that is asked for each alternative of a goal by itself, for the cheapest of its plans.

    The way to one alternative leads away from another: a greedy search for all at once approaches none of them.
    """

    # Maximum number of alternatives that are asked for one by one.
    MOST = 8

    def __init__(self, planner: Planner) -> None:
        self._planner = planner

    def fill(self, state: Bits, goal: Sequence[Cube]) -> Answer:
        """Return the cheapest plan; without any, the limit or the reason."""
        if len(goal) > self.MOST or any(cube.holds(state) for cube in goal):
            return self._planner.fill(state, goal)
        answer = _best([self._planner.fill(state, (cube,)) for cube in goal])
        # the reason of all together
        return self._planner.fill(state, goal) if isinstance(answer, Unreachable) else answer


class PartByPart:
    """Reaches the parts of a goal one after another, the nearest first, and keeps those that it has reached.

    Where many things are to be put away, or one part is for the next, each part is near, and all together are far.
    Where no part is near, an instruction that brings one about is made ready: the bowl gets into a shut microwave. With
    ``patient``, an instruction is made ready before a far part is looked for, which leaves time for more parts.
    """

    # Generated states after which the optimal search for one part gives up, then the greedy one, and all together.
    SHORT, LONG, ALL = 500, 4_000, 15_000
    # Maximum number of instructions that are made ready for one another.
    DEPTH = 2

    def __init__(self, task: Task, *, patient: bool = False) -> None:
        from tmd.planning.search.in_process import FirstSearch, OptimalSearch

        self._task = task
        self._short, self._long = OptimalSearch(task, cap=self.SHORT), FirstSearch(task, cap=self.LONG)
        self._orders = ((self._short,), (self._long,)) if patient else ((self._short, self._long), ())
        self._left = 0
        self._achievers = cache(lambda part: tuple(self._adding(part)))

    def fill(self, state: Bits, goal: Sequence[Cube]) -> Answer:
        """Return the cheapest plan to one of the alternatives; those with the fewest open parts are tried first."""
        self._left = self.ALL
        plans = (self._parts(state, cube, cube, self.DEPTH) for cube in sorted(goal, key=partial(_open, state)))
        found = [answer for answer in plans if answer is not None]
        return min(found, key=lambda answer: answer.cost) if found else GaveUp("the parts of the goal")

    def _parts(self, state: Bits, cube: Cube, purpose: Cube, depth: int) -> Filled | None:
        """Return a plan for one alternative, or for its purpose: water that heats may cook what is in it at once."""
        plan: tuple[Instruction, ...] = ()
        cost, known = 0, dict.fromkeys(cube.literals(), 0)
        while not (cube.holds(state) or purpose.holds(state)):
            kept = cube._replace(positive=cube.positive & state, negative=cube.negative & ~state)
            parts = sorted((p for p in known if not p.holds(state)), key=lambda p: known[p])
            before, after = self._orders
            best = self._nearest(before, state, kept, parts, known)
            if best is None:
                ready = (self._made_ready(state, kept, part, purpose, depth) for part in parts)
                best = next((answer for answer in ready if answer is not None), None)
            best = best or self._nearest(after, state, kept, parts, known)
            if best is None:
                return None
            plan, state, cost = (*plan, *best.plan), best.state, cost + best.cost
        return Filled(plan, state, cost)

    def _nearest(
        self, searches: Sequence[OptimalSearch], state: Bits, kept: Cube, parts: Sequence[Cube], known: dict[Cube, int]
    ) -> Filled | None:
        """Return the cheapest plan to one of several parts; ``known`` has what each cost last."""
        best: Filled | None = None
        for part in parts:
            if best is not None and best.cost <= known[part]:
                break
            answer = self._near(searches, state, kept.joined(part) or part)
            known[part] = answer.cost if answer is not None else _FAR
            if answer is not None and (best is None or answer.cost < best.cost):
                best = answer
        return best

    def _near(self, searches: Sequence[OptimalSearch], state: Bits, cube: Cube) -> Filled | None:
        """Return a plan for a part of a goal that is near."""
        for search in searches if self._left > 0 else ():
            answer = search.fill(state, (cube,))
            self._left -= search.generated
            if not isinstance(answer, GaveUp):
                return answer if isinstance(answer, Filled) else None
        return None

    def _made_ready(self, state: Bits, kept: Cube, part: Cube, purpose: Cube, depth: int) -> Filled | None:
        """Return a plan that makes an instruction ready which brings about a part, and ends with it."""
        wanted = kept.joined(part)
        if wanted is None or not depth or self._left <= 0:
            return None
        ways = [(o, both) for o, cube in self._achievers(part) if (both := cube.joined(kept)) is not None]
        for operator, cube in sorted(ways, key=lambda way: (_open(state, way[1]), self._short.bound(state, way[1:]))):
            before = self._parts(state, cube, wanted, depth - 1)
            if before is not None and wanted.holds(before.state):
                return before
            if before is None or not operator.applicable(before.state):
                continue
            end = operator.apply(before.state)
            if wanted.holds(end) or purpose.holds(end):
                return Filled((*before.plan, operator.instruction), end, before.cost + operator.cost)
        return None

    def _adding(self, part: Cube) -> Iterator[tuple[Operator, Cube]]:
        """Yield the operators that bring about a literal, each with what must hold for that."""
        for operator in self._task.operators:
            if operator.add & part.positive or operator.delete & part.negative:
                yield operator, operator.precondition
            for condition, add, delete in operator.conditional:
                if add & part.positive or delete & part.negative:
                    both = operator.precondition.joined(condition)
                    if both is not None:
                        yield operator, both


def _open(state: Bits, cube: Cube) -> int:
    """Return the number of literals of a cube that do not hold."""
    return (cube.positive & ~state).bit_count() + (cube.negative & state).bit_count()


class InTurn:
    """Planners that are asked one after another, until one does not give up."""

    def __init__(self, planners: Sequence[Planner]) -> None:
        self._planners = planners

    def fill(self, state: Bits, goal: Sequence[Cube]) -> Answer:
        """Return the first plan or proof, or the limit of the last planner."""
        answer: Answer = GaveUp("no planner")
        for planner in self._planners:
            answer = planner.fill(state, goal)
            if not isinstance(answer, GaveUp):
                break
        return answer


def solve(
    problem: Problem,
    planner: str = AUTO,
    *,
    optimal: bool = False,
    seconds: float | None = None,
    memory: int | None = None,
    deadline: Deadline | None = None,
) -> Solution:
    """Solve a whole PDDL problem, from its initial state to its goal.

    Args:
        problem: The problem.
        planner: ``auto``, ``fast-downward``, ``kairos``, ``in-process`` or ``up:ENGINE``.
        optimal: Whether a plan counts only if it is proven that none is cheaper; otherwise the first one does.
        seconds: The limit of time, :data:`TIME_LIMIT` by default. The search in this process has a cap of states too.
        memory: The limit in bytes, for each planner process, and for the search in this process beyond the memory that
            it has already; ``None`` for most of the machine's memory.
        deadline: Both limits, instead, where the time has begun before.

    Raises:
        TmdError: There is no such planner, it does not take the problem, or (in this process) that cannot be
            instantiated.
        MissingToolError: The planner is not installed.
        PlannerError: The planner died, or its plan is not valid.
    """
    deadline = deadline or Deadline(TIME_LIMIT if seconds is None else seconds, memory)
    try:
        with limited(deadline):
            answer = _solution(problem, planner, optimal, deadline)
    except TimeIsUpError:
        answer = GaveUp(f"{deadline.seconds:g} s")
    if optimal and isinstance(answer, Solved) and not answer.optimal:
        return GaveUp(f"a plan of cost {answer.cost} that {planner} did not prove to be optimal")
    return answer


def _solution(problem: Problem, planner: str, optimal: bool, deadline: Deadline) -> Solution:
    name = planner
    if planner == AUTO:
        name = FAST_DOWNWARD if find_spec("up_fast_downward") else IN_PROCESS
        if not optimal and find_spec("kairos"):
            return kairos_beside(problem, partial(_solution, problem, name, optimal), deadline)
    if name == FAST_DOWNWARD:
        return fast_downward(problem, optimal=optimal, deadline=deadline)
    if name == KAIROS:
        return kairos(problem, optimal=optimal, deadline=deadline)
    if engine := _engine(name):
        return solve_with_engine(problem, EngineSpec(engine, time_limit=deadline.seconds, memory=deadline.memory))
    if name != IN_PROCESS:
        raise _unknown(name, PLANNERS)
    return _in_time(lambda: _in_process(problem, deadline), deadline)


def _in_time(search: Callable[[], Solution], deadline: Deadline) -> Solution:
    """Return the answer of ``search``, if there is one by the deadline.

    It runs in a thread, because Python handles no signals while compiled code runs in the main one. A search that is
    given up goes on until its cap of states, or until the program ends.
    """
    answer = in_thread(search)
    while deadline.left():
        with suppress(TimeoutError):
            return answer.result(min(deadline.left(), _LOOK))
    return GaveUp(f"{deadline.seconds:g} s of {IN_PROCESS}")


def _in_process(problem: Problem, deadline: Deadline) -> Solution:
    """Solve a problem with the search of this package."""
    from tmd.pddl.grounding.ground_task import ground
    from tmd.planning.search.in_process import OptimalSearch, chosen

    try:
        with memory_limit(deadline.memory):
            task = ground(problem)
        if deadline.memory is not None:  # the compiled search is loaded by being used, which does not count
            OptimalSearch(task, backend=chosen("auto"), cap=1).fill(task.init, task.goal)
        with memory_limit(deadline.memory):
            answer = make(IN_PROCESS, task, cap=PLAN_CAP).fill(task.init, task.goal)
    except MemoryError:
        return GaveUp(f"{deadline.memory_limit()} of this process")
    return Solved(answer.plan, answer.cost, optimal=True) if isinstance(answer, Filled) else answer
