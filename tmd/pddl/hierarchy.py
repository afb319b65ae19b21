"""The type hierarchy of a domain, and the objects of each type in a problem."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache

from tmd.pddl.model import OBJECT, Domain, Problem, TypeDeclaration, TypedName


class TypeHierarchy:
    """Which type is a kind of which."""

    def __init__(self, declarations: Iterable[TypeDeclaration]) -> None:
        self.parents: dict[str, str] = {d.name: d.parent for d in declarations if d.name != OBJECT}
        self._ancestors: dict[str, tuple[str, ...]] = {}

    def known(self, name: str) -> bool:
        """Whether ``name`` is declared; ``object`` always is."""
        return name == OBJECT or name in self.parents

    def ancestors(self, name: str) -> tuple[str, ...]:
        """``name``, its parent and so on up to ``object``; a cycle is walked once."""
        found = self._ancestors.get(name)
        if found is None:
            chain: list[str] = []
            current: str | None = name
            while current is not None and current not in chain:
                chain.append(current)
                current = self.parents.get(current)
            if OBJECT not in chain:
                chain.append(OBJECT)
            found = self._ancestors[name] = tuple(chain)
        return found

    def accepts(self, wanted: Sequence[str], given: Sequence[str]) -> bool:
        """Whether everything of the types ``given`` (any of them) is also of one of ``wanted``."""
        return all(any(w in self.ancestors(g) for w in wanted) for g in given)


class Universe:
    """The objects of a problem, by type, each list in order of declaration."""

    def __init__(self, hierarchy: TypeHierarchy, objects: Sequence[TypedName]) -> None:
        self.hierarchy = hierarchy
        self.types_of: dict[str, tuple[str, ...]] = {o.name: o.types for o in objects}
        self._of: dict[tuple[str, ...], tuple[str, ...]] = {}
        self._is_a: dict[tuple[str, tuple[str, ...]], bool] = {}

    def is_a(self, name: str, types: Sequence[str]) -> bool:
        """Whether the object ``name`` exists and is of one of ``types``."""
        key = name, tuple(types)
        known = self._is_a.get(key)
        if known is None:
            given = self.types_of.get(name)
            known = self._is_a[key] = given is not None and self.hierarchy.accepts(types, given)
        return known

    def of(self, types: tuple[str, ...]) -> tuple[str, ...]:
        """The objects of any of ``types``."""
        found = self._of.get(types)
        if found is None:
            found = self._of[types] = tuple(name for name in self.types_of if self.is_a(name, types))
        return found


def parents_first(declarations: Sequence[TypeDeclaration]) -> tuple[TypeDeclaration, ...]:
    """``declarations`` with each parent before its children, otherwise in order: some readers insist."""
    waiting = list(declarations)
    ordered: list[TypeDeclaration] = []
    known = {OBJECT}
    while waiting:
        ready = next((t for t in waiting if t.parent in known), waiting[0])
        waiting.remove(ready)
        ordered.append(ready)
        known.add(ready.name)
    return tuple(ordered)


@lru_cache(maxsize=64)
def _hierarchy(declarations: tuple[TypeDeclaration, ...]) -> TypeHierarchy:
    return TypeHierarchy(declarations)


@lru_cache(maxsize=64)
def _universe(declarations: tuple[TypeDeclaration, ...], objects: tuple[TypedName, ...]) -> Universe:
    return Universe(_hierarchy(declarations), objects)


def hierarchy(domain: Domain) -> TypeHierarchy:
    """The type hierarchy of ``domain``."""
    return _hierarchy(domain.types)


def universe(problem: Problem) -> Universe:
    """The objects of ``problem``, its domain's constants among them."""
    return _universe(problem.domain.types, problem.all_objects())
