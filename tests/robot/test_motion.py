"""Planned motions: they exist where they should, and moving along them touches nothing."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pytest

pytest.importorskip("pybullet", reason="needs the extra robot")
pytest.importorskip("cmeel", reason="needs the extra robot")

from tmd.robot.pr2.arm_motion import between, plan_arm, plan_line, plan_poses
from tmd.robot.pr2.base_motion import plan_base
from tmd.robot.pr2.kinematics import Array
from tmd.robot.pr2.pr2 import Pr2
from tmd.robot.pr2.rrt import plan, shorten
from tmd.robot.pr2.trajectory_following import JointGroup, dense, exact, timed
from tmd.robot.sim.pose import Pose
from tmd.robot.sim.simulator import Simulator

Box = Callable[..., int]
DOWN = (0.0, 0.7071067811865476, 0.0, 0.7071067811865476)
LOW = (-0.4, 0.6, -0.8, -1.0, 0.4, -0.9, 0.5)


@pytest.fixture
def robot(sim: Simulator) -> Pr2:
    return Pr2(sim, kinematic=True, rng=np.random.default_rng(0))


def deepest(robot: Pr2, move: Callable[[], object], bodies: Sequence[int]) -> float:
    """How deep the robot is in any of the bodies while it moves, asked of the simulator at every tick."""
    depths = [0.0]

    def watch(sim: Simulator) -> None:
        for body in bodies:
            depths.extend(-point.distance for point in sim.closest(robot.body, body, 0.0))

    robot.sim.add_watcher(watch)
    move()
    robot.sim.remove_watcher(watch)
    return max(depths)


def test_an_arm_goes_around_a_shelf(sim: Simulator, box: Box, robot: Pr2) -> None:
    shelf = box((0.4, 1.0, 0.03), (0.75, -0.3, 0.85))
    above, below = Pose((0.65, -0.2, 1.1)), Pose((0.6, -0.2, 0.6))
    starts, goals = (
        [arm for arm in robot.solve("right", tool) if not robot.collides(side="right", arm=arm)]
        for tool in (above, below)
    )
    assert robot.move_arm("right", [starts[0]])
    path = plan_arm(robot, "right", goals[0], rng=np.random.default_rng(1), budget=1000)
    assert path is not None
    assert len(path) > 1
    assert deepest(robot, lambda: robot.move_arm("right", path), [shelf]) < 1e-3
    assert robot.tool("right").distance(below) < 1e-3
    assert robot.collides() == []


def test_a_plan_is_the_same_for_the_same_seed(sim: Simulator, box: Box, robot: Pr2) -> None:
    box((0.4, 1.0, 0.03), (0.75, -0.3, 0.85))
    goal = robot.solve("right", Pose((0.6, -0.2, 0.6)))[0]
    first, second = (plan_arm(robot, "right", goal, rng=np.random.default_rng(4)) for _ in range(2))
    assert first == second


def test_what_touches_at_the_start_is_left_and_not_dragged_along(sim: Simulator, box: Box, robot: Pr2) -> None:
    """A hand that starts on a plate gets off it before it goes anywhere, even if the way along the plate is shorter."""
    start, above = Pose((0.6, -0.35, 0.9), DOWN), Pose((0.6, 0.0, 0.908), DOWN)
    first, goal = (
        next(arm for arm in robot.solve("right", tool) if not robot.collides(side="right", arm=arm, margin=0.02))
        for tool in (start, above)
    )
    assert robot.move_arm("right", [first])
    plate = box((0.3, 1.0, 0.02), (0.6, -0.2, 0.0))
    for height in np.arange(0.8, 0.95, 0.002):
        sim.set_pose(plate, Pose((0.6, -0.2, float(height))))
        if any(depth > 0.002 for *_, depth in robot.collides(side="right")):
            break
    assert {body for _, body, _, _ in robot.collides(side="right")} == {plate}
    path = plan_arm(robot, "right", goal, rng=np.random.default_rng(1), budget=1000)
    assert path is not None
    rows = dense(np.array([first, *path]), (0.02,) * 7)
    away = next(number for number, row in enumerate(rows) if not robot.collides(side="right", arm=row))
    assert robot.tool_at("right", rows[away]).distance(start) < 0.1
    assert not any(robot.collides(side="right", arm=row) for row in rows[away:])


def test_a_goal_inside_of_something_has_no_plan(sim: Simulator, box: Box, robot: Pr2) -> None:
    block = box((0.4, 0.4, 0.4), (0.65, -0.2, 0.7))
    goal = robot.solve("right", Pose((0.65, -0.2, 0.9)))[0]
    assert plan_arm(robot, "right", goal, rng=np.random.default_rng(0)) is None
    assert plan_arm(robot, "right", goal, rng=np.random.default_rng(0), ignore=[(block, None)]) is not None


def test_a_tool_goes_straight(sim: Simulator, robot: Pr2) -> None:
    start, end = Pose((0.6, -0.3, 1.0), DOWN), Pose((0.6, -0.1, 0.8), DOWN)
    line = plan_line(robot, "right", start, end)
    assert line is not None
    for index, row in enumerate(line):
        wanted = between(start, end, index / (len(line) - 1))
        reached = robot.tool_at("right", row)
        assert reached.distance(wanted) < 5e-4
        assert reached.angle(wanted) < 5e-3
    assert np.abs(np.diff(np.array(line), axis=0)).max() < 0.3
    assert plan_line(robot, "right", start, Pose((1.6, -0.1, 0.8), DOWN)) is None


def test_a_line_through_a_block_is_refused(sim: Simulator, box: Box, robot: Pr2) -> None:
    block = box((0.1, 0.05, 0.5), (0.6, -0.2, 0.7))
    start, end = Pose((0.6, -0.4, 1.0), DOWN), Pose((0.6, 0.0, 1.0), DOWN)
    assert plan_line(robot, "right", start, end) is None
    assert plan_line(robot, "right", start, end, ignore=[(block, -1)]) is not None


def test_planning_for_another_stance_is_moving_there_first(sim: Simulator, robot: Pr2) -> None:
    poses = [Pose((2.0 + 0.01 * index, 0.5, 0.9), DOWN) for index in range(8)]
    assert plan_poses(robot, "right", poses) is None
    stance = (1.4, 0.7, 0.0)
    ahead = plan_poses(robot, "right", poses, base=stance, torso=0.2)
    assert ahead is not None
    robot.drive([stance])
    robot.raise_torso(0.2)
    robot.move_arm("right", ahead)
    assert robot.tool("right").distance(poses[-1]) < 1e-3


def test_what_is_held_is_kept_clear_as_well(sim: Simulator, box: Box, robot: Pr2) -> None:
    robot.move_arm("right", [LOW])
    tool = robot.tool("right")
    x, y, z = tool.position
    stick = box((0.03, 0.03, 0.5), (x, y, z - 0.6), mass=0.1)
    assert robot.collides(side="right") == []
    table = box((0.6, 0.6, 0.1), (x, y, z - 0.85))
    robot.hold("right", stick)
    lower = robot.solve("right", Pose((x, y, z - 0.2), tool.orientation))[0]
    found = robot.collides(side="right", arm=lower)
    assert {(name, body) for name, body, _, _ in found} == {("r_gripper_tool_frame", table)}


def test_the_base_goes_around_a_table(sim: Simulator, box: Box, robot: Pr2) -> None:
    table = box((0.6, 1.2, 0.8), (1.2, 0, 0))
    path = plan_base(robot, (2.3, 0.2, 3.1), rng=np.random.default_rng(0))
    assert path is not None
    assert deepest(robot, lambda: robot.drive(path), [table]) < 1e-3
    assert robot.base() == pytest.approx((2.3, 0.2, 3.1))
    assert plan_base(robot, (1.2, 0.0, 0.0), rng=np.random.default_rng(0)) is None


def test_a_walled_in_goal_has_no_way(sim: Simulator, box: Box, robot: Pr2) -> None:
    for place, size in (
        ((2, 1, 0), (2.2, 0.1, 1)),
        ((2, -1, 0), (2.2, 0.1, 1)),
        ((1, 0, 0), (0.1, 2, 1)),
        ((3, 0, 0), (0.1, 2, 1)),
    ):
        box(size, place)
    assert plan_base(robot, (2.0, 0.0, 0.0), rng=np.random.default_rng(0)) is None


def test_rrt_finds_the_gap_in_a_wall() -> None:
    rng = np.random.default_rng(0)
    strides = np.array([0.02, 0.02])

    def free(points: np.ndarray) -> bool:
        wall = np.abs(points[:, 0] - 0.5) < 0.05
        return not bool(np.any(wall & (np.abs(points[:, 1] - 0.8) > 0.1)))

    start, goal = np.array([0.1, 0.2]), np.array([0.9, 0.2])
    path = plan(start, goal, free, lambda: rng.uniform(0, 1, 2), strides, budget=2000)
    assert path is not None
    assert free(dense(path, [0.005, 0.005]))
    short = shorten(path, free, strides, rng)
    lengths = [np.linalg.norm(np.diff(each, axis=0), axis=1).sum() for each in (path, short)]
    assert lengths[1] <= lengths[0] + 1e-9
    assert (short[0] == start).all()
    assert (short[-1] == goal).all()
    assert free(dense(short, [0.02, 0.02]))
    assert plan(start, goal, lambda points: False, lambda: rng.uniform(0, 1, 2), strides, budget=20) is None


def test_corners_that_must_not_be_rounded_are_not() -> None:
    path = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]])
    group = JointGroup((0, 1), (1.0, 1.0), (1.0, 1.0), (0.1, 0.1), 0.01)

    def outside(track: Array) -> bool:
        """Nothing may be more than 5 mm inside of the corner."""
        return not np.any((track[:, 0] < 0.995) & (track[:, 1] > 0.005))

    assert not outside(timed(path, group.speeds, 240, group.window))
    rested = exact(path, group, outside)
    assert outside(timed(rested, group.speeds, 240, group.window))
    assert np.array_equal(np.unique(rested, axis=0), np.unique(path, axis=0))
    assert exact(path, group, lambda track: True) is path


def test_trajectories_keep_the_speed_and_end_at_rest() -> None:
    path = np.array([[0.0, 0.0], [1.0, 0.2], [1.0, 1.0]])
    track = timed(path, [1.0, 0.5], rate=240, window=48)
    speeds = np.diff(np.vstack([path[:1], track]), axis=0) * 240
    assert np.abs(speeds).max(axis=0) == pytest.approx([1.0, 0.5], rel=0.01)
    assert np.abs(speeds[[0, -1]]).max() < 0.03
    assert (track[-1] == path[-1]).all()
    assert len(timed(path[:1].repeat(2, axis=0), [1.0, 1.0], 240, 48)) > 0
