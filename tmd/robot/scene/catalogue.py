"""The objects of a scene and their parts: by name, and as the bodies and links of a simulator."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

from tmd.diagnostics import TmdError
from tmd.robot.assets.features import Grip, Opening, Region
from tmd.robot.assets.shapes import Blueprint, Shapes
from tmd.robot.assets.urdf_builder import ROOT
from tmd.robot.scene.furniture_layout import Footprint, Room, apart, floor_spots, inside
from tmd.robot.scene.placement import TURNS
from tmd.robot.sim.pose import Pose, Vector
from tmd.world.classes import ROOT as CLASS_ROOT
from tmd.world.environment import Environment
from tmd.world.folder import DomainFolder

if TYPE_CHECKING:
    from tmd.robot.sim.simulator import Simulator


FLOOR = "floor"
# A thing that is so many times as high as wide falls over.
TALL = 1.2


def built(environment: Environment, folder: DomainFolder) -> tuple[dict[str, Blueprint], dict[str, list[str]]]:
    """Return the blueprint of each object of an environment, and the names of its parts.

    Raises:
        TmdError: A shape makes no sense; with its place in ``objects.yaml``.
    """
    shapes = Shapes(folder)
    classes = {name: entry.class_name for name, entry in environment.objects.items()}
    parts = {
        name: [vertex for vertex in folder.classes.get(kind).vertices if vertex != CLASS_ROOT]
        for name, kind in classes.items()
    }
    return {name: shapes.blueprint(kind) for name, kind in classes.items()}, parts


class Catalogue:
    """The objects of an environment, their blueprints, and the names of their parts."""

    def __init__(self, environment: Environment, blueprints: dict[str, Blueprint], parts: dict[str, list[str]]) -> None:
        self.environment = environment
        self.blueprints = blueprints
        self._places: dict[str, tuple[str, str]] = {FLOOR: (FLOOR, ROOT)}
        for name in blueprints:
            self._places[name] = (name, ROOT)
            for part in parts[name]:
                self._places[self.named(name, part)] = (name, part)

    @staticmethod
    def named(whole: str, part: str) -> str:
        """Return the name of a part of an object; of the object itself if no part is given."""
        return f"{whole}_{part}" if part else whole

    def whole(self, name: str) -> str:
        """Return the object that an object or part belongs to."""
        return self.where(name)[0]

    def where(self, name: str) -> tuple[str, str]:
        """Return the object, and the part of it (``ROOT``: the whole), that a name means.

        Raises:
            TmdError: There is no such thing.
        """
        if name not in self._places:
            raise TmdError(f"there is no '{name}' in the scene of {self.environment.name}")
        return self._places[name]

    def is_item(self, name: str) -> bool:
        """Return whether it can be carried."""
        return name in self.blueprints and self.blueprints[name].sort == "item"

    def items(self) -> list[str]:
        """Return all items, in file order."""
        return [name for name in self.blueprints if self.is_item(name)]

    def names(self) -> list[str]:
        """Return all objects and parts, in file order."""
        return [name for name in self._places if name != FLOOR]

    def holds_contents(self, item: str) -> bool:
        """Return whether it is a vessel with visible contents."""
        return bool(self.blueprints[item].model.contents)

    def opening(self, item: str) -> Opening | None:
        """Return the rim of a vessel; None for a thing that holds nothing or is closed."""
        return self.blueprints[item].model.opening if item in self.blueprints else None

    def spouts(self, whole: str) -> dict[str, Vector]:
        """Return where streams leave an object, in its own frame, by the full name of the part."""
        if whole not in self.blueprints:
            return {}
        return {self.named(whole, part): place for part, place in self.blueprints[whole].model.spouts.items()}

    def stands(self, item: str) -> bool:
        """Return whether it is to be put down upright: vessels, and tall things."""
        model = self.blueprints[item].model
        if model.contents and model.opening is None:
            return False  # a spoon
        depth, width, height = (high - low for low, high in zip(model.low, model.high, strict=True))
        return model.opening is not None or bool(model.regions) or height > TALL * max(depth, width)

    def size(self, item: str) -> tuple[Vector, Vector]:
        """Return the item's box, lower and upper corner, in its own frame."""
        model = self.blueprints[item].model
        return (model.low[0], model.low[1], model.low[2]), (model.high[0], model.high[1], model.high[2])

    def footprint(self, item: str) -> Footprint:
        """Return the item's rectangle on its support."""
        low, high = self.size(item)
        return (low[0], low[1], high[0], high[1])

    def grip(self, whole: str, part: str) -> Grip | None:
        """Return the grip of a part in the frame of its link; None if it has none."""
        return next((g for g in self.blueprints[whole].model.grips if g.part == part), None)

    def frame(self, whole: str, link: str) -> Pose:
        """Return the pose of a link of an object now."""
        raise NotImplementedError

    def pose_of(self, item: str) -> Pose:
        """Return the pose of an object now."""
        raise NotImplementedError

    def top_of(self, item: str) -> float:
        """Return the height of the highest point of an object now."""
        raise NotImplementedError

    def regions(self, name: str, relation: str | None = None) -> list[tuple[str, Region]]:
        """Return the regions of an object or part, of one relation if it is given, each with the object."""
        whole, part = self.where(name)
        if whole == FLOOR:
            return []
        regions = self.blueprints[whole].model.regions
        return [(whole, r) for r in regions if r.part == part and relation in (None, r.relation)]


