"""Where the vertices of an object graph are drawn: in layers, edges from left to right."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tmd.view.object_graph.anatomy import Edge

CHARACTER = 6.7
"""Width in pixels of a character of the graph's type, 11 pixels high."""
LINE = 16
"""Height of a line of text in pixels."""
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
    """A box for every vertex.

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
    """Room for the words on the edges that leave a column."""
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
    """The longest way to each vertex; a cycle ends it after as many steps as there are vertices."""
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
    """Numbers in a name count as numbers: ``burner2`` stands before ``burner10``."""
    return tuple(
        (piece.isdigit(), int(piece) if piece.isdigit() else 0, piece) for piece in re.split(r"([0-9]+)", name)
    )
