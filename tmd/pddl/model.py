"""The nouns of PDDL: typed ADL with conditional and universal effects and action costs.

Everything here is immutable. Lifted things (:class:`Atom`, with variables) and ground things
(:class:`GroundAtom`, :class:`Instruction`) are different types. Every node that is read from a text knows its
:class:`~tmd.diagnostics.Location`; locations take no part in equality or hashing.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple, TypeAlias

from tmd.diagnostics import Location

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
        """The instruction as a plan line: ``(keep mug1 counter1 on)``."""
        return f"({' '.join((self.name, *self.args))})"


State: TypeAlias = frozenset[GroundAtom]
"""A closed world: the atoms that hold. Static atoms are part of it."""


@dataclass(frozen=True, slots=True)
class TypedName:
    """A name with its types: a parameter (``?x``), a constant or an object. Several types mean ``either``."""

    name: str
    types: tuple[str, ...] = (OBJECT,)
    location: Location | None = field(default=None, compare=False, repr=False)


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


@dataclass(frozen=True, slots=True)
class Effect:
    """One flat effect: ``(forall (parameters) (when condition [not] atom))``."""

    atom: Atom
    positive: bool = True
    condition: Formula = TRUE
    parameters: tuple[TypedName, ...] = ()
    location: Location | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class ActionSchema:
    """An action with variables: what an instruction needs and does.

    ``cost`` is what the action adds to ``total-cost``: a number, a function of its parameters, or ``None``
    where nothing is said (then each action costs 1).
    """

    name: str
    parameters: tuple[TypedName, ...]
    precondition: Formula
    effects: tuple[Effect, ...]
    cost: int | Atom | None = None
    location: Location | None = field(default=None, compare=False, repr=False)


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
    location: Location | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Problem:
    """A PDDL problem together with its domain.

    ``objects`` are the problem's own; :meth:`all_objects` adds the domain's constants. ``init`` holds every
    atom that is true at the start, static ones included. ``function_values`` gives the values that cost
    expressions read. ``requirements`` are the problem's own, beside its domain's. ``init_locations`` tells
    where each initial atom and function value was read.
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

    def all_objects(self) -> tuple[TypedName, ...]:
        """The domain's constants, then the problem's objects, each once."""
        own = {o.name for o in self.objects}
        return tuple(c for c in self.domain.constants if c.name not in own) + self.objects
