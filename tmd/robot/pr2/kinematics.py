"""Forward kinematics of a robot in numpy, for many configurations at once.

The simulator can tell this as well, for one configuration at a time and by moving its robot. Planners ask for
thousands.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from math import asin, atan2, cos, inf, isinf, pi, sin
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tmd.pddl.reading.syntax import nearest
from tmd.robot.sim.urdf_files import end_of, mesh_library

Array = NDArray[np.float64]
Fault: TypeAlias = tuple[str, str | None]
"""The end of a sentence about a file, and the cure."""
# Radians, or metres, beyond which a limit is in degrees or millimetres, and what these are.
_FARTHEST = {"revolute": (4 * pi, "radians", pi / 180), "prismatic": (6.0, "metres", 0.001)}


@dataclass(frozen=True, slots=True)
class Link:
    """A link and the joint that carries it.

    Attributes:
        parent: The link that the joint stands on.
        kind: ``fixed``, ``revolute``, ``continuous`` or ``prismatic``.
        origin: The joint in the parent's frame, 4×4.
        axis: In the joint's frame, a unit vector.
        lower: Least position; −inf for continuous joints.
        upper: Greatest position; inf for continuous joints.
    """

    name: str
    joint: str
    parent: str
    kind: str
    origin: Array
    axis: Array
    lower: float
    upper: float


class Tree:
    """The links of a URDF, whose ``<robot>`` is ``root``.

    Attributes:
        links: By name, every link after its parent; the root is not among them.
        root: The name of the root link.
    """

    def __init__(self, root: ET.Element) -> None:
        found = {link.name: link for link in map(_link, root.findall("joint"))}
        (self.root,) = {link.parent for link in found.values()} - set(found)
        self.links: dict[str, Link] = {}
        reached = [self.root]
        while reached:
            parent = reached.pop()
            for link in found.values():
                if link.parent == parent:
                    self.links[link.name] = link
                    reached.append(link.name)

    def below(self, link: str) -> list[str]:
        """Return ``link`` and everything it carries, in order."""
        result = {link}
        for name, each in self.links.items():
            if each.parent in result:
                result.add(name)
        return [name for name in self.links if name in result]

    def chain(self, first: str, last: str) -> list[Link]:
        """Return the links after ``first`` up to ``last``."""
        result = []
        name = last
        while name != first:
            result.append(self.links[name])
            name = self.links[name].parent
        return result[::-1]

    def forward(
        self, positions: Mapping[str, ArrayLike], links: Iterable[str], known: Mapping[str, Array]
    ) -> dict[str, Array]:
        """Return the frames of ``links`` and of ``known``, 4×4 or (n, 4, 4), in the frame that ``known`` is given in.

        Args:
            positions: Of joints by name, numbers or arrays (n,); joints that are not named are at 0.
            links: Names, every link after its parent.
            known: Known frames, among them the parents of the first links.
        """
        frames = dict(known)
        for name in links:
            link = self.links[name]
            frame = frames[link.parent] @ link.origin
            if link.kind != "fixed":
                frame = frame @ motion(link, positions.get(link.joint, 0.0))
            frames[name] = frame
        return frames


def faults_of(root: ET.Element) -> Iterator[Fault]:
    """Yield what is wrong with the links and joints of a URDF, whose numbers are numbers."""
    links = [link.get("name", "") for link in root.findall("link")]
    joints = root.findall("joint")
    if not links:
        yield " has no links", None
        return
    faults = [fault for joint in joints for fault in _joint_faults(joint, links)] or list(_tree_faults(joints, links))
    yield from faults
    if joints and not faults:
        for link in Tree(root).links.values():
            yield from _limit_faults(link)


def _tree_faults(joints: Sequence[ET.Element], links: Sequence[str]) -> Iterator[Fault]:
    children = [end_of(joint, "child") for joint in joints]
    roots = [link for link in links if link not in children]
    twice = sorted({name for names in (links, children) for name in names if names.count(name) > 1})
    if len(roots) != 1 or twice:
        why = f"'{twice[0]}' is twice there" if twice else f"it has the roots {', '.join(roots) or 'none'}"
        yield f" is not a tree: {why}", "let every link but one be the child of one joint"
        return
    reached = set(roots)
    while more := {end_of(joint, "child") for joint in joints if end_of(joint, "parent") in reached} - reached:
        reached |= more
    if away := sorted(set(links) - reached):
        yield f" is not a tree: '{away[0]}' stands on itself", "change a <parent>"


def _joint_faults(joint: ET.Element, links: Sequence[str]) -> Iterator[Fault]:
    told = f": the joint '{joint.get('name', '')}'"
    if not joint.get("name"):
        yield f": the joint of '{end_of(joint, 'child')}' has no name", "say `<joint name=`"
    if joint.get("type") not in ("fixed", "revolute", "continuous", "prismatic"):
        kinds = "fixed, revolute, continuous or prismatic"
        yield f"{told} is {joint.get('type') or 'of no type'}", f"a joint is {kinds}"
    for end in ("parent", "child"):
        if end_of(joint, end) not in links:
            message = f"{told} has the {end} link '{end_of(joint, end)}', which is not there"
            yield (message, nearest(end_of(joint, end), links) or f'say <{end} link="…"/>')


def _limit_faults(link: Link) -> Iterator[Fault]:
    told = f": the joint '{link.joint}'"
    if link.kind != "fixed" and not link.axis.any():
        yield f"{told} has no axis: it is 0 0 0", 'say `<axis xyz="0 0 1"/>`'
    if link.kind not in _FARTHEST:
        return
    farthest, unit, smaller = _FARTHEST[link.kind]
    lower, upper = link.lower, link.upper
    value = max(lower, upper, key=abs)
    if lower == upper or isinf(value):
        why = "its lower limit is its upper one" if lower == upper and lower else "it has no limits"
        hint = 'say `<limit lower="0" upper="1.57" effort="10" velocity="1"/>`'
        yield f"{told} cannot move: {why}", hint
    elif lower > upper:
        hint = f'say lower="{upper:g}" upper="{lower:g}"'
        yield f"{told} cannot move: its lower limit is above its upper one", hint
    elif abs(value) > farthest:
        hint = f"limits are in {unit}: say {value * smaller:.4g} for {value:g}"
        yield f"{told} has a limit of {value:g}", hint


def motion(link: Link, position: ArrayLike) -> Array:
    """Return the motion of a joint in the frame of its link: 4×4, or (n, 4, 4) for n positions."""
    value = np.asarray(position, dtype=float)
    result = np.zeros((*value.shape, 4, 4))
    result[..., 3, 3] = 1.0
    if link.kind == "prismatic":
        result[..., range(3), range(3)] = 1.0
        result[..., :3, 3] = value[..., None] * link.axis
        return result
    c, s = np.cos(value)[..., None, None], np.sin(value)[..., None, None]
    x, y, z = link.axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    result[..., :3, :3] = c * np.eye(3) + s * cross + (1 - c) * np.outer(link.axis, link.axis)
    return result


def _link(joint: ET.Element) -> Link:
    limit = joint.find("limit")
    kind = joint.get("type", "fixed")
    bounded = limit is not None and kind in ("revolute", "prismatic")
    axis = np.array(_numbers(joint.find("axis"), "xyz", (1.0, 0.0, 0.0)))
    return Link(
        name=end_of(joint, "child"),
        joint=joint.get("name", ""),
        parent=end_of(joint, "parent"),
        kind=kind,
        origin=origin(joint.find("origin")),
        axis=axis / (np.linalg.norm(axis) or 1.0),  # those of fixed joints may be 0
        lower=float(limit.get("lower", "0")) if limit is not None and bounded else -inf,
        upper=float(limit.get("upper", "0")) if limit is not None and bounded else inf,
    )


def origin(element: ET.Element | None) -> Array:
    """Return the 4×4 matrix of an ``<origin>``."""
    roll, pitch, yaw = _numbers(element, "rpy", (0.0, 0.0, 0.0))
    cr, sr, cp, sp, cy, sy = cos(roll), sin(roll), cos(pitch), sin(pitch), cos(yaw), sin(yaw)
    result = np.eye(4)
    result[:3, :3] = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    result[:3, 3] = _numbers(element, "xyz", (0.0, 0.0, 0.0))
    return result


def set_origin(element: ET.Element, frame: Array) -> None:
    """Write a 4×4 matrix as the ``<origin>`` of a joint or shape."""
    found = element.find("origin")
    if found is None:
        found = ET.SubElement(element, "origin")
    found.set("xyz", " ".join(repr(float(value)) for value in frame[:3, 3]))
    found.set("rpy", " ".join(map(repr, angles(frame))))


def angles(frame: Array) -> tuple[float, float, float]:
    """Return roll, pitch and yaw of a 4×4 matrix, in radians."""
    pitch = asin(max(-1.0, min(1.0, -float(frame[2, 0]))))
    if abs(frame[2, 0]) > 1 - 1e-9:  # roll and yaw turn about one line
        return 0.0, pitch, atan2(-float(frame[0, 1]), float(frame[1, 1]))
    return atan2(frame[2, 1], frame[2, 2]), pitch, atan2(frame[1, 0], frame[0, 0])


def shape_points(collision: ET.Element) -> Array:
    """Return points (n, 3) of a collision shape in the link's frame: vertices of a mesh, else the corners of a box.

    Raises:
        ValueError: It has no mesh, box, cylinder or sphere with its size.
    """
    shape = next(iter(collision.find("geometry") or ()), ET.Element("nothing"))
    if shape.tag == "mesh":
        mesh = mesh_library().load(shape.get("filename", ""), force="mesh", process=False)
        points = np.asarray(mesh.vertices) * np.array(_numbers(shape, "scale", (1.0, 1.0, 1.0)))
    else:
        if shape.tag == "box":
            half = np.array(_numbers(shape, "size", ())).reshape(3) / 2
        elif shape.tag in ("cylinder", "sphere"):
            radius = float(shape.get("radius", ""))
            half = np.array([radius, radius, float(shape.get("length", "")) / 2 if shape.tag == "cylinder" else radius])
        else:
            raise ValueError(f"no known shape: {shape.tag}")
        points = np.array(list(product((-1, 1), repeat=3))) * half
    frame = origin(collision.find("origin"))
    moved: Array = points @ frame[:3, :3].T + frame[:3, 3]
    return moved


def _numbers(element: ET.Element | None, name: str, default: Sequence[float]) -> Sequence[float]:
    text = None if element is None else element.get(name)
    return default if text is None else [float(word) for word in text.split()]