@dataclass(frozen=True, slots=True)
class Handle:
    """The place to work a joint at, in its current pose.

    Attributes:
        kind: ``door``, ``flap`` (a door without a handle: pushed), ``drawer``, ``lid``, ``slide`` (a curtain), ``knob``
            or ``button``.
        index: The joint's number, also that of the link that moves.
        grasp: The tool in the world with the fingers at the handle. Of a button and a flap: the closed tips touch it.
        opening: Gap of the fingers before they close; 0 means closed.
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


class Inventory(Catalogue):
    """The objects of an environment as bodies of a simulator.

    Attributes:
        bodies: The body of every object (parts are links of it), and of the floor.
    """

    def __init__(
        self, sim: Simulator, environment: Environment, blueprints: dict[str, Blueprint], parts: dict[str, list[str]]
    ) -> None:
        super().__init__(environment, blueprints, parts)
        self.sim = sim
        self.bodies: dict[str, int] = {}
        self._owners: dict[int, str] = {}

    def keep(self, name: str, body: int) -> None:
        """Register the body of an object."""
        self.bodies[name] = body
        self._owners[body] = name

    def index(self) -> None:
        """Look up the numbers of links, once all bodies are loaded."""
        self._links: dict[tuple[str, str], int] = {(FLOOR, ROOT): -1}
        self._named: dict[tuple[int, int], str] = {}
        for name, blueprint in self.blueprints.items():
            body, model = self.bodies[name], blueprint.model
            self._links[name, ROOT] = -1
            for joint in self.sim.joints(body).values():
                self._links[name, joint.link_name] = joint.index
            for link, part in model.link_parts.items():
                self._named[body, self._links[name, link]] = self.named(name, part)

    def place(self, name: str) -> tuple[int, int]:
        """Return the body and link (−1: the root) of an object or part.

        Raises:
            TmdError: There is no such thing.
        """
        whole, part = self.where(name)
        if whole == FLOOR:
            return self.bodies[FLOOR], -1
        return self.bodies[whole], self.link(whole, self.blueprints[whole].model.part_links.get(part, ROOT))

    def link(self, whole: str, link: str) -> int:
        """Return the number of a link of an object."""
        return self._links[whole, link]

    def owner(self, body: int, link: int = -1) -> str | None:
        """Return the object or part that a link belongs to; None for the robot and others outside of the scene."""
        return self._named.get((body, link), self._owners.get(body))

    def frame(self, whole: str, link: str) -> Pose:
        """Return the pose of a link of an object now."""
        return self.sim.pose(self.bodies[whole], self.link(whole, link))

    def handle(self, name: str) -> Handle | None:
        """Return the current handle of an object or part; None if it has none."""
        whole, part = self.where(name)
        grip = self.grip(whole, part) if whole != FLOOR else None
        if grip is None:
            return None
        link, frame = self.blueprints[whole].model.links[grip.link], self.frame(whole, grip.link)
        return Handle(
            grip.kind, self.bodies[whole], grip.link, self.link(whole, grip.link), frame * grip.tool.pose(),
            grip.opening, frame.position, frame.rotate(link.axis), link.kind == "revolute", grip.closed, grip.open,
            dict(grip.settings),
        )  # fmt: skip

    def entry(self, name: str, relation: str) -> Vector:
        """Return the direction in which the gripper enters there: (0, 0, −1) is from above."""
        for whole, region in self.regions(name, relation):
            return self.frame(whole, region.link).rotate(region.entry)
        return (0.0, 0.0, -1.0)

    def pose_of(self, item: str) -> Pose:
        """Return the pose of an object now."""
        return self.sim.pose(self.bodies[item])

    def top_of(self, item: str) -> float:
        """Return the height of its highest point now."""
        return self.sim.extents(self.bodies[item])[1][2]


# Between two items that stand side by side, at least.
GAP = 0.05
# The same in a basket or a bag, which nothing is to be taken out of in order.
HEAP_GAP = 0.01
# The same where no spot of a region has GAP around it: hands get in from above still.
TIGHT_GAP = 0.02
# Between the places that are tried then, all over the region.
PITCH = 0.03
# Between spots that count as different.
APART = 0.15
_TOUCH = 0.004
# Above what lies in a heap already.
_ON_TOP = 0.004


@dataclass(frozen=True, slots=True)
class Spot:
    """A free place: the pose of the item's frame, and the part whose stream would run into it there, if any."""

    pose: Pose
    outlet: str = ""


