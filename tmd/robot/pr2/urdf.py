"""The PR2's URDF, its faults, and a repaired copy in the user's cache directory.

The package ``example-robot-data`` holds the robot with its meshes. pybullet loads it as it is, and then the arms are
black (their meshes have no normals), the robot is 14 kg too heavy (frames without ``<inertial>`` get 1 kg each) and it
cannot drive (the wheels are fixed, and the base has no joints). The copy is made once for each content of the source.
"""

from __future__ import annotations

import hashlib
import importlib.metadata
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path

from tmd.diagnostics import MissingToolError, TmdError, install_extra
from tmd.files import make_directory, write_bytes
from tmd.pddl.reading.syntax import nearest
from tmd.robot.pr2 import tiago_pro
from tmd.robot.pr2.kinematics import faults_of
from tmd.robot.sim.urdf_files import cache_directory, end_of, find_mesh, mesh_advice, mesh_library, read_urdf

BASE_JOINTS = ("base_x_joint", "base_y_joint", "base_theta_joint")
TORSO = "torso_lift_joint"
HEAD = ("head_pan_joint", "head_tilt_joint")
ARM = (
    "shoulder_pan_joint",
    "shoulder_lift_joint",
    "upper_arm_roll_joint",
    "elbow_flex_joint",
    "forearm_roll_joint",
    "wrist_flex_joint",
    "wrist_roll_joint",
)
FINGERS = (
    "gripper_l_finger_joint",
    "gripper_r_finger_joint",
    "gripper_l_finger_tip_joint",
    "gripper_r_finger_tip_joint",
)
TOOL = "gripper_tool_frame"
# For driving with empty hands: the arms stay above the base, 0.38 m to the front and 0.37 m to the sides at most. Found
# by random search on the collision hulls, at the lowest torso, where the base is nearest. The SRDF's tucked arms lie
# across each other, and one in the way of the other.
TUCKED = {
    "right": (-0.192, 1.046, -0.883, -2.301, 1.193, -1.594, 1.345),
    "left": (0.192, 1.046, 0.883, -2.301, -1.193, -1.594, -1.345),
}
# The robots of ``example-robot-data`` that the skills can move.
ROBOTS = {"pr2": "pr2_description/urdf/pr2.urdf", "tiago_pro": "tiago_pro_description/robots/tiago_pro.urdf"}
_DISTRIBUTION = "example-robot-data"
_ADVICE = install_extra("robot")
_WITH_HANDS = "the skills take things: name a PR2 or a TIAGo Pro with both of its grippers"
_ANOTHER = "the skills move a PR2 or a TIAGo Pro: leave --urdf out, or say --robot tiago_pro"
_FRAME_MASS = 1e-3
# Metres: the range of the base's two sliding joints, more than any room.
_HALL = 100.0


@dataclass(frozen=True, slots=True)
class RobotDescription:
    """A robot that pybullet can load, with the PR2's names of links and joints.

    Attributes:
        urdf: The repaired file.
        source: The file as it was, with the robot's own names.
        disabled: Pairs of links, in both orders, that never collide or always do (the SRDF's list, and neighbours).
        tucked: The postures of the arms for driving with empty hands.
        fingers: The joints of a hand, without its side: the four of the PR2 first.
        finger_range: Of these joints: closed, open; radians.
        tip_offset: Metres between the frames of the finger tips when their surfaces meet.
        eye: The cameras, in the frame of head_tilt_link.
        own_joints: By the PR2's names of joints: the robot's own, and sign and shift from a position here to one there.
    """

    urdf: Path
    root: ET.Element
    source: Path
    disabled: frozenset[tuple[str, str]]
    tucked: Mapping[str, tuple[float, ...]]
    fingers: tuple[str, ...] = FINGERS
    finger_range: tuple[float, float] = (0.0, 0.548)
    tip_offset: float = 0.0336
    eye: tuple[float, float, float] = (0.1, 0.0, 0.11)
    own_joints: Mapping[str, tuple[str, float, float]] = field(default_factory=dict)


