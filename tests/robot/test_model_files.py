"""Things of one's own: a mesh and a URDF beside objects.yaml, taken, filled and opened by what YAML says of them."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from tmd.check.checker import Checker
from tmd.diagnostics import TmdError
from tmd.domain_kit import DomainKit
from tmd.pddl.reading.reader import with_goal
from tmd.planning.backends import solve
from tmd.planning.result import Solved
from tmd.robot.assets.shapes import Shapes
from tmd.robot.scene.scene import Scene
from tmd.robot.sim.pose import Pose
from tmd.robot.sim.simulator import Simulator
from tmd.world.compile import update_domain
from tmd.world.environment import load_room
from tmd.world.folder import DomainFolder
from tmd.world.roots import Roots

pytest.importorskip("pybullet", reason="needs the extra robot")
pytest.importorskip("vhacdx", reason="needs the extra meshes")
ROOT = Path(__file__).parents[2]
FILES = Path(__file__).parent / "shapes"
MUG = "{mesh: mug.obj, scale: 0.001, turn: [90, 0, 180], holds: true, colour: teal, mass: 0.2}"
HANDLE = "{part: door, kind: door, joint: hinge, at: [0.07, 0.64, -0.1], width: 0.018, open: 1.57}"
REGION = "{relation: in, low: [-0.19, -0.33, 0.72], high: [0.21, 0.33, 1.37], entry: [-1, 0, 0]}"
CABINET = (
    "{urdf: cabinet.urdf, origin: {xyz: [-0.21, -0.35, 0]}, size: [0.42, 0.7, 1.4], "
    f"handles: [{HANDLE}], regions: [{REGION}]}}"
)
CLASSES = """
  enamel_mug: {{parent: mug, shape: {mug}}}
  cabinet:
    parent: furniture
    facts: [allows self in, drops_on self floor]
    parts: {{door: {{class: door}}}}
    edges: [door guards root]
    shape: {cabinet}
"""
ROOM = """name: mine
domain: kitchen
objects:
  counter1: {class: counter}
  sink1: {class: sink}
  cabinet1: {class: cabinet}
  enamel_mug1: {class: enamel_mug, at: on counter1}
"""
Kitchen = Callable[..., DomainFolder]


@pytest.fixture
def kitchen(tmp_path: Path) -> Kitchen:
    """A kitchen with a mug and a cabinet of one's own."""

    def make(mug: str = MUG, cabinet: str = CABINET) -> DomainFolder:
        folder = tmp_path / "domains" / "kitchen"
        shutil.copytree(ROOT / "domains" / "kitchen", folder)
        for file in FILES.iterdir():
            if file.suffix in (".obj", ".urdf"):
                shutil.copy(file, folder)
        objects = folder / "objects.yaml"
        objects.write_text(objects.read_text() + CLASSES.format(mug=mug, cabinet=cabinet))
        (tmp_path / "mine.yaml").write_text(ROOM)
        return DomainFolder(folder)

    return make


def test_a_mesh_stands_on_its_underside_and_is_hollow(kitchen: Kitchen, tmp_path: Path) -> None:
    folder = kitchen()
    model = Shapes(folder).blueprint("enamel_mug").model
    assert np.allclose((model.low, model.high), ((-0.0615, -0.033, 0.0), (0.033, 0.033, 0.092)), atol=1e-4)
    assert model.contents == ["content", "topping"]
    assert {grasp.tool.approach for grasp in model.grasps if grasp.tool.approach[2] == 0} == {(-1.0, 0.0, 0.0)}
    with Simulator() as sim:
        scene = Scene(sim, load_room(tmp_path / "mine.yaml"), folder)
        mug = scene.bodies["enamel_mug1"]
        pose = sim.pose(mug)
        assert pose.rotate((0.0, 0.0, 1.0))[2] > 0.999, "it stands"
        inside, above = (pose.apply((x, 0.0, 0.3)) for x in (0.0, 0.031))
        hit, wall = (sim.ray(point, (point[0], point[1], 0.0)) for point in (inside, above))
        assert hit is not None
        assert wall is not None
        assert (hit.body, wall.body) == (mug, mug)
        assert hit.position[2] - pose.position[2] == pytest.approx(0.006, abs=0.003), "the bottom, through the opening"
        assert wall.position[2] - pose.position[2] == pytest.approx(0.092, abs=0.003), "the rim"


