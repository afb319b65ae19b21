"""What works what in VEIL-500, as facts for the PDDL domains.

The rules of the data set's simulator name objects: ``press MicrowaveButton`` switches Microwave.MicrowaveIsOn
when the robot is near Microwave. The schemas of our domains name none; this table says it as facts about the
objects that an environment has. Objects of other names have no rule, as in the original.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

from tmd.datasets.veil500.environment import VeilEnvironment

NamedFact: TypeAlias = tuple[str, ...]
"""A predicate and its arguments: objects by VEIL name, which has a capital, constants by PDDL name."""

TV = "Tv_1"
REMOTE = "Tv_1Remote_1"

DISPATCH = {
    "SinkKnob": "knob",
    **{f"StoveKnob_{k}": "knob" for k in range(1, 5)},
    "MicrowaveButton": "button",
    "FridgeButton": "button",
    **{f"{TV}{kind}Button": "button" for kind in ("Power", "ChannelUp", "ChannelDown", "VolumeUp", "VolumeDown")},
    **{
        f"{REMOTE}{kind}Button": "button"
        for kind in ("Power", "ChannelUp", "ChannelDown", "VolumeUp", "VolumeDown", "Mute")
    },
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
    """The buttons on the screen and on the remote; the remote's mute button wants the robot at the screen."""
    for carrier in (TV, REMOTE):
        yield ("works", f"{carrier}PowerButton", TV, "ison")
        yield ("raises", f"{carrier}VolumeUpButton", TV)
        yield ("lowers", f"{carrier}VolumeDownButton", TV)
        for here in range(1, _CHANNELS + 1):
            after = here % _CHANNELS + 1
            yield ("steps", f"{carrier}ChannelUpButton", TV, f"channel{here}", f"channel{after}")
            yield ("steps", f"{carrier}ChannelDownButton", TV, f"channel{after}", f"channel{here}")
        for kind in ("Power", "ChannelUp", "ChannelDown", "VolumeUp", "VolumeDown"):
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
    """The facts of the literal rules that hold among the objects an environment has."""
    present = environment.by_name
    declared = {thing.name: {state.lower() for state in thing.states} for thing in environment.objects}
    constants = {state for states in declared.values() for state in states} | {
        "on",
        "in",
        "inside",
        "next_to",
    }
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
    """What the sane domain knows beyond :func:`rule_facts`: supports, doors round insides, burners."""
    present = environment.by_name
    for thing in environment.objects:
        if "IsPlaceableOn" in thing.affordances:
            yield ("supports", thing.name, "on")
        if "IsPlaceableIn" in thing.affordances:
            yield ("supports", thing.name, "in")
            yield ("supports", thing.name, "inside")
        yield ("supports", thing.name, "next_to")
        for relation in ("in", "inside"):
            if thing.name in ("Microwave", "Fridge"):
                yield ("closed_off", thing.name, relation)
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
