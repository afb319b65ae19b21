"""The object graph of one object, as HTML: a list for each of its parts, with its states, relations and edges."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from tmd.pddl.model import GroundAtom, Problem, State
from tmd.view.markup import macro
from tmd.world.compile import AT, PART_OF
from tmd.world.world import World


@dataclass(frozen=True, slots=True)
class Anatomy:
    """The object graphs of one problem.

    Attributes:
        classes: The PDDL type of every object.
        constants: The names that the domain declares: robots, relations, substances.
        wholes: For every part the object it belongs to.
        parts: For every object its parts, in the problem's order.
        edges: The edges of the graphs (section III-B), by their two ends: acting on the first changes the second.
            Several static facts between the same two are one edge: ``guards, interrupts``.
        changing: The predicates that some action changes.
    """

    classes: Mapping[str, str]
    constants: frozenset[str]
    wholes: Mapping[str, str]
    parts: Mapping[str, tuple[str, ...]]
    edges: Mapping[tuple[str, str], str]
    changing: frozenset[str]

    def whole(self, name: str) -> str:
        """Return the object that ``name`` is a part of, or ``name`` itself."""
        return self.wholes.get(name, name)

    def vertices(self, name: str) -> tuple[str, ...]:
        """Return the object ``name`` and its parts."""
        return (name, *self.parts.get(name, ()))

    def short(self, name: str) -> str:
        """Return the name of a part without that of its whole: ``door`` for ``fridge1_door``."""
        whole = self.whole(name)
        return name.removeprefix(f"{whole}_") if whole != name else name


def anatomy(problem: Problem) -> Anatomy:
    """Return the object graphs of a problem; parts are what its static ``part_of`` facts say."""
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


def _edges(static: Iterable[GroundAtom], wholes: Mapping[str, str]) -> dict[tuple[str, str], str]:
    """Return the static facts between two parts of one object, without those that hold both ways."""
    pairs = {(atom.predicate, *atom.args[:2]) for atom in static if len(atom.args) >= 2 and atom.predicate != PART_OF}
    words: dict[tuple[str, str], list[str]] = {}
    for predicate, tail, head in sorted(pairs):
        within = wholes.get(tail, tail) == wholes.get(head, head)
        if tail != head and within and (predicate, head, tail) not in pairs:
            words.setdefault((tail, head), []).append(predicate)
    return {ends: ", ".join(predicates) for ends, predicates in sorted(words.items())}


@dataclass(frozen=True, slots=True)
class Aspect:
    """Fact as seen from one of its objects.

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
    """Return those of ``facts`` that are about the vertex ``name`` and may change, states first, then relations."""
    found = [_aspect(anatomy, name, a) for a in facts if name in a.args and a.predicate in anatomy.changing]
    return sorted(
        found, key=lambda a: (a.other != "", not a.outward, a.other in anatomy.constants, a.other, a.words, a.atom)
    )


def _aspect(anatomy: Anatomy, name: str, atom: GroundAtom) -> Aspect:
    """Return the words of a fact without its two ends; ``(at cup1 shelf1 on)`` is *on*."""
    place = atom.args.index(name)
    other = _other_end(anatomy, atom, place)
    rest = [arg for index, arg in enumerate(atom.args) if index != place and index != other]
    words = " ".join(rest) if atom.predicate == AT and other is not None and rest else " ".join([atom.predicate, *rest])
    return Aspect(atom, "" if other is None else atom.args[other], words, other is None or place < other)


def _other_end(anatomy: Anatomy, atom: GroundAtom, place: int) -> int | None:
    """Return the argument that the fact relates the one at ``place`` to: an object, or a constant that comes first."""
    for index, arg in enumerate(atom.args):
        if index != place and arg not in anatomy.constants:
            return index
    if place > 0:
        return 0
    furniture = [i for i, a in enumerate(atom.args) if i and atom.predicate == AT and i < len(atom.args) - 1]
    return furniture[0] if furniture else None


# An object with more parts than this is drawn without those that nothing happens to.
MOST_VERTICES = 60


@dataclass(frozen=True, slots=True)
class GraphChanges:
    """Facts to mark: those that came to hold, and those that ended or are about to.

    A removed fact that no longer holds in the state drawn is shown as well, struck out.
    """

    added: Collection[GroundAtom] = field(default=frozenset())
    removed: Collection[GroundAtom] = field(default=frozenset())


class _Line(NamedTuple):
    """A line of a list; ``kind`` is ``name``, ``edge``, ``added``, ``removed`` or empty."""

    text: str
    kind: str = ""


def object_graph(world: World, state: State, name: str, changes: GraphChanges | None = None) -> str:
    """Draw an object: its parts, the edges between them, their states, and what it is related to.

    Args:
        world: The environment.
        state: What holds; ``world.task.decode(bits)`` for the bits of a task.
        name: The object, or a part of it.
        changes: What to mark.

    Returns:
        A ``<div>`` with a ``<ul>`` for the object and for each of its parts; their look is in
        :func:`tmd.view.markup.style`.

    Raises:
        KeyError: There is no such object.
    """
    return draw(anatomy(world.task.problem), state, name, changes)


def draw(graph: Anatomy, state: State, name: str, changes: GraphChanges | None = None) -> str:
    """Draw an object as :func:`object_graph` does, for many drawings of one environment.

    Raises:
        KeyError: There is no such object.
    """
    root = graph.whole(name)
    if root not in graph.classes:
        raise KeyError(name)
    changes = changes or GraphChanges()
    facts = state | frozenset(changes.removed)
    known = {vertex: aspects(graph, vertex, facts) for vertex in graph.vertices(root)}
    shared = {(a.atom.predicate, a.other) for a in known[root] if not a.outward}
    lists = []
    for vertex, told in known.items():
        kept = told if vertex == root else [a for a in told if a.outward or (a.atom.predicate, a.other) not in shared]
        if vertex == root or kept or len(known) <= MOST_VERTICES:
            lines = [_title(graph, vertex), *(_fact(aspect, state, changes) for aspect in kept), *_out(graph, vertex)]
            lists.append((vertex == root, lines))
    return macro("object_graph.html.j2", "graph", root, lists)


def _title(graph: Anatomy, vertex: str) -> _Line:
    name, kind = graph.short(vertex), graph.classes.get(vertex)
    return _Line(name if kind in (None, name) else f"{name}: {kind}", "name")


def _fact(aspect: Aspect, state: State, changes: GraphChanges) -> _Line:
    mark = "added" if aspect.atom in changes.added else "removed" if aspect.atom in changes.removed else ""
    if aspect.atom not in state:
        mark = "removed"
    if not aspect.other:
        return _Line(aspect.words, mark)
    return _Line(f"{aspect.words} → {aspect.other}" if aspect.outward else f"{aspect.words} ← {aspect.other}", mark)


def _out(graph: Anatomy, vertex: str) -> list[_Line]:
    """Return the edges that leave a vertex."""
    edges = graph.edges.items()
    return [_Line(f"{words} → {graph.short(head)}", "edge") for (tail, head), words in edges if tail == vertex]
