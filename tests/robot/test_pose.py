"""Frames: composition, inverse and matrices agree."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tmd.robot.sim.pose import Pose

numbers = st.floats(-2, 2)


@st.composite
def poses(draw: st.DrawFn) -> Pose:
    q = np.array([draw(st.floats(-1, 1)) for _ in range(4)])
    if np.linalg.norm(q) < 1e-3:
        q = np.array([0.0, 0.0, 0.0, 1.0])
    x, y, z, w = (float(v) for v in q / np.linalg.norm(q))
    return Pose((draw(numbers), draw(numbers), draw(numbers)), (x, y, z, w))


@given(poses(), poses())
def test_composition_is_that_of_matrices(a: Pose, b: Pose) -> None:
    np.testing.assert_allclose((a * b).homogeneous(), a.homogeneous() @ b.homogeneous(), atol=1e-9)


@given(poses())
def test_an_inverse_undoes(a: Pose) -> None:
    np.testing.assert_allclose((a * a.inverse()).homogeneous(), np.eye(4), atol=1e-9)


@given(poses())
def test_a_matrix_gives_the_pose_back(a: Pose) -> None:
    again = Pose.from_matrix(a.homogeneous())
    np.testing.assert_allclose(again.homogeneous(), a.homogeneous(), atol=1e-9)
    assert a.angle(again) < 1e-6


def test_angles_and_distances() -> None:
    a, b = Pose.flat(0, 0, 0, 0.2), Pose.flat(3, 4, 0, -0.5)
    assert abs(a.angle(b) - 0.7) < 1e-12
    assert a.distance(b) == 5
    assert abs(b.yaw() + 0.5) < 1e-12
