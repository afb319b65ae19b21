"""The meaning of PDDL: conditions, the effect of an instruction (Φ) and its inverse, and getConstraints."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import product
from math import prod
from typing import TypeAlias

from tmd.diagnostics import TmdError
from tmd.pddl.derived import strata
from tmd.pddl.model import (
    ActionSchema,
    And,
    Atom,
    Axiom,
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
    Universe,
    free_variables,
    parts_of,
    universe,
    walk,
)
from tmd.pddl.reading.syntax import nearest
from tmd.pddl.task import Bits, Cube, Operator, Task, single_bits
from tmd.pddl.writer import format_formula

Row: TypeAlias = tuple[str, ...]
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
    """Return the ground atom of ``atom`` under ``binding``."""
    return GroundAtom(atom.predicate, tuple([binding.get(t, t) for t in atom.terms]))


def bindings(parameters: tuple[TypedName, ...], objects: Universe, outer: Binding) -> Iterator[Binding]:
    """Yield ``outer`` extended by every choice of objects for ``parameters``."""
    names = [p.name for p in parameters]
    for choice in product(*(objects.of(p.types) for p in parameters)):
        yield {**outer, **dict(zip(names, choice, strict=True))}


def holds(formula: Formula, state: State, objects: Problem | Universe, binding: Binding | None = None) -> bool:
    """Return whether ``formula`` holds in ``state``; quantifiers range over ``objects``."""
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
            return not _some(parameters, signed_conjuncts(part, False), state, objects, binding)
        case Exists(parameters, part):
            return _some(parameters, signed_conjuncts(part, True), state, objects, binding)


def size(formula: Formula, objects: Universe) -> int:
    """Return the number of atoms and equations of ``formula`` when its quantifiers are spread out."""
    match formula:
        case Atom() | Equals():
            return 1
        case Forall(parameters, part) | Exists(parameters, part):
            return prod(len(objects.of(p.types)) for p in parameters) * max(1, size(part, objects))
        case _:
            return sum(size(part, objects) for part in parts_of(formula))


def schema_of(problem: Problem, instruction: Instruction) -> ActionSchema:
    """Return the action that ``instruction`` names.

    Raises:
        TmdError: There is no such action.
    """
    for action in problem.domain.actions:
        if action.name == instruction.name:
            return action
    names = [a.name for a in problem.domain.actions]
    raise TmdError(f'unknown action "{instruction.name}"', hint=nearest(instruction.name, names, what="actions"))


def bind(problem: Problem, instruction: Instruction) -> dict[str, str]:
    """Return the object of each parameter of the instruction's action.

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
    """Return whether the instruction's precondition holds in ``state``.

    Raises:
        TmdError: As :func:`bind`.
    """
    binding = bind(problem, instruction)
    return _holds(schema_of(problem, instruction).precondition, state, universe(problem), binding)


def apply(instruction: Instruction, state: State, problem: Problem) -> State:
    """Return Φ, the state after ``instruction``. Its precondition is not read, so execution can be forced.

    Raises:
        TmdError: As :func:`bind`.
    """
    outer = bind(problem, instruction)
    objects = universe(problem)
    added: set[GroundAtom] = set()
    deleted: set[GroundAtom] = set()
    for effect in schema_of(problem, instruction).effects:
        for binding in solutions(effect.parameters, effect.condition, state, objects, outer):
            (added if effect.positive else deleted).add(instantiate(effect.atom, binding))
    return close((state - deleted) | added, problem)


def close(state: State, problem: Problem) -> State:
    """Return ``state`` with exactly the derived atoms that follow from it."""
    axioms = problem.domain.derived
    if not axioms:
        return state
    objects = universe(problem)
    names = {axiom.head.predicate for axiom in axioms}
    found = frozenset(atom for atom in state if atom.predicate not in names)
    for stratum in strata(axioms) or ():
        rules = _rules(stratum)
        heads = frozenset(axiom.head.predicate for axiom in stratum)
        new = frozenset(atom for rule in rules for atom in _following(rule, found, objects, {})) - found
        while new:
            found |= new
            new = frozenset(
                atom
                for rule in rules
                for start in _starts(rule, heads, new, objects)
                for atom in _following(rule, found, objects, start)
            ).difference(found)
    return found


