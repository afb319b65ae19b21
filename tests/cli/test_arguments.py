"""Environment and request as positions, short options, and the one name of the option for output."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from tests.cli.conftest import BLOCKS, ROOT, Tmd
from tmd.cli.program import COMMANDS, run
from tmd.diagnostics import ExitCode

TEXT = "Put the cup on the first table."
FILES = (BLOCKS / "domain.pddl", BLOCKS / "p01.pddl")
FORMS = {
    "positions": ("corner2", TEXT),
    "short": ("-e", "corner2", "-t", TEXT),
    "long": ("--environment", "corner2", "--text", TEXT),
    "place": ("corner2", "--text", TEXT),
    "request": (TEXT, "--environment", "corner2"),
    "domain": ("02_table", "corner2", TEXT),
    "file": (ROOT / "problems/02_table/environments/corner2.yaml", TEXT),
}


@pytest.mark.parametrize("form", FORMS)
def test_all_forms_of_a_request_are_one(tmd: Tmd, form: str) -> None:
    ended = tmd("ground", *FORMS[form])
    assert ended.code == ExitCode.OK
    assert "keep(cup1, table1, on)" in ended.out


def test_a_request_in_pddl_files(tmd: Tmd) -> None:
    by_position = tmd("ground", *FILES, "Stack b on c.")
    assert by_position.code == ExitCode.OK and "stack(b, c)" in by_position.out
    assert tmd("ground", *FILES, "-t", "Stack b on c.") == by_position


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["ground"], "Missing argument 'ENVIRONMENT'"),
        (["ground", "corner2"], "give one of REQUEST, --text and --text-file"),
        (["ground", *FILES], "give one of REQUEST, --text and --text-file"),
        (["ground", "corner2", "Take", "the", "cup"], "quote a request"),
        (["ground", "corner2", "-e", "corner2", TEXT], "name each file once"),
        (["parse", TEXT, "-t", TEXT], "give one of REQUEST, --text and --text-file"),
        (["run", "corner2", TEXT, "--goal", "(a)"], "give one of REQUEST, --text, "),
        (["scene"], "Missing argument 'ENVIRONMENT'"),
        (["scene", "a", "b", "c"], "name each file once"),
        (["data"], "Missing command"),
    ],
)
def test_what_is_missing_or_named_twice(tmd: Tmd, arguments: list[str | Path], told: str) -> None:
    ended = tmd(*arguments)
    assert (ended.code, ended.out) == (ExitCode.USAGE, "")
    assert told in ended.err and ended.err.startswith("error: ")


def test_a_text_is_parsed_by_position(tmd: Tmd) -> None:
    told = tmd("parse", "Take the cup.").out
    assert told == "clauses\n  1. (take, [cup])\n"
    assert tmd("parse", "-", stdin=b"Take the cup.").out == told


def test_the_version(tmd: Tmd) -> None:
    assert tmd("-V") == tmd("--version")


@pytest.mark.parametrize("option", ["-o", "--output", "--out"])
def test_one_option_for_the_output(tmd: Tmd, tmp_path: Path, option: str) -> None:
    printed = tmd("ground", "corner2", TEXT, "--json")
    written = tmd("ground", "corner2", TEXT, "--json", option, "it.json")
    assert (written.code, written.out) == (ExitCode.OK, "")
    assert (tmp_path / "it.json").read_text() == printed.out
    assert tmd("view", "it.json", option, "page.html").out == "page.html\n"
    assert tmd("plan", *FILES, option, "it.plan").code == ExitCode.OK
    assert tmd("compile", FORMS["file"][0], option, "it.pddl").code == ExitCode.OK
    assert (tmp_path / "it.plan").exists() and (tmp_path / "it.pddl").exists()


def test_a_file_that_cannot_be_written(tmd: Tmd) -> None:
    ended = tmd("ground", "corner2", TEXT, "-o", "none/it.txt")
    assert (ended.code, ended.out) == (ExitCode.CANNOT_WRITE, "")
    assert json.loads(tmd("ground", "corner2", TEXT, "--json", "-o", "none/a").out)["error"]["code"] == ended.code


@pytest.mark.parametrize("command", COMMANDS)
def test_a_wrong_option_is_wrong_usage(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run([command, "--xyzzy"]) == ExitCode.USAGE == 2
    out, err = capsys.readouterr()
    assert (out, err) == ("", f"error: No such option '--xyzzy'.\nhint: see tmd {command} --help\n")


@pytest.mark.parametrize(
    ("arguments", "meant"),
    [
        (["ground", "--enviroment", "a"], "--environment"),
        (["run", "--kinematik"], "--kinematic"),
        (["experiment", "--ouptut", "a"], "--output"),
        (["data", "chek"], "check"),
        (["exprot"], "export"),
        (["ground", "corner2", "b", "--model", "gols"], "goals"),
        (["plan", "01_blokcs", "p.pddl"], "01_blocks"),
    ],
)
def test_a_misspelt_word_gets_the_nearest(arguments: list[str], meant: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(arguments) in (ExitCode.USAGE, ExitCode.BAD_INPUT)
    assert re.search(f"[Dd]id you mean .*['\"]{meant}['\"]", capsys.readouterr().err)
