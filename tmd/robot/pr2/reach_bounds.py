"""Bounds on the reach of an arm: the quickest check of a pose, before inverse kinematics.

The hand, the wrist and the elbow of a PR2 are links of fixed length: the wrist is a hand's length behind the tool,
and its distance from the shoulder lies between that of the bent elbow and that of the straight one. What is refused
here has no posture; what is not refused may have one.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, sqrt
from typing import TYPE_CHECKING

import numpy as np

from tmd.robot.parameters import CONTACT
from tmd.robot.pr2.kinematics import Array
from tmd.robot.sim.pose import Pose

if TYPE_CHECKING:
    from tmd.robot.pr2.pr2 import Pr2

_ELBOW = 3


class ReachBounds:
    """One arm's lengths in metres: ``shoulder`` is the pan joint in ``base_link`` with the torso at 0, (3,).

    ``offset`` is the distance from the pan axis to the lift axis, ``nearest`` and ``farthest`` those from the lift axis
    to the wrist with the elbow bent and straight, ``hand`` that from the wrist to the tool.
    """

    def __init__(self, robot: Pr2, side: str) -> None:
        kinematics = robot.arm_kinematics[side]
        self.shoulder = kinematics.points[0]
        self.offset, upper, fore, self.hand = map(float, kinematics.lengths)
        bent = min(abs(float(kinematics.lower[_ELBOW])), np.pi)
        self.nearest = sqrt(upper**2 + fore**2 + 2 * upper * fore * cos(bent)) - CONTACT.slack
        self.farthest = upper + fore + CONTACT.slack
        if not kinematics.closed_form:  # its wrist is no point: the whole arm, from any distance
            self.farthest += self.hand
            self.hand, self.nearest = 0.0, 0.0

    def holds(self, wrists: Array, torso: float) -> Array:
        """Return for each of the wrists (n, 3), in ``base_link``, whether it is in reach."""
        away = wrists - self.shoulder - np.array([0.0, 0.0, torso])
        level = np.abs(np.hypot(away[:, 0], away[:, 1]) - self.offset)
        # the lift axis is on a circle round the pan axis: the nearest point of it bounds how far the wrist may be,
        # the farthest one how near
        far = np.hypot(np.hypot(away[:, 0], away[:, 1]) + self.offset, away[:, 2])
        kept: Array = (np.hypot(level, away[:, 2]) <= self.farthest) & (far >= self.nearest)
        return kept


class Wrists:
    """The wrists for many sequences of tool poses in the world, each of one arm."""

    def __init__(self, robot: Pr2, sides: Sequence[str], poses: Sequence[Sequence[Pose]]) -> None:
        self._robot = robot
        self._spans = {side: ReachBounds(robot, side) for side in sorted(set(sides))}
        self._sides = np.array(sides)
        self._starts = np.cumsum([0, *(len(each) for each in poses)])[:-1]
        self._of = np.repeat(np.arange(len(poses)), [len(each) for each in poses])
        points = [
            pose.apply((-self._spans[side].hand, 0.0, 0.0))
            for side, each in zip(sides, poses, strict=True)
            for pose in each
        ]
        self._points = np.array(points).reshape(-1, 3)

    def within(self, base: tuple[float, float, float], torso: float) -> list[int]:
        """Return the numbers of the sequences whose wrists are all in reach from a base and a torso."""
        back = self._robot.base_link(base).inverse().homogeneous()
        inside = self._points @ back[:3, :3].T + back[:3, 3]
        held = np.zeros(len(inside), dtype=bool)
        for side, span in self._spans.items():
            of_side = self._sides[self._of] == side
            held[of_side] = span.holds(inside[of_side], torso)
        return [int(number) for number in np.flatnonzero(np.logical_and.reduceat(held, self._starts))]
