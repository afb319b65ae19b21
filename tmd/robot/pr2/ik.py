"""Inverse kinematics of one arm: joint positions that bring the tool to a pose.

Seven joints for six degrees of freedom: a pose that can be reached has a family of solutions. For an arm built as the
PR2's is, with a wrist whose axes meet in one point, the family is indexed by the shoulder's pan, and the other six
joints follow in closed form, many pans at once. Damped least squares (Nakamura and Hanafusa 1986; Wampler 1986) from a
fixed set of starting points does the same for other arms, slower and with fewer solutions. Both keep the joint limits.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from math import pi, tau

import numpy as np

from tmd.robot.parameters import IK
from tmd.robot.pr2.kinematics import Array, Tree, motion
from tmd.robot.pr2.urdf import ARM, TOOL
from tmd.robot.sim.pose import Pose

_PAN = 0
_DETOURS = np.array([0.0, *(sign * far for far in (0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2) for sign in (1, -1))])
# Metres and radians: a descent from all of whose starts the pose is reached so well has ended.
_EXACT = 1e-7


class ArmKinematics:
    """One arm, from ``base_link`` to the tool frame; ``side`` is ``right`` or ``left``.

    Attributes:
        joints: The names of the seven joints.
        lower: (7,), −inf for endless joints.
        upper: (7,).
        endless: The numbers of the joints that turn without end.
        points: (8, 3), the joints and the tool in ``base_link`` with all joints at 0.
        lengths: (4,), from pan to lift, from there to the elbow, to the wrist, and to the tool.
        closed_form: Whether the closed form is that of this arm.
    """

    def __init__(self, tree: Tree, side: str) -> None:
        self.side = side
        self.joints = tuple(f"{side[0]}_{joint}" for joint in ARM)
        self._chain = tree.chain("base_link", f"{side[0]}_{TOOL}")
        arm = {link.joint: link for link in self._chain if link.joint in self.joints}
        self.lower = np.array([arm[joint].lower for joint in self.joints])
        self.upper = np.array([arm[joint].upper for joint in self.joints])
        self.endless = tuple(int(joint) for joint in np.flatnonzero(np.isinf(self.lower)))
        self._middle = (np.maximum(self.lower, -9.0) + np.minimum(self.upper, 9.0)) / 2  # 0 for endless joints
        self.points, self.closed_form = self._built_as_the_pr2()
        self.lengths = np.linalg.norm(np.diff(self.points[[0, 1, 3, 5, 7]], axis=0), axis=1)

    def _built_as_the_pr2(self) -> tuple[Array, bool]:
        """Return the points of the arm, and whether it is built as the PR2's.

        The axes are then z, y, x, y, x, y, x, all on a line along x, and elbow and wrist bend one way only.
        """
        frame, points, axes = np.eye(4), [], []
        for link in self._chain:
            frame = frame @ link.origin
            if link.joint in self.joints:
                axes.append(frame[:3, :3] @ link.axis)
                points.append(frame[:3, 3])
        points.append(frame[:3, 3])
        line = np.array(points) - points[0]
        fits = np.allclose(axes, np.eye(3)[[2, 1, 0, 1, 0, 1, 0]]) and np.allclose(frame[:3, :3], np.eye(3))
        fits = fits and np.allclose(line[:, 1:], 0.0) and bool(np.all(self.upper[[3, 5]] <= 0.0))
        return np.array(points), fits

    def tool(self, torso: float, arms: Array) -> Array:
        """Return the tool frame in ``base_link``: (n, 4, 4) for arms (n, 7)."""
        return self._tool_and_jacobian(torso, arms)[0]

    def _tool_and_jacobian(self, torso: float, arms: Array) -> tuple[Array, Array]:
        """Return the tool frame (n, 4, 4) and its geometric Jacobian (n, 6, 7), both in ``base_link``."""
        frame = np.broadcast_to(np.eye(4), (len(arms), 4, 4))
        axes, points = [], []
        for link in self._chain:
            frame = frame @ link.origin
            if link.joint in self.joints:
                axes.append(frame[:, :3, :3] @ link.axis)
                points.append(frame[:, :3, 3])
                frame = frame @ motion(link, arms[:, self.joints.index(link.joint)])
            elif link.kind == "prismatic":
                frame = frame @ motion(link, torso)
        axis, point = np.stack(axes, axis=2), np.stack(points, axis=2)
        lever = frame[:, :3, 3, None] - point
        return frame, np.concatenate([np.cross(axis, lever, axis=1), axis], axis=1)

    def near(self, arms: Array, seed: Sequence[float]) -> Array:
        """Return the same configurations with the endless joints turned to within half a turn of ``seed``."""
        result = arms.copy()
        for joint in self.endless:
            result[:, joint] -= tau * np.round((result[:, joint] - seed[joint]) / tau)
        return result

    def inside(self, arms: Array, margin: float = IK.margin) -> Array:
        """Return for each of (n, 7) whether it keeps the limits."""
        kept: Array = np.all((arms >= self.lower + margin) & (arms <= self.upper - margin), axis=1)
        return kept

    def solve(self, tool: Pose, torso: float, seed: Sequence[float]) -> list[tuple[float, ...]]:
        """Return configurations that bring the tool frame to a pose in ``base_link``, within the limits.

        ``torso`` is the height of the torso joint. Results near ``seed``, seven positions, come first (largest joint
        motion counts).
        """
        if self.closed_form:
            pans = np.linspace(self.lower[_PAN] + IK.margin, self.upper[_PAN] - IK.margin, IK.pans)
            arms = self._closed(tool, torso, pans, seed)
        else:
            arms = self._kept(self._numeric(tool, torso, seed), tool, torso, seed)
        far = np.abs(arms - np.asarray(seed, dtype=float))
        order = np.lexsort((far.sum(axis=1), np.round(far.max(axis=1), 6)))
        return [tuple(float(value) for value in arm) for arm in arms[order]]

    def track(self, tool: Pose, torso: float, seed: Sequence[float]) -> tuple[float, ...] | None:
        """Return the solution next to ``seed``, for a tool that moves in small steps; None if there is none nearby.

        The arguments are those of :meth:`solve`.
        """
        # the same pan as before first: mostly it will do
        for pans, most in ((_DETOURS[:1], IK.smooth), (_DETOURS, IK.leap))[not self.closed_form :]:
            found = _next_to(seed, self._beside(tool, torso, seed, seed[_PAN] + pans), most)
            if found is not None:
                return found
        return None

    def with_pan(self, tool: Pose, torso: float, seed: Sequence[float]) -> tuple[float, ...] | None:
        """Return a solution with the shoulder panned as in ``seed``, wherever the other joints are, or None."""
        return _next_to(seed, self._beside(tool, torso, seed, np.array(seed[:1])), np.inf)

    def _beside(self, tool: Pose, torso: float, seed: Sequence[float], pans: Array) -> Array:
        """Return solutions (n, 7) with some pans, or the one that a descent from ``seed`` leads to."""
        if self.closed_form:
            return self._closed(tool, torso, pans, seed)
        return self._kept(self._descend(np.array([seed]), tool, torso), tool, torso, seed)

    def _kept(self, arms: Array, tool: Pose, torso: float, seed: Sequence[float]) -> Array:
        """Return the rows within the limits that reach the pose."""
        arms = self.near(arms, seed)
        arms = arms[self.inside(arms)]
        away = np.abs(_error(tool.homogeneous(), self.tool(torso, arms)))
        result: Array = arms[(away[:, :3].max(axis=1) < IK.accuracy[0]) & (away[:, 3:].max(axis=1) < IK.accuracy[1])]
        return result

    def _closed(self, tool: Pose, torso: float, pans: Array, seed: Sequence[float]) -> Array:
        """Return the solutions (n, 7) within the limits for some pans (k,) of the shoulder; at most two for each.

        The length of the line from shoulder to wrist gives the elbow, its direction lift and roll of the upper arm, and
        what is then left of the orientation the three joints of the wrist, as Euler angles x, y, x.
        """
        turn, (offset, upper, fore, hand) = tool.matrix(), self.lengths
        wrist = np.array(tool.position) - hand * turn[:, 0] - self.points[0] - (0.0, 0.0, torso)
        x, y = _spun(pans, wrist[0], wrist[1])
        x, z = x - offset, wrist[2]
        bend = (x * x + y * y + z * z - upper**2 - fore**2) / (2 * upper * fore)
        elbow = -np.arccos(np.clip(bend, -1.0, 1.0))
        ahead, aside = upper + fore * np.cos(elbow), -fore * np.sin(elbow)
        sine = -y / np.maximum(aside, 1e-9)
        reached = (np.abs(bend) <= 1.0) & (np.abs(sine) <= 1.0)
        roll = np.arcsin(sine[reached])
        roll = np.concatenate([roll, pi - roll])
        pans, x, elbow, ahead, aside = (np.tile(v[reached], 2) for v in (pans, x, elbow, ahead, aside))
        lift = np.arctan2(aside * np.cos(roll), ahead) - np.arctan2(z, x)
        # the rows of the orientation as the forearm sees it
        row_x, row_y = _spun(pans[:, None], turn[0], turn[1])
        row_z, row_x = _spun(lift[:, None], turn[2], row_x)
        row_y, row_z = _spun(roll[:, None], row_y, row_z)
        row_z, row_x = _spun(elbow[:, None], row_z, row_x)
        flex = -np.arccos(np.clip(row_x[:, 0], -1.0, 1.0))
        forearm = np.arctan2(-row_y[:, 0], row_z[:, 0])
        arms = np.stack([pans, lift, roll, elbow, forearm, flex, np.arctan2(-row_x[:, 1], -row_x[:, 2])], axis=1)
        # a full turn more or less brings some joints back between their limits
        arms = self.near(arms - tau * np.round((arms - self._middle) / tau), seed)
        kept: Array = arms[self.inside(arms)]
        return kept

    def _numeric(self, tool: Pose, torso: float, seed: Sequence[float]) -> Array:
        lower = np.where(np.isinf(self.lower), -pi, self.lower + IK.margin)
        upper = np.where(np.isinf(self.upper), pi, self.upper - IK.margin)
        starts = lower + (upper - lower) * _halton(IK.starts - 1)
        return self._descend(np.vstack([np.asarray(seed, dtype=float), starts]), tool, torso)

    def _descend(self, arms: Array, tool: Pose, torso: float) -> Array:
        """Run damped least squares from every row at once, always within the limits."""
        target = tool.homogeneous()
        for _ in range(IK.rounds):
            frame, jacobian = self._tool_and_jacobian(torso, arms)
            error = _error(target, frame)
            if np.abs(error).max(initial=0.0) < _EXACT:
                break
            turned = np.swapaxes(jacobian, 1, 2)
            weight = IK.damping**2 * np.minimum(1.0, np.linalg.norm(error, axis=1) * 10)
            damped = jacobian @ turned + weight[:, None, None] * np.eye(6)
            damped += 1e-10 * np.eye(6)
            step = (turned @ np.linalg.solve(damped, error[:, :, None]))[:, :, 0]
            step *= np.minimum(1.0, IK.stride / np.maximum(np.abs(step).max(axis=1, keepdims=True), 1e-12))
            arms = np.clip(arms + step, self.lower + IK.margin + 1e-9, self.upper - IK.margin - 1e-9)
        return arms


def _spun(angle: Array, x: Array | float, y: Array | float) -> tuple[Array, Array]:
    """Return coordinates in a frame that is turned by ``angle`` from the axis of ``x`` to that of ``y``."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return cosine * x + sine * y, cosine * y - sine * x


