"""Exported scenes: other simulators read them, and in them everything stands where it stands in ours."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest
import yaml

from tmd.diagnostics import TmdError
from tmd.export.directory import write_directory
from tmd.export.scene_files import FORMATS, scene_files
from tmd.robot.scene.scene import Scene
from tmd.robot.sim.simulator import Simulator
from tmd.world.environment import load_room
from tmd.world.folder import DomainFolder

pytest.importorskip("pybullet", reason="needs the extra robot")
ROOT = Path(__file__).parents[2]
ROOM = "name: mine\ndomain: kitchen\nobjects:\n" + "".join(
    f"  {line}\n"
    for line in (
        "counter1: {class: counter, position: [-2.0, 0.4, 0], yaw: 10}",
        "drawer1: {class: drawer, states: {opened: true}}",
        "fridge1: {class: fridge, parts: {door: {opened: true}}}",
        "mug1: {class: mug, at: on counter1, yaw: 30}",
        "milk1: {class: milk_carton, at: in fridge1}",
    )
)


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("mujoco", reason="needs the extra mujoco")
    folder = tmp_path_factory.mktemp("scene")
    (folder / "mine.yaml").write_text(ROOM)
    room, kitchen = load_room(folder / "mine.yaml"), DomainFolder(ROOT / "domains" / "kitchen")
    files = scene_files(room, kitchen, FORMATS)
    assert files == scene_files(room, kitchen, FORMATS), "the same bytes each time"
    write_directory(folder / "out", files)
    return folder / "out"


def test_the_urdf_puts_the_objects_where_our_scene_has_them(written: Path) -> None:
    room, kitchen = load_room(written.parent / "mine.yaml"), DomainFolder(ROOT / "domains" / "kitchen")
    poses = urdf_positions(written / "scene.urdf")
    assert set(poses) == {"room", "counter1", "drawer1", "fridge1", "mug1", "milk1"}
    with Simulator() as sim:
        scene = Scene(sim, room, kitchen, settle=240)
        for name in scene.blueprints:
            assert poses[name] == pytest.approx(scene.pose_of(name).position, abs=1e-4), name


def urdf_positions(path: Path) -> dict[str, tuple[float, ...]]:
    """Each object's place in the world."""
    found: dict[str, tuple[float, ...]] = {}
    for joint in ET.fromstring(path.read_bytes()).findall("joint"):
        parent, child, origin = joint.find("parent"), joint.find("child"), joint.find("origin")
        if parent is not None and parent.get("link") == "world" and child is not None and origin is not None:
            found[child.get("link", "")] = tuple(map(float, origin.get("xyz", "").split()))
    return found


def test_mujoco_takes_the_scene_and_nothing_falls(written: Path) -> None:
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(written / "scene.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    poses = urdf_positions(written / "scene.urdf")
    start = {name: data.body(name).xpos.copy() for name in poses}
    for name, pose in poses.items():
        assert start[name] == pytest.approx(pose, abs=1e-4), name
    assert data.joint("fridge1_door_joint").qpos[0] == pytest.approx(1.57, abs=0.01), "the door is open"
    for _ in range(round(1 / model.opt.timestep)):
        mujoco.mj_step(model, data)
    for name in ("mug1", "milk1"):
        assert np.linalg.norm(data.body(name).xpos - start[name]) < 0.005, name


def test_the_urdf_is_one_tree_that_an_independent_reader_takes(written: Path) -> None:
    reading = pytest.importorskip("yourdfpy", reason="a development tool")
    scene = reading.URDF.load(str(written / "scene.urdf"), load_collision_meshes=True)
    assert scene.validate(), scene.errors
    assert {name for name, joint in scene.joint_map.items() if joint.type == "floating"} == {
        "world_mug1_joint", "world_milk1_joint",
    }  # fmt: skip
    for name, pose in urdf_positions(written / "scene.urdf").items():
        assert scene.get_transform(name, "world")[:3, 3] == pytest.approx(pose, abs=1e-4), name


def test_joints_that_are_not_at_zero_are_told(written: Path) -> None:
    told = yaml.safe_load((written / "initial_positions.yaml").read_text())["initial_positions"]
    assert set(told) >= {"drawer1_tray_joint", "fridge1_door_joint"}
    assert told["fridge1_door_joint"] == pytest.approx(1.57, abs=0.01), "the door is open"


def test_a_format_that_is_not_there_is_refused() -> None:
    room = load_room(ROOT / "problems/kitchen/environments/kitchen1.yaml")
    with pytest.raises(TmdError, match="there is no scene format 'usd'"):
        scene_files(room, DomainFolder(ROOT / "domains" / "kitchen"), ("usd",))
