"""Which VEIL-500 objects are parts of which, and what acting on a part changes (the paper's object graphs).

The data set gives nothing of this: its part objects have placeholder positions and no links. The small table
here names, for each class of whole, its parts and the edges between them. An edge says "acting on the tail
changes the head".
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class VeilVertex:
    """A part: its name in the graph, the object of the data set that stands for it, and its states."""

    part: str
    object: str
    states: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class PartGraph:
    """The directed graph of one object: the first vertex is the object itself."""

    object: str
    vertices: tuple[VeilVertex, ...]
    edges: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True, slots=True)
class _Kind:
    """What is known of a class of wholes. ``{0}`` in a part's object stands for the whole's name."""

    body: str
    body_states: tuple[str, ...]
    parts: tuple[tuple[str, str, tuple[str, ...]], ...]
    edges: tuple[tuple[str, str], ...]


_TV_BUTTONS = ("Power", "ChannelUp", "ChannelDown", "VolumeUp", "VolumeDown")


def _buttons(kinds: Iterable[str]) -> tuple[tuple[str, str, tuple[str, ...]], ...]:
    return tuple((f"{kind}Button", f"{{0}}{kind}Button", ()) for kind in kinds)


_KINDS = {
    "Microwave": _Kind(
        "body",
        ("MicrowaveIsOn",),
        (("door", "MicrowaveDoor", ("DoorIsOpen",)), ("button", "MicrowaveButton", ())),
        (("button", "body"), ("door", "body")),
    ),
    "Fridge": _Kind(
        "body",
        (),
        (
            ("left_door", "FridgeLeftDoor", ("LeftDoorIsOpen",)),
            ("right_door", "FridgeRightDoor", ("RightDoorIsOpen",)),
            ("dispenser", "Fridge", ("WaterDispenserIsOpen",)),
            ("button", "FridgeButton", ()),
        ),
        (("button", "dispenser"), ("left_door", "dispenser")),
    ),
    "Stove": _Kind(
        "body",
        (),
        tuple((f"knob_{k}", f"StoveKnob_{k}", ()) for k in range(1, 5))
        + tuple((f"fire_{k}", f"StoveFire_{k}", (f"StoveFire{k}",)) for k in range(1, 5)),
        tuple((f"knob_{k}", f"fire_{k}") for k in range(1, 5)),
    ),
    "Sink": _Kind("basin", (), (("knob", "SinkKnob", ("TapIsOn",)),), (("knob", "basin"),)),
    "Tv": _Kind(
        "screen",
        ("IsOn", "Channel1", "Channel2", "Channel3", "Channel4", "Channel5", "Channel6", "Volume"),
        _buttons(_TV_BUTTONS),
        tuple((f"{kind}Button", "screen") for kind in _TV_BUTTONS),
    ),
    "Tv_1Remote": _Kind(
        "remote",
        (),
        (*_buttons((*_TV_BUTTONS, "Mute")), ("screen", "Tv_1", ("IsOn", "Volume"))),
        tuple((f"{kind}Button", "screen") for kind in (*_TV_BUTTONS, "Mute")),
    ),
    "Xbox": _Kind("slot", ("CD",), (("cd", "Cd_1", ("CD",)),), (("cd", "slot"),)),
    "Spoon": _Kind("bowl", ("ScoopsLeft",), (("scoop", "IceCreamScoop", ()),), (("scoop", "bowl"),)),
    "BagOfChips": _Kind("bag", ("IsOpen", "HasChips"), (), ()),
}
"""The wholes, by class. All other classes are a single vertex."""

_NOT_PARTS = frozenset({"Tv_1", "Cd_1", "Fridge"})
"""Objects that a graph mentions although they are things of their own."""


def graph_of(name: str, object_class: str, states: Iterable[str], present: frozenset[str]) -> PartGraph:
    """The part graph of an object, with only the parts that the environment has."""
    kind = _KINDS.get(object_class)
    declared = tuple(states)
    if kind is None:
        return PartGraph(name, (VeilVertex("root", name, declared),))
    vertices = [VeilVertex(kind.body, name, kind.body_states)]
    for part, pattern, own in kind.parts:
        instance = pattern.format(name)
        if instance in present:
            vertices.append(VeilVertex(part, instance, own))
    known = {vertex.part for vertex in vertices}
    edges = tuple(edge for edge in kind.edges if edge[0] in known and edge[1] in known)
    return PartGraph(name, tuple(vertices), edges)


def parents(classes: dict[str, str]) -> dict[str, str]:
    """The whole of every part, given the class of every object of an environment."""
    found: dict[str, str] = {}
    for name, object_class in classes.items():
        kind = _KINDS.get(object_class)
        if kind is None:
            continue
        for _, pattern, _ in kind.parts:
            instance = pattern.format(name)
            if instance in classes and instance not in _NOT_PARTS and instance != name:
                found.setdefault(instance, name)
    return found
