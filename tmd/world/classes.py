"""Object classes as directed part graphs (section III-B): parts with states, edges of functional dependency.

``objects.yaml`` of a domain folder holds them. A class inherits the facts, states, parts and edges of its parent.
A part is itself of a class, so a stove says only that it has four burners and which knob controls which.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

from pydantic import BaseModel, ConfigDict, Field

from tmd.diagnostics import TmdError
from tmd.pddl.model import OBJECT
from tmd.pddl.reading.syntax import nearest
from tmd.world.shape import NAME, Shape
from tmd.world.yaml_positions import YamlSource

# The vertex of the whole object.
ROOT = "root"
# In a fact of a class: the vertex itself.
SELF = "self"
MAX_DEPTH = 32

# ``true``/``false`` for ``(p x)``; a name or names for ``(p x name)``.
StateValue: TypeAlias = bool | str | list[str]


class _VertexEntry(BaseModel):
    """The keys of parts and classes in ``objects.yaml``."""

    model_config = ConfigDict(defer_build=True, extra="forbid")
    facts: list[str] = []
    init: list[str] = []
    states: dict[str, StateValue] = {}
    shape: Shape | None = None


class PartEntry(_VertexEntry):
    """One part of a class, as ``objects.yaml`` has it."""

    class_name: str = Field(alias="class", pattern=NAME)


class ClassEntry(_VertexEntry):
    """One class, as ``objects.yaml`` has it."""

    parent: str | None = Field(default=None, pattern=NAME)
    parts: dict[str, PartEntry] = {}
    edges: list[str] = []


class ObjectsFile(BaseModel):
    """The content of ``objects.yaml``."""

    model_config = ConfigDict(defer_build=True, extra="forbid")
    substances: dict[str, str] = {}
    facts: list[str] = []
    init: list[str] = []
    derive: list[str] = []
    classes: dict[str, ClassEntry] = {}


@dataclass(frozen=True, slots=True)
class Vertex:
    """A part of an object: its class, what always holds of it, the states it starts in, and what it looks like.

    ``facts`` and ``init`` are atoms as tuples, with ``self`` for the vertex, ``root`` and part names for others.
    """

    name: str
    class_name: str
    facts: tuple[tuple[str, ...], ...] = ()
    init: tuple[tuple[str, ...], ...] = ()
    states: Mapping[str, StateValue] = field(default_factory=dict)
    shape: Shape | None = None


@dataclass(frozen=True, slots=True)
class ObjectClass:
    """A class of objects: a directed graph over its parts.

    Attributes:
        vertices: The parts by name, ``root`` first.
        edges: ``(predicate, tail, head, *more)``; acting on the tail changes the head.
    """

    name: str
    parent: str
    vertices: Mapping[str, Vertex]
    edges: tuple[tuple[str, ...], ...]


class Classes:
    """All object classes of a domain.

    ``types`` are those that the domain's instructions know already, with their parents.

    Raises:
        TmdError: With the place in ``objects.yaml`` of what does not fit.
    """

    def __init__(self, source: YamlSource, types: Mapping[str, str]) -> None:
        self.source = source
        self.entries = source.load(ObjectsFile, optional=("shape", "facts", "init", "states", "edges"))
        self._types = types
        self._resolved: dict[str, ObjectClass] = {}
        for name in self.entries.classes:
            source.recover(None, self._check_name, name)
            source.recover(None, self.get, name)

    def new_types(self) -> Iterator[tuple[str, str]]:
        """Yield the types that classes add, with their parents, parents first."""
        done: set[str] = set()
        for name in self.entries.classes:
            for ancestor in reversed(self.line(name)):
                if ancestor not in done and ancestor not in self._types and ancestor != OBJECT:
                    done.add(ancestor)
                    yield ancestor, self._parent(ancestor)

    def get(self, name: str) -> ObjectClass:
        """Return the class ``name`` with all it inherits.

        Raises:
            TmdError: There is no such class.
        """
        if name not in self._resolved:
            if name not in self.entries.classes and name not in self._types:
                raise self._unknown(("classes",), f"there is no class '{name}'", name)
            self._resolved[name] = self._resolve(name)
        return self._resolved[name]

    def is_below(self, name: str, above: str) -> bool:
        """Return whether ``name`` is the class or type ``above``, or inherits from it.

        Raises:
            TmdError: There is no class ``name``.
        """
        return above in self.line(name)

    def _unknown(self, path: Sequence[str], message: str, name: str) -> TmdError:
        """Return the fault of a name that is not that of a class, with the nearest one."""
        return self.source.error(path, message, nearest(name, [*self.entries.classes, *self._types]), "unknown-class")

    def _check_name(self, name: str) -> None:
        if not re.match(NAME, name) or name in (ROOT, SELF):
            raise self.source.error(
                ("classes", name), f"'{name}' cannot name a class", "use lower-case letters, digits and _", "bad-name"
            )

    def _parent(self, name: str) -> str:
        entry = self.entries.classes.get(name)
        if entry is not None and entry.parent is not None:
            return entry.parent
        if name in self._types:
            return self._types[name]
        raise self.source.error(
            ("classes", name), f"class '{name}' has no parent", "add `parent: TYPE`", "unknown-class"
        )

    def line(self, name: str) -> list[str]:
        """Return ``name`` and its ancestors, nearest first.

        Raises:
            TmdError: There is no such class, or it is its own ancestor.
        """
        line = [name]
        while line[-1] != OBJECT:
            parent = self._parent(line[-1])
            if parent in line or len(line) > MAX_DEPTH:
                message = f"class '{name}' is its own ancestor"
                raise self.source.error(("classes", name), message, "change a parent", "class-cycle")
            if parent not in self.entries.classes and parent not in self._types and parent != OBJECT:
                message = f"there is no class or type '{parent}'"
                raise self._unknown(("classes", line[-1], "parent"), message, parent)
            line.append(parent)
        return line

    def _resolve(self, name: str) -> ObjectClass:
        facts: list[tuple[str, ...]] = []
        init: list[tuple[str, ...]] = []
        states: dict[str, StateValue] = {}
        parts: dict[str, Vertex] = {}
        edges: list[tuple[str, ...]] = []
        shape: Shape | None = None
        for ancestor in reversed(self.line(name)):
            entry = self.entries.classes.get(ancestor)
            if entry is None:
                continue
            facts += [_words(fact) for fact in entry.facts]
            init += [_words(fact) for fact in entry.init]
            states |= entry.states
            shape = shape if entry.shape is None else entry.shape.over(shape)
            for part, said in entry.parts.items():
                vertex = self.source.recover(None, self._part, ancestor, part, said)
                if vertex is not None:
                    parts[part] = vertex
            for index, edge in enumerate(entry.edges):
                read = self.source.recover(None, self._edge, ancestor, index, edge, parts)
                edges += [read] if read is not None else []
        root = Vertex(ROOT, name, tuple(facts), tuple(init), states, shape)
        return ObjectClass(name, self.line(name)[1], {ROOT: root} | parts, tuple(edges))

    def _part(self, owner: str, part: str, said: PartEntry) -> Vertex:
        self._check_name(part)
        path, name = ("classes", owner, "parts", part), said.class_name
        if name not in self.entries.classes:
            raise self._unknown(path, f"there is no class '{name}'", name)
        if owner in self.line(name):
            raise self.source.error(path, f"'{owner}' cannot be its own part", code="class-cycle")
        own = self.get(name)
        if len(own.vertices) > 1:
            raise self.source.error(path, f"'{name}' has parts; a part cannot have any")
        base = own.vertices[ROOT]
        return Vertex(
            part,
            said.class_name,
            base.facts + tuple(map(_words, said.facts)),
            base.init + tuple(map(_words, said.init)),
            {**base.states, **said.states},
            base.shape if said.shape is None else said.shape.over(base.shape),
        )

    def _edge(self, owner: str, index: int, edge: str, parts: Mapping[str, Vertex]) -> tuple[str, ...]:
        words, path = _words(edge), ("classes", owner, "edges", index)
        if len(words) < 3:
            raise self.source.error(path, f"'{edge}' is not an edge", "write `tail predicate head`")
        tail, predicate, head, *more = words
        for vertex in (tail, head):
            if vertex != ROOT and vertex not in parts:
                hint = nearest(vertex, [ROOT, *parts])
                raise self.source.error(path, f"'{owner}' has no part '{vertex}'", hint, "unknown-part")
        return (predicate, tail, head, *more)


def _words(fact: str) -> tuple[str, ...]:
    """Return ``allows self on`` (brackets may stand around it) as a tuple."""
    return tuple(fact.strip().strip("()").split())
