"""Inverse kinematics: both solvers against forward kinematics, and within the limits."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tmd.diagnostics import MissingToolError
from tmd.robot.pr2 import urdf as pr2_urdf
from tmd.robot.pr2.ik import ArmKinematics
from tmd.robot.pr2.kinematics import Array, Tree
from tmd.robot.sim.pose import Pose

try:
    TREE = Tree(pr2_urdf.prepare().root)
except MissingToolError:
    pytest.skip("needs the extra robot", allow_module_level=True)
ARMS = {side: ArmKinematics(TREE, side) for side in ("right", "left")}
HOME = (0.0,) * 7
DESCENT = {side: ArmKinematics(TREE, side) for side in ("right", "left")}
for each in DESCENT.values():
    each.closed_form = False
SOLVERS = pytest.mark.parametrize("arms", [ARMS, DESCENT], ids=["closed form", "descent"])
Arms = dict[str, ArmKinematics]


def configuration(side: str, seed: int) -> Array:
    kinematics = ARMS[side]
    lower = np.where(np.isinf(kinematics.lower), -np.pi, kinematics.lower + 0.02)
    upper = np.where(np.isinf(kinematics.upper), np.pi, kinematics.upper - 0.02)
    drawn: Array = np.random.default_rng(seed).uniform(lower, upper)
    return drawn


def tool(side: str, arm: Array, torso: float) -> Pose:
    return Pose.from_matrix(ARMS[side].tool(torso, arm[None])[0])


@SOLVERS
@given(side=st.sampled_from(["right", "left"]), seed=st.integers(0, 10**6), torso=st.floats(0, 0.31))
@settings(max_examples=25, deadline=None, derandomize=True)
def test_poses_that_an_arm_can_reach_are_solved(arms: Arms, side: str, seed: int, torso: float) -> None:
    target = tool(side, configuration(side, seed), torso)
    found = arms[side].solve(target, torso, HOME)
    assert found
    rows = np.array(found)
    assert arms[side].inside(rows, 0.0).all()
    for arm in rows:
        reached = tool(side, arm, torso)
        assert reached.distance(target) < 2e-4
        assert reached.angle(target) < 2e-3
    far = np.abs(rows).max(axis=1)
    assert (np.diff(far) > -1e-5).all()


@SOLVERS
def test_a_pose_out_of_reach_has_no_solution(arms: Arms) -> None:
    assert arms["right"].solve(Pose((1.5, 0.0, 1.0)), 0.1, HOME) == []
    assert arms["right"].track(Pose((1.5, 0.0, 1.0)), 0.1, HOME) is None


@SOLVERS
def test_small_motions_of_the_tool_are_small_motions_of_the_arm(arms: Arms) -> None:
    arm = np.array([-0.5, 0.3, -0.8, -1.3, 0.4, -0.9, 0.5])
    start = tool("right", arm, 0.2)
    row: tuple[float, ...] = tuple(arm)
    for step in range(1, 11):
        target = Pose((start.position[0], start.position[1], start.position[2] + 0.01 * step), start.orientation)
        after = arms["right"].track(target, 0.2, row)
        assert after is not None
        assert max(abs(a - b) for a, b in zip(row, after, strict=True)) < 0.15
        assert tool("right", np.array(after), 0.2).distance(target) < 2e-4
        row = after


def test_endless_joints_take_the_short_way() -> None:
    seed = (0.0, 0.0, 0.0, -1.0, 9.0, -1.0, -7.0)
    target = tool("left", configuration("left", 3), 0.1)
    for arm in ARMS["left"].solve(target, 0.1, seed)[:5]:
        assert abs(arm[4] - 9.0) <= np.pi + 1e-9
        assert abs(arm[6] + 7.0) <= np.pi + 1e-9


@given(side=st.sampled_from(["right", "left"]), seed=st.integers(0, 10**6), torso=st.floats(0, 0.31))
@settings(max_examples=60, deadline=None, derandomize=True)
def test_the_closed_form_gives_a_configuration_back_to_the_digit(side: str, seed: int, torso: float) -> None:
    arm = configuration(side, seed)
    found = ARMS[side].with_pan(tool(side, arm, torso), torso, tuple(arm))
    assert found == pytest.approx(arm, abs=1e-6)


def test_an_arm_that_is_built_otherwise_has_no_closed_form() -> None:
    """The elbow is 1 cm beside the line from the shoulder to the wrist: descent solves it."""
    root = pr2_urdf.prepare().root
    origin = next(j for j in root.iter("joint") if j.get("name") == "r_elbow_flex_joint").find("origin")
    assert origin is not None
    origin.set("xyz", "0.4 0.01 0")
    arm = ArmKinematics(Tree(root), "right")
    target = Pose.from_matrix(arm.tool(0.1, configuration("right", 5)[None])[0])
    assert ARMS["right"].closed_form and not arm.closed_form
    found = arm.solve(target, 0.1, HOME)
    assert found and Pose.from_matrix(arm.tool(0.1, np.array(found[:1]))[0]).distance(target) < 2e-4
