"""Execution of a plan: perform an instruction, observe, compare with Φ, and replan around failures."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Hashable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Protocol, TypeAlias

from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.model import GroundAtom, Instruction, Problem, State
from tmd.pddl.semantics import apply, first_broken, get_constraints
from tmd.pddl.task import Bits, ConditionalEffect, Cube, Operator, Task
from tmd.planning.backends import IN_PROCESS, last_resort, make
from tmd.planning.gap_filler import eliminate
from tmd.planning.result import Filled, GaveUp, Unreachable
from tmd.planning.search.in_process import DEFAULT_CAP
from tmd.robot.monitor.observation import Mismatch, Observer
from tmd.robot.skills.results import ExecutedStep, Execution, SkillError, SkillPhase, SkillStatus
from tmd.robot.skills.skill_file import Skills

# Maximum number of tries before a way round is searched, by the stage of the failure. Another try finds
# another path, and no other place to stand. What failed at other stages was within reach.
TRIES = {SkillPhase.PRECONDITION: 1, SkillPhase.STANCE: 1, SkillPhase.PATH: 2}

# Maximum number of tries while nothing has moved, by the stage of the failure; two for other stages. Paths
# are drawn at random: another try may find one.
AGAIN = {SkillPhase.PRECONDITION: 1, SkillPhase.STANCE: 1, SkillPhase.PATH: 3}

# Cost of dropping a thing, in instructions: from the floor it is hard to take.
DROP = 6


@dataclass(frozen=True, slots=True)
class Setback:
    """A failed instruction, with the facts about places and hands at that time.

    If it is ``lasting``, it is not tried again while all ``facts`` hold. Else it is once one of them has changed, even
    if it is then as before: what was put down is a little elsewhere, and held in another way.
    """

    instruction: Instruction
    facts: frozenset[GroundAtom]
    lasting: bool = False
    hands: frozenset[GroundAtom] = frozenset()


class Setbacks:
    """The failures of a run so far; ``seen`` is that of ``skills.yaml``.

    Attributes:
        standing: Those that keep the robot from trying again, in order.
    """

    def __init__(self, seen: Mapping[str, str]) -> None:
        self._seen = seen
        self._failures: Counter[Instruction] = Counter()
        self._known: set[Setback] = set()
        self.standing: list[Setback] = []

    def failed(self, instruction: Instruction, state: State, stage: SkillPhase) -> None:
        """Record the failure of an instruction."""
        self._failures[instruction] += 1
        if stage not in TRIES or self._failures[instruction] < TRIES[stage]:
            return
        hands = frozenset(atom for atom in state if self._seen.get(atom.predicate) == "held")
        own, there = self.situations(instruction, state)
        # where there is no room, there is none until something there is taken away
        first = [(True, there)] if stage is SkillPhase.PRECONDITION and there else []
        for lasting, facts in (*first, *product((False, True), (own, there))):
            setback = Setback(instruction, facts or hands, lasting, hands)
            if setback.facts and setback not in self._known:
                del self._failures[instruction]
                self._known.add(setback)
                self.standing.append(setback)
                return

    def fruitless(self, instruction: Instruction, facts: frozenset[GroundAtom]) -> None:
        """Record an instruction that did not have its effect, as things stand."""
        setback = Setback(instruction, facts)
        if facts and setback not in self.standing:
            self.standing.append(setback)

    def observed(self, state: State) -> None:
        """Forget setbacks that may be tried again, as things are now."""
        self.standing = [setback for setback in self.standing if setback.lasting or setback.facts <= state]

    def with_free_hands(self, state: State) -> list[Setback]:
        """Return the setbacks, which may also be tried again once something else that was in a hand is put down."""
        return [
            setback if setback.lasting else replace(setback, facts=setback.facts | setback.hands)
            for setback in self.standing
            if setback.lasting or setback.hands <= state
        ]

    def situations(self, instruction: Instruction, state: State) -> tuple[frozenset[GroundAtom], frozenset[GroundAtom]]:
        """Return the facts that might be changed: the places of the things it names, and the things at them."""
        sensors = {atom: self._seen.get(atom.predicate) for atom in state}
        held = {atom for atom, sensor in sensors.items() if sensor == "held" and atom.args[-1] in instruction.args}
        at = {atom for atom, sensor in sensors.items() if sensor == "support"}
        own = frozenset(held | {atom for atom in at if atom.args[0] in instruction.args})
        return own, frozenset(atom for atom in at if atom.args[1] in instruction.args)


def without(task: Task, setbacks: Sequence[Setback]) -> Task:
    """Return the task in which setbacks are not tried again.

    Each setback that does not last is a fluent. It holds in the initial state, forbids the instruction, and ends with
    each operator that ends one of its facts.
    """
    passing = [setback for setback in setbacks if not setback.lasting]
    first = len(task.atoms)
    names = [GroundAtom("setback", (str(number),)) for number in range(len(passing))]
    marks = {setback: 1 << first + number for number, setback in enumerate(passing)}
    forbidden: dict[Instruction, list[Cube]] = {}
    for setback in setbacks:
        cube = Cube(marks[setback] if setback in marks else task.encode(setback.facts))
        forbidden.setdefault(setback.instruction, []).append(cube)
    operators = []
    for operator in task.operators:
        cubes = forbidden.get(operator.instruction, ())
        operator = replace(operator, forbidden=(*operator.forbidden, *cubes)) if cubes else operator
        for setback, mark in marks.items():
            operator = _ending(operator, task.encode(setback.facts), mark)
        operators.append(operator)
    return replace(
        task,
        atoms=(*task.atoms, *names),
        init=task.init | sum(marks.values()),
        operators=tuple(operators),
        index={**task.index, **{name: first + number for number, name in enumerate(names)}},
        by_instruction={operator.instruction: operator for operator in operators},
    )


def _ending(operator: Operator, facts: Bits, mark: Bits) -> Operator:
    """Return the operator that also removes a mark if it ends one of the facts."""
    ends = mark if operator.delete & facts else 0
    also = [ConditionalEffect(each.condition, 0, mark) for each in operator.conditional if each.delete & facts]
    if not ends and not also:
        return operator
    return replace(operator, delete=operator.delete | ends, conditional=(*operator.conditional, *also))


def careful(task: Task, skills: Skills) -> Task:
    """Return the task in which dropping a thing costs more than putting it down."""
    drops = {name for name, entry in skills.entries.items() if entry.skill == "drop"}
    operators = tuple(
        replace(operator, cost=operator.cost * DROP) if operator.instruction.name in drops else operator
        for operator in task.operators
    )
    return replace(task, operators=operators, by_instruction={o.instruction: o for o in operators})


# Maximum number of times the executor replans before the robot stops.
MOST_REPAIRS = 6
# Generated states after which the search for another plan to the same end gives up.
_NEW_PLAN_CAP = 1000


Begin: TypeAlias = Callable[[Instruction, Collection[GroundAtom], int, bool], None]
"""Receives an instruction, the facts that it should bring about, its place in the plan from 0 (of a repair: where it is
put in), and whether it is a repair."""


class Performer(Protocol):
    """Performer of instructions: a robot in a simulation."""

    @property
    def clock(self) -> int:
        """The simulation's step."""
        ...

    def situation(self) -> Hashable:
        """Return the places of everything but the robot: while it is the same, what failed fails again."""
        ...

    def idle(self, instruction: Instruction) -> bool:
        """Return whether an instruction moves nothing but the robot itself."""
        ...

    def perform(self, instruction: Instruction, gains: Collection[GroundAtom], attempt: int) -> str:
        """Carry out an instruction for its ``gains``, and return the evidence of its event.

        ``attempt`` is the number of earlier tries.

        Raises:
            SkillError: It could not be done.
        """
        ...


