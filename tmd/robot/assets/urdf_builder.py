"""A model under construction: links, boxes and joints of one object as URDF text, and what its surfaces are good for.

Everything is in the frame of the link it belongs to; a link that does not move relative to the whole has the whole's
frame (see :meth:`UrdfModel.link`), so builders think in one frame as long as nothing moves.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from xml.sax.saxutils import escape

from tmd.robot.assets.features import Grasp, Grip, Lamp, Opening, Region, rgba
from tmd.robot.sim.pose import Pose, Vector
from tmd.robot.sim.urdf_files import CUBE

# The name of the whole object among its parts and links.
ROOT = ""
_INVISIBLE = (0.0, 0.0, 0.0, 0.0)
_TURNED = {"x": (0.0, math.pi / 2, 0.0), "y": (math.pi / 2, 0.0, 0.0), "z": (0.0, 0.0, 0.0)}


@dataclass(slots=True)
class UrdfLink:
    """A link and the joint that carries it; ``turn`` is roll, pitch, yaw of the joint's frame."""

    name: str
    parent: str
    kind: str
    origin: Vector
    axis: Vector
    lower: float
    upper: float
    friction: float
    spring: float
    mass: float
    turn: Vector = (0.0, 0.0, 0.0)
    visuals: list[str] = field(default_factory=list)
    collisions: list[str] = field(default_factory=list)
    boxes: list[tuple[Vector, Vector]] = field(default_factory=list)

    def at(self, position: float) -> Pose:
        """Return the link's frame in its parent's for a position of the joint."""
        pose = Pose(self.origin)
        if self.turn != (0.0, 0.0, 0.0):
            pose = pose * Pose.turned(*self.turn)
        if position and self.kind == "prismatic":
            pose = pose * Pose((self.axis[0] * position, self.axis[1] * position, self.axis[2] * position))
        elif position and self.kind == "revolute":
            pose = pose * Pose.about(self.axis, position)
        return pose


