"""`shape:` in objects.yaml: inherited, refined, refused with its place, and unknown to PDDL."""

from __future__ import annotations

from pathlib import Path

import pytest

from tmd.diagnostics import TmdError
from tmd.world.classes import Classes
from tmd.world.compile import compile_domain
from tmd.world.folder import DomainFolder
from tmd.world.shape import Shape
from tmd.world.yaml_positions import YamlSource

KITCHEN = Path(__file__).parents[2] / "domains" / "kitchen"
TYPES = {"thing": "object", "vessel": "thing", "part": "thing"}


def classes(tmp_path: Path, text: str) -> Classes:
    path = tmp_path / "objects.yaml"
    path.write_text(text)
    return Classes(YamlSource(path), TYPES)


FAMILY = """classes:
  knob: {parent: part, shape: {kind: knob, settings: [off, high]}}
  cup: {parent: vessel, shape: {kind: cup, colour: red, mass: 0.2}}
  big_cup: {parent: cup, shape: {kind: cup, size: [0.1, 0.1, 0.2]}}
  bucket: {parent: cup, shape: {kind: pot}}
  mug: {parent: cup}
  stove:
    parent: thing
    parts:
      left: {class: knob}
      right: {class: knob, shape: {kind: knob, colour: blue}}
"""


def test_a_shape_is_inherited_and_refined(tmp_path: Path) -> None:
    family = classes(tmp_path, FAMILY)
    shapes = {name: family.get(name).vertices["root"].shape for name in ("mug", "big_cup", "bucket")}
    assert shapes["mug"] == Shape(kind="cup", colour="red", mass=0.2)
    assert shapes["big_cup"] == Shape(kind="cup", colour="red", mass=0.2, size=(0.1, 0.1, 0.2))
    assert shapes["bucket"] == Shape(kind="pot")


def test_a_part_has_the_shape_of_its_class_unless_it_says_more(tmp_path: Path) -> None:
    parts = classes(tmp_path, FAMILY).get("stove").vertices
    assert parts["left"].shape == Shape(kind="knob", settings=("off", "high"))
    assert parts["right"].shape == Shape(kind="knob", settings=("off", "high"), colour="blue")
    assert parts["root"].shape is None


@pytest.mark.parametrize(
    ("shape", "said"),
    [
        ("{kind: cup, size: [0.1, 0.1]}", "shape.size"),
        ("{kind: cup, size: [0.1, 0.1, -1.0]}", "greater than 0"),
        ("{kind: cup, size: [0.1, 0.1, .inf]}", "less than or equal to 10"),
        ("{kind: cup, colour: 7}", "shape.colour"),
        ("{kind: cup, colour: '#12'}", "should be a colour"),
        ("{kind: cup, wheels: 4}", "unknown key"),
        ("{size: [0.1, 0.1, 0.1]}", "a shape says one of kind, mesh and urdf"),
    ],
)
def test_a_wrong_shape_is_refused_with_its_line(tmp_path: Path, shape: str, said: str) -> None:
    with pytest.raises(TmdError) as caught:
        classes(tmp_path, f"classes:\n  cup:\n    parent: vessel\n    shape: {shape}\n")
    assert said in str(caught.value)
    assert "objects.yaml:4:" in str(caught.value)


def test_pddl_knows_nothing_of_shapes(tmp_path: Path) -> None:
    for name in ("instructions.pddl", "objects.yaml"):
        (tmp_path / name).write_text((KITCHEN / name).read_text())
    text = (tmp_path / "objects.yaml").read_text()
    bare = "\n".join(line for line in text.splitlines() if not line.strip().startswith("shape:"))
    with_shape = compile_domain(DomainFolder(tmp_path))
    (tmp_path / "objects.yaml").write_text(bare.replace("  counter:\n", "  counter:\n    shape: {kind: table}\n"))
    assert compile_domain(DomainFolder(tmp_path)) == with_shape