def _next_to(start: Sequence[float], arms: Array, most: float) -> tuple[float, ...] | None:
    """Return the row of ``arms`` (n, 7) that is nearest to ``start``, if no joint is farther away than ``most``."""
    if not len(arms):
        return None
    far = np.abs(arms - start).max(axis=1)
    best = int(np.argmin(far))
    return tuple(float(value) for value in arms[best]) if far[best] <= most else None


def _error(target: Array, frames: Array) -> Array:
    """Return metres and a rotation vector from ``frames`` (n, 4, 4) to ``target``: (n, 6)."""
    rotation = target[:3, :3] @ np.swapaxes(frames[:, :3, :3], 1, 2)
    vector = np.stack([rotation[:, j, i] - rotation[:, i, j] for i, j in ((1, 2), (2, 0), (0, 1))], axis=1)
    sine = np.linalg.norm(vector, axis=1) / 2
    cosine = (np.trace(rotation, axis1=1, axis2=2) - 1) / 2
    angle = np.arctan2(sine, cosine)
    # near half a turn the direction is lost; a fixed one leads away from there
    scale = np.where(sine > 1e-9, angle / np.maximum(2 * sine, 1e-12), 0.5)
    vector = np.where(((sine < 1e-6) & (cosine < 0))[:, None], np.array([2.0, 0.0, 0.0]), vector * scale[:, None])
    return np.concatenate([target[:3, 3] - frames[:, :3, 3], vector], axis=1)


@cache
def _halton(count: int) -> Array:
    """Return (count, 7) points that cover the unit cube evenly, always the same (Halton 1960)."""
    from scipy.stats import qmc  # type: ignore[import-untyped]  # slow to import, and the PR2 needs none

    points: Array = qmc.Halton(len(ARM), scramble=False).random(count + 1)[1:]
    return points
