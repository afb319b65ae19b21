"""Plan-resolved ground STRIPS: the problem as one plan meets it, for planners that know nothing else.

Each action of the exported domain is an instruction of the plan with its conditional effects decided: those that
fire on the way are plain effects, their conditions are preconditions, and so is one literal that keeps each of the
others from firing. A disjunction is decided by the literal that holds. So in every state where an exported action
applies, the instruction applies as well and does exactly the same: every plan of the export is a plan of the problem.
The other way round that is not so: what the plan does not do cannot be done.

A negated literal becomes an atom of a separate predicate, ``not_`` and the name, which is kept in step. Atoms that
never change are compiled away. Predicates and objects keep their names; an action is named by its instruction,
``grasp-cup1``, with the number of its step behind it where the same instruction is decided in two ways.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from operator import or_

from tmd.export.planned_problem import Planned
from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.model import (
    OBJECT,
    ActionSchema,
    And,
    Atom,
    Domain,
    Effect,
    GroundAtom,
    Instruction,
    Predicate,
    Problem,
    State,
    TypedName,
    rebuilt,
)
from tmd.pddl.task import Bits, Cube, Operator, Task

_NOT = "not_"


@dataclass(frozen=True)
class Strips:
    """A plan-resolved problem.

    Attributes:
        plan: The plan, in its actions; they have no arguments.
        instructions: The instruction that each of its actions was made of, by the action's name.
    """

    problem: Problem
    plan: tuple[Instruction, ...]
    instructions: Mapping[str, Instruction]


@dataclass(frozen=True, slots=True)
class _Decided:
    """An operator with its conditions decided: what it needs, adds and deletes."""

    instruction: Instruction
    needs: Cube
    add: Bits
    delete: Bits


def strips(source: Planned, *, typed: bool = False) -> Strips:
    """Return the plan-resolved ground STRIPS of a planned problem.

    Costs are left out: in the export each action costs 1. With ``typed`` the types of the original are written; the
    actions have no parameters and need none.

    Raises:
        TmdError: The problem cannot be ground.
    """
    task = ground(source.portable)
    found = _written(task, *_followed(task, source.plan))
    return found if typed else replace(found, problem=_without_types(found.problem))


def _without_types(problem: Problem) -> Problem:
    untyped = (OBJECT,)
    bare: Problem = rebuilt(problem, lambda part: replace(part, types=untyped) if isinstance(part, TypedName) else part)
    return replace(bare, domain=replace(bare.domain, types=(), requirements=(":strips",)))


@dataclass(frozen=True, slots=True)
class Checked:
    """An instruction of a plan between what is to be checked around it; literals are atoms that hold or do not.

    Of a disjunction, ``before`` has the literal that holds.
    """

    instruction: Instruction
    before: tuple[tuple[GroundAtom, bool], ...]
    after: tuple[tuple[GroundAtom, bool], ...]


def checked_steps(source: Planned) -> tuple[list[Checked], tuple[tuple[GroundAtom, bool], ...]]:
    """Return each instruction of the plan with what can be checked before and after it, and the literals of the goal.

    Raises:
        TmdError: The problem cannot be ground.
    """
    task = ground(source.portable)
    state = task.init
    found = []
    for instruction in source.plan:
        operator = task.by_instruction[instruction]
        before = operator.precondition
        for cube in operator.forbidden:
            before = _kept_false(cube, before, state)
        after = operator.apply(state)
        changes = Cube(after & ~state, state & ~after)
        found.append(Checked(instruction, _literals(task, before), _literals(task, changes)))
        state = after
    return found, _literals(task, next(cube for cube in task.goal if cube.holds(state)))


def _literals(task: Task, cube: Cube) -> tuple[tuple[GroundAtom, bool], ...]:
    positive = [(atom, True) for atom in task.names(cube.positive)]
    return (*positive, *((atom, False) for atom in task.names(cube.negative)))


def _followed(task: Task, plan: Iterable[Instruction]) -> tuple[list[_Decided], Cube]:
    """Return the operators of ``plan`` as they work in turn, and the case of the goal that holds at the end."""
    state = task.init
    steps: list[_Decided] = []
    for instruction in plan:
        operator = task.by_instruction[instruction]
        steps.append(_decided(operator, state))
        state = operator.apply(state)
    return steps, next(cube for cube in task.goal if cube.holds(state))


def _decided(operator: Operator, state: Bits) -> _Decided:
    """Return ``operator`` as it works in ``state``."""
    needs = operator.precondition
    add, delete = operator.add, operator.delete
    silent = list(operator.forbidden)
    for condition, also_add, also_delete in operator.conditional:
        if condition.holds(state):
            needs = Cube(needs.positive | condition.positive, needs.negative | condition.negative)
            add |= also_add
            delete |= also_delete
        else:
            silent.append(condition)
    for cube in silent:
        needs = _kept_false(cube, needs, state)
    return _Decided(operator.instruction, needs, add, delete & ~add)


def _kept_false(cube: Cube, needs: Cube, state: Bits) -> Cube:
    """Return ``needs`` with a literal that keeps ``cube`` false, as it is in ``state``; unchanged if one is there."""
    if cube.positive & needs.negative or cube.negative & needs.positive:
        return needs
    absent, present = cube.positive & ~state, cube.negative & state
    if absent:
        return Cube(needs.positive, needs.negative | (absent & -absent))
    return Cube(needs.positive | (present & -present), needs.negative)


def _written(task: Task, steps: Sequence[_Decided], goal: Cube) -> Strips:
    names = _names(steps)
    writer = _Writer(task, reduce(or_, (step.needs.negative for step in steps), goal.negative))
    actions = {names[step]: writer.action(names[step], step) for step in steps}
    problem = writer.problem(tuple(actions.values()), goal)
    plan = tuple(Instruction(names[step]) for step in steps)
    return Strips(problem, plan, {names[step]: step.instruction for step in steps})


def _names(steps: Sequence[_Decided]) -> dict[_Decided, str]:
    """Return a name for each different action, in the order of the plan."""
    names: dict[_Decided, str] = {}
    taken: set[str] = set()
    for number, step in enumerate(steps, start=1):
        if step in names:
            continue
        name = "-".join((step.instruction.name, *step.instruction.args))
        while name in taken:
            name += f"-{number}"
        names[step] = name
        taken.add(name)
    return names


class _Writer:
    """Writer of bit sets as atoms; atoms that must be false become atoms of a separate predicate."""

    def __init__(self, task: Task, negated: Bits) -> None:
        self.task = task
        self.negated = negated
        domain = task.problem.domain
        self.known = {p.name: p for p in domain.predicates}
        self.used: set[str] = set()

    def opposite(self, atom: GroundAtom) -> GroundAtom:
        name = _NOT + atom.predicate
        while name in self.known:
            name += "_"
        return GroundAtom(name, atom.args)

    def atoms(self, cube: Cube) -> list[GroundAtom]:
        negative = [self.opposite(atom) for atom in self.task.names(cube.negative)]
        return [*self.task.names(cube.positive), *negative]

    def action(self, name: str, step: _Decided) -> ActionSchema:
        needs = And(tuple(self.lifted(atom) for atom in self.atoms(step.needs)))
        gained = self.atoms(Cube(step.add, step.delete & self.negated))
        lost = self.atoms(Cube(step.delete, step.add & self.negated))
        effects = [Effect(self.lifted(atom)) for atom in gained]
        effects += [Effect(self.lifted(atom), positive=False) for atom in lost]
        return ActionSchema(name, (), needs, tuple(effects))

    def lifted(self, atom: GroundAtom) -> Atom:
        self.used.add(atom.predicate)
        return Atom(atom.predicate, atom.args)

    def problem(self, actions: tuple[ActionSchema, ...], goal: Cube) -> Problem:
        """Return the problem: only what its actions and its goal speak of is in it."""
        source = self.task.problem
        aim = And(tuple(self.lifted(atom) for atom in self.atoms(goal)))
        start = self.atoms(Cube(self.task.init, self.negated & ~self.task.init))
        init: State = frozenset(atom for atom in start if atom.predicate in self.used)
        domain = Domain(
            source.domain.name,
            (":strips", ":typing") if source.domain.types else (":strips",),
            source.domain.types,
            source.all_objects(),
            self.predicates(),
            (),
            actions,
        )
        return Problem(source.name, domain, (), init, aim)

    def predicates(self) -> tuple[Predicate, ...]:
        found = []
        for predicate in self.known.values():
            plain = replace(predicate, comment="")
            other = self.opposite(GroundAtom(predicate.name)).predicate
            found += [replace(plain, name=name) for name in (predicate.name, other) if name in self.used]
        return tuple(found)