@lru_cache(maxsize=64)
def _rules(axioms: tuple[Axiom, ...]) -> tuple[Axiom, ...]:
    """Return axioms with a rule for each case of a disjunction, and without ``exists`` around the condition."""
    found: list[Axiom] = []
    waiting = list(reversed(axioms))
    while waiting:
        axiom = waiting.pop()
        names = {p.name for p in axiom.parameters}
        match axiom.condition:
            case Or(parts):
                waiting += [replace(axiom, condition=part) for part in reversed(parts)]
            case Exists(parameters, part) if names.isdisjoint(p.name for p in parameters):
                waiting.append(replace(axiom, parameters=(*axiom.parameters, *parameters), condition=part))
            case _:
                found.append(axiom)
    return tuple(found)


def _following(rule: Axiom, state: State, objects: Universe, start: Binding) -> Iterator[GroundAtom]:
    """Yield the atoms that follow from a state by a rule of which ``start`` binds some parameters."""
    unbound = tuple(p for p in rule.parameters if p.name not in start)
    for binding in solutions(unbound, rule.condition, state, objects, start):
        yield instantiate(rule.head, binding)


def _starts(rule: Axiom, heads: Collection[str], new: State, objects: Universe) -> Iterator[Binding]:
    """Yield bindings under which new atoms are conditions of a rule: only these can derive more atoms."""
    parts = [formula for formula, _, _ in signed_conjuncts(rule.condition, True)]
    deep = (inner for part in parts if not isinstance(part, Atom) for inner in walk(part))
    if any(isinstance(inner, Atom) and inner.predicate in heads for inner in deep):
        yield {}  # which atoms count is not known
        return
    types = {p.name: p.types for p in rule.parameters}
    for part in parts:
        if isinstance(part, Atom) and part.predicate in heads:
            for atom in new:
                found = unified(part, atom.args, {}) if atom.predicate == part.predicate else None
                if found is not None and all(objects.is_a(found[name], types[name]) for name in found):
                    yield found


_Part: TypeAlias = tuple[Formula, bool, frozenset[str]]
"""A condition, whether it holds, and its free variables."""
_Signed: TypeAlias = tuple[_Part, ...]
"""Conditions that hold or do not hold together."""


@lru_cache(maxsize=4096)
def signed_conjuncts(formula: Formula, wanted: bool) -> _Signed:
    """Return the conjuncts of ``formula``, or of its negation where it is not ``wanted``."""
    match formula:
        case Not(part):
            return signed_conjuncts(part, not wanted)
        case And(parts) if wanted:
            return tuple(inner for part in parts for inner in signed_conjuncts(part, True))
        case Or(parts) if not wanted:
            return tuple(inner for part in parts for inner in signed_conjuncts(part, False))
        case Imply(left, right) if not wanted:
            return signed_conjuncts(left, True) + signed_conjuncts(right, False)
    return ((formula, wanted, free_variables(formula)),)


def _alternatives(formula: Formula, wanted: bool) -> list[_Signed]:
    """Return the cases of a disjunction; none for any other formula."""
    match formula:
        case Or(parts) | And(parts) if isinstance(formula, Or) == wanted:
            return [signed_conjuncts(part, wanted) for part in parts]
        case Imply(left, right) if wanted:
            return [signed_conjuncts(left, False), signed_conjuncts(right, True)]
    return []


class JoinRelation:
    """The known atoms of one predicate, with an index for each set of argument places asked for."""

    def __init__(self, rows: dict[Row, None] | None = None) -> None:
        self.rows: dict[Row, None] = {} if rows is None else rows
        self._indexes: dict[tuple[int, ...], dict[Row, list[Row]]] = {}

    def add(self, row: Row) -> None:
        """Make ``row`` known; it must not be already."""
        self.rows[row] = None
        for places, index in self._indexes.items():
            index.setdefault(tuple(row[p] for p in places), []).append(row)

    def matching(self, places: tuple[int, ...], key: Row) -> Collection[Row]:
        """Return the rows that hold ``key`` at ``places``, in the order in which they were added."""
        if not places:
            return self.rows
        index = self._indexes.get(places)
        if index is None:
            index = self._indexes[places] = {}
            for row in self.rows:
                index.setdefault(tuple(row[p] for p in places), []).append(row)
        return index.get(key, ())


@lru_cache(maxsize=8)
def _relations(state: State) -> Mapping[str, JoinRelation]:
    found: defaultdict[str, dict[Row, None]] = defaultdict(dict)
    for predicate, args in state:
        found[predicate][args] = None
    return {predicate: JoinRelation(rows) for predicate, rows in found.items()}


