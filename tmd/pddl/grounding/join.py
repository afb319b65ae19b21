"""Finding all bindings of variables that satisfy a conjunction, by joining relations.

Relations may grow between runs, as they do while reachable atoms are collected.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

from tmd.diagnostics import TmdError
from tmd.pddl.model import Atom
from tmd.pddl.semantics import Binding

Row: TypeAlias = tuple[str, ...]

_MOST_ROWS = 500_000
_UNKNOWN = 1_000_000
"""The size a relation is taken to have that is still to grow."""


class JoinRelation:
    """The known atoms of one predicate, with an index for each set of argument places asked for."""

    def __init__(self) -> None:
        self.rows: dict[Row, None] = {}
        self._indexes: dict[tuple[int, ...], dict[Row, list[Row]]] = {}

    def add(self, row: Row) -> None:
        """Make ``row`` known; it must not be already."""
        self.rows[row] = None
        for places, index in self._indexes.items():
            index.setdefault(tuple(row[p] for p in places), []).append(row)

    def matching(self, places: tuple[int, ...], key: Row) -> Collection[Row]:
        """The rows that hold ``key`` at ``places``, in the order in which they were added."""
        if not places:
            return self.rows
        index = self._indexes.get(places)
        if index is None:
            index = self._indexes[places] = {}
            for row in self.rows:
                index.setdefault(tuple(row[p] for p in places), []).append(row)
        return index.get(key, ())


@dataclass(frozen=True, slots=True)
class Check:
    """A test on variables that the join runs as soon as all of them are bound."""

    variables: frozenset[str]
    test: Callable[[Binding], bool]


@dataclass(frozen=True, slots=True)
class JoinQuery:
    """What to find: values for ``variables`` (each from its list) such that all atoms and checks hold.

    ``atoms`` are matched against ``relations``. ``given`` variables have their values already.
    """

    variables: Mapping[str, Sequence[str]]
    atoms: Sequence[Atom]
    relations: Mapping[str, JoinRelation]
    checks: Sequence[Check] = ()
    given: Sequence[str] = ()


@dataclass(frozen=True, slots=True)
class _Match:
    """Extend a row by what a relation tells."""

    relation: JoinRelation
    places: tuple[int, ...]
    key: tuple[int | str, ...]
    new: tuple[int, ...]
    same: tuple[tuple[int, int], ...]
    allowed: tuple[frozenset[str], ...]

    def run(self, rows: list[Row]) -> list[Row]:
        out: list[Row] = []
        for row in rows:
            key = tuple(row[k] if isinstance(k, int) else k for k in self.key)
            for found in self.relation.matching(self.places, key):
                if any(found[a] != found[b] for a, b in self.same):
                    continue
                values = tuple(found[p] for p in self.new)
                if all(v in a for v, a in zip(values, self.allowed, strict=True)):
                    out.append(row + values)
        return out


@dataclass(frozen=True, slots=True)
class _Enumerate:
    """Extend a row by each object of a variable's types."""

    objects: Sequence[str]

    def run(self, rows: list[Row]) -> list[Row]:
        if len(rows) * len(self.objects) > _MOST_ROWS:
            raise TmdError(
                f"grounding needs more than {_MOST_ROWS} combinations of objects",
                hint="use types or static preconditions to narrow the parameters",
            )
        return [(*row, o) for row in rows for o in self.objects]


@dataclass(frozen=True, slots=True)
class _Filter:
    """Drop the rows that fail a check."""

    slots: tuple[tuple[str, int], ...]
    test: Callable[[Binding], bool]

    def run(self, rows: list[Row]) -> list[Row]:
        return [row for row in rows if self.test({name: row[slot] for name, slot in self.slots})]


@dataclass(slots=True)
class Join:
    """A query with its order of steps fixed; ``order`` names the columns of its result."""

    order: list[str] = field(default_factory=list)
    steps: list[_Match | _Enumerate | _Filter] = field(default_factory=list)

    def run(self, start: Iterable[Row]) -> list[Row]:
        """All bindings that extend the rows of ``start`` (values of the given variables)."""
        rows = list(start)
        for step in self.steps:
            if not rows:
                break
            rows = step.run(rows)
        return rows


def plan_join(query: JoinQuery) -> Join:
    """Order the steps: checks as soon as possible, then the atom with the most bound places."""
    join = Join(list(query.given))
    waiting = list(query.atoms)
    checks = list(query.checks)
    while True:
        bound = set(join.order)
        for check in [c for c in checks if c.variables <= bound]:
            slots = tuple((v, join.order.index(v)) for v in sorted(check.variables))
            join.steps.append(_Filter(slots, check.test))
            checks.remove(check)
        if waiting:
            atom = min(waiting, key=lambda a: _effort(a, bound, query))
            waiting.remove(atom)
            join.steps.append(_match(atom, query, join.order))
            continue
        unbound = [v for v in query.variables if v not in bound]
        if not unbound:
            return join
        join.steps.append(_Enumerate(query.variables[unbound[0]]))
        join.order.append(unbound[0])


def _effort(atom: Atom, bound: set[str], query: JoinQuery) -> tuple[int, int, int]:
    new = len({t for t in atom.terms if t.startswith("?") and t not in bound})
    known = len(atom.terms) - new
    return (min(new, 1), -known, len(query.relations[atom.predicate].rows) or _UNKNOWN)


def _match(atom: Atom, query: JoinQuery, order: list[str]) -> _Match:
    """The step for ``atom``; its new variables join ``order``."""
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
    allowed = tuple(frozenset(query.variables[v]) for v in new)
    return _Match(query.relations[atom.predicate], tuple(places), tuple(key), tuple(new.values()), tuple(same), allowed)
