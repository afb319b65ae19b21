"""``tmd scene``: what stands where, and from where it is taken."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from tests.cli.conftest import BLOCKS, ROOT, Tmd
from tmd.diagnostics import ExitCode

pytest.importorskip("pybullet", reason="needs the extra robot")
pytest.importorskip("PIL", reason="needs the extra robot")

MINE = "name: mine\ndomain: kitchen\nobjects:\n  table1: {class: table}\n  mug1: {class: mug, at: on table1}\n"


def test_what_stands_where(tmd: Tmd, tmp_path: Path) -> None:
    from PIL import Image

    (tmp_path / "mine.yaml").write_text(MINE)
    ended = tmd("scene", "--environment", "mine.yaml", "--reach", "--picture", "room.png")
    assert (ended.code, ended.err) == (ExitCode.OK, "")
    assert re.fullmatch(
        r"mine: 1 pieces of furniture, 1 things to carry\n"
        r"  table1  table  at  \d\.\d\d +-?\d\.\d\d  0\.00  from \S+ \S+, facing -?\d+°\n"
        r"  mug1    cup    at  \d\.\d\d +-?\d\.\d\d  0\.74  on table1, from \S+ \S+, facing -?\d+°, \w+ hand\n",
        ended.out,
    ), ended.out
    with Image.open(tmp_path / "room.png") as picture:
        assert picture.format == "PNG"


@pytest.mark.parametrize(
    ("arguments", "code", "told"),
    [
        (["--environment", "kitchen9"], ExitCode.BAD_INPUT, r"error: there is no environment 'kitchen9'"),
        (["--environment", "none.yaml"], ExitCode.BAD_INPUT, r"error: none\.yaml"),
        (["--environment", BLOCKS / "p01.pddl"], ExitCode.BAD_INPUT, r"error: .*no scene of it"),
        (["--environment", "kitchen1", "--picture", "a.jpg"], ExitCode.USAGE, r"error: .*does not end in \.png"),
        (["--environment", "kitchen1", "--picture", "no/a.png"], ExitCode.CANNOT_WRITE, r"error: no/a\.png cannot be"),
    ],
)
def test_what_cannot_be_shown(tmd: Tmd, arguments: list[str | Path], code: ExitCode, told: str) -> None:
    ended = tmd("scene", *arguments)
    assert ended.code == code
    assert re.match(told, ended.err), ended.err
    assert ended.out == ""


def test_a_part_without_a_shape_is_not_said_to_be_missing(tmd: Tmd, tmp_path: Path) -> None:
    shutil.copytree(ROOT / "domains" / "03_drawer", tmp_path / "domains" / "03_drawer")
    classes = tmp_path / "domains" / "03_drawer" / "objects.yaml"
    text = classes.read_text().replace("  table:\n", "  flap: {parent: part, facts: [allows self in]}\n  table:\n")
    classes.write_text(
        text.replace("    parts:\n      drawer:", "    parts:\n      flap: {class: flap}\n      drawer:")
    )
    objects = "objects:\n  desk1: {class: desk}\n  key1: {class: key, at: in desk1_%s}\n"
    for part, told in (
        ("flap", "'desk1_flap', where 'key1' is to be, has no shape"),
        ("flab", "there is no 'desk1_flab'"),
    ):
        (tmp_path / "mine.yaml").write_text("name: mine\ndomain: 03_drawer\n" + objects % part)
        ended = tmd("scene", "--environment", "mine.yaml")
        assert ended.code == ExitCode.BAD_INPUT and told in ended.err