def _matching(atom: Atom, state: State, binding: Binding) -> Collection[Row]:
    """Return the arguments of the atoms of ``state`` that agree with what is bound in ``atom``."""
    relation = _relations(state).get(atom.predicate)
    values = [binding.get(term, term) for term in atom.terms]
    places = tuple(place for place, value in enumerate(values) if not value.startswith("?"))
    return relation.matching(places, tuple(values[place] for place in places)) if relation else ()


def _some(parameters: Sequence[TypedName], parts: _Signed, state: State, objects: Universe, binding: Binding) -> bool:
    """Return whether some choice of objects for ``parameters`` makes all ``parts`` true.

    Parts without a common parameter are looked at one after another.
    """
    binding = _without(binding, parameters)
    names = {p.name for p in parameters}
    if not _agree([part for part in parts if part[2].isdisjoint(names)], state, objects, binding):
        return False
    groups = _groups(parameters, [part for part in parts if not part[2].isdisjoint(names)])
    return all(_some_of_group(own, group, state, objects, binding) for own, group in groups)


def _without(binding: Binding, parameters: Sequence[TypedName]) -> Binding:
    """Return ``binding`` without what it says of ``parameters``, which a quantifier binds again."""
    hidden = {p.name for p in parameters if p.name in binding}
    return {name: value for name, value in binding.items() if name not in hidden} if hidden else binding


def _agree(parts: Iterable[_Part], state: State, objects: Universe, binding: Binding) -> bool:
    return all(_holds(formula, state, objects, binding) == wanted for formula, wanted, _ in parts)


def _some_of_group(
    parameters: Sequence[TypedName], parts: _Signed, state: State, objects: Universe, binding: Binding
) -> bool:
    """Return whether there is a solution of parts that share parameters: case by case, or value by value."""
    cases = _alternatives(*parts[0][:2]) if len(parts) == 1 else []
    if cases:
        return any(_some(parameters, case, state, objects, binding) for case in cases)
    return any(
        _some(tuple(p for p in parameters if p.name not in more), parts, state, objects, more)
        for more in _extended(parameters, parts, state, objects, binding)
    )


def _groups(parameters: Sequence[TypedName], parts: Sequence[_Part]) -> list[tuple[list[TypedName], _Signed]]:
    """Divide parameters, with their parts, into those that no part connects."""
    groups: list[tuple[list[TypedName], _Signed]] = [([p], ()) for p in parameters]
    for part in parts:
        joined = [group for group in groups if any(p.name in part[2] for p in group[0])]
        groups = [group for group in groups if group not in joined]
        own = [p for group in joined for p in group[0]]
        groups.append((own, (*(inner for group in joined for inner in group[1]), part)))
    return groups


def _equated(parts: _Signed, unbound: Collection[str]) -> Iterator[tuple[str, str]]:
    """Yield the variables that an equation of ``parts`` binds, each with what it equals."""
    for part, wanted, _ in parts:
        if wanted and isinstance(part, Equals):
            sides = (part.left, part.right), (part.right, part.left)
            yield from ((term, other) for term, other in sides if term in unbound and other not in unbound)


def _extended(
    parameters: Sequence[TypedName], parts: _Signed, state: State, objects: Universe, binding: Binding
) -> Iterator[Binding]:
    """Yield ``binding`` with more parameters bound: those of the atom that the fewest atoms of the state match.

    An equation with one side bound comes first. Without such a part it is the first parameter, with each object of its
    types.
    """
    types = {p.name: p.types for p in parameters}
    for term, other in _equated(parts, types):
        value = binding.get(other, other)
        if objects.is_a(value, types[term]):
            yield {**binding, term: value}
        return
    atoms = [f for f, wanted, names in parts if wanted and isinstance(f, Atom) and not names.isdisjoint(types)]
    if not atoms:
        yield from bindings((parameters[0],), objects, binding)
        return
    rows, atom = min(((_matching(atom, state, binding), atom) for atom in atoms), key=lambda pair: len(pair[0]))
    for row in rows:
        more = unified(atom, row, binding)
        if more and all(objects.is_a(more[term], types[term]) for term in atom.terms if term in types):
            yield more


