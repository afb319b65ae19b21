"""Contents, stance and openings of things: measured in a simulation without the robot doing anything."""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, pi, radians, sin
from pathlib import Path

import pytest

pytest.importorskip("pybullet", reason="needs the extra robot")

from tests.bundled import corpus, kit
from tmd.pddl.model import Instruction
from tmd.robot.session import SimulationSession
from tmd.robot.sim.pose import Pose
from tmd.robot.skills.articulated import swing
from tmd.robot.skills.pick_and_place import pick_options, place, place_options
from tmd.robot.skills.results import SkillError
from tmd.robot.skills.robot_context import Cell
from tmd.robot.skills.stance_search import candidates, with_room
from tmd.world.environment import load_environment

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def cell() -> Iterator[Cell]:
    kitchen = corpus("kitchen")
    environment = load_environment(kitchen.file("kitchen1"))
    problem = kitchen.world("kitchen1").task.problem
    with SimulationSession(environment, kitchen.folder, problem, kinematic=True) as session:
        yield session.cell


def put(cell: Cell, item: str, pose: Pose) -> None:
    """Put an item somewhere and let it come to rest."""
    cell.sim.set_pose(cell.scene.bodies[item], pose)
    cell.sim.wake()
    cell.settle()


def test_a_vessel_goes_below_the_spout(cell: Cell) -> None:
    spots = cell.scene.support("sink1", "in", "mug1")
    assert spots[0].outlet == "sink1_tap" and not spots[-1].outlet
    assert not any(spot.outlet for spot in cell.scene.support("sink1", "in", "spoon1"))


def test_only_what_is_below_the_spout_and_upright_is_filled(cell: Cell) -> None:
    home = cell.sim.pose(cell.scene.bodies["mug1"])
    below, beside = cell.scene.support("sink1", "in", "mug1")[0], cell.scene.support("sink1", "in", "mug1")[-1]
    put(cell, "mug1", below.pose)
    runs_in, told = cell.stream("mug1") or (None, "")
    assert runs_in is True and "sink1_tap" in told
    put(cell, "mug1", beside.pose)
    assert (cell.stream("mug1") or (None,))[0] is False
    x, y, z = below.pose.position
    put(cell, "mug1", Pose((x, y, z + 0.05)) * Pose.about((1.0, 0.0, 0.0), radians(90)))
    assert (cell.stream("mug1") or (None,))[0] is False
    put(cell, "mug1", home)
    assert cell.stream("mug1") is None, "there is no spout above a counter"


def test_what_lies_has_fallen_and_can_be_taken(cell: Cell) -> None:
    home = cell.sim.pose(cell.scene.bodies["mug1"])
    assert not cell.fallen("mug1") and cell.tilt("mug1") < 0.02
    x, y, z = home.position
    put(cell, "mug1", Pose((x, y, z + 0.05)) * Pose.about((0.0, 1.0, 0.0), radians(80)))
    assert cell.fallen("mug1") and cell.tilt("mug1") > radians(30)
    assert any(option.poses[-1].rotate((1.0, 0.0, 0.0))[2] < -0.5 for option in pick_options(cell, "mug1"))
    put(cell, "mug1", home)
    assert not cell.fallen("mug1")


def test_what_is_full_is_seen_to_lean(cell: Cell) -> None:
    home = cell.sim.pose(cell.scene.bodies["cup1"])
    cell.scene.show("cup1", ("water",))
    cell.reset_leant()
    lean, limit = cell.leant("cup1") or (9.0, 0.0)
    assert lean == 0.0 and radians(40) < limit < radians(60)
    cell.sim.set_pose(cell.scene.bodies["cup1"], home * Pose.about((1.0, 0.0, 0.0), radians(70)))
    cell.sim.tick()
    assert (cell.leant("cup1") or (0.0,))[0] > radians(65)
    cell.reset_leant()
    with cell.leaning("cup1", lambda: True):
        cell.sim.tick()
    assert (cell.leant("cup1") or (1.0,))[0] == 0.0, "over a rim nothing is lost"
    put(cell, "cup1", home)
    cell.scene.show("cup1", ())


def test_what_is_closed_does_not_spill(cell: Cell) -> None:
    assert cell.leant("coffee_jar1") is None
    assert cell.leant("raspberry_bottle1") is None


