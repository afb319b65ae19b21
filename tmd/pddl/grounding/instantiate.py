"""Instantiating actions while relaxed reachability collects the atoms that may ever hold.

The positive atoms of a precondition are joined against what is reached so far, the new atoms of each round
first (semi-naive evaluation), so no binding is tried that could not apply.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

from tmd.diagnostics import LimitError, TmdError
from tmd.pddl.grounding.ground_action import (
    FALSE,
    TRUE,
    GroundAction,
    GroundEffect,
    Literals,
    Reachability,
    Tree,
    Work,
    absorb,
    expand,
    grouped,
    normal_form,
)
from tmd.pddl.model import (
    ActionSchema,
    And,
    Atom,
    Effect,
    Formula,
    GroundAtom,
    Instruction,
    Problem,
    State,
    Universe,
    conjuncts,
    free_variables,
    predicates_of,
    signed_atoms,
    universe,
)
from tmd.pddl.semantics import Binding, JoinRelation, Row, action_cost, holds, instantiate, size, unified

Variables: TypeAlias = Mapping[str, Sequence[str]]
"""The objects that each variable may stand for."""

_MOST_ROWS = 500_000
# Objects that checks of static conditions look at: some 30 s.
_MOST_CHECKED = 2_000_000
# The size a relation is taken to have that is still to grow.
_UNKNOWN = 1_000_000


@dataclass(frozen=True, slots=True)
class _Match:
    """Extend a row by the rows of a relation that match it."""

    relation: JoinRelation
    places: tuple[int, ...]
    key: tuple[int | str, ...]
    new: tuple[int, ...]
    same: tuple[tuple[int, int], ...]
    allowed: tuple[frozenset[str], ...]

    def run(self, rows: list[Row]) -> list[Row]:
        out: list[Row] = []
        # many rows have one key: a thousand things stand in one place
        known: dict[Row, list[Row]] = {}
        for row in rows:
            key = tuple(row[k] if isinstance(k, int) else k for k in self.key)
            if key not in known:
                known[key] = list(self._values(key))
            out += [row + values for values in known[key]]
            if len(out) > _MOST_ROWS:
                raise _too_many_rows()
        return out

    def _values(self, key: Row) -> Iterator[Row]:
        """Yield the values of the new variables in the rows of the relation that match a key."""
        for found in self.relation.matching(self.places, key):
            if any(found[a] != found[b] for a, b in self.same):
                continue
            values = tuple(found[p] for p in self.new)
            if all(v in a for v, a in zip(values, self.allowed, strict=True)):
                yield values


@dataclass(frozen=True, slots=True)
class _Enumerate:
    """Extend a row by each object of a variable's types."""

    objects: Sequence[str]

    def run(self, rows: list[Row]) -> list[Row]:
        if len(rows) * len(self.objects) > _MOST_ROWS:
            raise _too_many_rows()
        return [(*row, o) for row in rows for o in self.objects]


def _too_many_rows() -> LimitError:
    return LimitError(
        f"grounding needs more than {_MOST_ROWS:,} combinations of objects",
        hint="use types or static preconditions to narrow the parameters",
    )


class _Counted(Universe):
    """The objects of a problem, for checks that look at :data:`_MOST_CHECKED` of them at most.

    Raises:
        LimitError: (From the methods.) They look at more.
    """

    def __init__(self, objects: Universe) -> None:
        vars(self).update(vars(objects))
        self._left = _MOST_CHECKED

    def is_a(self, name: str, types: Sequence[str]) -> bool:
        """Return as the universe does."""
        self._look(1)
        return super().is_a(name, types)

    def of(self, types: tuple[str, ...]) -> tuple[str, ...]:
        """Return as the universe does; all of them count."""
        found = super().of(types)
        self._look(len(found))
        return found

    def _look(self, count: int) -> None:
        self._left -= count
        if self._left < 0:
            raise LimitError(
                f"a condition with quantifiers needs more than {_MOST_CHECKED:,} objects to be looked at",
                hint="use types to narrow what its variables range over",
            )


@dataclass(frozen=True, slots=True)
class _Filter:
    """Drop the rows in which a condition on what never changes does not hold."""

    condition: Formula
    slots: tuple[tuple[str, int], ...]
    static: State
    objects: Universe

    def run(self, rows: list[Row]) -> list[Row]:
        found = []
        for row in rows:
            binding = {name: row[slot] for name, slot in self.slots}
            if holds(self.condition, self.static, self.objects, binding):
                found.append(row)
        return found


