"""The names in a PDDL text: each with its kind, its role and its place, as far as the text can be read."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum

from tmd.diagnostics import Location, TmdError
from tmd.pddl.model import OBJECT
from tmd.pddl.reading.formulas import RESERVED, is_variable
from tmd.pddl.reading.syntax import Document, Group, Node, Word, parse


class Kind(StrEnum):
    """Kinds of names; names of two kinds never clash."""

    TYPE = "type"
    PREDICATE = "predicate"
    FUNCTION = "function"
    OBJECT = "object"
    ACTION = "action"
    VARIABLE = "variable"


class Role(StrEnum):
    """What a text does with a name."""

    DECLARED = "declared"
    USED = "used"
    READ = "read"
    ADDED = "added"
    DELETED = "deleted"
    HOLDS = "holds at the start"


@dataclass(frozen=True, slots=True)
class Occurrence:
    """One place of a name.

    Attributes:
        name: The name, in lower case.
        kind: What it names.
        role: What the text does with it.
        place: Where it stands.
        within: What it stands in, for people: ``action load``, ``goal``.
        types: Of a declaration, the types of the thing, or the parent of the type.
        group: Of the declaration of a predicate, function or action: the whole of it.
        scope: Of a variable: the beginning of the group that binds it.
    """

    name: str
    kind: Kind
    role: Role
    place: Location
    within: str = ""
    types: tuple[str, ...] = ()
    group: Group | None = field(default=None, compare=False)
    scope: Location | None = None

    def covers(self, line: int, column: int) -> bool:
        """Return whether a place is on the name or just behind it."""
        return self.place.line == line and 0 <= column - self.place.column <= len(self.name)


def names_in_pddl(text: str, file: str) -> list[Occurrence]:
    """Return the names of a domain or problem, in the order of the text; nothing where it nests too deeply."""
    document = _parsed(text, file)
    sections = (part for top in document.groups for part in top.parts[1:] if isinstance(part, Group))
    found = _Names()
    for section in sections:
        found.section(section)
    return found.names


def names_in_conditions(text: str, file: str) -> list[Occurrence]:
    """Return the names of a text that consists of conditions."""
    found = _Names("condition")
    for group in _parsed(text, file).groups:
        found.formula(group, Role.READ)
    return found.names


def _parsed(text: str, file: str) -> Document:
    document = parse(text, file, lambda _: None)
    try:
        document.check_depth()
    except TmdError:
        return replace(document, groups=())
    return document


@dataclass(slots=True)
class _Names:
    """The names found so far; ``bound`` are the variables of the groups around, inner ones last."""

    within: str = ""
    names: list[Occurrence] = field(default_factory=list)
    bound: list[tuple[Location, set[str]]] = field(default_factory=list)

    def note(self, word: Word, kind: Kind, role: Role, **more: object) -> None:
        found = Occurrence(word.text, kind, role, word.location, self.within)
        self.names.append(replace(found, **more) if more else found)  # type: ignore[arg-type]

    def section(self, group: Group) -> None:
        """Note the names of a part of ``(define ...)``."""
        self.within, self.bound = group.head.removeprefix(":"), []
        rest = group.parts[1:]
        match group.head:
            case ":types":
                self.typed(rest, Kind.TYPE)
            case ":constants" | ":objects":
                self.typed(rest, Kind.OBJECT)
            case ":predicates" | ":functions":
                kind = Kind.PREDICATE if group.head == ":predicates" else Kind.FUNCTION
                for part in rest:
                    self.signature(part, kind)
            case ":action" | ":durative-action":
                self.action(group)
            case ":derived":
                self.derived(group)
            case ":init" | ":goal" | ":metric":
                for part in rest:
                    self.formula(part, Role.HOLDS if group.head == ":init" else Role.READ)

    def signature(self, node: Node, kind: Kind) -> None:
        """Note the declaration of a predicate or function."""
        if isinstance(node, Group) and node.parts and isinstance(node.parts[0], Word):
            self.note(node.parts[0], kind, Role.DECLARED, group=node)
            self.bound = [(node.location, set())]
            self.typed(node.parts[1:], Kind.VARIABLE)

    def action(self, group: Group) -> None:
        name = group.parts[1] if len(group.parts) > 1 else None
        if isinstance(name, Word):
            self.within = f"action {name.text}"
            self.note(name, Kind.ACTION, Role.DECLARED, group=group)
        self.bound = [(group.location, set())]
        keyword = ""
        for node in group.parts[2:]:
            if isinstance(node, Word):
                keyword = node.text
            elif keyword == ":parameters":
                self.typed(node.parts, Kind.VARIABLE)
            else:
                self.formula(node, Role.ADDED if keyword == ":effect" else Role.READ)

    def derived(self, group: Group) -> None:
        head, *conditions = group.parts[1:] or (None,)
        self.bound = [(group.location, set())]
        if isinstance(head, Group) and head.parts and isinstance(head.parts[0], Word):
            self.within = f"derived {head.head}"
            self.note(head.parts[0], Kind.PREDICATE, Role.ADDED)
            self.typed(head.parts[1:], Kind.VARIABLE)
        for part in conditions:
            self.formula(part, Role.READ)

    def typed(self, nodes: Sequence[Node], kind: Kind) -> None:
        """Note the names of a typed list, and its types, which stand behind dashes."""
        waiting: list[Word] = []
        words = iter(nodes)
        for node in words:
            if isinstance(node, Word) and node.text != "-":
                waiting.append(node)
                continue
            behind = node if isinstance(node, Group) else next(words, None)
            types = [word for word in _words(behind) if word.text != "either"]
            self.declare(waiting, kind, tuple(word.text for word in types))
            for word in types:
                self.note(word, Kind.TYPE, Role.USED)
            waiting = []
        self.declare(waiting, kind, (OBJECT,))

    def declare(self, words: Iterable[Word], kind: Kind, types: tuple[str, ...]) -> None:
        for word in words:
            if kind is not Kind.VARIABLE:
                self.note(word, kind, Role.DECLARED, types=types)
            elif self.bound and is_variable(word.text):
                self.bound[-1][1].add(word.text)
                self.note(word, kind, Role.DECLARED, types=types, scope=self.bound[-1][0])

    def formula(self, node: Node, role: Role, kind: Kind = Kind.PREDICATE) -> None:
        """Note the names of a condition or an effect; ``role`` is that of its atoms."""
        if isinstance(node, Word):
            self.term(node)
            return
        rest, head = node.parts[1:], node.head
        if head in ("forall", "exists"):
            self.bound.append((node.location, set()))
            if rest and isinstance(rest[0], Group):
                self.typed(rest[0].parts, Kind.VARIABLE)
            for part in rest[1:]:
                self.formula(part, role, kind)
            self.bound.pop()
            return
        if node.parts and isinstance(node.parts[0], Word) and head not in _NO_NAMES:
            self.note(node.parts[0], kind, role)
        if head in _NUMERIC:
            kind, role = Kind.FUNCTION, Role.READ
        elif head == "not" and role is Role.ADDED:
            role = Role.DELETED
        for number, part in enumerate(rest if head else node.parts):
            self.formula(part, Role.READ if head == "when" and number == 0 else role, kind)

    def term(self, word: Word) -> None:
        if is_variable(word.text):
            scope = next((place for place, names in reversed(self.bound) if word.text in names), None)
            self.note(word, Kind.VARIABLE, Role.USED, scope=scope)
        elif word.text[0].isalpha() and word.text not in _NO_NAMES:
            self.note(word, Kind.OBJECT, Role.USED)


_NUMERIC = frozenset({"=", "<", ">", "<=", ">=", "+", "-", "*", "/", "increase", "decrease", "assign"})
_NO_NAMES = _NUMERIC | RESERVED | {"minimize", "maximize"}


def _words(node: Node | None) -> Iterator[Word]:
    """Yield the words of a node, without those of groups within groups."""
    if isinstance(node, Word):
        yield node
    elif node is not None:
        yield from (part for part in node.parts if isinstance(part, Word))