def prepare(urdf: Path | None = None) -> RobotDescription:
    """Repair a PR2's URDF, or the packaged one.

    Raises:
        MissingToolError: The package or its meshes are not there.
        TmdError: ``urdf`` cannot be read, is neither a PR2 nor a TIAGo Pro, has no hands, or lacks a mesh.
    """
    source = packaged("urdf/pr2.urdf") if urdf is None else urdf
    root = read_urdf(source)
    for end, hint in faults_of(root):
        raise TmdError(f"{source}{end}", hint=hint)
    missing = tiago_pro.missing_joints(root)
    if missing and not any("finger" in joint.get("name", "") for joint in root.findall("joint")):
        raise TmdError(f"{source} has no hands: {_lacks('joint', missing)}", hint=_WITH_HANDS)
    other = missing == []
    if other:
        tiago_pro.adapt(root)
    check(source, root)
    meshes = {}
    for mesh in root.iter("mesh"):
        name = mesh.get("filename", "")
        path = find_mesh(source, name)
        if path is None:
            if urdf is None:
                raise MissingToolError(f"the PR2's mesh {name} is missing", hint=f"{_ADVICE} --force-reinstall")
            raise TmdError(f"{source}: its mesh {name} is missing", hint=mesh_advice(source, name))
        meshes[name] = path
    contents = {path: path.read_bytes() for path in sorted(set(meshes.values()))}
    folder = cache_directory("pr2") / _digest(
        source.read_bytes(), *contents.values(), *(str(p).encode() for p in contents)
    )
    names = {path: f"{index:02d}-{path.name}" for index, path in enumerate(contents)}
    repair(root, {name: str(folder / names[path]) for name, path in meshes.items()})
    target = folder / "pr2.urdf"
    copies = {folder / names[path]: data for path, data in contents.items()}
    if not all(file.is_file() for file in (*copies, target)):
        make_directory(folder)
        for file, data in copies.items():
            write_bytes(file, with_normals(data) if file.suffix.lower() == ".stl" else data)
        write_bytes(target, ET.tostring(root, encoding="utf-8"))  # last: where it is, everything is
    if other:
        return RobotDescription(
            target, root, source, _both_ways(tiago_pro.never_checked(root)), tiago_pro.TUCKED,
            (*FINGERS, *tiago_pro.COUPLED), (0.0, tiago_pro.CLOSED), tiago_pro.TIP_OFFSET, tiago_pro.EYE,
            tiago_pro.OWN_JOINTS,
        )  # fmt: skip
    return RobotDescription(target, root, source, _disabled(root), TUCKED)


def packaged_robot(name: str) -> Path | None:
    """Return the URDF of a robot of :data:`ROBOTS`; ``None`` for the PR2, the default everywhere.

    Raises:
        MissingToolError: The package, or the file in it, is not there.
        TmdError: There is no such robot.
    """
    if name not in ROBOTS:
        raise TmdError(
            f"there is no robot '{name}'", hint=nearest(name, list(ROBOTS)) or f"there are {', '.join(ROBOTS)}"
        )
    return None if name == "pr2" else _of_package(ROBOTS[name])


def packaged(name: str) -> Path:
    """Return a file of the PR2 in ``example-robot-data``.

    Raises:
        MissingToolError: The package, or the file in it, is not there.
    """
    return _of_package(f"pr2_description/{name}")


def _of_package(name: str) -> Path:
    try:
        files = importlib.metadata.files(_DISTRIBUTION) or []
    except importlib.metadata.PackageNotFoundError as error:
        raise MissingToolError(f"the PR2's model is missing: no package {_DISTRIBUTION}", hint=_ADVICE) from error
    found = [file for file in files if file.as_posix().endswith(f"/{name}")]
    path = Path(str(found[0].locate())) if found else None
    if path is None or not path.is_file():
        raise MissingToolError(f"{_DISTRIBUTION} has no {name}", hint=f"{_ADVICE} --force-reinstall")
    return path


def check(source: Path, root: ET.Element) -> None:
    """Refuse a URDF that is not a PR2's.

    Raises:
        TmdError: Joints are missing; the message names some of them.
    """
    movable = {joint.get("name") for joint in root.findall("joint") if joint.get("type") != "fixed"}
    wanted = [TORSO, *HEAD, *(f"{side}_{joint}" for side in "rl" for joint in (*ARM, *FINGERS))]
    missing = [joint for joint in wanted if joint not in movable]
    links = {link.get("name") for link in root.findall("link")}
    frames = ["base_footprint", "base_link", *(f"{side}_{TOOL}" for side in "rl")]
    missing_links = [frame for frame in frames if frame not in links]
    fingers = {f"{side}_{joint}" for side in "rl" for joint in FINGERS}
    if missing and set(missing) <= fingers:
        raise TmdError(f"{source} has no hands, or not both: {_lacks('joint', missing)}", hint=_WITH_HANDS)
    if missing or missing_links:
        parts = [_lacks(kind, names) for kind, names in (("joint", missing), ("link", missing_links)) if names]
        raise TmdError(f"{source} is not a PR2: {'; '.join(parts)}", hint=_ANOTHER)
    if _root_link(root) != "base_footprint":
        raise TmdError(
            f"{source}: its root is {_root_link(root)}, not base_footprint",
            hint="take the joints in front of base_footprint out: the base gets its own",
        )


