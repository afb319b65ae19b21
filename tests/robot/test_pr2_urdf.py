"""The PR2's model: the packaged one is repaired, and what is not a PR2 is refused in one line."""

from __future__ import annotations

import importlib.metadata
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

from tmd.diagnostics import MissingToolError, TmdError
from tmd.robot.pr2 import urdf as pr2_urdf


@pytest.fixture
def source() -> Path:
    try:
        return pr2_urdf.packaged("urdf/pr2.urdf")
    except MissingToolError:
        pytest.skip("needs the extra robot")


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "cache"
    folder.mkdir()
    monkeypatch.setattr(pr2_urdf, "cache_directory", lambda name: folder)
    return folder


def test_the_copy_is_repaired(source: Path, cache: Path) -> None:
    model = pr2_urdf.prepare()
    assert cache in model.urdf.parents
    joints = {joint.get("name"): joint for joint in model.root.findall("joint")}
    assert all(link.find("inertial") is not None for link in model.root.findall("link"))
    assert [joints[name].get("type") for name in pr2_urdf.BASE_JOINTS] == ["prismatic", "prismatic", "continuous"]
    links = {link.get("name") for link in model.root.findall("link")}
    assert {"r_gripper_tool_frame", "l_gripper_tool_frame"} <= links
    for mesh in model.root.iter("mesh"):
        data = Path(mesh.get("filename", "")).read_bytes()
        facets = np.frombuffer(data, np.dtype([("n", "<f4", 3), ("c", "<f4", (3, 3)), ("r", "<u2")]), offset=84)
        corners = facets["c"].astype(float)
        area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        lengths = np.linalg.norm(facets["n"], axis=1)
        np.testing.assert_allclose(lengths[area > 1e-12], 1, atol=1e-5)


def test_the_copy_is_made_once_and_repaired(source: Path, cache: Path) -> None:
    first = pr2_urdf.prepare().urdf
    made = first.stat().st_mtime_ns
    assert pr2_urdf.prepare().urdf == first
    assert first.stat().st_mtime_ns == made
    mesh = next(first.parent.glob("*.stl"))
    mesh.unlink()
    pr2_urdf.prepare()
    assert mesh.is_file()
    assert not list(first.parent.glob(".*"))


def test_the_same_robot_elsewhere_is_taken(source: Path, cache: Path, tmp_path: Path) -> None:
    text = source.read_text().replace("package://example-robot-data/robots/pr2_description", str(source.parents[1]))
    copy = tmp_path / "mine.urdf"
    copy.write_text(text)
    assert pr2_urdf.prepare(copy).urdf != pr2_urdf.prepare().urdf


def test_another_robot_is_refused_with_what_it_lacks(tmp_path: Path) -> None:
    path = tmp_path / "cart.urdf"
    path.write_text('<robot name="cart"><link name="base_footprint"/></robot>')
    with pytest.raises(
        TmdError, match=r"cart\.urdf is not a PR2: 25 joints missing: torso_lift_joint, .*base_link"
    ) as caught:
        pr2_urdf.prepare(path)
    assert "\n" not in str(caught.value)


def test_one_missing_joint_is_named(source: Path, tmp_path: Path) -> None:
    path = tmp_path / "armless.urdf"
    root = ET.fromstring(source.read_bytes())
    for joint in root.findall("joint"):
        if joint.get("name") == "l_elbow_flex_joint":
            joint.set("type", "fixed")
    path.write_bytes(ET.tostring(root))
    with pytest.raises(TmdError, match=r"1 joint missing: l_elbow_flex_joint"):
        pr2_urdf.prepare(path)


@pytest.mark.parametrize(
    ("tag", "attributes", "message"),
    [
        ("axis", {"xyz": "0 0 0"}, "has no axis"),
        ("axis", {"xyz": "0, 1, 0"}, "is not 3 numbers"),
        ("parent", {"link": "gone"}, "has the parent link 'gone'"),
        ("limit", {"lower": "-121"}, "has a limit of -121"),
        ("limit", {"lower": "0", "upper": "-2"}, "its lower limit is above"),
        ("limit", {"lower": "-pi"}, "is not a number"),
    ],
)
def test_a_joint_that_cannot_be_is_named(
    source: Path, tmp_path: Path, tag: str, attributes: dict[str, str], message: str
) -> None:
    path = tmp_path / "odd.urdf"
    root = ET.fromstring(source.read_bytes())
    (part,) = root.findall(f"joint[@name='l_elbow_flex_joint']/{tag}")
    part.attrib.update(attributes)
    path.write_bytes(ET.tostring(root))
    with pytest.raises(TmdError, match=rf"joint 'l_elbow_flex_joint'.* {message}"):
        pr2_urdf.prepare(path)


def test_a_mesh_that_is_missing_is_named(source: Path, cache: Path, tmp_path: Path) -> None:
    path = tmp_path / "lost.urdf"
    path.write_text(source.read_text())
    with pytest.raises(TmdError, match=r"mesh package://.*base\.stl is missing"):
        pr2_urdf.prepare(path)


@pytest.mark.parametrize("text", ["", "<robot", "<world/>"])
def test_what_is_no_urdf_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "bad.urdf"
    path.write_text(text)
    with pytest.raises(TmdError, match=r"bad\.urdf is no"):
        pr2_urdf.prepare(path)


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(TmdError, match=r"none\.urdf cannot be read: No such file"):
        pr2_urdf.prepare(tmp_path / "none.urdf")


def test_without_the_package_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(name: str) -> None:
        raise importlib.metadata.PackageNotFoundError(name)

    monkeypatch.setattr(importlib.metadata, "files", fail)
    with pytest.raises(MissingToolError, match=r"pip install 'tell-me-dave\[robot\]'"):
        pr2_urdf.prepare()
