"""Recordings of runs: one motion as JSON Lines and MCAP, in the forms that readers know."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ET
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
import yaml

import tmd
from tests.bundled import kit
from tmd.diagnostics import TmdError
from tmd.export.trajectory import SUFFIXES
from tmd.records.trajectory import SampleLine, SceneLine

pytest.importorskip("pybullet", reason="needs the extra robot")
ROOT = Path(__file__).parents[2]
PLAN = [tmd.Instruction("find", ("pot1",)), tmd.Instruction("moveto", ("pot1",))]


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """One run in all forms: the same plan, so the same motion."""
    folder = tmp_path_factory.mktemp("trajectory")
    kitchen = kit("kitchen")
    files = {suffix: folder / f"run{suffix}" for suffix in SUFFIXES}
    for file in files.values():
        run = kitchen.run_plan(PLAN, "kitchen1", kinematic=True, trajectory=file, rate=5)
        assert run.record.status == "done"
    return files


def samples(recorded: dict[str, Path]) -> list[SampleLine]:
    return [SampleLine.from_text(line, "t") for line in recorded[".jsonl"].read_text().splitlines()[1:]]


def test_the_lines_say_where_everything_was(recorded: dict[str, Path]) -> None:
    first = recorded[".jsonl"].read_text().splitlines()[0]
    scene = SceneLine.from_text(first, "t")
    assert (scene.environment, scene.rate) == ("kitchen1", 5.0)
    assert set(scene.fixtures) >= {"counter1", "fridge1"}
    lines = samples(recorded)
    assert [line.time for line in lines] == sorted(line.time for line in lines)
    assert next(line.number for line in lines if line.instruction == "find(pot1)") == 1
    assert {line.instruction for line in lines} == {"", "find(pot1)", "moveto(pot1)"}
    start, end = lines[0], lines[-1]
    assert start.base == (0.0, 0.0, 0.0)
    assert start.joints["head_pan_joint"] == 0.0
    assert any(abs(line.joints["head_pan_joint"]) > 0.1 for line in lines), "it turned its head"
    x, y, *_ = end.objects["pot1"]
    assert ((end.base[0] - x) ** 2 + (end.base[1] - y) ** 2) ** 0.5 < 1.1, "it drove to the pot"
    assert "fridge1_door" in end.object_joints
    driving = [line.time for line in lines if line.instruction == "moveto(pot1)"]
    assert all(later - earlier <= 0.2 + 1 / 15 for earlier, later in pairwise(driving))


def test_mcap_is_read_back_as_ros_2_messages(recorded: dict[str, Path]) -> None:
    reading = pytest.importorskip("mcap_ros2.reader", reason="needs the extra ros")
    from mcap.reader import make_reader

    found: dict[str, list[Any]] = {}
    for message in reading.read_ros2_messages(str(recorded[".mcap"])):
        found.setdefault(message.channel.topic, []).append((message.log_time_ns, message.ros_msg))
    lines = samples(recorded)
    states = found["/joint_states"]
    assert len(states) == len(lines)
    for (time, state), line in zip(states, lines, strict=True):
        assert time == state.header.stamp.sec * 10**9 + state.header.stamp.nanosec == round(line.time * 1e9)
        assert dict(zip(state.name, state.position, strict=True)) == pytest.approx(line.joints, abs=1e-6)
    transforms = {frame.child_frame_id: frame.transform for frame in found["/tf"][-1][1].transforms}
    assert transforms["base_footprint"].translation.x == pytest.approx(lines[-1].base[0], abs=1e-6)
    assert set(transforms) > {"pot1", "cup1"}
    assert {frame.child_frame_id for frame in found["/tf_static"][0][1].transforms} >= {"fridge1", "counter1"}
    robot = ET.fromstring(found["/robot_description"][0][1].data)
    assert {joint.get("name") for joint in robot.iter("joint")} >= set(states[0][1].name)
    parents = {frame.child_frame_id: frame.header.frame_id for frame in found["/tf"][-1][1].transforms}
    parents |= {frame.child_frame_id: frame.header.frame_id for frame in found["/tf_static"][0][1].transforms}
    assert {link.get("name") for link in robot.findall("link")} <= set(parents)
    for name in list(parents):
        while name != "map":
            name = parents[name]
    with recorded[".mcap"].open("rb") as file:
        channels = make_reader(file).get_summary().channels.values()
    profiles = {
        channel.topic: yaml.safe_load(channel.metadata.get("offered_qos_profiles", "[]")) for channel in channels
    }
    latched = {topic for topic, profile in profiles.items() if profile and profile[0]["durability"] == 1}
    assert latched == {"/tf_static", "/robot_description"}
    assert [message.data for _, message in found["/instruction"] if message.data] == ["find(pot1)", "moveto(pot1)"]


def test_a_file_of_another_kind_is_refused(tmp_path: Path) -> None:
    kitchen = kit("kitchen")
    with pytest.raises(TmdError, match=r"ends in one of \.jsonl, \.mcap"):
        kitchen.run_plan(PLAN, "kitchen1", trajectory=tmp_path / "run.bag")
    assert json.dumps(sorted(path.name for path in tmp_path.iterdir())) == "[]"