def unified(atom: Atom, row: Row, binding: Binding) -> Binding | None:
    """Return ``binding`` extended so that ``atom`` has the arguments ``row``; ``None`` where that contradicts it."""
    found = dict(binding)
    for term, value in zip(atom.terms, row, strict=True):
        if (found.setdefault(term, value) if term.startswith("?") else term) != value:
            return None
    return found


def solutions(
    parameters: Sequence[TypedName], condition: Formula, state: State, objects: Universe, outer: Binding
) -> list[Binding]:
    """Return ``outer`` extended by each choice of objects for ``parameters`` for which ``condition`` holds.

    Its atoms are joined, so the number of combinations counts only where they do not restrict it.
    """
    found: list[Binding] = []
    waiting = [(tuple(parameters), signed_conjuncts(condition, True), _without(outer, parameters))]
    while waiting:
        unbound, parts, binding = waiting.pop()
        names = {p.name for p in unbound}
        if not _agree([part for part in parts if part[2].isdisjoint(names)], state, objects, binding):
            continue
        if not unbound:
            found.append(binding)
            continue
        rest = tuple(part for part in parts if not part[2].isdisjoint(names))
        for more in _extended(unbound, rest, state, objects, binding):
            waiting.append((tuple(p for p in unbound if p.name not in more), rest, more))
    return found


def cost(instruction: Instruction, problem: Problem) -> int:
    """Return the cost of ``instruction``: 1 each, unless the problem minimises total-cost.

    Where it does, an action without a cost is free, as in other planners.

    Raises:
        TmdError: As :func:`bind`, or the problem gives no value for the cost.
    """
    return action_cost(problem, schema_of(problem, instruction), bind(problem, instruction))


def action_cost(problem: Problem, action: ActionSchema, binding: Binding) -> int:
    """Return the cost of ``action`` under ``binding``; see :func:`cost`."""
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
    """Return the first part of the instruction's precondition that fails in ``state``; ``None`` if all hold.

    Raises:
        TmdError: As :func:`bind`.
    """
    binding = bind(problem, instruction)
    return first_false(schema_of(problem, instruction).precondition, state, problem, binding)


def first_false(
    formula: Formula, state: State, objects: Problem | Universe, binding: Binding | None = None
) -> Broken | None:
    """Return the first part of ``formula``, in reading order, that fails in ``state``; a literal if possible."""
    known = universe(objects) if isinstance(objects, Problem) else objects
    return _first_false(formula, state, known, binding or {}, True)


def _first_false(formula: Formula, state: State, objects: Universe, binding: Binding, wanted: bool) -> Broken | None:
    """Return the first part for which ``formula`` is not ``wanted``."""
    if isinstance(formula, Not):
        return _first_false(formula.part, state, objects, binding, not wanted)
    if isinstance(formula, And if wanted else Or):
        found = (_first_false(p, state, objects, binding, wanted) for p in formula.parts)
        return next((b for b in found if b), None)
    if isinstance(formula, Forall if wanted else Exists):
        inner = _first_solution(formula.parameters, signed_conjuncts(formula.part, not wanted), state, objects, binding)
        return _first_false(formula.part, state, objects, inner, wanted) if inner is not None else None
    if _holds(formula, state, objects, binding) == wanted:
        return None
    atom = instantiate(formula, binding) if isinstance(formula, Atom) else None
    text = format_formula(formula, binding)
    return Broken(text if wanted else f"(not {text})", atom, wanted)


def _first_solution(
    parameters: Sequence[TypedName], parts: _Signed, state: State, objects: Universe, binding: Binding
) -> Binding | None:
    """Return the first choice of objects, in the order of their declaration, that makes all ``parts`` true."""
    if not _some(parameters, parts, state, objects, binding):
        return None
    found = dict(binding)
    for number, parameter in enumerate(parameters, start=1):
        values = ({**found, parameter.name: name} for name in objects.of(parameter.types))
        found = next(more for more in values if _some(parameters[number:], parts, state, objects, more))
    return found


