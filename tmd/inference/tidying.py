"""Improvement of plans that reach their goals: an end that people leave, by instructions that are needed.

Not in the paper. A plan is cut into segments, one for each step of the request. What it opened, switched on or still
holds without being asked to is restored, as early as the rest of the plan allows. Then instructions are removed, and
short parts are planned again, as long as every segment still ends in its goal.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property, partial
from itertools import pairwise, permutations
from typing import TypeAlias

from tmd.pddl.domain_traits import single_valued
from tmd.pddl.model import GroundAtom, Instruction
from tmd.pddl.semantics import opposite
from tmd.pddl.task import Bits, Cube, Operator, Task, atoms_in
from tmd.planning.gap_filler import GapFiller
from tmd.planning.result import Answer, Filled, GaveUp, Planner
from tmd.world.compile import PART_OF

# Cost of letting something fall rather than putting it down, and of leaving a thing elsewhere unasked, in instructions.
_CARE = 3
_ELSEWHERE = 2
# Generated states after which the search for a part gives up, and that for what is restored at the end.
_CAP = 200
_END_CAP = 3_000
# Weight of a place where nothing stood at the start, against the other disorder of a plan.
_STRANGE = 3
# Maximum length of a part that is planned again: a search for so few instructions takes milliseconds.
_WINDOW = 5
# Maximum number of instructions that are moved together: to go to a thing, open and take it.
_BLOCK = 4
Condition: TypeAlias = tuple[Cube, ...]
"""A disjunction of conjunctions."""
Key: TypeAlias = tuple[int, int, int, int]
"""Conditions that are not restored, cost, atoms that are changed in the end, and disorder: less is better."""


@dataclass(frozen=True, slots=True)
class Need:
    """The purpose of a part of a plan.

    Attributes:
        end: What must hold at its end; empty for nothing.
        via: Conditions to be passed in it, in this order.
        fixed: Whether its instructions stay as they are, because no goal is known for them.
    """

    end: Condition = ()
    via: tuple[Condition, ...] = ()
    fixed: bool = False


@dataclass(frozen=True, slots=True)
class PlanPart:
    """The instructions for one step of a request."""

    instructions: tuple[Instruction, ...]
    need: Need


Plan: TypeAlias = tuple[PlanPart, ...]
Placed: TypeAlias = Sequence[tuple[int, Instruction]]
"""Instructions, each with the number of its part."""


@dataclass(frozen=True, slots=True)
class Tidying:
    """Improves plans for one request.

    Attributes:
        task: The task, without what the request forbids.
        planner: The planner for short gaps.
        restored: The conditions that are restored unless the request asks for them.
        lasting: The atoms that do not pass by themselves.
        contents: The atoms that say what is in what.
        allowed: Returns whether the request allows a sequence of states.
        orderly: Whether instructions are put in order, and things are taken back to where they were.
    """

    task: Task
    planner: Planner
    restored: Sequence[Condition]
    lasting: Bits
    contents: Bits
    allowed: Callable[[Sequence[Bits]], bool]
    orderly: bool = True

    def is_careless(self, instruction: Instruction) -> bool:
        """Return whether an instruction lets something fall."""
        planner = self.planner
        return isinstance(planner, GapFiller) and instruction not in planner.careful.task.by_instruction

    def improved(self, start: Bits, plan: Plan, kept: Condition) -> Plan:
        """Return a plan that is at least as good. ``kept`` must hold at its end, beside the needs of its parts."""
        return _Improvement(self, start, plan, kept).improved(plan)

    def pruned(self, start: Bits, part: PlanPart) -> tuple[Instruction, ...]:
        """Return the instructions of a part of a plan that starts in ``start``, without those that are for nothing."""
        return _Improvement(self, start, (part,), (Cube(),)).pruned((part,))[0].instructions


class _Improvement:
    """The improvement of one plan, with what any other plan must not change."""

    def __init__(self, setup: Tidying, start: Bits, plan: Plan, kept: Condition) -> None:
        self.setup = setup
        self.task = setup.task
        self.start = start
        self.kept = kept
        states = self._states(plan)
        end = states[-1][-1] if states else start
        # another way to the same goals may fill another mug
        wanted = atoms_in(Cube(cube.positive) for part in plan for cube in part.need.end)
        vessels = {atom.args[0] for atom in self.task.names(wanted) if atom.args}
        self.moved = self._moved(end) | vessels
        # what was poured away, or is not in a vessel of a goal, was in the way there
        gone = ~end & setup.contents & ~wanted
        own = self.task.encode(atom for atom in self.task.names(gone) if atom.args[0] in vessels)
        self.absent = (gone & start) | own
        self.asked_true, self.asked_false = _asked(kept, end, plan, states)
        self.asked = self.asked_true | self.asked_false
        self.settled = self._names(self.asked_true & end)
        self._soon = cache(self._searched)
        self._keys: dict[tuple[tuple[Instruction, ...], ...], Key | None] = {}

    @cached_property
    def watched(self) -> list[int]:
        """The conditions that are restored: they did not hold at the start, and nobody asks for them."""
        true, false = self.asked_true, self.asked_false
        conditions = enumerate(self.setup.restored)
        return [
            number
            for number, condition in conditions
            if not _any_holds(condition, self.start)
            and not any(c.positive & true or c.negative & false for c in condition)
        ]

    @cached_property
    def places(self) -> list[GroundAtom]:
        """The atoms that say where things are at the start."""
        values = single_valued(self.task.problem.domain)
        stood = self.task.names(self.start & self.setup.lasting & ~self.setup.contents)
        return [atom for atom in stood if len(atom.args) > 1 and atom.predicate not in values]

    @cached_property
    def home(self) -> Bits:
        """The atoms of ``places`` about things that the request does not name."""
        named = self._names(self.asked)
        return self.task.encode(atom for atom in self.places if atom.args[0] not in named)

    @cached_property
    def usual(self) -> set[str]:
        """The places where something is at the start."""
        return {atom.args[1] for atom in self.places}

    @cached_property
    def begun(self) -> tuple[Bits, list[Condition]]:
        """The conditions that are to be restored and did not hold at the start: single atoms, and others."""
        begun = [c for c in self.setup.restored if not _any_holds(c, self.start)]
        simple = {c for c in begun if len(c) == 1 and not c[0].negative and c[0].positive.bit_count() == 1}
        return sum({c[0].positive for c in simple}), [c for c in begun if c not in simple]

    @cached_property
    def wholes(self) -> dict[str, str]:
        """The whole of each part."""
        return {fact.args[0]: fact.args[1] for fact in self.task.static if fact.predicate == PART_OF}

    def _names(self, bits: Bits) -> set[str]:
        """Return the objects that atoms are about."""
        return {argument for atom in self.task.names(bits) for argument in atom.args}

    def improved(self, plan: Plan) -> Plan:
        """Return the plan with what it leaves restored, and without what it does not need."""
        if self._key(plan) is None:
            return plan
        plan = self._restored(plan)
        before = None
        while plan != before:
            before = plan
            plan = self.pruned(plan)
            if self.setup.orderly:
                plan = self._with_usual_places(self._returned(self._with_care(self._ordered(plan))))
            plan = self._with_others(self._with_windows(plan))
        return plan

    def pruned(self, plan: Plan) -> Plan:
        """Return the plan without objects and instructions that are there for nothing."""
        if self._key(plan) is None:
            return plan
        plan = self._without_objects(plan)
        return self._without_instructions(self._without_detours(plan) if self.setup.orderly else plan)

    # ------------------------------------------------------------------ the measure

    def _states(self, plan: Plan) -> list[list[Bits]]:
        """Return the states of each segment, from the one in which it begins."""
        found: list[list[Bits]] = []
        state = self.start
        for segment in plan:
            found.append(self.task.trace(state, segment.instructions))
            state = found[-1][-1]
        return found

    def _key(self, plan: Plan) -> Key | None:
        """Return how good a plan is; ``None`` where it cannot be executed or misses what it is for."""
        own = tuple(segment.instructions for segment in plan)
        if own not in self._keys:
            self._keys[own] = self._measured(plan)
        return self._keys[own]

    def _measured(self, plan: Plan) -> Key | None:
        states = [self.start]
        cost = 0
        for segment in plan:
            trace = [states[-1]]
            for instruction in segment.instructions:
                operator = self.task.by_instruction.get(instruction)
                if operator is None or not operator.applicable(trace[-1]):
                    return None
                cost += operator.cost + _CARE * self.setup.is_careless(instruction)
                trace.append(operator.apply(trace[-1]))
            need = segment.need
            if (need.end and not _any_holds(need.end, trace[-1])) or not passes(need.via, trace):
                return None
            states += trace[1:]
        end = states[-1]
        other = end & self.absent or not self._moved(end) <= self.moved
        if other or not _any_holds(self.kept, end) or not self.setup.allowed(states):
            return None
        if self.setup.orderly:
            cost += _ELSEWHERE * len({atom.args[0] for atom in self.task.names(self.home & ~end)})
        changed = ((end ^ self.start) & self.setup.lasting).bit_count()
        return len(self._untidy(end)), cost, changed, self._disorder(plan, states) if self.setup.orderly else 0

    def _disorder(self, plan: Plan, states: Sequence[Bits]) -> int:
        """Return for how long things are open, running, held or on the floor, and how often a plan turns elsewhere."""
        long = sum(self._begun(state) for state in states)
        instructions = [i for segment in plan for i in segment.instructions]
        long += _STRANGE * len([p for p in self._new_places(states[-1]) if p.args[1] not in self.usual])
        return long + 2 * sum(not self._units(a) & self._units(b) for a, b in pairwise(instructions))

    def _new_places(self, end: Bits) -> list[GroundAtom]:
        """Return where things are in the end that were elsewhere, unless the request says that they go there."""
        places = self.setup.lasting & ~self.setup.contents & ~self.asked
        lost = {(atom.predicate, atom.args[:1]) for atom in self.task.names(self.start & ~end & places)}
        gained = self.task.names(end & ~self.start & places)
        return [atom for atom in gained if len(atom.args) > 1 and (atom.predicate, atom.args[:1]) in lost]

    def _units(self, instruction: Instruction) -> set[str]:
        """Return the objects that an instruction handles; a part counts as its whole."""
        return {self.wholes.get(argument, argument) for argument in instruction.args}

    def _begun(self, state: Bits) -> int:
        """Return how many conditions that are to be restored hold, and did not hold at the start."""
        single, others = self.begun
        return (state & single).bit_count() + sum(_any_holds(c, state) for c in others)

    def _untidy(self, state: Bits) -> list[int]:
        """Return the watched conditions that hold."""
        return [number for number in self.watched if _any_holds(self.setup.restored[number], state)]

    def _moved(self, state: Bits) -> frozenset[str]:
        """Return the objects that are somewhere else, or have other contents, than at the start."""
        return moved(self.task, (state ^ self.start) & self.setup.lasting)

    def _better(self, plan: Plan, others: Iterable[Plan]) -> Plan:
        """Return the best of a plan and others; the first among equals."""
        best, least = plan, self._key(plan)
        assert least is not None
        for other in others:
            key = self._key(other)
            if key is not None and key < least:
                best, least = other, key
        return best

    # ------------------------------------------------------------------ restoration

    def _restored(self, plan: Plan) -> Plan:
        """Return a plan that leaves as few conditions unrestored as a short way allows."""
        for number in self._untidy(self._states(plan)[-1][-1] if plan else self.start):
            plan = self._inserted(plan, number)
        end = self._states(plan)[-1][-1] if plan else self.start
        untidy = self._untidy(end)
        plan = self._appended(plan, end, untidy)
        for number in untidy:
            end = self._states(plan)[-1][-1]
            if number in self._untidy(end):
                plan = self._appended(plan, end, [number])
        return plan

    def _inserted(self, plan: Plan, number: int) -> Plan:
        """Return the plan with the fewest instructions that restore a condition, as early as the rest allows."""
        best = plan
        for place, (segment, trace) in enumerate(zip(plan, self._states(plan), strict=True)):
            for at, state in enumerate(trace):
                inner = segment.need.fixed and at < len(trace) - 1
                if inner or not _any_holds(self.setup.restored[number], state):
                    continue
                found = self._planned(state, self._tidier(state, [number], (Cube(),)))
                best = self._better(best, (self._with(plan, place, at, at, own) for own in found))
        return best

    def _appended(self, plan: Plan, end: Bits, untidy: Sequence[int]) -> Plan:
        """Return the plan followed by the cheapest instructions that restore conditions."""
        if not untidy:
            return plan
        goal = self._tidier(end, untidy, self.kept)
        last = len(plan[-1].instructions)
        return self._better(
            plan, (self._with(plan, len(plan) - 1, last, last, own) for own in self._planned(end, goal, _END_CAP))
        )

    def _tidier(self, state: Bits, numbers: Sequence[int], goal: Condition) -> Condition:
        """Return a goal with some conditions restored, and without another one that does not hold now."""
        now = self._untidy(state)
        for number in self.watched:
            condition = self.setup.restored[number]
            if number in numbers or (number not in now and len(condition) == 1):
                goal = tuple(c for cube in goal for c in _denied(condition, cube))
        return goal

    def _planned(self, state: Bits, goal: Condition, cap: int = _CAP) -> Iterator[tuple[Instruction, ...]]:
        """Yield the planner's instructions from a state to a goal, if it has any."""
        if any(cube.holds(state) for cube in goal):
            yield ()
            return
        answer = self._soon(state, goal, cap) if goal else GaveUp("")
        if isinstance(answer, Filled):
            home = self._home(state, goal)
            back = self._soon(state, tuple(Cube(c.positive | home, c.negative) for c in goal), cap) if home else answer
            near = isinstance(back, Filled) and len(back.plan) <= len(answer.plan) + 1
            yield back.plan if isinstance(back, Filled) and near else answer.plan

    def _searched(self, state: Bits, goal: Condition, cap: int) -> Answer:
        """Return what a short search finds, without careless instructions if there is a way without."""
        planner = self.setup.planner
        if not isinstance(planner, GapFiller):
            return planner.fill(state, goal)
        answer = planner.careful.soon(state, goal, cap)
        return answer if isinstance(answer, Filled) or cap == _CAP else planner.soon(state, goal, cap)

    def _home(self, state: Bits, goal: Condition) -> Bits:
        """Return where things were that are in a hand now and need not be, unless the request settles that."""
        wanted = atoms_in(Cube(cube.positive) for cube in goal)
        held = {
            argument
            for number in self._untidy(state)
            for cube in self.setup.restored[number]
            if not cube.positive & wanted
            for argument in self._names(cube.positive)
        }
        held -= self.settled
        lost = self.task.names(self.start & ~state & self.setup.lasting & ~self.asked)
        return self.task.encode(atom for atom in lost if len(atom.args) > 1 and atom.args[0] in held)

    # ------------------------------------------------------------------ shorter plans

    @staticmethod
    def _with(plan: Plan, place: int, first: int, last: int, own: tuple[Instruction, ...]) -> Plan:
        """Return the plan with other instructions from ``first`` to ``last`` of one segment."""
        segment = plan[place]
        instructions = (*segment.instructions[:first], *own, *segment.instructions[last:])
        return (*plan[:place], replace(segment, instructions=instructions), *plan[place + 1 :])

    def _executable(
        self, plan: Plan, changed: Callable[[Instruction], Instruction | None] = lambda i: i, *, untaken: str = ""
    ) -> Plan:
        """Return the plan with its instructions changed, and without what cannot be executed then.

        The object ``untaken`` is not taken in a hand, nor anything else begun with it.
        """
        found, state = [], self.start
        for segment in plan:
            own, fixed = [], segment.need.fixed
            for instruction in segment.instructions:
                new = instruction if fixed else changed(instruction)
                operator = self.task.by_instruction.get(new) if new is not None else None
                if new is None or operator is None or not operator.applicable(state):
                    continue
                after = operator.apply(state)
                if fixed or untaken not in new.args or self._begun(after) <= self._begun(state):
                    own.append(new)
                    state = after
            found.append(replace(segment, instructions=tuple(own)))
        return tuple(found)

    def _with_care(self, plan: Plan) -> Plan:
        """Return the plan with other instructions instead of those that let something fall or restore something."""
        for place in range(len(plan)):
            at = 0
            while not plan[place].need.fixed and at < len(plan[place].instructions):
                instruction, trace = plan[place].instructions[at], self._states(plan)[place]
                restores = self._begun(trace[at + 1]) < self._begun(trace[at])
                careless = self.setup.is_careless(instruction)
                if restores or careless:
                    other = self._executable(self._with(plan, place, at, at + 1, ()))
                    if self._key(other) is not None:
                        plan = self._better(plan, [self._restored(other)])
                if careless:
                    for length in range(1, _WINDOW):
                        plan = self._with_window(plan, place, at, length, _END_CAP)
                at += 1
        return plan

    def _ordered(self, plan: Plan) -> Plan:
        """Return the plan with instructions where they belong.

        Things are opened, switched on and taken late and restored early, and what concerns one thing stands together.
        """
        at = 0
        while at < sum(len(segment.instructions) for segment in plan):
            better = plan
            for length in range(_BLOCK, 0, -1):
                better = self._better(better, self._moves(better, at, length))
            at += better == plan  # another instruction may stand there now
            plan = better
        return plan

    def _returned(self, plan: Plan) -> Plan:
        """Return the plan with things taken back to where they were, where that costs little more."""
        for atom in self.task.names(self.home & ~self._states(plan)[-1][-1]) if plan else ():
            placed = _placed(plan)
            states = self.task.trace(self.start, (i for _, i in placed))
            handled = [n for n, (_, i) in enumerate(placed) if atom.args[0] in i.args]
            if handled and not plan[placed[handled[-1]][0]].need.fixed:
                before = range(handled[-1])
                restoring = [n for n in before if self._begun(states[n + 1]) < self._begun(states[n])]
                for other in (handled[-1], *restoring):
                    without = {handled[-1], other}
                    plan = self._better(plan, self._with_return(plan, placed, handled[:-1], without, atom))
        return plan

    def _with_return(
        self, plan: Plan, placed: Placed, used: Sequence[int], without: set[int], atom: GroundAtom
    ) -> Iterator[Plan]:
        """Yield plans without some instructions that take a thing to where it was as soon as it has served.

        ``used`` are the numbers of those of the ``placed`` for which the thing is needed; those ``without`` are left
        out. ``atom`` is the place of the thing.
        """
        at = used[-1] + 1 if used else 0
        kept = [pair for n, pair in enumerate(placed[:at]) if n not in without]
        rest = [pair for n, pair in enumerate(placed[at:], at) if n not in without]
        part = placed[at - 1][0] if at else placed[0][0]
        if plan[part].need.fixed:
            return
        state = self._states(self._executable(_arranged(plan, kept)))[-1][-1]
        home, needed = self.task.encode([atom]), 0
        if rest:
            needed = self.task.by_instruction[rest[0][1]].precondition.positive & state
        for goal in dict.fromkeys((Cube(home), Cube(home | needed))):
            for own in self._planned(state, (goal,)):
                other = self._executable(_arranged(plan, [*kept, *((part, i) for i in own), *rest]))
                if self._key(other) is not None:
                    yield self._without_instructions(self._restored(other))

    def _with_usual_places(self, plan: Plan) -> Plan:
        """Return the plan with things put down where things stand at the start, rather than where nothing does."""
        for atom in self._new_places(self._states(plan)[-1][-1]) if plan else ():
            thing, there = atom.args[:2]
            numbered = ((place, at, i) for place, part in enumerate(plan) for at, i in enumerate(part.instructions))
            put_down = [(place, at) for place, at, i in numbered if {thing, there} <= set(i.args)]
            if not put_down or there in self.usual or plan[put_down[-1][0]].need.fixed:
                continue
            place, at = put_down[-1]
            first, last = max(at - _WINDOW, 0), at + _WINDOW
            part = plan[place].instructions[first:last]
            others = (tuple(_with_name(i, there, other) for i in part) for other in sorted(self.usual))
            known = (own for own in others if all(i in self.task.by_instruction for i in own))
            plan = self._better(plan, (self._with(plan, place, first, last, own) for own in known))
        return plan

    def _moves(self, plan: Plan, at: int, length: int) -> Iterator[Plan]:
        """Yield the plans in which some instructions of one segment stand elsewhere, and that can be executed."""
        placed = _placed(plan)
        block, rest = placed[at : at + length], placed[:at] + placed[at + length :]
        if len(block) < length or block[0][0] != block[-1][0] or plan[block[0][0]].need.fixed:
            return
        states = self.task.trace(self.start, (i for _, i in placed))
        matters = self._begun(states[at]) != self._begun(states[at + length])
        for to in range(len(rest) + 1):
            place = _part_at(rest, to, at, block[0][0])
            if (
                to == at
                or plan[place].need.fixed
                or not (matters or self._related(block, rest[max(to - 1, 0) : to + 1]))
            ):
                continue
            new = [*rest[:to], *((place, i) for _, i in block), *rest[to:]]
            first = min(at, to)
            if self._applicable(states[first], [i for _, i in new[first:]]):
                yield _arranged(plan, new)

    def _related(self, some: Placed, others: Placed) -> bool:
        """Return whether some instructions concern what others do."""
        return any(self._units(a) & self._units(b) for _, a in some for _, b in others)

    def _applicable(self, state: Bits, instructions: Sequence[Instruction]) -> bool:
        """Return whether instructions can be executed in a state."""
        for instruction in instructions:
            operator = self.task.by_instruction[instruction]
            if not operator.applicable(state):
                return False
            state = operator.apply(state)
        return True

    def _without_objects(self, plan: Plan) -> Plan:
        """Return the plan without the objects that it handles for nothing."""
        for name in dict.fromkeys(a for s in plan for i in s.instructions for a in i.args):
            plan = self._better(plan, [self._executable(plan, partial(_unless_about, name))])
        return plan

    def _without_detours(self, plan: Plan) -> Plan:
        """Return the plan without objects that only stand for others: sugar goes into the mug that it is for."""
        pairs = (pair for s in plan for i in s.instructions for pair in permutations(i.args, 2) if pair[0] != pair[1])
        for name, other in dict.fromkeys(pairs):
            renamed = partial(_with_name, name=name, other=other)
            plan = self._better(plan, (self._executable(plan, renamed, untaken=thing) for thing in ("", other)))
        return plan

    def _without_instructions(self, plan: Plan) -> Plan:
        """Return the plan without single instructions, and those that need them, that are there for nothing."""
        place, at = len(plan) - 1, len(plan[-1].instructions) if plan else 0
        while place >= 0:
            at -= 1
            if at < 0:
                place -= 1
                at = len(plan[place].instructions) if place >= 0 else 0
                continue
            if not plan[place].need.fixed:
                plan = self._better(plan, [self._executable(self._with(plan, place, at, at + 1, ()))])
            at = min(at, len(plan[place].instructions))
        return plan

    def _with_others(self, plan: Plan) -> Plan:
        """Return the plan with instructions that change less: nobody drives a cow along to get to the next field."""
        for place in range(len(plan)):
            for at in range(0 if plan[place].need.fixed else len(plan[place].instructions)):
                state, goal = self._states(plan)[place][at], self._relied_on(plan, place, at + 1)
                usable = (o for o in self.task.operators if o.applicable(state) and goal.holds(o.apply(state)))
                plan = self._better(plan, (self._with(plan, place, at, at + 1, (o.instruction,)) for o in usable))
        return plan

    def _with_windows(self, plan: Plan) -> Plan:
        """Return the plan with its parts, and pieces of them, replaced by shorter ones for what the rest relies on."""
        for place in range(len(plan)):
            if self.setup.orderly and not plan[place].need.fixed:
                plan = self._with_window(plan, place, 0, len(plan[place].instructions), _END_CAP)
            at = 0
            while not plan[place].need.fixed and at < len(plan[place].instructions):
                plan = self._with_window(plan, place, at)
                at += 1
        return plan

    def _with_window(self, plan: Plan, place: int, at: int, length: int = _WINDOW, cap: int = _CAP) -> Plan:
        last = min(at + length, len(plan[place].instructions))
        if last - at < min(2, length):
            return plan
        trace = self._states(plan)[place]
        goal = (self._relied_on(plan, place, last),)
        found = self._planned(trace[at], goal, cap)
        return self._better(plan, (self._with(plan, place, at, last, own) for own in found))

    def _relied_on(self, plan: Plan, place: int, at: int) -> Cube:
        """Return the literals of a state in a plan that the instructions and needs after it read."""
        states = self._states(plan)
        cubes = [cube for number in self.watched for cube in self.setup.restored[number]]
        for needed, state in ((self.kept, states[-1][-1]), *_ends(plan[place:], states[place:])):
            cubes.append(next((c for c in needed if c.holds(state)), Cube()))
        for index in range(place, len(plan)):
            first = at if index == place else 0
            for instruction, state in zip(plan[index].instructions[first:], states[index][first:], strict=False):
                cubes += _read_by(self.task.by_instruction[instruction], state)
        state, read = states[place][at], atoms_in(cubes)
        return Cube(read & state, read & ~state)


