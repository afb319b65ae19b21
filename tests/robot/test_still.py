"""Pictures of states without a simulator: they agree with the states, and begin as the simulated scene does."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest

from tests.bundled import corpus
from tmd.pddl.model import Instruction, State
from tmd.pddl.plan_file import parse_instruction
from tmd.robot.assets.urdf_builder import UrdfLink
from tmd.robot.sim.pose import Pose, Vector
from tmd.robot.skills.skill_file import visible
from tmd.robot.video.symbolic_renderer import INVISIBLE, Picture, Still
from tmd.world.environment import load_environment

ROOT = Path(__file__).parents[2]
SEEN = [(domain, path.stem) for domain in ("kitchen", "living_room", "02_table", "03_drawer", "04_tea", "lab_bench")
        for path in sorted((ROOT / "problems" / domain / "environments").glob("*.yaml"))]  # fmt: skip


def frames(
    domain: str, environment: str, most: int = 2
) -> list[list[tuple[Instruction | None, State, Picture, Still]]]:
    """Steps of some demonstrations: the instruction, the state after it, and its picture."""
    known = corpus(domain)
    world = known.world(environment)
    still = Still(load_environment(known.file(environment)), known.folder, visible(known.folder))
    shown = [d for d in known.demonstrations() if d.environment == environment][:most]
    found = []
    for demonstration in shown:
        bits = world.task.init
        picture = still.first(world.task.decode(bits))
        rows: list[tuple[Instruction | None, State, Picture, Still]] = [(None, world.task.decode(bits), picture, still)]
        for instruction in demonstration.instructions:
            bits = world.task.by_instruction[instruction].apply(bits)
            picture = still.draw(world.task.decode(bits), picture)
            rows.append((instruction, world.task.decode(bits), picture, still))
        found.append(rows)
    return found


@pytest.mark.parametrize(("domain", "environment"), SEEN)
def test_things_are_where_the_state_says(domain: str, environment: str) -> None:
    for rows in frames(domain, environment):
        for _, state, picture, still in rows:
            at = {a.args[0]: a.args[1:] for a in state if a.predicate == "at" and still.is_item(a.args[0])}
            held = {a.args[1] for a in state if a.predicate == "holding"}
            for item, place in at.items():
                assert picture.rests[item].at == place
            for item in held:
                assert picture.poses[item].distance(picture.robot) < 1.6
            assert set(picture.poses) == set(still.blueprints)


@pytest.mark.parametrize("environment", ["kitchen1", "kitchen4"])
def test_what_no_instruction_touches_stays(environment: str) -> None:
    for rows in frames("kitchen", environment):
        for (_, _, before, _), (instruction, _, after, still) in pairwise(rows):
            assert instruction is not None
            moved_things = {name for name in after.poses if after.poses[name] != before.poses[name]}
            named = {still.whole(a) for a in instruction.args if a in still.names()}
            carried = {n for n, rest in after.rests.items() if rest.at[1] == "held" or rest.whole in moved_things}
            assert moved_things <= named | carried


def test_a_door_opens_and_a_cup_fills() -> None:
    seen = [frame for rows in frames("kitchen", "kitchen1", 12) for frame in rows]
    opened = [f for f in seen if f[0] is not None and f[0].name == "open"]
    assert opened
    for instruction, _, picture, still in opened:
        assert instruction is not None
        whole, part = still.where(instruction.args[0])
        links = [link for (owner, link), position in picture.joints.items() if owner == whole and position]
        assert links, part
    assert any(c != INVISIBLE for _, _, p, _ in seen for (_, link), c in p.colours.items() if link == "content")


def test_what_lies_in_a_drawer_slides_out_with_it() -> None:
    known = corpus("03_drawer")
    world = known.world("study2")
    still = Still(load_environment(known.file("study2")), known.folder, visible(known.folder))
    first = still.first(world.task.decode(world.task.init))
    state = world.task.init
    for line in ("moveto(cabinet1)", "open(cabinet1_top_drawer)"):
        state = world.task.by_instruction[parse_instruction(line)].apply(state)
    after = still.draw(world.task.decode(state), first)
    assert first.joints["cabinet1", "bottom_drawer"] > 0.2 and first.joints["cabinet1", "top_drawer"] == 0
    assert after.joints["cabinet1", "top_drawer"] > 0.2
    assert after.poses["key1"].distance(first.poses["key1"]) > 0.2
    assert after.poses["pen1"] == first.poses["pen1"]


def test_the_robot_stands_before_what_it_went_to() -> None:
    for rows in frames("kitchen", "kitchen3", 3):
        for instruction, _, picture, still in rows:
            if instruction is not None and instruction.name == "moveto" and instruction.args[0] in still.blueprints:
                x, y, _ = picture.poses[instruction.args[0]].position
                assert Pose((x, y, 0.0)).distance(picture.robot) < 1.6


def test_a_scene_begins_as_the_simulated_one() -> None:
    pytest.importorskip("pybullet", reason="needs the extra robot")
    from tmd.robot.scene.scene import Scene
    from tmd.robot.sim.simulator import Simulator

    known = corpus("kitchen")
    environment = load_environment(known.file("kitchen2"))
    picture = Still(environment, known.folder, visible(known.folder)).first(known.world("kitchen2").task.problem.init)
    with Simulator() as sim:
        placed = Scene(sim, environment, known.folder, settle=0).placed
    assert list(placed) == list(picture.poses)
    assert all(placed[name].distance(picture.poses[name]) < 1e-9 for name in placed)


def test_joints() -> None:
    assert _joint("prismatic", (0.0, 1.0, 0.0)).at(0.2).position == (0.0, 0.2, 0.0)
    x, y, _ = _joint("revolute", (0.0, 0.0, 1.0)).at(1.5707963267948966).apply((1.0, 0.0, 0.0))
    assert (round(x, 9), round(y, 9)) == (0.0, 1.0)


def _joint(kind: str, axis: Vector) -> UrdfLink:
    return UrdfLink("link", "", kind, (0.0, 0.0, 0.0), axis, 0.0, 2.0, 0.0, 0.0, 0.1)
