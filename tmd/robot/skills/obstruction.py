"""Names of what is in the way: asked only where something could not be done; nothing moves."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from tmd.robot.pr2.collision import Ignored
from tmd.robot.pr2.quick_checks import HandChecker
from tmd.robot.sim.pose import Pose
from tmd.robot.skills.robot_context import Base, Cell

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


class _Rejecter:
    """Collects what rejected ways meet, and reports each of them to :attr:`Cell.rejected`.

    Attributes:
        met: Number of ways on which each thing is met.
    """

    def __init__(self, cell: Cell, what: str) -> None:
        self._cell, self._what = cell, what
        self.met: Counter[str] = Counter()

    def add(
        self, touched: Iterable[tuple[int, int]], positions: Mapping[str, float], hand: tuple[str, Pose] | None = None
    ) -> None:
        """Add a way: what it touches, and where the robot, or only a hand, is then."""
        names = _names(self._cell, touched)
        self.met.update(names)
        if names:
            self._cell.rejected(self._what, frozenset(names), positions, hand)

    def look(self, *, itself: bool = True, **at: Any) -> None:  # noqa: ANN401 - as they are there
        """Add the robot at some positions; the arguments are those of :meth:`tmd.robot.pr2.pr2.Pr2.collides`."""
        robot, arm = self._cell.robot, at.get("arm")
        positions = robot.elsewhere(at.get("base"), at.get("torso"))
        if arm is not None:
            positions |= dict(zip(robot.arm_joints[at["side"]], arm, strict=True))
        found = robot.collides(**at)
        self.add([(body, link) for _, body, link, _ in found if itself or body != robot.body], positions)


def of_hand(cell: Cell, ways: Sequence[tuple[str, Sequence[Pose], Ignored]]) -> str:
    """Name what a hand, or what it holds, would be in, wherever the robot stood; ``ways``: hand, poses, ignored."""
    found = _Rejecter(cell, "the hand, wherever the robot stands")
    for side, poses, ignore in ways:
        checker = HandChecker(cell.robot, side, ignore)
        found.add({each for pose in poses for each in checker.touched(pose)}, {}, (side, poses[-1]))
    return named(found.met, len(ways))


def of_arm(cell: Cell, side: str, pose: Pose, bases: Sequence[Base], ignore: Ignored) -> str:
    """Name what keeps an arm from a pose, from some places to stand."""
    found = _Rejecter(cell, f"the {side} arm")
    reached = 0
    for base in bases:
        arms = cell.robot.solve(side, pose, base=base)[:_POSTURES]
        reached += bool(arms)
        for arm in arms:
            found.look(side=side, arm=arm, base=base, ignore=ignore)
        if not arms:
            cell.rejected(f"the {side} arm does not reach", frozenset(), cell.robot.elsewhere(base), None)
    if not reached:
        return "it is out of reach of the arm from every place where there is room to stand"
    return named(found.met)


def of_stances(cell: Cell, bases: Sequence[Base]) -> str:
    """Name what stands where the robot would have to stand."""
    found = _Rejecter(cell, "a place to stand")
    for base in bases:
        found.look(base=base)
    return named(found.met, len(bases))


def of_arm_path(cell: Cell, side: str, goal: Sequence[float]) -> str:
    """Name what is on the straight way of an arm's joints to ``goal``."""
    found = _Rejecter(cell, f"the {side} arm on its way")
    start = np.array(cell.robot.arm(side))
    end = cell.robot.arm_kinematics[side].near(np.array([goal], dtype=float), start.tolist())[0]
    for share in np.linspace(0.0, 1.0, _LOOKS):
        found.look(side=side, arm=(start + float(share) * (end - start)).tolist())
    return named(found.met)


def of_straight(cell: Cell, side: str, poses: Sequence[Pose], ignore: Ignored) -> str:
    """Name what is on a straight way of a hand, or say that the arm does not reach so far."""
    found = _Rejecter(cell, f"the {side} hand on its straight way")
    seed = cell.robot.arm(side)
    for pose in poses:
        arms = cell.robot.solve(side, pose, seed=seed)[:_POSTURES]
        if not arms:
            return "the arm does not reach so far from here"
        found.look(side=side, arm=arms[0], ignore=ignore)
    return named(found.met) or "the arm would have to turn over on its way"


def of_base_path(cell: Cell, base: Base) -> str:
    """Name what is on the straight way of the base."""
    found, start = _Rejecter(cell, "the base on its way"), cell.robot.base()
    for share in np.linspace(0.0, 1.0, _LOOKS)[1:]:
        x, y, theta = (a + float(share) * (b - a) for a, b in zip(start, base, strict=True))
        found.look(base=(x, y, theta), margin=0.01)
    return named(found.met)


def of_posture(cell: Cell, torso: float | None = None) -> str:
    """Name what the robot is in as it stands, or would be with the torso at another height."""
    found = _Rejecter(cell, "the robot as it stands")
    found.look(torso=torso, itself=False)
    return named(found.met)
