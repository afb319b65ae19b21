"""Collision-free motion of the base: straight if possible, else A* on a lattice of places and headings.

The base moves in any direction at any heading, so the lattice has eight moves that keep the heading and two turns on
the spot. Its origin and its headings are those of the goal, so the goal is one of its points.
"""

from __future__ import annotations

from collections.abc import Iterator
from heapq import heappop, heappush
from math import hypot, pi, tau
from typing import TYPE_CHECKING

import numpy as np

from tmd.robot.collision import Checker, Ignored
from tmd.robot.kinematics import Array
from tmd.robot.pr2_urdf import BASE_JOINTS
from tmd.robot.rrt import shorten

if TYPE_CHECKING:
    from tmd.robot.pr2 import Pr2

Base = tuple[float, float, float]
Cell = tuple[int, int, int]

PITCH = 0.1
"""Metres between neighbours."""
HEADINGS = 16
STRIDES = np.array([0.04, 0.04, 0.08])
"""How far the base may move between two checks."""
CLEARANCE = 0.02
"""Metres that the way keeps from things, where its start and its goal do."""
DEEPEST = 0.01
_TURN = 0.35
"""Metres that turning by one radian costs."""
_MOVES = [(dx, dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1) if dx or dy]


def plan_base(
    robot: Pr2,
    goal: Base,
    *,
    ignore: Ignored = (),
    rng: np.random.Generator,
    budget: int = 20000,
    clearance: float = CLEARANCE,
) -> list[Base] | None:
    """A way for the robot, as its arms are and with what it holds, to a pose of the base.

    Args:
        robot: The robot; nothing moves.
        goal: x, y, theta.
        ignore: (body, link) that may be touched, link None: all of the body.
        rng: For shortcuts.
        budget: Lattice points that are looked at before giving up.
        clearance: Metres to keep away. What is nearer at the start or at the goal may stay as near as it is there.

    Returns:
        Poses after the start, the last is the goal; None: the goal touches something, or no way was found.
    """
    x, y, theta = robot.base()
    end = np.array([goal[0], goal[1], theta + (goal[2] - theta + pi) % tau - pi])
    start = np.array([x, y, theta])
    with Checker(robot, BASE_JOINTS, ignore=ignore, margin=clearance) as checker:
        for pose, deepest in ((start, DEEPEST), (end, 1e-3)):
            for name, body, link, depth in checker.collisions(pose.tolist()):
                if depth > deepest:
                    return None
                pair = name, body, link
                checker.allowed[pair] = max(checker.allowed.get(pair, -np.inf), depth + 1e-3)
        path = _Lattice(checker, start, end).search(budget)
        if path is None:
            return None
        path = shorten(path, checker.free, STRIDES, rng)
    return [(float(a), float(b), float(c)) for a, b, c in path[1:]]


class _Lattice:
    """Points (i, j, k): places and headings relative to the goal, which is (0, 0, 0)."""

    def __init__(self, checker: Checker, start: Array, goal: Array) -> None:
        self._checker = checker
        self._start, self._goal = start, goal
        self._known: dict[Cell, bool] = {(0, 0, 0): True}
        self._edges: dict[tuple[Cell, Cell], bool] = {}

    def pose(self, cell: Cell) -> Array:
        """x, y, theta; the heading is counted on, not wrapped."""
        i, j, k = cell
        result: Array = self._goal + np.array([i * PITCH, j * PITCH, k * tau / HEADINGS])
        return result

    def search(self, budget: int) -> Array | None:
        """Corners from start to goal, (n, 3), or None."""
        if self._line(self._start, self._goal):
            return np.array([self._start, self._goal])
        # turning first, driving, turning at the end is what people expect, and it is often free
        for corner in (
            self._start * [1, 1, 0] + self._goal * [0, 0, 1],
            self._goal * [1, 1, 0] + self._start * [0, 0, 1],
        ):
            if self._line(self._start, corner) and self._line(corner, self._goal):
                return np.array([self._start, corner, self._goal])
        return self._astar(budget)

    def _astar(self, budget: int) -> Array | None:
        """From the goal back to the start: the points next to the start, which is off the lattice, end the search."""
        entries = {cell: True for cell in self._entries()}
        best: dict[Cell, float] = {(0, 0, 0): 0.0}
        before: dict[Cell, Cell] = {}
        closed: set[Cell] = set()
        heap = [(self._left((0, 0, 0)), 0, (0, 0, 0))]
        pushed = 0
        while heap and len(closed) < budget:
            _, _, cell = heappop(heap)
            if cell in closed:
                continue
            closed.add(cell)
            if cell in entries and self._line(self._start, self.pose(cell)):
                path = [self._start, self.pose(cell)]
                while cell in before:
                    cell = before[cell]
                    path.append(self.pose(cell))
                return np.array(path)
            for neighbour, price in self._neighbours(cell):
                total = best[cell] + price
                if neighbour in closed or total >= best.get(neighbour, np.inf) - 1e-12:
                    continue
                if not self._passable(cell, neighbour):
                    continue
                best[neighbour] = total
                before[neighbour] = cell
                pushed += 1
                heappush(heap, (total + self._left(neighbour), pushed, neighbour))
        return None

    def _entries(self) -> Iterator[Cell]:
        i, j, k = (self._start - self._goal) / [PITCH, PITCH, tau / HEADINGS]
        for a in (int(np.floor(i)), int(np.ceil(i))):
            for b in (int(np.floor(j)), int(np.ceil(j))):
                for c in (int(np.floor(k)), int(np.ceil(k))):
                    yield a, b, c

    def _left(self, cell: Cell) -> float:
        """A lower bound on the cost from a point to the start, slightly raised: fewer points, hardly longer ways."""
        away = np.abs(self.pose(cell) - self._start)
        return 1.2 * (hypot(away[0], away[1]) + _TURN * float(away[2]))

    @staticmethod
    def _neighbours(cell: Cell) -> Iterator[tuple[Cell, float]]:
        i, j, k = cell
        for dx, dy in _MOVES:
            yield (i + dx, j + dy, k), PITCH * hypot(dx, dy)
        for turn in (-1, 1):
            if abs(k + turn) <= HEADINGS:
                yield (i, j, k + turn), _TURN * tau / HEADINGS

    def _passable(self, cell: Cell, neighbour: Cell) -> bool:
        if neighbour not in self._known:
            self._known[neighbour] = self._checker.free(self.pose(neighbour)[None])
        if not self._known[neighbour]:
            return False
        if cell[2] == neighbour[2]:
            return True  # 0.1 m between two free poses: the base is 0.67 m long, nothing slips through
        middle = (self.pose(cell) + self.pose(neighbour)) / 2
        return self._checker.free(middle[None])

    def _line(self, start: Array, end: Array) -> bool:
        count = max(1, int(np.ceil(np.max(np.abs(end - start) / STRIDES))))
        return self._checker.free(start + (end - start) * np.linspace(0, 1, count + 1)[1:, None])
