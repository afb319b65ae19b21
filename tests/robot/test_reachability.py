"""The quick questions before inverse kinematics: they refuse nothing that is possible, and disturb nothing."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

pytest.importorskip("pybullet", reason="needs the extra robot")
pytest.importorskip("cmeel", reason="needs the extra robot")

from tmd.robot.pr2.pr2 import Pr2
from tmd.robot.pr2.quick_checks import HandChecker, Wrists
from tmd.robot.sim.pose import Pose
from tmd.robot.sim.simulator import Simulator

Box = Callable[..., int]
BASES = ((0.0, 0.0, 0.0), (0.7, -0.4, 2.1))


@pytest.fixture
def robot(sim: Simulator) -> Pr2:
    return Pr2(sim, kinematic=True, rng=np.random.default_rng(0))


def postures(robot: Pr2, side: str, count: int) -> list[tuple[float, ...]]:
    kinematics = robot.arm_kinematics[side]
    lower, upper = np.maximum(kinematics.lower, -3.0), np.minimum(kinematics.upper, 3.0)
    return [tuple(row) for row in np.random.default_rng(7).uniform(lower, upper, (count, 7)).tolist()]


@pytest.mark.parametrize("side", ["left", "right"])
def test_no_pose_that_an_arm_has_is_out_of_its_span(robot: Pr2, side: str) -> None:
    for base in BASES:
        for torso in (0.02, 0.3):
            tools = [robot.tool_at(side, arm, base=base, torso=torso) for arm in postures(robot, side, 60)]
            wrists = Wrists(robot, [side] * len(tools), [[tool] for tool in tools])
            assert wrists.within(base, torso) == list(range(len(tools)))


def test_what_is_far_away_is_out_of_the_span_and_one_far_pose_is_enough(robot: Pr2) -> None:
    near = robot.tool("left")
    far = Pose((near.position[0] + 1.5, *near.position[1:]), near.orientation)
    wrists = Wrists(robot, ["left"] * 3, [[near], [far], [near, far]])
    assert wrists.within(robot.base(), robot.torso()) == [0]


def test_a_floating_hand_touches_what_the_hand_of_the_arm_would_touch(robot: Pr2, box: Box) -> None:
    wall = box((0.3, 2.0, 2.0), (0.5, 0.0, 0.3))
    hand = set(robot.tree.below("l_wrist_roll_link"))
    state = robot.sim.joint_states(robot.body, robot.movable), robot.sim.motion(robot.body)
    seen = {True: 0, False: 0}
    for arm in postures(robot, "left", 80):
        touched = [
            depth for link, body, _, depth in robot.collides(side="left", arm=arm) if body == wall and link in hand
        ]
        (depth,) = HandChecker(robot, "left").depth([robot.tool_at("left", arm)])
        assert depth == pytest.approx(max(touched, default=0.0), abs=1e-3)
        seen[depth > 0] += 1
    assert min(seen.values()) > 3
    assert state == (robot.sim.joint_states(robot.body, robot.movable), robot.sim.motion(robot.body))


def test_what_is_ignored_may_be_touched(robot: Pr2, box: Box) -> None:
    wall = box((0.02, 2.0, 2.0), (0.75, 0.0, 1.0))
    into = Pose((0.75, 0.2, 1.0))
    assert HandChecker(robot, "left").depth([into]) > [0.0]
    assert HandChecker(robot, "left", ignore={(wall, None)}).depth([into]) == [0.0]


def test_what_the_other_hand_holds_goes_where_the_robot_goes(robot: Pr2, box: Box) -> None:
    tool = robot.tool("right")
    held = box((0.05, 0.05, 0.05), tool.position, mass=0.1)
    robot.hold("right", held)
    arm = next(a for a in robot.solve("left", tool) if any(c[1] == held for c in robot.collides(side="left", arm=a)))
    away = (2.0, 0.0, 0.0)
    assert any(c[1] == held for c in robot.collides(side="left", arm=arm, base=away))
    assert robot.sim.pose(held).distance(tool) < 0.06  # nothing was moved by asking
