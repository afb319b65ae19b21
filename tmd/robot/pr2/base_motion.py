"""Collision-free motion of the base: straight if possible, else A* on a lattice of places and headings.

The base moves in any direction at any heading, so the lattice has eight moves that keep the heading and two turns on
the spot. Its origin and its headings are those of the goal, so the goal is one of its points.
"""

from __future__ import annotations

from collections.abc import Iterator
from heapq import heappop, heappush
from itertools import pairwise, product
from math import hypot, inf, pi, tau
from typing import TYPE_CHECKING

import numpy as np

from tmd.robot.parameters import BASE_MOTION
from tmd.robot.pr2.collision import CollisionChecker, Ignored
from tmd.robot.pr2.kinematics import Array
from tmd.robot.pr2.rrt import clear, shorten
from tmd.robot.pr2.trajectory_following import exact
from tmd.robot.pr2.urdf import BASE_JOINTS

if TYPE_CHECKING:
    from tmd.robot.pr2.pr2 import Pr2

Base = tuple[float, float, float]
Place = tuple[int, int]
Cell = tuple[int, int, int]

# Maximum motion of the base between two checks: metres, radians.
STRIDES = np.array([0.04, 0.04, 0.08])
_ALL_HEADINGS = sorted(range(-BASE_MOTION.grid_headings // 2, BASE_MOTION.grid_headings // 2), key=abs)
_MOVES = [(dx, dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1) if dx or dy]


def plan_base(
    robot: Pr2,
    goal: Base,
    *,
    ignore: Ignored = (),
    rng: np.random.Generator,
    budget: int = 4000,
    clearance: float = BASE_MOTION.clearance,
) -> list[Base] | None:
    """Plan a way for the robot, as its arms are and with what it holds, to a pose x, y, theta; nothing moves.

    ``clearance`` is kept, in metres; what is nearer at the start or at the goal may stay as near as it is there.
    ``ignore`` and ``rng`` are as for :func:`tmd.robot.pr2.arm_motion.plan_arm`; ``budget`` counts lattice points.

    Returns:
        Poses after the start up to the goal; None if the goal touches something, or no way was found.
    """
    x, y, theta = robot.base()
    end = np.array([goal[0], goal[1], theta + (goal[2] - theta + pi) % tau - pi])
    start = np.array([x, y, theta])
    with CollisionChecker(robot, BASE_JOINTS, ignore=ignore, margin=clearance) as checker:
        for near in (BASE_MOTION.near * STRIDES, None):
            if not checker.allow(((start, BASE_MOTION.start_penetration), (end, 1e-3)), near):
                return None
            path = _search(checker, start, end, budget)
            if path is not None or not checker.touching():
                break
        if path is None:
            return None
        path = shorten(path, checker.free, STRIDES, rng, tries=100)
        if not robot.kinematic:  # else corners are not rounded
            path = exact(path, robot.base_group, lambda track: checker.free(track, BASE_MOTION.rounding * clearance))
    return [(float(a), float(b), float(c)) for a, b, c in path[1:]]


def _search(checker: CollisionChecker, start: Array, end: Array, budget: int) -> Array | None:
    """Return a way from the start, or from somewhere straight away from what is close to the start."""
    lattice = _Lattice(checker, start, end)
    path = lattice.straight()
    if path is not None:
        return path
    ways_out = [start] if checker.apart(start[None])[0] else [*_ways_out(checker, start), start]
    for out in ways_out[: BASE_MOTION.max_ways_out]:
        path = _Lattice(checker, out, end).search(budget // len(ways_out[: BASE_MOTION.max_ways_out]))
        if path is not None:
            return path if out is start else np.vstack([start[None], path])
    return None


def _ways_out(checker: CollisionChecker, start: Array) -> list[Array]:
    """Return places that are reached straight from the start, backwards first; the farthest free one each way."""
    found = []
    for turn in BASE_MOTION.ways_out:
        angle = start[2] + pi + turn
        for away in BASE_MOTION.ways_out_lengths:
            out = start + np.array([away * np.cos(angle), away * np.sin(angle), 0.0])
            if clear(start, out, checker.free, STRIDES):
                found.append(out)
                break
    return found


class _Lattice:
    """Points (i, j, k): places and headings relative to the goal, which is (0, 0, 0)."""

    def __init__(self, checker: CollisionChecker, start: Array, goal: Array) -> None:
        self._checker = checker
        self._start, self._goal = start, goal
        self._known: dict[Cell, bool] = {(0, 0, 0): True}
        self._screened: dict[Cell, bool] = {}
        self._blocked: set[tuple[Cell, Cell]] = set()
        self._ways = _PlaceDistances(self)

    def pose(self, cell: Cell) -> Array:
        """Return x, y, theta; the heading is counted on, not wrapped."""
        i, j, k = cell
        pitch = BASE_MOTION.grid_pitch
        result: Array = self._goal + np.array([i * pitch, j * pitch, k * tau / BASE_MOTION.grid_headings])
        return result

    def straight(self) -> Array | None:
        """Return the corners of a way with one corner at most, (n, 3), or None."""
        if self._line(self._start, self._goal):
            return np.array([self._start, self._goal])
        # turning first, driving, turning at the end is what people expect, and it is often free
        for corner in (
            self._start * [1, 1, 0] + self._goal * [0, 0, 1],
            self._goal * [1, 1, 0] + self._start * [0, 0, 1],
        ):
            if self._line(self._start, corner) and self._line(corner, self._goal):
                return np.array([self._start, corner, self._goal])
        return None

    def search(self, budget: int) -> Array | None:
        """Return corners from start to goal, (n, 3), or None."""
        if (path := self.straight()) is not None:
            return path
        entries = {cell for cell in self._entries() if self.free(cell) and self._line(self._start, self.pose(cell))}
        # wedged in at either end: the search would look at the whole room in vain
        if self._enclosed(entries, {(0, 0, 0)}) or self._enclosed({(0, 0, 0)}, entries):
            return None
        for i, j, k in sorted(entries):
            self._ways.add((i, j), float(np.hypot(*(self.pose((i, j, k)) - self._start)[:2])))
        # the search looks at points only; what lies between them is looked at once a way is found
        for _ in range(BASE_MOTION.max_attempts):
            cells = self._astar(entries, budget)
            if cells is None:
                return None
            bad = [pair for pair in pairwise(cells) if not self._line(self.pose(pair[0]), self.pose(pair[1]))]
            if not bad:
                return np.array([self._start, *(self.pose(cell) for cell in cells)])
            self._blocked.update(bad, [(b, a) for a, b in bad])
        return None

    def _enclosed(self, ends: set[Cell], others: set[Cell]) -> bool:
        """Return whether few points can be reached from ``ends``, and none of the others is among them."""
        reached, waiting = set(ends), sorted(ends)
        while waiting and len(reached) < BASE_MOTION.escape_points:
            for neighbour, _ in self._neighbours(waiting.pop()):
                if neighbour not in reached and self.free(neighbour):
                    reached.add(neighbour)
                    waiting.append(neighbour)
        return not waiting and reached.isdisjoint(others)

    def _astar(self, entries: set[Cell], budget: int) -> list[Cell] | None:
        """Search from the goal back to a point next to the start, which is off the lattice; points in driving order."""
        best: dict[Cell, float] = {(0, 0, 0): 0.0}
        before: dict[Cell, Cell] = {}
        closed: set[Cell] = set()
        heap = [(self._left((0, 0, 0)), 0, (0, 0, 0))]
        pushed = 0
        if heap[0][0] == inf:
            return None
        while heap and len(closed) < budget:
            _, _, cell = heappop(heap)
            if cell in closed:
                continue
            closed.add(cell)
            if cell in entries:
                path = [cell]
                while cell in before:
                    cell = before[cell]
                    path.append(cell)
                return path
            for neighbour, price in self._neighbours(cell):
                total = best[cell] + price
                if neighbour in closed or total >= best.get(neighbour, np.inf) - 1e-12:
                    continue
                if (cell, neighbour) in self._blocked or not self.free(neighbour):
                    continue
                best[neighbour] = total
                before[neighbour] = cell
                pushed += 1
                heappush(heap, (total + self._left(neighbour), pushed, neighbour))
        return None

    def _entries(self) -> Iterator[Cell]:
        pitch = BASE_MOTION.grid_pitch
        place = (self._start - self._goal) / [pitch, pitch, tau / BASE_MOTION.grid_headings]
        i, j, k = ((int(np.floor(value)), int(np.ceil(value))) for value in place)
        yield from product(i, j, k)

    def _left(self, cell: Cell) -> float:
        """Return a lower bound on the cost from a point to the start, raised a little to look at fewer points."""
        turn = abs(float(self.pose(cell)[2] - self._start[2]))
        return 1.2 * (self._ways.to(cell[:2]) + BASE_MOTION.turn_cost * turn)

    @staticmethod
    def _neighbours(cell: Cell) -> Iterator[tuple[Cell, float]]:
        i, j, k = cell
        for dx, dy in _MOVES:
            yield (i + dx, j + dy, k), BASE_MOTION.grid_pitch * hypot(dx, dy)
        for turn in (-1, 1):
            if abs(k + turn) <= BASE_MOTION.grid_headings:
                yield (i, j, k + turn), BASE_MOTION.turn_cost * tau / BASE_MOTION.grid_headings

    def free(self, cell: Cell) -> bool:
        """Return whether the robot touches nothing there."""
        if cell not in self._known:
            if cell not in self._screened:
                self._screen(cell)
            self._known[cell] = self._screened[cell] or self._checker.free(self.pose(cell)[None])
        return self._known[cell]

    def _screen(self, cell: Cell) -> None:
        """Compare boxes for a block of places with one heading: many at once cost little more than one."""
        size = BASE_MOTION.block
        i, j, k = cell[0] // size * size, cell[1] // size * size, cell[2]
        cells = [(i + a, j + b, k) for a, b in product(range(size), repeat=2)]
        verdicts = self._checker.apart(np.array([self.pose(each) for each in cells]))
        self._screened.update(zip(cells, verdicts, strict=True))

    def _line(self, start: Array, end: Array) -> bool:
        return clear(start, end, self._checker.free, STRIDES)


class _PlaceDistances:
    """Distances from the start to places if the heading is free to choose at each: a bound for the search.

    It knows the ways round obstacles, into which the straight distance leads. The search continues whenever a place is
    asked for (D. Silver, Cooperative Pathfinding, AIIDE 2005: reverse resumable A*).
    """

    def __init__(self, lattice: _Lattice) -> None:
        self._lattice = lattice
        self._best: dict[Place, float] = {}
        self._closed: set[Place] = set()
        self._heap: list[tuple[float, Place]] = []
        self._passable: dict[Place, bool] = {}

    def add(self, place: Place, distance: float) -> None:
        """Add a way of so many metres to this place."""
        if distance < self._best.get(place, inf) - 1e-12:
            self._best[place] = distance
            # to the goal it is at least as far as straight ahead
            heappush(self._heap, (distance + BASE_MOTION.grid_pitch * hypot(*place), place))

    def to(self, place: Place) -> float:
        """Return metres; infinite if no way leads there, or if it is too far."""
        while place not in self._closed and self._heap and len(self._closed) < BASE_MOTION.max_places:
            _, here = heappop(self._heap)
            if here in self._closed:
                continue
            self._closed.add(here)
            for dx, dy in _MOVES:
                there = here[0] + dx, here[1] + dy
                if there not in self._closed and self._is_passable(there):
                    self.add(there, self._best[here] + BASE_MOTION.grid_pitch * hypot(dx, dy))
        return self._best[place] if place in self._closed else inf

    def _is_passable(self, place: Place) -> bool:
        if place not in self._passable:
            self._passable[place] = any(self._lattice.free((*place, k)) for k in _ALL_HEADINGS)
        return self._passable[place]