class Executor:
    """Executes plans and checks each step.

    ``observer`` reads the state back. ``planner`` makes at most ``most_repairs`` repairs. ``begin`` is called before
    each instruction, ``watch`` with each finished step.
    """

    def __init__(
        self,
        problem: Problem,
        observer: Observer,
        performer: Performer,
        *,
        planner: str = IN_PROCESS,
        most_repairs: int = MOST_REPAIRS,
        begin: Begin = lambda *_: None,
        watch: Callable[[ExecutedStep], None] = lambda step: None,
    ) -> None:
        self.problem = problem
        self.observer = observer
        self.performer = performer
        self.planner = planner
        self.most_repairs = most_repairs
        self.begin = begin
        self.watch = watch

    def execute(self, plan: Sequence[Instruction]) -> Execution:
        """Carry out ``plan``."""
        self._reset(plan)
        state = self.observer.now(self.problem.init)
        wanted = self._wanted(plan, state)
        waiting = [(instruction, False) for instruction in plan]
        attempt = 0
        smooth = True
        while waiting or not _satisfied(wanted, state):
            tried = waiting[0][0] if waiting else None
            if tried is not None and first_broken(tried, state, self.problem) is None:
                before = state
                place = len(plan) - sum(not repair for _, repair in waiting)
                done, state = self._do(*waiting[0], state, attempt, place)
                # it did what was predicted, and no more
                exact = not done.failure and all(self._beside(mismatch, before) for mismatch in done.mismatches)
                smooth = smooth and exact
                attempt += 1
                if exact or self._did(done, before, state):
                    waiting.pop(0)  # it did what it is for, even if something else is not as it should be
                    attempt = 0
                    if exact or self._goes_on(waiting, state, wanted):
                        continue
            repaired = self._repaired(state, waiting, wanted, tried)
            if isinstance(repaired, str):
                if _satisfied(wanted, state) and all(repair for _, repair in waiting):
                    break  # only what was to be tidied up is left
                return self._stopped(repaired, state)
            waiting = repaired
        status = SkillStatus.DONE if smooth and not self._repairs else SkillStatus.RECOVERED
        return Execution(status, "", tuple(self._steps), self._repairs, state, self._lasting(plan, state))

    def _reset(self, plan: Sequence[Instruction]) -> None:
        """Forget what was noted of the plan before."""
        self._steps: list[ExecutedStep] = []
        self._repairs = 0
        self._setbacks = Setbacks(self.observer.skills.seen)
        self._hopeless: set[tuple[tuple[Setback, ...], tuple[Instruction, ...]]] = set()
        self._lost: frozenset[GroundAtom] = frozenset()
        self._tried: Counter[tuple[Instruction, Hashable]] = Counter()
        self._spent: set[tuple[Instruction, Hashable]] = set()
        self._on_course: State = self.problem.init
        self._end: State = self.problem.init
        self._named = {name for instruction in plan for name in instruction.args}

    def _did(self, step: ExecutedStep, before: State, after: State) -> bool:
        """Return whether the changes of an instruction are as they should be."""
        if step.failure:
            return False
        predicted = apply(step.instruction, before, self.problem)
        changed = {atom for atom in predicted ^ before if not self._aside(atom)}
        return all((atom in predicted) is (atom in after) for atom in changed)

    def _aside(self, atom: GroundAtom) -> bool:
        """Return whether a fact is about the contents of a thing that the plan does not name."""
        return self._follows(atom) and atom.args[0] not in self._named

    def _beside(self, mismatch: Mismatch, before: State) -> bool:
        """Return whether what stands beside a stream stayed as it was, though PDDL lets everything there be filled."""
        return self._aside(mismatch.atom) and (mismatch.atom in before) is not mismatch.expected

    def _goes_on(self, waiting: Sequence[tuple[Instruction, bool]], state: State, wanted: _Wanted) -> bool:
        """Return whether instructions are waiting and lead to the goal from here, without replanning."""
        for instruction, _ in waiting:
            if first_broken(instruction, state, self.problem) is not None:
                return False
            state = apply(instruction, state, self.problem)
        return bool(waiting) and _satisfied(wanted, state)

    def _do(
        self, instruction: Instruction, repair: bool, state: State, attempt: int, place: int
    ) -> tuple[ExecutedStep, State]:
        predicted = apply(instruction, state, self.problem)
        begin, failure, evidence = self.performer.clock, "", ""
        key = instruction, self.performer.situation()
        self.begin(instruction, predicted - state, place, repair)
        try:
            evidence = self.performer.perform(instruction, predicted - state, attempt)
        except SkillError as error:
            failure = str(error)
            self._setbacks.failed(instruction, state, error.stage)
            self._tried[key] += 1
            if self._tried[key] >= AGAIN.get(error.stage, 2):
                self._spent.add(key)
        now = self.observer.after(state, instruction, happened=not failure, evidence=evidence)
        self._setbacks.observed(now)
        mismatches = self.observer.mismatches(predicted, now)
        effects = tuple(self.observer.effects(state, predicted, now))
        if not failure:
            self._setbacks.fruitless(instruction, self._in_vain(mismatches, now))
        self._lost = self._still_lost(mismatches, now) if failure or mismatches or repair else frozenset()
        if not (failure or mismatches or repair):
            self._on_course = now
        step = ExecutedStep(
            instruction, repair, failure, evidence, effects, tuple(mismatches), begin, self.performer.clock, now
        )
        self._steps.append(step)
        self.watch(step)
        return step, now

    def _still_lost(self, mismatches: Sequence[Mismatch], now: State) -> frozenset[GroundAtom]:
        """Return what should be in something and is not, or not hot, since the plan last went on."""
        missing = (m.atom for m in mismatches if m.expected and self._follows(m.atom))
        return frozenset(atom for atom in (*self._lost, *missing) if atom not in now and not self._aside(atom))

    def _follows(self, atom: GroundAtom) -> bool:
        """Return whether a fact is about contents: it is inferred, and not from one event."""
        return self.observer.skills.inferred.get(atom.predicate, "event") != "event"

    def _in_vain(self, mismatches: Sequence[Mismatch], now: State) -> frozenset[GroundAtom]:
        """Return the places or hands of things that should have got contents, and did not."""
        skills = self.observer.skills
        missing = [m.atom for m in mismatches if m.expected and not self._aside(m.atom)]
        dry = {atom.args[0] for atom in missing if skills.inferred.get(atom.predicate) == "contents"}
        place = {"support": 0, "held": -1}
        return frozenset(
            a for a in now if (sensor := skills.seen.get(a.predicate)) in place and a.args[place[sensor]] in dry
        )

    def _repaired(
        self, state: State, waiting: Sequence[tuple[Instruction, bool]], wanted: _Wanted, tried: Instruction | None
    ) -> list[tuple[Instruction, bool]] | str:
        """Return the next instructions after one that was ``tried``, or why execution stops."""
        if self._repairs >= self.most_repairs:
            return f"replanned {self._repairs} times, and then {self._last()}"
        self._repairs += 1
        found = self._replan(state, [instruction for instruction, repair in waiting if not repair], wanted)
        if isinstance(found, str) and tried is not None:
            return f"after {self._last()}, {found}"
        return found

    def _replan(
        self, state: State, waiting: Sequence[Instruction], wanted: _Wanted
    ) -> list[tuple[Instruction, bool]] | str:
        """Return the next instructions, each with whether it is a repair; or why there is no way.

        Setbacks are avoided if possible. Else they are tried again, unless nothing has moved since they failed.
        """
        task = ground(replace(self.problem, init=state))
        found: list[tuple[Instruction, bool]] | str | None
        found = self._regained(task, self._setbacks.standing, waiting, wanted)
        found = found or self._around(task, state, waiting, wanted)
        if found is None:
            plain = careful(task, self.observer.skills) if self.planner == IN_PROCESS else task
            way = _missing(plain, waiting, wanted, planner=self.planner, any_way=True)
            found = way if isinstance(way, str) else _joined(way, waiting)
        if isinstance(found, str):
            return found
        found += self._tidied(task, [instruction for instruction, _ in found], wanted)
        if (again := self._the_same_again([instruction for instruction, _ in found])) is not None:
            return f"there is no way left but {again}, which would be tried again as it failed: nothing has moved since"
        return found

    def _tidied(self, task: Task, way: Sequence[Instruction], wanted: _Wanted) -> list[tuple[Instruction, bool]]:
        """Return what follows a way so that hands, doors and knobs end as the plan leaves them, if one does."""
        sensors = self.observer.skills.seen
        moved = frozenset(a for a in task.atoms if sensors.get(a.predicate) in ("held", "joint", "setting"))
        plain = careful(replace(task, init=task.trace(task.init, way)[-1]), self.observer.skills)
        more = _missing(plain, (), (wanted[0], wanted[1] | moved - self._end))
        return [] if isinstance(more, str) else _joined(more, ())

    def _the_same_again(self, way: Sequence[Instruction]) -> Instruction | None:
        """Return what has failed as everything stands now, up to the first instruction that moves something."""
        moving = next((count for count, each in enumerate(way, 1) if not self.performer.idle(each)), len(way))
        now = self.performer.situation()
        return next((each for each in way[:moving] if (each, now) in self._spent), None)

    def _lasting(self, plan: Sequence[Instruction], state: State) -> tuple[Mismatch, ...]:
        """Return all differences from the plan's final state."""
        end = self.problem.init
        for instruction in plan:
            end = apply(instruction, end, self.problem)
        return tuple(self.observer.lasting(end, state))

    def _around(
        self, task: Task, state: State, waiting: Sequence[Instruction], wanted: _Wanted
    ) -> list[tuple[Instruction, bool]] | None:
        """Return a way round the setbacks, if there are any and there is one.

        The waiting instructions are kept; or others do what the next one is for, and leave things where it would; or
        the aims of the plan are reached in another way. If none of that is possible, a hand is freed first. What does
        not lead to the aims is the last choice.
        """
        question = tuple(self._setbacks.standing), tuple(waiting)
        if not self._setbacks.standing or question in self._hopeless:
            return None
        # setbacks are no part of the PDDL that other planners are given
        plain = careful(task, self.observer.skills)
        choices: list[tuple[tuple[Instruction, ...], _Wanted | None]] = [(question[1], None)]
        if waiting:
            choices += [(question[1][1:], self._same_end(waiting[0], state)), ((), None)]
        last: list[tuple[Instruction, bool]] | None = None
        for setbacks in dict.fromkeys((question[0], tuple(self._setbacks.with_free_hands(state)))):
            chances = without(plain, setbacks)
            for rest, aim in choices:
                way = _missing(chances, () if aim else rest, aim or wanted, cap=DEFAULT_CAP if rest else _NEW_PLAN_CAP)
                if isinstance(way, str):
                    continue
                if _leads(plain, [*way, *rest], wanted):
                    return _joined(way, rest)
                if rest == question[1] and last is None:
                    last = _joined(way, rest)
        if last is not None:
            return last
        self._hopeless.add(question)
        return None

    def _same_end(self, instruction: Instruction, state: State) -> _Wanted:
        """Return the aims of an instruction that is done in another way: what it names is where it would be."""
        after = apply(instruction, state, self.problem)
        changed = {a for a in after ^ state if a.predicate not in self.observer.skills.confirmed}
        places, _ = self._setbacks.situations(instruction, after)
        return frozenset(changed & after | places), frozenset(changed - after)

    def _regained(
        self, task: Task, setbacks: Sequence[Setback], waiting: Sequence[Instruction], wanted: _Wanted
    ) -> list[tuple[Instruction, bool]] | None:
        """Return a way of short plans: spilled contents are back and hot, knobs and doors as before, the rest goes on.

        A search for all at once would take much longer than each of these.
        """
        lost = self._to_regain(task.decode(task.init), waiting, wanted)
        if not lost:
            return None
        plain = careful(task, self.observer.skills)
        refilled = self._refilled(plain, setbacks, lost)
        if refilled is None:
            return None
        way, after = refilled
        worked = self._worked()
        changed = {atom for atom in self._on_course ^ plain.decode(after) if atom.predicate in worked}
        again = frozenset(changed & self._on_course), frozenset(changed - self._on_course)
        back = _missing(replace(plain, init=after), (), (again[0] | lost, again[1]))
        if isinstance(back, str):
            back = ()
        after = plain.trace(after, back)[-1]
        # what the way does itself is not done a second time
        for rest in (waiting[1:], waiting) if waiting and waiting[0] in way else (waiting, waiting[1:]):
            more = _missing(replace(plain, init=after), rest, wanted)
            if not isinstance(more, str) and _leads(plain, [*way, *back, *more, *rest], wanted):
                return _joined([*way, *back, *more], rest)
        return None

    def _to_regain(self, state: State, waiting: Sequence[Instruction], wanted: _Wanted) -> frozenset[GroundAtom]:
        """Return what was lost and is not back; once nothing waits, the contents that are wanted count as well."""
        lost = frozenset(atom for atom in self._lost if atom not in state)
        if not waiting:
            lost |= frozenset(a for a in wanted[0] if a not in state and self._follows(a))
        return lost

    def _refilled(
        self, plain: Task, setbacks: Sequence[Setback], lost: frozenset[GroundAtom]
    ) -> tuple[list[Instruction], Bits] | None:
        """Return a way to what was lost, and its end: first the contents are in again, then they are heated again."""
        way: list[Instruction] = []
        after = plain.init
        contents = frozenset(a for a in lost if self.observer.skills.inferred.get(a.predicate) == "contents")
        for part in dict.fromkeys((contents, lost)):
            begun = replace(plain, init=after)
            more = _missing(begun if way else without(begun, setbacks), (), (part, frozenset()))
            if isinstance(more, str):
                return None
            way += more
            after = plain.trace(after, more)[-1]
        return way, after

    def _wanted(self, plan: Sequence[Instruction], state: State) -> _Wanted:
        """Return the aims of the plan: the facts that it brings about, and those that it ends.

        Doors and knobs that it moves belong to it even if they end as they were: a tap that it turns on is off again.
        """
        end, moved, worked = state, set[GroundAtom](), self._worked()
        for instruction in plan:
            before, end = end, apply(instruction, end, self.problem)
            moved |= {atom for atom in before ^ end if atom.predicate in worked}
        aside = self.observer.skills.confirmed
        self._end = end
        concerned = [a for a in (state ^ end) | moved if a.predicate not in aside and not self._aside(a)]
        return frozenset(a for a in concerned if a in end), frozenset(a for a in concerned if a not in end)

    def _worked(self) -> frozenset[str]:
        return frozenset(p for p, sensor in self.observer.skills.seen.items() if sensor in ("joint", "setting"))

    def _stopped(self, reason: str, state: State) -> Execution:
        lasting = tuple(self.observer.lasting(self.problem.init, state, odd=True))
        return Execution(SkillStatus.STOPPED, reason, tuple(self._steps), self._repairs, state, lasting)

    def _last(self) -> str:
        """Return what went wrong last; what was expected and is missing goes before what is there unexpectedly."""
        for step in reversed(self._steps):
            if step.failure:
                return f"{step.instruction} failed: {step.failure}"
            if step.mismatches:
                return f"{step.instruction}: {min(step.mismatches, key=lambda m: not m.expected)}"
        return "the environment was not as described"