def free_spots(
    things: Catalogue, room: Room, name: str, relation: str, item: str | None, held: Collection[str] = ()
) -> list[Spot]:
    """Return free places on, in or next to something as it is now, best first.

    ``relation`` is ``on``, ``in`` or ``next_to``. ``item`` is to stand there; None: a thing 7 cm wide. ``held``
    items are in a hand, and take no place away.
    """
    own = things.footprint(item) if item is not None else (-0.035, -0.035, 0.035, 0.035)
    names = [other for other in things.items() if other not in (item, things.whole(name), *held)]
    others = {other: (things.pose_of(other), things.footprint(other)) for other in names}
    if name == FLOOR:
        return [Spot(pose) for pose in floor_spots(room, others.values(), own)]
    tall = 0.0 if item is None else things.size(item)[1][2]
    filled = item is not None and things.opening(item) is not None
    spots: list[Spot] = []
    heaped: list[Spot] = []
    for whole, region in things.regions(name, relation):
        if region.low[2] + tall > region.high[2]:
            continue
        frame = things.frame(whole, region.link)
        low, high = region.low[2] + frame.position[2], region.high[2] + frame.position[2]
        near = {o: at for o, at in others.items() if low - 0.05 < at[0].position[2] < high}
        if filled:
            spots += _under_spouts(things, whole, region, own, near)
        free, taken = _unoccupied(frame, region, own, near)
        spots += map(Spot, free)
        heaped += map(Spot, _heaped(things, taken, own, near, high))
    # beside what lies in a heap there may be room for a thing, and none for the hand
    return _spread(spots) + _spread(sorted(heaped, key=lambda spot: spot.pose.position[2]))


def _unoccupied(
    frame: Pose, region: Region, own: Footprint, near: Mapping[str, tuple[Pose, Footprint]]
) -> tuple[list[Pose], list[Pose]]:
    """Return free poses in a region, in the first turn that has any; of a heap also the other poses up to that."""
    gap = HEAP_GAP if region.heap else GAP
    taken: list[Pose] = []
    for turned in TURNS:
        fitting = _fitting(frame, region, turned, own)
        free = [pose for pose in fitting if all(apart(pose, own, *at, gap) for at in near.values())]
        taken += [pose for pose in fitting if region.heap and pose not in free]
        if free:
            return free, taken
    return [] if region.heap else _squeezed_in(frame, region, own, near), taken


def _under_spouts(
    things: Catalogue, whole: str, region: Region, own: Footprint, near: dict[str, tuple[Pose, Footprint]]
) -> list[Spot]:
    """Return where a stream would run into a vessel: its middle is below the spout."""
    frame = things.frame(whole, region.link)
    found = []
    for part, place in things.spouts(whole).items():
        x, y, z = (frame.inverse() * things.frame(whole, ROOT)).apply(place)
        if z < region.low[2] or not all(
            a <= v <= b for a, v, b in zip(region.low[:2], (x, y), region.high, strict=False)
        ):
            continue
        for turned in TURNS:
            pose = frame * Pose.flat(x, y, region.low[2], turned)
            if inside(pose, own, region.low, region.high, frame, region.overhang) and all(
                apart(pose, own, *at, HEAP_GAP) for at in near.values()
            ):
                found.append(Spot(pose, part))
                break
    return found


