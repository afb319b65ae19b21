"""Environments of VEIL-500: objects with class, position, states, affordances and their whole."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from tmd.datasets.veil500.classes import IGNORED_STATES, VeilObjectClass, class_of, is_true
from tmd.datasets.veil500.forms import pddl_name
from tmd.datasets.veil500.xml import Element, read_xml
from tmd.diagnostics import DataError

_TV_BUTTONS = tuple(f"{{0}}{kind}Button" for kind in ("Power", "ChannelUp", "ChannelDown", "VolumeUp", "VolumeDown"))
# the parts of wholes by class; {0} stands for the name of the whole; all other classes have no parts
_PARTS: Mapping[str, tuple[str, ...]] = {
    "Microwave": ("MicrowaveDoor", "MicrowaveButton"),
    "Fridge": ("FridgeLeftDoor", "FridgeRightDoor", "FridgeButton"),
    "Stove": tuple(f"Stove{kind}_{k}" for kind in ("Knob", "Fire") for k in range(1, 5)),
    "Sink": ("SinkKnob",),
    "Tv": _TV_BUTTONS,
    "Tv_1Remote": (*_TV_BUTTONS, "{0}MuteButton"),
    "Spoon": ("IceCreamScoop",),
}


def parents(classes: Mapping[str, str]) -> dict[str, str]:
    """Return the whole of every part, given the class of every object of an environment."""
    found: dict[str, str] = {}
    for name, object_class in classes.items():
        for pattern in _PARTS.get(object_class, ()):
            part = pattern.format(name)
            if part in classes:
                found.setdefault(part, name)
    return found


KITCHEN = "kitchen"
LIVING_ROOM = "living_room"
FOLDERS = {KITCHEN: "kitchen", LIVING_ROOM: "livingRoom"}
"""The directory below ``Environments/`` of each world; file names begin with the same word."""

PLACEHOLDER = (-200.0, -200.0, -200.0)
"""The position of things whose true one was not recorded."""

ALWAYS_TRUE = frozenset({("Mug_1", "Coffee"), ("Syrup_1", "Vanilla"), ("Syrup_2", "Chocolate")})
"""States that hold at the start whatever the file says."""

_NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")


class Vector(NamedTuple):
    """A position (``y`` is up, a unit is about 2 cm) or a rotation in degrees."""

    x: float
    y: float
    z: float


@dataclass(frozen=True, slots=True)
class VeilObject:
    """An object.

    Attributes:
        name: As the data set writes it, with a capital.
        pddl: Its PDDL name.
        kind: Its class.
        position: Where it is; a placeholder is replaced by the position of the whole.
        rotation: In degrees.
        states: Value of every state that the class declares.
        affordances: What it is good for.
        placeholder: Whether the file held a placeholder instead of a position.
        parent: The whole it is a part of.
    """

    name: str
    pddl: str
    kind: str
    position: Vector
    rotation: Vector
    states: Mapping[str, bool] = field(hash=False)
    affordances: frozenset[str]
    placeholder: bool = False
    parent: str | None = None


@dataclass(frozen=True, slots=True)
class VeilEnvironment:
    """An environment.

    Attributes:
        world: ``kitchen`` or ``living_room``.
        number: The number of its file.
        objects: In file order.
        dropped: States of the file that no class declares, as (object, state).
        repeated: Objects that the file describes again; the first description counts.
        path: The file.
        by_name: The objects by VEIL name.
    """

    world: str
    number: int
    objects: tuple[VeilObject, ...]
    dropped: tuple[tuple[str, str], ...] = ()
    repeated: tuple[str, ...] = ()
    path: str = ""
    by_name: Mapping[str, VeilObject] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "by_name", MappingProxyType({o.name: o for o in self.objects}))

    @property
    def key(self) -> tuple[str, int]:
        """World and file number."""
        return self.world, self.number

    @property
    def names(self) -> dict[str, str]:
        """PDDL name to VEIL name, for :func:`tmd.datasets.veil500.forms.to_veil`."""
        return {o.pddl: o.name for o in self.objects}


def read_environment(path: Path, world: str, number: int, classes: Mapping[str, VeilObjectClass]) -> VeilEnvironment:
    """Return an environment file.

    Raises:
        DataError: The file is missing or broken, or holds a name or a position that cannot be read.
    """
    root = read_xml(path, "environment")
    raw: dict[str, Element] = {}
    seen: set[str] = set()
    repeated: list[str] = []
    for element in root.all("object"):
        spelled = element.need("name").text.strip()
        name = spelled[:1].upper() + spelled[1:]
        if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name):
            raise DataError(
                f"'{name}' is not a name for an object",
                location=element.location,
                hint="names are letters, digits and underscores; copy the file again from the release",
            )
        if name.lower() in seen:
            repeated.append(name)
            continue
        raw[name] = element
        seen.add(name.lower())
    if not raw:
        raise DataError("no object in the file", location=root.location, hint="copy it again from the release")
    positions = {name: _vector(element, "position", PLACEHOLDER) for name, element in raw.items()}
    kinds = {name: class_of(name) for name in raw}
    whole = parents(kinds)
    objects: list[VeilObject] = []
    dropped: list[tuple[str, str]] = []
    for name, element in raw.items():
        own = classes.get(kinds[name], VeilObjectClass(kinds[name]))
        states, unknown = _states(name, element, own)
        dropped += unknown
        placeholder = positions[name] == PLACEHOLDER
        parent = whole.get(name)
        position = positions[parent] if placeholder and parent else positions[name]
        rotation = _vector(element, "rotation", (0.0, 0.0, 0.0))
        objects.append(
            VeilObject(
                name,
                pddl_name(name),
                kinds[name],
                position,
                rotation,
                states,
                own.affordances,
                placeholder,
                parent,
            )
        )
    return VeilEnvironment(world, number, tuple(objects), tuple(dropped), tuple(repeated), str(path))


def _states(name: str, element: Element, own: VeilObjectClass) -> tuple[Mapping[str, bool], list[tuple[str, str]]]:
    """Return an object's states, and the file's states that its class does not declare."""
    states = dict(own.states)
    dropped = []
    for state in element.all("state"):
        key = state.get("statename")
        if key in states:
            states[key] = is_true(state.get("statevalue"))
        elif key not in IGNORED_STATES:
            dropped.append((name, key))
    for key in states:
        if (name, key) in ALWAYS_TRUE:
            states[key] = True
    return MappingProxyType(states), dropped


def _vector(thing: Element, tag: str, default: tuple[float, float, float]) -> Vector:
    """Return three numbers, with or without brackets round them; the default where nothing is said."""
    found = thing.all(tag)
    if not found:
        return Vector(*default)
    numbers = _NUMBER.findall(found[0].text)
    if len(numbers) != 3:
        raise DataError(
            f"<{tag}> needs three numbers, not '{found[0].text.strip()}'",
            location=found[0].location,
            hint="write x,y,z",
        )
    return Vector(*(float(number) for number in numbers))