def _unless_about(name: str, instruction: Instruction) -> Instruction | None:
    """Return an instruction that does not handle an object; ``None`` for others."""
    return None if name in instruction.args else instruction


def _with_name(instruction: Instruction, name: str, other: str) -> Instruction:
    """Return an instruction with another object in the place of one."""
    return instruction._replace(args=tuple(other if argument == name else argument for argument in instruction.args))


def _asked(kept: Condition, end: Bits, plan: Plan, states: Sequence[Sequence[Bits]]) -> tuple[Bits, Bits]:
    """Return what must hold and what must not hold at the ends of the parts of a plan, as they were reached."""
    true = false = 0
    for cubes, state in ((kept, end), *((s.need.end, trace[-1]) for s, trace in zip(plan, states, strict=True))):
        cube = next((c for c in cubes if c.holds(state)), Cube())
        true |= cube.positive
        false |= cube.negative
    return true, false


def _placed(plan: Plan) -> list[tuple[int, Instruction]]:
    """Return all instructions, each with the number of its part."""
    return [(place, i) for place, segment in enumerate(plan) for i in segment.instructions]


def _part_at(rest: Placed, to: int, at: int, own: int) -> int:
    """Return the number of the part to which instructions belong that are moved from ``at`` to ``to``."""
    if to and to <= at:
        return rest[to - 1][0]
    return rest[to][0] if to < len(rest) else own