def test_joints_of_a_urdf_are_worked_where_yaml_says(kitchen: Kitchen, tmp_path: Path) -> None:
    folder = kitchen()
    with Simulator() as sim:
        scene = Scene(sim, load_room(tmp_path / "mine.yaml"), folder)
        cabinet, handle = scene.pose_of("cabinet1"), scene.handle("cabinet1_door")
        assert handle is not None
        assert (handle.kind, handle.turns, handle.closed, handle.open) == ("door", True, 0.0, 1.57)
        # the file has its origin in a corner; the thing has it in the middle of its footprint
        assert cabinet.inverse().apply(handle.grasp.position) == pytest.approx((0.281, 0.3, 0.96), abs=1e-4)
        sim.set_joint(handle.body, handle.joint, 1.57)
        turned = scene.handle("cabinet1_door")
        assert turned is not None
        away = cabinet.inverse().apply(turned.grasp.position)
        assert away == pytest.approx((0.211 + 0.64, -0.34 - 0.07, 0.96), abs=0.002)
        spots = scene.support("cabinet1", "in", "enamel_mug1")
        assert spots
        for spot in spots:
            assert cabinet.inverse().apply(spot.pose.position)[2] == pytest.approx(0.72, abs=1e-6)


def test_a_mug_of_ones_own_is_filled_and_put_away(kitchen: Kitchen, tmp_path: Path) -> None:
    """By the robot, without a line of Python: into a cabinet of one's own, whose door it opens and shuts."""
    folder = kitchen()
    update_domain(folder, write=True)
    roots = Roots(tmp_path / "domains", ROOT / "problems")
    kit = DomainKit(roots.corpus(DomainFolder(folder.path)))
    room = tmp_path / "mine.yaml"
    goal = "(and (filled enamel_mug1) (at enamel_mug1 cabinet1 in) (not (opened cabinet1_door)))"
    answer = solve(with_goal(kit.problem(room), goal, "goal"))
    assert isinstance(answer, Solved)
    run = kit.run_plan(answer.plan, room, kinematic=True)
    assert run.execution.status != "stopped", run.execution.reason
    end = {str(atom) for atom in run.execution.steps[-1].state}
    assert {"(filled enamel_mug1)", "(at enamel_mug1 cabinet1 in)"} <= end
    assert "(opened cabinet1_door)" not in end


