"""Warnings on domains and problems that are legal PDDL and hardly ever meant, such as goals that nothing reaches."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cache
from math import prod
from pathlib import Path

from tmd.diagnostics import Edit, TmdError
from tmd.pddl.derived import as_actions
from tmd.pddl.grounding.ground_action import TOO_MANY_CASES, Reachability, Rule
from tmd.pddl.grounding.ground_task import ground, ground_condition
from tmd.pddl.model import (
    TRUE,
    ActionSchema,
    And,
    Atom,
    Domain,
    Effect,
    Equals,
    Formula,
    GroundAtom,
    Not,
    Or,
    Problem,
    TypedName,
    conjuncts,
    free_variables,
    universe,
    walk,
)
from tmd.pddl.reading.syntax import Node, Source, Word, after, read_text, split_lines
from tmd.pddl.semantics import instantiate, size, solutions
from tmd.pddl.task import Cube, Task
from tmd.pddl.writer import format_formula
from tmd.planning.unsolvable import reachable, relaxed_literals, unreachable_reason

Scope = Mapping[str, tuple[str, ...]]
"""The types of variables."""


def lint_domain(domain: Domain, source: Source) -> list[TmdError]:
    """Return the warnings for a domain that has no faults."""
    found = list(_unused_predicates(domain, source))
    for action in domain.actions:
        found += _contradictory_effects(action, source)
        found += _never_applies(action, source)
        needed = conjuncts(action.precondition)
        found += _said_twice(needed, f'in the precondition of action "{action.name}"', source)
        found += _said_twice(action.effects, f'among the effects of action "{action.name}"', source)
        found += _unused_parameters(action, source)
        if not action.effects and action.cost is None:
            hint = "write its :effect, or remove it"
            found.append(source.error(f'action "{action.name}" changes nothing', action.location, hint, "no-effect"))
    return found


def _unused_predicates(domain: Domain, source: Source) -> Iterator[TmdError]:
    used = {part.predicate for part in walk((domain.actions, domain.derived)) if isinstance(part, Atom)}
    for predicate in domain.predicates:
        if predicate.name not in used and domain.actions and predicate.name != "=":
            yield source.error(
                f'no action speaks of the predicate "{predicate.name}"',
                source.word(predicate.location, 0),
                "use it, or remove it",
                "unused-predicate",
            )


def _contradictory_effects(action: ActionSchema, source: Source) -> Iterator[TmdError]:
    """Yield the same atom added and deleted under the same condition: adding wins."""
    added = {(e.atom, e.condition, e.parameters) for e in action.effects if e.positive}
    for effect in action.effects:
        if not effect.positive and (effect.atom, effect.condition, effect.parameters) in added:
            atom = " ".join((effect.atom.predicate, *effect.atom.terms))
            yield source.error(
                f'action "{action.name}" adds and deletes ({atom}); adding wins',
                effect.location,
                "remove one of the two",
                "contradictory-effects",
            )


def _said_twice(parts: Iterable[Formula | Effect], where: str, source: Source) -> Iterator[TmdError]:
    """Yield the conditions or effects that stand twice among some."""
    seen: set[Formula | Effect] = set()
    for part in parts:
        if part in seen:
            plain = part if not isinstance(part, Effect) else part.atom if part.positive else Not(part.atom)
            message = f"{format_formula(plain)} stands twice {where}"
            yield source.error(message, part.location, "remove one of the two", "said-twice")
        seen.add(part)


def _never_applies(action: ActionSchema, source: Source) -> Iterator[TmdError]:
    """Yield a precondition that no state satisfies, as far as one can tell by looking at it."""
    parts = conjuncts(action.precondition)
    stated = set(parts)
    for part in parts:
        if _is_false(part) or (isinstance(part, Not) and part.part in stated):
            yield source.error(
                f'action "{action.name}" can never apply: its precondition contradicts itself here',
                part.location or action.location,
                "remove one of the conditions",
                "never-applies",
            )


def _is_false(formula: Formula) -> bool:
    if isinstance(formula, Or):
        return not formula.parts
    if isinstance(formula, Not):
        inner = formula.part
        return inner == TRUE or (isinstance(inner, Equals) and inner.left == inner.right)
    return (
        isinstance(formula, Equals) and formula.left != formula.right and "?" not in formula.left[0] + formula.right[0]
    )


def _unused_parameters(action: ActionSchema, source: Source) -> Iterator[TmdError]:
    used = set(free_variables(action.precondition))
    for effect in action.effects:
        used.update(effect.atom.terms)
        used |= free_variables(effect.condition)
    if isinstance(action.cost, Atom):
        used.update(action.cost.terms)
    for parameter in action.parameters:
        if parameter.name not in used:
            yield source.error(
                f'action "{action.name}" does not speak of its parameter "{parameter.name}"',
                parameter.location,
                "use it, or remove it",
                "unused-parameter",
            )


class Possible:
    """Atoms that may hold and actions that may apply in a problem, found without grounding it.

    An over-approximation in time linear in the problem: relaxed reachability over the effects of the lifted actions,
    and over the objects that the initial state has at each place of each predicate. What is impossible here is
    impossible. ``blocked`` has for each action that can never apply what it lacks: a type without objects, or an atom
    of its precondition.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.objects = universe(problem)
        # whether the initial state has an object of some types at a place of a predicate
        self._fits = cache(lambda name, at, types: any(self.objects.is_a(o, types) for o in self._columns[name][at]))
        self._columns: dict[str, list[dict[str, None]]] = {}
        for atom in problem.init:
            columns = self._columns.setdefault(atom.predicate, [{} for _ in atom.args])
            for column, name in zip(columns, atom.args, strict=True):
                column[name] = None
        actions = as_actions(problem.domain).actions
        # each effect that adds an atom is a literal of the relaxation, by its number
        self._effects: list[tuple[Effect, Scope]] = []
        self._adding: dict[str, list[int]] = {}
        heads: list[list[int]] = []
        for action in actions:
            heads.append([])
            for effect in action.effects:
                if effect.positive:
                    literal = 2 * len(self._effects)
                    self._effects.append((effect, types_of((*action.parameters, *effect.parameters))))
                    self._adding.setdefault(effect.atom.predicate, []).append(literal)
                    heads[-1].append(literal)
        needs = [self._needs(action) for action in actions]
        self._reachability = Reachability((), lambda atom: False)
        for number, own in enumerate(needs):
            self._reachability.add(Rule((number, -1), [literals for _, literals in own], heads[number]))
        self._reachability.run()
        self.blocked: dict[str, str | Atom] = {}
        for action, own in zip(actions, needs, strict=True):
            lack = next((need for need, literals in own if not self._reached(literals)), None)
            if lack is not None:
                self.blocked[action.name] = lack

    def may_hold(self, atom: Atom, scope: Scope) -> bool:
        """Return whether some atom of this form holds at the start or may be added."""
        return self._holds_at_start(atom, scope) or self._reached(self._makers(atom, scope))

    def _reached(self, literals: Iterable[int]) -> bool:
        return any(map(self._reachability.holds, literals))

    def _needs(self, action: ActionSchema) -> list[tuple[str | Atom, frozenset[int]]]:
        """Return each thing that the initial state does not give to ``action``, with the effects that may make it."""
        types = [parameter.types for parameter in action.parameters if not self.objects.of(parameter.types)]
        if types:
            return [(types[0][0], frozenset())]
        scope = types_of(action.parameters)
        atoms = (part for part in conjuncts(action.precondition) if isinstance(part, Atom))
        return [(atom, self._makers(atom, scope)) for atom in atoms if not self._holds_at_start(atom, scope)]

    def _holds_at_start(self, atom: Atom, scope: Scope) -> bool:
        columns = self._columns.get(atom.predicate)
        if columns is None:
            return False
        return all(
            self._fits(atom.predicate, place, scope[term]) if term.startswith("?") else term in columns[place]
            for place, term in enumerate(atom.terms)
        )

    def _makers(self, atom: Atom, scope: Scope) -> frozenset[int]:
        """Return the effects that may add an atom of this form."""
        return frozenset(
            literal
            for literal in self._adding.get(atom.predicate, ())
            if self._unify(atom, scope, *self._effects[literal // 2])
        )

    def _unify(self, atom: Atom, scope: Scope, effect: Effect, inner: Scope) -> bool:
        bound: dict[str, str] = {}
        for one, two in zip(atom.terms, effect.atom.terms, strict=True):
            if one.startswith("?") and two.startswith("?"):
                fits = self._overlap(scope[one], inner[two])
            elif one.startswith("?"):
                fits = self.objects.is_a(two, scope[one])
            elif two.startswith("?"):
                fits = bound.setdefault(two, one) == one and self.objects.is_a(one, inner[two])
            else:
                fits = one == two
            if not fits:
                return False
        return True

    def _overlap(self, one: Sequence[str], other: Sequence[str]) -> bool:
        ancestors = self.objects.hierarchy.ancestors
        return any(a in ancestors(b) or b in ancestors(a) for a in one for b in other)


def types_of(parameters: Iterable[TypedName]) -> dict[str, tuple[str, ...]]:
    """Return the types of each parameter."""
    return {parameter.name: parameter.types for parameter in parameters}


def lint_problem(problem: Problem, source: Source) -> list[TmdError]:
    """Return the warnings for a problem that has no faults."""
    task = _ground(problem)
    return [
        *_constants_again(problem, source),
        *_costs_missing(problem, source),
        *_said_twice(conjuncts(problem.goal), "in the goal", source),
        *_too_many_cases(problem, task),
        *(_contradictory_goal(problem, source) or _goal_holds(problem, source) or _unreachable(problem, task, source)),
    ]


def _constants_again(problem: Problem, source: Source) -> Iterator[TmdError]:
    """Yield a warning on constants of the domain that are listed as objects."""
    constants = {constant.name for constant in problem.domain.constants}
    again = [o for o in problem.objects if o.name in constants]
    if again:
        names = ", ".join(f'"{o.name}"' for o in again)
        message = f"constants of the domain stand here again, which other planners refuse: {names}"
        edits = list(_removals(source, {o.name for o in again}))
        yield source.error(message, again[0].location, "remove them here", "constant-again", edits)


def _removals(source: Source, names: set[str]) -> Iterator[Edit]:
    """Yield the edits that remove names from a typed list, and the types that are left without names."""
    listed: list[Word] = []
    parts = iter(source.sections[":objects"].parts[1:])
    for part in parts:
        if isinstance(part, Word) and part.text != "-":
            listed.append(part)
        else:
            yield from _removed(source, listed, names, next(parts, None))
            listed = []
    yield from _removed(source, listed, names, None)


def _removed(source: Source, listed: Sequence[Word], names: set[str], kind: Node | None) -> Iterator[Edit]:
    gone = [word for word in listed if word.text in names]
    if gone and kind and len(gone) == len(listed):
        yield source.removal(gone[0].location, after(kind))
    else:
        yield from (source.removal(word.location, after(word)) for word in gone)


def _costs_missing(problem: Problem, source: Source) -> Iterator[TmdError]:
    """Yield a warning for each action whose cost has no value where nothing that never changes forbids the action."""
    changed = {effect.atom.predicate for action in as_actions(problem.domain).actions for effect in action.effects}
    objects = universe(problem)
    for action in problem.domain.actions if problem.minimize_cost else ():
        lasting = [p for p in conjuncts(action.precondition) if isinstance(p, Atom) and p.predicate not in changed]
        bound = {term for atom in lasting for term in atom.terms}
        free = prod(len(objects.of(p.types)) for p in action.parameters if p.name not in bound)
        if not isinstance(action.cost, Atom) or free > _MOST_GROUND:
            continue
        found = solutions(action.parameters, And(tuple(lasting)), problem.init, objects, {})
        missing = sorted({instantiate(action.cost, binding) for binding in found} - problem.function_values.keys())
        if missing:
            more = f", and {len(missing) - 1} more lack one" if len(missing) > 1 else ""
            message = f'{missing[0]} has no value{more}, and action "{action.name}" needs it'
            place = problem.metric_location or problem.location
            yield source.error(message, place, f"add (= {missing[0]} 1) to :init", "cost-missing")


def _contradictory_goal(problem: Problem, source: Source) -> list[TmdError]:
    parts = conjuncts(problem.goal)
    stated = set(parts)
    return [
        source.error(
            f"the goal contradicts itself: {format_formula(part.part)} would have to hold and not to hold",
            part.location or problem.location,
            "remove one of the two",
            "unreachable-goal",
        )
        for part in parts
        if isinstance(part, Not) and part.part in stated
    ]


# Problems with more instances of actions, or atoms in their conditions, are not ground while they are checked: that
# takes over a second.
_MOST_GROUND = 10_000
_MOST_ATOMS = 200_000


def lint_cases(problem: Problem) -> list[TmdError]:
    """Return the condition that keeps ``problem`` from being ground, if there is one; with its place in the domain."""
    return _too_many_cases(problem, _ground(problem))


def _too_many_cases(problem: Problem, task: Task | TmdError | None) -> list[TmdError]:
    place = task.location if isinstance(task, TmdError) and task.code == TOO_MANY_CASES else None
    found = [a for a in problem.domain.actions for part in conjuncts(a.precondition) if part.location == place]
    if not isinstance(task, TmdError) or place is None or not found:
        return []
    message = f'this condition of action "{found[0].name}" is too large to be written out in "{problem.name}"'
    line = split_lines(read_text(place.file))[place.line - 1] if Path(place.file).is_file() else None
    return [TmdError(message, location=place, hint=task.hint, source=line, code=TOO_MANY_CASES)]


def _ground(problem: Problem) -> Task | TmdError | None:
    """Ground ``problem``, or return why that fails; ``None`` for too many instances or atoms in their conditions."""
    objects = universe(problem)
    actions = problem.domain.actions
    instances = [prod(len(objects.of(p.types)) for p in action.parameters) for action in actions]
    atoms = sum(size(a.precondition, objects) * many for a, many in zip(actions, instances, strict=True))
    if sum(instances) > _MOST_GROUND or atoms > _MOST_ATOMS:
        return None
    try:
        return ground(problem)
    except TmdError as error:
        return error


def _unreachable(problem: Problem, task: Task | TmdError | None, source: Source) -> list[TmdError]:
    """Return the proof that ``tmd plan`` gives: what relaxed reachability from the initial state never reaches."""
    if not isinstance(task, Task):
        return []
    may_hold = relaxed_literals(task, task.init)

    def reaches(cubes: Sequence[Cube]) -> bool:
        return any(reachable(cube, may_hold) for cube in cubes)

    if reaches(task.goal):
        return []
    lost = [part for part in conjuncts(problem.goal) if not reaches(ground_condition(task, part))]
    place = (lost[0].location if lost else problem.goal.location) or problem.location
    message = f"no plan reaches the goal: {unreachable_reason(task, task.init, task.goal)}"
    if lost:
        message = f"the goal {format_formula(lost[0])} cannot be reached: no action that leads to it can ever apply"
    if len(lost) > 1:
        message += f", and {len(lost) - 1} more of its parts cannot be reached either"
    hint = "look at :init, and at the preconditions and effects of the actions"
    return [source.error(message, place, hint, "unreachable-goal")]


def _goal_holds(problem: Problem, source: Source) -> list[TmdError]:
    parts = conjuncts(problem.goal)
    literals = [part.part if isinstance(part, Not) else part for part in parts]
    if parts and all(isinstance(literal, Atom) for literal in literals):
        holds = (
            (GroundAtom(atom.predicate, atom.terms) in problem.init) != isinstance(part, Not)
            for part, atom in zip(parts, literals, strict=True)
            if isinstance(atom, Atom)
        )
        if all(holds):
            place = getattr(parts[0], "location", None) or problem.location
            message = "the goal holds at the start: the empty plan reaches it"
            return [source.error(message, place, "change the goal or :init", "goal-holds")]
    return []


def lint_together(domain: Domain, problems: Sequence[Problem], source: Source) -> list[TmdError]:
    """Return warnings on actions of ``domain`` that never apply in any of the ``problems``, and why.

    Where nothing makes a predicate true or a type has no objects, other actions that never apply follow from that, and
    are not reported.
    """
    known = [Possible(problem) for problem in problems]
    every = "in this problem" if len(known) == 1 else f"in none of the {len(known)} problems"
    made = {effect.atom.predicate for a in as_actions(domain).actions for effect in a.effects if effect.positive}
    made |= {atom.predicate for problem in problems for atom in problem.init}
    causes: dict[str, TmdError] = {}
    others: list[TmdError] = []
    for action in domain.actions:
        lack = known[0].blocked.get(action.name) if known else None
        if lack is None or any(action.name not in p.blocked for p in known):
            continue
        if isinstance(lack, str):
            message = f'no object is of type "{lack}" {every}, so action "{action.name}" never applies'
            hint = f'declare an object of type "{lack}"'
            causes.setdefault(lack, source.error(message, action.location, hint, "type-without-objects"))
            continue
        place, name = lack.location or action.location, lack.predicate
        if name in made:
            message = f'action "{action.name}" can never apply {every}: {format_formula(lack)} never holds'
            hint = "look at the types and constants here and in :init"
            others.append(source.error(message, place, hint, "never-applies"))
        else:
            true = "true" if len(known) == 1 else "true,"
            message = f'nothing makes "{name}" {true} {every}, and action "{action.name}" needs it'
            hint = f'add "{name}" to an effect or to :init'
            causes.setdefault(f"({name})", source.error(message, place, hint, "never-produced"))
    return list(causes.values()) or others
