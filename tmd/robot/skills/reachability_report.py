"""What stands where in a scene, and from where the robot would take it."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees

from tmd.robot.sim.pose import Pose, Vector
from tmd.robot.skills.pick_and_place import pick_options
from tmd.robot.skills.robot_context import Cell
from tmd.robot.skills.stance_search import Base, candidates, stances, with_room


@dataclass(frozen=True, slots=True)
class ReachabilityEntry:
    """One object.

    Attributes:
        name: Its name.
        kind: The kind of its shape.
        item: Whether it can be carried.
        position: Of the middle of its underside, in metres.
        place: What it is on, in or next to, and how; ``None`` for furniture and for what hangs in the air.
    """

    name: str
    kind: str
    item: bool
    position: Vector
    place: tuple[str, str] | None


@dataclass(frozen=True, slots=True)
class Stance:
    """Where the robot stands to take an item, or before furniture.

    Attributes:
        base: x and y in metres, heading in radians.
        side: The hand, ``left`` or ``right``; empty before furniture.
    """

    base: Base
    side: str = ""

    def __str__(self) -> str:
        x, y, heading = self.base
        hand = f", {self.side} hand" if self.side else ""
        return f"from {x:.2f} {y:.2f}, facing {degrees(heading):.0f}°{hand}"


def survey(cell: Cell) -> list[ReachabilityEntry]:
    """All objects, in file order."""
    scene = cell.scene
    return [
        ReachabilityEntry(
            name,
            blueprint.look.kind,
            scene.is_item(name),
            cell.sim.pose(scene.bodies[name]).position,
            scene.supported(name) if scene.is_item(name) else None,
        )
        for name, blueprint in scene.blueprints.items()
    ]


def stance(cell: Cell, name: str) -> Stance | None:
    """From where the robot can take an item as everything stands now, or be before furniture; ``None`` if nowhere."""
    focus = Pose(cell.centre(name))
    if not cell.scene.is_item(name):
        return next(
            (Stance(base) for base in stances(cell, focus, cell.front(name)) if not cell.robot.collides(base=base)),
            None,
        )
    options = with_room(cell, pick_options(cell, name))
    found = next(candidates(cell, options, focus, cell.front(name)), None)
    return None if found is None else Stance(found.base, found.option.side)