_Wanted = tuple[frozenset[GroundAtom], frozenset[GroundAtom]]


def _missing(
    task: Task,
    waiting: Sequence[Instruction],
    wanted: _Wanted,
    *,
    planner: str = IN_PROCESS,
    cap: int = DEFAULT_CAP,
    any_way: bool = False,
) -> Sequence[Instruction] | str:
    """Return instructions that make the waiting ones executable, or bring about the aims; or why there are none.

    With ``any_way``, a long way is accepted if no short one is found.
    """
    operators = [task.by_instruction.get(instruction) for instruction in waiting]
    known = [operator for operator in operators if operator is not None]
    if len(known) < len(operators):
        lost = next(i for i, o in zip(waiting, operators, strict=True) if o is None)
        return f"{lost} can no longer be done"
    if waiting and _runs(known, task.init):
        return ()
    if waiting:
        goal = get_constraints(known)[0]
    else:
        needed, spoiled = (task.encode(frozenset(atoms)) for atoms in wanted)
        goal = (Cube(needed, spoiled),)
    answer = make(planner, task, cap=cap).fill(task.init, goal)
    if isinstance(answer, GaveUp) and any_way and planner == IN_PROCESS:
        answer = last_resort(task).fill(task.init, goal)
    if isinstance(answer, Filled):
        return eliminate(answer.plan, task, task.init, goal)
    if isinstance(answer, Unreachable):
        return f"replanning proved that there is no way: {answer.reason}"
    return f"replanning gave up: {answer.limit}"


def _leads(task: Task, plan: Sequence[Instruction], wanted: _Wanted) -> bool:
    known = [task.by_instruction[instruction] for instruction in plan if instruction in task.by_instruction]
    runs = len(known) == len(plan) and _runs(known, task.init)
    return runs and _satisfied(wanted, task.decode(task.trace(task.init, plan)[-1]))


def _joined(repairs: Sequence[Instruction], rest: Sequence[Instruction]) -> list[tuple[Instruction, bool]]:
    """Return repairs and then the rest of a plan, each with whether it is a repair."""
    return [*((instruction, True) for instruction in repairs), *((instruction, False) for instruction in rest)]


def _runs(operators: Sequence[Operator], state: Bits) -> bool:
    for operator in operators:
        if not operator.applicable(state):
            return False
        state = operator.apply(state)
    return True


def _satisfied(wanted: _Wanted, state: State) -> bool:
    gained, ended = wanted
    return gained <= state and not ended & state
