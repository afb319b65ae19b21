"""A second robot through the same skills: its figure is the file's, its hands close, and it takes a cup."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

from tests.bundled import kit
from tmd.diagnostics import MissingToolError, TmdError
from tmd.pddl.model import Instruction
from tmd.records.trajectory import SampleLine
from tmd.robot.pr2 import tiago_pro
from tmd.robot.pr2.kinematics import Tree
from tmd.robot.pr2.urdf import packaged_robot, prepare

pytest.importorskip("pybullet", reason="needs the extra robot")
from tmd.robot.pr2.pr2 import Pr2
from tmd.robot.sim.simulator import Simulator

CORNER = Path(__file__).parents[1] / "cli" / "corner.yaml"


@pytest.fixture(scope="module")
def source() -> Path:
    try:
        found = packaged_robot("tiago_pro")
    except MissingToolError:
        pytest.skip("needs the extra robot")
    assert found is not None
    return found


def test_positions_led_back_to_its_own_joints_give_the_figure_of_the_untouched_file(source: Path) -> None:
    model = prepare(source)
    theirs, ours = Tree(ET.fromstring(source.read_bytes())), Tree(model.root)
    by_joint = [{link.joint: link for link in tree.links.values()} for tree in (ours, theirs)]
    rng = np.random.default_rng(0)
    for _ in range(10):
        here, there = {"torso_lift_joint": 0.1}, {"torso_lift_joint": 0.1}
        for name, (own, sign, shift) in model.own_joints.items():
            here[name] = rng.uniform(by_joint[0][name].lower, by_joint[0][name].upper)
            there[own] = sign * here[name] + shift
            assert by_joint[1][own].lower - 1e-9 <= there[own] <= by_joint[1][own].upper + 1e-9, own
        frames = ours.forward(here, ours.links, {ours.root: np.eye(4)})
        known = theirs.forward(there, theirs.links, {theirs.root: np.eye(4)})
        names = {name: tiago_pro.NAMES.get(name, name) for name in known}
        for own_link, link in names.items():
            if link in frames and own_link != "head_2_link":  # whose frame is turned; what is on it is not
                inside = np.linalg.inv(frames["base_footprint"]) @ frames[link]
                np.testing.assert_allclose(inside, known[own_link], atol=1e-6, err_msg=own_link)


def test_its_hands_open_as_wide_as_is_asked_and_it_looks_where_it_is_told(source: Path) -> None:
    with Simulator() as sim:
        robot = Pr2(sim, urdf=source, kinematic=True, rng=np.random.default_rng(0))
        assert robot.collides() == [], "tucked"
        for side in robot.arms:
            for gap in (0.02, 0.05, 0.075):
                robot.open_gripper(side, gap)
                assert robot.gap(side) == pytest.approx(gap, abs=1e-3)
            tool = robot.tool(side)
            tips = [robot.index[f"{side[0]}_gripper_{finger}_finger_tip_link"] for finger in "lr"]
            left, right = (tool.inverse().apply(sim.pose(robot.body, tip).position) for tip in tips)
            assert left[1] > 0 > right[1]
            assert left[0] == pytest.approx(right[0], abs=1e-6)
        assert robot.look_at((2.0, 0.5, 0.8))
        assert not robot.look_at((-2.0, 0.0, 1.0)), "its head does not turn so far"


def test_poses_are_solved_by_damped_least_squares(source: Path) -> None:
    """The closed form is that of the PR2's arms, and must not be asked."""
    with Simulator() as sim:
        robot = Pr2(sim, urdf=source, kinematic=True, rng=np.random.default_rng(0))
        kinematics, rng, solved = robot.arm_kinematics["left"], np.random.default_rng(1), 0
        assert kinematics.endless == ()
        for _ in range(20):
            arm = rng.uniform(kinematics.lower + 0.2, kinematics.upper - 0.2)
            robot.sim.set_joints(robot.body, robot.arm_groups["left"].joints, arm.tolist())
            goal = robot.tool("left")
            found = robot.solve("left", goal, seed=robot.model.tucked["left"])
            solved += bool(found)
            for each in found[:1]:
                robot.sim.set_joints(robot.body, robot.arm_groups["left"].joints, each)
                assert robot.tool("left").distance(goal) < 1e-3
        assert solved >= 18


def test_it_takes_a_cup(tmp_path: Path) -> None:
    plan = [Instruction(name, ("cup1",)) for name in ("find", "moveto", "grasp")]
    file = tmp_path / "run.jsonl"
    run = kit("kitchen").run_plan(plan, CORNER, kinematic=True, robot="tiago_pro", trajectory=file)
    assert run.execution.status == "done", run.execution.reason
    assert "(holding pr2 cup1)" in map(str, run.execution.steps[-1].state)
    sample = SampleLine.from_text(file.read_text().splitlines()[1], "run")
    assert {"arm_left_1_joint", "gripper_right_finger_joint", "head_2_joint"} <= set(sample.joints), "its own names"


def test_a_robot_without_hands_is_refused(source: Path, tmp_path: Path) -> None:
    root = ET.fromstring(source.read_bytes())
    for each in [each for each in root if "finger" in each.get("name", "")]:
        root.remove(each)
    bare = tmp_path / "bare.urdf"
    bare.write_bytes(ET.tostring(root))
    with pytest.raises(TmdError, match=r"bare\.urdf has no hands: 12 joints missing: gripper_right_") as caught:
        prepare(bare)
    assert caught.value.hint is not None
    with pytest.raises(TmdError, match="there is no robot 'tiago'"):
        packaged_robot("tiago")


def test_a_pr2_without_fingers_is_refused(tmp_path: Path) -> None:
    from tmd.robot.pr2.urdf import packaged

    root = ET.fromstring(packaged("urdf/pr2.urdf").read_bytes())
    for each in [each for each in root.findall("joint") if "finger" in each.get("name", "")]:
        each.set("type", "fixed")
    bare = tmp_path / "pr2.urdf"
    bare.write_bytes(ET.tostring(root))
    with pytest.raises(TmdError, match=r"pr2\.urdf has no hands, or not both: 8 joints missing"):
        prepare(bare)
