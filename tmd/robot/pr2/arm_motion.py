"""Collision-free motion of an arm: to a posture, along a sequence of tool poses, and to where it is for driving.

Planners only compute; :func:`tuck` and :meth:`tmd.robot.pr2.pr2.Pr2.move_arm` move. They may ask about a base and a
torso that are elsewhere, so that a skill can see whether all its motions exist before it makes the first.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from math import ceil, hypot, pi, sin, tau
from typing import TYPE_CHECKING

import numpy as np

from tmd.robot.parameters import ARM_MOTION
from tmd.robot.pr2.collision import CollisionChecker, Ignored
from tmd.robot.pr2.kinematics import Array
from tmd.robot.pr2.rrt import plan, shorten
from tmd.robot.pr2.trajectory_following import exact
from tmd.robot.pr2.urdf import ARM
from tmd.robot.sim.pose import Pose, Quaternion

if TYPE_CHECKING:
    from tmd.robot.pr2.pr2 import Pr2

Arm = tuple[float, ...]
Base = tuple[float, float, float]

# Maximum motion of each joint between two checks, in radians: 2 to 4 cm at the hand.
STRIDES = np.array([0.04, 0.04, 0.06, 0.06, 0.12, 0.12, 0.25])
# Microseconds of following a pose, about.
_TRACK_WORK = 80
# Places of a hand with something in it for driving, in the base's frame: ahead, to its side, up; compact ones first.
_PLACES = [(x, y, z) for z in (1.15, 1.0, 1.3, 0.85) for x in (0.42, 0.5) for y in (0.2, 0.1, 0.3)]


def plan_arm(
    robot: Pr2, side: str, goal: Sequence[float], *, ignore: Ignored = (), rng: np.random.Generator, budget: int = 300
) -> list[Arm] | None:
    """Plan a collision-free path of one arm from where it is to joint positions; nothing moves.

    It keeps a clearance; what is nearer at the start or at the goal may stay as near as it is there. A thing that can
    hold something stays upright.

    Args:
        robot: The robot.
        side: The arm.
        goal: Seven joint positions; the endless joints are turned the short way.
        ignore: (body, link) that may be touched, link None: all of the body.
        rng: For samples and shortcuts.
        budget: Maximum number of samples where something must stay level; else it is at least 1000, each cheap.

    Returns:
        Joint positions after the start up to the goal, to go through in straight lines; None if the goal touches
        something, or no path was found.
    """
    must = robot.keeps_level(side)
    for level in (None,) if must is None else (True,) if must else (True, None):
        samples = budget if level else max(budget, ARM_MOTION.free_samples)
        path = _plan_arm(robot, side, goal, ignore, rng, samples, level=bool(level))
        if path is not None:
            return path
    return None


def _plan_arm(
    robot: Pr2, side: str, goal: Sequence[float], ignore: Ignored, rng: np.random.Generator, budget: int, *, level: bool
) -> list[Arm] | None:
    kinematics = robot.arm_kinematics[side]
    first = np.array(robot.arm(side), dtype=float)
    last = kinematics.near(np.array([goal], dtype=float), first.tolist())[0]
    lower = np.where(np.isinf(kinematics.lower), np.minimum(first, last) - pi, kinematics.lower)
    upper = np.where(np.isinf(kinematics.upper), np.maximum(first, last) + pi, kinematics.upper)

    upright = _Upright(robot, side, first, last) if level else None

    def sample() -> Array | None:
        if rng.random() < 0.5:
            drawn: Array = rng.uniform(lower, upper)
        else:
            middle = first + (last - first) * rng.random()
            drawn = np.clip(middle + rng.normal(0.0, 0.6, len(ARM)), lower, upper)
        return drawn if upright is None else upright.stood_up(drawn, anywhere=True)

    with CollisionChecker(
        robot, robot.arm_joints[side], arm=side, ignore=ignore, margin=ARM_MOTION.clearance
    ) as checker:

        def free(rows: Array, closer: float = 0.0) -> bool:
            return (upright is None or upright.kept(rows)) and checker.free(rows, closer)

        # what touches at an end should come off soon; where that is not possible, it may touch all the way
        for near in (ARM_MOTION.near * STRIDES, None):
            if not checker.allow(((first, ARM_MOTION.start_penetration), (last, 1e-3)), near):
                return None
            path = plan(
                first, last, free, sample, STRIDES, budget=budget, project=None if upright is None else upright.stood_up
            )
            if path is not None or not checker.touching():
                break
        if path is None:
            return None
        path = shorten(path, free, STRIDES, rng)
        if not robot.kinematic:  # else corners are not rounded
            rounding = ARM_MOTION.rounding * ARM_MOTION.clearance
            path = exact(path, robot.arm_groups[side], lambda track: free(track, rounding))
    return [tuple(float(value) for value in row) for row in path[1:]]


class _Upright:
    """Keeps what a hand holds upright: it leans a little at most, or as much as at the ends of its way."""

    def __init__(self, robot: Pr2, side: str, first: Array, last: Array) -> None:
        self._kinematics = robot.arm_kinematics[side]
        self._torso = robot.torso()
        held = next(held for held in robot.helds() if held.side == side)
        self._axis = np.array(held.grip.rotate((0.0, 0.0, 1.0)))
        self._most = max(ARM_MOTION.level, float(self._leaning(np.array([first, last])).max()) + 0.02)

    def _leaning(self, rows: Array) -> Array:
        """Return the radians between the axis of what is held and the vertical, for (n, 7)."""
        frames = self._kinematics.tool(self._torso, rows)
        angles: Array = np.arccos(np.clip((frames[:, :3, :3] @ self._axis)[:, 2], -1.0, 1.0))
        return angles

    def kept(self, rows: Array) -> bool:
        """Return whether it is upright in all of (n, 7)."""
        return bool(np.all(self._leaning(rows) <= self._most))

    def stood_up(self, row: Array, *, anywhere: bool = False) -> Array | None:
        """Return a posture like ``row`` in which it is upright; None if there is none nearby, or ``anywhere``."""
        frame = self._kinematics.tool(self._torso, row[None])[0]
        pose = Pose.from_matrix(frame)
        up = np.array(pose.rotate((float(self._axis[0]), float(self._axis[1]), float(self._axis[2]))))
        turn = np.cross(up, (0.0, 0.0, 1.0))
        sine = float(np.linalg.norm(turn))
        if sine > 1e-9:
            x, y, z = (float(value) for value in turn / sine)
            pose = pose.spun(Pose.about((x, y, z), float(np.arctan2(sine, up[2]))))
        solve = self._kinematics.with_pan if anywhere else self._kinematics.track
        found = solve(pose, self._torso, row.tolist())
        return None if found is None else np.array(found, dtype=float)


def plan_line(
    robot: Pr2, side: str, start: Pose, end: Pose, *, ignore: Ignored = (), arm: Sequence[float] | None = None
) -> list[Arm] | None:
    """Plan a straight motion of the tool, whose orientation turns evenly; see :func:`plan_poses`."""
    return plan_poses(robot, side, dense([start, end]), ignore=ignore, arm=arm)


def plan_level(robot: Pr2, side: str, goal: Pose, *, ignore: Ignored = ()) -> list[Arm] | None:
    """Plan a way of a hand in straight lines, on which what it holds leans no more than at its ends.

    It leads straight there; or back towards the robot, or up, or both, before and after that. See :func:`plan_arm`.
    """
    start = robot.tool_at(side, robot.arm(side))
    shoulder = robot.base_link()
    for up, back in ARM_MOTION.level_detours:
        corners = [_aside(shoulder, pose, up, back) for pose in (start, goal)] if up or back else []
        whole = dense([start, *corners, goal], 2.0)
        rows = plan_poses(robot, side, whole, ignore=ignore, margin=ARM_MOTION.level_clearance)
        if rows is not None:
            return rows[1:]
    return None


def _aside(base: Pose, pose: Pose, up: float, back: float) -> Pose:
    """Return the pose higher up and nearer to the robot."""
    x, y, z = pose.position
    away = max(hypot(base.position[0] - x, base.position[1] - y), 1e-6)
    nearer = min(back, away)
    return Pose(
        (x + nearer * (base.position[0] - x) / away, y + nearer * (base.position[1] - y) / away, z + up),
        pose.orientation,
    )


def plan_poses(
    robot: Pr2,
    side: str,
    poses: Sequence[Pose],
    *,
    ignore: Ignored = (),
    arm: Sequence[float] | None = None,
    base: Base | None = None,
    torso: float | None = None,
    margin: float = 0.0,
) -> list[Arm] | None:
    """Compute joint positions along tool poses, without leaps between them; nothing moves.

    Args:
        robot: The robot.
        side: The arm.
        poses: Tool frames in the world, a few centimetres apart at most.
        ignore: (body, link) that may be touched, link None: all of the body.
        arm: Where the arm is at the first pose. None: where it is, if its tool is there (to 1 cm and 0.05 rad);
            else several solutions of the first pose are tried, nearest first.
        base: Pose of the base; None: the present one.
        torso: Height of the torso; None: the present one.
        margin: Metres that count as touching, except for what is as near at the start.

    Returns:
        One row for each pose, the first included; None if a pose is out of reach, or the way to it is blocked.
    """
    kinematics = robot.arm_kinematics[side]
    height = robot.torso() if torso is None else torso
    back = robot.base_link(base).inverse()
    seeds = [tuple(arm)] if arm is not None else _first_rows(robot, side, poses[0], base, torso)
    with CollisionChecker(
        robot, robot.arm_joints[side], positions=robot.elsewhere(base, torso), arm=side, ignore=ignore, margin=margin
    ) as checker:
        for seed in seeds:
            for collision in checker.collisions(seed):
                if collision[3] <= ARM_MOTION.start_penetration:
                    checker.allowed[collision[:3]] = collision[3] + 1e-3
            rows = _along(checker, lambda pose, last: kinematics.track(back * pose, height, last), seed, poses)
            if rows is not None:
                return rows
            checker.allowed.clear()
    return None


def _along(
    checker: CollisionChecker, track: Callable[[Pose, Arm], Arm | None], seed: Arm, poses: Sequence[Pose]
) -> list[Arm] | None:
    """Return free rows from ``seed`` on, checked in chunks: blocked ways are noticed early."""
    rows, looked_at = [seed], 0
    for number, pose in enumerate(poses[1:], 1):
        row = track(pose, rows[-1])
        checker.sim.work += _TRACK_WORK
        if row is None:
            return None
        rows.append(row)
        if len(rows) - looked_at == ARM_MOTION.chunk or number == len(poses) - 1:
            if not checker.free(np.array(rows[looked_at:])):
                return None
            looked_at = len(rows)
    return rows if len(poses) > 1 or checker.free(np.array(rows)) else None


def _first_rows(robot: Pr2, side: str, pose: Pose, base: Base | None, torso: float | None) -> list[Arm]:
    """Return the arm as it is, if its tool is at ``pose``; else solutions that differ, nearest first."""
    now = robot.arm(side)
    tool = robot.tool_at(side, now, base=base, torso=torso)
    if tool.distance(pose) < 0.01 and tool.angle(pose) < 0.05:
        return [now]
    chosen: list[Arm] = []
    for row in robot.solve(side, pose, base=base, torso=torso):
        if all(max(abs(a - b) for a, b in zip(row, other, strict=True)) > 0.3 for other in chosen):
            chosen.append(row)
    return chosen[: ARM_MOTION.max_branches]


def dense(poses: Sequence[Pose], pitch: float = 1.0) -> list[Pose]:
    """Insert poses so that neighbours are at most ``pitch`` cm and 0.05 ``pitch`` rad apart."""
    found = [poses[0]]
    for start, end in pairwise(poses):
        pieces = max(1, ceil(max(start.distance(end) / (0.01 * pitch), start.angle(end) / (0.05 * pitch)) - 1e-9))
        found += [between(start, end, k / pieces) for k in range(1, pieces + 1)]
    return found


def between(start: Pose, end: Pose, part: float) -> Pose:
    """Return the pose at ``part`` (0 to 1) of the way; the orientation turns evenly (slerp, Shoemake 1985)."""
    a, b = np.array(start.orientation), np.array(end.orientation)
    b = b if a @ b >= 0 else -b
    angle = start.angle(end) / 2
    mixed = a + part * (b - a)
    if angle > 1e-6:
        mixed = (sin((1 - part) * angle) * a + sin(part * angle) * b) / sin(angle)
    mixed /= np.linalg.norm(mixed)
    x, y, z = (p + part * (q - p) for p, q in zip(start.position, end.position, strict=True))
    orientation: Quaternion = (float(mixed[0]), float(mixed[1]), float(mixed[2]), float(mixed[3]))
    return Pose((x, y, z), orientation)


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
