"""The camera of a film: for each instruction the angle that best shows the hands and the thing.

Angles round the subject are compared by what rays from there meet: a point that something hides counts nothing.
Rays move nothing, so a run is the same with and without a film.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from tmd.robot.pr2.pr2 import ARMS
from tmd.robot.scene.scene import Handle
from tmd.robot.sim.pose import Vector
from tmd.robot.skills.robot_context import Cell

# Vertical angle of view in degrees.
FOV = 50.0
_TURNS = tuple(math.radians(15.0 * step) for step in range(24))
_HEIGHTS = tuple(map(math.radians, (16.0, 28.0, 40.0, 54.0)))
# Metres round the subject that are in the picture, at least.
_CLOSE, _WIDE = 0.5, 1.0
# A hand that is farther from the thing than this has nothing to do with it.
_NEAR_HAND = 0.4
# One that is nearer than this to the middle of the picture works there.
_AT_WORK = 0.35
# A ray that gets this near to its goal has met it.
_SEEN = 0.06
# The robot's own body counts as seen where it is this near to the point.
_OWN = 0.35


@dataclass(frozen=True, slots=True)
class View:
    """A camera round its target: radians and metres; a turn of 0 is the side of +x."""

    target: Vector
    turn: float
    height: float
    distance: float

    @property
    def eye(self) -> Vector:
        """The position of the camera."""
        x, y, z = self.target
        flat = self.distance * math.cos(self.height)
        return (
            x + flat * math.cos(self.turn),
            y + flat * math.sin(self.turn),
            z + self.distance * math.sin(self.height),
        )


@dataclass(frozen=True, slots=True)
class _Point:
    """A point to show: the bodies whose surface it is on, and its weight."""

    place: Vector
    bodies: tuple[int, ...]
    weight: float


class Camera:
    """The camera of one film.

    Attributes:
        wide: Whether that shows the whole robot.
    """

    def __init__(self, cell: Cell) -> None:
        self._cell = cell
        self._names: tuple[str, ...] = ()
        self.wide = True
        self.view = _overview(cell)

    def follow(self, names: Sequence[str], *, wide: bool) -> None:
        """Choose the view of some objects and parts (none: the former ones) from now on.

        A ``wide`` view shows the whole robot on its way there, not its hands.
        """
        self._names = tuple(dict.fromkeys(names)) or self._names
        self.wide = wide
        self.view = self.best()

    def at_work(self) -> bool:
        """Return whether a hand is at what the view shows."""
        hands = (self._cell.robot.tool(side).position for side in ARMS)
        return not self.wide and min(math.dist(hand, self.view.target) for hand in hands) < _AT_WORK

    def best(self) -> View:
        """Return the angle that shows most now."""
        if not self._names:
            return _overview(self._cell)
        points = self._points()
        target, around = _ball([p.place for p in points if p.weight >= 1.0])
        around = max(around + 0.3, _WIDE) if self.wide else max(around + 0.2, _CLOSE)
        distance = around / math.sin(math.radians(FOV / 2))
        heights = _HEIGHTS[1:] if self.wide else _HEIGHTS
        views = [View(target, turn, height, distance) for turn, height in product(_TURNS, heights)]
        return max(views, key=lambda view: self._worth(view, points))

    def _points(self) -> list[_Point]:
        cell, points = self._cell, []
        for name in self._names:
            handle = cell.scene.handle(name)
            if handle is not None:
                points += self._handle_points(name, handle)
                continue
            low, high = cell.sim.extents(*cell.scene.place(name))
            body, _ = cell.scene.place(name)
            x, y, z = cell.centre(name)
            points.append(_Point((x, y, z), (body,), 2.0))
            points.append(_Point((x, y, high[2]), (), 1.5))  # the opening of a vessel
            points += [_Point((a, b, high[2]), (body,), 0.25) for a, b in product((low[0], high[0]), (low[1], high[1]))]
        own = (cell.robot.body, *(cell.scene.bodies[item] for item in cell.in_hand.values()))
        x, y, _ = cell.robot.base()
        if self.wide:
            points += [self._near_side(name, (x, y)) for name in self._names]
            return [*points, _Point((x, y, 1.2), own, 1.5), _Point((x, y, 0.5), own, 2.0)]
        things = [p.place for p in points]
        for side in ARMS:
            hand = cell.robot.tool(side).position
            if min(math.dist(hand, thing) for thing in things) < _NEAR_HAND:
                points.append(_Point(hand, own, 2.0))
        return [*points, _Point((x, y, 1.2), own, 0.5)]

    def _handle_points(self, name: str, handle: Handle) -> list[_Point]:
        """Return what to show of what hands work: the handle or button, and what is behind a door or in a drawer.

        The thing itself may not cover them.
        """
        scene, inside = self._cell.scene, []
        if handle.kind in ("door", "drawer"):
            inside = scene.regions(name, "in") or scene.regions(self._cell.whole(name), "in")
        middles = [
            scene.frame(whole, each.link).apply((np.add(each.low, each.high) / 2).tolist()) for whole, each in inside
        ]
        return [_Point(handle.grasp.position, (), 2.0), *(_Point(each, (), 1.5) for each in middles)]

    def _near_side(self, name: str, base: tuple[float, float]) -> _Point:
        """Return the middle of the side of a thing that the robot stands before."""
        low, high = self._cell.sim.extents(*self._cell.scene.place(name))
        x, y = (min(max(b, a), c) for a, b, c in zip(low, base, high, strict=False))
        return _Point((x, y, (low[2] + high[2]) / 2), (), 2.0)

    def _worth(self, view: View, points: Sequence[_Point]) -> float:
        if self._inside(view.eye):
            return -math.inf
        seen = sum(point.weight for point in points if self._sees(view.eye, point))
        turned = abs(math.remainder(view.turn - self.view.turn, math.tau)) / math.pi
        return seen - 1.2 * turned - 1.6 * abs(view.height - _HEIGHTS[2])

    def _sees(self, eye: Vector, point: _Point) -> bool:
        hit = self._cell.sim.ray(eye, point.place)
        if hit is None or math.dist(hit.position, point.place) < _SEEN:
            return True
        # its own shoulder may not stand for a hand
        near = math.dist(hit.position, point.place) < _OWN
        return hit.body in point.bodies and (near or hit.body != self._cell.robot.body)

    def _inside(self, eye: Vector) -> bool:
        """Return whether the camera would be in something, or so near that it fills the picture."""
        for name, body in self._cell.scene.bodies.items():
            if name in self._cell.scene.blueprints and not self._cell.scene.is_item(name):
                low, high = self._cell.sim.extents(body)
                if all(a - 0.25 < value < b + 0.25 for a, value, b in zip(low, eye, high, strict=True)):
                    return True
        return False


def _overview(cell: Cell) -> View:
    eye, target = cell.scene.viewpoint()
    x, y, z = (e - t for e, t in zip(eye, target, strict=True))
    distance = math.hypot(x, y, z)
    return View(target, math.atan2(y, x), math.asin(z / distance), distance)


def _ball(places: Sequence[Vector]) -> tuple[Vector, float]:
    """Return the middle of some points, and the distance of the farthest."""
    x, y, z = ((min(values) + max(values)) / 2 for values in zip(*places, strict=True))
    return (x, y, z), max(math.dist((x, y, z), place) for place in places)