@dataclass(slots=True)
class Join:
    """The steps that bind variables such that conditions hold; ``order`` names the columns of the result."""

    order: list[str] = field(default_factory=list)
    steps: list[_Match | _Enumerate | _Filter] = field(default_factory=list)

    def run(self, start: Iterable[Row]) -> list[Row]:
        """Return all bindings that extend the rows of ``start`` (values of the given variables)."""
        rows = list(start)
        for step in self.steps:
            if not rows:
                break
            rows = step.run(rows)
        return rows


@dataclass(frozen=True, slots=True)
class Instances:
    """All actions that may apply, over the numbered ``atoms``, and what they reach.

    ``static`` are the atoms of predicates that no action changes.
    """

    atoms: Sequence[GroundAtom]
    static: State
    actions: Sequence[GroundAction]
    reachability: Reachability


def instantiate_actions(problem: Problem, initial_states: Sequence[State], forced: frozenset[Instruction]) -> Instances:
    """Return every instance that relaxed reachability from the union of ``initial_states`` admits."""
    return _Instantiation(problem, initial_states, forced).run()


@dataclass(frozen=True, slots=True)
class _EffectPlan:
    """A lifted effect, with the join that finds the values of its own parameters.

    ``literals`` is what ``rest`` is a conjunction of, where it is so simple.
    """

    effect: Effect
    join: Join | None
    rest: Formula
    literals: tuple[tuple[Atom, int], ...] | None


@dataclass(frozen=True, slots=True)
class _ActionPlan:
    """A lifted action: its joins (one for each positive fluent atom that may come last) and the rest."""

    action: ActionSchema
    fluent: tuple[Atom, ...]
    rest: Formula
    first: Join
    joins: tuple[Join, ...]
    effects: tuple[_EffectPlan, ...]
    size: int
    """What an instance writes down: its arguments, the atoms of its precondition that may change, its effects."""


