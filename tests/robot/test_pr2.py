"""The robot: it goes where it is told, holds what it grips, and asking what would be changes nothing."""

from __future__ import annotations

from collections.abc import Callable
from math import pi

import numpy as np
import pytest

pytest.importorskip("pybullet", reason="needs the extra robot")
pytest.importorskip("cmeel", reason="needs the extra robot")

from tmd.robot.pr2.arm_motion import tuck
from tmd.robot.pr2.pr2 import Pr2
from tmd.robot.pr2.urdf import TUCKED
from tmd.robot.sim.pose import Pose
from tmd.robot.sim.simulator import Simulator, pybullet

Box = Callable[..., int]
DOWN = (0.0, 0.7071067811865476, 0.0, 0.7071067811865476)
"""A tool that points down."""
BOTH = pytest.mark.parametrize("kinematic", [False, True], ids=["physics", "kinematic"])


def robot_in(sim: Simulator, kinematic: bool = False, **options: tuple[float, float, float]) -> Pr2:
    return Pr2(sim, kinematic=kinematic, rng=np.random.default_rng(0), **options)


def test_own_kinematics_are_those_of_the_simulator(sim: Simulator) -> None:
    robot = robot_in(sim)
    rng = np.random.default_rng(1)
    for link in robot.tree.links.values():
        if link.kind != "fixed":
            sim.set_joint(robot.body, link.joint, rng.uniform(max(link.lower, -2), min(link.upper, 2)))
    frames = robot.tree.forward(robot.positions(), robot.tree.links, {robot.tree.root: np.eye(4)})
    for name, index in robot.index.items():
        np.testing.assert_allclose(sim.pose(robot.body, index).homogeneous(), frames[name], atol=1e-6)
    for side in robot.arms:
        assert robot.tool_at(side, robot.arm(side)).distance(robot.tool(side)) < 1e-6


@BOTH
def test_it_stands_still_and_drives(sim: Simulator, box: Box, kinematic: bool) -> None:
    box((8, 8, 0.1), (0, 0, -0.1))
    robot = robot_in(sim, kinematic, pose=(0.5, 0.0, 3.0))
    sim.step(480)
    assert robot.base() == pytest.approx((0.5, 0, 3.0), abs=1e-4)
    assert robot.arm("left") == pytest.approx(TUCKED["left"], abs=1e-3)
    assert robot.drive([(0.5, 1.0, 3.0), (-0.5, 1.0, -3.0)])
    assert robot.base() == pytest.approx((-0.5, 1.0, -3.0), abs=0.006)
    assert robot.raise_torso(0.31)
    assert robot.torso() == pytest.approx(0.31, abs=0.004)
    assert (sim.steps == 480) == kinematic
    assert sim.ticks > 490


def test_turning_takes_the_short_way(sim: Simulator) -> None:
    robot = robot_in(sim, pose=(0.0, 0.0, 3.0))
    before = sim.steps
    assert robot.drive([(0.0, 0.0, -3.0)])
    assert sim.steps - before < 240 * (2 * pi - 6) / 1.5 + 240


@BOTH
def test_a_box_is_gripped_lifted_and_driven_without_slipping(sim: Simulator, box: Box, kinematic: bool) -> None:
    box((8, 8, 0.1), (0, 0, -0.1))
    box((0.6, 1.2, 0.8), (1.0, 0, 0))
    item = box((0.05, 0.05, 0.1), (0.8, -0.2, 0.8), mass=0.2)
    robot = robot_in(sim, kinematic, pose=(0.28, 0.0, 0.0))
    assert robot.raise_torso(0.25)
    assert robot.open_gripper("right", 0.08)
    assert robot.gap("right") == pytest.approx(0.08, abs=0.003)
    above, at = Pose((0.8, -0.2, 1.02), DOWN), Pose((0.8, -0.2, 0.86), DOWN)
    (up, *_) = [arm for arm in robot.solve("right", above) if not robot.collides(side="right", arm=arm)]
    assert robot.move_arm("right", [up])
    assert robot.tool("right").distance(above) < 0.01
    assert not robot.touches("right", item)
    down = robot.solve("right", at, seed=up)[0]
    assert robot.move_arm("right", [down])
    assert robot.close_gripper("right") == pytest.approx(0.05, abs=0.012)
    assert robot.touches("right", item)
    robot.hold("right", item)
    assert (robot.held("right"), robot.held("left")) == (item, None)
    grip = robot.helds()[0].grip
    assert robot.move_arm("right", [up])
    assert sim.pose(item).position[2] == pytest.approx(0.96, abs=0.015)
    assert robot.drive([(-0.5, 0.3, 0.0), (-1.0, 0.0, 1.2)])
    assert robot.helds()[0].grip.distance(grip) < 2e-3
    robot.let_go("right")
    assert robot.open_gripper("right", 0.09)
    sim.step(240)
    assert sim.pose(item).position[2] < 0.1
    assert robot.held("right") is None


