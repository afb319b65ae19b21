"""The model of PDDL: typed ADL with conditional and universal effects and action costs; its formulas and its types."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass, replace
from functools import lru_cache
from heapq import heappop, heappush
from typing import Any, NamedTuple, TypeAlias

from tmd.diagnostics import Location
from tmd.short_repr import short_repr

OBJECT = "object"
"""The root of the type hierarchy."""

TOTAL_COST = "total-cost"
"""The only numeric fluent that is supported."""


class GroundAtom(NamedTuple):
    """A ground atom such as ``(on mug1 counter1)``; ordered by name, so sorting is canonical."""

    predicate: str
    args: tuple[str, ...] = ()

    def __str__(self) -> str:
        return f"({' '.join((self.predicate, *self.args))})"


class Instruction(NamedTuple):
    """A ground action by name: ``keep(mug1, counter1, on)``. What a plan is made of."""

    name: str
    args: tuple[str, ...] = ()

    def __str__(self) -> str:
        return f"{self.name}({', '.join(self.args)})"

    def pddl(self) -> str:
        """Return the instruction as a plan line: ``(keep mug1 counter1 on)``."""
        return f"({' '.join((self.name, *self.args))})"


State: TypeAlias = frozenset[GroundAtom]
"""A closed world: the atoms that hold. Static atoms are part of it."""


@dataclass(frozen=True, slots=True)
class TypedName:
    """A name with its types: a parameter (``?x``), a constant or an object. Several types mean ``either``."""

    name: str
    types: tuple[str, ...] = (OBJECT,)
    location: Location | None = field(default=None, compare=False, repr=False)

    def typed(self) -> str:
        """Return ``name - type`` as it is declared; the name alone where it has no type."""
        return self.name if self.types in ((), (OBJECT,)) else f"{self.name} - {self.types[0]}"


@dataclass(frozen=True, slots=True)
class TypeDeclaration:
    """A type and its parent."""

    name: str
    parent: str = OBJECT
    location: Location | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Predicate:
    """A predicate and its parameters. ``comment`` is the comment beside its declaration, if any."""

    name: str
    parameters: tuple[TypedName, ...] = ()
    comment: str = field(default="", compare=False)
    location: Location | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Atom:
    """A predicate applied to terms: variables begin with ``?``, all else is a constant or an object."""

    predicate: str
    terms: tuple[str, ...] = ()
    location: Location | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Equals:
    """``(= a b)``."""

    left: str
    right: str
    location: Location | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Not:
    """Negation."""

    part: Formula
    location: Location | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class And:
    """Conjunction; the empty one is true."""

    parts: tuple[Formula, ...] = ()
    location: Location | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Or:
    """Disjunction; the empty one is false."""

    parts: tuple[Formula, ...] = ()
    location: Location | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Imply:
    """``(imply a b)``."""

    left: Formula
    right: Formula
    location: Location | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Forall:
    """Universal quantification over the objects of the parameters' types."""

    parameters: tuple[TypedName, ...]
    part: Formula
    location: Location | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Exists:
    """Existential quantification over the objects of the parameters' types."""

    parameters: tuple[TypedName, ...]
    part: Formula
    location: Location | None = field(default=None, compare=False, repr=False)


Formula: TypeAlias = Atom | Equals | Not | And | Or | Imply | Forall | Exists

TRUE = And()


def keyword(formula: Formula) -> str:
    """Return the word of a connective or quantifier in PDDL."""
    return type(formula).__name__.lower()


@dataclass(frozen=True, slots=True)
class Effect:
    """One flat effect: ``(forall (parameters) (when condition [not] atom))``."""

    atom: Atom
    positive: bool = True
    condition: Formula = TRUE
    parameters: tuple[TypedName, ...] = ()
    location: Location | None = field(default=None, compare=False, repr=False)


