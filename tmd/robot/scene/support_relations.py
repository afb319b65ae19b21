"""Free places in a scene as it is now, and the supports of items."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from itertools import product

from tmd.robot.assets.features import Region
from tmd.robot.assets.urdf_builder import ROOT
from tmd.robot.scene.catalogue import FLOOR, Catalogue, Inventory
from tmd.robot.scene.furniture_layout import Footprint, Room, apart, floor_spots, inside
from tmd.robot.scene.placement import TURNS
from tmd.robot.sim.pose import Pose, Vector

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
