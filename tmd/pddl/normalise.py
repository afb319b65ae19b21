"""The form of a problem that other planners read: no ``either``, and every requirement by its own name.

Fast Downward takes ``either`` in predicates only, and unified-planning nowhere. Types that stand together in
an ``either`` get a common parent of their own, which changes neither objects nor actions.
The ``pddl`` package does not take ``:adl`` for what it stands for, so what is used is named.
"""

from __future__ import annotations

from dataclasses import replace

from tmd.diagnostics import TmdError
from tmd.pddl.model import OBJECT, Problem, TypeDeclaration, TypedName, TypeHierarchy, parents_first, rebuilt, walk
from tmd.pddl.reading.checking import used_requirements


def portable(problem: Problem) -> Problem:
    """Return ``problem`` with the same states, instructions and plans, in the form that other planners read.

    Raises:
        TmdError: As :func:`without_either`.
    """
    constants = {constant.name for constant in problem.domain.constants}
    # some readers refuse objects that are constants of the domain as well
    own = tuple(named for named in problem.objects if named.name not in constants)
    plain = without_either(replace(problem, objects=own))
    requirements = used_requirements(plain.domain, plain)
    return replace(plain, domain=replace(plain.domain, requirements=requirements), requirements=())


def without_either(problem: Problem) -> Problem:
    """Replace each ``either`` by a new parent type; without any the problem is returned as it is.

    Raises:
        TmdError: The types of an ``either`` do not share their parent, or two of them overlap.
    """
    domain = problem.domain
    hierarchy = TypeHierarchy(domain.types)
    several = [part for part in walk((problem.goal, domain)) if isinstance(part, TypedName) and len(part.types) > 1]
    if not several:
        return problem
    wanted: dict[tuple[str, ...], TypedName] = {}
    for name in several:
        wanted.setdefault(_reduced(name.types, hierarchy), name)
    parents = {t.name: t.parent for t in domain.types}
    new: dict[tuple[str, ...], str] = {}
    for types in sorted((t for t in wanted if len(t) > 1), key=lambda t: (-len(t), t)):
        new[types] = _join(types, parents, wanted[types])

    def one_type(name: TypedName) -> TypedName:
        types = _reduced(name.types, hierarchy)
        return replace(name, types=(new.get(types, types[0]),))

    plain: Problem = rebuilt(problem, lambda part: one_type(part) if isinstance(part, TypedName) else part)
    places = {t.name: t.location for t in domain.types}
    declared = [TypeDeclaration(name, parent, places.get(name)) for name, parent in parents.items()]
    return replace(plain, domain=replace(plain.domain, types=parents_first(declared)))


def _reduced(types: tuple[str, ...], hierarchy: TypeHierarchy) -> tuple[str, ...]:
    """Return ``types`` without those that another one of them covers; sorted."""
    own = set(types)
    return tuple(sorted(t for t in own if not own & set(hierarchy.ancestors(t)[1:])))


def _join(types: tuple[str, ...], parents: dict[str, str], example: TypedName) -> str:
    """Put a new type between ``types`` and their parent, and name it."""
    above = {parents.get(t, OBJECT) for t in types}
    if len(above) != 1:
        raise TmdError(
            f"(either {' '.join(types)}) cannot be written for other planners",
            location=example.location,
            hint="give these types one common parent, and use that",
        )
    name = "-or-".join(types)
    while name in parents:
        name += "-1"
    parents[name] = above.pop()
    parents.update(dict.fromkeys(types, name))
    return name
