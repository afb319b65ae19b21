"""What an object graph is made of, read off a PDDL problem: parts, edges between them, and facts that are states."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from tmd.pddl.model import GroundAtom, Problem
from tmd.world.compile import AT, PART_OF


@dataclass(frozen=True, slots=True)
class Edge:
    """A functional dependency within an object (section III-B): acting on ``tail`` changes ``head``.

    Several static facts between the same two are one edge: ``guards, interrupts``.
    """

    words: str
    tail: str
    head: str


@dataclass(frozen=True, slots=True)
class Anatomy:
    """The object graphs of one problem.

    Attributes:
        classes: The PDDL type of every object.
        constants: The names that the domain declares: robots, relations, substances.
        wholes: For every part the object it belongs to.
        parts: For every object its parts, in the problem's order.
        edges: For every object the edges between its parts, sorted.
        changing: The predicates that some action changes.
    """

    classes: Mapping[str, str]
    constants: frozenset[str]
    wholes: Mapping[str, str]
    parts: Mapping[str, tuple[str, ...]]
    edges: Mapping[str, tuple[Edge, ...]]
    changing: frozenset[str]

    def whole(self, name: str) -> str:
        """The object that ``name`` is a part of, or ``name`` itself."""
        return self.wholes.get(name, name)

    def vertices(self, name: str) -> tuple[str, ...]:
        """The object ``name`` and its parts."""
        return (name, *self.parts.get(name, ()))

    def short(self, name: str) -> str:
        """The name of a part without that of its whole: ``door`` for ``fridge1_door``."""
        whole = self.whole(name)
        return name.removeprefix(f"{whole}_") if whole != name else name

    def things(self, atom: GroundAtom) -> list[str]:
        """The objects that a fact is about, wholes for parts, each once; constants are none."""
        return list(dict.fromkeys(self.whole(a) for a in atom.args if a in self.classes and a not in self.constants))


def anatomy(problem: Problem) -> Anatomy:
    """The object graphs of a problem; parts are what its static ``part_of`` facts say."""
    changing = frozenset(effect.atom.predicate for action in problem.domain.actions for effect in action.effects)
    static = sorted(atom for atom in problem.init if atom.predicate not in changing)
    wholes = {atom.args[0]: atom.args[1] for atom in static if atom.predicate == PART_OF and len(atom.args) == 2}
    parts: dict[str, list[str]] = {}
    for declared in problem.objects:
        if declared.name in wholes:
            parts.setdefault(wholes[declared.name], []).append(declared.name)
    return Anatomy(
        {o.name: o.types[0] for o in problem.all_objects()},
        frozenset(c.name for c in problem.domain.constants),
        wholes,
        {whole: tuple(names) for whole, names in parts.items()},
        _edges(static, wholes),
        changing,
    )


def _edges(static: Iterable[GroundAtom], wholes: Mapping[str, str]) -> dict[str, tuple[Edge, ...]]:
    """The static facts between two parts of one object; what holds both ways says only that they belong together."""
    pairs = {(atom.predicate, *atom.args[:2]) for atom in static if len(atom.args) >= 2 and atom.predicate != PART_OF}
    words: dict[tuple[str, str], list[str]] = {}
    for predicate, tail, head in sorted(pairs):
        within = wholes.get(tail, tail) == wholes.get(head, head)
        if tail != head and within and (predicate, head, tail) not in pairs:
            words.setdefault((tail, head), []).append(predicate)
    found: dict[str, list[Edge]] = {}
    for (tail, head), predicates in sorted(words.items()):
        found.setdefault(wholes.get(tail, tail), []).append(Edge(", ".join(predicates), tail, head))
    return {whole: tuple(edges) for whole, edges in found.items()}


@dataclass(frozen=True, slots=True)
class Aspect:
    """A fact as it is told of one of its objects.

    Attributes:
        atom: The fact.
        other: What it relates the object to; empty for a state.
        words: The rest of it: ``contains water``, ``on``, ``near``.
        outward: Whether it leads from the object to the other, and not back.
    """

    atom: GroundAtom
    other: str
    words: str
    outward: bool


def aspects(anatomy: Anatomy, name: str, facts: Iterable[GroundAtom]) -> list[Aspect]:
    """Those of ``facts`` that are about the vertex ``name`` and may change, states first, then relations."""
    found = [_aspect(anatomy, name, a) for a in facts if name in a.args and a.predicate in anatomy.changing]
    return sorted(
        found, key=lambda a: (a.other != "", not a.outward, a.other in anatomy.constants, a.other, a.words, a.atom)
    )


def _aspect(anatomy: Anatomy, name: str, atom: GroundAtom) -> Aspect:
    """What the fact says, without the two ends; ``(at cup1 shelf1 on)`` is *on*."""
    place = atom.args.index(name)
    other = _other_end(anatomy, atom, place)
    rest = [arg for index, arg in enumerate(atom.args) if index != place and index != other]
    words = " ".join(rest) if atom.predicate == AT and other is not None and rest else " ".join([atom.predicate, *rest])
    return Aspect(atom, "" if other is None else atom.args[other], words, other is None or place < other)


def _other_end(anatomy: Anatomy, atom: GroundAtom, place: int) -> int | None:
    """The argument that the fact relates the one at ``place`` to: another object, or a constant that stands first."""
    for index, arg in enumerate(atom.args):
        if index != place and arg not in anatomy.constants:
            return index
    if place > 0:
        return 0
    furniture = [i for i, a in enumerate(atom.args) if i and atom.predicate == AT and i < len(atom.args) - 1]
    return furniture[0] if furniture else None
