"""Ways that skills offer: none of them goes through what it is about."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise, product
from math import cos, pi, sin
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pybullet", reason="needs the extra robot")

from tests.bundled import corpus
from tmd.robot.monitor.observation import REACH
from tmd.robot.pr2.quick_checks import HandChecker
from tmd.robot.session import SimulationSession
from tmd.robot.sim.pose import Pose
from tmd.robot.skills.articulated import swing_options
from tmd.robot.skills.navigate_and_look import drive
from tmd.robot.skills.pour_and_dip import _held_at, dip_options, mouths
from tmd.robot.skills.robot_context import Cell
from tmd.robot.skills.stance_search import with_room
from tmd.world.environment import load_environment
from tmd.world.roots import Roots


@pytest.fixture(scope="module")
def cell() -> Iterator[Cell]:
    kitchen = corpus("kitchen")
    environment = load_environment(kitchen.file("kitchen3"))
    problem = kitchen.world("kitchen3").task.problem
    with SimulationSession(environment, kitchen.folder, problem, kinematic=True) as stage:
        yield stage.cell


@contextmanager
def held(cell: Cell, side: str, item: str, grasp: int = 0) -> Iterator[None]:
    """As if a hand had taken an item, by one of its grasps."""
    motion = cell.sim.motion(cell.scene.bodies[item])
    grip = cell.scene.grasps(item)[grasp].tool.pose().inverse()
    cell.sim.set_pose(cell.scene.bodies[item], cell.robot.tool(side) * grip)
    cell.robot.hold(side, cell.scene.bodies[item])
    cell.in_hand[side] = item
    yield
    cell.robot.let_go(side)
    del cell.in_hand[side]
    cell.sim.set_motion(cell.scene.bodies[item], motion)


@contextmanager
def without_lid(cell: Cell, target: str) -> Iterator[None]:
    """As if it were open."""
    handle = cell.scene.handle(target)
    if handle is not None:
        cell.sim.set_joint(handle.body, handle.index, handle.open)
    yield
    if handle is not None:
        cell.sim.set_joint(handle.body, handle.index, handle.closed)


@pytest.mark.parametrize("item", ["spoon1", "ice_cream_scoop1"])
@pytest.mark.parametrize("target", ["vanilla_tub1", "sugar_bowl1"])
def test_a_spoon_is_dipped_below_the_rim_and_not_through_it(cell: Cell, item: str, target: str) -> None:
    body, jar = cell.scene.bodies[item], cell.scene.bodies[target]
    with held(cell, "left", item), without_lid(cell, target):
        grip = cell.in_tool("left", item)
        options = dip_options(cell, item, target)
        assert with_room(cell, options)
        for option in options:
            for tool in option.poses[-2:]:
                cell.sim.set_pose(body, tool * grip)
                assert all(contact.distance > -0.004 for contact in cell.sim.closest(body, jar, 0.0))
            assert cell.sim.extents(body)[0][2] < cell.top(target)
            cell.sim.set_pose(body, cell.robot.tool("left") * grip)


@pytest.mark.parametrize("item", ["vanilla_tub1", "milk1"])
@pytest.mark.parametrize("opened", [True, False])
def test_a_lid_does_not_swing_into_the_hand_that_moves_it(cell: Cell, item: str, opened: bool) -> None:
    handle = cell.scene.handle(item)
    assert handle is not None
    start, end = (handle.closed, handle.open) if opened else (handle.open, handle.closed)
    cell.sim.set_joint(handle.body, handle.index, start)
    options = swing_options(cell, item, (1.0 if opened else 0.0,))
    assert {option.side for option in options} == {"left", "right"}
    lid = handle.body, handle.index
    for option in options:
        steps = len(option.poses) - 2
        for number, tool in enumerate(option.poses[1:]):
            cell.sim.set_joint(*lid, start + number / steps * (end - start))
            assert HandChecker(cell.robot, option.side, only=lid).depth([tool])[0] < 0.005
        assert all(one.distance(other) < 0.06 for one, other in pairwise(option.poses[1:]))
        cell.sim.set_joint(*lid, start)
    cell.sim.set_joint(*lid, handle.closed)


def test_a_hand_can_be_asked_about_one_thing_only(cell: Cell) -> None:
    body = cell.scene.bodies["vanilla_tub1"]
    inside = Pose(cell.centre("vanilla_tub1"))
    everything = HandChecker(cell.robot, "right")
    only = HandChecker(cell.robot, "right", only=(cell.scene.bodies["milk1"], -1))
    assert everything.depth([inside])[0] > 0.0
    assert only.depth([inside])[0] == 0.0
    assert HandChecker(cell.robot, "right", only=(body, -1)).depth([inside])[0] > 0.0


def test_a_door_is_seen_to_hit_what_the_other_hand_holds(cell: Cell) -> None:
    """Even a spoon, wherever the robot stands: as if the door were looked at in 120 places of its way."""
    handle, tucked = cell.scene.handle("fridge1_door"), cell.robot.arm("left")
    assert handle is not None
    body, struck = cell.scene.bodies["spoon1"], []
    cell.robot.move_arm("left", [(1.08, -0.1, 1.4, -2.29, -3.46, -0.44, -7.71)])
    places = [(x, y, turn) for x in np.arange(-0.3, 0.11, 0.05) for y in (-0.8, -0.9, -1.0) for turn in (-0.87, -1.2)]
    with held(cell, "left", "spoon1", grasp=5):
        for place in places:
            cell.robot.drive([place])
            for share in np.linspace(0.0, 1.0, 120):
                cell.sim.set_joint(handle.body, handle.index, handle.closed + share * (handle.open - handle.closed))
                if cell.sim.closest(body, handle.body, 0.0, other_link=handle.index):
                    struck.append(place)
                    break
            cell.sim.set_joint(handle.body, handle.index, handle.closed)
        cell.robot.drive([(0.0, 0.0, 0.0)])
        before = cell.sim.pose(body)
        assert all(cell.sweeps("fridge1_door", place, side="right") for place in struck)
        assert not all(cell.sweeps("fridge1_door", place, side="right") for place in places)
        assert cell.sim.pose(body) == before
    cell.robot.move_arm("left", [tucked])
    assert 0 < len(struck) < len(places)


def test_what_was_just_dipped_is_kept_level_before_anything_is_seen_on_it(cell: Cell) -> None:
    with held(cell, "right", "spoon1"):
        motion = cell.sim.motion(cell.scene.bodies["spoon1"])
        x, y, z = cell.sim.pose(cell.scene.bodies["spoon1"]).position
        cell.sim.set_pose(cell.scene.bodies["spoon1"], Pose((x, y, z)))
        assert cell.robot.keeps_level("right") is None, "an empty spoon may lie in the hand as it likes"
        cell.load("spoon1")
        assert cell.robot.keeps_level("right") is True
        cell.reset_leant()
        cell.sim.set_motion(cell.scene.bodies["spoon1"], motion)


def test_contents_leave_a_vessel_at_its_mouth_whatever_its_handle(cell: Cell) -> None:
    """However it is held, and from the angle of spilling on, the lowest point of the rim is where the mouth is."""
    vessels = [item for item in cell.scene.items() if cell.scene.opening(item) and cell.scene.grasps(item)]
    low, high = cell.scene.size("bowl1")
    assert high[0] - low[0] > 2.5 * high[2], "with its ear it is long and flat"
    for item, grasp in product(vessels, (0, -1)):
        opening = cell.scene.opening(item)
        assert opening is not None
        with held(cell, "right", item, grasp):
            for how in mouths(cell, item, "right"):
                for angle in np.linspace(opening.spills_from, 1.8, 5):
                    pose = _held_at(Pose((0.0, 0.0, 0.0)), how, (0.0, 0.0, 1.0), float(angle))
                    x, y, z = opening.centre
                    out = opening.radius + 0.005
                    rim = [pose.apply((x + out * cos(a), y + out * sin(a), z)) for a in np.linspace(0.0, 2 * pi, 72)]
                    assert min(rim, key=lambda point: point[2]) == pytest.approx((0.0, 0.0, 1.0), abs=4e-3), item


def test_a_door_that_stands_open_can_be_approached(tmp_path: Path) -> None:
    """From places before its cupboard: round the door itself there are none that are near to it."""
    file = tmp_path / "open.yaml"
    file.write_text(
        "name: open\ndomain: living_room\nobjects:\n"
        "  cupboard1: {class: cupboard, parts: {door: {opened: true}}}\n"
        "  soda_tin1: {class: soda_tin, at: in cupboard1}\n"
    )
    environment, folder = Roots().room(str(file))
    problem = Roots().world(str(file))[1].task.problem
    with SimulationSession(environment, folder, problem, kinematic=True) as stage:
        assert "m away" in drive(stage.cell, "cupboard1_door", 0)
        assert stage.cell.reach("cupboard1") <= REACH


def test_nothing_is_dipped_through_a_lid(cell: Cell) -> None:
    with held(cell, "left", "spoon1"):
        assert dip_options(cell, "spoon1", "vanilla_tub1") == []


def test_a_drawer_with_something_in_it_can_be_shut(cell: Cell) -> None:
    """The hand at its end is where the thing stood before."""
    handle, item = cell.scene.handle("drawer1"), "mug1"
    assert handle is not None
    home = cell.sim.pose(cell.scene.bodies[item])
    cell.sim.set_joint(handle.body, handle.index, handle.open)
    front = cell.scene.handle("drawer1")
    assert front is not None
    spots = [spot.pose for spot in cell.scene.support("drawer1", "in", item)]
    cell.sim.set_pose(cell.scene.bodies[item], min(spots, key=lambda pose: pose.distance(front.grasp)))
    cell.sim.step(1)
    assert with_room(cell, swing_options(cell, "drawer1", [0.0]))
    cell.sim.set_pose(cell.scene.bodies[item], home)
    cell.sim.set_joint(handle.body, handle.index, handle.closed)
