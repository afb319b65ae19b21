"""Reading conditions and effects from nested groups.

Effects come out flat. ``and`` and ``forall`` are spread out, and the conditions of a ``when`` within a
``when`` are conjoined: ``(when a (when b e))`` becomes ``(when (and a b) e)``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from tmd.pddl.formulas import free_variables
from tmd.pddl.model import (
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
from tmd.pddl.reading.names import (
    RESERVED,
    read_name,
    read_number,
    read_parameters,
    read_term,
    unsupported,
)
from tmd.pddl.reading.syntax import Group, Node, Source, Word

_UNSUPPORTED_CONDITIONS = {
    "preference": "preferences",
    "<": "numeric conditions",
    ">": "numeric conditions",
    "<=": "numeric conditions",
    ">=": "numeric conditions",
    "oneof": "non-deterministic effects",
    "unknown": "partial observability",
    **dict.fromkeys(
        (
            "always", "sometime", "within", "at-most-once", "sometime-after", "sometime-before", "always-within",
            "hold-during", "hold-after",
        ),
        "trajectory constraints",
    ),
}  # fmt: skip
_NEVER_PREDICATES = frozenset({"preference", "<", ">", "<=", ">="})
"""The others may be names of predicates as well, and then have no conditions in them."""
_UNSUPPORTED_EFFECTS = {
    "assign": "numeric and object fluents",
    "change": "numeric and object fluents",
    "decrease": "numeric fluents",
    "scale-up": "numeric fluents",
    "scale-down": "numeric fluents",
    "oneof": "non-deterministic effects",
    "probabilistic": "probabilistic effects",
}
_ONLY_COSTS = "of numeric fluents only total-cost is supported"


def read_condition(node: Node, source: Source) -> Formula:
    """A precondition, goal or condition of an effect.

    Raises:
        TmdError: It is not a formula, or it holds something that is not supported.
    """
    if isinstance(node, Word):
        raise source.error(f'expected a condition, found "{node.text}"', node.location, f"write ({node.text})")
    if not node.parts:
        source.warn("() is empty, and some tools read it as false", node.location, "write (and)", "empty-condition")
        return And((), node.location)
    head, parts, place = node.head, node.parts[1:], node.location
    if head in ("and", "or"):
        inner = _read_parts(parts, source)
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
        if any(isinstance(p, Group) or p.text[0].isdigit() for p in parts):
            raise unsupported(source, "numeric conditions and object fluents", head, place)
        return Equals(read_term(parts[0], source), read_term(parts[1], source), place)
    if head == "when":
        raise source.error('"when" belongs in effects', place, 'write "imply" in conditions', "when-in-condition")
    if head in _NEVER_PREDICATES or (head in _UNSUPPORTED_CONDITIONS and any(isinstance(p, Group) for p in parts)):
        raise unsupported(source, _UNSUPPORTED_CONDITIONS[head], head, place)
    return read_atom(node, source)


def _read_parts(parts: Sequence[Node], source: Source) -> tuple[Formula, ...]:
    read = (source.recover(None, read_condition, p, source) for p in parts)
    return tuple(part for part in read if part is not None)


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
            source.recover(None, _read_effect, part, source, around, found)
    elif head == "forall":
        _expect(node, 2, "(forall (parameters) effect)", source)
        _read_effect(parts[1], source, _quantified(node, source, around), found)
    elif head == "when":
        _expect(node, 2, "(when condition effect)", source)
        if around.conditions:
            source.warn(
                'a "when" within a "when" is read as one with both conditions; most planners refuse it',
                node.location,
                "write one (when (and ...) ...)",
                "nested-when",
            )
        condition = source.recover(TRUE, read_condition, parts[0], source)
        inside = _Around(around.parameters, (*around.conditions, condition))
        _read_effect(parts[1], source, inside, found)
    elif head == "increase":
        _read_cost(node, source, around, found)
    elif head in _UNSUPPORTED_EFFECTS:
        what = _UNSUPPORTED_EFFECTS[head]
        raise unsupported(source, what, head, node.location, _ONLY_COSTS if "numeric" in what else None)
    elif head in ("or", "exists", "imply", "="):
        hint = "it belongs in conditions"
        raise source.error(f'"{head}" cannot be an effect', node.location, hint, "not-an-effect")
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
            'only an atom can stand in an effect\'s "not"',
            inner.location,
            "write (not (predicate ...))",
            "not-an-effect",
        )
    return Effect(read_atom(inner, source), positive, around.condition(), around.parameters, node.location)


def _read_cost(node: Group, source: Source, around: _Around, found: Effects) -> None:
    _expect(node, 2, "(increase (total-cost) number)", source)
    target, amount = node.parts[1:]
    name = target.head if isinstance(target, Group) else target.text
    if name != TOTAL_COST:
        raise unsupported(source, "numeric fluents", name, node.location, _ONLY_COSTS)
    if around.parameters or around.conditions:
        raise unsupported(source, "costs that depend on conditions", "increase", node.location)
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
