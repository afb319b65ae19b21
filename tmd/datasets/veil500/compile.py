"""VEIL-500 environments as PDDL problems, under the literal or the sane semantics."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Literal, TypeAlias

from tmd.datasets.veil500.environment import VeilEnvironment, VeilObject
from tmd.datasets.veil500.forms import pddl_name
from tmd.datasets.veil500.relations import RelationRule, initial_relations
from tmd.datasets.veil500.rules import DISPATCH, NamedFact, rule_facts, sane_facts
from tmd.diagnostics import TmdError
from tmd.pddl.model import Domain, GroundAtom, Problem, TypedName
from tmd.pddl.reading.reader import read_domain

Semantics: TypeAlias = Literal["literal", "sane"]
"""``literal`` is the data set's own simulator, for scoring; ``sane`` is for planning."""

DOMAINS = {"literal": "veil500_literal", "sane": "veil500_sane"}
"""The folder below ``domains/`` of each semantics."""


def domain_path(semantics: Semantics) -> Path:
    """The ``domain.pddl`` of a semantics: in a checkout, or in the installed package.

    Raises:
        TmdError: Unknown semantics, or the file is not there.
    """
    if semantics not in DOMAINS:
        raise TmdError(f"no semantics '{semantics}' for VEIL-500", hint="choose literal or sane")
    package = Path(__file__).resolve().parents[2]
    for root in (package.parent / "domains", package / "bundled" / "domains"):
        path = root / DOMAINS[semantics] / "domain.pddl"
        if path.is_file():
            return path
    raise TmdError(f"domains/{DOMAINS[semantics]}/domain.pddl is missing", hint="install tmd again")


@lru_cache(maxsize=4)
def veil_domain(semantics: Semantics) -> Domain:
    """The PDDL domain of a semantics (read once).

    Raises:
        TmdError: As :func:`domain_path`.
    """
    return read_domain(domain_path(semantics))


def compile_environment(
    environment: VeilEnvironment,
    semantics: Semantics = "literal",
    relations: RelationRule | None = None,
) -> Problem:
    """The PDDL problem of an environment at its start, without a goal.

    Args:
        environment: What to compile.
        semantics: Whose rules.
        relations: What is on what at the start; by default ``literal`` for the literal semantics and
            ``honest`` for the sane one.

    Raises:
        TmdError: Unknown semantics or rule.
    """
    domain = _with_states(veil_domain(semantics), environment)
    rule: RelationRule = relations or ("literal" if semantics == "literal" else "honest")
    objects = tuple(TypedName(thing.pddl, (_type(thing, semantics),)) for thing in environment.objects)
    facts = list(rule_facts(environment))
    if semantics == "sane":
        facts = [*_adapted(facts), *sane_facts(environment)]
    spelled = {thing.name: thing.pddl for thing in environment.objects}
    init = {GroundAtom(fact[0], tuple(spelled.get(arg, arg) for arg in fact[1:])) for fact in facts}
    for thing in environment.objects:
        init.update(GroundAtom("is", (thing.pddl, s.lower())) for s, value in thing.states.items() if value)
    placed = [
        GroundAtom("at", (spelled[thing], spelled[place], kind))
        for thing, kind, place in initial_relations(environment, rule)
    ]
    init.update(placed)
    if semantics == "sane":
        init.update(_shut_away(placed, frozenset(init)))
    return Problem(f"{environment.world}{environment.number}", domain, objects, frozenset(init))


def absent_types(environment: VeilEnvironment) -> dict[str, str]:
    """PDDL name and type of things that the environment lacks and that the rules still know by name.

    ``add IceCreamScoop Plate_1`` fills the plate by force even where there is no spoon.
    """
    return {pddl_name(n): kind for n, kind in DISPATCH.items() if n not in environment.by_name}


def _type(thing: VeilObject, semantics: Semantics) -> str:
    """The PDDL type: what the rules choose by name has its own, the sane domain knows what can be carried."""
    special = DISPATCH.get(thing.name)
    if semantics == "sane":
        carried = "IsGraspable" in thing.affordances
        if special in (None, "cutlery", "openable"):
            return "item" if carried else "thing"
        if special in ("additive", "scooper") and not carried:
            return "thing"
    return special or "thing"


def _with_states(domain: Domain, environment: VeilEnvironment) -> Domain:
    """The domain with a constant for every state of the environment's classes that it does not know."""
    known = {constant.name for constant in domain.constants}
    states = {state.lower() for thing in environment.objects for state in thing.states}
    missing = tuple(TypedName(state, ("state",)) for state in sorted(states - known))
    return replace(domain, constants=domain.constants + missing) if missing else domain


def _adapted(facts: Iterable[NamedFact]) -> Iterator[NamedFact]:
    """The literal rules as the sane domain has them: mute needs the remote, gates are ``closed_off``."""
    for fact in facts:
        if fact[0] in ("graspable", "gated") or fact == ("worked_freely", "Tv_1Remote_1MuteButton"):
            continue
        if fact[0] == "yields" and fact[1] in ("Fork_1", "Spoon_1"):
            continue
        yield fact


def _shut_away(placed: Iterable[GroundAtom], init: frozenset[GroundAtom]) -> Iterator[GroundAtom]:
    """The things that are behind a closed door at the start: no door round their place is open."""
    open_doors: set[str] = set()
    enclosed: set[str] = set()
    for fact in init:
        if fact.predicate == "swings" and GroundAtom("is", fact.args[1:]) in init:
            open_doors.add(fact.args[1])
        elif fact.predicate == "encloses":
            enclosed.add(fact.args[1])
    for _, (thing, place, relation) in placed:
        if relation == "in" and place in enclosed and place not in open_doors:
            yield GroundAtom("shut_away", (thing,))
