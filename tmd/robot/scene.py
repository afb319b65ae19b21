"""An environment as a physical world: what stands where, what can be taken, opened and put on, and what it shows."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from numpy.random import Generator

from tmd.errors import TmdError
from tmd.robot.colours import mixed
from tmd.robot.cube import CUBE, cube
from tmd.robot.features import Grasp, Grip, Region
from tmd.robot.layout import Footprint, Room, apart, floor_spots, inside
from tmd.robot.model import ROOT
from tmd.robot.placing import TURNS, Placing
from tmd.robot.pose import Pose, Vector
from tmd.robot.room import build_room
from tmd.robot.shapes import Blueprint, Shapes
from tmd.world.environment import Environment
from tmd.world.folder import DomainFolder

if TYPE_CHECKING:
    from tmd.robot.simulator import Simulator

FLOOR = "floor"
SETTLE = 240
"""Steps of physics before the scene is ready."""
OVERLAP = 0.002
"""Metres that two things may be in each other."""
GAP = 0.05
"""Between two items that stand side by side, at least."""
APART = 0.15
"""Between spots that count as different."""
_OPENED, _SET_TO, _CONTAINS = "opened", "set_to", "contains"
_TOUCH = 0.004


@dataclass(frozen=True, slots=True)
class Spot:
    """A free place: the pose that an item's frame would have, in the world, now."""

    pose: Pose


@dataclass(frozen=True, slots=True)
class Handle:
    """What the robot works a joint by, as it is now.

    Attributes:
        kind: ``door``, ``flap`` (a door without a handle: pushed), ``drawer``, ``lid``, ``slide`` (a
            curtain), ``knob`` or ``button``.
        body: The body.
        joint: The joint's name.
        index: Its number, also that of the link that moves.
        grasp: The tool in the world with the fingers at the handle. Of a button and a flap: the closed tips touch it.
        opening: How wide the fingers stand before they close; 0 means closed.
        origin: A point of the joint's axis in the world.
        axis: The joint's axis in the world: of turning, or of sliding.
        turns: Whether it turns (radians) or slides (metres).
        closed: Position when closed, off or not pressed.
        open: Position when open or pressed.
        settings: Of a knob: the position of each setting.
    """

    kind: str
    body: int
    joint: str
    index: int
    grasp: Pose
    opening: float
    origin: Vector
    axis: Vector
    turns: bool
    closed: float
    open: float
    settings: Mapping[str, float]