def _fitting(frame: Pose, region: Region, turned: float, own: Footprint) -> list[Pose]:
    """Return the spots of a region in which a thing does not stick out."""
    poses = [frame * Pose.flat(x, y, z, yaw + turned) for x, y, z, yaw in region.spots]
    return [pose for pose in poses if inside(pose, own, region.low, region.high, frame, region.overhang)]


def _squeezed_in(frame: Pose, region: Region, own: Footprint, near: Mapping[str, tuple[Pose, Footprint]]) -> list[Pose]:
    """Return where there is just room between the things there, the nearest to the front first."""
    across, deep = (int((region.high[axis] - region.low[axis]) / PITCH) for axis in (1, 0))
    places = [
        (region.high[0] - PITCH * row, region.low[1] + PITCH * column)
        for row, column in product(range(deep + 1), range(across + 1))
    ]
    for turned in TURNS:
        poses = [frame * Pose.flat(x, y, region.low[2], turned) for x, y in places]
        fitting = [pose for pose in poses if inside(pose, own, region.low, region.high, frame, region.overhang)]
        if free := [pose for pose in fitting if all(apart(pose, own, *at, TIGHT_GAP) for at in near.values())]:
            return free
    return []


def _heaped(
    things: Catalogue, poses: list[Pose], own: Footprint, near: dict[str, tuple[Pose, Footprint]], rim: float
) -> list[Pose]:
    """Return the same spots, on top of the things there."""
    found = []
    for pose in poses:
        below = [other for other, at in near.items() if not apart(pose, own, *at, 0.0)]
        top = max((things.top_of(other) for other in below), default=pose.position[2])
        if top + _ON_TOP < rim:
            found.append(Pose((pose.position[0], pose.position[1], top + _ON_TOP), pose.orientation))
    return found


def supported(things: Inventory, item: str) -> tuple[str, str] | None:
    """Return what an item is on, in or next to now, and the relation; None while it is in the air or in a hand.

    The middle of its underside decides, together with what it touches: itself or, in a vessel or on another item,
    through that.
    """
    touched = _touched(things, item)
    if not touched:
        return None
    point = things.sim.pose(things.bodies[item]).position
    best: tuple[float, str, str] | None = None
    for whole in things.blueprints:
        if whole not in touched:
            continue
        for region in things.blueprints[whole].model.regions:
            if _reaches(region, things.frame(whole, region.link).inverse().apply(point)):
                volume = math.prod(high - low for low, high in zip(region.low, region.high, strict=True))
                if best is None or volume < best[0]:
                    best = (volume, things.named(whole, region.part), region.relation)
    if best is not None:
        return best[1], best[2]
    return (FLOOR, "on") if FLOOR in touched else None


def _reaches(region: Region, local: Vector) -> bool:
    """Return whether a point of the region's frame is in it, or a little below."""
    deep = 0.03 if region.relation != "in" else 0.015
    return all(
        low - (deep if axis == 2 else 0.005) <= value <= high + (0.0 if axis == 2 else 0.005)
        for axis, (low, value, high) in enumerate(zip(region.low, local, region.high, strict=True))
    )


def _touched(things: Inventory, item: str) -> set[str]:
    """Return the objects that carry an item, directly or through other items."""
    found: set[str] = set()
    waiting = [item]
    while waiting:
        current = waiting.pop()
        for other in _neighbours(things, current):
            if other not in found and other != item:
                found.add(other)
                if things.is_item(other):
                    waiting.append(other)
    return found


def _neighbours(things: Inventory, item: str) -> list[str]:
    body = things.bodies[item]
    box = things.sim.extents(body)
    names = []
    for other, its in things.bodies.items():
        if other == item or not boxes_meet(box, things.sim.extents(its), _TOUCH):
            continue
        if any(c.distance < _TOUCH for c in things.sim.closest(body, its, _TOUCH)):
            names.append(other)
    return names


def _spread(spots: list[Spot]) -> list[Spot]:
    """Move spots beside an earlier one to the end: a few tries then reach far."""
    first: list[Spot] = []
    for spot in spots:
        if all(spot.pose.distance(other.pose) >= APART for other in first):
            first.append(spot)
    return [*first, *(spot for spot in spots if spot not in first)]


def boxes_meet(one: tuple[Vector, Vector], other: tuple[Vector, Vector], gap: float = 0.0) -> bool:
    """Return whether two boxes along the axes are less than ``gap`` apart."""
    return all(one[0][axis] - gap <= other[1][axis] and other[0][axis] - gap <= one[1][axis] for axis in range(3))