class UrdfModel:
    """An object under construction; ``mass`` is that of the root link, in kilograms.

    Attributes:
        opening: The rim of a vessel; None for a thing that holds nothing, or is closed.
        spouts: Where a stream leaves a part, in the whole's frame, by part.
    """

    def __init__(self, name: str, mass: float) -> None:
        self.name = name
        self.mass = mass
        root = UrdfLink(ROOT, ROOT, "root", (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 0.0, 0.0, 0.0, 0.0, mass)
        self.links: dict[str, UrdfLink] = {ROOT: root}
        self.regions: list[Region] = []
        self.grips: list[Grip] = []
        self.grasps: list[Grasp] = []
        self.lamps: list[Lamp] = []
        self.contents: list[str] = []
        self.opening: Opening | None = None
        self.spouts: dict[str, Vector] = {}
        self.part_links: dict[str, str] = {ROOT: ROOT}
        self.link_parts: dict[str, str] = {ROOT: ROOT}
        self.low: list[float] = [math.inf] * 3
        self.high: list[float] = [-math.inf] * 3

    def link(
        self,
        name: str,
        *,
        part: str = ROOT,
        kind: str = "fixed",
        origin: Vector = (0.0, 0.0, 0.0),
        axis: Vector = (0.0, 0.0, 1.0),
        limits: tuple[float, float] = (0.0, 0.0),
        friction: float = 0.0,
        spring: float = 0.0,
        mass: float = 0.0,
    ) -> None:
        """Add a link, on the root by a joint of the same name.

        ``kind`` is ``fixed``, ``revolute`` or ``prismatic``. Origin, axis and limits (radians or metres) are those of
        the joint in the root's frame; the link's frame lies there. The first link of a part is the part's own.
        ``friction`` holds the joint in place, ``spring`` drives it back to 0 (N or N·m). A mass of 0 means weightless.
        """
        self.links[name] = UrdfLink(name, ROOT, kind, origin, axis, *limits, friction, spring, mass or 0.001)
        self.part_links.setdefault(part, name)
        self.link_parts[name] = part

    def frame(self, link: str, positions: Mapping[str, float] | None = None) -> Pose:
        """Return the link's frame in the root's for positions of joints; others are at 0."""
        pose = Pose((0.0, 0.0, 0.0))
        while link != ROOT:
            pose = self.links[link].at((positions or {}).get(link, 0.0)) * pose
            link = self.links[link].parent
        return pose

    def box(
        self, centre: Vector, size: Vector, colour: str, *, link: str = ROOT, solid: bool = True, seen: bool = True,
        turn: Vector = (0.0, 0.0, 0.0),
    ) -> None:  # fmt: skip
        """Add a box; ``turn`` is roll, pitch, yaw."""
        self._shape(f'<box size="{_words(size)}"/>', centre, turn, colour, link, solid, seen)
        if solid:
            self._extend(link, centre, size, turn[2])

    def slab(self, low: Vector, high: Vector, colour: str, *, link: str = ROOT, solid: bool = True) -> None:
        """Add a box by two of its corners."""
        self.box(*_between(low, high), colour, link=link, solid=solid)

    def cylinder(
        self, centre: Vector, radius: float, length: float, colour: str, *, axis: str = "z", link: str = ROOT,
        solid: bool = True, seen: bool = True,
    ) -> None:  # fmt: skip
        """Add a cylinder along x, y or z."""
        geometry = f'<cylinder radius="{radius:.5f}" length="{length:.5f}"/>'
        self._shape(geometry, centre, _TURNED[axis], colour, link, solid, seen)
        if solid:
            wide = 2 * radius
            size = {"x": (length, wide, wide), "y": (wide, length, wide), "z": (wide, wide, length)}[axis]
            self._extend(link, centre, size, 0.0)

    def ball(self, centre: Vector, radius: float, colour: str, *, link: str = ROOT) -> None:
        """Add a sphere that nothing touches."""
        geometry = f'<sphere radius="{radius:.5f}"/>'
        self._shape(geometry, centre, (0.0, 0.0, 0.0), colour, link, solid=False, seen=True)

    def tube(
        self, radius: float, wall: float, low: float, high: float, colour: str, *,
        centre: tuple[float, float] = (0.0, 0.0),
    ) -> None:  # fmt: skip
        """Add an upright wall round a hollow; ``radius`` is the outer one."""
        count, middle, height = 12, (low + high) / 2, high - low
        apothem = radius * math.cos(math.pi / count)
        length = 2 * apothem * math.tan(math.pi / count)
        for index in range(count):
            angle = 2 * math.pi * index / count
            at = apothem - wall / 2
            place = (centre[0] + at * math.cos(angle), centre[1] + at * math.sin(angle), middle)
            self.box(place, (wall, length, height), colour, turn=(0.0, 0.0, angle))

    def mesh(self, seen: Path, solids: Sequence[Path], low: Vector, high: Vector, colour: str) -> None:
        """Add a mesh in the root's frame: one visible file, convex ones for collisions, and its box."""
        named = [f'<mesh filename="{escape(str(path))}"/>' for path in (seen, *solids)]
        self._shape(named[0], (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), colour, ROOT, solid=False, seen=True)
        for solid in named[1:]:
            self._shape(solid, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), colour, ROOT, solid=True, seen=False)
        self._extend(ROOT, *_between(low, high), 0.0)

    def lamp(self, part: str, predicate: str, link: str, on: str, off: str | None) -> None:
        """Let ``link`` show whether ``predicate`` holds of ``part``; off is invisible where it is None."""
        self.lamps.append(Lamp(part, predicate, link, rgba(on), rgba(off) if off else _INVISIBLE))

    def region(
        self, relation: str, low: Vector, high: Vector, entry: Vector, spots: Sequence[tuple[float, float, float]],
        *, part: str = ROOT, link: str = ROOT, overhang: float = 0.0, heap: bool = False,
    ) -> None:  # fmt: skip
        """Add a region whose items stand on its floor at ``spots`` (x, y, yaw)."""
        placed = tuple((x, y, low[2], yaw) for x, y, yaw in spots)
        self.regions.append(Region(part, relation, link, low, high, entry, placed, overhang, heap))

    def text(self) -> str:
        """Return the URDF."""
        lines = ['<?xml version="1.0"?>', f'<robot name="{self.name}">']
        for link in self.links.values():
            lines += [f'<link name="{link.name or "root"}">', *self.physics(link), *link.visuals, *link.collisions]
            lines.append("</link>")
            if link.name != ROOT:
                lines += _joint(link)
        return "\n".join([*lines, "</robot>", ""])

    def physics(self, link: UrdfLink) -> list[str]:
        """Return friction and inertia, of a mass that is spread over the box, as elements of a ``<link>``."""
        low, high = _bounds(link.boxes)
        size = [max(b - a, 0.005) for a, b in zip(low, high, strict=True)]
        centre = [(a + b) / 2 for a, b in zip(low, high, strict=True)]
        squares = [side * side * link.mass / 12 for side in size]
        moments = (squares[1] + squares[2], squares[0] + squares[2], squares[0] + squares[1])
        named = " ".join(f'{n}="{max(v, 1e-7):.9f}"' for n, v in zip(("ixx", "iyy", "izz"), moments, strict=True))
        return [
            '<contact><lateral_friction value="0.8"/><spinning_friction value="0.002"/>'
            '<rolling_friction value="0.0005"/></contact>',
            f'<inertial><origin xyz="{_words(centre)}"/><mass value="{link.mass:.4f}"/>'
            f'<inertia {named} ixy="0" ixz="0" iyz="0"/></inertial>',
        ]

    def _shape(
        self, geometry: str, centre: Vector, turn: Vector, colour: str, link: str, solid: bool, seen: bool
    ) -> None:
        place = f'<origin xyz="{_words(centre)}" rpy="{_words(turn)}"/>'
        if seen:
            values = " ".join(f"{v:.3f}" for v in rgba(colour))
            number = sum(len(known.visuals) for known in self.links.values())
            material = f'<material name="m{number}"><color rgba="{values}"/><specular rgb="0 0 0"/></material>'
            shown = geometry.replace("<box size", f'<mesh filename="{CUBE}" scale')
            self.links[link].visuals.append(f"<visual>{place}<geometry>{shown}</geometry>{material}</visual>")
        if solid:
            self.links[link].collisions.append(f"<collision>{place}<geometry>{geometry}</geometry></collision>")

    def _extend(self, link: str, centre: Vector, size: Vector, yaw: float) -> None:
        c, s = abs(math.cos(yaw)), abs(math.sin(yaw))
        half = ((size[0] * c + size[1] * s) / 2, (size[0] * s + size[1] * c) / 2, size[2] / 2)
        low = (centre[0] - half[0], centre[1] - half[1], centre[2] - half[2])
        high = (centre[0] + half[0], centre[1] + half[1], centre[2] + half[2])
        self.links[link].boxes.append((low, high))
        for axis, shift in enumerate(self.frame(link).position):
            self.low[axis] = min(self.low[axis], low[axis] + shift)
            self.high[axis] = max(self.high[axis], high[axis] + shift)


