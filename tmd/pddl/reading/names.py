"""Reading names, terms, numbers and typed lists from nested groups."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence

from tmd.diagnostics import Location, TmdError
from tmd.pddl.model import OBJECT, TypedName
from tmd.pddl.reading.syntax import Group, Node, Source, Word

_NAME = re.compile(r"[a-z][a-z0-9_-]*")
_ODD_NAME = re.compile(r"[a-z0-9_][!-~]*")
"""What planners take for a name although PDDL does not."""
_VARIABLE = re.compile(r"\?[a-z][a-z0-9_-]*")
_ODD_VARIABLE = re.compile(r"\?[a-z0-9_][!-~]*")
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
        _odd_name(node, source, what, _ODD_NAME, "names begin with a letter and hold letters, digits, - and _")
    if node.text in RESERVED:
        raise source.error(f'"{node.text}" is a word of PDDL and cannot be {what}', node.location, code="bad-name")
    return node


def _odd_name(node: Word, source: Source, what: str, accepted: re.Pattern[str], hint: str) -> None:
    """A name that PDDL does not have: let pass where planners do.

    Raises:
        TmdError: It is none.
    """
    strange = next((place for place, letter in enumerate(node.text) if not letter.isascii()), None)
    if strange is not None:
        letter = node.text[strange]
        place = Location(node.location.file, node.location.line, node.location.column + strange)
        message = (
            f'"{node.text}" has a character that PDDL does not: {letter!r} ({unicodedata.name(letter, "unnamed")})'
        )
        raise source.error(message, place, look_alike(letter) or hint, "look-alike")
    if not accepted.fullmatch(node.text):
        raise source.error(f'"{node.text}" is not {what}', node.location, hint, "bad-name")
    source.warn(
        f'"{node.text}" is not a name by the letter of PDDL; some tools refuse it', node.location, hint, "odd-name"
    )


def look_alike(letter: str) -> str | None:
    """A hint with the ASCII character that ``letter`` looks like."""
    plain = _LOOK_ALIKES.get(letter) or unicodedata.normalize("NFKD", letter)[0]
    return f'write "{plain}"' if plain.isascii() and plain.isprintable() else None


_LOOK_ALIKES = {
    **dict.fromkeys("\u2010\u2011\u2012\u2013\u2014\u2015\u2212\ufe63\uff0d", "-"),
    **dict(zip("\u0430\u0435\u043e\u0440\u0441\u0443\u0445\u0456\u0458\u0455", "aeopcyxijs", strict=True)),
    **dict(zip("\u03b1\u03bf\u03c1\u03bd\u03b9", "aopvi", strict=True)),
    **dict.fromkeys("\u2018\u2019\u201c\u201d", "'"),
}
"""Dashes, and Cyrillic and Greek letters, with the ASCII characters that they look like."""


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
            _odd_name(node, source, "a variable", _ODD_VARIABLE, "write ?name")
        return node.text
    return read_name(node, source, "a name or ?variable").text


def read_number(node: Node, source: Source) -> int | None:
    """A whole number that is not negative; ``None`` where ``node`` is not a number at all."""
    if isinstance(node, Group) or not re.fullmatch(r"[-+]?[0-9.]+(e[-+]?[0-9]+)?", node.text):
        return None
    whole = _NUMBER.fullmatch(node.text)
    if whole:
        return int(whole[1])
    shown = node.text if len(node.text) <= 30 else f"{node.text[:30]}…"
    message = f'not supported: numbers other than whole ones from 0 to 10^15: "{shown}"'
    raise source.error(message, node.location, "multiply all costs by 10, 100, ...", "not-supported")


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
        if isinstance(node, Word) and _LOOK_ALIKES.get(node.text) == "-":
            source.recover(None, read_name, node, source, "a dash")
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
        name = f"?{node.text.lstrip('?')}"
        source.recover(None, _odd_name, node, source, what, _ODD_VARIABLE, f'write "{name}"')
        node = Word(name, node.location)
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
