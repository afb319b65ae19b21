"""What PDDL means: when a condition holds, what an instruction does (the paper's Φ), and its inverse.

The environment of section III-A of the paper is a :data:`~tmd.pddl.model.State`; ``apply`` is Φ for one
instruction. The conditions of conditional effects all read the state before the instruction, and where an
atom is both deleted and added it is added. Everything else in the package (grounding, searching, validating)
must agree with this file, and tests hold them to it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from typing import TypeAlias

from tmd.diagnostics import TmdError
from tmd.pddl.formulas import conjuncts, free_variables
from tmd.pddl.hierarchy import Universe, universe
from tmd.pddl.model import (
    ActionSchema,
    And,
    Atom,
    Effect,
    Equals,
    Exists,
    Forall,
    Formula,
    GroundAtom,
    Imply,
    Instruction,
    Not,
    Or,
    Problem,
    State,
    TypedName,
)
from tmd.pddl.reading.syntax import nearest
from tmd.pddl.regress import regress
from tmd.pddl.writer import format_formula

__all__ = [
    "Binding",
    "Broken",
    "action_cost",
    "applicable",
    "apply",
    "bind",
    "bindings",
    "cost",
    "first_broken",
    "first_false",
    "holds",
    "instantiate",
    "regress",
    "schema_of",
]

Binding: TypeAlias = Mapping[str, str]
"""The object that each variable stands for."""


@dataclass(frozen=True, slots=True)
class Broken:
    """A part of a condition that does not hold.

    Attributes:
        text: The ground part as PDDL: ``(on mug1 counter1)``, ``(not (holding mug1))``, ``(or ...)``.
        atom: The atom, where the part is a literal.
        positive: Whether the atom should hold; it should not where this is false.
    """

    text: str
    atom: GroundAtom | None = None
    positive: bool = True


def instantiate(atom: Atom, binding: Binding) -> GroundAtom:
    """The ground atom of ``atom`` under ``binding``."""
    return GroundAtom(atom.predicate, tuple([binding.get(t, t) for t in atom.terms]))


def bindings(parameters: tuple[TypedName, ...], objects: Universe, outer: Binding) -> Iterator[Binding]:
    """``outer`` extended by every choice of objects for ``parameters``."""
    names = [p.name for p in parameters]
    for choice in product(*(objects.of(p.types) for p in parameters)):
        yield {**outer, **dict(zip(names, choice, strict=True))}


def holds(formula: Formula, state: State, objects: Problem | Universe, binding: Binding | None = None) -> bool:
    """Whether ``formula`` holds in ``state``; quantifiers range over ``objects``."""
    known = universe(objects) if isinstance(objects, Problem) else objects
    return _holds(formula, state, known, binding or {})


def _holds(formula: Formula, state: State, objects: Universe, binding: Binding) -> bool:
    match formula:
        case Atom():
            return instantiate(formula, binding) in state
        case Equals(left, right):
            return binding.get(left, left) == binding.get(right, right)
        case Not(part):
            return not _holds(part, state, objects, binding)
        case And(parts):
            return all(_holds(p, state, objects, binding) for p in parts)
        case Or(parts):
            return any(_holds(p, state, objects, binding) for p in parts)
        case Imply(left, right):
            return not _holds(left, state, objects, binding) or _holds(right, state, objects, binding)
        case Forall(parameters, part):
            return all(_holds(part, state, objects, b) for b in bindings(parameters, objects, binding))
        case Exists(parameters, part):
            return any(_holds(part, state, objects, b) for b in bindings(parameters, objects, binding))


def schema_of(problem: Problem, instruction: Instruction) -> ActionSchema:
    """The action that ``instruction`` names.

    Raises:
        TmdError: There is no such action.
    """
    for action in problem.domain.actions:
        if action.name == instruction.name:
            return action
    names = [a.name for a in problem.domain.actions]
    raise TmdError(f'unknown action "{instruction.name}"', hint=nearest(instruction.name, names, what="actions"))


def bind(problem: Problem, instruction: Instruction) -> dict[str, str]:
    """The object of each parameter of the instruction's action.

    Raises:
        TmdError: Unknown action or object, wrong number or wrong type of arguments.
    """
    action = schema_of(problem, instruction)
    if len(instruction.args) != len(action.parameters):
        shown = ", ".join(p.name for p in action.parameters)
        raise TmdError(
            f'"{action.name}" takes {len(action.parameters)} argument(s), found {len(instruction.args)}',
            hint=f"declared as {action.name}({shown})",
        )
    objects = universe(problem)
    for argument, parameter in zip(instruction.args, action.parameters, strict=True):
        given = objects.types_of.get(argument)
        if given is None:
            hint = nearest(argument, list(objects.types_of), what="objects")
            raise TmdError(f'unknown object "{argument}" in {instruction}', hint=hint)
        if not objects.is_a(argument, parameter.types):
            raise TmdError(
                f'"{argument}" in {instruction} is of type "{given[0]}", '
                f"{parameter.name} needs {' or '.join(parameter.types)}"
            )
    return {p.name: a for p, a in zip(action.parameters, instruction.args, strict=True)}


def applicable(instruction: Instruction, state: State, problem: Problem) -> bool:
    """Whether the instruction's precondition holds in ``state``.

    Raises:
        TmdError: As :func:`bind`.
    """
    binding = bind(problem, instruction)
    return _holds(schema_of(problem, instruction).precondition, state, universe(problem), binding)


def apply(instruction: Instruction, state: State, problem: Problem) -> State:
    """Φ: the state after ``instruction``. Its precondition is not read, so execution can be forced.

    Raises:
        TmdError: As :func:`bind`.
    """
    outer = bind(problem, instruction)
    objects = universe(problem)
    added: set[GroundAtom] = set()
    deleted: set[GroundAtom] = set()
    for effect in schema_of(problem, instruction).effects:
        for binding in _satisfying(effect, state, objects, outer):
            (added if effect.positive else deleted).add(instantiate(effect.atom, binding))
    return (state - deleted) | added


def _satisfying(effect: Effect, state: State, objects: Universe, outer: Binding) -> list[Binding]:
    """The bindings of the effect's parameters under which its condition holds.

    Each conjunct is tested as soon as its variables are bound, which spares most combinations of objects.
    """
    found = [outer]
    for parameter, tests in _stages(effect):
        if parameter:
            found = [{**b, parameter.name: o} for b in found for o in objects.of(parameter.types)]
        found = [b for b in found if all(_holds(test, state, objects, b) for test in tests)]
    return found


@lru_cache(maxsize=4096)
def _stages(effect: Effect) -> tuple[tuple[TypedName | None, tuple[Formula, ...]], ...]:
    """The effect's parameters, each with the conjuncts that can be tested once it is bound; first those before."""
    own = {p.name for p in effect.parameters}
    waiting = [(free_variables(part) & own, part) for part in conjuncts(effect.condition)]
    stages: list[tuple[TypedName | None, tuple[Formula, ...]]] = []
    bound: set[str] = set()
    for parameter in (None, *effect.parameters):
        if parameter:
            bound.add(parameter.name)
        stages.append((parameter, tuple(part for needed, part in waiting if needed <= bound)))
        waiting = [(needed, part) for needed, part in waiting if not needed <= bound]
    return tuple(stages)


