"""The object graph of one object, as SVG: its parts, where they are drawn, and which facts are states or edges."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from tmd.pddl.model import GroundAtom, Problem, State
from tmd.view.markup import macro
from tmd.world.compile import AT, PART_OF
from tmd.world.world import World


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
        """Return the object that ``name`` is a part of, or ``name`` itself."""
        return self.wholes.get(name, name)

    def vertices(self, name: str) -> tuple[str, ...]:
        """Return the object ``name`` and its parts."""
        return (name, *self.parts.get(name, ()))

    def short(self, name: str) -> str:
        """Return the name of a part without that of its whole: ``door`` for ``fridge1_door``."""
        whole = self.whole(name)
        return name.removeprefix(f"{whole}_") if whole != name else name

    def things(self, atom: GroundAtom) -> list[str]:
        """Return the objects that a fact is about, wholes for parts, each once; constants are none."""
        return list(dict.fromkeys(self.whole(a) for a in atom.args if a in self.classes and a not in self.constants))


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


def _edges(static: Iterable[GroundAtom], wholes: Mapping[str, str]) -> dict[str, tuple[Edge, ...]]:
    """Return the static facts between two parts of one object, without those that hold both ways."""
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


# Width in pixels of a character of the graph's type, 11 pixels high.
CHARACTER = 6.7
# Height of a line of text in pixels.
LINE = 16
PAD = 7
GAP_X, GAP_Y = 26, 12


@dataclass(frozen=True, slots=True)
class VertexBox:
    """A vertex: where it stands and how large it is, in pixels."""

    x: int
    y: int
    width: int
    height: int

    @property
    def right(self) -> int:
        """Its right edge."""
        return self.x + self.width

    @property
    def bottom(self) -> int:
        """Its lower edge."""
        return self.y + self.height

    @property
    def middle(self) -> int:
        """Half way down."""
        return self.y + self.height // 2


def place(root: str, sizes: Mapping[str, tuple[int, int]], edges: Sequence[Edge]) -> dict[str, VertexBox]:
    """Return a box for every vertex.

    What an edge leads to stands right of where it comes from. The object itself stands last, unless it leads on.

    Args:
        root: The vertex that is the whole object.
        sizes: For every vertex characters and lines of its text.
        edges: The edges between them.
    """
    boxes: dict[str, VertexBox] = {}
    x = 0
    columns = _columns(root, list(sizes), edges)
    heights = {name: lines * LINE + PAD for name, (_, lines) in sizes.items()}
    tallest = max(sum(heights[n] + GAP_Y for n in column) for column in columns)
    for number, column in enumerate(columns):
        width = max(round(sizes[name][0] * CHARACTER) + 2 * PAD for name in column)
        y = (tallest - sum(heights[name] + GAP_Y for name in column)) // 2
        for name in column:
            boxes[name] = VertexBox(x, y, width, heights[name])
            y += heights[name] + GAP_Y
        x += width + _gap(column, columns[number + 1 :], edges)
    return boxes


def _gap(column: Sequence[str], later: Sequence[Sequence[str]], edges: Sequence[Edge]) -> int:
    """Return the room for the words on the edges that leave a column."""
    words = [len(edge.words) for edge in edges if edge.tail in column and any(edge.head in c for c in later)]
    return GAP_X + round(max(words, default=0) * CHARACTER)


def _columns(root: str, names: Sequence[str], edges: Sequence[Edge]) -> list[list[str]]:
    depth = _depths(root, names, edges)
    columns: list[list[str]] = []
    for level in sorted(set(depth.values())):
        members = sorted((name for name in names if depth[name] == level), key=_natural)
        rank = {name: place for column in columns for place, name in enumerate(column)}
        columns.append(sorted(members, key=lambda name: _mean_of_tails(name, edges, rank)))
    return columns


def _depths(root: str, names: Sequence[str], edges: Sequence[Edge]) -> dict[str, int]:
    """Return the longest way to each vertex; a cycle ends it after as many steps as there are vertices."""
    depth = dict.fromkeys(names, 0)
    for _ in names:
        for edge in edges:
            if edge.head in depth and edge.tail in depth:
                depth[edge.head] = min(max(depth[edge.head], depth[edge.tail] + 1), len(names))
    if len(names) > 1 and root not in {edge.tail for edge in edges}:
        depth[root] = max(depth[root], *(d for name, d in depth.items() if name != root), 1)
    return depth


def _mean_of_tails(name: str, edges: Sequence[Edge], rank: Mapping[str, int]) -> float:
    tails = [rank[edge.tail] for edge in edges if edge.head == name and edge.tail in rank]
    return sum(tails) / len(tails) if tails else float(len(rank))


def _natural(name: str) -> tuple[tuple[bool, int, str], ...]:
    """Return a sort key with numbers as numbers: ``burner2`` before ``burner10``."""
    return tuple(
        (piece.isdigit(), int(piece) if piece.isdigit() else 0, piece) for piece in re.split(r"([0-9]+)", name)
    )


# Longer lines are cut; the whole is shown when the pointer rests on it.
LONGEST = 36
# An object with more parts than this is drawn without those that nothing happens to.
MOST_VERTICES = 60
_MARGIN = 8
_SIGNS = {"added": "+ ", "removed": "− ", "": ""}


@dataclass(frozen=True, slots=True)
class GraphChanges:
    """Facts to mark: those that came to hold, and those that ended or are about to.

    A removed fact that no longer holds in the state drawn is shown as well, struck out.
    """

    added: Collection[GroundAtom] = field(default=frozenset())
    removed: Collection[GroundAtom] = field(default=frozenset())


@dataclass(frozen=True, slots=True)
class _Line:
    text: str
    mark: str = ""


def object_graph(world: World, state: State, name: str, changes: GraphChanges | None = None) -> str:
    """Draw an object: its parts, the edges between them, their states, and what it is related to.

    Args:
        world: The environment.
        state: What holds; ``world.task.decode(bits)`` for the bits of a task.
        name: The object, or a part of it.
        changes: What to mark.

    Returns:
        An ``<svg>`` element; its colours are in :func:`tmd.view.markup.style`.

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
    lines = _all_lines(graph, state, root, changes or GraphChanges())
    edges = [edge for edge in graph.edges.get(root, ()) if edge.tail in lines and edge.head in lines]
    sizes = {v: (max(len(_cut(_signed(line))) for line in found), len(found)) for v, found in lines.items()}
    boxes = place(root, sizes, edges)
    curves = [_Curve(edge, boxes[edge.tail], boxes[edge.head]) for edge in edges]
    vertices = [(v == root, boxes[v], _placed(boxes[v], found)) for v, found in lines.items()]
    right, bottom = max(b.right for b in boxes.values()), max(b.bottom for b in boxes.values())
    size = right + 2 * _MARGIN, bottom + 2 * _MARGIN, -_MARGIN
    return macro("object_graph.html.j2", "graph", root, size, curves, vertices)