def _lacks(kind: str, names: list[str]) -> str:
    plural = "s" if len(names) > 1 else ""
    return f"{len(names)} {kind}{plural} missing: {', '.join(names[:4])}{', …' if len(names) > 4 else ''}"


def repair(root: ET.Element, meshes: dict[str, str]) -> None:
    """Repair a parsed URDF in place, with new names of its mesh files.

    Frames that carry nothing are left out, except the tool frames: fewer links are faster. Links without
    ``<inertial>`` get a gram. The base gets joints: x and y slide, theta turns.
    """
    for extra in [child for child in root if child.tag not in ("link", "joint", "material")]:
        root.remove(extra)
    while idle := _idle_leaves(root):
        for child in list(root):
            name = child.get("name", "") if child.tag == "link" else end_of(child, "child")
            if name in idle:
                root.remove(child)
    for mesh in root.iter("mesh"):
        mesh.set("filename", meshes[mesh.get("filename", "")])
    for link in root.findall("link"):
        if link.find("inertial") is None:
            link.append(_inertial(_FRAME_MASS))
    kinds = (("prismatic", "1 0 0"), ("prismatic", "0 1 0"), ("continuous", "0 0 1"))
    frames = ("base_origin", "base_x_link", "base_y_link", "base_footprint")
    for frame in frames[:-1]:
        ET.SubElement(root, "link", name=frame).append(_inertial(1.0))
    for joint_name, (kind, axis), before, after in zip(BASE_JOINTS, kinds, frames[:-1], frames[1:], strict=True):
        joint = ET.SubElement(root, "joint", name=joint_name, type=kind)
        ET.SubElement(joint, "parent", link=before)
        ET.SubElement(joint, "child", link=after)
        ET.SubElement(joint, "axis", xyz=axis)
        limits = {} if kind == "continuous" else {"lower": str(-_HALL), "upper": str(_HALL)}
        ET.SubElement(joint, "limit", limits, effort="1e5", velocity="2")


def with_normals(data: bytes) -> bytes:
    """Return an STL file with the normals of its facets."""
    mesh = mesh_library().load(BytesIO(data), file_type="stl", process=False)
    return bytes(mesh.export(file_type="stl"))


def _root_link(root: ET.Element) -> str:
    children = {end_of(joint, "child") for joint in root.findall("joint")}
    return next((link.get("name", "") for link in root.findall("link") if link.get("name") not in children), "")


def _idle_leaves(root: ET.Element) -> set[str]:
    """Return links without children, visuals and collisions: sensor frames, and helpers of the gripper."""
    parents = {end_of(joint, "parent") for joint in root.findall("joint")}
    return {
        link.get("name", "")
        for link in root.findall("link")
        if link.get("name") not in parents
        and not link.get("name", "").endswith(TOOL)
        and link.find("collision") is None
        and link.find("visual/geometry/mesh") is None
    }


def _inertial(mass: float) -> ET.Element:
    """Return the inertia of a small ball of 2 cm, so that the tensor is positive."""
    inertial = ET.Element("inertial")
    ET.SubElement(inertial, "mass", value=repr(mass))
    moment = repr(0.4 * mass * 0.02**2)
    ET.SubElement(inertial, "inertia", ixx=moment, iyy=moment, izz=moment, ixy="0", ixz="0", iyz="0")
    return inertial


def _disabled(root: ET.Element) -> frozenset[tuple[str, str]]:
    """Return pairs that need no check: the SRDF's, and links that are joined by one joint."""
    pairs = {(end_of(joint, "parent"), end_of(joint, "child")) for joint in root.findall("joint")}
    srdf = read_urdf(packaged("srdf/pr2.srdf"))
    pairs |= {(pair.get("link1", ""), pair.get("link2", "")) for pair in srdf.findall("disable_collisions")}
    return _both_ways(pairs)


def _both_ways(pairs: Iterable[tuple[str, str]]) -> frozenset[tuple[str, str]]:
    return frozenset(each for a, b in pairs for each in ((a, b), (b, a)))


def _digest(*parts: bytes) -> str:
    """Return a name for the contents and for the present text of the modules whose repairs are in the copy."""
    parts = (*parts, Path(__file__).read_bytes(), Path(tiago_pro.__file__).read_bytes())
    return hashlib.sha256(b"".join(hashlib.sha256(part).digest() for part in parts)).hexdigest()[:20]
