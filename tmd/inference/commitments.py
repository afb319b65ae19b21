"""Conditions that a plan must keep: what earlier steps reached, and what the request forbids."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise, product

from tmd.pddl.domain_traits import passing_predicates, transformations
from tmd.pddl.ground_formula import goal_cubes
from tmd.pddl.grounding.ground_task import ground_condition
from tmd.pddl.model import Formula, GroundAtom
from tmd.pddl.semantics import opposite
from tmd.pddl.task import Bits, Cube, Operator, Task, atoms_in
from tmd.readers.interface import PlanConstraints

# Maximum number of conjunctions of a goal and its commitments.
_MOST = 512


@dataclass(frozen=True, slots=True)
class Commitment:
    """A condition that later steps should not undo.

    Attributes:
        ways: The condition first, then what it may turn into by itself; one of them must hold.
        hard: Whether it must be kept at any price, because the request says so.
    """

    ways: tuple[Cube, ...]
    clause: int
    hard: bool = False


def commitments_of(cube: Cube, clause: int, task: Task) -> tuple[Commitment, ...]:
    """Return a commitment for each literal of a goal that was reached as ``cube``.

    Predicates that pass by themselves, such as ``near``, are not kept. Those that only turn into others of their kind,
    as contents do when they are cooked, are.
    """
    domain = task.problem.domain
    passing = passing_predicates(domain) - {predicate for _, predicate, _ in transformations(domain)}
    found = []
    for literal in cube.literals():
        (atom,) = task.names(literal.positive | literal.negative)
        if atom.predicate in passing:
            continue
        later = tuple(_later(atom, task)) if literal.positive else ()
        found.append(Commitment((literal, *later), clause))
    return tuple(found)


def _later(atom: GroundAtom, task: Task) -> Iterator[Cube]:
    """Yield the literals that an atom may turn into: raw food becomes cooked food."""
    for change, predicate, place in transformations(task.problem.domain):
        if predicate != atom.predicate:
            continue
        for fact in sorted(task.static):
            if fact.predicate == change and fact.args[0] == atom.args[place]:
                other = GroundAtom(predicate, (*atom.args[:place], fact.args[1], *atom.args[place + 1 :]))
                if other in task.index:
                    yield Cube(1 << task.index[other], 0)


def kept_throughout(formulas: Iterable[Formula], clause: int, task: Task) -> tuple[Commitment, ...]:
    """Return hard commitments to conditions that the request says to keep."""
    return tuple(Commitment(goal_cubes(task, formula), clause, hard=True) for formula in formulas)


def aims(
    cubes: Sequence[Cube], kept: Sequence[Commitment], released: Collection[str], task: Task
) -> Iterator[tuple[Cube, ...]]:
    """Yield what to plan for, in the order of trying: the goal with all commitments, then with ever fewer of them.

    Commitments about ``released`` objects lapse.
    """
    names = set(released)
    own = [k for k in kept if not (names & _objects(k, task)) or k.hard]
    yield combined(cubes, own)
    shared = _named(cubes, task)
    fewer = [k for k in own if k.hard or not (_objects(k, task) & shared)]
    if len(fewer) < len(own):
        yield combined(cubes, fewer)
    hard = [k for k in own if k.hard]
    if len(hard) < len(fewer):
        yield combined(cubes, hard)


def combined(cubes: Iterable[Cube], kept: Sequence[Commitment]) -> tuple[Cube, ...]:
    """Return the consistent conjunctions of a goal and commitments."""
    found: dict[Cube, None] = {}
    for cube in cubes:
        open_ = [k for k in kept if not _gives_way(k, cube)]
        for ways in product(*(k.ways for k in open_)):
            positive, negative = cube
            for way in ways:
                positive |= way.positive
                negative |= way.negative
            if not positive & negative:
                found[Cube(positive, negative)] = None
            if len(found) >= _MOST:
                return tuple(found)
    return tuple(found)


def _gives_way(kept: Commitment, cube: Cube) -> bool:
    """Return whether the goal itself contradicts a commitment. Later steps win."""
    if kept.hard:
        return False
    literal = kept.ways[0]
    return bool(literal.positive & cube.negative or literal.negative & cube.positive)


def _objects(kept: Commitment, task: Task) -> set[str]:
    return {a for atom in task.names(atoms_in(kept.ways[:1])) for a in atom.args}


def _named(cubes: Sequence[Cube], task: Task) -> set[str]:
    constants = {c.name for c in task.problem.domain.constants}
    return {a for atom in task.names(atoms_in(cubes)) for a in atom.args} - constants


def constrained(task: Task, constraints: PlanConstraints) -> Task:
    """Return the task without what the constraints forbid; ``task`` itself where they forbid nothing."""
    if not (constraints.never or constraints.untouched):
        return task
    forbidden = [cube for formula in constraints.never for cube in ground_condition(task, formula)]
    operators = []
    for operator in task.operators:
        if not constraints.untouched.intersection(operator.instruction.args):
            allowed = _without(operator, forbidden, task)
            if allowed is not None:
                operators.append(allowed)
    return replace(task, operators=tuple(operators), by_instruction={o.instruction: o for o in operators})


_ALWAYS = Cube(0, 0)


def _without(operator: Operator, forbidden: Iterable[Cube], task: Task) -> Operator | None:
    """Return an operator restricted to states in which it brings about none of the ``forbidden`` cubes.

    ``None`` where it always does. Each effect under a condition is looked at together with the unconditional ones, but
    not together with effects under other conditions: :func:`violated` checks whole plans.
    """
    states: dict[Cube, None] = {}
    for cube in forbidden:
        always = _brought_about(cube, operator.add, operator.delete)
        unconditional = [always] if always is not None else []
        for condition, add, delete in operator.conditional:
            further = _brought_about(cube, operator.add | add, operator.delete | delete)
            if further is None:
                # this effect undoes the cube: the unconditional ones bring it about only where its condition fails
                pairs = product(unconditional, opposite(condition))
                unconditional = [both for c, fails in pairs if (both := c.joined(fails)) is not None]
            elif (both := further.joined(condition)) is not None:
                states[both] = None
        states.update(dict.fromkeys(unconditional))
    if _ALWAYS in states:
        return None
    return replace(operator, forbidden=(*operator.forbidden, *states)) if states else operator


def _brought_about(cube: Cube, add: Bits, delete: Bits) -> Cube | None:
    """Return what must hold before an effect for it to complete ``cube``; ``None`` where it does not contribute."""
    lost = delete & ~add
    contributes = add & cube.positive or lost & cube.negative
    if not contributes or lost & cube.positive or add & cube.negative:
        return None
    return Cube(cube.positive & ~add, cube.negative & ~lost)


def violated(task: Task, constraints: PlanConstraints, states: Sequence[Bits]) -> Formula | None:
    """Return the first forbidden condition that a sequence of states brings about; ``None`` for none."""
    for formula in constraints.never:
        cubes = ground_condition(task, formula)
        holds = [any(cube.holds(state) for cube in cubes) for state in states]
        if any(after and not before for before, after in pairwise(holds)):
            return formula
    return None
