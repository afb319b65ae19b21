"""Reading names, terms, numbers and typed lists from nested groups."""

from __future__ import annotations

import re
from collections.abc import Sequence

from tmd.errors import Location, TmdError
from tmd.pddl.model import OBJECT, TypedName
from tmd.pddl.syntax import Group, Node, Source, Word

_NAME = re.compile(r"[a-z][a-z0-9_-]*")
_VARIABLE = re.compile(r"\?[a-z][a-z0-9_-]*")
_NUMBER = re.compile(r"([0-9]{1,15})(\.0*)?")

RESERVED = frozenset({"and", "or", "not", "imply", "forall", "exists", "when", "either", "increase"})


def is_variable(term: str) -> bool:
    """Whether a term is a variable."""
    return term.startswith("?")


def unsupported(source: Source, what: str, name: str, location: Location, hint: str | None = None) -> TmdError:
    """The error for a construct of PDDL that is outside the supported part."""
    return source.error(f'not supported: {what}: "{name}"', location, hint, "not-supported")


def read_name(node: Node, source: Source, what: str) -> Word:
    """A name such as ``mug1``."""
    if isinstance(node, Group):
        raise source.error(f"expected {what}, found a parenthesis", node.location)
    if not _NAME.fullmatch(node.text):
        raise source.error(
            f'"{node.text}" is not {what}',
            node.location,
            "names begin with a letter and hold letters, digits, - and _",
            "bad-name",
        )
    if node.text in RESERVED:
        raise source.error(f'"{node.text}" is a word of PDDL and cannot be {what}', node.location, code="bad-name")
    return node


def read_term(node: Node, source: Source) -> str:
    """A variable, constant or object."""
    if isinstance(node, Group):
        raise unsupported(
            source,
            "object fluents and nested terms",
            f"({node.head} ...)",
            node.location,
            "write a name or ?variable",
        )
    if is_variable(node.text):
        if not _VARIABLE.fullmatch(node.text):
            raise source.error(f'"{node.text}" is not a variable', node.location, "write ?name", "bad-name")
        return node.text
    return read_name(node, source, "a name or ?variable").text


def read_number(node: Node, source: Source) -> int | None:
    """A whole number that is not negative; ``None`` where ``node`` is no number at all."""
    if isinstance(node, Group) or not re.fullmatch(r"[-+]?[0-9.]+(e[-+]?[0-9]+)?", node.text):
        return None
    whole = _NUMBER.fullmatch(node.text)
    if whole:
        return int(whole[1])
    raise source.error(f'cost "{node.text}" is not a whole number from 0 to 10^15', node.location)


def read_typed_list(nodes: Sequence[Node], source: Source, *, variables: bool, what: str) -> tuple[TypedName, ...]:
    """``a b - t c - (either t u)``: names (or variables) with their types."""
    found: list[TypedName] = []
    waiting: list[Word] = []
    rest = list(reversed(nodes))
    while rest:
        node = rest.pop()
        if isinstance(node, Word) and len(node.text) > 1 and node.text[0] == "-":
            rest.append(_after_dash(node, source))
            node = Word("-", node.location)
        if isinstance(node, Word) and node.text == "-":
            types = _types_after(node, rest, source)
            if not waiting:
                source.fault(source.error(f"this type belongs to no {what}", node.location))
            found.extend(TypedName(w.text, types, w.location) for w in waiting)
            waiting.clear()
        else:
            waiting.extend(_read_listed(node, source, variables, what))
    found.extend(TypedName(w.text, (OBJECT,), w.location) for w in waiting)
    return tuple(found)


def _after_dash(node: Word, source: Source) -> Word:
    """The type in ``-type``, which wants a space."""
    message = f'some tools want a space between "-" and "{node.text[1:]}"'
    source.warn(message, node.location, f'write "- {node.text[1:]}"', "glued-dash")
    place = node.location
    return Word(node.text[1:], Location(place.file, place.line, place.column + 1))


def _types_after(dash: Word, rest: list[Node], source: Source) -> tuple[str, ...]:
    node = rest.pop() if rest else None
    return source.recover((OBJECT,), _read_types, node, dash.location, source)


def _read_listed(node: Node, source: Source, variables: bool, what: str) -> list[Word]:
    """The name at ``node``; nothing where it is none and faults are collected."""
    if not variables:
        return source.recover([], lambda: [read_name(node, source, f"the name of {what}")])
    if isinstance(node, Group):
        source.fault(source.error(f"expected {what} such as ?x, found a parenthesis", node.location))
        return []
    if not _VARIABLE.fullmatch(node.text):
        hint = f'write "?{node.text.lstrip("?")}"'
        source.fault(source.error(f'"{node.text}" is not {what}', node.location, hint, "bad-name"))
        node = Word(f"?{node.text.lstrip('?')}", node.location)
    return [node]


def _read_types(node: Node | None, dash: Location, source: Source) -> tuple[str, ...]:
    if node is None:
        raise source.error('a type is missing after "-"', dash)
    if isinstance(node, Word):
        return (read_name(node, source, "the name of a type").text,)
    if node.head != "either" or len(node.parts) < 2:
        raise source.error("expected a type or (either type ...)", node.location)
    return tuple(read_name(n, source, "the name of a type").text for n in node.parts[1:])


def read_parameters(node: Node, source: Source) -> tuple[TypedName, ...]:
    """The parameter list of an action or quantifier."""
    if isinstance(node, Word):
        raise source.error(f'expected a list of parameters, found "{node.text}"', node.location, "write (?x - type)")
    return read_typed_list(node.parts, source, variables=True, what="a variable")
