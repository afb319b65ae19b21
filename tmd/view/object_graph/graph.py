"""The object graph of one object, with what a step changed, as SVG (section III-B of the paper)."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from html import escape

from tmd.pddl.model import GroundAtom, State
from tmd.veil.world import World
from tmd.view.object_graph.anatomy import Anatomy, Aspect, Edge, anatomy, aspects
from tmd.view.object_graph.layout import LINE, PAD, VertexBox, place

LONGEST = 36
"""Longer lines are cut; the whole is shown when the pointer rests on it."""
MOST_VERTICES = 60
"""An object with more parts than this is drawn without those that nothing happens to."""
_MARGIN = 8
_SIGNS = {"added": "+ ", "removed": "− ", "": ""}


@dataclass(frozen=True, slots=True)
class GraphChanges:
    """What to mark: facts that came about, and facts that ceased to hold or are about to.

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
    """As :func:`object_graph`, for many drawings of one environment.

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
    inner = "".join(_edge(edge, boxes) for edge in edges)
    inner += "".join(_vertex(boxes[v], found, v == root) for v, found in lines.items())
    return _svg(root, max(b.right for b in boxes.values()), max(b.bottom for b in boxes.values()), inner)


def _all_lines(graph: Anatomy, state: State, root: str, changes: GraphChanges) -> dict[str, list[_Line]]:
    """For every vertex its name, then its facts."""
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


def _svg(name: str, right: int, bottom: int, inner: str) -> str:
    width, height = right + 2 * _MARGIN, bottom + 2 * _MARGIN
    return (
        f'<svg class="tmd-graph" role="img" aria-label="{escape(name)}" width="{width}" height="{height}" '
        f'viewBox="{-_MARGIN} {-_MARGIN} {width} {height}">{inner}</svg>'
    )


def _vertex(box: VertexBox, lines: list[_Line], is_root: bool) -> str:
    shape = f'<rect x="{box.x}" y="{box.y}" width="{box.width}" height="{box.height}" rx="4"/>'
    texts = "".join(_text(box.x + PAD, box.y + LINE * (place + 1) - 3, line, place) for place, line in enumerate(lines))
    return f'<g class="{"root" if is_root else "part"}">{shape}{texts}</g>'


def _text(x: int, y: int, line: _Line, place: int) -> str:
    shown = _cut(_signed(line))
    whole = f"<title>{escape(line.text)}</title>" if shown != _signed(line) else ""
    kind = f' class="{line.mark}"' if line.mark else ' class="name"' if place == 0 else ""
    sign = _SIGNS[line.mark]
    said = f"{sign}<tspan>{escape(shown[len(sign) :])}</tspan>" if line.mark == "removed" else escape(shown)
    return f'<text x="{x}" y="{y}"{kind}>{whole}{said}</text>'


def _edge(edge: Edge, boxes: Mapping[str, VertexBox]) -> str:
    """A curve with an arrow head and its word."""
    tail, head = boxes[edge.tail], boxes[edge.head]
    x, y, to_x, to_y = tail.right, tail.middle, head.x, head.middle
    if to_x <= x:
        return _bow(edge, tail, head)
    bend = (to_x - x) // 2
    path = f'<path d="M{x} {y}C{x + bend} {y} {to_x - bend} {to_y} {to_x - 5} {to_y}"/>'
    return f'<g class="edge">{path}{_arrow(to_x, to_y)}{_word(edge, x + bend, (y + to_y) // 2 - 3)}</g>'


def _bow(edge: Edge, tail: VertexBox, head: VertexBox) -> str:
    """An edge that leads back: below the boxes and around."""
    low = max(tail.bottom, head.bottom) + 6
    path = f'<path d="M{tail.x + tail.width // 2} {tail.bottom}V{low}H{head.x + head.width // 2}V{head.bottom}"/>'
    return f'<g class="edge back">{path}<title>{escape(edge.words)}</title></g>'


def _arrow(x: int, y: int) -> str:
    return f'<path class="head" d="M{x} {y}l-6 -3.5v7z"/>'


def _word(edge: Edge, x: int, y: int) -> str:
    return f'<text x="{x}" y="{y}" text-anchor="middle">{escape(edge.words)}</text>'