def _all_lines(graph: Anatomy, state: State, root: str, changes: GraphChanges) -> dict[str, list[_Line]]:
    """Return for every vertex its name, then its facts."""
    facts = state | frozenset(changes.removed)
    known = {vertex: aspects(graph, vertex, facts) for vertex in graph.vertices(root)}
    shared = {(a.atom.predicate, a.other) for a in known[root] if not a.outward}
    found = {}
    for vertex, told in known.items():
        kept = told if vertex == root else [a for a in told if a.outward or (a.atom.predicate, a.other) not in shared]
        if vertex == root or kept or len(known) <= MOST_VERTICES:
            found[vertex] = [_title(graph, vertex), *(_fact(aspect, state, changes) for aspect in kept)]
    return found


def _title(graph: Anatomy, vertex: str) -> _Line:
    name, kind = graph.short(vertex), graph.classes.get(vertex)
    return _Line(name if kind in (None, name) else f"{name}: {kind}")


def _fact(aspect: Aspect, state: State, changes: GraphChanges) -> _Line:
    mark = "added" if aspect.atom in changes.added else "removed" if aspect.atom in changes.removed else ""
    if aspect.atom not in state:
        mark = "removed"
    if not aspect.other:
        return _Line(aspect.words, mark)
    return _Line(f"{aspect.words} → {aspect.other}" if aspect.outward else f"{aspect.words} ← {aspect.other}", mark)


def _signed(line: _Line) -> str:
    return _SIGNS[line.mark] + line.text


def _cut(text: str) -> str:
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 1]}…"


def _placed(box: VertexBox, lines: Sequence[_Line]) -> list[tuple[int, int, str, str, str, str]]:
    """Return each line of a vertex: x, y, its class, the whole text if it is cut, its sign, the text."""
    found = []
    for place, line in enumerate(lines):
        shown, sign = _cut(_signed(line)), _SIGNS[line.mark]
        whole = line.text if shown != _signed(line) else ""
        kind = line.mark or ("name" if place == 0 else "")
        found.append((box.x + PAD, box.y + LINE * (place + 1) - 3, kind, whole, sign, shown[len(sign) :]))
    return found


@dataclass(frozen=True, slots=True)
class _Curve:
    """Curve of an edge from one box to another: to the right, or, where that is not possible, below both."""

    edge: Edge
    tail: VertexBox
    head: VertexBox

    @property
    def back(self) -> bool:
        return self.head.x <= self.tail.right

    @property
    def path(self) -> str:
        tail, head = self.tail, self.head
        if self.back:
            low = max(tail.bottom, head.bottom) + 6
            return f"M{tail.x + tail.width // 2} {tail.bottom}V{low}H{head.x + head.width // 2}V{head.bottom}"
        bend = (head.x - tail.right) // 2
        first, second = f"{tail.right + bend} {tail.middle}", f"{head.x - bend} {head.middle}"
        return f"M{tail.right} {tail.middle}C{first} {second} {head.x - 5} {head.middle}"

    @property
    def middle(self) -> tuple[int, int]:
        """The place of its words."""
        tail, head = self.tail, self.head
        return tail.right + (head.x - tail.right) // 2, (tail.middle + head.middle) // 2 - 3
