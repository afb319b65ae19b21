"""The shape of a thing for the robot's scene, as in ``objects.yaml``; PDDL does not use it.

A shape is a *kind* that the scene knows how to build, or a file: a *mesh* of a thing in one piece, or a *urdf* with
links and joints. What a file does not say (what can be put where, how the thing is taken, which joint is the door)
stands beside it in YAML. ``docs/scenes.md`` explains every key; ``tmd/robot/assets/model_files.py`` reads the files.
"""

from __future__ import annotations

from typing import Annotated, Literal, Self, TypeAlias

from pydantic import BaseModel, ConfigDict, Field, model_validator
from pydantic_core import PydanticCustomError

NAME = r"^[a-z][a-z0-9_]*$"
COLOUR = r"^([a-z][a-z_]*|#[0-9a-f]{6})$"
# Metres.
Length: TypeAlias = Annotated[float, Field(gt=0.0, le=10.0)]
Number: TypeAlias = Annotated[float, Field(ge=-1000.0, le=1000.0)]
# Metres, or a direction of any length.
Point: TypeAlias = tuple[Number, Number, Number]
HandleKind: TypeAlias = Literal["door", "flap", "drawer", "lid", "slide", "knob", "button"]
# The keys that each of the three takes; what stands in none is for all of them, or for both files.
_KEYS = {
    "kind": {"kind", "size", "settings", "accent"},
    "mesh": {"mesh", "scale", "turn", "holds", "solid"},
    "urdf": {"urdf", "size", "origin", "parts", "handles", "lamps", "contents"},
}
_FILES = {"regions", "grasps"}


class _Part(BaseModel):
    model_config = ConfigDict(defer_build=True, extra="forbid", frozen=True)


class GraspEntry(_Part):
    """A grasp of the thing: at a point, along ``approach``, with the fingers along ``across``.

    ``width`` is that of what is between the fingers.
    """

    at: Point
    approach: Point
    across: Point
    width: Length


class RegionEntry(_Part):
    """A space in, on or next to the thing, or a part of it, where items may be.

    Attributes:
        relation: ``on``, ``in`` or ``next_to``.
        part: Whose region it is; the whole's by default.
        link: Of a URDF: in whose frame it is given, and with which it moves.
        low: Lower corner of the space; items stand on its z.
        high: Upper corner.
        entry: The direction in which a hand comes in; from above by default.
        spots: Where items may stand: (x, y, yaw in degrees); in rows from the front by default.
        heap: Things may lie on one another there.
    """

    relation: Literal["on", "in", "next_to"]
    part: str | None = None
    link: str | None = None
    low: Point
    high: Point
    entry: Point = (0.0, 0.0, -1.0)
    spots: tuple[Point, ...] = ()
    heap: bool = False


class HandleEntry(_Part):
    """The place where the robot works a joint.

    Attributes:
        part: The part that it opens, turns or presses; the whole by default.
        kind: How it is worked.
        joint: The URDF's joint.
        at: Where the fingers meet it, in the frame of the link that the joint moves.
        approach: The direction in which the hand comes.
        across: The direction in which the fingers open.
        width: Of what is between the fingers; not of what is pushed.
        closed: The joint's position when shut, off or not pressed.
        open: When open or pressed.
        settings: Of a knob: its settings with their positions.
        friction: What holds the joint where it is left, N or N·m; of a button: what brings it back.
    """

    part: str | None = None
    kind: HandleKind
    joint: str
    at: Point
    approach: Point = (-1.0, 0.0, 0.0)
    across: Point = (0.0, 1.0, 0.0)
    width: Length = 0.02
    closed: Number = 0.0
    open: Number | None = None
    settings: dict[str, Number] = {}
    friction: float | None = Field(default=None, gt=0.0, le=1000.0)


class LampEntry(_Part):
    """A link whose colour shows whether a predicate holds of a part (of the whole by default)."""

    part: str | None = None
    predicate: str = Field(pattern=NAME)
    link: str
    on: str = Field(default="glow", pattern=COLOUR)
    off: str | None = Field(default=None, pattern=COLOUR)


class Placement(_Part):
    """The origin of a file in the frame of the thing: metres, and roll, pitch, yaw in degrees."""

    xyz: Point = (0.0, 0.0, 0.0)
    rpy: Point = (0.0, 0.0, 0.0)


class Shape(_Part):
    """The shape of a thing.

    Attributes:
        kind: Which of the kinds of :mod:`tmd.robot.assets.shapes` builds it.
        mesh: The file of a mesh, beside ``objects.yaml``.
        urdf: The file of a URDF, beside ``objects.yaml``.
        size: Depth (to the front), width and height in metres; where it is not said, that of the kind or the URDF.
        colour: A colour's name or ``#rrggbb``; also the second colour, ``accent``.
        mass: Of an item, in kilograms.
        settings: Of a knob: the names of its settings, in the order of its angle.
        scale: Of a mesh: metres for each of its units.
        turn: Of a mesh: roll, pitch, yaw in degrees that bring its up to z and its front to x.
        holds: Of a mesh: it is a vessel.
        solid: Of a mesh: whether its convex hull is what touches, or the convex pieces that it is divided into.
        origin: Of a URDF: where its root is in the thing's frame.
        parts: Of a URDF: the link of each part that is a link of its own.
        regions: Where items may be.
        handles: Where its joints are worked.
        grasps: How it is taken.
        lamps: What shows states.
        contents: Of a URDF: the links that are seen when it contains something, the filling first.
    """

    kind: str | None = Field(default=None, pattern=NAME)
    mesh: str | None = None
    urdf: str | None = None
    size: tuple[Length, Length, Length] | None = None
    colour: str | None = Field(default=None, pattern=COLOUR)
    accent: str | None = Field(default=None, pattern=COLOUR)
    mass: float | None = Field(default=None, gt=0.0, le=100.0)
    settings: tuple[str, ...] = ()
    scale: float = Field(default=1.0, gt=0.0, le=1000.0)
    turn: Point = (0.0, 0.0, 0.0)
    holds: bool = False
    solid: bool | None = None
    origin: Placement = Placement()
    parts: dict[str, str] = {}
    regions: tuple[RegionEntry, ...] = ()
    handles: tuple[HandleEntry, ...] = ()
    grasps: tuple[GraspEntry, ...] = ()
    lamps: tuple[LampEntry, ...] = ()
    contents: tuple[str, ...] = ()

    @model_validator(mode="after")
    def _one_of_three(self) -> Self:
        given = [name for name in _KEYS if getattr(self, name) is not None]
        if len(given) != 1:
            raise PydanticCustomError("shape", "a shape says one of kind, mesh and urdf")
        (source,) = given
        known = set().union(*_KEYS.values()) | _FILES
        taken = _KEYS[source] | (_FILES if source != "kind" else set())
        for name in sorted((self.model_fields_set & known) - taken):
            others = " or ".join(
                other for other, keys in _KEYS.items() if name in keys or (name in _FILES and other != "kind")
            )
            raise PydanticCustomError("shape", f"'{name}' is for a shape that is a {others}, not for a {source}")
        return self

    @property
    def file(self) -> str | None:
        """The file that it comes from."""
        return self.mesh or self.urdf

    def over(self, inherited: Shape | None) -> Shape:
        """Return this shape, completed from ``inherited`` if that is of the same kind or file."""
        if inherited is None or (inherited.kind, inherited.file) != (self.kind, self.file):
            return self
        return inherited.model_copy(update={name: getattr(self, name) for name in self.model_fields_set})
