"""Features of a model's surfaces: regions to put things in, grips of joints, grasps of items, signs."""

from __future__ import annotations

import math
import zlib
from collections.abc import Sequence
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


PALETTE = {
    "white": "#f4f3ee", "cream": "#efe6d2", "grey": "#a9acb0", "dark_grey": "#55585d", "black": "#26272b",
    "steel": "#c3c9ce", "dark_steel": "#858c93", "oak": "#c8a06a", "walnut": "#7d5535", "pine": "#e0c391",
    "terracotta": "#c66b45", "red": "#c8373a", "orange": "#e58a2e", "yellow": "#eec643", "green": "#5a9f57",
    "dark_green": "#35674b", "teal": "#3f9299", "blue": "#3d72b4", "light_blue": "#a9d1e6", "navy": "#2b3f66",
    "violet": "#7d5ba6", "pink": "#e79ab0", "raspberry": "#b3214f", "brown": "#6b4226", "chocolate": "#5a3422",
    "vanilla": "#f6e7b4", "granite": "#6d7076", "sand": "#d9c7a3", "sage": "#b4c3a6", "water": "#5aa7dc",
    "glow": "#ff4a1c", "lamp": "#fff1a8", "screen": "#7fc4ff", "glass": "#cfe6ee",
}  # fmt: skip
SUBSTANCES = {
    "water": "water", "milk": "white", "coffee": "chocolate", "coffee_powder": "brown", "sugar": "white",
    "ramen": "yellow", "cooked_ramen": "vanilla", "vanilla_ice_cream": "vanilla", "chocolate_ice_cream": "brown",
    "raspberry_syrup": "raspberry", "chocolate_syrup": "chocolate", "raw_egg": "orange", "boiled_egg": "cream",
    "chips": "yellow", "popped_corn": "cream", "corn_kernels": "orange", "peanuts": "sand", "candy": "pink",
    "soda": "chocolate", "beer": "orange", "juice": "orange",
}  # fmt: skip

_OFF_WHITE, _GREY, _DARK = (0.93, 0.92, 0.89, 1.0), (0.45, 0.46, 0.48, 1.0), (0.22, 0.22, 0.24, 1.0)
_DARK_LINKS = ("finger", "wheel", "laser", "stereo")
_GREY_LINKS = ("head", "elbow", "forearm_roll", "wrist", "caster", "shoulder_lift", "upper_arm_roll")


def robot_colour(link: str) -> tuple[float, float, float, float]:
    """Return the colour of a link of the PR2, whose model has signal colours."""
    dark = any(word in link for word in _DARK_LINKS)
    grey = any(word in link for word in _GREY_LINKS)
    return _DARK if dark else _GREY if grey else _OFF_WHITE


def rgba(colour: str) -> tuple[float, float, float, float]:
    """Return a colour of the palette or ``#rrggbb`` as red, green, blue, alpha between 0 and 1.

    Raises:
        KeyError: There is no colour of this name.
    """
    digits = colour if colour.startswith("#") else PALETTE[colour]
    red, green, blue = (int(digits[place : place + 2], 16) / 255 for place in (1, 3, 5))
    return (red, green, blue, 1.0)


def mixed(substances: Sequence[str]) -> tuple[float, float, float, float]:
    """Return the mean colour of substances; unknown ones get a colour from their letters."""
    names = sorted(PALETTE)
    colours = [
        rgba(SUBSTANCES[s] if s in SUBSTANCES else names[zlib.crc32(s.encode()) % len(names)]) for s in substances
    ]
    red, green, blue = (sum(colour[channel] for colour in colours) / len(colours) for channel in range(3))
    return (red, green, blue, 1.0)