WRONG = {
    "no-such-mesh": ({"mug": "{mesh: jug.obj}"}, r"there is no file .*jug\.obj"),
    "no-mesh": ({"mug": "{mesh: lexicon.yaml}"}, r".*lexicon\.yaml is not a mesh"),
    "empty-mesh": ({"mug": "{mesh: empty.obj}"}, r".*empty\.obj is not a mesh"),
    "outside": ({"mug": "{mesh: ../../mine.yaml}"}, r"\.\./\.\./mine\.yaml is not in the folder of the domain"),
    "millimetres": ({"mug": "{mesh: mug.obj}"}, r".*mug\.obj is 94\.5 × 92 × 66 m large.*scale: 0\.001"),
    "upside-down": (
        {"mug": "{mesh: mug.obj, scale: 0.001, turn: [-90, 0, 0], holds: true}"},
        r"it holds nothing: .* closed at 9\.2 cm.*`turn:`",
    ),
    "too-wide": ({"mug": "{mesh: mug.obj, scale: 0.01}"}, r"no hand fits round it.*`grasps:`"),
    "two-shapes": ({"mug": "{kind: cup, mesh: mug.obj}"}, r".*a shape says one of kind, mesh and urdf"),
    "key-of-another": (
        {"mug": "{kind: cup, scale: 0.001}"},
        r".*'scale' is for a shape that is a mesh, not for a kind",
    ),
    "no-such-urdf": ({"cabinet": "{urdf: wardrobe.urdf}"}, r"there is no file .*wardrobe\.urdf"),
    "no-urdf": ({"cabinet": "{urdf: lexicon.yaml}"}, r".*lexicon\.yaml is not valid XML"),
    "missing-mesh": ({"cabinet": "{urdf: lost.urdf}"}, r".*lost\.urdf: its mesh gone\.stl is missing"),
    "off-the-floor": (
        {"cabinet": "{urdf: cabinet.urdf, origin: {xyz: [0, 0, 1]}}"},
        r".*its lowest point is at z = 1\.000 m.*`origin: \{xyz: \[0, 0, -1\.000\]\}`",
    ),
    "no-joint": (
        {"cabinet": CABINET.replace("joint: hinge", "joint: hinges")},
        r"cabinet\.urdf has no joint 'hinges' that moves.*did you mean \"hinge\"",
    ),
    "wrong-kind": ({"cabinet": CABINET.replace("kind: door", "kind: drawer")}, r"'hinge' turns, and a drawer does not"),
    "beyond-limits": (
        {"cabinet": CABINET.replace("1.57", "2.5")},
        r"open: 2\.5 is beyond the limits of 'hinge', 0 to 1\.9",
    ),
    "no-part": ({"cabinet": CABINET.replace("part: door", "part: doer")}, r"the class has no part 'doer'.*\"door\""),
    "no-link": (
        {"cabinet": CABINET.replace("relation: in", "relation: in, link: shelf")},
        r"cabinet\.urdf has no link 'shelf'.*body, door_panel",
    ),
    "empty-region": ({"cabinet": CABINET.replace("0.72]", "1.72]")}, r"the region is empty along z"),
    "no-bottom": ({"mug": "{mesh: tube.obj, holds: true}"}, r"it has no bottom: .*leave `holds` out"),
    "not-closed": ({"mug": "{mesh: open.obj, solid: false}"}, r".*open\.obj is not closed.*`solid: true`"),
    "no-thickness": ({"mug": "{mesh: card.obj}"}, r".*card\.obj has no thickness: it is 0\.08 × 0\.06 × 0 m large"),
    "centimetres": (
        {"mug": "{mesh: mug.obj, scale: 0.1}"},
        r".*mug\.obj is .* m large.*`scale: 0\.001`.*centimetre: .* cm",
    ),
    "inches": (
        {"mug": "{mesh: mug.obj, scale: 0.03937}"},
        r"no hand fits round it.*`scale: 0\.000999998`.*inch.*or say under `grasps:`",
    ),
    "xacro": ({"cabinet": "{urdf: macro.urdf}"}, r".*macro\.urdf is a xacro, not a URDF \(.* > macro_expanded\.urdf"),
    "degrees": ({"cabinet": "{urdf: degrees.urdf}"}, r".*hinge' has a limit of 90 \(limits are in radians: say 1\.571"),
    "no-limits": ({"cabinet": "{urdf: loose.urdf}"}, r".*hinge' cannot move: it has no limits \(say `<limit lower"),
    "swapped-limits": (
        {"cabinet": "{urdf: swapped.urdf}"},
        r".*its lower limit is above .*say lower=\"0\" upper=\"1\.9",
    ),
    "commas": ({"cabinet": "{urdf: commas.urdf}"}, r".*the joint 'hinge': xyz=\".*,.*\" of <axis> is not 3 numbers"),
    "formula": ({"cabinet": "{urdf: formula.urdf}"}, r".*upper=\"pi/2\" of <limit> is not a number \(.*no formulas"),
    "half-expanded": ({"cabinet": "{urdf: half.urdf}"}, r".*half\.urdf is a xacro, not a URDF"),
    "no-axis": ({"cabinet": "{urdf: still.urdf}"}, r".*joint 'hinge' has no axis"),
    "two-roots": ({"cabinet": "{urdf: two.urdf}"}, r".*two\.urdf is not a tree: it has the roots body, lonely"),
    "a-cycle": ({"cabinet": "{urdf: cycle.urdf}"}, r".*cycle\.urdf is not a tree: '[ab]' stands on itself"),
    "unknown-encoding": ({"cabinet": "{urdf: encoding.urdf}"}, r".*encoding\.urdf is not valid XML: unknown encoding"),
    "long-name": ({"cabinet": "{urdf: long.urdf}"}, r".*its mesh a{300} is missing"),
    "slanted": ({"mug": "{mesh: slanted.obj}"}, r".*slanted\.obj has no thickness"),
    "no-such-corner": (
        {"mug": "{mesh: corner.ply}"},
        r".*corner\.ply is not a mesh: ",
    ),
    "another-case": ({"cabinet": "{urdf: case.urdf}"}, r".*its mesh MUG\.obj is missing \(there is mug\.obj"),
    "no-package": ({"cabinet": "{urdf: package.urdf}"}, r".*is missing \(put the folder 'mine' beside the URDF"),
    "centimetres-in-a-urdf": (
        {"cabinet": "{urdf: large.urdf}"},
        r".*large\.urdf is 70 m large \(its lengths are metres",
    ),
    "pointer": ({"mug": "{mesh: lfs.stl}"}, r".*lfs\.stl is a pointer of Git LFS.*git lfs pull"),
    "not-a-number": ({"mug": "{mesh: nan.obj}"}, r".*nan\.obj is not a mesh: it has no triangles whose corners are"),
    "another-format": ({"mug": "{mesh: mug.blend}"}, r".*not a mesh: \.blend files are not read .*an OBJ, STL"),
    "beside-the-bar": (
        {"cabinet": CABINET.replace("0.07, 0.64, -0.1", "0.07, 0.64, -0.35")},
        r"the hand would be \d+\.\d cm beside 'door_panel' \(`at` is the middle of the bar",
    ),
    "no-hand": ({"mug": "{urdf: cabinet.urdf}"}, r"no hand can take it.*`grasps:`"),
}


