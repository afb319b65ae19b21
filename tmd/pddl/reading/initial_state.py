"""Reading ``(:init ...)``: the atoms that hold, and the values of cost functions."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import takewhile

from tmd.diagnostics import Edit, Location
from tmd.pddl.model import TOTAL_COST, Domain, GroundAtom
from tmd.pddl.reading.formulas import ASSIGNED, read_atom, read_number, truth_value, unsupported
from tmd.pddl.reading.infix import atom_of_words
from tmd.pddl.reading.syntax import Group, Node, Source, Word, after, replaced, shifted


class InitReader:
    """Collects the initial state, where each entry stands, and the values of cost functions."""

    def __init__(self, source: Source, domain: Domain) -> None:
        self.source = source
        self.predicates = {p.name: len(p.parameters) for p in domain.predicates}
        self.functions = {f.name for f in domain.functions} - self.predicates.keys()
        self.atoms: dict[GroundAtom, None] = {}
        self.denied: dict[GroundAtom, None] = {}
        self.values: dict[GroundAtom, int] = {}
        self.twice: list[tuple[GroundAtom, Location]] = []
        self.locations: dict[GroundAtom, Location] = {}

    def read(self, group: Group) -> None:
        """Read ``(:init ...)``.

        Raises:
            TmdError: An entry is not a ground atom or value, or contradicts another one.
        """
        for node in _spread(group.parts[1:], self.source):
            self.source.recover(None, self._read_entry, node)
        for atom in self.denied:
            if atom in self.atoms:
                message = f"{atom} is said to hold and not to hold"
                hint = "remove one of the two"
                self.source.fault_at(message, self.locations[atom], hint, "contradictory-init")
        if self.twice:
            atom, place = self.twice[0]
            more = f", and so do {len(self.twice) - 1} more" if len(self.twice) > 1 else ""
            self.source.warn(f"{atom} stands twice in :init{more}", place, "remove one of the two", "said-twice")

    def _read_entry(self, node: Node) -> None:
        if isinstance(node, Word):
            hint = f"write ({node.text})" if node.text.strip(".") else "write out what is left out"
            if node.text == ".":
                edits = [replaced(node, "")]
                raise self.source.error("an atom has no full stop", node.location, "remove it", "syntax", edits)
            raise self.source.error(f'expected an atom, found "{node.text}"', node.location, hint)
        node = self._in_pddl(node)
        if node.head in ("unknown", "oneof") and any(isinstance(p, Group) for p in node.parts):
            raise unsupported(self.source, "uncertain initial states", node.head, node.location)
        if node.head == "=":
            self._read_value(node)
        elif node.head == "at" and len(node.parts) == 3 and isinstance(node.parts[2], Group):
            raise unsupported(self.source, "timed initial literals", "at", node.location)
        elif node.head == "not":
            inner = node.parts[-1]
            if isinstance(inner, Word) or len(node.parts) != 2:
                hint = "write one atom in it"
                raise self.source.error("expected (not (predicate ...))", inner.location, hint)
            self._note(self._ground(inner), self.denied, node.location)
        elif node.head in ("or", "forall", "exists", "imply", "when"):
            raise self.source.error(f'"{node.head}" cannot stand in :init', node.location, "list the atoms that hold")
        else:
            self._note(self._ground(node), self.atoms, node.location)

    def _in_pddl(self, node: Group) -> Group:
        """Return an entry of another notation, which is reported, in that of PDDL."""
        *before, last = node.parts or [node]
        number = isinstance(last, Word) and last.text[0].isdigit()
        if number and node.head in self.functions:
            function = Group(tuple(before), node.location, node.end, node.depth)
            end = after(before[-1])
            shown = f"(= {self.source.text(node.location, end)}) {self.source.text(last.location, after(last))})"
            edits = [Edit(node.location, after(node), shown)]
            message = f'"{node.head}" is a function: its value stands behind "="'
            self.source.fault_once(message, node.location, f"write {shown}", "other-notation", edits)
            return Group((Word("=", node.location), function, last), node.location, node.end, node.depth)
        written = self._in_order(node, before, last) if len(before) == 2 else None
        if written is not None:
            return written
        if node.head in ASSIGNED and len(before) == 2 and isinstance(before[1], Group):
            return truth_value(node, before[1], last, self.source)
        return node

    def _in_order(self, node: Group, before: Sequence[Node], last: Node) -> Group | None:
        """Return ``(= 3 (weight a))``, ``((weight a) = 3)`` or ``(= (at r) a)``, which are reported, in PDDL."""
        first, between = before
        if isinstance(between, Word) and isinstance(last, Group) and node.head == "=" and between.text[0].isdigit():
            return _value(node.location, last, between, after(node), self.source)
        if isinstance(between, Word) and isinstance(first, Group) and between.text == "=":
            return _value(node.location, first, last, after(node), self.source)
        if not (isinstance(between, Group) and isinstance(last, Word) and node.head == "="):
            return None
        if last.text[0].isdigit() or self.predicates.get(between.head) != len(between.parts):
            return None
        name, value = shifted(between.location, 1), self.source.text(last.location, after(last))
        shown = f"({self.source.text(name, between.end)} {value})"
        edits = [Edit(node.location, after(node), shown)]
        message = f'"{between.head}" is a predicate, and has no value'
        self.source.fault_once(message, node.location, f"write {shown}", "other-notation", edits)
        return Group((*between.parts, last), node.location, node.end, node.depth)

    def _note(self, atom: GroundAtom, where: dict[GroundAtom, None], place: Location) -> None:
        if atom in where:
            self.twice.append((atom, place))
        where[atom] = None

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
            hint = "write (= (function object ...) number)"
            raise self.source.error("expected a function and its value", node.location, hint)
        number = read_number(node.parts[2], self.source)
        if number is None:
            raise unsupported(self.source, "object fluents", node.parts[1].head, node.location, "give a number")
        function = self._ground(node.parts[1])
        if function == GroundAtom(TOTAL_COST):
            if number:
                raise self.source.error(f"{TOTAL_COST} begins at 0", node.location)
            return
        if function in self.values:
            message, hint = f"the value of {function} is given twice", "remove one of the two"
            raise self.source.error(message, node.location, hint)
        self.values[function] = number


def _spread(nodes: Iterable[Node], source: Source) -> list[Node]:
    """Flatten :init, where ``(and a b)`` is the same as ``a b``; others refuse it. Atoms may lack their parentheses."""
    found: list[Node] = []
    for node in nodes:
        outer = isinstance(node, Group) and len(node.parts) > 0 and all(isinstance(p, Group) for p in node.parts)
        if isinstance(node, Group) and node.head == "and":
            edits = [Edit(node.location, after(node.parts[0])), Edit(node.end, after(node))]
            message = '"and" stands in :init, which other planners refuse'
            source.warn(message, node.location, "write its parts alone", "nested-init", edits)
            found.extend(node.parts[1:])
        elif isinstance(node, Group) and outer:
            edits = [Edit(node.location, shifted(node.location, 1)), Edit(node.end, after(node))]
            message, hint = "the atoms of :init have no parentheses around all of them", "remove them"
            source.fault_at(message, node.location, hint, "syntax", edits)
            found.extend(_spread(node.parts, source))
        else:
            found.append(node)
    return list(_in_atoms(found, source))


def _in_atoms(nodes: Sequence[Node], source: Source) -> Iterator[Node]:
    """Yield atoms and values; words of a line, and ``(weight a) = 3``, are reported and put in parentheses."""
    rest = list(nodes)
    while rest:
        node = rest.pop(0)
        if isinstance(node, Group) and len(rest) > 1 and isinstance(rest[0], Word) and rest[0].text in ("=", "=="):
            yield _value(node.location, node, rest[1], after(rest[1]), source)
            del rest[:2]
            continue
        if isinstance(node, Word):
            words = [node, *_words_of_line(node.location.line, rest)]
            atom = atom_of_words(words, source)
            del rest[: len(words) - 1 if atom else 0]
            node = atom or node
        yield node


def _value(place: Location, function: Node, number: Node, end: Location, source: Source) -> Group:
    """Return ``(= (weight a) 3)`` for the same in another order, up to ``end``, which is reported."""
    shown = f"(= {' '.join(source.text(node.location, after(node)) for node in (function, number))})"
    edits = [Edit(place, end, shown)]
    source.fault_once('"=" stands before a function and its value', place, f"write {shown}", "other-notation", edits)
    return Group((Word("=", place), function, number), place, shifted(end, -1), 2)


def _words_of_line(line: int | None, nodes: Sequence[Node]) -> list[Node]:
    return list(takewhile(lambda node: isinstance(node, Word) and node.location.line == line, nodes))
