"""Names of what is in the way: asked only where something could not be done; nothing moves."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

import numpy as np

from tmd.robot.pr2.collision import Collision, Ignored
from tmd.robot.pr2.gripper_clearance import HandChecker
from tmd.robot.sim.pose import Pose
from tmd.robot.skills.robot_context import Cell

# Maximum number of things that a message names.
_NAMES = 3
# Places on a way that are checked.
_LOOKS = 12
# Postures of an arm that are checked for each pose.
_POSTURES = 2


def named(counted: Counter[str], of: int = 0) -> str:
    """Name the things that are in the way most often, with the number of ways; empty for none."""
    most = sorted(counted.items(), key=lambda pair: (-pair[1], pair[0]))[:_NAMES]
    if not most:
        return ""
    things = " and ".join(f"{name} ({count} of {of} ways)" if of > 1 else name for name, count in most)
    return f"{things} {'is' if len(most) == 1 else 'are'} in the way"


def _names(cell: Cell, touched: Iterable[tuple[int, int]]) -> set[str]:
    return {
        "the robot itself" if body == cell.robot.body else cell.scene.owner(body, link) or "something"
        for body, link in touched
    }


def _met(cell: Cell, collisions: Iterable[Collision]) -> set[str]:
    return _names(cell, [(body, link) for _, body, link, _ in collisions])


def _counted(cell: Cell, ways: Iterable[Iterable[Collision]]) -> Counter[str]:
    """Count the ways on which each thing is met."""
    return Counter(name for collisions in ways for name in _met(cell, collisions))


def of_hand(cell: Cell, ways: Sequence[tuple[str, Sequence[Pose], Ignored]]) -> str:
    """Name what a hand, or what it holds, would be in, wherever the robot stood; ``ways``: hand, poses, ignored."""
    counted: Counter[str] = Counter()
    for side, poses, ignore in ways:
        checker = HandChecker(cell.robot, side, ignore)
        counted.update(_names(cell, {each for pose in poses for each in checker.touched(pose)}))
    return named(counted, len(ways))


def of_arm(cell: Cell, side: str, pose: Pose, bases: Sequence[tuple[float, float, float]], ignore: Ignored) -> str:
    """Name what keeps an arm from a pose, from some places to stand."""
    counted: Counter[str] = Counter()
    reached = 0
    for base in bases:
        found = cell.robot.solve(side, pose, base=base)[:_POSTURES]
        reached += bool(found)
        for arm in found:
            counted.update(_met(cell, cell.robot.collides(side=side, arm=arm, base=base, ignore=ignore)))
    if not reached:
        return "it is out of reach of the arm from every place where there is room to stand"
    return named(counted)


def of_stances(cell: Cell, bases: Sequence[tuple[float, float, float]]) -> str:
    """Name what stands where the robot would have to stand."""
    return named(_counted(cell, (cell.robot.collides(base=base) for base in bases)), len(bases))


def of_arm_path(cell: Cell, side: str, goal: Sequence[float]) -> str:
    """Name what is on the straight way of an arm's joints to ``goal``."""
    start = np.array(cell.robot.arm(side))
    end = cell.robot.arm_kinematics[side].near(np.array([goal], dtype=float), start.tolist())[0]
    arms = [(start + float(share) * (end - start)).tolist() for share in np.linspace(0.0, 1.0, _LOOKS)]
    return named(_counted(cell, (cell.robot.collides(side=side, arm=arm) for arm in arms)))


def of_straight(cell: Cell, side: str, poses: Sequence[Pose], ignore: Ignored) -> str:
    """Name what is on a straight way of a hand, or say that the arm does not reach so far."""
    counted: Counter[str] = Counter()
    seed = cell.robot.arm(side)
    for pose in poses:
        found = cell.robot.solve(side, pose, seed=seed)[:_POSTURES]
        if not found:
            return "the arm does not reach so far from here"
        counted.update(_met(cell, cell.robot.collides(side=side, arm=found[0], ignore=ignore)))
    return named(counted) or "the arm would have to turn over on its way"


def of_base_path(cell: Cell, base: tuple[float, float, float]) -> str:
    """Name what is on the straight way of the base."""
    start, counted = cell.robot.base(), Counter[str]()
    for share in np.linspace(0.0, 1.0, _LOOKS)[1:]:
        x, y, theta = (a + float(share) * (b - a) for a, b in zip(start, base, strict=True))
        counted.update(_met(cell, cell.robot.collides(base=(x, y, theta), margin=0.01)))
    return named(counted)


def of_posture(cell: Cell, torso: float | None = None) -> str:
    """Name what the robot is in as it stands, or would be with the torso at another height."""
    return named(Counter(_met(cell, [c for c in cell.robot.collides(torso=torso) if c[1] != cell.robot.body])))
