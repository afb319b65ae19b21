"""Kinds of shapes: every class of every domain has one, and what makes no sense is refused with its line."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

from tmd.diagnostics import TmdError
from tmd.robot.assets.features import PALETTE, mixed, rgba
from tmd.robot.assets.kinds import KINDS
from tmd.robot.assets.shapes import Shapes
from tmd.world.compile import compile_domain
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).parents[2]
DOMAINS = sorted(p.parent for p in ROOT.glob("domains/*/skills.yaml"))
"""Those that the robot acts in."""
NO_OBJECTS = {"fixture", "appliance"}
"""Classes that only say what others have in common."""


def whole_classes(folder: Path) -> list[str]:
    shapes = Shapes(DomainFolder(folder))
    names = [n for n in shapes.classes.entries.classes if n not in NO_OBJECTS]
    parts = {v.class_name for n in names for v in shapes.classes.get(n).vertices.values() if v.name != "root"}
    return [n for n in names if n not in parts and shapes.sort(n) != "part"]


@pytest.mark.parametrize("folder", DOMAINS, ids=lambda p: p.name)
def test_every_class_of_a_bundled_domain_says_its_shape(folder: Path) -> None:
    shapes = Shapes(DomainFolder(folder))
    for name in whole_classes(folder):
        assert shapes.classes.get(name).vertices["root"].shape is not None, name


@pytest.mark.parametrize("folder", DOMAINS, ids=lambda p: p.name)
def test_every_blueprint_is_a_tree_of_links_with_mass(folder: Path) -> None:
    shapes = Shapes(DomainFolder(folder))
    for name in whole_classes(folder):
        blueprint = shapes.blueprint(name)
        robot = ElementTree.fromstring(blueprint.urdf)
        links = {link.get("name") for link in robot.iter("link")}
        children = [joint.find("child") for joint in robot.iter("joint")]
        assert links - {c.get("link") for c in children if c is not None} == {"root"}
        assert all(float(mass.get("value", 0)) > 0 for mass in robot.iter("mass"))
        if blueprint.sort == "item":
            assert blueprint.look.mass <= 1.0
            assert blueprint.model.grasps, name
            assert all(grasp.opening <= 0.09 for grasp in blueprint.model.grasps)
            assert blueprint.model.low[2] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("folder", DOMAINS, ids=lambda p: p.name)
def test_every_part_that_is_worked_has_its_grip(folder: Path) -> None:
    shapes = Shapes(DomainFolder(folder))
    worked = {"door", "latched_door", "button", "knob", "tap_handle", "lid", "curtain"}
    for name in whole_classes(folder):
        grips = {grip.part for grip in shapes.blueprint(name).model.grips}
        for part, vertex in shapes.classes.get(name).vertices.items():
            if part != "root" and vertex.shape is not None and vertex.shape.kind in worked:
                assert part in grips, (name, part)


@pytest.mark.parametrize("kind", [k for k, v in KINDS.items() if v.sort != "part"])
def test_a_kind_can_be_built_without_parts(kind: str) -> None:
    from tmd.robot.assets.appearance import Parts
    from tmd.robot.assets.urdf_builder import UrdfModel

    entry = KINDS[kind]
    model = UrdfModel(kind, 1.0)
    assert entry.build is not None
    entry.build(model, entry.default, Parts({}))
    assert model.high[2] > model.low[2]
    if entry.sort == "fixture":
        depth, width, _ = entry.default.size
        assert model.high[1] - model.low[1] <= width + 0.05
        assert model.low[0] >= -depth / 2 - 0.01


def broken(tmp_path: Path, old: str, new: str) -> Shapes:
    for name in ("instructions.pddl", "objects.yaml", "domain.pddl"):
        (tmp_path / name).write_text((ROOT / "domains/kitchen" / name).read_text())
    text = (tmp_path / "objects.yaml").read_text()
    assert text.count(old) >= 1
    (tmp_path / "objects.yaml").write_text(text.replace(old, new, 1))
    return Shapes(DomainFolder(tmp_path))


@pytest.mark.parametrize(
    ("class_name", "old", "new", "said"),
    [
        ("table", "{kind: table}", "{kind: tabel}", "there is no shape 'tabel'"),
        ("table", "{kind: table}", "{kind: pot}", "'pot' is the shape of an item, but table is a fixture"),
        ("table", "{kind: table}", "{kind: table, colour: rainbow}", "there is no colour 'rainbow'"),
        ("table", "{kind: table}", "{kind: table, size: [0.7, 0.01, 0.7]}", "cannot have a width of 0.01 m"),
        ("cupboard", "{kind: cupboard}", "{kind: table}", "the part 'door' is a door, and a table has no place for it"),
        ("stove", "{kind: knob, settings: [off, low, high]}", "{kind: cup}", "'cup' is the shape of an item"),
    ],
)
def test_a_shape_that_makes_no_sense_is_refused(tmp_path: Path, class_name: str, old: str, new: str, said: str) -> None:
    with pytest.raises(TmdError) as caught:
        broken(tmp_path, old, new).blueprint(class_name)
    assert said in str(caught.value)
    assert re.search(r"objects\.yaml:\d+:\d+", str(caught.value))
    line = int(re.findall(r"objects\.yaml:(\d+):", str(caught.value))[0])
    assert new in (tmp_path / "objects.yaml").read_text().splitlines()[line - 1]


def test_a_class_without_a_shape_has_a_plain_one(tmp_path: Path) -> None:
    shapes = broken(tmp_path, "    shape: {kind: cupboard}\n", "")
    assert shapes.blueprint("cupboard").look.kind == "counter"
    assert compile_domain(DomainFolder(tmp_path)) == (ROOT / "domains/kitchen/domain.pddl").read_text()


def test_colours_of_substances_mix_and_unknown_ones_have_one() -> None:
    assert mixed(["milk"]) == rgba("white")
    assert mixed(["milk", "coffee"]) == mixed(["coffee", "milk"])
    assert mixed(["never heard of"]) in {rgba(name) for name in PALETTE}


def test_the_page_names_every_kind_and_every_colour() -> None:
    page = (ROOT / "docs/scenes.md").read_text()
    for name in [*KINDS, *PALETTE]:
        assert name == "plain_part" or f"`{name}`" in page, name
