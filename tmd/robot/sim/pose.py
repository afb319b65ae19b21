"""Poses: a position and an orientation, and their composition."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, cos, hypot, sin, sqrt
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Vector: TypeAlias = tuple[float, float, float]
Quaternion: TypeAlias = tuple[float, float, float, float]
_UNITS: tuple[Vector, Vector, Vector] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@dataclass(frozen=True, slots=True)
class Pose:
    """A frame in another frame.

    Attributes:
        position: Metres.
        orientation: A unit quaternion (x, y, z, w).
    """

    position: Vector
    orientation: Quaternion = (0.0, 0.0, 0.0, 1.0)

    @classmethod
    def flat(cls, x: float, y: float, z: float = 0.0, yaw: float = 0.0) -> Pose:
        """Return a pose that is upright and turned by ``yaw`` radians about z."""
        return cls((x, y, z), (0.0, 0.0, sin(yaw / 2), cos(yaw / 2)))

    @classmethod
    def about(cls, axis: Vector, angle: float) -> Pose:
        """Return a turn by ``angle`` radians about a unit vector through the origin."""
        s = sin(angle / 2)
        return cls((0.0, 0.0, 0.0), (axis[0] * s, axis[1] * s, axis[2] * s, cos(angle / 2)))

    @classmethod
    def turned(cls, roll: float, pitch: float, yaw: float) -> Pose:
        """Return a turn by roll, pitch and yaw in radians, as in URDF: about x, then y, then z of the outer frame."""
        origin: Vector = (0.0, 0.0, 0.0)
        x, y, z = (cls.about(axis, angle) for axis, angle in zip(_UNITS, (roll, pitch, yaw), strict=True))
        return cls(origin, (z * y * x).orientation)

    @classmethod
    def from_matrix(cls, matrix: NDArray[np.float64]) -> Pose:
        """Return the pose of a 4×4 homogeneous matrix."""
        x, y, z = (float(value) for value in matrix[:3, 3])
        return cls((x, y, z), quaternion_of(matrix[:3, :3]))

    def matrix(self) -> NDArray[np.float64]:
        """Return the rotation, 3×3."""
        x, y, z, w = self.orientation
        return np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
        )

    def homogeneous(self) -> NDArray[np.float64]:
        """Return the 4×4 matrix."""
        result = np.eye(4)
        result[:3, :3] = self.matrix()
        result[:3, 3] = self.position
        return result

    def __mul__(self, other: Pose) -> Pose:
        """Return ``other``, given in this frame, in the frame that this pose is given in."""
        return Pose(self.apply(other.position), _product(self.orientation, other.orientation))

    def inverse(self) -> Pose:
        """Return the outer frame, given in this one."""
        x, y, z, w = self.orientation
        back: Quaternion = (-x, -y, -z, w)
        px, py, pz = _rotate(back, self.position)
        return Pose((-px, -py, -pz), back)

    def apply(self, point: Sequence[float]) -> Vector:
        """Transform a point of this frame into the outer frame."""
        x, y, z = _rotate(self.orientation, point)
        px, py, pz = self.position
        return (x + px, y + py, z + pz)

    def rotate(self, direction: Sequence[float]) -> Vector:
        """Transform a direction of this frame into the outer frame."""
        return _rotate(self.orientation, direction)

    def moved(self, by: Sequence[float]) -> Pose:
        """Return the pose shifted by metres in the outer frame."""
        x, y, z = (a + b for a, b in zip(self.position, by, strict=True))
        return Pose((x, y, z), self.orientation)

    def spun(self, turn: Pose) -> Pose:
        """Return the pose turned on the spot by the orientation of ``turn``, which is given in the outer frame."""
        return Pose(self.position, _product(turn.orientation, self.orientation))

    def yaw(self) -> float:
        """Return the heading of the x axis about z, in (−π, π]."""
        x, y, _ = self.rotate((1.0, 0.0, 0.0))
        return atan2(y, x)

    def distance(self, other: Pose) -> float:
        """Return the distance between the two origins in metres."""
        return sqrt(sum((a - b) ** 2 for a, b in zip(self.position, other.position, strict=True)))

    def angle(self, other: Pose) -> float:
        """Return the angle between the two orientations in radians, in [0, π]."""
        x, y, z, w = _product(self.inverse().orientation, other.orientation)
        return 2 * atan2(hypot(x, y, z), abs(w))


def quaternion_of(rotation: NDArray[np.float64]) -> Quaternion:
    """Return the unit quaternion (x, y, z, w), w ≥ 0, of a 3×3 rotation."""
    trace = float(np.trace(rotation))
    squares = np.array([*(2 * np.diag(rotation) - trace + 1), trace + 1])
    largest = int(np.argmax(squares))
    r = rotation
    rows = (
        (squares[0], r[0, 1] + r[1, 0], r[0, 2] + r[2, 0], r[2, 1] - r[1, 2]),
        (r[0, 1] + r[1, 0], squares[1], r[1, 2] + r[2, 1], r[0, 2] - r[2, 0]),
        (r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], squares[2], r[1, 0] - r[0, 1]),
        (r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], squares[3]),
    )
    row = np.array(rows[largest])
    row /= np.linalg.norm(row) * (1 if row[3] >= 0 else -1)
    x, y, z, w = (float(value) for value in row)
    return (x, y, z, w)


def _product(a: Quaternion, b: Quaternion) -> Quaternion:
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    x = aw * bx + ax * bw + ay * bz - az * by
    y = aw * by - ax * bz + ay * bw + az * bx
    z = aw * bz + ax * by - ay * bx + az * bw
    w = aw * bw - ax * bx - ay * by - az * bz
    norm = sqrt(x * x + y * y + z * z + w * w)
    return (x / norm, y / norm, z / norm, w / norm)


def _rotate(q: Quaternion, point: Sequence[float]) -> Vector:
    """Return ``q`` p ``q``⁻¹ without building the matrix."""
    x, y, z, w = q
    px, py, pz = point
    px, py, pz = float(px), float(py), float(pz)
    tx, ty, tz = 2 * (y * pz - z * py), 2 * (z * px - x * pz), 2 * (x * py - y * px)
    return (px + w * tx + y * tz - z * ty, py + w * ty + z * tx - x * tz, pz + w * tz + x * ty - y * tx)