def write_wrong(folder: Path) -> None:
    """A tube, half a box, a card, and URDFs that are no good."""
    import trimesh

    trimesh.creation.annulus(0.025, 0.03, 0.09).export(folder / "tube.obj")
    box = trimesh.creation.box((0.05, 0.05, 0.05))
    trimesh.Trimesh(box.vertices, box.faces[:-2]).export(folder / "open.obj")
    (folder / "card.obj").write_text("v 0 0 0\nv 0.08 0 0\nv 0.08 0.06 0\nv 0 0.06 0\nf 1 2 3\nf 1 3 4\n")
    cabinet = (folder / "cabinet.urdf").read_text()
    limit = re.search(r"<limit[^>]*>", cabinet)
    assert limit is not None
    (folder / "degrees.urdf").write_text(cabinet.replace(limit[0], '<limit lower="0" upper="90"/>'))
    (folder / "loose.urdf").write_text(cabinet.replace(limit[0], ""))
    axis = re.search(r'<axis xyz="([^"]*)"/>', cabinet)
    assert axis is not None
    mesh = '<link name="body"><visual><geometry><mesh filename="{}"/></geometry></visual>'
    for name, old, new in (
        ("swapped", limit[0], '<limit lower="1.9" upper="0"/>'),
        ("commas", axis[1], axis[1].replace(" ", ", ")),
        ("formula", limit[0], '<limit lower="0" upper="pi/2"/>'),
        ("half", limit[0], '<limit lower="0" upper="${pi/2}"/>'),
        ("still", axis[1], "0 0 0"),
        ("two", "</robot>", '<link name="lonely"/></robot>'),
        ("case", '<link name="body">', mesh.format("MUG.obj")),
        ("long", '<link name="body">', mesh.format("a" * 300)),
        ("encoding", 'version="1.0"', 'version="1.0" encoding="none"'),
        (
            "cycle",
            "</robot>",
            '<link name="a"/><link name="b"/>'
            + '<joint name="{0}" type="fixed"><parent link="{0}"/><child link="{1}"/></joint>'.format("a", "b")
            + '<joint name="{0}" type="fixed"><parent link="{0}"/><child link="{1}"/></joint></robot>'.format("b", "a"),
        ),
        ("package", '<link name="body">', mesh.format("package://mine/jug.obj")),
        ("windows", '<link name="body">', mesh.format(r".\\mug.obj")),
        (
            "large",
            'xyz="0.21 0.35 0.36"/><geometry><box size="0.42 0.7 0.72"',
            'xyz="0 0 35"/><geometry><box size="7 7 70"',
        ),
    ):
        (folder / f"{name}.urdf").write_text(cabinet.replace(old, new))
    (folder / "lfs.stl").write_text("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n")
    (folder / "nan.obj").write_text("v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n")
    (folder / "slanted.obj").write_text("v 0 0 0\nv 0.05 0 0.05\nv 0 0.05 0.02\nf 1 2 3\n")
    header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    header += "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    (folder / "corner.ply").write_text(f"{header}0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n")
    (folder / "mug.blend").write_text("BLENDER")
    macro = '<xacro:macro name="m" params=""/>'
    (folder / "macro.urdf").write_text(
        cabinet.replace("<robot", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"').replace(
            "</robot>", f"{macro}</robot>"
        )
    )


