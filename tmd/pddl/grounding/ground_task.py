"""Grounding of a problem: every operator that may ever apply, as bit sets.

In three steps. Actions are instantiated while relaxed reachability collects the atoms that may hold
(:mod:`tmd.pddl.grounding.instantiate`). Then what can never apply and what never changes is removed. At last the
remaining atoms are numbered.
"""

from __future__ import annotations

import gc
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace

from tmd.pddl.derived import unfolded, unfolded_condition
from tmd.pddl.grounding.ground_action import (
    FALSE,
    TRUE,
    Conditional,
    GroundAction,
    Literals,
    Tree,
    Work,
    expand,
    grouped,
    normal_form,
)
from tmd.pddl.grounding.instantiate import Instances, instantiate_actions
from tmd.pddl.model import Formula, GroundAtom, Instruction, Problem, State, universe
from tmd.pddl.semantics import Binding, bind, size
from tmd.pddl.task import Bits, ConditionalEffect, Cube, Operator, Task

# A forbidden cube that holds in every state.
_NEVER = Cube(0, 0)


def ground(problem: Problem, initial_states: Sequence[State] = (), forced: Sequence[Instruction] = ()) -> Task:
    """Return the ground task of ``problem``.

    The task is exact for every state that its operators reach from the problem's initial state, from any of
    ``initial_states``, and by the ``forced`` instructions, which may be executed although their precondition does not
    hold. Forced instructions are among the operators even where they can never apply.

    Raises:
        TmdError: A forced instruction is not one of the problem, a cost has no value, a predicate is derived from
            itself, or grounding exceeds its limits.
    """
    for instruction in forced:
        bind(problem, instruction)
    problem = unfolded(problem)
    with _collector_paused():
        instances = instantiate_actions(problem, (problem.init, *initial_states), frozenset(forced))
        return _number(problem, instances)


@contextmanager
def _collector_paused() -> Iterator[None]:
    """Pause the garbage collector: instantiation makes many small objects and no cycles, which it would look for."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


def ground_condition(task: Task, formula: Formula, binding: Binding | None = None) -> tuple[Cube, ...]:
    """Compile a formula to cubes over the task's atoms; empty where no state satisfies it.

    Atoms that are neither fluent nor static in ``task`` count as false.

    Raises:
        TmdError: The formula has too many cases.
    """
    cubes = normal_form(expand_condition(task, formula, binding), "or", "this formula")
    return tuple(sorted(_cube(literals) for literals in cubes))


def expand_condition(task: Task, formula: Formula, binding: Binding | None = None) -> Tree:
    """Write a formula over the task's atoms; literal ``2 * n`` is atom ``n``, and ``2 * n + 1`` its negation.

    Raises:
        LimitError: The formula is too large.
    """

    def lookup(atom: GroundAtom) -> Tree:
        number = task.index.get(atom)
        if number is not None:
            return 2 * number
        return TRUE if atom in task.static else FALSE

    formula = unfolded_condition(formula, task.problem.domain)
    objects = universe(task.problem)
    Work().spend(size(formula, objects), "a condition")
    return expand(formula, binding or {}, objects, lookup)


def _number(problem: Problem, instances: Instances) -> Task:
    """Return the task over the fluent atoms, which are numbered in sorted order."""
    actions, known = _prune(instances)
    names = instances.atoms
    fluent = sorted(known.fluent, key=lambda number: names[number])
    bit = {number: place for place, number in enumerate(fluent)}
    atoms = tuple(names[number] for number in fluent)
    operators = tuple(sorted((_operator(a, bit) for a in actions), key=lambda o: o.instruction))
    static = frozenset(names[number] for number in known.always) | instances.static
    index = {atom: place for place, atom in enumerate(atoms)}
    draft = Task(problem, atoms, static, 0, (), operators, index, {o.instruction: o for o in operators})
    return replace(draft, init=draft.encode(problem.init), goal=ground_condition(draft, problem.goal))


def _cube(literals: Iterable[int]) -> Cube:
    own = set(literals)
    return Cube(sum(1 << (lit >> 1) for lit in own if not lit & 1), sum(1 << (lit >> 1) for lit in own if lit & 1))


def _operator(action: GroundAction, bit: dict[int, int]) -> Operator:
    """Encode an action: single-literal clauses are the precondition, others become forbidden cubes."""
    units = [_renumber(c, bit) for c in action.clauses if len(c) == 1]
    wider = [_renumber(c, bit) for c in action.clauses if len(c) != 1]
    forbidden = [_cube(literal ^ 1 for literal in clause) for clause in wider]
    precondition = _cube(literal for unit in units for literal in unit)
    if precondition.positive & precondition.negative:
        precondition, forbidden = Cube(), [_NEVER]
    nothing = Conditional(frozenset(), frozenset(), frozenset())
    always = next((e for e in action.effects if not e.condition), nothing)
    conditional = [
        ConditionalEffect(_cube(_renumber(condition, bit)), _bits(add, bit), _bits(delete, bit))
        for condition, add, delete in action.effects
        if condition
    ]
    return Operator(
        action.instruction,
        precondition,
        _bits(always.add, bit),
        _bits(always.delete, bit),
        tuple(sorted(conditional)),
        tuple(sorted(forbidden)),
        action.cost,
    )


def _renumber(literals: Literals, bit: dict[int, int]) -> list[int]:
    return [2 * bit[literal >> 1] + (literal & 1) for literal in literals]


def _bits(atoms: frozenset[int], bit: dict[int, int]) -> Bits:
    return sum(1 << bit[atom] for atom in atoms)


def _prune(instances: Instances) -> tuple[tuple[GroundAction, ...], _Known]:
    """Drop actions, effects and conditions that can play no part; return the other actions, and what is known."""
    reachability = instances.reachability
    atoms = [literal >> 1 for literal in reachability.reached if not literal & 1]
    fluent = frozenset(atom for atom in atoms if reachability.holds(2 * atom + 1))
    known = _Known(fluent, frozenset(atoms) - fluent)
    left = tuple(
        known.action(action, [e for k, e in enumerate(action.effects) if (number, k) in reachability.fired])
        for number, action in enumerate(instances.actions)
        if (number, -1) in reachability.fired
    )
    return left, known


@dataclass(frozen=True, slots=True)
class _Known:
    """Atoms that are neither ``fluent`` nor ``always`` true are always false."""

    fluent: frozenset[int]
    always: frozenset[int]

    def truth(self, literal: int) -> bool | None:
        """Return the value of ``literal``; ``None`` where it changes."""
        if literal >> 1 in self.fluent:
            return None
        return (literal >> 1 in self.always) != bool(literal & 1)

    def open(self, literals: Literals) -> Literals:
        if all(literal >> 1 in self.fluent for literal in literals):
            return literals
        return frozenset(literal for literal in literals if literal >> 1 in self.fluent)

    def action(self, action: GroundAction, effects: Sequence[Conditional]) -> GroundAction:
        clauses = (c for c in action.clauses if not any(self.truth(literal) for literal in c))
        kept: list[Conditional] = []
        shortened = False
        for condition, add, delete in effects:
            add, delete = add & self.fluent, delete & self.fluent
            if (add or delete) and not any(self.truth(literal) is False for literal in condition):
                kept.append(Conditional(self.open(condition), add, delete))
                shortened |= len(kept[-1].condition) < len(condition)
        left = tuple(dict.fromkeys(self.open(c) for c in clauses))
        found = GroundAction(action.instruction, left, tuple(kept), action.cost, action.forced)
        # Shorter conditions may coincide or be empty; then adding wins again.
        return replace(found, effects=grouped(found.flat())) if shortened else found
