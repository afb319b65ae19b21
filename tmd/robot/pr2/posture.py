"""Postures of the arms for driving, and the ways to them."""

from __future__ import annotations

from collections.abc import Iterator
from math import pi, tau
from typing import TYPE_CHECKING

import numpy as np

from tmd.robot.parameters import ARM_MOTION
from tmd.robot.pr2.arm_motion import plan_arm, plan_level, plan_line
from tmd.robot.sim.pose import Pose

if TYPE_CHECKING:
    from tmd.robot.pr2.pr2 import Pr2

_PLACES = [(x, y, z) for z in (1.15, 1.0, 1.3, 0.85) for x in (0.42, 0.5) for y in (0.2, 0.1, 0.3)]


def tuck(robot: Pr2, budget: int = ARM_MOTION.tuck_samples) -> bool:
    """Fold both arms, each along a collision-free path, and return whether both arrived.

    A hand that holds something brings it to the front, as upright as it is held. An arm that is in the other's way is
    moved first. ``budget`` is the number of samples for the path of an arm.
    """
    waiting = sorted(robot.arms, key=lambda side: robot.held(side) is not None)
    for _ in robot.arms:
        waiting = [side for side in waiting if not _tuck_arm(robot, side, budget)]
    return not waiting


def _tuck_arm(robot: Pr2, side: str, budget: int) -> bool:
    if robot.held(side) is not None:
        return _in_front(robot, side) or _carry(robot, side, budget // 3)
    return _fold(robot, side, budget) or _carry(robot, side, budget // 3)


def _fold(robot: Pr2, side: str, budget: int) -> bool:
    for goal in _folded(robot, side):
        (near,) = robot.arm_kinematics[side].near(np.array([robot.arm(side)]), goal)
        if np.max(np.abs(near - goal)) < ARM_MOTION.there:
            return True
        path = plan_arm(robot, side, goal, rng=robot.rng, budget=budget)
        if path is not None:
            return robot.move_arm(side, path)
    return False


def _folded(robot: Pr2, side: str) -> list[tuple[float, ...]]:
    """Return the tucked posture; if it touches something, the nearest free ones like it."""
    usual = robot.model.tucked[side]
    others = [
        tuple(value + shift * (joint == number) for number, value in enumerate(usual))
        for shift in ARM_MOTION.tuck_shifts
        for joint in range(ARM_MOTION.max_shifted)
    ]
    free, *rest = robot.clear(side, [usual, *others])
    if free:
        return [usual]
    return [other for other, clear in zip(others, rest, strict=True) if clear][: ARM_MOTION.max_folded]


def _carry(robot: Pr2, side: str, budget: int) -> bool:
    """Bring a hand, and what it holds, to the front of the robot; it turns about the vertical only, if possible."""
    base = Pose.flat(*robot.base()[:2], 0.0, robot.base()[2])
    now = base.inverse() * robot.tool(side)
    level = robot.keeps_level(side)
    goals: list[tuple[float, ...]] = []
    for place in _tool_places(now, side):
        tool = base * place
        found = [goal for goal in robot.solve(side, tool)[:2] if not robot.collides(side=side, arm=goal)]
        if not found:
            continue
        if level is None:
            line = plan_line(robot, side, robot.tool(side), tool, arm=robot.arm(side))
            path = line[1:] if line else None
        else:
            path = plan_level(robot, side, tool)
        if path is not None:
            return robot.move_arm(side, path)
        goals += found
        if level is None:
            for goal in found:
                path = plan_arm(robot, side, goal, rng=robot.rng, budget=budget)
                if path is not None:
                    return robot.move_arm(side, path)
        if len(goals) >= ARM_MOTION.max_carried:
            break
    if level is None:
        return False
    for goal in goals[: ARM_MOTION.level_planned]:
        path = plan_arm(robot, side, goal, rng=robot.rng, budget=budget)
        if path is not None:
            return robot.move_arm(side, path)
    return False


def _in_front(robot: Pr2, side: str) -> bool:
    """Return whether a hand is in front of the robot, where it may be for driving."""
    base = Pose.flat(*robot.base()[:2], 0.0, robot.base()[2])
    x, y, z = (base.inverse() * robot.tool(side)).position
    inside = (x, -y if side == "right" else y, z)
    return all(low <= value <= high for value, (low, high) in zip(inside, ARM_MOTION.carrying_region, strict=True))


def _tool_places(now: Pose, side: str) -> Iterator[Pose]:
    """Yield tool frames in the base's frame, compact ones first; at each place the least turning first."""
    for x, y, z in _PLACES:
        for index in range(ARM_MOTION.carrying_yaws):
            yaw = (index + 1) // 2 * tau / ARM_MOTION.carrying_yaws * (1 if index % 2 else -1)
            turn = Pose.flat(0.0, 0.0, yaw=(yaw + pi) % tau - pi)
            yield Pose((x, -y if side == "right" else y, z), now.orientation).spun(turn)
