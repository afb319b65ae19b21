"""Where things stand, as plain geometry: free floor before every fixture, nothing twice in one place."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmd.robot.scene.furniture_layout import GAP, Footprint, apart, arrange, floor_spots, inside, room_of
from tmd.robot.sim.pose import Pose

SIZES = st.dictionaries(
    st.sampled_from([f"f{i}" for i in range(14)]),
    st.tuples(st.floats(0.2, 1.0), st.floats(0.2, 2.2)),
    max_size=12,
)
FREE = 1.6


def footprint(size: tuple[float, float]) -> Footprint:
    return (-size[0] / 2, -size[1] / 2, size[0] / 2, size[1] / 2)


@given(SIZES)
def test_fixtures_stand_apart_inside_the_room_and_have_free_floor_in_front(
    sizes: dict[str, tuple[float, float]],
) -> None:
    room = arrange(sizes)
    assert list(room.poses) == list(sizes)
    for name, pose in room.poses.items():
        depth, width = sizes[name]
        before = (depth / 2, -width / 2, depth / 2 + FREE, width / 2)
        for other, its in room.poses.items():
            if other != name:
                assert apart(pose, footprint(sizes[name]), its, footprint(sizes[other]), GAP - 1e-3), (name, other)
                assert apart(pose, before, its, footprint(sizes[other]), 0.0), (name, other)
        for x in (-depth / 2, depth / 2):
            for y in (-width / 2, width / 2):
                px, py, _ = pose.apply((x, y, 0.0))
                assert room.low[0] < px < room.high[0]
                assert room.low[1] < py < room.high[1]


@given(SIZES)
def test_the_front_looks_into_the_room(sizes: dict[str, tuple[float, float]]) -> None:
    for pose in arrange(sizes).poses.values():
        x, y, _ = pose.rotate((1.0, 0.0, 0.0))
        px, py, _ = pose.position
        assert x * px + y * py < 0


SQUARE: Footprint = (-0.1, -0.1, 0.1, 0.1)


@pytest.mark.parametrize(
    ("x", "yaw", "gap", "expected"),
    [
        (0.21, 0.0, 0.0, True),
        (0.19, 0.0, 0.0, False),
        (0.21, 0.0, 0.02, False),
        (0.21, math.pi / 4, 0.0, False),
        (0.25, math.pi / 4, 0.0, True),
    ],
)
def test_apart_knows_turned_things(x: float, yaw: float, gap: float, expected: bool) -> None:
    assert apart(Pose.flat(0.0, 0.0), SQUARE, Pose.flat(x, 0.0, 0.0, yaw), SQUARE, gap) is expected


def test_inside_allows_an_overhang_in_front_only() -> None:
    frame = Pose.flat(3.0, 1.0, 0.0, math.pi)
    low, high = (-0.5, -0.5, 0.0), (0.5, 0.5, 1.0)
    over_front, over_side = frame * Pose.flat(0.45, 0.0), frame * Pose.flat(0.0, 0.45)
    assert not inside(over_front, SQUARE, low, high, frame, 0.0)
    assert inside(over_front, SQUARE, low, high, frame, 0.06)
    assert not inside(over_side, SQUARE, low, high, frame, 0.06)
    assert inside(over_side, SQUARE, low, high, frame, math.inf)


def test_floor_spots_are_clear_of_the_robot_and_of_what_stands_there() -> None:
    room = arrange({f"f{i}": (0.6, 1.2) for i in range(8)})
    taken = [(Pose.flat(-0.8, 0.0), SQUARE)]
    spots = floor_spots(room, taken, SQUARE)
    assert len(spots) > 10
    for spot in spots:
        assert apart(spot, SQUARE, *taken[0], 0.15)
        assert apart(spot, SQUARE, Pose.flat(0.0, 0.0), (-0.4, -0.4, 0.4, 0.4), 0.1)
        assert room.low[0] < spot.position[0] < room.high[0]


L_SHAPE = [(-1.5, -2.2), (2.6, -2.2), (2.6, 1.2), (0.8, 1.2), (0.8, 3.2), (-1.5, 3.2)]


@pytest.mark.parametrize("corners", [L_SHAPE, L_SHAPE[::-1]], ids=["anticlockwise", "clockwise"])
@pytest.mark.parametrize(
    ("x", "y", "yaw", "within"),
    [
        (0.0, 0.0, 0.0, True),
        (0.0, 2.5, 1.0, True),
        (1.5, 2.0, 0.0, False),  # beyond the inner corner
        (0.72, 2.0, 0.0, False),  # in the wall
        (0.8, 1.2, math.pi / 4, False),  # the inner corner is in it
        (2.45, 0.0, 0.0, True),
        (2.45, 0.0, math.pi / 4, True),
        (2.49, 0.0, math.pi / 4, False),
    ],
)
def test_what_is_within_the_walls_of_a_room(
    corners: list[tuple[float, float]], x: float, y: float, yaw: float, within: bool
) -> None:
    room = room_of(corners)
    assert (room.low, room.high) == ((-1.5, -2.2), (2.6, 3.2))
    assert room.holds(Pose.flat(x, y, 0.0, yaw), SQUARE) is within


@pytest.mark.parametrize(
    ("corners", "told"),
    [
        ([(0.0, 0.0), (2.0, 0.0), (0.0, 2.0), (2.0, 2.0)], "cross"),
        ([(0.0, 0.0), (0.5, 0.0), (0.5, 0.5)], "square metres"),
        ([(0.0, 0.0), (3.0, 0.0), (3.0, 0.0), (0.0, 3.0)], "at one place"),
    ],
)
def test_what_is_no_room_is_refused(corners: list[tuple[float, float]], told: str) -> None:
    with pytest.raises(ValueError, match=told):
        room_of(corners)


def test_nothing_is_put_on_the_floor_outside_the_walls() -> None:
    room = room_of(L_SHAPE)
    spots = floor_spots(room, [], SQUARE)
    assert spots
    assert all(room.holds(spot, SQUARE) for spot in spots)
