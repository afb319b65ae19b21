"""The robot's room of an environment for other simulators: URDF, SDF and MJCF, meshes and joint positions beside them.

All three come from the same links: each object's, with its name before those of its links. The URDF is one tree under
the link ``world``, furniture on fixed joints and things on floating ones. MJCF is what MuJoCo makes of that tree.
"""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import yaml

from tmd.diagnostics import MissingToolError, TmdError
from tmd.pddl.reading.syntax import nearest
from tmd.robot.assets.room import build_room
from tmd.robot.pr2.kinematics import origin
from tmd.robot.scene.scene import Scene
from tmd.robot.sim.box_mesh import CUBE
from tmd.robot.sim.pose import Pose, Vector
from tmd.robot.sim.simulator import Simulator
from tmd.world.environment import Environment
from tmd.world.folder import DomainFolder

FORMATS = ("urdf", "sdf", "mjcf")
WORLD, ROOM = "world", "room"
_MESHES = "meshes"
_SETTLED = 240
"""Steps of physics after which everything has come to rest."""


@dataclass(frozen=True, slots=True)
class _Part:
    """An object of the scene: its name, its URDF, where it is, whether it can be carried."""

    name: str
    robot: ET.Element
    pose: Pose
    item: bool


def scene_files(environment: Environment, folder: DomainFolder, formats: tuple[str, ...]) -> dict[str, bytes]:
    """The files of a scene, by their paths.

    Args:
        environment: What there is and where.
        folder: Its domain.
        formats: Some of :data:`FORMATS`.

    Returns:
        ``scene.urdf``, ``scene.sdf`` and ``scene.xml`` (MJCF) as far as they are asked for; ``meshes/`` for what is
        not made of boxes and cylinders; ``initial_positions.yaml``, the joints that are not at 0.

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
    if "sdf" in formats:
        files["scene.sdf"] = _text(_sdf(environment.name, parts, positions))
    if "mjcf" in formats:
        files["scene.xml"] = _mjcf(urdf, meshes, positions)
    files |= {f"{_MESHES}/{name}": data for name, data in meshes.items()}
    moved = {name: value for name, value in positions.items() if value}
    files["initial_positions.yaml"] = yaml.safe_dump({"initial_positions": moved}).encode()
    return files


# ---------------------------------------------------------------------- what all have in common


def _collect(parts: list[_Part]) -> dict[str, bytes]:
    """Let boxes be boxes again and name every mesh by a file beside the scene; the files."""
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
        for link in part.robot.findall("link"):
            for contact in link.findall("contact"):
                link.remove(contact)  # pybullet's
        for material in part.robot.iter("material"):
            for specular in material.findall("specular"):
                material.remove(specular)
    return found


def _named(part: _Part, link: str) -> str:
    """A link's name in the scene: the root has that of the object."""
    return part.name if link == "root" else f"{part.name}_{link}"


def _joint(owner: str, name: str) -> str:
    """A joint's name in the scene, which is no link's: in SDF both are names of frames."""
    return f"{owner}_{name}_joint"


def _text(root: ET.Element) -> bytes:
    ET.indent(root)
    text: bytes = ET.tostring(root, encoding="utf-8")
    return b'<?xml version="1.0"?>\n' + text + b"\n"


def _words(values: tuple[float, ...] | list[float]) -> str:
    return " ".join(f"{round(value, 6) + 0.0:g}" for value in values)


def _angles(pose: Pose) -> Vector:
    """Roll, pitch, yaw."""
    m = pose.matrix()
    pitch = math.asin(max(-1.0, min(1.0, -float(m[2, 0]))))
    if abs(m[2, 0]) > 1 - 1e-9:
        return 0.0, pitch, math.atan2(-float(m[0, 1]), float(m[1, 1]))
    return math.atan2(m[2, 1], m[2, 2]), pitch, math.atan2(m[1, 0], m[0, 0])


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
            copy = ET.fromstring(ET.tostring(link))
            copy.set("name", _named(part, link.get("name", "")))
            whole.append(copy)
        for joint in part.robot.findall("joint"):
            copy = ET.fromstring(ET.tostring(joint))
            copy.set("name", _joint(part.name, joint.get("name", "")))
            for end in ("parent", "child"):
                found = copy.find(end)
                assert found is not None
                found.set("link", _named(part, found.get("link", "")))
            whole.append(copy)
        joint = ET.SubElement(whole, "joint", name=_joint(WORLD, part.name), type="floating" if part.item else "fixed")
        ET.SubElement(joint, "parent", link=WORLD)
        ET.SubElement(joint, "child", link=part.name)
        ET.SubElement(joint, "origin", xyz=_words(part.pose.position), rpy=_words(_angles(part.pose)))
    return whole


# ---------------------------------------------------------------------- SDF


def _sdf(name: str, parts: list[_Part], positions: Mapping[str, float]) -> ET.Element:
    """SDFormat 1.7: a world with a model for each object."""
    whole = ET.Element("sdf", version="1.7")
    world = ET.SubElement(whole, "world", name=name)
    ET.SubElement(world, "gravity").text = "0 0 -9.81"
    light = ET.SubElement(world, "light", name="sun", type="directional")
    ET.SubElement(light, "direction").text = "-0.3 0.4 -1"
    for part in parts:
        model = ET.SubElement(world, "model", name=part.name)
        ET.SubElement(model, "static").text = "false" if part.item or part.robot.find("joint") is not None else "true"
        ET.SubElement(model, "pose").text = _words((*part.pose.position, *_angles(part.pose)))
        carriers = {}
        for joint in part.robot.findall("joint"):
            parent, child = joint.find("parent"), joint.find("child")
            assert parent is not None
            assert child is not None
            carriers[child.get("link", "")] = (joint, parent.get("link", ""))
        frames: dict[str, Pose] = {}
        for link in part.robot.findall("link"):
            _sdf_link(model, part, link, _frame(part, link.get("name", ""), carriers, positions, frames))
        for below, (carrier, above) in carriers.items():
            _sdf_joint(model, carrier, above, below)
        if not part.item and part.robot.find("joint") is not None:
            fixed = ET.SubElement(model, "joint", name=f"{WORLD}_joint", type="fixed")
            ET.SubElement(fixed, "parent").text = WORLD
            ET.SubElement(fixed, "child").text = "root"
    return whole