@pytest.mark.parametrize("suffix", ["obj", "stl", "ply"])
def test_what_is_just_as_wide_as_a_hand_is_taken_whatever_its_format(kitchen: Kitchen, suffix: str) -> None:
    import trimesh

    folder = kitchen(mug=f"{{mesh: post.{suffix}}}")
    trimesh.creation.cylinder(0.035, 0.1, sections=64).export(folder.path / f"post.{suffix}")
    assert Shapes(folder).blueprint("enamel_mug").model.grasps


@pytest.mark.parametrize(("shapes", "told"), WRONG.values(), ids=list(WRONG))
def test_what_is_wrong_with_a_file_is_told_with_its_place(kitchen: Kitchen, shapes: dict[str, str], told: str) -> None:
    folder = kitchen(**shapes)
    (folder.path / "empty.obj").write_text("# nothing\n")
    (folder.path / "lost.urdf").write_text(
        '<robot name="lost"><link name="a"><collision><geometry><mesh filename="gone.stl"/></geometry></collision>'
        "</link></robot>"
    )
    write_wrong(folder.path)
    with pytest.raises(TmdError) as caught:
        Shapes(folder).blueprint("enamel_mug" if "mug" in shapes else "cabinet")
    assert re.match(told, f"{caught.value.message} ({caught.value.hint})"), caught.value
    place = caught.value.location
    assert place is not None
    line = (folder.path / "objects.yaml").read_text().splitlines()[place.line - 1]
    assert "shape:" in line


def test_a_wrong_value_in_one_shape_does_not_hide_the_faults_of_others(kitchen: Kitchen) -> None:
    folder = kitchen(mug=MUG.replace("0.001", "[1, 1, 1]"), cabinet="{urdf: gone.urdf}")
    objects = folder.path / "objects.yaml"
    more = "  jug: {parent: item, facts: movable self, shap: {kind: jar}}\n  jar: {parent: item, shape: {kind: jra}}\n"
    objects.write_text(objects.read_text() + more)
    checker = Checker()
    checker.check(objects)
    faults = [finding.message for finding in checker.findings.sorted()]
    parts = ("shape.scale: should be", "no file", "facts: should be a list", "unknown key 'classes.jug.shap'", "'jra'")
    for fault, part in zip(faults, parts, strict=True):
        assert part in fault


def test_all_joints_of_a_urdf_are_looked_at(kitchen: Kitchen) -> None:
    folder = kitchen(cabinet="{urdf: two.urdf}")
    cabinet = (folder.path / "cabinet.urdf").read_text()
    joint = '<joint name="{}" type="{}"><parent link="body"/><child link="{}"/></joint>'
    more = joint.format("slide", "screw", "door_panel") + joint.format("knob", "fixed", "knbo")
    (folder.path / "two.urdf").write_text(cabinet.replace("</robot>", f"{more}</robot>"))
    checker = Checker()
    checker.check(folder.path / "objects.yaml")
    faults = [finding.message for finding in checker.findings.sorted() if "two.urdf" in finding.message]
    assert len(faults) == 2


def test_names_of_meshes_from_windows_are_read(kitchen: Kitchen) -> None:
    folder = kitchen(cabinet="{urdf: windows.urdf}")
    write_wrong(folder.path)
    assert "mug.obj" in Shapes(folder).blueprint("cabinet").urdf


def test_the_frame_of_a_joint_may_be_turned() -> None:
    assert Pose.turned(0.1, 0.2, 0.3).rotate((1.0, 0.0, 0.0)) == pytest.approx((0.9362934, 0.2896295, -0.1986693))
