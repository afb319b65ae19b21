"""Rooms of VEIL-500 as scenes: what is built is what the sane rules start from, and what differs is told."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tmd.datasets.veil500 import VeilData
from tmd.datasets.veil500.environment import VeilEnvironment
from tmd.datasets.veil500.scene import VeilScene, read_room, scene_of
from tmd.diagnostics import DataError

KITCHEN = Path("Environments/kitchen/kitchen2.xml")
LIVING_ROOM = Path("Environments/livingRoom/livingRoom1.xml")


@pytest.fixture
def kitchen(small_directory: Path) -> VeilScene:
    return scene_of(read_room(small_directory / KITCHEN))


def test_what_there_is_and_where(kitchen: VeilScene) -> None:
    objects = kitchen.environment.objects
    assert (objects["mug_1"].class_name, objects["mug_1"].at) == ("mug", "on counter_1")
    assert objects["boiledegg_1"].at == "in fridge"
    assert objects["counter_1"].at is None
    assert "stoveknob_1" not in objects
    assert kitchen.environment.called["stoveknob_1"] == "stove_knob_1"
    assert kitchen.environment.called["microwavedoor"] == "microwave_door"
    assert kitchen.environment.called["sinkknob"] == "sink_knob"
    assert objects["mug_1"].states == {"contains": ["water", "coffee"]}


def test_what_differs_is_told(kitchen: VeilScene) -> None:
    assert kitchen.remarks == (
        "fridgeleftdoor: it is not a part of its own here, but stands for fridge",
        "icecreamscoop: it is not a part of its own here, but stands for spoon_1",
        "robinia_7: nobody said what such a thing looks like, so it is a plain counter",
    )


def test_a_thing_of_unknown_kind_is_a_box_and_one_without_a_place_lies_on_the_floor(small_directory: Path) -> None:
    (small_directory / "Objects.xml").write_text(
        (small_directory / "Objects.xml")
        .read_text()
        .replace("<name>Book</name>", "<name>Book</name><name>Gadget</name>")
    )
    path = small_directory / LIVING_ROOM
    path.write_text(path.read_text().replace("book_1", "gadget_1"))
    veil = scene_of(read_room(path))
    assert "gadget_1: nobody said what such a thing looks like, so it is a plain box" in veil.remarks
    assert "gadget_1: nothing is told of where it stands, so it is on the floor" in veil.remarks
    built(veil)


def test_states_are_seen(small_directory: Path) -> None:
    path = small_directory / KITCHEN
    on = "<state><statename>{}</statename><statevalue>True</statevalue></state></object>"
    text = path.read_text()
    for name, state in (("Stove", "StoveFire2"), ("Microwave", "DoorIsOpen"), ("SinkKnob", "TapIsOn")):
        begin = text.index(f"<name>{name}</name>")
        end = text.index("</object>", begin)
        text = text[:end] + on.format(state) + text[end + len("</object>") :]
    path.write_text(text)
    objects = scene_of(read_room(path)).environment.objects
    assert objects["stove"].parts == {"fire_2": {"active": True}, "knob_2": {"set_to": "on"}}
    assert objects["microwave"].parts == {"door": {"opened": True}}
    assert objects["sink"].parts == {"tap": {"active": True}, "knob": {"set_to": "high"}}


@pytest.mark.parametrize(
    "name", ["kitchen/kitchen.xml", "kitchen/other1.xml", "attic/attic1.xml", "kitchen/kitchen7.xml"]
)
def test_what_is_no_room(small_directory: Path, name: str) -> None:
    path = small_directory / "Environments" / name
    path.parent.mkdir(exist_ok=True)
    if not name.endswith("kitchen7.xml"):
        path.write_text("<environment/>")
    with pytest.raises(DataError, match=path.name):
        read_room(path)


def test_a_room_without_its_classes(small_directory: Path) -> None:
    (small_directory / "Objects.xml").unlink()
    with pytest.raises(DataError, match=r"Objects\.xml"):
        read_room(small_directory / KITCHEN)


def built(veil: VeilScene) -> None:
    """Build it, and compare with what the sane rules start from."""
    pytest.importorskip("pybullet", reason="needs the extra robot")
    from tmd.robot.scene.scene import Scene
    from tmd.robot.sim.simulator import Simulator

    at = {atom.args[0]: atom.args[1:] for atom in veil.problem.init if atom.predicate == "at"}
    with Simulator() as sim:
        scene = Scene(sim, veil.environment, veil.folder)
        assert {o.name for o in veil.problem.objects} <= set(scene.names())
        for item in scene.items():
            assert scene.supported(item) == at.get(item, ("floor", "on")), item
        for name in scene.names():
            scene.place(name)
        for said, meant in veil.environment.called.items():
            # a part of its own, or the whole that it stands for
            assert scene.owner(*scene.place(said)) == (meant if meant in veil.environment.objects else said)


@pytest.mark.parametrize("path", [KITCHEN, LIVING_ROOM], ids=["kitchen", "living room"])
def test_a_scene_is_what_the_rules_start_from(small_directory: Path, path: Path) -> None:
    built(scene_of(read_room(small_directory / path)))


def test_every_room_of_the_release_has_a_scene(released: VeilData) -> None:
    rooms = sorted(released.environments)
    assert len(rooms) == 16
    for key in rooms:
        room: VeilEnvironment = released.environments[key]
        built(scene_of(room))


def test_the_robot_finds_its_place_in_rooms_of_the_release(released: VeilData) -> None:
    """It stands free in the middle, can go before all furniture, and reaches most of what stands on a counter."""
    pytest.importorskip("pybullet", reason="needs the extra robot")
    from tmd.robot.scene.scene import Scene
    from tmd.robot.sim.simulator import Simulator
    from tmd.robot.skills.reachability_report import stance, survey
    from tmd.robot.skills.robot_context import make_cell

    for name in ("kitchen/kitchen3.xml", "livingRoom/livingRoom3.xml"):
        veil = scene_of(read_room(Path(os.environ["VEIL500_DIR"]) / "Environments" / name))
        with Simulator() as sim:
            cell = make_cell(sim, Scene(sim, veil.environment, veil.folder), seed=0, kinematic=True)
            assert cell.robot.collides() == []
            entries = survey(cell)
            assert all(stance(cell, entry.name) for entry in entries if not entry.item)
            items = [entry.name for entry in entries if entry.item and entry.place and entry.place[1] == "on"][:6]
            assert sum(stance(cell, item) is not None for item in items) >= 4, items