class _Instantiation:
    """The state of one run."""

    def __init__(self, problem: Problem, initial_states: Sequence[State], forced: frozenset[Instruction]) -> None:
        self.problem = problem
        self.objects: Universe = universe(problem)
        self.checked = _Counted(self.objects)
        self.forced = forced
        self.work = Work()
        self.numbers: dict[GroundAtom, int] = {}
        self.atoms: list[GroundAtom] = []
        self.actions: dict[Instruction, GroundAction] = {}
        self.refused: set[Instruction] = set()
        somewhere = frozenset[GroundAtom]().union(*initial_states)
        everywhere = frozenset(problem.init).intersection(*initial_states)
        changing = {e.atom.predicate for a in problem.domain.actions for e in a.effects}
        changing |= {atom.predicate for atom in somewhere - everywhere}
        self.changing = frozenset(changing)
        self.static: State = frozenset(a for a in everywhere if a.predicate not in changing)
        self.relations = {p.name: JoinRelation() for p in problem.domain.predicates}
        for atom in sorted(self.static):
            self.relations[atom.predicate].add(atom.args)
        fluent = sorted(a for a in somewhere if a.predicate in changing)
        start = [2 * self.number(a) for a in fluent]
        always = frozenset(self.number(a) for a in fluent if a in everywhere)
        self.reachability = Reachability(start, lambda atom: atom not in always)
        self.plans = [self.plan(action) for action in problem.domain.actions]

    def number(self, atom: GroundAtom) -> int:
        found = self.numbers.get(atom)
        if found is None:
            found = self.numbers[atom] = len(self.atoms)
            self.atoms.append(atom)
        return found

    def lookup(self, atom: GroundAtom) -> Tree:
        """Return the value of an atom of a static predicate, and the literal of any other."""
        if atom.predicate in self.changing:
            return 2 * self.number(atom)
        return TRUE if atom in self.static else FALSE

    def run(self) -> Instances:
        for plan in self.plans:
            if not plan.fluent:
                self.instantiate(plan, plan.first.order, plan.first.run([()]))
        for instruction in sorted(self.forced):
            plan = next(p for p in self.plans if p.action.name == instruction.name)
            self.instantiate(plan, [p.name for p in plan.action.parameters], [instruction.args])
        while new := self.reachability.run():
            self.extend(new)
        return Instances(self.atoms, self.static, tuple(self.actions.values()), self.reachability)

    def extend(self, new: Iterable[int]) -> None:
        """Instantiate what the literals ``new`` make possible; negated ones wait in the rules themselves."""
        rows: dict[str, list[Row]] = {}
        for literal in new:
            if literal & 1:
                continue
            atom = self.atoms[literal >> 1]
            self.relations[atom.predicate].add(atom.args)
            rows.setdefault(atom.predicate, []).append(atom.args)
        for plan in self.plans:
            for atom_plan, join in zip(plan.fluent, plan.joins, strict=True):
                start = self.unify(plan, atom_plan, rows.get(atom_plan.predicate, ()))
                if start:
                    self.instantiate(plan, join.order, join.run(start))

    def unify(self, plan: _ActionPlan, atom: Atom, rows: Iterable[Row]) -> list[Row]:
        """Return the values that matching ``atom`` with each of ``rows`` gives to its variables."""
        types = {p.name: p.types for p in plan.action.parameters}
        found = (unified(atom, row, {}) for row in rows)
        return [
            tuple(values.values())
            for values in found
            if values is not None and all(self.objects.is_a(v, types[t]) for t, v in values.items() if t in types)
        ]

    def is_static(self, formula: Formula) -> bool:
        return not predicates_of(formula) & self.changing

    def plan(self, action: ActionSchema) -> _ActionPlan:
        parts = conjuncts(action.precondition)
        fluent = tuple(dict.fromkeys(p for p in parts if isinstance(p, Atom) and not self.is_static(p)))
        rest = And(tuple(p for p in parts if not self.is_static(p) and p not in fluent))
        variables = {p.name: self.objects.of(p.types) for p in action.parameters}
        static = [p for p in parts if self.is_static(p)]
        joins = []
        for atom in fluent:
            given = tuple(dict.fromkeys(t for t in atom.terms if t.startswith("?")))
            joins.append(self.join(variables, [*static, *(a for a in fluent if a != atom)], given))
        return _ActionPlan(
            action,
            fluent,
            rest,
            self.join(variables, static, ()),
            tuple(joins),
            tuple(self.effect_plan(e, tuple(variables)) for e in action.effects),
            len(variables) + len(fluent) + size(rest, self.objects) + len(action.effects),
        )

    def join(self, variables: Variables, parts: Sequence[Formula], given: Sequence[str]) -> Join:
        """Plan the query for values of ``variables`` such that all ``parts`` hold; ``given`` ones are bound before.

        The order is: checks as soon as possible, then the atom with the most bound places.
        """
        join = Join(list(given))
        atoms = [p for p in parts if isinstance(p, Atom)]
        checks = [(p, free_variables(p)) for p in parts if not isinstance(p, Atom)]
        while True:
            bound = set(join.order)
            for condition, needed in [c for c in checks if c[1] <= bound]:
                slots = tuple((v, join.order.index(v)) for v in sorted(needed))
                join.steps.append(_Filter(condition, slots, self.static, self.checked))
                checks.remove((condition, needed))
            if atoms:
                atom = min(atoms, key=lambda a: self.effort(a, bound))
                atoms.remove(atom)
                join.steps.append(self.match(atom, variables, join.order))
                continue
            unbound = [v for v in variables if v not in bound]
            if not unbound:
                return join
            join.steps.append(_Enumerate(variables[unbound[0]]))
            join.order.append(unbound[0])

    def effort(self, atom: Atom, bound: set[str]) -> tuple[int, int, int]:
        new = len({t for t in atom.terms if t.startswith("?") and t not in bound})
        known = len(atom.terms) - new
        return (min(new, 1), -known, len(self.relations[atom.predicate].rows) or _UNKNOWN)

    def match(self, atom: Atom, variables: Variables, order: list[str]) -> _Match:
        """Return the step for ``atom``; its new variables join ``order``."""
        places: list[int] = []
        key: list[int | str] = []
        new: dict[str, int] = {}
        same: list[tuple[int, int]] = []
        for place, term in enumerate(atom.terms):
            if term in new:
                same.append((new[term], place))
            elif term in order:
                places.append(place)
                key.append(order.index(term))
            elif term.startswith("?"):
                new[term] = place
            else:
                places.append(place)
                key.append(term)
        order.extend(new)
        allowed = tuple(frozenset(variables[v]) for v in new)
        relation = self.relations[atom.predicate]
        return _Match(relation, tuple(places), tuple(key), tuple(new.values()), tuple(same), allowed)

    def effect_plan(self, effect: Effect, given: tuple[str, ...]) -> _EffectPlan:
        if not effect.parameters:
            return _EffectPlan(effect, None, effect.condition, signed_atoms(effect.condition))
        parts = conjuncts(effect.condition)
        static = [p for p in parts if self.is_static(p)]
        rest = And(tuple(p for p in parts if not self.is_static(p)))
        variables = {p.name: self.objects.of(p.types) for p in effect.parameters}
        return _EffectPlan(effect, self.join(variables, static, given), rest, signed_atoms(rest))

    def instantiate(self, plan: _ActionPlan, order: Sequence[str], rows: Iterable[Row]) -> None:
        """Make the instances for ``rows`` (values in ``order``), each once, and let them take part."""
        action = plan.action
        places = [order.index(p.name) for p in action.parameters]
        for row in rows:
            instruction = Instruction(action.name, tuple(row[p] for p in places))
            if instruction in self.actions or instruction in self.refused:
                continue
            self.work.spend(plan.size, f"the action {action.name}")
            binding = dict(zip(order, row, strict=True))
            ground = self.ground(plan, instruction, binding)
            if ground is None:
                self.refused.add(instruction)
                continue
            self.reachability.add(ground.rule(len(self.actions)))
            self.actions[instruction] = ground

    def ground(self, plan: _ActionPlan, instruction: Instruction, binding: Binding) -> GroundAction | None:
        """Return the ground action, or ``None`` where its precondition contradicts itself or what never changes."""
        forced = instruction in self.forced
        what = str(instruction)
        precondition = plan.action.precondition if forced else plan.rest
        clauses = self.clauses(precondition, binding, what)
        if not forced:
            clauses.extend(frozenset((2 * self.number(instantiate(atom, binding)),)) for atom in plan.fluent)
            units = {literal for clause in clauses if len(clause) == 1 for literal in clause}
            if frozenset() in clauses or any(literal ^ 1 in units for literal in units):
                return None
        effects = grouped(found for effect in plan.effects for found in self.effects(effect, binding, what))
        cost = action_cost(self.problem, plan.action, binding)
        return GroundAction(instruction, tuple(dict.fromkeys(clauses)), effects, cost, forced)

    def clauses(self, precondition: Formula, binding: Binding, what: str) -> list[Literals]:
        """Return ``precondition`` as clauses."""
        found: set[Literals] = set()
        for part in conjuncts(precondition):
            try:
                found.update(normal_form(expand(part, binding, self.objects, self.lookup), "and", what))
            except TmdError as error:
                error.location = part.location
                raise
        return absorb(found)

    def effects(self, plan: _EffectPlan, outer: Binding, what: str) -> Iterable[GroundEffect]:
        rows: Iterable[Binding] = (outer,)
        if plan.join is not None:
            order = plan.join.order
            found = plan.join.run([tuple(outer[v] for v in order[: len(outer)])])
            self.work.spend(len(found) * len(order), f"an effect of {what}")
            rows = (dict(zip(order, row, strict=True)) for row in found)
        for binding in rows:
            cubes = self.cubes(plan, binding, what)
            if cubes:
                literal = 2 * self.number(instantiate(plan.effect.atom, binding)) + (not plan.effect.positive)
                for cube in cubes:
                    yield GroundEffect(cube, literal)

    def cubes(self, plan: _EffectPlan, binding: Binding, what: str) -> Sequence[Literals]:
        """Return the condition of an effect as cubes; most are plain conjunctions, and quick."""
        if plan.literals is None:
            self.work.spend(size(plan.rest, self.objects), f"an effect of {what}")
            return normal_form(expand(plan.rest, binding, self.objects, self.lookup), "or", what)
        cube: set[int] = set()
        for atom, negated in plan.literals:
            found = self.lookup(instantiate(atom, binding))
            if isinstance(found, int):
                cube.add(found ^ negated)
            elif (found == TRUE) == bool(negated):
                return ()
        return () if any(literal ^ 1 in cube for literal in cube) else (frozenset(cube),)
