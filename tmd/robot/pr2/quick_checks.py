"""Quick checks of tool poses, before inverse kinematics.

A skill knows many poses that would do, and each could be reached from many places. Where the hand itself, or what it
holds, is in something, no place to stand helps: such poses are left out before a place is looked for.

The hand, the wrist and the elbow of a PR2 are links of fixed length: the wrist is a hand's length behind the tool,
and its distance from the shoulder lies between that of the bent elbow and that of the straight one. What is refused
by that has no posture; what is not refused may have one.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, sqrt
from typing import TYPE_CHECKING

import numpy as np

from tmd.robot.parameters import CONTACT
from tmd.robot.pr2.collision import Ignored, box_of, moved
from tmd.robot.pr2.kinematics import Array
from tmd.robot.pr2.urdf import TOOL
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


class HandChecker:
    """Collision checks for one hand that floats freely; between two calls the robot is where it was.

    ``ignore`` is what may be touched: (body, link), link None for all of the body. ``only`` restricts the check to one
    link.
    """

    def __init__(self, robot: Pr2, side: str, ignore: Ignored = (), *, only: tuple[int, int] | None = None) -> None:
        self._robot, self._side, self._ignore = robot, side, frozenset(ignore)
        self._links = [name for name in robot.tree.below(f"{side[0]}_wrist_roll_link") if name in robot.boxes]
        frames = robot.tree.forward(robot.positions(), robot.tree.links, {robot.tree.root: np.eye(4)})
        self._tool = frames[f"{side[0]}_{TOOL}"]
        back = np.linalg.inv(self._tool)
        self._relative = [back @ frames[name] for name in self._links]
        self._boxes = [robot.boxes[name] for name in self._links]
        self._held = next((held for held in robot.helds() if held.side == side), None)
        if self._held is not None:
            self._relative.append(self._held.grip.homogeneous())
            self._boxes.append(box_of(robot.sim, self._held.body))
        self._obstacles = self._find_obstacles() if only is None else [only]

    def _find_obstacles(self) -> list[tuple[int, int]]:
        taken = {self._robot.body, *(held.body for held in self._robot.helds())}  # they go where the robot goes
        return [
            (body, link)
            for body in self._robot.sim.bodies()
            if body not in taken and (body, None) not in self._ignore
            for link in self._robot.sim.solid_links(body)
            if (body, link) not in self._ignore
        ]

    def depth(self, tools: Sequence[Pose]) -> list[float]:
        """Return for each tool pose in the world how deep the hand would be in something, in metres; else 0."""
        if not self._obstacles:
            return [0.0] * len(tools)
        sim, body = self._robot.sim, self._robot.body
        extents = [sim.extents(*each) for each in self._obstacles]
        least, most = (np.array([extent[end] for extent in extents]) for end in (0, 1))
        place = sim.motion(body)
        held = sim.motion(self._held.body) if self._held else None
        try:
            return [self._depth(tool, least, most) for tool in tools]
        finally:
            sim.set_motion(body, place)
            if self._held and held is not None:
                sim.set_motion(self._held.body, held)

    def touched(self, tool: Pose) -> list[tuple[int, int]]:
        """Return what the hand would be in at a tool pose: (body, link), in order."""
        extents = [self._robot.sim.extents(*each) for each in self._obstacles]
        found = []
        for obstacle, extent in zip(self._obstacles, extents, strict=True):
            only = HandChecker(self._robot, self._side, only=obstacle)
            least, most = (np.array([extent[end]]) for end in (0, 1))
            if self._meeting(tool, least, most).any() and only.depth([tool])[0]:
                found.append(obstacle)
        return found

    def _meeting(self, tool: Pose, least: Array, most: Array) -> Array:
        """Return whether boxes overlap: (links of the hand, obstacles)."""
        frames = tool.homogeneous() @ np.array(self._relative)
        spans = [moved(box, frame[None]) for box, frame in zip(self._boxes, frames, strict=True)]
        low, high = (np.concatenate([span[end] for span in spans]) for end in (0, 1))
        result: Array = np.all((low[:, None] <= most) & (high[:, None] >= least), axis=2)
        return result

    def _depth(self, tool: Pose, least: Array, most: Array) -> float:
        meeting = self._meeting(tool, least, most)
        if not meeting.any():
            return 0.0
        sim, robot = self._robot.sim, self._robot
        # the whole robot is put where its hand is there: nothing but the hand is asked about
        sim.set_pose(robot.body, Pose.from_matrix(tool.homogeneous() @ np.linalg.inv(self._tool)))
        if self._held is not None:
            sim.set_pose(self._held.body, tool * self._held.grip)
        deepest = 0.0
        for mover, obstacle in np.argwhere(meeting):
            body, link = self._obstacles[obstacle]
            if mover < len(self._links):
                points = sim.closest(robot.body, body, 0.0, robot.index[self._links[mover]], link)
            else:
                assert self._held is not None
                points = sim.closest(self._held.body, body, 0.0, other_link=link)
            deepest = max(deepest, *(-point.distance for point in points), 0.0)
        return deepest if deepest > CONTACT.touch else 0.0