def _between(low: Vector, high: Vector) -> tuple[Vector, Vector]:
    centre = ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2)
    return centre, (high[0] - low[0], high[1] - low[1], high[2] - low[2])


def _joint(link: UrdfLink) -> list[str]:
    # pybullet applies damping explicitly: more than a joint's inertia times 240 steps a second throws it about
    lines = [
        f'<joint name="{link.name}" type="{link.kind}">',
        f'<parent link="{link.parent or "root"}"/><child link="{link.name}"/><origin xyz="{_words(link.origin)}"/>',
    ]
    if link.kind != "fixed":
        lines.append(
            f'<axis xyz="{_words(link.axis)}"/>'
            f'<limit lower="{link.lower:.5f}" upper="{link.upper:.5f}" effort="100" velocity="5"/>'
            '<dynamics damping="0.0005" friction="0"/>'
        )
    return [*lines, "</joint>"]


def _bounds(boxes: Sequence[tuple[Vector, Vector]]) -> tuple[Sequence[float], Sequence[float]]:
    if not boxes:
        return (-0.005,) * 3, (0.005,) * 3
    return [min(b[0][i] for b in boxes) for i in range(3)], [max(b[1][i] for b in boxes) for i in range(3)]


def _words(values: Sequence[float]) -> str:
    return " ".join(f"{value:.5f}" for value in values)