@short_repr(lambda action: " ".join((action.name, *(p.name for p in action.parameters))))
@dataclass(frozen=True, slots=True)
class ActionSchema:
    """An action with variables: what an instruction needs and does.

    ``cost`` is what the action adds to ``total-cost``: a number, a function of its parameters, or ``None``
    where nothing is said (then each action costs 1). ``comment`` is what stands above it in the file, for people.
    """

    name: str
    parameters: tuple[TypedName, ...]
    precondition: Formula
    effects: tuple[Effect, ...]
    cost: int | Atom | None = None
    location: Location | None = field(default=None, compare=False, repr=False)
    comment: str = field(default="", compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Axiom:
    """``(:derived head condition)``: the head holds wherever the condition does. Its terms are the parameters."""

    head: Atom
    parameters: tuple[TypedName, ...]
    condition: Formula
    location: Location | None = field(default=None, compare=False, repr=False)


@short_repr(lambda domain: f"{domain.name}: {len(domain.actions)} action(s)")
@dataclass(frozen=True, slots=True)
class Domain:
    """A PDDL domain. Order of declaration is kept."""

    name: str
    requirements: tuple[str, ...] = ()
    types: tuple[TypeDeclaration, ...] = ()
    constants: tuple[TypedName, ...] = ()
    predicates: tuple[Predicate, ...] = ()
    functions: tuple[Predicate, ...] = ()
    actions: tuple[ActionSchema, ...] = ()
    derived: tuple[Axiom, ...] = ()
    location: Location | None = field(default=None, compare=False, repr=False)


@short_repr(lambda problem: f"{problem.name} of {problem.domain.name}: {len(problem.objects)} object(s)")
@dataclass(frozen=True, slots=True)
class Problem:
    """A PDDL problem together with its domain.

    ``objects`` are the problem's own; :meth:`all_objects` adds the domain's constants. ``init`` holds every
    atom that is true at the start, static and derived ones included. ``function_values`` gives the values that cost
    expressions read. ``requirements`` are the problem's own, beside its domain's. ``init_locations`` tells
    where each initial atom and function value was read, and ``init_denied`` holds the atoms that are denied: atoms
    that are not stated do not hold anyway, so they are kept only to be checked.
    """

    name: str
    domain: Domain
    objects: tuple[TypedName, ...] = ()
    init: State = frozenset()
    goal: Formula = TRUE
    function_values: Mapping[GroundAtom, int] = field(default_factory=dict, hash=False)
    minimize_cost: bool = False
    requirements: tuple[str, ...] = ()
    location: Location | None = field(default=None, compare=False, repr=False)
    init_locations: Mapping[GroundAtom, Location] = field(default_factory=dict, compare=False, repr=False)
    init_denied: State = field(default=frozenset(), compare=False, repr=False)
    metric_location: Location | None = field(default=None, compare=False, repr=False)

    def all_objects(self) -> tuple[TypedName, ...]:
        """Return the domain's constants, then the problem's objects, each once."""
        own = {o.name for o in self.objects}
        return tuple(c for c in self.domain.constants if c.name not in own) + self.objects


def conjuncts(formula: Formula) -> list[Formula]:
    """Return the parts of a conjunction, however nested."""
    if isinstance(formula, And):
        return [inner for part in formula.parts for inner in conjuncts(part)]
    return [formula]


def signed_atoms(formula: Formula) -> tuple[tuple[Atom, int], ...] | None:
    """Return the atoms of a conjunction of literals, 1 for negated ones; ``None`` for any other formula."""
    found: list[tuple[Atom, int]] = []
    for part in conjuncts(formula):
        inner = part.part if isinstance(part, Not) else part
        if not isinstance(inner, Atom):
            return None
        found.append((inner, int(isinstance(part, Not))))
    return tuple(found)


def parts_of(formula: Formula) -> tuple[Formula, ...]:
    """Return the direct parts of a formula."""
    match formula:
        case And(parts) | Or(parts):
            return parts
        case Not(part) | Forall(_, part) | Exists(_, part):
            return (part,)
        case Imply(left, right):
            return left, right
        case _:
            return ()


def with_parts(formula: Formula, change: Callable[[Formula], Formula]) -> Formula:
    """Return a formula with each of its direct parts changed."""
    match formula:
        case And(parts) | Or(parts):
            return replace(formula, parts=tuple(map(change, parts)))
        case Not(part) | Forall(_, part) | Exists(_, part):
            return replace(formula, part=change(part))
        case Imply(left, right):
            return replace(formula, left=change(left), right=change(right))
        case _:
            return formula


def signed_subformulas(formula: Formula, positive: bool = True) -> Iterator[tuple[Formula, bool]]:
    """Yield a formula and everything in it, outer formulas first, each with whether it is not negated."""
    yield formula, positive
    for place, part in enumerate(parts_of(formula)):
        negated = isinstance(formula, Not) or (isinstance(formula, Imply) and place == 0)
        yield from signed_subformulas(part, positive != negated)


# The types of parts that have no parts: to leave them out takes half the time.
_LEAVES = frozenset({str, int, bool, type(None), Location})


def walk(node: object) -> Iterator[object]:
    """Yield a part of a domain (an action, a formula, a tuple of parts) and all parts in it, outer ones first."""
    waiting = [node]
    while waiting:
        node = waiting.pop()
        yield node
        if isinstance(node, tuple):
            waiting += [part for part in reversed(node) if type(part) not in _LEAVES]
        elif not isinstance(node, TypedName):
            parts = [getattr(node, name) for name in reversed(getattr(node, "__dataclass_fields__", {}))]
            waiting += [part for part in parts if type(part) not in _LEAVES]


def rebuilt(node: Any, change: Callable[[Any], Any]) -> Any:  # noqa: ANN401 - any part of a problem or plan
    """Return a part of a problem or plan with ``change`` applied to it and to all parts in it, inner ones first."""
    if isinstance(node, GroundAtom | Instruction):
        return change(node)
    if isinstance(node, tuple | frozenset):
        return type(node)(rebuilt(part, change) for part in node)
    if isinstance(node, Mapping):
        return {rebuilt(key, change): value for key, value in node.items()}
    if not is_dataclass(node) or isinstance(node, type | Location):
        return node
    return change(replace(node, **{each.name: rebuilt(getattr(node, each.name), change) for each in fields(node)}))


def predicates_of(formula: Formula) -> frozenset[str]:
    """Return the predicates of a formula."""
    return frozenset(part.predicate for part in walk(formula) if isinstance(part, Atom))


def free_variables(formula: Formula) -> frozenset[str]:
    """Return the variables of a formula that no quantifier within it binds."""
    if isinstance(formula, Atom):
        return frozenset(t for t in formula.terms if t.startswith("?"))
    if isinstance(formula, Equals):
        return frozenset(t for t in (formula.left, formula.right) if t.startswith("?"))
    bound = {p.name for p in formula.parameters} if isinstance(formula, Forall | Exists) else set()
    return frozenset[str]().union(*map(free_variables, parts_of(formula))) - bound


MOST_LEVELS = 200
"""Maximum depth of the type hierarchy; types of a longer chain count as unrelated, and are a fault."""


class TypeHierarchy:
    """The hierarchy of types."""

    def __init__(self, declarations: Iterable[TypeDeclaration]) -> None:
        self.parents: dict[str, str] = {d.name: d.parent for d in declarations if d.name != OBJECT}
        self._ancestors: dict[str, tuple[str, ...]] = {}

    def known(self, name: str) -> bool:
        """Return whether ``name`` is declared; ``object`` always is."""
        return name == OBJECT or name in self.parents

    def ancestors(self, name: str) -> tuple[str, ...]:
        """Return ``name``, its parent and so on up to ``object``; a cycle is walked once."""
        found = self._ancestors.get(name)
        if found is None:
            chain: dict[str, None] = {}
            current: str | None = name
            while current is not None and current not in chain and len(chain) < MOST_LEVELS:
                chain[current] = None
                current = self.parents.get(current)
            chain.setdefault(OBJECT)
            found = self._ancestors[name] = tuple(chain)
        return found

    def accepts(self, wanted: Sequence[str], given: Sequence[str]) -> bool:
        """Return whether everything of the types ``given`` (any of them) is also of one of ``wanted``."""
        return all(any(w in self.ancestors(g) for w in wanted) for g in given)


class Universe:
    """The objects of a problem, by type, each list in order of declaration."""

    def __init__(self, hierarchy: TypeHierarchy, objects: Sequence[TypedName]) -> None:
        self.hierarchy = hierarchy
        self.types_of: dict[str, tuple[str, ...]] = {o.name: o.types for o in objects}
        self._of: dict[tuple[str, ...], tuple[str, ...]] = {}
        self._is_a: dict[tuple[str, tuple[str, ...]], bool] = {}

    def is_a(self, name: str, types: Sequence[str]) -> bool:
        """Return whether the object ``name`` exists and is of one of ``types``."""
        key = name, tuple(types)
        known = self._is_a.get(key)
        if known is None:
            given = self.types_of.get(name)
            known = self._is_a[key] = given is not None and self.hierarchy.accepts(types, given)
        return known

    def of(self, types: tuple[str, ...]) -> tuple[str, ...]:
        """Return the objects of any of ``types``."""
        found = self._of.get(types)
        if found is None:
            found = self._of[types] = tuple(name for name in self.types_of if self.is_a(name, types))
        return found


def parents_first(declarations: Sequence[TypeDeclaration]) -> tuple[TypeDeclaration, ...]:
    """Sort declarations: each parent before its children, as some readers need it, otherwise in order."""
    children: dict[str, list[int]] = {}
    for number, declared in enumerate(declarations):
        children.setdefault(declared.parent, []).append(number)
    order: dict[int, None] = {}
    ready = list(children.get(OBJECT, ()))  # a heap: the first of those whose parent stands before them comes next
    for first in range(len(declarations)):  # next where none is ready, as in a cycle
        while ready or first not in order:
            number = heappop(ready) if ready else first
            if number not in order:
                order[number] = None
                for child in children.get(declarations[number].name, ()):
                    heappush(ready, child)
    return tuple(declarations[number] for number in order)


@lru_cache(maxsize=64)
def _hierarchy(declarations: tuple[TypeDeclaration, ...]) -> TypeHierarchy:
    return TypeHierarchy(declarations)


@lru_cache(maxsize=64)
def _universe(declarations: tuple[TypeDeclaration, ...], objects: tuple[TypedName, ...]) -> Universe:
    return Universe(_hierarchy(declarations), objects)


def hierarchy(domain: Domain) -> TypeHierarchy:
    """Return the type hierarchy of ``domain``."""
    return _hierarchy(domain.types)


def universe(problem: Problem) -> Universe:
    """Return the objects of ``problem``, its domain's constants among them."""
    return _universe(problem.domain.types, problem.all_objects())
