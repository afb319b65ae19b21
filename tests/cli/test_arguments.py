"""Environment and request as positions, short options, and the one name of the option for output."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from tests.bundled import kit
from tests.cli.conftest import BLOCKS, ROOT, Tmd
from tmd.cli.program import COMMANDS, run
from tmd.diagnostics import ExitCode
from tmd.goals.wording import folded, shortened
from tmd.pddl.model import And, Atom, Or
from tmd.pddl.writer import format_formula
from tmd.view.answer_text import grounded_text

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
        (["exprot"], "export"),
        (["ground", "corner2", "b", "--model", "gols"], "goals"),
        (["plan", "01_blokcs", "p.pddl"], "01_blocks"),
    ],
)
def test_a_misspelt_word_gets_the_nearest(arguments: list[str], meant: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(arguments) in (ExitCode.USAGE, ExitCode.BAD_INPUT)
    assert re.search(f"[Dd]id you mean .*['\"]{meant}['\"]", capsys.readouterr().err)


def test_an_answer_fits_a_screen(learned: Path) -> None:
    """The next test says that the command prints these texts."""
    grounded = kit("kitchen").ground("Make ramen.", "kitchen1")
    answer = grounded_text(grounded)
    assert answer.startswith("clauses\n") and "energy" not in answer
    goal = answer.partition("goals\n")[2].splitlines()[:2]
    words, pddl = (line.partition("   declared: ")[0].removeprefix("  1. ").strip() for line in goal)
    assert len(words) <= 200 and len(pddl) <= 200
    assert pddl.endswith("…") and pddl.removesuffix(" …") in grounded_text(grounded, verbose=True)
    energies = grounded_text(grounded, energies=True)
    assert "plan 1: energy " in energies and "  energy by factor: " in energies


def test_a_program_gets_the_same_text(tmd: Tmd) -> None:
    grounded = kit("02_table").ground(TEXT, "corner2", top=2)
    for option in ({}, {"energies": True}, {"verbose": True, "energies": True}):
        printed = tmd("ground", "corner2", TEXT, "--top", "2", *(f"--{name}" for name in option))
        assert grounded_text(grounded, **option) == printed.out


def test_a_brief_answer_is_a_plan_on_a_line(tmd: Tmd) -> None:
    for option in ("-q", "--brief"):
        assert tmd("ground", "corner2", TEXT, option).out == f"{STEPS}\n"
    plans = tmd("ground", "corner2", TEXT, "-q", "--top", "2").out.splitlines()
    assert len(plans) == 2 and plans[0] == STEPS
    refused = tmd("ground", "corner2", "Take the zebra.", "-q")
    assert (refused.code, refused.out) == (ExitCode.NOT_GROUNDED, "no plan\n")


def test_alternatives_are_folded() -> None:
    atoms = [Atom("a", (f"x{n}",)) for n in range(5)]
    shown = folded(And((Or(tuple(atoms)), Or(tuple(atoms[:3])))))
    assert format_formula(shown) == "(and (or (a x0) (a x1) (a x2) (... 2 more)) (or (a x0) (a x1) (a x2)))"
    long = shortened("word " * 100)
    assert len(long) <= 200 and long.endswith("word …") and shortened("a b") == "a b"


LINES = "Take the zebra.\n\nPut the cup on the first table.\r\nTake \udcff.\n {}\nLeave the cup.\nTake the book. Ahem."
STEPS = "moveto(cup1) grasp(cup1) moveto(table1) keep(cup1, table1, on)"


def test_requests_line_by_line(tmd: Tmd, tmp_path: Path) -> None:
    given = LINES.format("take the cup " * 400).encode("utf-8", "surrogateescape")
    ended = tmd("ground", "corner2", "-", stdin=given)
    assert ended.code == ExitCode.NOT_GROUNDED
    wanted = ["no plan", STEPS, "no plan", "no plan", "nothing to do", "moveto(book1) grasp(book1)"]
    assert ended.out.splitlines() == wanted
    told = [line.partition(": ")[::2] for line in ended.err.splitlines()]
    assert [place for place, _ in told] == ["line 1", "line 4", "line 4", "line 5", "line 5", "line 7"], ended.err
    assert told[1][1] == "error: the request: character 6 is not UTF-8"
    assert told[3][1].startswith("error: the text has 1,200 words")
    assert told[5][1].startswith('warning: "Ahem" was skipped')
    assert tmd("ground", "corner2", "-", "-o", "plans", stdin=given).out == ""
    assert (tmp_path / "plans").read_text() == ended.out


def test_requests_line_by_line_as_json(tmd: Tmd) -> None:
    ended = tmd("ground", "corner2", "-", "--json", stdin=LINES.encode("utf-8", "surrogateescape"))
    told = [json.loads(line) for line in ended.out.splitlines()]
    assert ["error" if "error" in line else len(line["plans"]) for line in told] == [0, 1, "error", 0, 1, 1]
    assert told[1]["text"] == "Put the cup on the first table."
    ended = tmd("ground", "corner2", "-", "--json", "--goal-only", stdin=b"Take the cup.")
    assert (ended.code, json.loads(ended.out)["goal"]) == (ExitCode.OK, "(holding pr2 cup1)")
    assert tmd("ground", "corner2", "-").out == ""


@pytest.mark.parametrize("option", [["--goal-only"], ["--show-prompt"], ["--ask"]], ids=str)
def test_what_one_line_cannot_hold(tmd: Tmd, option: list[str]) -> None:
    ended = tmd("ground", "corner2", "-", *option, stdin=b"Take the cup.")
    assert (ended.code, ended.out) == (ExitCode.USAGE, "")