def _arranged(plan: Plan, placed: Placed) -> Plan:
    """Return the plan with other instructions, each with the number of its part."""
    parts = (tuple(i for own, i in placed if own == number) for number in range(len(plan)))
    return tuple(replace(s, instructions=own) for s, own in zip(plan, parts, strict=True))


def _ends(plan: Plan, states: Sequence[Sequence[Bits]]) -> Iterator[tuple[Condition, Bits]]:
    for segment, trace in zip(plan, states, strict=True):
        yield segment.need.end, trace[-1]
        for condition in segment.need.via:
            yield condition, next((s for s in trace if _any_holds(condition, s)), trace[-1])


def _read_by(operator: Operator, state: Bits) -> list[Cube]:
    """Return the conditions that matter to an operator in a state: its own, and those of the effects that it has."""
    effects = (effect.condition for effect in operator.conditional if effect.condition.holds(state))
    return [operator.precondition, *operator.forbidden, *effects]


def _any_holds(condition: Condition, state: Bits) -> bool:
    return any(cube.holds(state) for cube in condition)


def moved(task: Task, changed: Bits) -> frozenset[str]:
    """Return the objects of which changed atoms say that they are somewhere else, or have other contents."""
    return frozenset(atom.args[0] for atom in task.names(changed) if len(atom.args) > 1)


def passes(via: Sequence[Condition], trace: Sequence[Bits]) -> bool:
    """Return whether states meet conditions in their order."""
    at = 0
    for condition in via:
        while at < len(trace) and not _any_holds(condition, trace[at]):
            at += 1
    return at < len(trace)


def _denied(condition: Condition, cube: Cube) -> Iterator[Cube]:
    """Yield the conjunctions of a cube with the negation of a condition."""
    if not condition:
        yield cube
        return
    first, rest = condition[0], condition[1:]
    for other in _denied(rest, cube):
        for literal in opposite(first):
            both = other.joined(literal)
            if both is not None:
                yield both
