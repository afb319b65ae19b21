"""Defaults of options in ``tmd.toml`` and ``pyproject.toml``."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import BLOCKS, ROOT, Tmd
from tmd.cli.program import run
from tmd.diagnostics import ExitCode

TABLE = 'environment = "corner2"\ntop = 2\njson = true\n'


@pytest.mark.parametrize(
    ("file", "head"), [("tmd.toml", "[ground]\n"), ("pyproject.toml", "[project]\nname = 'x'\n[tool.tmd.ground]\n")]
)
def test_settings_are_defaults(tmd: Tmd, tmp_path: Path, file: str, head: str) -> None:
    (tmp_path / file).write_text(head + TABLE)
    wanted = tmd("ground", "-e", "corner2", "--top", "2", "--json", "Take the cup.")
    assert wanted.code == ExitCode.OK
    assert tmd("ground", "Take the cup.") == wanted
    assert tmd("ground", "--text", "Take the cup.") == wanted


def test_the_command_line_goes_before_settings(tmd: Tmd, tmp_path: Path) -> None:
    (tmp_path / "tmd.toml").write_text('[ground]\nenvironment = "corner2"\ndomain = "02_table"\ntop = 2')
    assert "stack(b, c)" in tmd("ground", BLOCKS / "domain.pddl", BLOCKS / "p01.pddl", "Stack b on c.").out
    assert "plan 2" not in tmd("ground", "Take the cup.", "--top", "1").out
    assert (
        tmd("ground", "corner1", "Take the cup.", "--top", "1").out
        == tmd("ground", "-e", "corner1", "-t", "Take the cup.", "--top", "1").out
    )


def test_the_directories_may_be_settings(tmd: Tmd, tmp_path: Path) -> None:
    (tmp_path / "tmd.toml").write_text(f'domains = "{ROOT}/domains"\nproblems = "none"')
    ended = tmd("ground", "corner2", "Take the cup.")
    assert ended.code == ExitCode.BAD_INPUT and "none: no such directory" in ended.err


@pytest.mark.parametrize(
    ("table", "told"),
    [
        ("[ground]\ntopp = 3", "tmd.toml: ground: there is no option 'topp'\nhint: did you mean \"top\"?"),
        ("[grond]\ntop = 3", "tmd.toml: there is no option 'grond'\nhint: did you mean \"ground\"?"),
        ("debug = true", "tmd.toml: there is no option 'debug'"),
        ("[ground]\ntop = [3]", "tmd.toml: ground: top is [3]\nhint: write a text or a number"),
        ("[ground]\njson = 1", "tmd.toml: ground: json is 1\nhint: write true or false"),
        ("[ground]\ntop = 0", "Invalid value for '--top': 0 is not in the range"),
        ("ground = 3", "tmd.toml is no table of settings: one value stands for a table"),
        ("[ground", "tmd.toml is no table of settings: Expected ']'"),
    ],
)
def test_wrong_settings_are_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], table: str, told: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("tmd.toml").write_text(table)
    assert run(["ground", "corner2", "Take the cup."]) == ExitCode.USAGE
    out, err = capsys.readouterr()
    assert out == "" and err.startswith(f"error: {told}") and err.count("\n") == 2
