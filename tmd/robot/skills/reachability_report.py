"""Survey of a scene: the place of each object, and the stances from which the robot takes it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import degrees
from pathlib import Path

import numpy as np

from tmd.robot.scene.scene import Scene
from tmd.robot.sim.pose import Pose, Vector
from tmd.robot.sim.simulator import Simulator
from tmd.robot.skills.pick_and_place import pick_options
from tmd.robot.skills.robot_context import Base, Cell, make_cell
from tmd.robot.skills.stance_search import candidates, stances, with_room
from tmd.robot.video.captions import pillow, write_picture
from tmd.short_repr import short_repr
from tmd.world.environment import Environment
from tmd.world.folder import DomainFolder

# Width and height of a picture of the room, in pixels.
PICTURE = (960, 640)


@dataclass(frozen=True, slots=True)
class ReachabilityEntry:
    """One object: kind of its shape, whether it can be carried, the middle of its underside in metres, and its support.

    ``place`` is the support and the relation; ``None`` for furniture and for what hangs in the air.
    """

    name: str
    kind: str
    item: bool
    position: Vector
    place: tuple[str, str] | None


@dataclass(frozen=True, slots=True)
class Stance:
    """A stance to take an item, or before furniture: x and y in metres, heading in radians; the hand, or no side."""

    base: Base
    side: str = ""

    def __str__(self) -> str:
        x, y, heading = self.base
        hand = f", {self.side} hand" if self.side else ""
        return f"from {x:.2f} {y:.2f}, facing {degrees(heading):.0f}°{hand}"


@short_repr(lambda survey: f"{survey.name}: {len(survey.entries)} objects")
@dataclass(frozen=True, slots=True)
class SceneSurvey:
    """An environment as the robot's room.

    Attributes:
        entries: All objects, in file order.
        stances: Of each object, ``None`` if the robot cannot reach it; empty if not asked for.
    """

    name: str
    entries: tuple[ReachabilityEntry, ...]
    stances: Mapping[str, Stance | None]


def survey_scene(
    environment: Environment,
    folder: DomainFolder,
    *,
    reach: bool = False,
    seed: int = 0,
    urdf: Path | None = None,
    picture: Path | None = None,
) -> SceneSurvey:
    """Build the room of an environment, put a PR2 into it, and return what stands where.

    ``reach`` also looks for a base pose for every object, in seconds. ``seed`` is that of the placement jitter; 0
    disables it. ``picture`` is the destination of a picture of the room, a PNG file.

    Raises:
        MissingToolError: A package that simulates or draws is not installed.
        OutputError: The picture cannot be written.
        TmdError: The domain has no shapes, the scene cannot be built, or ``urdf`` is not a PR2.
    """
    if picture is not None:
        pillow()
    with Simulator(pictures=picture is not None) as sim:
        scene = Scene(sim, environment, folder, rng=np.random.default_rng(seed) if seed else None)
        cell = make_cell(sim, scene, seed=seed, kinematic=True, urdf=urdf)
        entries = survey(cell)
        stances = {entry.name: stance(cell, entry.name) for entry in entries} if reach else {}
        if picture is not None:
            from PIL import Image

            write_picture(picture, Image.fromarray(sim.picture(*scene.viewpoint(), *PICTURE)), "PNG")
    return SceneSurvey(environment.name, tuple(entries), stances)


def survey(cell: Cell) -> list[ReachabilityEntry]:
    """Return all objects, in file order."""
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
    """Return a stance to take an item as everything stands now, or before furniture; ``None`` if there is none."""
    focus = Pose(cell.centre(name))
    if not cell.scene.is_item(name):
        return next(
            (Stance(base) for base in stances(cell, focus, cell.front(name)) if not cell.robot.collides(base=base)),
            None,
        )
    options = with_room(cell, pick_options(cell, name))
    found = next(candidates(cell, options, focus, cell.front(name)), None)
    return None if found is None else Stance(found.base, found.option.side)
