"""VEIL-500 environments as PDDL problems, under the literal or the sane semantics."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import TypeAlias

from tmd.datasets.veil500.environment import TV_BUTTONS, VeilEnvironment, VeilObject
from tmd.datasets.veil500.forms import RELATIONS, Semantics, pddl_name, veil_domain
from tmd.datasets.veil500.relations import RelationRule, initial_relations
from tmd.pddl.model import Domain, GroundAtom, Problem, TypedName

NamedFact: TypeAlias = tuple[str, ...]
"""A predicate and its arguments: objects by VEIL name, which has a capital, constants by PDDL name."""

TV = "Tv_1"
REMOTE = "Tv_1Remote_1"

DISPATCH = {
    "SinkKnob": "knob",
    **{f"StoveKnob_{k}": "knob" for k in range(1, 5)},
    "MicrowaveButton": "button",
    "FridgeButton": "button",
    **{f"{TV}{kind}Button": "button" for kind in TV_BUTTONS},
    **{f"{REMOTE}{kind}Button": "button" for kind in (*TV_BUTTONS, "Mute")},
    "Microwave": "door",
    "FridgeLeftDoor": "door",
    "FridgeRightDoor": "door",
    "BagOfChips_1": "openable",
    "Salt_1": "additive",
    "Ramen_1": "additive",
    "BoiledEgg_1": "additive",
    "Fork_1": "cutlery",
    "Spoon_1": "scooper",
}
"""The objects that the rules choose by name, and the type that makes the schemas choose them."""

_CHANNELS = 6

_FIXED: tuple[NamedFact, ...] = (
    ("works", "SinkKnob", "SinkKnob", "tapison"),
    ("feeds", "SinkKnob", "Sink"),
    ("reached_at", "SinkKnob", "Sink"),
    *(("works", f"StoveKnob_{k}", "Stove", f"stovefire{k}") for k in range(1, 5)),
    *(("reached_at", f"StoveKnob_{k}", "Stove") for k in range(1, 5)),
    ("works", "MicrowaveButton", "Microwave", "microwaveison"),
    ("reached_at", "MicrowaveButton", "Microwave"),
    ("worked_freely", "MicrowaveButton"),
    ("works", "FridgeButton", "Fridge", "waterdispenserisopen"),
    ("dispenses", "FridgeButton", "Fridge"),
    ("reached_at", "FridgeButton", "Fridge"),
    ("worked_freely", "FridgeButton"),
    ("swings", "Microwave", "Microwave", "doorisopen"),
    ("stops", "Microwave", "Microwave", "microwaveison"),
    ("reached_at", "Microwave", "Microwave"),
    ("swings", "FridgeLeftDoor", "Fridge", "leftdoorisopen"),
    ("stops", "FridgeLeftDoor", "Fridge", "waterdispenserisopen"),
    ("reached_at", "FridgeLeftDoor", "Fridge"),
    ("swings", "FridgeRightDoor", "Fridge", "rightdoorisopen"),
    ("reached_at", "FridgeRightDoor", "Fridge"),
    ("opened_in_hand", "BagOfChips_1"),
    ("gated", "Microwave", "in"),
    ("hand_fed", "GarbageBag_1", "in"),
    ("yields", "Salt_1", "salt"),
    ("yields", "Ramen_1", "ramen"),
    ("yields", "BoiledEgg_1", "egg"),
    ("goes_whole", "Ramen_1"),
    ("goes_whole", "BoiledEgg_1"),
    ("yields", "Fork_1", "fork"),
    ("yields", "Spoon_1", "spoon"),
)

_STATE_FACTS = frozenset({"works", "swings", "stops"})
"""Facts whose last argument is a state of the argument before it."""


def _television() -> Iterator[NamedFact]:
    """Yield the buttons on the screen and on the remote; the remote's mute button wants the robot at the screen."""
    for carrier in (TV, REMOTE):
        yield ("works", f"{carrier}PowerButton", TV, "ison")
        yield ("raises", f"{carrier}VolumeUpButton", TV)
        yield ("lowers", f"{carrier}VolumeDownButton", TV)
        for here in range(1, _CHANNELS + 1):
            after = here % _CHANNELS + 1
            yield ("steps", f"{carrier}ChannelUpButton", TV, f"channel{here}", f"channel{after}")
            yield ("steps", f"{carrier}ChannelDownButton", TV, f"channel{after}", f"channel{here}")
        for kind in TV_BUTTONS:
            button = f"{carrier}{kind}Button"
            if carrier == TV:
                yield ("reached_at", button, TV)
                yield ("worked_freely", button)
            else:
                yield ("reached_anywhere", button)
                yield ("worked_by", button, REMOTE)
    mute = f"{REMOTE}MuteButton"
    yield ("lowers", mute, TV)
    yield ("reached_at", mute, TV)
    yield ("worked_freely", mute)


