from __future__ import annotations

from pathlib import Path

import pytest

from tmd.datasets.veil500 import VeilData, VeilEnvironment, compile_environment, load
from tmd.datasets.veil500.environment import class_of, is_true, read_classes
from tmd.datasets.veil500.relations import VeilRelation, initial_relations, unsupported
from tmd.diagnostics import TmdError
from tmd.pddl.model import GroundAtom


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("Mug_1", "Mug"),
        ("Counter1_1", "Counter"),
        ("Tv_1", "Tv"),
        ("Tv_1Remote_1", "Tv_1Remote"),
        ("Sink", "Sink"),
    ],
)
def test_class_of(name: str, kind: str) -> None:
    assert class_of(name) == kind


@pytest.mark.parametrize(("value", "truth"), [("True", True), ("2", True), ("0", False), ("Low", False), ("", False)])
def test_is_true(value: str, truth: bool) -> None:
    assert is_true(value) is truth


def test_classes_add_up(small_directory: Path) -> None:
    classes = read_classes(small_directory / "Objects.xml")
    kettle = classes["Kettle"]
    assert list(kettle.states) == ["Water", "Coffee", "IceCream", "Chocolate", "Vanilla", "Salt", "Ramen"]
    assert not kettle.states["Water"]  # the first default counts
    assert kettle.affordances == {"IsGraspable", "IsPourable"}
    assert classes["BagOfChips"].states == {"HasChips": True, "IsOpen": False}
    assert classes["Fork"].affordances == {"IsGraspable"}


def test_states_rule(small: VeilData) -> None:
    kitchen = small.environments["kitchen", 2]
    mug = kitchen.by_name["Mug_1"]
    assert mug.states["Water"]  # from the file
    assert mug.states["Coffee"]  # always
    assert "Filled" not in mug.states  # not declared
    assert kitchen.dropped == (("Mug_1", "Filled"),)
    assert kitchen.by_name["Syrup_2"].states == {"Vanilla": False, "Chocolate": True}


def test_parts(small: VeilData) -> None:
    kitchen, room = small.environments["kitchen", 2], small.environments["living_room", 1]
    knob = kitchen.by_name["SinkKnob"]
    assert (knob.parent, knob.placeholder, knob.position) == ("Sink", True, kitchen.by_name["Sink"].position)
    assert kitchen.by_name["StoveFire_1"].parent == "Stove"
    assert not kitchen.by_name["StoveFire_1"].placeholder
    assert kitchen.by_name["Fridge"].parent is None
    assert room.by_name["Tv_1PowerButton"].parent == "Tv_1"
    assert room.by_name["Tv_1Remote_1MuteButton"].parent == "Tv_1Remote_1"


def test_relations(small: VeilData) -> None:
    kitchen, room = small.environments["kitchen", 2], small.environments["living_room", 1]
    literal, honest = initial_relations(kitchen, "literal"), initial_relations(kitchen, "honest")
    assert VeilRelation("GarbageBag_1", "in", "GarbageBag_1") in literal
    assert VeilRelation("Mug_1", "on", "Counter_1") in literal
    assert VeilRelation("IceCream_1", "on", "Counter_1") in literal  # the depth is not looked at
    assert VeilRelation("IceCream_1", "in", "Fridge") in honest
    assert VeilRelation("Plate_1", "in", "Microwave") in honest
    assert VeilRelation("Kettle", "on", "StoveFire_1") in honest
    assert VeilRelation("Cd_1", "on", "CoffeeTable_1") in initial_relations(room, "honest")
    assert unsupported(room) == (("Book_1", "Xbox_1", "GarbageBag_1"), ())
    with pytest.raises(TmdError, match="no rule"):
        initial_relations(room, "wishful")  # type: ignore[arg-type]


def _atom(text: str) -> GroundAtom:
    predicate, *args = text.split()
    return GroundAtom(predicate, tuple(args))


@pytest.mark.parametrize("semantics", ["literal", "sane"])
def test_compile(small: VeilData, semantics: str) -> None:
    problem = compile_environment(small.environments["kitchen", 2], semantics)  # type: ignore[arg-type]
    for text in ("is mug_1 coffee", "declares sinkknob tapison", "works stoveknob_2 stove stovefire2"):
        assert _atom(text) in problem.init
    assert _atom("works stoveknob_3 stove stovefire3") not in problem.init
    assert (_atom("shut_away icecream_1") in problem.init) == (semantics == "sane")
    assert (_atom("at icecream_1 fridge in") in problem.init) == (semantics == "sane")
    assert (_atom("at icecream_1 counter_1 on") in problem.init) == (semantics == "literal")


def test_relation_rule_is_free(small: VeilData) -> None:
    problem = compile_environment(small.environments["kitchen", 2], "literal", relations="honest")
    assert _atom("at icecream_1 fridge in") in problem.init
    with pytest.raises(TmdError, match="no semantics"):
        compile_environment(small.environments["kitchen", 2], "dreamt")  # type: ignore[arg-type]


def test_names_that_clash_with_constants(small_directory: Path) -> None:
    path = small_directory / "Environments/kitchen/kitchen2.xml"
    path.write_text(path.read_text().replace("Robinia_7", "Salt"))
    environment = load(small_directory).environments["kitchen", 2]
    assert environment.names["salt_thing"] == "Salt"
    problem = compile_environment(environment)
    assert _atom("declares mug_1 salt") in problem.init
    assert "salt_thing" in {o.name for o in problem.objects}


def test_states_that_the_domain_does_not_know(small_directory: Path) -> None:
    path = small_directory / "Objects.xml"
    path.write_text(path.read_text().replace("<stateName>IsOpen<", "<stateName>IsStale<"))
    problem = compile_environment(load(small_directory).environments["living_room", 1])
    assert "isstale" in {c.name for c in problem.domain.constants}
    assert _atom("declares bagofchips_1 isstale") in problem.init


def _kitchens_and_rooms(data: VeilData) -> list[VeilEnvironment]:
    return list(data.environments.values())


def test_environments_of_the_release(released: VeilData) -> None:
    environments = _kitchens_and_rooms(released)
    assert len(environments) == 16
    kitchens = [set(e.by_name) for e in environments if e.world == "kitchen"]
    rooms = [set(e.by_name) for e in environments if e.world == "living_room"]
    assert (len(set.intersection(*kitchens)), len(set.intersection(*rooms))) == (39, 36)
    placeholders = [o for e in environments for o in e.objects if o.placeholder]
    assert len(placeholders) == 8 * 8 + 8 * 11
    assert all(o.parent and o.position.x != -200 for o in placeholders)
    small = [
        o
        for e in environments
        if e.world == "living_room"
        for o in e.objects
        if "IsGraspable" in o.affordances and not o.kind.startswith("Garbage")
    ]
    rooms_only = [e for e in environments if e.world == "living_room"]
    placed = sum(len(initial_relations(e, "honest")) for e in rooms_only)
    floor = [n for e in rooms_only for n in unsupported(e)[0] if not n.startswith("Garbage")]
    unknown = [n for e in rooms_only for n in unsupported(e)[1]]
    assert (len(small), placed, len(floor), len(unknown)) == (116, 98, 15, 3)
    microwaved = {
        (e.number, r.thing)
        for e in environments
        if e.world == "kitchen"
        for r in initial_relations(e, "honest")
        if r.place == "Microwave"
    }
    assert microwaved == {(2, "Mug_1"), (3, "Plate_1"), (7, "Plate_1"), (4, "Kettle")}
