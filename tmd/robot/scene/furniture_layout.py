"""Layout of a room: fixtures along three walls, items on free spots of their supports.

The robot starts in the middle, at the origin, and looks along +x at the far wall. Fixtures stand in file order along
the left wall, the far wall and the right wall. Everything is plain geometry: no physics, nothing random.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache

from tmd.robot.assets.urdf_builder import UrdfModel
from tmd.robot.sim.pose import Pose, Vector

# From the middle of the room to the fronts, at least.
FREE_FLOOR = 1.75
# Between neighbours.
GAP = 0.12
# Beside the outermost fixture of a wall.
CORNER = 0.35
# x and y of the lower and of the upper corner, in the thing's own frame.
Footprint = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Room:
    """The room around the fixtures.

    Attributes:
        poses: Of the fixtures.
        low: x and y of the lower corner.
        high: x and y of the upper corner.
        corners: Of its walls, anticlockwise; empty: the rectangle of ``low`` and ``high``.
    """

    poses: dict[str, Pose]
    low: tuple[float, float]
    high: tuple[float, float]
    corners: tuple[tuple[float, float], ...] = ()

    def walls(self) -> list[tuple[tuple[float, float], tuple[float, float]]]:
        """Return the two ends of each wall, anticlockwise: the room is on the left of the way from one to the other."""
        (x0, y0), (x1, y1) = self.low, self.high
        corners = self.corners or ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
        return list(zip(corners, (*corners[1:], corners[0]), strict=True))

    def holds(self, pose: Pose, own: Footprint) -> bool:
        """Return whether an upright thing is wholly within the walls."""
        points = _corners(pose, own, -0.001)
        middle = pose.apply(((own[0] + own[2]) / 2, (own[1] + own[3]) / 2, 0.0))[:2]
        order = (points[0], points[1], points[3], points[2])
        sides = list(zip(order, (*order[1:], order[0]), strict=True))
        return self._within(middle) and not any(_cross(*side, *wall) for side in sides for wall in self.walls())

    def _within(self, point: tuple[float, float]) -> bool:
        """Return whether a point is inside, by the number of walls that a line from it along x crosses."""
        x, y = point
        met = 0
        for (ax, ay), (bx, by) in self.walls():
            if (ay > y) != (by > y) and x < ax + (y - ay) / (by - ay) * (bx - ax):
                met += 1
        return met % 2 == 1


def _cross(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float], d: tuple[float, float]) -> bool:
    """Return whether the lines from a to b and from c to d cross."""

    def side(p: tuple[float, float], q: tuple[float, float], r: tuple[float, float]) -> float:
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    return side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0


def room_of(corners: Sequence[tuple[float, float]]) -> Room:
    """Return an empty room by the corners of its walls.

    Raises:
        ValueError: They are not those of a room; the message says why.
    """
    count = len(corners)
    walls = [(corners[i], corners[(i + 1) % count]) for i in range(count)]
    if any(math.dist(*wall) < 0.05 for wall in walls):
        raise ValueError("two of its corners are at one place")
    if any(_cross(*walls[i], *walls[j]) for i in range(count) for j in range(i)):
        raise ValueError("its walls cross each other")
    area = sum(a[0] * b[1] - b[0] * a[1] for a, b in walls) / 2
    if abs(area) < 1.0:
        raise ValueError(f"it has {abs(area):.2f} square metres of floor")
    xs, ys = zip(*corners, strict=True)
    ordered = tuple(corners) if area > 0 else tuple(reversed(corners))
    return Room({}, (min(xs), min(ys)), (max(xs), max(ys)), ordered)


def arrange(sizes: dict[str, tuple[float, float]]) -> Room:
    """Place fixtures, given by depth and width in file order, along the walls of a room."""
    groups = _thirds(sizes)
    lengths = [_length([sizes[n][1] for n in group]) for group in groups]
    across = max(FREE_FLOOR, lengths[1] / 2 + CORNER)
    ahead = max(FREE_FLOOR, max(lengths[0], lengths[2]) / 2 + CORNER)
    poses: dict[str, Pose] = {}
    for group, length, (yaw, front) in zip(
        groups, lengths, ((-math.pi / 2, across), (math.pi, ahead), (math.pi / 2, across)), strict=True
    ):
        # a wall is read from its left to its right by who stands before it: along the fixtures' own +y
        along = -length / 2
        for name in group:
            depth, width = sizes[name]
            away, side = front + depth / 2, along + width / 2
            c, s = math.cos(yaw), math.sin(yaw)
            poses[name] = Pose.flat(_round(-c * away - s * side), _round(-s * away + c * side), 0.0, yaw)
            along += width + GAP
    deepest = max((depth for depth, _ in sizes.values()), default=0.5)
    reach_x, reach_y = ahead + deepest + 0.05, across + deepest + 0.05
    return Room(poses, (-max(2.2, reach_x), -reach_y), (reach_x, reach_y))


def _round(value: float) -> float:
    return round(value, 6)


def _length(widths: Sequence[float]) -> float:
    return sum(widths) + GAP * max(len(widths) - 1, 0)


def _thirds(sizes: dict[str, tuple[float, float]]) -> list[list[str]]:
    """Cut the names, in order, into three groups whose greatest length is least."""
    names = list(sizes)
    best: tuple[float, int, int] | None = None
    for first in range(len(names) + 1):
        for second in range(first, len(names) + 1):
            groups = (names[:first], names[first:second], names[second:])
            longest = max(_length([sizes[n][1] for n in group]) for group in groups)
            if best is None or longest < best[0] - 1e-9:
                best = (longest, first, second)
    _, first, second = best or (0.0, 0, 0)
    return [names[:first], names[first:second], names[second:]]


def apart(one: Pose, own: Footprint, other: Pose, its: Footprint, gap: float) -> bool:
    """Return whether two upright things are at least ``gap`` apart, by separating axes of their rectangles."""
    corners = [_corners(one, own, gap / 2), _corners(other, its, gap / 2)]
    for pose in (one, other):
        for c, s in _sides(pose):
            spans = [[x * c + y * s for x, y in four] for four in corners]
            if max(spans[0]) <= min(spans[1]) or max(spans[1]) <= min(spans[0]):
                return True
    return False


def inside(pose: Pose, own: Footprint, low: Vector, high: Vector, frame: Pose, beyond: float) -> bool:
    """Return whether the footprint of an upright thing is within the box ``low`` to ``high`` of ``frame``.

    It may stick out at the front (+x) by ``beyond``; ``inf``: anywhere, only its origin must be within.
    """
    if math.isinf(beyond):
        own = (0.0, 0.0, 0.0, 0.0)
    back = frame.inverse()
    for x, y in _corners(pose, own, 0.0):
        px, py, _ = back.apply((x, y, pose.position[2]))
        if not (low[0] - 1e-6 <= px <= high[0] + beyond + 1e-6 and low[1] - 1e-6 <= py <= high[1] + 1e-6):
            return False
    return True


@lru_cache(10_000)
def _sides(pose: Pose) -> list[tuple[float, float]]:
    yaw = pose.yaw()
    return [(math.cos(angle), math.sin(angle)) for angle in (yaw, yaw + math.pi / 2)]


@lru_cache(10_000)  # a place that is looked for is compared with each thing again and again
def _corners(pose: Pose, own: Footprint, more: float) -> list[tuple[float, float]]:
    points = []
    for x in (own[0] - more, own[2] + more):
        for y in (own[1] - more, own[3] + more):
            px, py, _ = pose.apply((x, y, 0.0))
            points.append((px, py))
    return points


def floor_spots(room: Room, taken: Iterable[tuple[Pose, Footprint]], own: Footprint) -> list[Pose]:
    """Return free places on the floor, those behind the robot first; the ways in front of the fixtures stay wide."""
    spots = []
    standing = list(taken)
    robot = (Pose.flat(0.0, 0.0), (-0.45, -0.45, 0.45, 0.45))
    reach = min(room.high[1] - 1.6, 1.6)
    steps = range(-int(max(reach, 0.0) / 0.4), int(max(reach, 0.0) / 0.4) + 1)
    for row in range(6):
        for column in sorted(steps, key=lambda s: (abs(s), s)):
            pose = Pose.flat(-0.8 - 0.4 * row, 0.4 * column)
            if pose.position[0] - 0.3 < room.low[0] or not room.holds(pose, own):
                continue
            if apart(pose, own, *robot, 0.1) and all(apart(pose, own, *other, 0.15) for other in standing):
                spots.append((row % 2 + abs(column) % 2, pose))
    # what lies close together is hard to drive up to: every other place is taken first
    return [pose for _, pose in sorted(spots, key=lambda spot: spot[0])]


WALL_HEIGHT = 1.7
THICK = 0.08
TILE = 0.8
_FAR, _SIDE = "#e9e4d8", "#dfe5e2"


def build_room(room: Room) -> str:
    """Return the room as URDF text, in the world's frame."""
    model = UrdfModel("room", 1000.0)
    (x0, y0), (x1, y1) = room.low, room.high
    west, south = x0 - 2.0, y0 - 2.0
    rows, columns = math.ceil((x1 - west) / TILE), math.ceil((y1 + 2.0 - south) / TILE)
    middle = (west + rows * TILE / 2, south + columns * TILE / 2, -0.05)
    model.box(middle, (rows * TILE, columns * TILE, 0.1), "sand", seen=False)
    # tiles of two colours beside each other: one on top of another would flicker
    for row in range(rows):
        for column in range(columns):
            corner = (west + row * TILE, south + column * TILE)
            colour = "#d8cdb8" if (row + column) % 2 else "#e6dfd0"
            model.slab((*corner, -0.02), (corner[0] + TILE, corner[1] + TILE, 0.0), colour, solid=False)
    if not room.corners:
        model.slab((x1, y0 - THICK, 0.0), (x1 + THICK, y1 + THICK, WALL_HEIGHT), _FAR)
        model.slab((x0, y1, 0.0), (x1, y1 + THICK, WALL_HEIGHT), _SIDE)
        model.slab((x0, y0 - THICK, 0.0), (x1, y0, WALL_HEIGHT), _SIDE)
        return model.text()
    for (ax, ay), (bx, by) in room.walls():
        length, yaw = math.dist((ax, ay), (bx, by)), math.atan2(by - ay, bx - ax)
        out = (math.sin(yaw), -math.cos(yaw))
        centre = ((ax + bx) / 2 + out[0] * THICK / 2, (ay + by) / 2 + out[1] * THICK / 2, WALL_HEIGHT / 2)
        size = (length + 2 * THICK, THICK, WALL_HEIGHT)
        # a wall between the camera and the room is there, and is not drawn
        model.box(centre, size, _FAR if out[0] > 0.7 else _SIDE, turn=(0.0, 0.0, yaw), seen=out[0] > -0.3)
    return model.text()