def test_how_a_shut_thing_leans_does_not_count_once_it_is_open(cell: Cell) -> None:
    jar, handle = "coffee_jar1", cell.scene.handle("coffee_jar1")
    assert handle is not None
    home = cell.sim.pose(cell.scene.bodies[jar])
    cell.scene.show(jar, ("coffee_powder",))
    cell.reset_leant()
    cell.sim.set_pose(cell.scene.bodies[jar], home * Pose.about((1.0, 0.0, 0.0), radians(80)))
    cell.sim.tick()
    put(cell, jar, home)
    cell.sim.set_joint(handle.body, handle.index, handle.open)
    assert (cell.leant(jar) or (9.0,))[0] < radians(5)
    cell.sim.set_joint(handle.body, handle.index, handle.closed)
    cell.scene.show(jar, ())


def test_what_lies_is_not_opened_with_something_in_it(cell: Cell) -> None:
    home = cell.sim.pose(cell.scene.bodies["coffee_jar1"])
    x, y, z = home.position
    cell.scene.show("coffee_jar1", ("coffee_powder",))
    put(cell, "coffee_jar1", Pose((x, y, z + 0.06)) * Pose.about((1.0, 0.0, 0.0), radians(90)))
    with pytest.raises(SkillError, match=r"^precondition: coffee_jar1 leans by \d+ degrees: .* would run out$"):
        swing(cell, "coffee_jar1", 0, opened=True)
    put(cell, "coffee_jar1", home)
    cell.scene.show("coffee_jar1", ())


def test_what_lies_flat_on_the_floor_is_reached_from_any_side(cell: Cell) -> None:
    home = cell.sim.pose(cell.scene.bodies["spoon1"])
    for turn in range(4):
        x, y, theta = cell.robot.base()
        away = theta + turn * pi / 2
        put(cell, "spoon1", Pose.flat(x + 0.9 * cos(away), y + 0.9 * sin(away), 0.02, 1.0))
        assert cell.support("spoon1") == ("floor", "on") and cell.front("spoon1") is None
        options = with_room(cell, pick_options(cell, "spoon1"))
        assert next(candidates(cell, options, cell.sim.pose(cell.scene.bodies["spoon1"]), None), None) is not None
    put(cell, "spoon1", home)


def test_what_is_held_askew_is_laid_down(cell: Cell) -> None:
    """As it is held no hand fits in where it would be put down level."""
    body, side = cell.scene.bodies["spoon1"], "left"
    askew = Pose.about((0.0, 1.0, 0.0), pi) * cell.scene.grasps("spoon1")[0].tool.pose().inverse()
    cell.sim.set_pose(body, cell.robot.tool(side) * askew)
    cell.robot.hold(side, body)
    cell.in_hand[side] = "spoon1"
    below, others = place_options(cell, side, "spoon1", "counter2", "on")
    assert others and not with_room(cell, (*below, *others))
    assert place(cell, "spoon1", "counter2", "on", 0) == "spoon1 is on counter2"
    assert not cell.in_hand and cell.support("spoon1") == ("counter2", "on")


def test_what_is_dipped_comes_back_as_it_went_in() -> None:
    """Other postures for the same poses would lead to where the arm has to turn over, and the spoon would be tilted."""
    steps = [("find", "spoon1"), ("moveto", "spoon1"), ("grasp", "spoon1"), ("find", "coffee_jar1")]
    steps += [("moveto", "coffee_jar1"), ("open", "coffee_jar1"), ("scoopfrom", "spoon1", "coffee_jar1")]
    room = ROOT / "experiments" / "execution" / "environments" / "crowded_counter.yaml"
    run = kit("kitchen").run_plan([Instruction(name, tuple(args)) for name, *args in steps], room, kinematic=True)
    assert (run.execution.status, run.execution.repairs) == ("done", 0)


@pytest.mark.parametrize(("share", "is_open"), [(0.0, False), (0.04, False), (0.3, None), (0.55, None), (0.65, True)])
def test_between_open_and_shut_is_neither(cell: Cell, share: float, is_open: bool | None) -> None:
    handle = cell.scene.handle("fridge1_door")
    assert handle is not None
    cell.sim.set_joint(handle.body, handle.index, handle.closed + share * (handle.open - handle.closed))
    assert cell.is_open("fridge1_door") is is_open
    assert cell.ajar("fridge1_door") is (is_open is None)
    assert ("neither open nor shut" in cell.how_open("fridge1_door")) is (is_open is None)
    cell.sim.set_joint(handle.body, handle.index, handle.closed)
