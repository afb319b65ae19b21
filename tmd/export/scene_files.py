"""The robot's room of an environment for other simulators: URDF and MJCF, meshes and joint positions beside them.

The URDF is one tree under the link ``world``, furniture on fixed joints and things on floating ones; the names of links
begin with the name of their object. MuJoCo compiles the MJCF from that tree.
"""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import yaml

from tmd.diagnostics import MissingToolError, TmdError, install_extra
from tmd.pddl.reading.syntax import nearest
from tmd.robot.pr2.kinematics import angles
from tmd.robot.scene.furniture_layout import build_room
from tmd.robot.scene.scene import Scene
from tmd.robot.sim.pose import Pose
from tmd.robot.sim.simulator import Simulator
from tmd.robot.sim.urdf_files import CUBE
from tmd.world.environment import Environment
from tmd.world.folder import DomainFolder

FORMATS = ("urdf", "mjcf")
WORLD, ROOM = "world", "room"
_MESHES = "meshes"
# Steps of physics after which everything has come to rest.
_SETTLED = 240


@dataclass(frozen=True, slots=True)
class _Part:
    """An object of the scene: its name, its URDF, where it is, whether it can be carried."""

    name: str
    robot: ET.Element
    pose: Pose
    item: bool


def scene_files(environment: Environment, folder: DomainFolder, formats: tuple[str, ...]) -> dict[str, bytes]:
    """Return the files of a scene, by their paths.

    ``formats`` are some of :data:`FORMATS`.

    Returns:
        ``scene.urdf`` and ``scene.xml`` (MJCF) as far as they are asked for; ``meshes/`` for what is not made of boxes
        and cylinders; ``initial_positions.yaml``, the joints that are not at 0.

    Raises:
        MissingToolError: pybullet is not installed, or MuJoCo for MJCF.
        TmdError: There is no such format, or the scene cannot be built.
    """
    for name in formats:
        if name not in FORMATS:
            hint = nearest(name, FORMATS) or f"there are {', '.join(FORMATS)}"
            raise TmdError(f"there is no scene format '{name}'", hint=hint)
    with Simulator() as sim:
        scene = Scene(sim, environment, folder, settle=_SETTLED)
        parts = [_Part(ROOM, ET.fromstring(build_room(scene.room)), Pose((0.0, 0.0, 0.0)), False)]
        positions: dict[str, float] = {}
        for name, blueprint in scene.blueprints.items():
            parts.append(_Part(name, ET.fromstring(blueprint.urdf), scene.pose_of(name), scene.is_item(name)))
            for joint, found in sim.joints(scene.bodies[name]).items():
                if found.kind != "fixed":
                    positions[_joint(name, joint)] = round(sim.joint_position(scene.bodies[name], joint), 4) + 0.0
    meshes = _collect(parts)
    files: dict[str, bytes] = {}
    urdf = _urdf(environment.name, parts)
    if "urdf" in formats:
        files["scene.urdf"] = _text(urdf)
    if "mjcf" in formats:
        files["scene.xml"] = _mjcf(urdf, meshes, positions)
    files |= {f"{_MESHES}/{name}": data for name, data in meshes.items()}
    moved = {name: value for name, value in positions.items() if value}
    files["initial_positions.yaml"] = yaml.safe_dump({"initial_positions": moved}).encode()
    return files


# ---------------------------------------------------------------------- what both have in common


def _collect(parts: list[_Part]) -> dict[str, bytes]:
    """Turn box meshes into boxes, name every other mesh by a file beside the scene, and return the files."""
    found: dict[str, bytes] = {}
    for part in parts:
        for geometry in part.robot.iter("geometry"):
            mesh = geometry.find("mesh")
            if mesh is None:
                continue
            path = mesh.get("filename", "")
            if path == CUBE:
                geometry.remove(mesh)
                ET.SubElement(geometry, "box", size=mesh.get("scale", "1 1 1"))
                continue
            source = Path(path)
            name = f"{re.sub(r'[^a-z0-9]', '', source.parent.name.lower())[:8]}_{source.name}"
            found[name] = source.read_bytes()
            mesh.set("filename", f"{_MESHES}/{name}")
        for owner, extra in (("link", "contact"), ("material", "specular")):  # pybullet's
            for element in part.robot.iter(owner):
                for child in element.findall(extra):
                    element.remove(child)
    return found


