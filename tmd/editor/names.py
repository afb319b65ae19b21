"""The names in a PDDL text: each with its kind, its role and its place, as far as the text can be read."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

from tmd.diagnostics import Location, TmdError
from tmd.pddl.model import OBJECT
from tmd.pddl.reading.formulas import RESERVED, is_variable
from tmd.pddl.reading.syntax import Group, Node, Word, parse


class NameKind(StrEnum):
    """Kinds of names; names of two kinds never clash."""

    TYPE = "type"
    PREDICATE = "predicate"
    FUNCTION = "function"
    OBJECT = "object"
    ACTION = "action"
    VARIABLE = "variable"


class Role(StrEnum):
    """Uses of a name in a text."""

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
        within: What it stands in, for people: ``action load``, ``goal``.
        types: Of a declaration, the types of the thing, or the parent of the type.
        group: Of the declaration of a predicate, function or action: the whole of it.
        scope: Of a variable: the beginning of the group that binds it.
    """

    name: str
    kind: NameKind
    role: Role
    place: Location
    within: str = ""
    types: tuple[str, ...] = ()
    group: Group | None = field(default=None, compare=False)
    scope: Location | None = None


def names_in_pddl(text: str, file: str) -> list[Occurrence]:
    """Return the names of a domain or problem, in the order of the text; nothing where it nests too deeply."""
    sections = (part for top in groups_in(text, file) for part in top.parts[1:] if isinstance(part, Group))
    return [name for section in sections for name in names_in_section(section)]


def names_in_section(section: Group) -> list[Occurrence]:
    """Return the names of a part of ``(define ...)``."""
    found = _Names()
    found.section(section)
    return found.names


def names_in_conditions(text: str, file: str) -> list[Occurrence]:
    """Return the names of a text that consists of conditions."""
    found = _Names("condition")
    for group in groups_in(text, file):
        found.formula(group, Role.READ)
    return found.names


def groups_in(text: str, file: str) -> tuple[Group, ...]:
    """Return the outermost groups of a text, as far as it can be read; none where it nests too deeply."""
    document = parse(text, file, lambda _: None)
    with suppress(TmdError):
        document.check_depth()
        return document.groups
    return ()


