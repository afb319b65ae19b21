"""Scenes: every environment that has shapes becomes a world that stands still, is open to the hand, and is the same
each time."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from tmd.diagnostics import TmdError
from tmd.robot.sim.pose import Pose
from tmd.robot.sim.simulator import pybullet
from tmd.world.environment import Environment, load_environment
from tmd.world.folder import DomainFolder

pytest.importorskip("pybullet", reason="needs the extra robot")

from tmd.robot.scene.scene import OVERLAP, Scene
from tmd.robot.sim.simulator import Simulator

ROOT = Path(__file__).parents[2]
ACTED_IN = sorted(path.parent.name for path in ROOT.glob("domains/*/skills.yaml"))
"""The domains that the robot acts in; others need no shapes."""
ENVIRONMENTS = [path for name in ACTED_IN for path in sorted(ROOT.glob(f"problems/{name}/environments/*.yaml"))]
LOW, HIGH = 0.65, 1.15
"""Where handles, knobs and buttons are in reach."""


def folder_of(path: Path) -> DomainFolder:
    return DomainFolder(ROOT / "domains" / path.parent.parent.name)


@pytest.fixture(scope="module", params=ENVIRONMENTS, ids=lambda p: p.stem)
def scene(request: pytest.FixtureRequest) -> Iterator[Scene]:
    with Simulator() as sim:
        yield Scene(sim, load_environment(request.param), folder_of(request.param))


@pytest.fixture
def kitchen(request: pytest.FixtureRequest) -> Iterator[Scene]:
    path = ROOT / f"problems/kitchen/environments/{request.param}.yaml"
    with Simulator() as sim:
        yield Scene(sim, load_environment(path), folder_of(path))


def test_every_item_stays_where_it_was_put(scene: Scene) -> None:
    for item in scene.items():
        now = scene.sim.pose(scene.bodies[item])
        assert now.distance(scene.placed[item]) < 0.01, item
        assert now.angle(scene.placed[item]) < 0.05, item


def test_every_item_is_where_the_environment_says(scene: Scene) -> None:
    for item in scene.items():
        relation, where = (scene.environment.objects[item].at or "on floor").split()
        assert scene.supported(item) == (where, relation), item


def test_nothing_is_in_anything_else(scene: Scene) -> None:
    bodies = sorted(scene.bodies.values())
    for index, body in enumerate(bodies):
        for other in bodies[index + 1 :]:
            deepest = min((c.distance for c in scene.sim.closest(body, other, 0.0)), default=0.0)
            assert deepest > -OVERLAP, (scene.owner(body), scene.owner(other), deepest)


def test_places_and_owners_are_inverse(scene: Scene) -> None:
    for name, entry in scene.environment.objects.items():
        assert scene.owner(*scene.place(name)) == name
        for vertex in scene.blueprints[name].model.part_links:
            if vertex:
                assert scene.owner(*scene.place(f"{name}_{vertex}")) == f"{name}_{vertex}", entry


def test_what_the_hand_works_is_in_reach(scene: Scene) -> None:
    for name in scene.names():
        handle = scene.handle(name)
        if handle is None or scene.is_item(scene.whole(name)):
            continue
        assert LOW <= handle.grasp.position[2] <= HIGH, (name, handle.grasp.position)


def test_every_item_has_a_grasp_with_room_for_the_fingers(scene: Scene, tmp_path: Path) -> None:
    token = pybullet().saveState(physicsClientId=scene.sim.client)
    open_everything(scene)
    fingers = Fingers(scene.sim, tmp_path)
    try:
        for item in scene.items():
            here = scene.sim.pose(scene.bodies[item])
            entry = scene.entry(*(scene.supported(item) or ("floor", "on")))
            found = [
                grasp
                for grasp in scene.grasps(item)
                if np.dot((here * grasp.tool.pose()).rotate((1.0, 0.0, 0.0)), entry) > 0.5
                and fingers.free(here * grasp.tool.pose(), grasp.opening, list(scene.bodies.values()))
            ]
            assert found, item
    finally:
        fingers.remove()
        pybullet().restoreState(token, physicsClientId=scene.sim.client)


def open_everything(scene: Scene) -> None:
    """Doors, and drawers with what is in them."""
    for name in scene.names():
        handle = scene.handle(name)
        if handle is None or handle.kind not in ("door", "flap", "drawer"):
            continue
        inside = [i for i in scene.items() if scene.supported(i) == (name, "in")] if handle.kind == "drawer" else []
        way = handle.open - scene.sim.joint_position(handle.body, handle.joint)
        scene.sim.set_joint(handle.body, handle.joint, handle.open)
        for item in inside:
            pose = scene.sim.pose(scene.bodies[item])
            x, y, z = (p + a * way for p, a in zip(pose.position, handle.axis, strict=True))
            scene.sim.set_pose(scene.bodies[item], Pose((x, y, z), pose.orientation))


class Fingers:
    """Two boxes of 2 x 2 x 6 cm where the fingers would be."""

    def __init__(self, sim: Simulator, directory: Path) -> None:
        self.sim = sim
        path = directory / "finger.urdf"
        path.write_text(
            '<robot name="f"><link name="f"><inertial><mass value="0.1"/><inertia ixx="1e-4" iyy="1e-4" izz="1e-4" '
            'ixy="0" ixz="0" iyz="0"/></inertial><collision><origin xyz="-0.012 0 0"/><geometry>'
            '<box size="0.06 0.02 0.02"/></geometry></collision></link></robot>'
        )
        self.bodies = [sim.load(path, Pose((0.0, 0.0, 50.0 + side)), fixed=True) for side in range(2)]

    def free(self, tool: Pose, opening: float, others: list[int]) -> bool:
        for body, side in zip(self.bodies, (-1, 1), strict=True):
            self.sim.set_pose(body, tool * Pose((0.0, side * (opening / 2 + 0.01), 0.0)))
        hits = [c for body in self.bodies for other in others for c in self.sim.closest(body, other, 0.0)]
        for body in self.bodies:
            self.sim.set_pose(body, Pose((0.0, 0.0, 50.0 + body)))
        return all(c.distance > -0.0005 for c in hits)

    def remove(self) -> None:
        for body in self.bodies:
            pybullet().removeBody(body, physicsClientId=self.sim.client)


@pytest.mark.parametrize("path", [p for p in ENVIRONMENTS if p.stem in ("kitchen2", "room3")], ids=lambda p: p.stem)
def test_a_seed_gives_the_same_scene_to_the_byte_and_another_seed_another(path: Path) -> None:
    def poses(seed: int) -> list[Pose]:
        with Simulator() as sim:
            scene = Scene(sim, load_environment(path), folder_of(path), rng=np.random.default_rng(seed), settle=20)
            return [sim.pose(body) for body in scene.bodies.values()]

    first = poses(1)
    assert first == poses(1)
    assert first != poses(2)


@pytest.mark.parametrize("kitchen", ["kitchen1"], indirect=True)
def test_a_door_stays_where_it_is_left_and_a_button_comes_back(kitchen: Scene) -> None:
    door, button = kitchen.handle("microwave1_door"), kitchen.handle("microwave1_button")
    assert door is not None
    assert button is not None
    kitchen.sim.set_joint(door.body, door.joint, 0.8)
    kitchen.sim.set_joint(button.body, button.joint, button.open)
    kitchen.sim.step(240)
    assert kitchen.sim.joint_position(door.body, door.joint) == pytest.approx(0.8, abs=0.01)
    assert kitchen.sim.joint_position(button.body, button.joint) == pytest.approx(0.0, abs=0.002)


def test_doors_and_drawers_open_towards_the_robot(scene: Scene) -> None:
    for name in scene.names():
        handle = scene.handle(name)
        if handle is None or handle.kind not in ("door", "flap", "drawer"):
            continue
        was = scene.sim.joint_position(handle.body, handle.joint)
        front = scene.sim.pose(handle.body)
        depths = []
        for position in (handle.closed, handle.open):
            scene.sim.set_joint(handle.body, handle.joint, position)
            moved = scene.handle(name)
            assert moved is not None
            depths.append(front.inverse().apply(moved.grasp.position)[0])
        assert depths[1] > depths[0] + 0.2, name
        scene.sim.set_joint(handle.body, handle.joint, was)


@pytest.mark.parametrize("kitchen", ["kitchen1"], indirect=True)
@pytest.mark.parametrize("speed", [1.0, 5.0, -5.0])
def test_a_lid_that_is_let_go_of_in_motion_does_not_throw_its_jar_about(kitchen: Scene, speed: float) -> None:
    lids = [name for name in kitchen.items() if (handle := kitchen.handle(name)) and handle.kind == "lid"]
    assert len(lids) >= 3
    for name in lids:
        handle = kitchen.handle(name)
        assert handle is not None
        before = kitchen.sim.pose(handle.body)
        kitchen.sim.set_joints(handle.body, [handle.index], [0.8], [speed])
        kitchen.sim.step(120)
        assert kitchen.sim.pose(handle.body).distance(before) < 0.005
        assert abs(kitchen.sim.joint_states(handle.body, [handle.index])[1][0]) < 0.01


@pytest.mark.parametrize("kitchen", ["kitchen3"], indirect=True)
def test_an_unlatched_door_springs_open_and_can_be_calmed(kitchen: Scene) -> None:
    kitchen.spring_open("microwave1_door")
    kitchen.sim.step(600)
    kitchen.calm("microwave1_door")
    kitchen.sim.step(60)
    handle = kitchen.handle("microwave1_door")
    assert handle is not None
    assert kitchen.sim.joint_position(handle.body, handle.joint) == pytest.approx(handle.open, abs=0.1)


@pytest.mark.parametrize("kitchen", ["kitchen2"], indirect=True)
def test_a_drawer_takes_along_what_lies_in_it_and_its_spots(kitchen: Scene) -> None:
    handle = kitchen.handle("drawer1")
    assert handle is not None
    before = kitchen.support("drawer1", "in", "sponge1")[0].pose.position
    kitchen.sim.drive_joint(handle.body, handle.joint, handle.open, 60.0, 0.4)
    kitchen.sim.step(1000)
    way = kitchen.sim.joint_position(handle.body, handle.joint)
    assert way == pytest.approx(handle.open, abs=0.01)
    assert kitchen.supported("spoon1") == ("drawer1", "in")
    moved = kitchen.support("drawer1", "in", "sponge1")[0].pose.position
    assert np.linalg.norm(np.subtract(moved, before)) == pytest.approx(way, abs=0.02)


@pytest.mark.parametrize("kitchen", ["kitchen1"], indirect=True)
def test_a_spot_is_free_and_an_item_put_there_is_supported_there(kitchen: Scene) -> None:
    for where, relation in [
        ("stove1_burner3", "on"), ("sink1", "in"), ("counter2", "on"), ("table1", "on"), ("stove1", "next_to"),
        ("microwave1", "next_to"), ("fridge1", "next_to"), ("sink1", "next_to"), ("microwave1", "in"),
        ("fridge1", "in"), ("cupboard1", "in"), ("floor", "on"),
    ]:  # fmt: skip
        for item in ("mug1", "bowl1", "pot1", "kettle1"):
            spots = kitchen.support(where, relation, item)
            assert spots, (where, relation, item)
            x, y, z = spots[0].pose.position
            home = kitchen.sim.pose(kitchen.bodies[item])
            kitchen.sim.set_pose(kitchen.bodies[item], Pose((x, y, z + 0.002), spots[0].pose.orientation))
            kitchen.sim.step(30)
            assert kitchen.supported(item) == (where, relation), item
            kitchen.sim.set_pose(kitchen.bodies[item], home)
            kitchen.sim.step(2)
            assert kitchen.supported(item) is not None


def test_things_lie_on_one_another_in_a_basket_and_in_a_bag() -> None:
    """The blanket fills the basket, so a toy lies on it; bottles go into a bag, which stands on the floor."""
    for room, where, items in (
        ("room2", "basket1", ["toy1"]),
        ("room4", "garbage_sack1", ["beer_bottle1", "soda_tin1"]),
    ):
        path = ROOT / f"problems/living_room/environments/{room}.yaml"
        with Simulator() as sim:
            scene = Scene(sim, load_environment(path), folder_of(path))
            for item in items:
                spots = scene.support(where, "in", item)
                assert spots, (where, item)
                sim.set_pose(scene.bodies[item], spots[0].pose)
                sim.step(120)
                assert scene.supported(item) == (where, "in"), item


@pytest.mark.parametrize("kitchen", ["kitchen1"], indirect=True)
def test_what_hangs_in_the_air_is_nowhere(kitchen: Scene) -> None:
    kitchen.sim.set_pose(kitchen.bodies["mug1"], Pose((0.0, 0.0, 1.5)))
    assert kitchen.supported("mug1") is None


@pytest.mark.parametrize("kitchen", ["kitchen4"], indirect=True)
def test_states_of_the_environment_are_seen(kitchen: Scene) -> None:
    door = kitchen.handle("fridge1_door")
    lid = kitchen.handle("milk1")
    assert door is not None
    assert lid is not None
    assert kitchen.sim.joint_position(door.body, door.joint) == pytest.approx(door.open, abs=0.02)
    assert kitchen.sim.joint_position(lid.body, lid.joint) == pytest.approx(lid.open, abs=0.1)
    assert kitchen.shown("pot1") == ("water",)
    assert kitchen.shown("mug1") == ()


@pytest.mark.parametrize("kitchen", ["kitchen1"], indirect=True)
def test_contents_and_signs_change_the_picture(kitchen: Scene) -> None:
    x, y, z = kitchen.sim.pose(kitchen.bodies["stove1"]).position
    eye, target = (x - 1.6, y - 1.0, z + 1.8), (x, y, z + 0.8)
    dark = kitchen.sim.picture(eye, target, 160, 120, shadow=False)
    kitchen.sign("stove1_burner1", "active", True)
    lit = kitchen.sim.picture(eye, target, 160, 120, shadow=False)
    kitchen.sign("stove1_burner1", "active", False)
    assert (dark != lit).any()
    assert (dark == kitchen.sim.picture(eye, target, 160, 120, shadow=False)).all()


def environment(tmp_path: Path, objects: str) -> Environment:
    path = tmp_path / "e.yaml"
    path.write_text(f"name: e\ndomain: kitchen\nobjects:\n{objects}")
    return load_environment(path)


ROOM_BELOW = "room: [[-1.5, -1.5], [1.5, -1.5], [1.5, 1.5], [-1.5, 1.5]]\n"


@pytest.mark.parametrize(
    ("objects", "said", "line"),
    [
        ("  t: {class: table, position: [2.0, 0.0, 0.0]}\n  u: {class: table, position: [2.1, 0.2, 0.0]}\n",
         "'t' and 'u' are in each other by", 5),
        ("  t: {class: table}\n" + "".join(f"  b{i}: {{class: bowl, at: on t}}\n" for i in range(25)),
         "finds no room on 't'", None),
        ("  t: {class: table}\n  e1: {class: egg, at: in t}\n", "nothing can be in 't'", 5),
        ("  e1: {class: egg, at: on nowhere}\n", "there is no 'nowhere'", 4),
        ("  t: {class: table, yaw: 30}\n", "'t' has a yaw and no position", 4),
        (f"  t: {{class: table}}\n{ROOM_BELOW}", "'t' is not within the walls of the room", 4),
        (f"  t: {{class: table, position: [0.9, 0, 0]}}\n  e1: {{class: egg, position: [1.49, 0, 0.74]}}\n{ROOM_BELOW}",
         "'e1' is not within the walls of the room", 5),
        ("  t: {class: table}\nroom: [[0, 0], [9, 0], [9, 9]]\n", "the robot does not fit into the room", 5),
        ("  t: {class: table}\nroom: [[0, 0], [9, 0], [0, 9], [9, 9]]\n", "not a room: its walls cross", 5),
    ],
)  # fmt: skip
def test_what_cannot_stand_is_refused_with_its_line(tmp_path: Path, objects: str, said: str, line: int | None) -> None:
    with Simulator() as sim, pytest.raises(TmdError) as caught:
        Scene(sim, environment(tmp_path, objects), DomainFolder(ROOT / "domains/kitchen"))
    assert said in str(caught.value)
    assert f"e.yaml:{line or ''}" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_given_positions_are_kept(tmp_path: Path) -> None:
    text = (
        "  t: {class: table, position: [0.0, -2.0, 0.0]}\n  e1: {class: egg, at: on t, position: [0.1, -1.9, 0.74]}\n"
    )
    with Simulator() as sim:
        scene = Scene(sim, environment(tmp_path, text), DomainFolder(ROOT / "domains/kitchen"))
        assert scene.supported("e1") == ("t", "on")
        assert sim.pose(scene.bodies["t"]).rotate((1.0, 0.0, 0.0))[1] == pytest.approx(1.0)


def test_yaw_turns_what_stands_and_what_stands_on_it(tmp_path: Path) -> None:
    text = (
        "  t: {class: table, position: [0.0, -2.0, 0.0], yaw: 120}\n  e1: {class: mug, at: on t, yaw: 30}\n"
        "  m1: {class: mug, at: on t, position: [0.1, -1.9, 0.74], yaw: -90}\n"
    )
    with Simulator() as sim:
        scene = Scene(sim, environment(tmp_path, text), DomainFolder(ROOT / "domains/kitchen"))
        for name, yaw in (("t", 120), ("e1", 30), ("m1", -90)):
            assert np.degrees(scene.pose_of(name).yaw()) == pytest.approx(yaw, abs=0.5), name
        assert scene.supported("e1") == scene.supported("m1") == ("t", "on")


def test_walls_stand_where_the_room_has_its_corners(tmp_path: Path) -> None:
    text = "  t: {class: table, position: [-0.2, 2.5, 0], yaw: -60}\n"
    text += "room: [[-1.5, -2.2], [2.6, -2.2], [2.6, 1.2], [0.8, 1.2], [0.8, 3.2], [-1.5, 3.2]]\n"
    with Simulator() as sim:
        scene = Scene(sim, environment(tmp_path, text), DomainFolder(ROOT / "domains/kitchen"))
        for way, far in (((1.0, 0.0), 2.6), ((-1.0, 0.0), 1.5), ((0.0, -1.0), 2.2)):
            hit = sim.ray((0.0, 0.0, 1.2), (9 * way[0], 9 * way[1], 1.2))
            assert hit is not None
            assert scene.owner(hit.body) == "floor"
            assert np.hypot(*hit.position[:2]) == pytest.approx(far, abs=0.01)
        beyond = sim.ray((1.5, 0.0, 1.2), (1.5, 9.0, 1.2))
        assert beyond is not None
        assert beyond.position[1] == pytest.approx(1.2, abs=0.01), "the inner corner"
