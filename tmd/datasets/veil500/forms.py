"""The PDDL domains of VEIL-500, and its action forms as instructions of Table I: one to one, both ways.

VEIL writes ``keep Mug_1 On Sink``; the paper's Table I writes ``keep(obj1, obj2, R)``, and so do the PDDL
domains: ``keep(mug_1, sink, on)``. Names in PDDL are lower case, so the way back needs the table of names of
an environment. Two VEIL verbs hide several instructions each: ``add IceCreamScoop y`` is Table I's
``scoopTo``, done with the only spoon, and ``pour`` with one argument empties a vessel.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Literal, TypeAlias

from tmd.diagnostics import DataError, Location, TmdError
from tmd.files import bundled
from tmd.pddl.model import OBJECT, Domain, Instruction
from tmd.pddl.reading.reader import read_domain

SCOOP = "icecreamscoop"
"""The scoop of ice cream on the spoon. No action moves it, it only names what is added."""

SPOON = "spoon_1"
"""The spoon that VEIL's rule for adding a scoop means, even if another one is held."""

RELATIONS = {"on": "On", "in": "In", "inside": "Inside", "next_to": "Near"}
"""PDDL constant to VEIL word. ``Near`` between things is ``next_to``: ``near`` relates the robot to a thing."""

_TOKEN = re.compile(r"[A-Za-z0-9][A-Za-z0-9_]*\Z")
_FROM_RELATION = {word.lower(): constant for constant, word in RELATIONS.items()}

Semantics: TypeAlias = Literal["literal", "sane"]
"""``literal`` is the data set's own simulator, for scoring; ``sane`` is for planning."""

DOMAINS: dict[Semantics, str] = {"literal": "veil500_literal", "sane": "veil500_sane"}
"""The folder below ``domains/`` of each semantics."""


def domain_path(semantics: Semantics) -> Path:
    """Return the ``domain.pddl`` of a semantics: in a checkout, or in the installed package.

    Raises:
        TmdError: Unknown semantics, or the file is not there.
    """
    if semantics not in DOMAINS:
        raise TmdError(f"no semantics '{semantics}' for VEIL-500", hint="choose literal or sane")
    place = f"{DOMAINS[semantics]}/domain.pddl"
    found = next((path for root in bundled("domains") if (path := root / place).is_file()), None)
    if found is None:
        raise TmdError(f"domains/{place} is missing", hint="install tmd again")
    return found


@lru_cache(maxsize=4)
def veil_domain(semantics: Semantics) -> Domain:
    """Return the PDDL domain of a semantics (read once).

    Raises:
        TmdError: As :func:`domain_path`.
    """
    return read_domain(domain_path(semantics))


@lru_cache(maxsize=1)
def reserved() -> frozenset[str]:
    """Return the names that the two domains use. Tools want each name once, so a thing of that name gets another."""
    kinds = [kind for d in map(veil_domain, DOMAINS) for kind in (d.types, d.constants, d.predicates, d.actions)]
    return frozenset({OBJECT, *(named.name for kind in kinds for named in kind)})


def pddl_name(name: str) -> str:
    """Return the PDDL name of an object or state of VEIL: ``Mug_1`` is ``mug_1``."""
    lower = name.lower()
    return f"{lower}_thing" if lower in reserved() else lower


def from_veil(text: str, location: Location | None = None) -> Instruction:
    """Return the instruction that a VEIL action is.

    A verb without a rule or a wrong number of arguments is kept as it stands: it names no action schema, so
    it is not executable and does nothing.

    Raises:
        DataError: The text is empty or holds something that is not a word.
    """
    tokens = text.split()
    if not tokens:
        raise DataError("an action without words", location=location, hint="delete it, or write: verb argument…")
    for token in tokens:
        if not _TOKEN.match(token):
            raise DataError(
                f"'{token}' in the action '{' '.join(tokens)}' is not a name",
                location=location,
                hint="names are letters, digits and underscores",
            )
    verb, *rest = (token.lower() for token in tokens)
    args = tuple(pddl_name(token) for token in rest)
    match verb, len(args):
        case "keep", 3:
            return Instruction("keep", (args[0], args[2], _FROM_RELATION.get(rest[1], args[1])))
        case "pour", 1:
            return Instruction("pour_out", args)
        case "scoop", 2:
            return Instruction("scoopfrom", args)
        case "add", 2 if args[0] == SCOOP:
            return Instruction("scoopto", (SPOON, args[1]))
    return Instruction(verb, args)


def to_veil(instruction: Instruction, names: Mapping[str, str]) -> str:
    """Return the VEIL action of an instruction.

    ``names`` maps PDDL names to VEIL names, as :attr:`VeilEnvironment.names` does; others stay as they are.

    Raises:
        DataError: VEIL cannot say it: scooping with something other than the one spoon.
    """
    verb, args = instruction
    spelled = [names.get(arg, arg) for arg in args]
    match verb, len(args):
        case "keep", 3:
            return f"keep {spelled[0]} {RELATIONS.get(args[2], args[2])} {spelled[1]}"
        case "pour_out", 1:
            return f"pour {spelled[0]}"
        case "scoopfrom", 2:
            return f"scoop {spelled[0]} {spelled[1]}"
        case "scoopto", 2:
            if args[0] != SPOON:
                raise DataError(
                    f"VEIL-500 has no action for {instruction}",
                    hint=f"only {SPOON} can scoop; name it instead",
                )
            return f"add {names.get(SCOOP, 'IceCreamScoop')} {spelled[1]}"
    return " ".join((verb, *spelled))


def mentioned(instruction: Instruction) -> tuple[str, ...]:
    """Return the objects that the VEIL action names, relation words left out (what the metrics call the cover)."""
    match instruction.name, len(instruction.args):
        case "keep", 3:
            return instruction.args[:2]
        case "scoopto", 2:
            return (SCOOP, instruction.args[1])
    return instruction.args