def test_a_hand_that_meets_nothing_closes(sim: Simulator) -> None:
    robot = robot_in(sim)
    assert robot.close_gripper("left") == pytest.approx(0.0, abs=0.004)


def test_a_blocked_motion_fails_and_pushes_no_more(sim: Simulator, box: Box) -> None:
    wall = box((0.2, 3, 1.5), (1.0, 0, 0))
    robot = robot_in(sim)
    assert not robot.drive([(1.0, 0.0, 0.0)])
    assert robot.base()[0] < 0.6
    sim.step(120)
    points = pybullet().getContactPoints(robot.body, wall, physicsClientId=sim.client)
    assert sum(point[9] for point in points) < 500


def test_asking_changes_nothing(sim: Simulator, box: Box) -> None:
    def run(asking: bool) -> tuple[float, ...]:
        with Simulator() as world:
            robot = robot_in(world)
            rng = np.random.default_rng(2)
            for _ in range(6):
                robot.move_arm("right", [np.array(TUCKED["right"]) + rng.uniform(-0.1, 0.1, 7)])
                if asking:
                    robot.collides(base=(1.0, 2.0, 0.5), torso=0.3)
                    robot.collides(side="right", arm=(0.0,) * 7)
            return tuple(robot.positions().values())

    assert run(asking=True) == run(asking=False)


def test_collisions_are_named(sim: Simulator, box: Box) -> None:
    table = box((0.6, 1.2, 0.8), (1.0, 0, 0))
    robot = robot_in(sim)
    assert robot.collides() == []
    found = robot.collides(base=(0.6, 0.0, 0.0))
    assert ("base_link", table, -1) in {each[:3] for each in found}
    depths = [each[3] for each in found]
    assert depths == sorted(depths, reverse=True)
    assert robot.collides(base=(0.6, 0.0, 0.0), ignore=[(table, None)]) == []
    crossed = robot.collides(side="right", arm=(0.7, 0.0, 0.0, -2.2, 0.0, 0.0, 0.0))
    assert any(body == robot.body for _, body, _, _ in crossed)


def test_many_positions_are_checked_as_each_of_them_is(sim: Simulator, box: Box) -> None:
    table = box((0.6, 1.2, 0.8), (0.9, 0, 0))
    robot = robot_in(sim)
    high, low = (robot.solve("right", Pose((0.65, -0.2, height))) for height in (0.95, 0.79))
    arms = [*high[:10], *low[:10]]
    verdicts = robot.clear("right", arms)
    assert verdicts == [not robot.collides(side="right", arm=arm) for arm in arms]
    assert any(verdicts[:10])
    assert not any(verdicts[10:])
    assert any(robot.clear("right", arms, ignore=[(table, None)])[10:])
    assert robot.clear("right", []) == []


def test_the_head_finds_what_is_in_view(sim: Simulator, box: Box) -> None:
    item = box((0.1, 0.1, 0.1), (1.5, 1.0, 0.7), mass=0.1)
    screen = box((0.05, 0.5, 2.0), (-1.0, 0, 0))
    behind = box((0.1, 0.1, 0.1), (-1.5, 0.0, 1.0))
    robot = robot_in(sim, kinematic=True)
    point = (1.5, 1.0, 0.75)
    assert robot.look_at(point)
    assert robot.sees(point, item)
    assert not robot.sees((-1.5, 0.0, 1.05), behind)
    robot.look_at((-1.5, 0.0, 1.05))
    assert not robot.sees((-1.5, 0.0, 1.05), behind)
    assert robot.sees((-0.975, 0.0, 1.05), screen)
    assert not robot.sees(point, item)


@BOTH
def test_arms_are_tucked(sim: Simulator, kinematic: bool) -> None:
    robot = robot_in(sim, kinematic)
    assert robot.move_arm("right", [(-0.5, 0.3, -0.8, -1.3, 0.4, -0.9, 0.5)])
    assert robot.move_arm("left", [(1.5, 0.3, 0.8, -1.3, 0.4, -0.9, 0.5)])
    assert tuck(robot)
    for side in robot.arms:
        (near,) = robot.arm_kinematics[side].near(np.array([robot.arm(side)]), TUCKED[side])
        assert near == pytest.approx(TUCKED[side], abs=0.011)


@pytest.mark.parametrize("torso", [0.0, 0.15, 0.31])
def test_tucked_arms_are_clear_of_the_robot_with_open_hands(sim: Simulator, torso: float) -> None:
    robot = robot_in(sim, kinematic=True)
    for side in robot.arms:
        robot.open_gripper(side, 0.09)
    assert robot.collides(torso=torso) == []


@pytest.mark.parametrize("gap", [0.0, 0.01, 0.05, 0.08])
def test_a_hand_opens_to_a_gap(sim: Simulator, gap: float) -> None:
    robot = robot_in(sim, kinematic=True)
    robot.open_gripper("left", gap)
    assert robot.gap("left") == pytest.approx(gap, abs=3e-4)
