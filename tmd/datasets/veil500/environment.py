"""Object classes (``Objects.xml``) and environments of VEIL-500.

A class declares states and affordances; an object has class, position, states, affordances and its whole.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from tmd.datasets.veil500.forms import pddl_name
from tmd.datasets.veil500.xml import Element, read_xml
from tmd.diagnostics import DataError

IGNORED_STATES = frozenset({"Color"})
"""Declared by nearly every class, set by no action and no environment."""


@dataclass(frozen=True, slots=True)
class VeilObjectClass:
    """A class: its states with their values at the start, in file order, and its affordances."""

    name: str
    states: Mapping[str, bool] = field(default_factory=dict)
    affordances: frozenset[str] = frozenset()


def class_of(object_name: str) -> str:
    """Return the class that an object's name says: ``Mug_1`` is a Mug, ``Counter1_1`` a Counter."""
    return re.sub(r"[_\d]+\Z", "", object_name)


def is_true(value: str) -> bool:
    """Return a state's value as a Boolean: ``True`` and positive whole numbers are true, all else is false."""
    value = value.strip()
    return value == "True" or (value.isdecimal() and int(value) > 0)


def read_classes(path: Path) -> dict[str, VeilObjectClass]:
    """Return the classes of ``Objects.xml``. Blocks about one class add up; the first default of a state counts.

    Raises:
        DataError: The file is missing, broken or without classes.
    """
    root = read_xml(path, "objects")
    states: dict[str, dict[str, bool]] = {}
    affordances: dict[str, set[str]] = {}
    for block in root.all("object"):
        declared = _declared(block)
        offered = [element.text.strip() for element in block.walk() if element.tag == "affordance"]
        for name in (element.text.strip() for element in block.all("name")):
            own = states.setdefault(name, {})
            for state, value in declared:
                own.setdefault(state, value)
            affordances.setdefault(name, set()).update(offered)
    if not states:
        raise DataError(
            "no object class in the file",
            location=root.location,
            hint="copy Objects.xml again from the release",
        )
    return {name: VeilObjectClass(name, own, frozenset(affordances[name])) for name, own in states.items()}


def _declared(block: Element) -> list[tuple[str, bool]]:
    """Return all ``stateName``/``default`` pairs of a block, wherever they stand."""
    found = []
    for element in block.walk():
        for name, default in zip(element.all("stateName"), element.all("default"), strict=False):
            state = name.text.strip()
            if state not in IGNORED_STATES:
                found.append((state, is_true(default.text)))
    return found


TV_BUTTONS = ("Power", "ChannelUp", "ChannelDown", "VolumeUp", "VolumeDown")
"""The buttons of a television, each ``…Button``; its remote has another one, ``Mute``."""
# the parts of wholes by class; {0} is the name of the whole; all other classes have no parts
_PARTS: Mapping[str, tuple[str, ...]] = {
    "Microwave": ("MicrowaveDoor", "MicrowaveButton"),
    "Fridge": ("FridgeLeftDoor", "FridgeRightDoor", "FridgeButton"),
    "Stove": tuple(f"Stove{kind}_{k}" for kind in ("Knob", "Fire") for k in range(1, 5)),
    "Sink": ("SinkKnob",),
    "Tv": tuple(f"{{0}}{kind}Button" for kind in TV_BUTTONS),
    "Tv_1Remote": tuple(f"{{0}}{kind}Button" for kind in (*TV_BUTTONS, "Mute")),
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


class Vector(NamedTuple):
    """A position; ``y`` is up, a unit is about 2 cm."""

    x: float
    y: float
    z: float


PLACEHOLDER = Vector(-200.0, -200.0, -200.0)
"""The position of things whose true one was not recorded."""

ALWAYS_TRUE = frozenset({("Mug_1", "Coffee"), ("Syrup_1", "Vanilla"), ("Syrup_2", "Chocolate")})
"""States that always hold at the start; the file is not asked."""

_NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")


@dataclass(frozen=True, slots=True)
class VeilObject:
    """An object.

    Attributes:
        name: As the data set writes it, with a capital.
        pddl: Its PDDL name.
        position: Where it is; a placeholder is replaced by the position of the whole.
        placeholder: Whether the file held a placeholder instead of a position.
    """

    name: str
    pddl: str
    kind: str
    position: Vector
    states: Mapping[str, bool] = field(hash=False)
    affordances: frozenset[str]
    placeholder: bool = False
    parent: str | None = None


@dataclass(frozen=True, slots=True)
class VeilEnvironment:
    """An environment.

    Attributes:
        world: ``kitchen`` or ``living_room``.
        objects: In file order.
        dropped: States of the file that no class declares, as (object, state).
        repeated: Objects that the file describes again; the first description counts.
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
    positions = {name: _position(element) for name, element in raw.items()}
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
        objects.append(
            VeilObject(
                name,
                pddl_name(name),
                kinds[name],
                position,
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


def _position(thing: Element) -> Vector:
    """Return three numbers, with or without brackets round them; the placeholder if there is no ``<position>``."""
    found = thing.all("position")
    if not found:
        return PLACEHOLDER
    numbers = _NUMBER.findall(found[0].text)
    if len(numbers) != 3:
        raise DataError(
            f"<position> needs three numbers, not '{found[0].text.strip()}'",
            location=found[0].location,
            hint="write x,y,z",
        )
    return Vector(*(float(number) for number in numbers))