class Scene:
    """All objects of an environment in a simulator, settled.

    Args:
        sim: An empty simulator.
        environment: What there is and where.
        folder: Its domain, with the shapes of its classes.
        rng: Moves things by millimetres, so that no two seeds see quite the same scene; None: exact places.
        settle: Steps of physics before the scene is ready.

    Attributes:
        bodies: The body of every object (parts are links of it), and of the floor.
        room: Where the fixtures and walls are.
        placed: Where every object was put before physics began.

    Raises:
        TmdError: A shape makes no sense, something does not fit where it should be, or things are in each other.
    """

    def __init__(
        self,
        sim: Simulator,
        environment: Environment,
        folder: DomainFolder,
        *,
        rng: Generator | None = None,
        settle: int = SETTLE,
    ) -> None:
        self.sim = sim
        self.environment = environment
        shapes = Shapes(folder)
        self.blueprints: dict[str, Blueprint] = {
            name: shapes.blueprint(entry.class_name) for name, entry in environment.objects.items()
        }
        self._states = {
            name: {
                vertex.name: dict(vertex.states) for vertex in folder.classes.get(entry.class_name).vertices.values()
            }
            for name, entry in environment.objects.items()
        }
        self._shown: dict[str, tuple[str, ...]] = {}
        self.bodies: dict[str, int] = {}
        self._owners: dict[int, str] = {}
        with tempfile.TemporaryDirectory(prefix="tmd-scene-") as directory:
            self._load(Path(directory), rng)
        self._index()
        for name in self.bodies:
            if name != FLOOR:
                self._start(name)
        self._refuse_overlaps()
        if settle:
            sim.step(settle)

    # ------------------------------------------------------------------ building

    def _load(self, directory: Path, rng: Generator | None) -> None:
        placing = Placing(self.environment, self.blueprints, rng)
        self.room: Room = placing.room
        self.placed: dict[str, Pose] = placing.poses
        (directory / CUBE).write_text(cube())
        floor = directory / "room.urdf"
        floor.write_text(build_room(self.room))
        self._keep(FLOOR, self.sim.load(floor, Pose((0.0, 0.0, 0.0)), fixed=True))
        for name, blueprint in self.blueprints.items():
            path = directory / f"{blueprint.class_name}.urdf"
            if not path.exists():
                path.write_text(blueprint.urdf)
            pose = self.placed[name]
            if blueprint.sort == "item":
                # a hair above what it stands on, so that nothing starts inside it
                x, y, z = pose.position
                pose = Pose((x, y, z + 0.001), pose.orientation)
            self._keep(name, self.sim.load(path, pose, fixed=blueprint.sort != "item", own_inertia=True))

    def _keep(self, name: str, body: int) -> None:
        self.bodies[name] = body
        self._owners[body] = name

    def _index(self) -> None:
        self._places: dict[str, tuple[str, str]] = {FLOOR: (FLOOR, ROOT)}
        self._links: dict[tuple[str, str], int] = {(FLOOR, ROOT): -1}
        self._named: dict[tuple[int, int], str] = {}
        for name, blueprint in self.blueprints.items():
            body, model = self.bodies[name], blueprint.model
            self._links[name, ROOT] = -1
            for joint in self.sim.joints(body).values():
                self._links[name, joint.link_name] = joint.index
            parts = [v for v in self._states[name] if v != "root"]
            self._places[name] = (name, ROOT)
            for part in parts:
                self._places[f"{name}_{part}"] = (name, part)
            for link, part in model.link_parts.items():
                self._named[body, self._links[name, link]] = f"{name}_{part}" if part else name

    def _start(self, name: str) -> None:
        """Joints, contents and signs as the environment says."""
        body, model, entry = self.bodies[name], self.blueprints[name].model, self.environment.objects[name]
        for link in model.links.values():
            if link.spring:
                self.sim.drive_joint(body, link.name, 0.0, link.spring)
            elif link.kind in ("revolute", "prismatic"):
                self.sim.brake_joint(body, link.name, link.friction)
        for vertex, usual in self._states[name].items():
            part = ROOT if vertex == "root" else vertex
            states = {**usual, **(entry.states if part == ROOT else entry.parts.get(part, {}))}
            grip = self._grip(name, part)
            if grip is not None and grip.kind != "button":
                setting = dict(grip.settings).get(str(states.get(_SET_TO)))
                position = setting if setting is not None else grip.open if states.get(_OPENED) is True else grip.closed
                self.sim.set_joint(body, grip.link, position)
            whole = f"{name}_{part}" if part else name
            for predicate, value in states.items():
                self.sign(whole, predicate, value is True)
            contained = states.get(_CONTAINS, [])
            if part == ROOT and model.contents:
                several = (
                    contained if isinstance(contained, list) else [contained] if isinstance(contained, str) else []
                )
                self.show(name, several)

    def _refuse_overlaps(self) -> None:
        names = list(self.bodies)
        extents = {name: self.sim.extents(self.bodies[name]) for name in names}
        for index, one in enumerate(names):
            for other in names[index + 1 :]:
                if not _boxes_meet(extents[one], extents[other]):
                    continue
                near = self.sim.closest(self.bodies[one], self.bodies[other], 0.0)
                depth = max((-c.distance for c in near), default=0.0)
                if depth > OVERLAP:
                    self._overlap(one, other, depth)

    def _overlap(self, one: str, other: str, depth: float) -> None:
        guilty = other if self.environment.objects[other].position or one == FLOOR else one
        path = ("objects", guilty, "position")
        raise self.environment.source.error(
            path,
            f"'{one}' and '{other}' are in each other by {depth * 1000:.0f} mm",
            "give other positions, or leave them out: then places are found",
        )

    # ------------------------------------------------------------------ names and places

    def place(self, name: str) -> tuple[int, int]:
        """The body and link (−1: the root) of an object or part.

        Raises:
            TmdError: There is no such thing.
        """
        whole, part = self._where(name)
        if whole == FLOOR:
            return self.bodies[FLOOR], -1
        link = self.blueprints[whole].model.part_links.get(part, ROOT)
        return self.bodies[whole], self._links[whole, link]

    def owner(self, body: int, link: int = -1) -> str | None:
        """The object or part that a link belongs to; None for the robot and others that are not of the scene."""
        return self._named.get((body, link), self._owners.get(body))

    def whole(self, name: str) -> str:
        """The object that an object or part belongs to."""
        return self._where(name)[0]

    def is_item(self, name: str) -> bool:
        """Whether it can be carried."""
        return name in self.blueprints and self.blueprints[name].sort == "item"

    def items(self) -> list[str]:
        """All items, in file order."""
        return [name for name in self.blueprints if self.is_item(name)]

    def names(self) -> list[str]:
        """All objects and parts, in file order."""
        return [name for name in self._places if name != FLOOR]

    def holds_contents(self, item: str) -> bool:
        """Whether it is a vessel: what is in it is seen."""
        return bool(self.blueprints[item].model.contents)

    def size(self, item: str) -> tuple[Vector, Vector]:
        """The item's box, lower and upper corner, in its own frame."""
        model = self.blueprints[item].model
        return (model.low[0], model.low[1], model.low[2]), (model.high[0], model.high[1], model.high[2])

    def _where(self, name: str) -> tuple[str, str]:
        if name not in self._places:
            raise TmdError(f"there is no '{name}' in the scene of {self.environment.name}")
        return self._places[name]

    def _regions(self, name: str, relation: str | None = None) -> list[tuple[str, Region]]:
        whole, part = self._where(name)
        if whole == FLOOR:
            return []
        regions = self.blueprints[whole].model.regions
        return [(whole, r) for r in regions if r.part == part and relation in (None, r.relation)]

    def _frame(self, whole: str, link: str) -> Pose:
        return self.sim.pose(self.bodies[whole], self._links[whole, link])

    # ------------------------------------------------------------------ where things may stand, and stand

    def support(self, name: str, relation: str, item: str | None = None) -> list[Spot]:
        """Free places on, in or next to something as it is now, best first.

        Args:
            name: An object or part, or the floor.
            relation: ``on``, ``in`` or ``next_to``.
            item: What is to stand there; without it, a thing 7 cm wide is meant.
        """
        own = self._footprint(item) if item is not None else (-0.035, -0.035, 0.035, 0.035)
        others = [(self.sim.pose(self.bodies[o]), self._footprint(o)) for o in self.items() if o != item]
        if name == FLOOR:
            return [Spot(pose) for pose in floor_spots(self.room, others, own)]
        spots: list[Spot] = []
        for whole, region in self._regions(name, relation):
            frame = self._frame(whole, region.link)
            low = region.low[2] + frame.position[2]
            near = [o for o in others if low - 0.05 < o[0].position[2] < region.high[2] + frame.position[2]]
            tall = 0.0 if item is None else self.size(item)[1][2]
            if region.low[2] + tall > region.high[2]:
                continue
            for turned in TURNS:
                poses = [frame * Pose.flat(x, y, z, yaw + turned) for x, y, z, yaw in region.spots]
                free = [
                    pose
                    for pose in poses
                    if inside(pose, own, region.low, region.high, frame, region.overhang)
                    and all(apart(pose, own, *other, GAP) for other in near)
                ]
                spots += map(Spot, free)
                if free:
                    break
        return _spread(spots)

    def _footprint(self, item: str) -> Footprint:
        low, high = self.size(item)
        return (low[0], low[1], high[0], high[1])

    def supported(self, item: str) -> tuple[str, str] | None:
        """What the item physically is on, in or next to now, and how; None while it is in the air or in a hand.

        Where the middle of its underside is decides, together with what it touches: itself or, in a vessel or on
        another item, through that.
        """
        touched = self._touched(item)
        if not touched:
            return None
        point = self.sim.pose(self.bodies[item]).position
        best: tuple[float, str, str] | None = None
        for whole in self.blueprints:
            if whole not in touched:
                continue
            for region in self.blueprints[whole].model.regions:
                local = self._frame(whole, region.link).inverse().apply(point)
                deep = 0.03 if region.relation != "in" else 0.015
                if all(
                    low - (deep if axis == 2 else 0.005) <= value <= high + (0.0 if axis == 2 else 0.005)
                    for axis, (low, value, high) in enumerate(zip(region.low, local, region.high, strict=True))
                ):
                    volume = math.prod(high - low for low, high in zip(region.low, region.high, strict=True))
                    if best is None or volume < best[0]:
                        best = (volume, f"{whole}_{region.part}" if region.part else whole, region.relation)
        if best is not None:
            return best[1], best[2]
        return (FLOOR, "on") if FLOOR in touched else None

    def _touched(self, item: str) -> set[str]:
        """The objects that carry an item, directly or through other items."""
        found: set[str] = set()
        waiting = [item]
        while waiting:
            current = waiting.pop()
            for other in self._neighbours(current):
                if other not in found and other != item:
                    found.add(other)
                    if self.is_item(other):
                        waiting.append(other)
        return found

    def _neighbours(self, item: str) -> list[str]:
        body = self.bodies[item]
        low, high = self.sim.extents(body)
        names = []
        for other, its in self.bodies.items():
            if other == item or not _boxes_meet((low, high), self.sim.extents(its), _TOUCH):
                continue
            if any(c.distance < _TOUCH for c in self.sim.closest(body, its, _TOUCH)):
                names.append(other)
        return names

    def entry(self, name: str, relation: str) -> Vector:
        """The direction in which the gripper comes in there: (0, 0, −1) is from above."""
        for whole, region in self._regions(name, relation):
            return self._frame(whole, region.link).rotate(region.entry)
        return (0.0, 0.0, -1.0)

    # ------------------------------------------------------------------ what can be taken and worked

    def grasps(self, item: str) -> Sequence[Grasp]:
        """How an item can be taken: ``Grasp.tool.pose()`` is in the item's frame."""
        return self.blueprints[item].model.grasps

    def _grip(self, whole: str, part: str) -> Grip | None:
        return next((g for g in self.blueprints[whole].model.grips if g.part == part), None)

    def handle(self, name: str) -> Handle | None:
        """What opens, turns or presses an object or part now; None where nothing does."""
        whole, part = self._where(name)
        grip = self._grip(whole, part) if whole != FLOOR else None
        if grip is None:
            return None
        body, link = self.bodies[whole], self.blueprints[whole].model.links[grip.link]
        frame = self._frame(whole, grip.link)
        return Handle(
            grip.kind,
            body,
            grip.link,
            self._links[whole, grip.link],
            frame * grip.tool.pose(),
            grip.opening,
            frame.position,
            frame.rotate(link.axis),
            link.kind == "revolute",
            grip.closed,
            grip.open,
            dict(grip.settings),
        )

    def spring_open(self, name: str) -> None:
        """Let a door that has been unlatched swing open by itself."""
        handle = self.handle(name)
        if handle is None:
            raise TmdError(f"'{name}' has no joint")
        self.sim.drive_joint(handle.body, handle.joint, handle.open, 2.0, 1.2)

    def calm(self, name: str) -> None:
        """Leave a joint to its own friction again, after :meth:`spring_open` or a drive."""
        whole, part = self._where(name)
        grip = self._grip(whole, part)
        if grip is not None:
            self.sim.brake_joint(self.bodies[whole], grip.link, self.blueprints[whole].model.links[grip.link].friction)

    # ------------------------------------------------------------------ what it shows

    def show(self, name: str, substances: Sequence[str]) -> None:
        """Let a vessel be seen to contain this: the first substance fills it, the others lie on top."""
        whole, _ = self._where(name)
        model, body = self.blueprints[whole].model, self.bodies[whole]
        groups = [list(substances[:1]), list(substances[1:])]
        self._shown[name] = tuple(substances)
        for link, group in zip(model.contents, groups, strict=False):
            colour = mixed(group) if group else (0.0, 0.0, 0.0, 0.0)
            self.sim.colour(body, self._links[whole, link], colour)

    def shown(self, name: str) -> tuple[str, ...]:
        """What a vessel is seen to contain."""
        return self._shown.get(name, ())

    def sign(self, name: str, predicate: str, on: bool) -> None:
        """Let a state be seen: a burner glows, the tap runs, the microwave is lit; nothing where there is no sign."""
        whole, part = self._where(name)
        if whole == FLOOR:
            return
        for lamp in self.blueprints[whole].model.lamps:
            if lamp.part == part and lamp.predicate == predicate:
                self.sim.colour(self.bodies[whole], self._links[whole, lamp.link], lamp.on if on else lamp.off)

    def viewpoint(self, around: Sequence[str] = ()) -> tuple[Vector, Vector]:
        """Eye and target of a camera that sees some things (or the whole room) and the robot before them."""
        if not around:
            return (self.room.low[0] - 0.9, 0.0, 3.4), (0.5, 0.0, 0.4)
        points = [self.sim.pose(*self.place(name)).position for name in around]
        x, y, z = (sum(values) / len(points) for values in zip(*points, strict=True))
        away = math.hypot(x, y) or 1.0
        side = 0.75 if y <= 0 else -0.75
        eye = (x - x / away * 1.9 - side * y / away, y - y / away * 1.9 + side * x / away, max(z, 0.7) + 1.1)
        return eye, (x, y, max(z, 0.5))


def _spread(spots: list[Spot]) -> list[Spot]:
    """The same spots with those first that are not beside an earlier one: a few tries then reach far."""
    first: list[Spot] = []
    for spot in spots:
        if all(spot.pose.distance(other.pose) >= APART for other in first):
            first.append(spot)
    return [*first, *(spot for spot in spots if spot not in first)]


def _boxes_meet(one: tuple[Vector, Vector], other: tuple[Vector, Vector], gap: float = 0.0) -> bool:
    return all(one[0][axis] - gap <= other[1][axis] and other[0][axis] - gap <= one[1][axis] for axis in range(3))
