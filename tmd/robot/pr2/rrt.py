"""RRT-connect (Kuffner and LaValle 2000): a collision-free path through a space of joint positions, then shortcuts.

Every call has its generator and a number of samples: OMPL's planners share one seed in a process and stop by the clock.
On equal queries both solve the same ones at the same cost.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from tmd.robot.parameters import ARM_MOTION
from tmd.robot.pr2.kinematics import Array
from tmd.robot.pr2.trajectory_following import dense

# Returns whether all of (n, k) configurations are free.
Free = Callable[[Array], bool]
# A configuration (k,) nearby that keeps a constraint; None if there is none.
Project = Callable[[Array], Array | None]


@dataclass
class _Tree:
    nodes: list[Array]
    parents: list[int] = field(default_factory=lambda: [-1])

    def nearest(self, point: Array, strides: Array) -> int:
        away = (np.array(self.nodes) - point) / strides
        return int(np.argmin(np.einsum("ij,ij->i", away, away)))

    def path(self, node: int) -> list[Array]:
        result = []
        while node >= 0:
            result.append(self.nodes[node])
            node = self.parents[node]
        return result[::-1]

    def add(self, point: Array, parent: int) -> int:
        self.nodes.append(point)
        self.parents.append(parent)
        return len(self.nodes) - 1


def plan(
    start: Array,
    goal: Array,
    free: Free,
    sample: Callable[[], Array | None],
    strides: Array,
    *,
    budget: int,
    project: Project | None = None,
) -> Array | None:
    """Return a path (n, k), corners only, from ``start`` to ``goal``, or None: a straight line, else by RRT-connect.

    Args:
        start: (k,), taken to be free.
        goal: (k,), taken to be free.
        free: The collision check.
        sample: Draws (k,) from the space.
        strides: (k,): motions that a check may jump over.
        budget: Maximum number of samples.
        project: Brings new nodes to where a constraint holds (CBiRRT, Berenson et al. 2009); ``free`` checks it too.
    """
    if clear(start, goal, free, strides):
        return np.array([start, goal])
    trees = [_Tree([start]), _Tree([goal])]
    for _ in range(budget):
        here, there = trees
        drawn = sample()
        new = None if drawn is None else _extend(here, drawn, free, strides, project)
        if new is not None:
            met = _connect(there, here.nodes[new], free, strides, project)
            if met is not None:
                path = here.path(new) + there.path(met)[::-1][1:]
                return np.array(path if here.nodes[0] is start else path[::-1])
        trees.reverse()
    return None


def shorten(
    path: Array, free: Free, strides: Array, rng: np.random.Generator, tries: int = ARM_MOTION.rrt_shortcuts
) -> Array:
    """Replace random pieces of the path by straight lines if these are free; it never gets longer."""
    failed = 0
    for _ in range(tries):
        if len(path) < 3 or failed == ARM_MOTION.rrt_in_vain:
            break
        lengths = np.linalg.norm(np.diff(path, axis=0) / strides, axis=1)
        at = np.concatenate([[0.0], np.cumsum(lengths)])
        low, high = sorted(float(value) for value in rng.uniform(0, at[-1], 2))
        first, last = int(np.searchsorted(at, low, "right")) - 1, int(np.searchsorted(at, high, "right")) - 1
        if last >= len(path) - 1 or first == last:
            continue
        failed += 1
        start, end = (
            path[piece] + (path[piece + 1] - path[piece]) * (where - at[piece]) / max(lengths[piece], 1e-12)
            for piece, where in ((first, low), (last, high))
        )
        if clear(start, end, free, strides):
            path, failed = np.vstack([path[: first + 1], start, end, path[last + 1 :]]), 0
    return path


def clear(start: Array, end: Array, free: Free, strides: Array) -> bool:
    """Return whether the line is free; ``start`` is not checked."""
    return free(dense(np.array([start, end]), strides.tolist())[1:])


def _extend(tree: _Tree, target: Array, free: Free, strides: Array, project: Project | None) -> int | None:
    near = tree.nearest(target, strides)
    step = (target - tree.nodes[near]) / strides
    length = float(np.linalg.norm(step))
    edge = ARM_MOTION.rrt_edge if project is None else ARM_MOTION.level_edge
    point: Array | None = target
    if length > edge:
        point = tree.nodes[near] + step * strides * edge / length
        point = project(point) if project is not None else point
        if point is None or float(np.linalg.norm((target - point) / strides)) > length - edge / 10:
            return None  # the constraint leads away from there
    assert point is not None
    return tree.add(point, near) if clear(tree.nodes[near], point, free, strides) else None


def _connect(tree: _Tree, target: Array, free: Free, strides: Array, project: Project | None) -> int | None:
    """Extend towards ``target`` until it is reached or something is in the way."""
    while True:
        new = _extend(tree, target, free, strides, project)
        if new is None:
            return None
        if tree.nodes[new] is target:
            return new