def regress(cube: Cube, operator: Operator) -> tuple[Cube, ...]:
    """Return the weakest precondition of ``cube`` under ``operator``, exactly, the operator's own included.

    ``operator`` applies in a state and leads to one that satisfies ``cube`` if and only if one of the
    returned cubes holds in that state. No returned cube contradicts itself or is implied by another. They
    are sorted.
    """
    positive, negative = cube
    if positive & negative or negative & operator.add:
        return ()
    clauses: list[Sequence[Cube]] = [opposite(f) for f in operator.forbidden]
    wanted = positive & ~operator.add
    unwanted = negative & ~operator.delete
    may_add = may_delete = 0
    for condition, add, delete in operator.conditional:
        may_add |= add
        may_delete |= delete & ~add
        if add & negative:
            clauses.append(opposite(condition))
    for bit in single_bits(wanted & (may_add | may_delete | operator.delete)):
        wanted &= ~bit
        clauses.append(_made_true(bit, operator))
    for bit in single_bits(unwanted & may_delete):
        unwanted &= ~bit
        made_false = [c for c, _, delete in operator.conditional if delete & bit]
        clauses.append([*made_false, Cube(0, bit)])
    needs = operator.precondition
    return _conjoin(Cube(needs.positive | wanted, needs.negative | unwanted), clauses)


def _made_true(bit: Bits, operator: Operator) -> Sequence[Cube]:
    """Return the ways in which the atom ``bit``, which is not added in any case, holds afterwards."""
    ways = [condition for condition, add, _ in operator.conditional if add & bit]
    if not operator.delete & bit:
        threats = [opposite(c) for c, add, delete in operator.conditional if delete & bit and not add & bit]
        ways.extend(_conjoin(Cube(bit, 0), threats))
    return ways


@lru_cache(maxsize=65536)
def opposite(cube: Cube) -> tuple[Cube, ...]:
    """Return the negation of ``cube``, as a disjunction of single literals."""
    return tuple(Cube(literal.negative, literal.positive) for literal in cube.literals())


def _conjoin(start: Cube, clauses: Iterable[Sequence[Cube]]) -> tuple[Cube, ...]:
    """Return the conjunction of ``start`` and of ``clauses`` (disjunctions), as a minimal disjunction of cubes."""
    if start.positive & start.negative:
        return ()
    found = [start]
    for clause in sorted(clauses, key=len):
        grown: set[Cube] = set()
        for positive, negative in found:
            if any(p & ~positive == 0 and n & ~negative == 0 for p, n in clause):
                grown.add(Cube(positive, negative))
                continue
            for more_positive, more_negative in clause:
                both = Cube(positive | more_positive, negative | more_negative)
                if not both.positive & both.negative:
                    grown.add(both)
        found = minimal(grown) if len(grown) > 1 else list(grown)
        if not found:
            return ()
    return tuple(sorted(found))


def minimal(cubes: Iterable[Cube]) -> list[Cube]:
    """Return ``cubes`` without those that another one of them implies, the shortest first."""
    kept: list[Cube] = []
    for cube in sorted(cubes, key=_size):
        if not any(k.positive & ~cube.positive == 0 and k.negative & ~cube.negative == 0 for k in kept):
            kept.append(cube)
    return kept


MOST_CUBES = 64
"""Conditional effects can make the constraints a long disjunction; the smallest cubes are kept. What is lost
are only roundabout ways to make the sequence executable; every cube kept is exact."""


def get_constraints(operators: Sequence[Operator]) -> list[tuple[Cube, ...]]:
    """Return for each t the constraints of ``operators[t:]``, as a disjunction of cubes; the last one is "true".

    A sequence begun in a state that satisfies one of the cubes can be executed to its end. An empty
    disjunction means that it never can.
    """
    found: list[tuple[Cube, ...]] = [(Cube(),)]
    for operator in reversed(operators):
        cubes: set[Cube] = set()
        for cube in found[-1]:
            cubes.update(regress(cube, operator))
        found.append(tuple(sorted(cubes, key=_size)[:MOST_CUBES]))
    found.reverse()
    return found


class Constraints:
    """The constraints of instruction sequences in one task, remembered."""

    def __init__(self, task: Task) -> None:
        self._task = task
        self._known: dict[tuple[Instruction, ...], tuple[Cube, ...]] = {}

    def of(self, instructions: tuple[Instruction, ...]) -> tuple[Cube, ...]:
        """Return the constraints of a sequence; those of its tails are kept as well, since tails are asked for next."""
        if instructions not in self._known:
            operators = [self._task.by_instruction[i] for i in instructions]
            for t, cubes in enumerate(get_constraints(operators)):
                self._known[instructions[t:]] = cubes
        return self._known[instructions]


def _size(cube: Cube) -> tuple[int, int, int]:
    return (cube.positive.bit_count() + cube.negative.bit_count(), cube.positive, cube.negative)
