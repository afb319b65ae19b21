"""Inverse kinematics of one arm of the PR2: joint positions that bring the tool to a pose.

Seven joints for six degrees of freedom: a pose that can be reached has a family of solutions, here indexed by the
upper arm's roll. ``pr2-ikfast`` solves the other six in closed form, on a grid of 48 rolls. Without it, damped least
squares (Nakamura and Hanafusa 1986; Wampler 1986) from a fixed set of starting points does the same, slower and with
fewer solutions. Both keep the joint limits.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Sequence
from functools import cache
from math import pi, tau
from typing import Any

import numpy as np

from tmd.robot.parameters import IK
from tmd.robot.pr2.kinematics import Array, Tree, motion
from tmd.robot.pr2.urdf import ARM, TOOL
from tmd.robot.sim.pose import Pose

_ROLL = 2
_DETOURS = np.array([0.0, 0.02, -0.02, 0.05, -0.05, 0.1, -0.1, 0.2, -0.2])
# Metres and radians: a descent from all of whose starts the pose is reached so well has ended.
_EXACT = 1e-7
_PRIMES = (2, 3, 5, 7, 11, 13, 17)


class ArmKinematics:
    """One arm, from ``base_link`` to the tool frame; ``side`` is ``right`` or ``left``.

    Attributes:
        joints: The names of the seven joints.
        lower: (7,), −inf for endless joints.
        upper: (7,).
        endless: The numbers of the joints that turn without end.
    """

    def __init__(self, tree: Tree, side: str) -> None:
        self.side = side
        self.joints = tuple(f"{side[0]}_{joint}" for joint in ARM)
        self._chain = tree.chain("base_link", f"{side[0]}_{TOOL}")
        arm = {link.joint: link for link in self._chain if link.joint in self.joints}
        self.lower = np.array([arm[joint].lower for joint in self.joints])
        self.upper = np.array([arm[joint].upper for joint in self.joints])
        self.endless = tuple(int(joint) for joint in np.flatnonzero(np.isinf(self.lower)))
        # the closed form is that of the PR2, whose forearm and wrist roll without end
        self._closed_form = _closed_form(side) if self.endless == (4, 6) else None
        self._fits: bool | None = None
        self._pitch = float(self.upper[_ROLL] - self.lower[_ROLL] - 2 * IK.margin) / (IK.rolls - 1)

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

    def solve(
        self, tool: Pose, torso: float, seed: Sequence[float], *, numeric: bool | None = None
    ) -> list[tuple[float, ...]]:
        """Return configurations that bring the tool frame to a pose in ``base_link``, within the limits.

        ``torso`` is the height of the torso joint. Results near ``seed``, seven positions, come first (largest joint
        motion counts). ``numeric`` selects damped least squares; None: only without ``pr2-ikfast``.
        """
        closed = None if numeric else self._closed_form
        if numeric is False and closed is None:
            raise ValueError("pr2-ikfast is not installed")
        if closed is None:
            arms = self._kept(self._numeric(tool, torso, seed), tool, torso, seed)
        else:
            arms = self._kept(self._grid(closed, tool, torso, 0.0), tool, torso, seed)
            if not len(arms):  # a narrow family can lie between two points of the grid
                arms = self._kept(self._grid(closed, tool, torso, 0.5), tool, torso, seed)
        far = np.abs(arms - np.asarray(seed, dtype=float))
        order = np.lexsort((far.sum(axis=1), np.round(far.max(axis=1), 6)))
        return [tuple(float(value) for value in arm) for arm in arms[order]]

    def track(
        self, tool: Pose, torso: float, seed: Sequence[float], *, numeric: bool | None = None
    ) -> tuple[float, ...] | None:
        """Return the solution next to ``seed``, for a tool that moves in small steps; None if there is none nearby.

        The arguments are those of :meth:`solve`.
        """
        closed = None if numeric else self._closed_form
        start = np.asarray(seed, dtype=float)
        if closed is None:
            return _next_to(start, self._kept(self._descend(start[None], tool, torso), tool, torso, seed), IK.leap)
        # the same roll as before first: mostly it will do
        for rolls, most in ((_DETOURS[:1], IK.smooth), (_DETOURS, IK.leap)):
            arms = self.near(self._closed(closed, tool, torso, seed[_ROLL] + rolls), seed)
            found = _next_to(start, arms[self.inside(arms)], most)
            if found is not None and self._reaches(found, tool, torso):
                return found
        return None

    def with_roll(self, tool: Pose, torso: float, seed: Sequence[float]) -> tuple[float, ...] | None:
        """Return a solution with the upper arm rolled as in ``seed``, wherever the other joints are, or None."""
        closed, start = self._closed_form, np.asarray(seed, dtype=float)
        if closed is None:
            arms = self._descend(start[None], tool, torso)
        else:
            arms = self._closed(closed, tool, torso, start[_ROLL : _ROLL + 1])
        return _next_to(start, self._kept(arms, tool, torso, seed), np.inf)

    def _reaches(self, arm: Sequence[float], tool: Pose, torso: float) -> bool:
        """Return whether the closed form is right: always for the PR2 it was made for, perhaps not for another one."""
        if self._fits is None:
            self._fits = len(self._kept(np.array([arm]), tool, torso, arm)) == 1
        return self._fits

    def _kept(self, arms: Array, tool: Pose, torso: float, seed: Sequence[float]) -> Array:
        """Return the rows within the limits that reach the pose: another PR2 than the solver was made for may not."""
        arms = self.near(arms, seed)
        arms = arms[self.inside(arms)]
        away = np.abs(_error(tool.homogeneous(), self.tool(torso, arms)))
        result: Array = arms[(away[:, :3].max(axis=1) < IK.accuracy[0]) & (away[:, 3:].max(axis=1) < IK.accuracy[1])]
        return result

    def _grid(self, closed: Callable[..., Any], tool: Pose, torso: float, shift: float) -> Array:
        rolls = np.linspace(self.lower[_ROLL] + IK.margin, self.upper[_ROLL] - IK.margin, IK.rolls)
        return self._closed(closed, tool, torso, rolls + shift * self._pitch)

    def _closed(self, closed: Callable[..., Any], tool: Pose, torso: float, rolls: Array) -> Array:
        position, rotation = list(tool.position), tool.matrix().tolist()
        found: list[Sequence[float]] = []
        for roll in rolls:
            found += [row[1:] for row in closed(position, rotation, [torso, float(roll)]) or ()]
        arms = np.array(found, dtype=float).reshape(-1, len(ARM))
        # a full turn more or less brings some joints back between their limits
        bounded = np.isfinite(self.lower)
        middle = np.where(bounded, np.where(bounded, self.lower, 0.0) + np.where(bounded, self.upper, 0.0), 0.0) / 2
        return arms - tau * np.round((arms - middle) / tau)

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


def _next_to(start: Array, arms: Array, most: float) -> tuple[float, ...] | None:
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
    result = np.zeros((count, len(_PRIMES)))
    for column, prime in enumerate(_PRIMES):
        for row in range(count):
            index, fraction = row + 1, 1.0
            while index:
                fraction /= prime
                index, digit = divmod(index, prime)
                result[row, column] += fraction * digit
    result.flags.writeable = False
    return result


@cache
def _closed_form(side: str) -> Callable[..., Any] | None:
    """Return the compiled solver of one arm, or None without the package."""
    try:
        module = importlib.import_module("pr2_ikfast")
    except ImportError:
        return None
    solver: Callable[..., Any] = module.solve_right_ik if side == "right" else module.solve_left_ik
    return solver
