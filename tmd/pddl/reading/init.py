"""Reading the initial state of a problem, and the values of its cost functions."""

from __future__ import annotations

from collections.abc import Iterable

from tmd.diagnostics import Location, TmdError
from tmd.pddl.model import TOTAL_COST, GroundAtom
from tmd.pddl.reading.formulas import read_atom
from tmd.pddl.reading.names import read_number, unsupported
from tmd.pddl.reading.sections import only_part
from tmd.pddl.reading.syntax import Group, Node, Source, Word


class InitReader:
    """Collects the initial state, where each entry stands, and the values of cost functions."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.atoms: dict[GroundAtom, None] = {}
        self.denied: dict[GroundAtom, None] = {}
        self.values: dict[GroundAtom, int] = {}
        self.locations: dict[GroundAtom, Location] = {}

    def read(self, group: Group) -> None:
        """Take in ``(:init ...)``.

        Raises:
            TmdError: An entry is not a ground atom or value, or contradicts another one.
        """
        for node in _spread(group.parts[1:]):
            self.source.recover(None, self._read_entry, node)
        for atom in self.denied:
            if atom in self.atoms:
                self.source.fault(self._contradiction(atom))

    def _read_entry(self, node: Node) -> None:
        if isinstance(node, Word):
            raise self.source.error(f'expected an atom, found "{node.text}"', node.location, f"write ({node.text})")
        if node.head in ("unknown", "oneof") and any(isinstance(p, Group) for p in node.parts):
            raise unsupported(self.source, "uncertain initial states", node.head, node.location)
        if node.head == "=":
            self._read_value(node)
        elif node.head == "at" and len(node.parts) == 3 and isinstance(node.parts[2], Group):
            raise unsupported(self.source, "timed initial literals", "at", node.location)
        elif node.head == "not":
            inner = only_part(node, self.source)
            if isinstance(inner, Word):
                raise self.source.error("expected (not (predicate ...))", inner.location)
            self.denied[self._ground(inner)] = None
        elif node.head in ("or", "forall", "exists", "imply", "when"):
            raise self.source.error(f'"{node.head}" cannot stand in :init', node.location, "list the atoms that hold")
        else:
            self.atoms[self._ground(node)] = None

    def _ground(self, node: Group) -> GroundAtom:
        atom = read_atom(node, self.source)
        for term in atom.terms:
            if term.startswith("?"):
                hint = "write the name of an object"
                raise self.source.error(f'variable "{term}" in :init', node.location, hint, "free-variable")
        ground = GroundAtom(atom.predicate, atom.terms)
        self.locations.setdefault(ground, node.location)
        return ground

    def _read_value(self, node: Group) -> None:
        if len(node.parts) != 3 or isinstance(node.parts[1], Word):
            raise self.source.error("expected (= (function object ...) number)", node.location)
        number = read_number(node.parts[2], self.source)
        if number is None:
            raise unsupported(self.source, "object fluents", node.parts[1].head, node.location, "give a number")
        function = self._ground(node.parts[1])
        if function == GroundAtom(TOTAL_COST):
            if number:
                raise self.source.error(f"{TOTAL_COST} begins at 0", node.location)
            return
        if function in self.values:
            raise self.source.error(f"the value of {function} is given twice", node.location)
        self.values[function] = number

    def _contradiction(self, atom: GroundAtom) -> TmdError:
        message = f"{atom} is said to hold and not to hold"
        return self.source.error(message, self.locations[atom], "remove one of the two", "contradictory-init")


def _spread(nodes: Iterable[Node]) -> list[Node]:
    """``(and a b)`` in :init is the same as ``a b``."""
    found: list[Node] = []
    for node in nodes:
        found.extend(node.parts[1:] if isinstance(node, Group) and node.head == "and" else [node])
    return found
