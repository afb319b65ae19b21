"""Joint paths: sampled within speed limits, followed by motors under physics, or kinematically by setting joints."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from tmd.robot.parameters import MOTOR
from tmd.robot.pr2.kinematics import Array
from tmd.robot.sim.simulator import STEPS_PER_SECOND, Simulator


def timed(path: Array, speeds: Sequence[float], rate: int, window: int) -> Array:
    """Return positions for every step, (m, k), along ``path`` (n, k), n ≥ 2, whose first row is where the joints are.

    Each piece is passed at the speed (per second) of the joint that needs longest; the result is smoothed by a moving
    average over ``window`` steps, so it starts and ends at rest, and corners are rounded. A row that is given twice is
    a corner where the joints come to rest, so it is not rounded. ``rate`` is the number of steps a second.
    """
    steps = np.max(np.abs(np.diff(path, axis=0)) / np.asarray(speeds), axis=1) * rate
    steps[steps == 0.0] = window
    at = np.concatenate([[0.0], np.cumsum(steps)])
    times = np.arange(1, int(np.ceil(at[-1])) + 1)
    track = np.stack([np.interp(times, at, column) for column in path.T], axis=1)
    padded = np.vstack([np.repeat(path[:1], window, axis=0), track, np.repeat(path[-1:], window, axis=0)])
    sums = np.cumsum(np.vstack([np.zeros((1, path.shape[1])), padded]), axis=0)
    smooth: Array = (sums[window:] - sums[:-window]) / window
    smooth[-1] = path[-1]
    return smooth[1:]


def dense(path: Array, strides: Sequence[float]) -> Array:
    """Insert rows so that no joint moves by more than its stride from row to row; (m, k)."""
    pieces = [path[:1]]
    for start, end in pairwise(path):
        count = max(1, int(np.ceil(np.max(np.abs(end - start) / np.asarray(strides)) - 1e-9)))
        pieces.append(start + (end - start) * np.linspace(0, 1, count + 1)[1:, None])
    return np.vstack(pieces)


def unwound(path: Array, endless: Sequence[int]) -> Array:
    """Return the path with the endless joints turned the short way at every row."""
    result = path.copy()
    result[:, list(endless)] = np.unwrap(result[:, list(endless)], axis=0)
    return result


@dataclass(frozen=True, slots=True)
class JointGroup:
    """Some joints of a body, given by their numbers.

    Attributes:
        speeds: Greatest speeds, m/s or rad/s.
        forces: Greatest motor forces, N or N·m.
        strides: Greatest motions between two kinematic ticks.
        tolerance: Maximum distance of each from its goal for a motion to have succeeded.
        window: Steps to reach full speed.
    """

    joints: tuple[int, ...]
    speeds: tuple[float, ...]
    forces: tuple[float, ...]
    strides: tuple[float, ...]
    tolerance: float
    window: int = 48


def exact(path: Array, group: JointGroup, free: Callable[[Array], bool]) -> Array:
    """Return the path with a rest at each corner, if the corners that physics rounds are not free."""
    track = timed(path, group.speeds, STEPS_PER_SECOND, group.window)[:: MOTOR.check_every]
    if len(path) == 2 or free(track):
        return path
    return np.repeat(path, [1, *[2] * (len(path) - 2), 1], axis=0)


def hold(sim: Simulator, body: int, group: JointGroup, positions: Sequence[float]) -> None:
    """Let the motors keep the joints at ``positions``."""
    zeros = [0.0] * len(group.joints)
    sim.drive_joints(body, group.joints, list(positions), zeros, group.forces, MOTOR.gain)


def run(sim: Simulator, body: int, group: JointGroup, path: Array) -> bool:
    """Move along ``path`` under physics; return whether all joints are within the group's tolerance of the last row.

    The budget is twice the planned time and one second. A motion that no longer gets nearer for half a second, after
    its planned time, ends before that. The motors then hold the joints at their goals or, after a failure, where
    they are once they have yielded to what is in the way for a quarter of a second.
    """
    track = timed(path, group.speeds, STEPS_PER_SECOND, group.window)
    speeds = np.diff(np.vstack([path[:1], track]), axis=0) * STEPS_PER_SECOND
    for position, speed in zip(track.tolist(), speeds.tolist(), strict=True):
        sim.drive_joints(body, group.joints, position, speed, group.forces, MOTOR.gain)
        sim.step()
    goal = track[-1]
    hold(sim, body, group, goal.tolist())
    best, since = np.inf, 0
    for _ in range(len(track) + STEPS_PER_SECOND):
        positions, velocities = sim.joint_states(body, group.joints)
        away = float(np.max(np.abs(np.array(positions) - goal)))
        if away <= group.tolerance and np.max(np.abs(velocities)) <= 10 * group.tolerance:
            return True
        best, since = (away, 0) if away < best - 1e-4 else (best, since + 1)
        if since > MOTOR.stalled_after:
            break
        sim.step()
    positions, _ = sim.joint_states(body, group.joints)
    if np.max(np.abs(np.array(positions) - goal)) <= group.tolerance:
        return True
    _yield(sim, body, group)
    return False


def _yield(sim: Simulator, body: int, group: JointGroup) -> None:
    """Let what is in the way push back for a moment, then stay there: no motor pushes on after a failure."""
    weak = replace(group, forces=tuple(MOTOR.yielding_share * force for force in group.forces))
    for _ in range(STEPS_PER_SECOND // 4):
        hold(sim, body, weak, sim.joint_states(body, group.joints)[0])
        sim.step()
    hold(sim, body, group, sim.joint_states(body, group.joints)[0])


def jump(sim: Simulator, body: int, group: JointGroup, path: Array, carry: Callable[[], None]) -> None:
    """Set the joints along ``path``, one tick a row; ``carry`` moves along what is held."""
    for row in dense(path, group.strides)[1:].tolist():
        sim.set_joints(body, group.joints, row)
        carry()
        sim.tick()
    hold(sim, body, group, path[-1].tolist())
