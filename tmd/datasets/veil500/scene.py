"""Rooms of VEIL-500 as environments that a robot's scene can be built of.

The data set has positions of the middles of things, and no sizes. What is built keeps what the honest rule reads from
them (what is on or in what), and finds places of its own. What things look like is in ``scene.yaml`` of the sane
domain, by kind.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from tmd.datasets.veil500.compile import compile_environment
from tmd.datasets.veil500.data import CLASSES, ENVIRONMENTS
from tmd.datasets.veil500.environment import FOLDERS, VeilEnvironment, VeilObject, read_classes, read_environment
from tmd.datasets.veil500.forms import domain_path
from tmd.diagnostics import DataError, Location, TmdError
from tmd.pddl.model import OBJECT, Problem
from tmd.world.classes import Classes, StateValue
from tmd.world.environment import Environment, ObjectEntry
from tmd.world.folder import DomainFolder
from tmd.world.yaml_positions import YamlSource

SHAPES = "scene.yaml"
_BUILT_IN = {"fixture": OBJECT, "item": OBJECT, "part": OBJECT}
_CONTENTS = ("Water", "Coffee", "Coke", "EnergyDrink", "IceCream", "Chocolate", "CanadaDry", "Vanilla", "Ramen", "Egg")
"""The states that say what a vessel holds, in the order in which they are shown."""
_PART_STATES: dict[tuple[str, str], tuple[tuple[str, str, StateValue], ...]] = {
    ("microwave", "DoorIsOpen"): (("door", "opened", True),),
    ("microwave", "MicrowaveIsOn"): (("", "active", True),),
    ("fridge", "RightDoorIsOpen"): (("right_door", "opened", True),),
    ("sink", "TapIsOn"): (("tap", "active", True), ("knob", "set_to", "high")),
    ("tv", "IsOn"): (("", "active", True),),
    **{("stove", f"StoveFire{k}"): ((f"fire_{k}", "active", True), (f"knob_{k}", "set_to", "on")) for k in range(1, 5)},
}
"""What a state of a whole looks like: parts (empty: the whole) with a predicate and its value."""


class SceneFolder(DomainFolder):
    """The sane domain, with the shapes of ``scene.yaml`` where others have ``objects.yaml``."""

    @cached_property
    def classes(self) -> Classes:
        """``scene.yaml``.

        Raises:
            TmdError: It is missing or wrong.
        """
        return Classes(YamlSource(self.path / SHAPES), _BUILT_IN)


class _XmlFile(YamlSource):
    """Errors about a file of the data set, which names no places."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def error(self, path: Sequence[str | int], message: str, hint: str | None = None, code: str = "") -> TmdError:
        """Return the hint of a YAML file (other sizes, other places) is none for the data set."""
        return TmdError(message, location=self.locate(path), code=code)

    def locate(self, path: Sequence[str | int]) -> Location:
        """Return the file."""
        return Location(str(self.path), 1, 1)


@dataclass(frozen=True, slots=True)
class VeilScene:
    """A room of VEIL-500, ready to be built.

    Attributes:
        environment: What there is and where.
        folder: The shapes.
        problem: The same under the sane rules.
        remarks: What is not as the data set has it.
    """

    environment: Environment
    folder: DomainFolder
    problem: Problem
    remarks: tuple[str, ...]


def read_room(path: Path) -> VeilEnvironment:
    """Read one environment file of a copy of VEIL-500: ``DIR/Environments/kitchen/kitchen3.xml``.

    Raises:
        DataError: The file, or ``DIR/Objects.xml``, is missing or wrong, or lies elsewhere.
    """
    path = path.resolve()
    worlds = {folder: world for world, folder in FOLDERS.items()}
    digits = path.stem.removeprefix(path.parent.name)
    if path.parent.name not in worlds or path.parent.parent.name != ENVIRONMENTS or not digits.isdecimal():
        raise DataError(
            f"{path} is not an environment of VEIL-500",
            hint="give a file such as DIR/Environments/kitchen/kitchen3.xml",
        )
    classes = read_classes(path.parents[2] / CLASSES)
    return read_environment(path, worlds[path.parent.name], int(digits), classes)


