"""Where the links of a robot are for given joint positions, in numpy and for many configurations at once.

The simulator can tell this as well, for one configuration at a time and by moving its robot. Planners ask for
thousands.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import cos, inf, sin

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Link:
    """A link and the joint that carries it.

    Attributes:
        name: Of the link.
        joint: The name of the joint.
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
    """The links of a URDF.

    Args:
        root: The parsed ``<robot>``.

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
        """``link`` and everything it carries, in order."""
        result = {link}
        for name, each in self.links.items():
            if each.parent in result:
                result.add(name)
        return [name for name in self.links if name in result]

    def chain(self, first: str, last: str) -> list[Link]:
        """The links after ``first`` up to ``last``."""
        result = []
        name = last
        while name != first:
            result.append(self.links[name])
            name = self.links[name].parent
        return result[::-1]

    def forward(
        self, positions: Mapping[str, ArrayLike], links: Iterable[str], known: Mapping[str, Array]
    ) -> dict[str, Array]:
        """Frames of links.

        Args:
            positions: Of joints by name, numbers or arrays (n,); joints that are not named are at 0.
            links: What to work out, every link after its parent.
            known: Frames that are known already, 4×4 or (n, 4, 4), among them the parents of the first links.

        Returns:
            Each of ``links`` and of ``known``: 4×4 or (n, 4, 4), in the frame that ``known`` is given in.
        """
        frames = dict(known)
        for name in links:
            link = self.links[name]
            frame = frames[link.parent] @ link.origin
            if link.kind != "fixed":
                frame = frame @ motion(link, positions.get(link.joint, 0.0))
            frames[name] = frame
        return frames


def motion(link: Link, position: ArrayLike) -> Array:
    """What a joint does to the frame of its link: 4×4, or (n, 4, 4) for n positions."""
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
        name=_end(joint, "child"),
        joint=joint.get("name", ""),
        parent=_end(joint, "parent"),
        kind=kind,
        origin=origin(joint.find("origin")),
        axis=axis / (np.linalg.norm(axis) or 1.0),  # those of fixed joints may be 0
        lower=float(limit.get("lower", "0")) if limit is not None and bounded else -inf,
        upper=float(limit.get("upper", "0")) if limit is not None and bounded else inf,
    )


def origin(element: ET.Element | None) -> Array:
    """The 4×4 matrix of an ``<origin>``."""
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


def _numbers(element: ET.Element | None, name: str, default: Sequence[float]) -> Sequence[float]:
    text = None if element is None else element.get(name)
    return default if text is None else [float(word) for word in text.split()]


def _end(joint: ET.Element, end: str) -> str:
    found = joint.find(end)
    return "" if found is None else found.get("link", "")