def _named(part: _Part, link: str) -> str:
    """Return a link's name in the scene: the root has that of the object."""
    return part.name if link == "root" else f"{part.name}_{link}"


def _joint(owner: str, name: str) -> str:
    """Return a joint's name in the scene, which differs from every link's."""
    return f"{owner}_{name}_joint"


def _text(root: ET.Element) -> bytes:
    ET.indent(root)
    text: bytes = ET.tostring(root, encoding="utf-8")
    return b'<?xml version="1.0"?>\n' + text + b"\n"


def _words(values: tuple[float, ...] | list[float]) -> str:
    return " ".join(f"{round(value, 6) + 0.0:g}" for value in values)


# ---------------------------------------------------------------------- URDF


def _urdf(name: str, parts: list[_Part]) -> ET.Element:
    whole = ET.Element("robot", name=name)
    ET.SubElement(whole, "link", name=WORLD)
    for part in parts:
        prefix = f"{part.name}_"
        for material in part.robot.iter("material"):
            material.set("name", f"{prefix}{material.get('name', '')}")
        whole.extend(part.robot.findall("material"))
        for link in part.robot.findall("link"):
            link.set("name", _named(part, link.get("name", "")))
            whole.append(link)
        for joint in part.robot.findall("joint"):
            joint.set("name", _joint(part.name, joint.get("name", "")))
            for end in (*joint.findall("parent"), *joint.findall("child")):
                end.set("link", _named(part, end.get("link", "")))
            whole.append(joint)
        joint = ET.SubElement(whole, "joint", name=_joint(WORLD, part.name), type="floating" if part.item else "fixed")
        ET.SubElement(joint, "parent", link=WORLD)
        ET.SubElement(joint, "child", link=part.name)
        ET.SubElement(joint, "origin", xyz=_words(part.pose.position), rpy=_words(angles(part.pose.matrix())))
    return whole


# ---------------------------------------------------------------------- MJCF


def _mjcf(urdf: ET.Element, meshes: Mapping[str, bytes], positions: Mapping[str, float]) -> bytes:
    """Compile the URDF with MuJoCo, with its meshes in ``meshes/`` and the joints at the start as a key frame."""
    try:
        import mujoco
    except ImportError as error:
        raise MissingToolError(
            "MJCF is written by MuJoCo", hint=f"{install_extra('mujoco')}, or ask for urdf"
        ) from error
    whole = ET.fromstring(ET.tostring(urdf))
    settings = ET.SubElement(whole, "mujoco")
    ET.SubElement(
        settings, "compiler", meshdir=_MESHES, strippath="true", discardvisual="false", balanceinertia="true",
        fusestatic="false",
    )  # fmt: skip
    with TemporaryDirectory(prefix="tmd-mjcf-") as directory:
        folder = Path(directory)
        (folder / _MESHES).mkdir()
        for name, data in meshes.items():
            (folder / _MESHES / name).write_bytes(data)
        (folder / "scene.urdf").write_bytes(_text(whole))
        try:
            model = mujoco.MjModel.from_xml_path(str(folder / "scene.urdf"))
            mujoco.mj_saveLastXML(str(folder / "scene.xml"), model)
        except (ValueError, mujoco.FatalError) as error:
            raise TmdError(f"MuJoCo does not take the scene: {' '.join(str(error).split())}") from error
        made = ET.fromstring((folder / "scene.xml").read_bytes())
    start = model.qpos0.copy()
    for name, value in positions.items():
        joint = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name)
        if joint >= 0:
            start[model.jnt_qposadr[joint]] = value
    key = ET.SubElement(ET.SubElement(made, "keyframe"), "key", name="start")
    key.set("qpos", _words(start.tolist()))
    return _text(made)
