"""Input of the builders of shapes: sizes, colours, and the parts of the object."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from tmd.robot.assets.urdf_builder import UrdfModel
from tmd.robot.sim.pose import Vector


@dataclass(frozen=True, slots=True)
class Appearance:
    """A completely specified shape: depth, width and height in metres, mass in kilograms, ``settings`` of a knob."""

    kind: str
    size: Vector
    colour: str
    accent: str
    mass: float
    settings: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Parts:
    """The parts of an object and how they look, in the order of its class."""

    looks: dict[str, Appearance]

    def of(self, *kinds: str) -> list[tuple[str, Appearance]]:
        """Return the parts of some kinds."""
        return [(name, look) for name, look in self.looks.items() if look.kind in kinds]


Builder = Callable[[UrdfModel, Appearance, Parts], None]


@dataclass(frozen=True, slots=True)
class ShapeKind:
    """A kind of shape.

    Attributes:
        sort: ``fixture``, ``item`` or ``part``.
        default: Used where a class leaves something open.
        build: Builds the object; a part is built by the builder of its whole.
        takes: The kinds of parts that it has a place for, and the maximum number of each.
    """

    sort: str
    default: Appearance
    build: Builder | None = None
    takes: tuple[tuple[str, int], ...] = ()


def rows(
    front: float, width: float, depths: tuple[float, ...], pitch: float = 0.08, middle: float = 0.0
) -> list[tuple[float, float, float]]:
    """Return spots (x, y, yaw 0) in rows at some depths behind a front edge, each row from its middle outwards.

    ``width`` is that from the first to the last spot of a row, ``pitch`` that between neighbours; metres.
    """
    count = int(width / pitch + 1e-6)
    steps = sorted((index - count / 2 for index in range(count + 1)), key=lambda s: (abs(s), s))
    return [(front - depth, middle + step * pitch, 0.0) for depth in depths for step in steps]
