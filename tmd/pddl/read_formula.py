"""Reading names, typed lists, conditions and effects from nested groups.

Effects come out flat. ``and`` and ``forall`` are spread out, and the conditions of a ``when`` within a
``when`` are conjoined: ``(when a (when b e))`` becomes ``(when (and a b) e)``.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field

from tmd.errors import Location, TmdError
from tmd.pddl.model import (
    OBJECT,
    TOTAL_COST,
    TRUE,
    And,
    Atom,
    Effect,
    Equals,
    Exists,
    Forall,
    Formula,
    Imply,
    Not,
    Or,
    TypedName,
)
from tmd.pddl.syntax import Group, Node, Source, Word

_NAME = re.compile(r"[a-z][a-z0-9_-]*")
_VARIABLE = re.compile(r"\?[a-z][a-z0-9_-]*")
_NUMBER = re.compile(r"[0-9]+(\.[0-9]+)?")

RESERVED = frozenset({"and", "or", "not", "imply", "forall", "exists", "when", "either", "increase"})
_UNSUPPORTED_CONDITIONS = {
    "preference": "preferences",
    "<": "numeric conditions",
    ">": "numeric conditions",
    "<=": "numeric conditions",
    ">=": "numeric conditions",
    "oneof": "non-deterministic effects",
}
_UNSUPPORTED_EFFECTS = {
    "assign": "numeric and object fluents",
    "decrease": "numeric fluents",
    "scale-up": "numeric fluents",
    "scale-down": "numeric fluents",
    "oneof": "non-deterministic effects",
    "probabilistic": "probabilistic effects",
}
_ONLY_COSTS = "of numeric fluents only total-cost is supported"


def is_variable(term: str) -> bool:
    """Whether a term is a variable."""
    return term.startswith("?")


def free_variables(formula: Formula) -> frozenset[str]:
    """The variables of ``formula`` that no quantifier within it binds."""
    if isinstance(formula, Atom):
        return frozenset(t for t in formula.terms if is_variable(t))
    if isinstance(formula, Equals):
        return frozenset(t for t in (formula.left, formula.right) if is_variable(t))
    if isinstance(formula, Not):
        return free_variables(formula.part)
    if isinstance(formula, Imply):
        return free_variables(formula.left) | free_variables(formula.right)
    if isinstance(formula, Forall | Exists):
        return free_variables(formula.part) - {p.name for p in formula.parameters}
    return frozenset[str]().union(*(free_variables(p) for p in formula.parts))


def unsupported(source: Source, what: str, name: str, location: Location, hint: str | None = None) -> TmdError:
    """The error for a construct of PDDL that is outside the supported part."""
    return source.error(f'{what} are not supported: "{name}"', location, hint)


def read_name(node: Node, source: Source, what: str) -> Word:
    """A name such as ``mug1``."""
    if isinstance(node, Group):
        raise source.error(f"expected {what}, found a parenthesis", node.location)
    if not _NAME.fullmatch(node.text):
        raise source.error(
            f'"{node.text}" is not {what}',
            node.location,
            "names begin with a letter and hold letters, digits, - and _",
        )
    if node.text in RESERVED:
        raise source.error(f'"{node.text}" is a word of PDDL and cannot be {what}', node.location)
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
            raise source.error(f'"{node.text}" is not a variable', node.location, "write ?name")
        return node.text
    return read_name(node, source, "a name or ?variable").text


def read_number(node: Node, source: Source) -> int | None:
    """A whole number that is not negative; ``None`` where ``node`` is no number at all."""
    if isinstance(node, Group) or not re.fullmatch(r"[-+]?[0-9.]+(e[-+]?[0-9]+)?", node.text):
        return None
    if _NUMBER.fullmatch(node.text) and float(node.text) == int(float(node.text)):
        return int(float(node.text)) if "." in node.text else int(node.text)
    raise source.error(f'cost "{node.text}" is not a whole number from 0 up', node.location)


def read_typed_list(nodes: Sequence[Node], source: Source, *, variables: bool, what: str) -> tuple[TypedName, ...]:
    """``a b - t c - (either t u)``: names (or variables) with their types."""
    found: list[TypedName] = []
    waiting: list[Word] = []
    rest = list(reversed(nodes))
    while rest:
        node = rest.pop()
        if isinstance(node, Word) and node.text == "-":
            types = _read_types(rest.pop() if rest else None, node.location, source)
            if not waiting:
                raise source.error(f"this type belongs to no {what}", node.location)
            found.extend(TypedName(w.text, types, w.location) for w in waiting)
            waiting.clear()
        else:
            waiting.append(_read_listed(node, source, variables, what))
    found.extend(TypedName(w.text, (OBJECT,), w.location) for w in waiting)
    return tuple(found)


def _read_listed(node: Node, source: Source, variables: bool, what: str) -> Word:
    if not variables:
        return read_name(node, source, f"the name of {what}")
    if isinstance(node, Group):
        raise source.error(f"expected {what} such as ?x, found a parenthesis", node.location)
    if not _VARIABLE.fullmatch(node.text):
        raise source.error(f'"{node.text}" is not {what}', node.location, f'write "?{node.text.lstrip("?")}"')
    return node


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


def read_condition(node: Node, source: Source) -> Formula:
    """A precondition, goal or condition of an effect.

    Raises:
        TmdError: It is not a formula, or it holds something that is not supported.
    """
    if isinstance(node, Word):
        raise source.error(f'expected a condition, found "{node.text}"', node.location, f"write ({node.text})")
    if not node.parts:
        return And((), node.location)
    head, parts, place = node.head, node.parts[1:], node.location
    if head in ("and", "or"):
        inner = tuple(read_condition(p, source) for p in parts)
        return And(inner, place) if head == "and" else Or(inner, place)
    if head == "not":
        _expect(node, 1, "(not condition)", source)
        return Not(read_condition(parts[0], source), place)
    if head == "imply":
        _expect(node, 2, "(imply condition condition)", source)
        return Imply(read_condition(parts[0], source), read_condition(parts[1], source), place)
    if head in ("forall", "exists"):
        _expect(node, 2, f"({head} (parameters) condition)", source)
        parameters, part = read_parameters(parts[0], source), read_condition(parts[1], source)
        return Forall(parameters, part, place) if head == "forall" else Exists(parameters, part, place)
    if head == "=":
        _expect(node, 2, "(= term term)", source)
        return Equals(read_term(parts[0], source), read_term(parts[1], source), place)
    if head == "when":
        raise source.error('"when" belongs in effects', place, 'write "imply" in conditions')
    if head in _UNSUPPORTED_CONDITIONS:
        raise unsupported(source, _UNSUPPORTED_CONDITIONS[head], head, place)
    return read_atom(node, source)


def read_atom(node: Group, source: Source) -> Atom:
    """A predicate or function applied to terms."""
    if not node.parts:
        raise source.error("expected (predicate term ...), found ()", node.location)
    name = read_name(node.parts[0], source, "the name of a predicate")
    return Atom(name.text, tuple(read_term(p, source) for p in node.parts[1:]), node.location)


def _expect(node: Group, count: int, form: str, source: Source) -> None:
    if len(node.parts) != count + 1:
        raise source.error(f'"{node.head}" takes {count} part(s), found {len(node.parts) - 1}', node.location, form)


@dataclass(slots=True)
class Effects:
    """What :func:`read_effects` collects."""

    flat: list[Effect] = field(default_factory=list)
    cost: int | Atom | None = None


@dataclass(frozen=True, slots=True)
class _Around:
    """The quantifiers and conditions around an effect."""

    parameters: tuple[TypedName, ...] = ()
    conditions: tuple[Formula, ...] = ()

    def condition(self) -> Formula:
        if not self.conditions:
            return TRUE
        return self.conditions[0] if len(self.conditions) == 1 else And(self.conditions)


def read_effects(node: Node, source: Source) -> Effects:
    """The effects of an action, flattened, and its cost.

    Raises:
        TmdError: It is not an effect, or it holds something that is not supported.
    """
    found = Effects()
    _read_effect(node, source, _Around(), found)
    return found


def _read_effect(node: Node, source: Source, around: _Around, found: Effects) -> None:
    if isinstance(node, Word):
        raise source.error(f'expected an effect, found "{node.text}"', node.location, f"write ({node.text})")
    head, parts = node.head, node.parts[1:]
    if head == "and" or not node.parts:
        for part in parts:
            _read_effect(part, source, around, found)
    elif head == "forall":
        _expect(node, 2, "(forall (parameters) effect)", source)
        _read_effect(parts[1], source, _quantified(node, source, around), found)
    elif head == "when":
        _expect(node, 2, "(when condition effect)", source)
        condition = read_condition(parts[0], source)
        inside = _Around(around.parameters, (*around.conditions, condition))
        _read_effect(parts[1], source, inside, found)
    elif head == "increase":
        _read_cost(node, source, around, found)
    elif head in _UNSUPPORTED_EFFECTS:
        raise unsupported(source, _UNSUPPORTED_EFFECTS[head], head, node.location, _ONLY_COSTS)
    elif head in ("or", "exists", "imply", "="):
        raise source.error(f'"{head}" cannot be an effect', node.location, "it belongs in conditions")
    else:
        found.flat.append(_read_literal(node, source, around))


def _quantified(node: Group, source: Source, around: _Around) -> _Around:
    """``around`` with the quantifier of ``node``; a condition outside it must not be captured."""
    parameters = read_parameters(node.parts[1], source)
    outside = frozenset[str]().union(*(free_variables(c) for c in around.conditions))
    for parameter in parameters:
        if parameter.name in outside:
            raise source.error(
                f'"{parameter.name}" already stands in a condition around this forall',
                parameter.location,
                "give it another name",
            )
    return _Around(around.parameters + parameters, around.conditions)


def _read_literal(node: Group, source: Source, around: _Around) -> Effect:
    positive = node.head != "not"
    inner: Node = node
    if not positive:
        _expect(node, 1, "(not (predicate term ...))", source)
        inner = node.parts[1]
    if isinstance(inner, Word) or inner.head in RESERVED or inner.head == "=":
        raise source.error(
            'only an atom can stand in an effect\'s "not"', inner.location, "write (not (predicate ...))"
        )
    return Effect(read_atom(inner, source), positive, around.condition(), around.parameters, node.location)


def _read_cost(node: Group, source: Source, around: _Around, found: Effects) -> None:
    _expect(node, 2, "(increase (total-cost) number)", source)
    target, amount = node.parts[1:]
    name = target.head if isinstance(target, Group) else target.text
    if name != TOTAL_COST:
        raise unsupported(source, "numeric fluents", name, node.location, _ONLY_COSTS)
    if around.parameters or around.conditions:
        raise source.error(
            "a cost that depends on conditions is not supported: increase inside when or forall",
            node.location,
        )
    if found.cost is not None:
        raise source.error("the cost of this action is given twice", node.location)
    if isinstance(amount, Group):
        if amount.head in ("+", "-", "*", "/"):
            raise unsupported(source, "numeric expressions", amount.head, amount.location, _ONLY_COSTS)
        found.cost = read_atom(amount, source)
        return
    found.cost = read_number(amount, source)
    if found.cost is None:
        raise source.error(f'cost "{amount.text}" is neither a number nor (function ...)', amount.location)
