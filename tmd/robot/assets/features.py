"""Features of a model's surfaces: regions to put things in, grips of joints, grasps of items, signs."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from tmd.robot.sim.pose import Pose, Vector, quaternion_of


@dataclass(frozen=True, slots=True)
class Frame:
    """A position and the directions of the tool there: ``approach`` is the tool's +x, ``across`` its +y (fingers)."""

    position: Vector
    approach: Vector
    across: Vector

    def pose(self) -> Pose:
        """Return the same as a pose."""
        x, y = np.array(self.approach), np.array(self.across)
        return Pose(self.position, quaternion_of(np.stack([x, y, np.cross(x, y)], axis=1)))


@dataclass(frozen=True, slots=True)
class Region:
    """A space for items on, in or next to a part.

    Attributes:
        link: The link it moves with.
        low: Lower corner of the box; its z is that of the items' undersides.
        high: Upper corner.
        entry: Unit vector along which the gripper enters.
        spots: Places of items: (x, y, z, yaw), those best to reach first.
        overhang: Allowed overhang of items at the front; ``inf``: on all sides, as of a pot over a burner.
        heap: Whether things may lie on one another there, as in a basket.
    """

    part: str
    relation: str
    link: str
    low: Vector
    high: Vector
    entry: Vector
    spots: tuple[tuple[float, float, float, float], ...]
    overhang: float = 0.0
    heap: bool = False


@dataclass(frozen=True, slots=True)
class Grip:
    """The place to work a joint at: see :class:`tmd.robot.scene.scene.Handle`; ``tool`` is in the link's frame."""

    part: str
    kind: str
    link: str
    tool: Frame
    opening: float
    closed: float
    open: float
    settings: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True, slots=True)
class Grasp:
    """A way to take an item: the tool in the item's frame, and the gap of the fingers before they close (metres)."""

    tool: Frame
    opening: float


@dataclass(frozen=True, slots=True)
class Opening:
    """The rim of a vessel, round and level while it stands.

    Its middle is in the item's frame, its radius inside of the wall; ``level`` is the height up to which it is filled.
    """

    centre: Vector
    radius: float
    level: float

    @property
    def spills_from(self) -> float:
        """Radians that it may lean before the surface of its contents reaches the rim."""
        return math.atan((self.centre[2] - self.level) / self.radius)


@dataclass(frozen=True, slots=True)
class Lamp:
    """A link whose colour shows a state of a part."""

    part: str
    predicate: str
    link: str
    on: tuple[float, float, float, float]
    off: tuple[float, float, float, float]