def cost(instruction: Instruction, problem: Problem) -> int:
    """What ``instruction`` adds to the cost of a plan: 1 each, unless the problem minimises total-cost.

    Where it does, an action that says nothing about costs is free, as other planners have it.

    Raises:
        TmdError: As :func:`bind`, or the problem gives no value for the cost.
    """
    return action_cost(problem, schema_of(problem, instruction), bind(problem, instruction))


def action_cost(problem: Problem, action: ActionSchema, binding: Binding) -> int:
    """What ``action`` costs under ``binding``; see :func:`cost`."""
    if not problem.minimize_cost:
        return 1
    if not isinstance(action.cost, Atom):
        return action.cost or 0
    function = instantiate(action.cost, binding)
    value = problem.function_values.get(function)
    if value is None:
        raise TmdError(f"the problem gives no value for {function}", hint=f"add (= {function} 1) to :init")
    return value


def first_broken(instruction: Instruction, state: State, problem: Problem) -> Broken | None:
    """The first part of the instruction's precondition that fails in ``state``; ``None`` if all hold.

    Raises:
        TmdError: As :func:`bind`.
    """
    binding = bind(problem, instruction)
    return first_false(schema_of(problem, instruction).precondition, state, problem, binding)


def first_false(
    formula: Formula, state: State, objects: Problem | Universe, binding: Binding | None = None
) -> Broken | None:
    """The first part of ``formula``, in reading order, that fails in ``state``; a literal if possible."""
    known = universe(objects) if isinstance(objects, Problem) else objects
    return _first_false(formula, state, known, binding or {}, True)


def _first_false(formula: Formula, state: State, objects: Universe, binding: Binding, wanted: bool) -> Broken | None:
    """The first part for which ``formula`` is not ``wanted``."""
    if isinstance(formula, Not):
        return _first_false(formula.part, state, objects, binding, not wanted)
    if isinstance(formula, And if wanted else Or):
        found = (_first_false(p, state, objects, binding, wanted) for p in formula.parts)
        return next((b for b in found if b), None)
    if isinstance(formula, Forall if wanted else Exists):
        inner = bindings(formula.parameters, objects, binding)
        return next((b for b in (_first_false(formula.part, state, objects, x, wanted) for x in inner) if b), None)
    if _holds(formula, state, objects, binding) == wanted:
        return None
    atom = instantiate(formula, binding) if isinstance(formula, Atom) else None
    text = format_formula(formula, binding)
    return Broken(text if wanted else f"(not {text})", atom, wanted)