def scene_of(room: VeilEnvironment) -> VeilScene:
    """Return an environment of VEIL-500 as one that can be built.

    Raises:
        TmdError: ``scene.yaml`` is missing or wrong.
    """
    folder = SceneFolder(domain_path("sane").parent)
    problem = compile_environment(room, "sane")
    at = {atom.args[0]: atom.args[1:] for atom in sorted(problem.init) if atom.predicate == "at"}
    remarks: list[str] = []
    names = {
        thing.pddl: _part(thing, room.by_name[thing.parent], folder.classes, remarks)
        for thing in room.objects
        if thing.parent is not None
    }
    entries = {
        thing.pddl: _entry(
            [thing, *(part for part in room.objects if part.parent == thing.name)],
            folder.classes,
            _place(at.get(thing.pddl), names),
            remarks,
        )
        for thing in room.objects
        if thing.parent is None
    }
    about = f"VEIL-500, {room.world} {room.number}"
    environment = Environment(problem.name, folder.name, about, entries, (), _XmlFile(Path(room.path)), names)
    return VeilScene(environment, folder, problem, tuple(remarks))


def _place(at: tuple[str, ...] | None, names: Mapping[str, str]) -> str | None:
    """Return the place of a thing in the words of an environment: ``on stove_fire_1``."""
    return None if at is None else f"{at[1]} {names.get(at[0], at[0])}"


def _kind(thing: VeilObject, classes: Classes) -> str:
    """Return the class that says what a thing looks like."""
    kind = thing.kind.lower()
    if kind in classes.entries.classes:
        return kind
    return "item" if "IsGraspable" in thing.affordances else "fixture"


def _entry(things: Sequence[VeilObject], classes: Classes, place: str | None, remarks: list[str]) -> ObjectEntry:
    """Return an object as an environment has it; ``things`` are the object and its parts."""
    thing = things[0]
    kind = _kind(thing, classes)
    if kind != thing.kind.lower():
        plain = "box" if kind == "item" else "counter"
        remarks.append(f"{thing.pddl}: nobody said what such a thing looks like, so it is a plain {plain}")
    item = classes.is_below(kind, "item")
    if item and place is None:
        remarks.append(f"{thing.pddl}: nothing is told of where it stands, so it is on the floor")
    states, parts = _states(things, kind, classes)
    return ObjectEntry.model_validate(
        {"class": kind, "at": (place or "on floor") if item else None, "states": states, "parts": parts}
    )


def _states(
    things: Sequence[VeilObject], kind: str, classes: Classes
) -> tuple[dict[str, StateValue], dict[str, dict[str, StateValue]]]:
    """Return the visible states of an object, and of its parts."""
    known = classes.get(kind)
    states: dict[str, StateValue] = {}
    parts: dict[str, dict[str, StateValue]] = {}
    true = [state for thing in things for state, value in thing.states.items() if value]
    for state in true:
        for part, predicate, seen in _PART_STATES.get((kind, state), ()):
            if part in known.vertices:
                parts.setdefault(part, {})[predicate] = seen
            elif not part:
                states[predicate] = seen
    if "contains" in known.vertices["root"].states:
        states["contains"] = [state.lower() for state in _CONTENTS if state in true]
    return states, parts


def _part(thing: VeilObject, whole: VeilObject, classes: Classes, remarks: list[str]) -> str:
    """Return the name in the scene of the part that an object of the data set is; of its whole if there is none."""
    vertices = classes.get(_kind(whole, classes)).vertices
    said = _bare(thing.pddl).removeprefix(_bare(whole.pddl))
    part = next((name for name in vertices if _bare(name) == said), None)
    if part is None:
        remarks.append(f"{thing.pddl}: it is not a part of its own here, but stands for {whole.pddl}")
        return whole.pddl
    return f"{whole.pddl}_{part}"


def _bare(name: str) -> str:
    """Return a name without what its spelling adds."""
    return name.replace("_", "")