def rule_facts(environment: VeilEnvironment) -> Iterator[NamedFact]:
    """Yield the facts of the literal rules that hold among the objects an environment has."""
    present = environment.by_name
    declared = {thing.name: {state.lower() for state in thing.states} for thing in environment.objects}
    constants = {*RELATIONS, *(state for states in declared.values() for state in states)}
    for fact in (*_FIXED, *_television()):
        if not all(arg in present or arg in constants for arg in fact[1:]):
            continue
        if fact[0] in _STATE_FACTS and fact[3] not in declared[fact[2]]:
            continue
        yield fact
    for thing in environment.objects:
        for state in thing.states:
            yield ("declares", thing.name, state.lower())
        if "IsGraspable" in thing.affordances:
            yield ("graspable", thing.name)
        if "IsSqueezeable" in thing.affordances:
            yield ("squeezable", thing.name)


def sane_facts(environment: VeilEnvironment) -> Iterator[NamedFact]:
    """Yield the facts of the sane domain beyond :func:`rule_facts`: supports, doors, burners."""
    present = environment.by_name
    for thing in environment.objects:
        if "IsPlaceableOn" in thing.affordances:
            yield ("supports", thing.name, "on")
        if "IsPlaceableIn" in thing.affordances:
            yield ("supports", thing.name, "in")
            yield ("supports", thing.name, "inside")
        yield ("supports", thing.name, "next_to")
        if thing.name in ("Microwave", "Fridge"):
            yield from (("closed_off", thing.name, relation) for relation in ("in", "inside"))
        if thing.kind == "Microwave":
            yield ("needs_shut", thing.name)
    for door, whole, twin in (
        ("Microwave", "Microwave", None),
        ("FridgeLeftDoor", "Fridge", "rightdoorisopen"),
        ("FridgeRightDoor", "Fridge", "leftdoorisopen"),
    ):
        if door in present and whole in present:
            yield ("encloses", door, whole)
            yield ("only_door", door) if twin is None else ("twin_door", door, twin)
    for k in range(1, 5):
        if f"StoveFire_{k}" in present and f"StoveKnob_{k}" in present:
            yield ("lights", f"StoveKnob_{k}", f"StoveFire_{k}")
            if "Stove" in present and present["Stove"].states.get(f"StoveFire{k}"):
                yield ("lit", f"StoveFire_{k}")
    if REMOTE in present and f"{REMOTE}MuteButton" in present:
        yield ("worked_by", f"{REMOTE}MuteButton", REMOTE)


def compile_environment(
    environment: VeilEnvironment,
    semantics: Semantics = "literal",
    relations: RelationRule | None = None,
) -> Problem:
    """Return the PDDL problem of an environment at its start, without a goal.

    ``relations`` says what is on what at the start; by default ``literal`` for the literal semantics and ``honest`` for
    the sane one.

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
    """Return the PDDL type: what the rules choose by name has its own, the sane domain knows what can be carried."""
    special = DISPATCH.get(thing.name)
    if semantics == "sane":
        carried = "IsGraspable" in thing.affordances
        if special in (None, "cutlery", "openable"):
            return "item" if carried else "thing"
        if special in ("additive", "scooper") and not carried:
            return "thing"
    return special or "thing"


def _with_states(domain: Domain, environment: VeilEnvironment) -> Domain:
    """Return the domain with a constant for every state of the environment's classes that it does not know."""
    known = {constant.name for constant in domain.constants}
    states = {state.lower() for thing in environment.objects for state in thing.states}
    missing = tuple(TypedName(state, ("state",)) for state in sorted(states - known))
    return replace(domain, constants=domain.constants + missing) if missing else domain


def _adapted(facts: Iterable[NamedFact]) -> Iterator[NamedFact]:
    """Yield the literal rules as the sane domain has them: mute needs the remote, gates are ``closed_off``."""
    for fact in facts:
        if fact[0] in ("graspable", "gated") or fact == ("worked_freely", "Tv_1Remote_1MuteButton"):
            continue
        if fact[0] == "yields" and fact[1] in ("Fork_1", "Spoon_1"):
            continue
        yield fact


def _shut_away(placed: Iterable[GroundAtom], init: frozenset[GroundAtom]) -> Iterator[GroundAtom]:
    """Yield the things that are behind a closed door at the start: no door round their place is open."""
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
