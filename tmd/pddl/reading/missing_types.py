"""The types that objects and lists of types lack, as far as the rest of the text tells them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby

from tmd.diagnostics import Edit, Location
from tmd.pddl.model import (
    OBJECT,
    ActionSchema,
    Atom,
    Domain,
    Predicate,
    Problem,
    TypeDeclaration,
    TypedName,
    TypeHierarchy,
    walk,
)
from tmd.pddl.reading.syntax import Source, shifted


def apart(
    domain: Domain, name: str, place: Location, listed: Sequence[TypeDeclaration], source: Source
) -> Iterator[Edit]:
    """Yield the edits that end a list of types with ``- object`` behind ``name``, the type that ends the list itself.

    What stands behind it in the list stays of this type, and so do types before it that nothing else in the domain
    names: they are of use as this type only.
    """
    named: Sequence[Predicate | ActionSchema] = (*domain.predicates, *domain.functions, *domain.actions)
    used = {kind for n in named for parameter in n.parameters for kind in parameter.types}
    places = {declared.name: declared.location for declared in listed if declared.location is not None}
    stay = {other: start for other, start in places.items() if start < place and other not in used}
    for other, start in stay.items():
        yield source.removal(start, shifted(start, len(other)))
    behind = shifted(place, len(name))
    if stay or any(start > place for start in places.values()):
        yield Edit(behind, behind, " ".join((f" - {OBJECT}", *stay)))
    else:
        parent = source.type_of(place, name) or place
        yield Edit(parent, shifted(parent, len(name)), OBJECT)


def types_needed(problem: Problem) -> Mapping[str, set[str]]:
    """Return the types other than ``object`` that the uses of each object in a problem ask for."""
    predicates = {predicate.name: predicate.parameters for predicate in problem.domain.predicates}
    found: dict[str, set[str]] = {}
    goal = (part for part in walk(problem.goal) if isinstance(part, Atom))
    for atom in (*(Atom(a.predicate, a.args) for a in problem.init), *goal):
        for term, parameter in zip(atom.terms, predicates.get(atom.predicate, ()), strict=False):
            if len(parameter.types) == 1 and parameter.types != (OBJECT,):
                found.setdefault(term, set()).add(parameter.types[0])
    return found


def narrowest(kinds: set[str], hierarchy: TypeHierarchy) -> str:
    """Return the type that is all of ``kinds``; empty where none of them is."""
    return next((kind for kind in sorted(kinds) if kinds <= {*hierarchy.ancestors(kind)}), "")


def typed(objects: Sequence[TypedName], kinds: Mapping[str, str]) -> Iterator[Edit]:
    """Yield the edits that write the types of untyped objects behind them, once behind those of one type."""
    for kind, run in groupby(objects, lambda o: kinds.get(o.name, OBJECT)):
        *_, last = run
        if last.location is not None:
            end = shifted(last.location, len(last.name))
            yield Edit(end, end, f" - {kind}")
