"""Timing of joint paths: sampled at the rate of the simulation, within speed limits."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from tmd.robot.pr2.kinematics import Array


def timed(path: Array, speeds: Sequence[float], rate: int, window: int) -> Array:
    """Return positions for every step, (m, k); the last row is that of ``path``.

    Each piece is passed at the speed of the joint that needs longest; the result is smoothed by a moving average, so
    it starts and ends at rest, and corners are rounded. A row that is given twice is a corner where the joints come to
    rest, so it is not rounded.

    Args:
        path: (n, k), n ≥ 2; the first row is where the joints are.
        speeds: The greatest speed of each joint, per second.
        rate: Steps a second.
        window: Steps that are averaged: the time to reach the full speed.
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