@dataclass(slots=True)
class _Names:
    """The names found so far; ``bound`` are the variables of the groups around, inner ones last."""

    within: str = ""
    names: list[Occurrence] = field(default_factory=list)
    bound: list[tuple[Location, set[str]]] = field(default_factory=list)

    def note(self, word: Word, kind: NameKind, role: Role, **more: Any) -> None:  # noqa: ANN401 - other attributes
        self.names.append(Occurrence(word.text, kind, role, word.location, self.within, **more))

    def section(self, group: Group) -> None:
        """Note the names of a part of ``(define ...)``."""
        head, rest = group.head, group.parts[1:]
        self.within, self.bound = head.removeprefix(":"), []
        if head in _TYPED:
            self.typed(rest, _TYPED[head])
        elif head in (":action", ":durative-action"):
            self.action(group)
        elif head == ":derived":
            self.derived(group)
        for part in rest:
            if head in _SIGNATURES:
                self.bound = [(part.location, set())]
                self.signature(part, _SIGNATURES[head])
            elif head in _FORMULAS:
                self.formula(part, _FORMULAS[head])

    def signature(self, node: Node, kind: NameKind, role: Role = Role.DECLARED) -> None:
        """Note the declaration of a predicate or function, or the head of a derived one."""
        name = _head(node)
        if isinstance(node, Group) and name is not None:
            self.note(name, kind, role, group=node if role is Role.DECLARED else None)
            self.typed(node.parts[1:], NameKind.VARIABLE)

    def action(self, group: Group) -> None:
        name, *parts = group.parts[1:] or (None,)
        if isinstance(name, Word):
            self.within = f"action {name.text}"
            self.note(name, NameKind.ACTION, Role.DECLARED, group=group)
        self.bound = [(group.location, set())]
        keyword = ""
        for node in parts:
            if isinstance(node, Word):
                keyword = node.text
            elif keyword == ":parameters":
                self.typed(node.parts, NameKind.VARIABLE)
            else:
                self.formula(node, Role.ADDED if keyword == ":effect" else Role.READ)

    def derived(self, group: Group) -> None:
        head, *conditions = group.parts[1:] or (group,)
        self.within = f"derived {head.head}" if isinstance(head, Group) else ""
        self.bound = [(group.location, set())]
        self.signature(head, NameKind.PREDICATE, Role.ADDED)
        for part in conditions:
            self.formula(part, Role.READ)

    def typed(self, nodes: Sequence[Node], kind: NameKind) -> None:
        """Note the names of a typed list, and its types, which stand behind dashes."""
        waiting: list[Word] = []
        words = iter(nodes)
        for node in words:
            if isinstance(node, Word) and node.text != "-":
                waiting.append(node)
                continue
            types = _types(node if isinstance(node, Group) else next(words, None))
            self.declare(waiting, kind, tuple(word.text for word in types))
            for word in types:
                self.note(word, NameKind.TYPE, Role.USED)
            waiting = []
        self.declare(waiting, kind, (OBJECT,))

    def declare(self, words: Iterable[Word], kind: NameKind, types: tuple[str, ...]) -> None:
        for word in words:
            if kind is not NameKind.VARIABLE:
                self.note(word, kind, Role.DECLARED, types=types)
            elif self.bound and is_variable(word.text):
                self.bound[-1][1].add(word.text)
                self.note(word, kind, Role.DECLARED, types=types, scope=self.bound[-1][0])

    def formula(self, node: Node, role: Role, kind: NameKind = NameKind.PREDICATE) -> None:
        """Note the names of a condition or an effect; ``role`` is that of its atoms."""
        if isinstance(node, Word):
            self.term(node)
            return
        head, outside = _head(node), len(self.bound)
        word = head.text if head else ""
        if head and word not in _NO_NAMES:
            self.note(head, kind, role)
        role = _ROLES_BELOW.get((word, role), role)
        if word in _NUMERIC:
            kind, role = NameKind.FUNCTION, Role.READ
        for number, part in enumerate(self.quantified(node) if word in _QUANTIFIERS else node.parts[bool(head) :]):
            self.formula(part, Role.READ if (word, number) == ("when", 0) else role, kind)
        del self.bound[outside:]

    def quantified(self, group: Group) -> Sequence[Node]:
        """Bind the variables of a quantifier; return the parts behind them."""
        self.bound.append((group.location, set()))
        for part in group.parts[1:2]:
            self.typed(_parts(part), NameKind.VARIABLE)
        return group.parts[2:]

    def term(self, word: Word) -> None:
        if is_variable(word.text):
            scope = next((place for place, names in reversed(self.bound) if word.text in names), None)
            self.note(word, NameKind.VARIABLE, Role.USED, scope=scope)
        elif word.text[0].isalpha() and word.text not in _NO_NAMES:
            self.note(word, NameKind.OBJECT, Role.USED)


_TYPED = {":types": NameKind.TYPE, ":constants": NameKind.OBJECT, ":objects": NameKind.OBJECT}
_SIGNATURES = {":predicates": NameKind.PREDICATE, ":functions": NameKind.FUNCTION}
_FORMULAS = {":init": Role.HOLDS, ":goal": Role.READ, ":metric": Role.READ}
_QUANTIFIERS = ("forall", "exists")
_ROLES_BELOW = {("not", Role.ADDED): Role.DELETED}
_NUMERIC = frozenset({"=", "<", ">", "<=", ">=", "+", "-", "*", "/", "increase", "decrease", "assign"})
_NO_NAMES = _NUMERIC | RESERVED | {"minimize", "maximize"}


def _parts(node: Node | None) -> tuple[Node, ...]:
    return node.parts if isinstance(node, Group) else ()


def _types(behind: Node | None) -> list[Word]:
    """Return the types behind a dash: one, or several in ``(either ...)``."""
    inside = (behind,) if isinstance(behind, Word) else _parts(behind)
    return [word for word in inside if isinstance(word, Word) and word.text != "either"]


def _head(node: Node) -> Word | None:
    first = _parts(node)[:1]
    return first[0] if first and isinstance(first[0], Word) else None
