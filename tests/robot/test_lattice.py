"""The search for a way of the base: who is wedged in is told so at once, who is not gets a way."""

from __future__ import annotations

from itertools import pairwise
from typing import cast

import numpy as np
import pytest

from tmd.robot.pr2.base_motion import _Lattice
from tmd.robot.pr2.collision import CollisionChecker
from tmd.robot.pr2.kinematics import Array


class Walls:
    """A floor on which the robot is a point that cannot turn, with a wall round it, perhaps with a gap behind it."""

    def __init__(self, gap: float) -> None:
        self.gap = gap
        self.looked_at = 0

    def apart(self, poses: Array) -> Array:
        self.looked_at += len(poses)
        away = np.max(np.abs(poses[:, :2]), axis=1)
        gap = (np.abs(poses[:, 0]) < self.gap) & (poses[:, 1] > 0)
        result: Array = (away < 2.5) & (np.abs(poses[:, 2]) < 0.2) & ((away < 0.35) | (away > 0.9) | gap)
        return result

    def free(self, poses: Array) -> bool:
        return bool(self.apart(poses).all())


class Pocket:
    """A room of six by six metres in which three walls stand round the goal, open on the side away from the start."""

    def apart(self, poses: Array) -> Array:
        x, y = poses[:, 0], poses[:, 1]
        back = (np.abs(x - 1.0) < 0.2) & (np.abs(y) < 2.0)
        sides = (np.abs(np.abs(y) - 1.8) < 0.2) & (x > 0.8) & (x < 2.3)
        result: Array = (np.abs(x) < 3) & (np.abs(y) < 3) & ~back & ~sides
        return result

    def free(self, poses: Array) -> bool:
        return bool(self.apart(poses).all())


def search(walls: Walls) -> Array | None:
    start, goal = np.zeros(3), np.array([0.4, -1.9, 0.0])
    return _Lattice(cast(CollisionChecker, walls), start, goal).search(4000)


def test_a_way_leads_through_the_gap() -> None:
    walls = Walls(gap=0.25)
    way = search(walls)
    assert way is not None
    assert way[0] == pytest.approx([0.0, 0.0, 0.0]) and way[-1] == pytest.approx([0.4, -1.9, 0.0])
    for start, end in pairwise(way):
        assert walls.free(start + (end - start) * np.linspace(0, 1, 50)[:, None])


def test_without_a_gap_only_what_is_inside_is_looked_at() -> None:
    closed, open_ = Walls(gap=0.0), Walls(gap=0.25)
    assert search(closed) is None and search(open_) is not None
    assert closed.looked_at < open_.looked_at / 2


def test_the_search_goes_round_what_is_in_between_without_trying_all_headings() -> None:
    room = Pocket()
    start, goal = np.zeros(3), np.array([1.5, 0.0, 0.0])
    way = _Lattice(cast(CollisionChecker, room), start, goal).search(200)
    assert way is not None
    for one, other in pairwise(way):
        assert room.free(one + (other - one) * np.linspace(0, 1, 50)[:, None])
