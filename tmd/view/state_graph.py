"""Drawings of a plan: a PDDL state as a graph, and a row for each object with a mark at each step that names it.

Objects are nodes, facts of two objects are edges, the other facts are in the nodes.
The nodes keep their places while a plan goes on: they are laid out once, for all of its states.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import atan2, ceil, cos, sin

from tmd.goals.wording import Wording
from tmd.pddl.model import GroundAtom, Instruction, Problem, State
from tmd.view.markup import macro

# Objects that are drawn at most: with more, nothing can be read.
MOST = 80
# Facts that no action changes are drawn up to this number of facts.
_FEW = 150
# Pixels: of a character, of a line, and around the words of a node.
_CHARACTER, _LINE, _MARGIN = 7.6, 15, 8
# Pixels of an inch, in which Graphviz measures.
_INCH = 72
# Seconds that Graphviz may take.
_PATIENCE = 10
# Pixels: the width of a row of parts of a graph, and between two parts.
_WIDTH, _GAP = 760, 26
# Pixels: the length of the head of an arrow.
_HEAD = 9
# Lines of facts in a node.
_LINES = 4
_KINDS = 6
_WORDS = re.compile(r'"[^"]*"|\S+')

Point = tuple[float, float]
Places = dict[str, Point]
Layout = Callable[[Mapping[str, Point], Iterable[tuple[str, str]]], Places]


@dataclass(frozen=True, slots=True)
class _Edge:
    """A fact of two objects or more, as it is drawn."""

    x: float
    y: float
    to_x: float
    to_y: float
    words: str
    change: str
    head: str


def _always(problem: Problem, atoms: Iterable[GroundAtom]) -> set[GroundAtom]:
    """Return the facts that no action changes."""
    changing = {effect.atom.predicate for action in problem.domain.actions for effect in action.effects}
    changing |= {axiom.head.predicate for axiom in problem.domain.derived}
    return {atom for atom in atoms if atom.predicate not in changing}


class StateGraph:
    """The layout of some states of a problem.

    What is in none of them is not drawn. Where there are too many objects, those ``first`` are drawn before others.
    """

    def __init__(self, problem: Problem, states: Sequence[State], first: Iterable[str] = ()) -> None:
        atoms = sorted({atom for state in states for atom in state})
        self._always = _always(problem, atoms) if len(atoms) > _FEW else set()
        names = self._named(problem, atoms, first)
        self.left_out = max(len(names) - MOST, 0)
        kinds = {each.name: each.types[0] if each.types else "object" for each in problem.all_objects()}
        self._kinds = {name: kinds[name] for name in names[:MOST]}
        self._colours = {kind: n % _KINDS for n, kind in enumerate(sorted(set(self._kinds.values())))}
        self._sizes = self._room(states)
        pairs = dict.fromkeys(pair for atom in atoms if (pair := self._pair(atom)) is not None)
        self._places = placed(self._sizes, pairs)

    def _named(self, problem: Problem, atoms: Sequence[GroundAtom], first: Iterable[str]) -> list[str]:
        """Return the objects, those first that are wanted first, then those of facts that change."""
        constants = {each.name for each in problem.domain.constants}
        every = [each.name for each in problem.all_objects()]
        seen = (atom for atom in atoms if atom not in self._always)
        used = [name for facts in (seen, atoms) for atom in facts for name in atom.args]
        wanted = [name for name in first if name in every]
        return [name for name in dict.fromkeys([*wanted, *used, *every]) if name not in constants]

    def _room(self, states: Sequence[State]) -> dict[str, tuple[float, float]]:
        """Return the width and the height of each node, in pixels: enough for its words in any state."""
        lines: dict[str, int] = dict.fromkeys(self._kinds, 0)
        width = {name: float(len(name)) for name in self._kinds}
        for state in states:
            for name, words in self._words(state).items():
                lines[name] = max(lines[name], len(words))
                width[name] = max([width[name], *(len(each) * 0.75 for each in words)])
        return {
            name: (width[name] * _CHARACTER + 2 * _MARGIN, (1 + lines[name]) * _LINE + _MARGIN) for name in self._kinds
        }

    def _pair(self, atom: GroundAtom) -> tuple[str, str] | None:
        """Return the two objects that an edge for a fact joins; ``None`` where it has no edge."""
        if atom in self._always:
            return None
        ends = [name for name in atom.args if name in self._kinds]
        return (ends[0], ends[1]) if len(ends) > 1 and ends[0] != ends[1] else None

    def _words(self, state: State) -> dict[str, list[str]]:
        """Return the facts that have no edge, by the object whose node has them."""
        found: dict[str, list[str]] = {name: [] for name in self._kinds}
        for atom in sorted(state - self._always):
            if atom.args and atom.args[0] in found and self._pair(atom) is None:
                found[atom.args[0]].append(" ".join((atom.predicate, *atom.args[1:])))
        return {
            name: words if len(words) <= _LINES else [*words[: _LINES - 1], f"and {len(words) - _LINES + 1} more"]
            for name, words in found.items()
        }

    def svg(self, state: State, before: State | None = None, marked: str | None = None, title: str = "") -> str:
        """Draw a state as SVG.

        What came and went since the state ``before`` the last step is marked; an object that is ``marked`` is pointed
        at.
        """
        came = state - before if before is not None else frozenset[GroundAtom]()
        went = before - state if before is not None else frozenset[GroundAtom]()
        edges: dict[tuple[str, str, str], list[str]] = {}
        for atom in sorted(state | went):
            pair = self._pair(atom)
            if pair is not None:
                change = "came" if atom in came else "went" if atom in went else ""
                words = " ".join((atom.predicate, *(name for name in atom.args if name not in pair)))
                edges.setdefault((*pair, change), []).append(words)
        drawn = []
        for (one, other, change), told in edges.items():
            both = edges.get((other, one, change)) == told
            if not both or one < other:
                drawn.append(self._edge(one, other, ", ".join(told), change, both=both))
        changed = {name for atom in came | went for name in atom.args}
        facts, alone = self._words(state), [atom.predicate for atom in sorted(state) if not atom.args]
        nodes = [
            (name, *self._places[name], *self._sizes[name], kind, self._colours[kind], facts[name], name in changed)
            for name, kind in self._kinds.items()
        ]
        width = max((x + w / 2 for _, x, _, w, *_ in nodes), default=0.0) + _MARGIN
        height = max((y + h / 2 for _, _, y, _, h, *_ in nodes), default=0.0) + _MARGIN
        note = f"{self.left_out} more objects are not drawn." if self.left_out else ""
        return macro("state.html.j2", "graph", nodes, drawn, width, height, marked, title, alone, note)

    def _edge(self, one: str, other: str, words: str, change: str, *, both: bool) -> _Edge:
        """Return an edge, from border to border of the two nodes."""
        begin, end = self._border(one, other), self._border(other, one)
        return _Edge(*begin, *end, words, change, "" if both else _head(begin, end))

    def _border(self, name: str, towards: str) -> Point:
        (x, y), (to_x, to_y) = self._places[name], self._places[towards]
        width, height = self._sizes[name]
        far = max(abs(to_x - x) / (width / 2), abs(to_y - y) / (height / 2), 1.0)
        return x + (to_x - x) / far, y + (to_y - y) / far


def _head(begin: Point, end: Point) -> str:
    """Return the corners of the head of an arrow, as SVG has them."""
    (x, y), angle = end, atan2(end[1] - begin[1], end[0] - begin[0])
    corners = [(x - _HEAD * cos(angle + turn), y - _HEAD * sin(angle + turn)) for turn in (-0.4, 0.4)]
    return " ".join(f"{a:.1f},{b:.1f}" for a, b in (end, *corners))


def placed(sizes: Mapping[str, Point], pairs: Iterable[tuple[str, str]], layout: Layout | None = None) -> Places:
    """Place nodes: each connected part by itself, the largest first, from left to right in rows.

    ``layout`` places the nodes of one part: Graphviz where it is installed, else networkx.
    """
    import networkx

    graph = networkx.DiGraph()
    graph.add_nodes_from(sizes)
    graph.add_edges_from(pairs)
    parts = sorted(networkx.weakly_connected_components(graph), key=len, reverse=True)
    order = {name: number for number, name in enumerate(sizes)}
    lay_out = layout or (by_graphviz if shutil.which("dot") else by_networkx)
    found: Places = {}
    left = top = high = 0.0
    for part in parts:
        part_sizes = {name: sizes[name] for name in sorted(part, key=order.__getitem__)}
        own = [pair for pair in graph.edges if pair[0] in part]
        places = lay_out(part_sizes, own) if own else dict.fromkeys(part_sizes, (0.0, 0.0))
        (low_x, high_x), (low_y, high_y) = (_extent(places, sizes, axis) for axis in (0, 1))
        if left and left + high_x - low_x > _WIDTH:
            left, top, high = 0.0, top + high + _GAP, 0.0
        for name, (x, y) in places.items():
            found[name] = round(x - low_x + left + _MARGIN, 1), round(y - low_y + top + _MARGIN + _LINE, 1)
        left, high = left + high_x - low_x + _GAP, max(high, high_y - low_y)
    return found


def _extent(places: Places, sizes: Mapping[str, Point], axis: int) -> Point:
    """Return the least and the greatest coordinate of the borders of some nodes."""
    ends = [place[axis] + sign * sizes[name][axis] / 2 for name, place in places.items() for sign in (-1, 1)]
    return min(ends), max(ends)


def by_graphviz(sizes: Mapping[str, Point], pairs: Iterable[tuple[str, str]]) -> Places:
    """Place nodes by ``dot`` of Graphviz, or by networkx where that fails."""
    numbers = {name: number for number, name in enumerate(sizes)}
    nodes = (f"{numbers[n]} [width={w / _INCH:.3f}, height={h / _INCH:.3f}]" for n, (w, h) in sizes.items())
    arrows = (f"{numbers[one]} -> {numbers[other]}" for one, other in _stacked(sizes, pairs))
    text = "\n".join(("digraph {", "nodesep=0.45 ranksep=0.6 node [shape=box fixedsize=true]", *nodes, *arrows, "}"))
    try:
        done = subprocess.run(
            ["dot", "-Tplain"], input=text, capture_output=True, text=True, timeout=_PATIENCE, check=True
        )
    except (OSError, subprocess.SubprocessError):
        return by_networkx(sizes, pairs)
    lines = [_WORDS.findall(line) for line in done.stdout.splitlines()]
    found = {int(line[1]): (float(line[2]) * _INCH, -float(line[3]) * _INCH) for line in lines if line[0] == "node"}
    return {name: found[number] for name, number in numbers.items()}


def _stacked(sizes: Mapping[str, Point], pairs: Iterable[tuple[str, str]]) -> list[tuple[str, str]]:
    """Return edges for a layout in which many nodes that hang on one other node stand in several ranks.

    Each node of a further rank hangs on one of the rank before.
    """
    found = list(pairs)
    edges = Counter(name for pair in found for name in pair)
    hanging: dict[tuple[str, int], list[int]] = {}
    for number, pair in enumerate(found):
        leaf = next((end for end in (0, 1) if edges[pair[end]] == 1), None)
        if leaf is not None:
            hanging.setdefault((pair[1 - leaf], leaf), []).append(number)
    for (_, leaf), numbers in hanging.items():
        leaves = [found[number][leaf] for number in numbers]
        ranks = ceil(sum(sizes[name][0] + _GAP for name in leaves) / _WIDTH)
        many = ceil(len(leaves) / ranks)
        for number, name, before in zip(numbers[many:], leaves[many:], leaves, strict=False):
            found[number] = (name, before) if leaf == 0 else (before, name)
    return found


def by_networkx(sizes: Mapping[str, Point], pairs: Iterable[tuple[str, str]]) -> Places:
    """Place nodes as if the edges were springs, as far apart as their sizes need."""
    import networkx

    graph = networkx.Graph()
    graph.add_nodes_from(sizes)
    graph.add_edges_from(pairs)
    found = {name: (float(x), float(y)) for name, (x, y) in networkx.spring_layout(graph, seed=0).items()}
    scale, names = 150.0, list(sizes)
    for number, one in enumerate(names):
        for other in names[number + 1 :]:
            (x, y), (to_x, to_y) = found[one], found[other]
            wide, high = ((sizes[one][axis] + sizes[other][axis]) / 2 + _MARGIN for axis in (0, 1))
            scale = max(scale, min(wide / max(abs(x - to_x), 1e-3), high / max(abs(y - to_y), 1e-3)))
    return {name: (scale * x, scale * y) for name, (x, y) in found.items()}


def object_rows(plan: Sequence[Instruction], problem: Problem, current: int, wording: Wording, link: str = "") -> str:
    """Render the objects of a plan as rows and its steps as columns; empty for an empty plan.

    ``current`` is the number of the step that is looked at, from 1; 0 for none. ``link`` is the beginning of the
    address of a step; without it a step is a mark of the studio's page. Constants of the domain have no row.
    """
    constants = {each.name for each in problem.domain.constants}
    rows: dict[str, dict[int, str]] = {}
    for number, instruction in enumerate(plan, start=1):
        for name in instruction.args:
            if name not in constants:
                rows.setdefault(name, {})[number] = wording.instruction(instruction)
    return macro("state.html.j2", "object_rows", rows, len(plan), current, link) if rows else ""