def _frame(
    part: _Part,
    link: str,
    carriers: Mapping[str, tuple[ET.Element, str]],
    positions: Mapping[str, float],
    known: dict[str, Pose],
) -> Pose:
    """Where a link is in its model, with its joints where they are at the start: SDF counts positions from there."""
    if link in known:
        return known[link]
    if link not in carriers:
        return Pose((0.0, 0.0, 0.0))
    joint, parent = carriers[link]
    pose = _frame(part, parent, carriers, positions, known) * Pose.from_matrix(origin(joint.find("origin")))
    at, axis = positions.get(_joint(part.name, joint.get("name", "")), 0.0), _axis(joint)
    if joint.get("type") == "prismatic":
        pose = pose * Pose((axis[0] * at, axis[1] * at, axis[2] * at))
    elif joint.get("type") in ("revolute", "continuous"):
        pose = pose * Pose.about(axis, at)
    known[link] = pose
    return pose


def _axis(joint: ET.Element) -> Vector:
    found = joint.find("axis")
    x, y, z = (float(word) for word in ("1 0 0" if found is None else found.get("xyz", "1 0 0")).split())
    length = math.sqrt(x * x + y * y + z * z) or 1.0
    return x / length, y / length, z / length


def _sdf_link(model: ET.Element, part: _Part, link: ET.Element, pose: Pose) -> None:
    name = link.get("name", "")
    made = ET.SubElement(model, "link", name=name)
    ET.SubElement(made, "pose").text = _words((*pose.position, *_angles(pose)))
    inertial = link.find("inertial")
    if inertial is not None:
        mass, inertia = inertial.find("mass"), inertial.find("inertia")
        told = ET.SubElement(made, "inertial")
        place = Pose.from_matrix(origin(inertial.find("origin")))
        ET.SubElement(told, "pose").text = _words((*place.position, *_angles(place)))
        ET.SubElement(told, "mass").text = "1" if mass is None else mass.get("value", "1")
        if inertia is not None:
            tensor = ET.SubElement(told, "inertia")
            for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"):
                ET.SubElement(tensor, key).text = inertia.get(key, "0")
    for kind in ("visual", "collision"):
        for number, shape in enumerate(link.findall(kind)):
            element = ET.SubElement(made, kind, name=f"{kind}{number}")
            place = Pose.from_matrix(origin(shape.find("origin")))
            ET.SubElement(element, "pose").text = _words((*place.position, *_angles(place)))
            _sdf_geometry(element, shape)
            if kind == "visual":
                _sdf_colour(element, part, shape)


def _sdf_geometry(element: ET.Element, shape: ET.Element) -> None:
    geometry = ET.SubElement(element, "geometry")
    found = next(iter(shape.find("geometry") or ()), None)
    assert found is not None, "every shape has one"
    made = ET.SubElement(geometry, found.tag)
    if found.tag == "mesh":
        ET.SubElement(made, "uri").text = found.get("filename", "")
        ET.SubElement(made, "scale").text = found.get("scale", "1 1 1")
        return
    for key in ("size", "radius", "length"):
        if found.get(key) is not None:
            ET.SubElement(made, key).text = found.get(key)


def _sdf_colour(element: ET.Element, part: _Part, shape: ET.Element) -> None:
    named = shape.find("material")
    if named is None:
        return
    colour = named.find("color")
    if colour is None:
        same = (each for each in part.robot.findall("material") if each.get("name") == named.get("name"))
        colour = next((each.find("color") for each in same), None)
    if colour is not None:
        material = ET.SubElement(element, "material")
        for key in ("ambient", "diffuse"):
            ET.SubElement(material, key).text = colour.get("rgba", "")


def _sdf_joint(model: ET.Element, joint: ET.Element, parent: str, child: str) -> None:
    kind = joint.get("type", "fixed")
    made = ET.SubElement(
        model, "joint", name=f"{joint.get('name')}_joint", type="revolute" if kind == "continuous" else kind
    )
    ET.SubElement(made, "parent").text = parent
    ET.SubElement(made, "child").text = child
    if kind == "fixed":
        return
    axis = ET.SubElement(made, "axis")
    ET.SubElement(axis, "xyz").text = _words(_axis(joint))
    limit = joint.find("limit")
    if limit is not None and kind != "continuous":
        told = ET.SubElement(axis, "limit")
        for key in ("lower", "upper", "effort", "velocity"):
            ET.SubElement(told, key).text = limit.get(key, "0")


# ---------------------------------------------------------------------- MJCF


def _mjcf(urdf: ET.Element, meshes: Mapping[str, bytes], positions: Mapping[str, float]) -> bytes:
    """What MuJoCo makes of the URDF, with its meshes in ``meshes/`` and the joints at the start as a key frame.

    Raises:
        MissingToolError: MuJoCo is not installed.
    """
    try:
        import mujoco
    except ImportError as error:
        raise MissingToolError(
            "MJCF is written by MuJoCo", hint="pip install 'tmd[mujoco]', or ask for urdf or sdf"
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
