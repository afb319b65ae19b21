"""Mistakes in the files people write: the place, a caret under it, a remedy where there is one, code 31."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from tests.cli.conftest import BLOCKS, Ended, Tmd
from tmd.diagnostics import ExitCode

DOMAIN = """(define (domain lamps)
  (:requirements :strips :typing)
  (:types lamp switch)
  (:predicates
    (lit ?l - lamp)
    (wired ?s - switch ?l - lamp))
  (:action flip
    :parameters (?s - switch ?l - lamp)
    :precondition (and (wired ?s ?l))
    :effect (and (lit ?l))))
"""
PROBLEM = """(define (problem one)
  (:domain lamps)
  (:objects l1 - lamp s1 - switch)
  (:init (wired s1 l1))
  (:goal (lit l1)))
"""
PLAN = "(flip s1 l1)\n"
ENVIRONMENT = """name: mine
domain: kitchen
objects:
  counter1: {class: counter}
  pot1: {class: pot, at: on counter1}
"""

SLIPS = {
    "parenthesis missing": (DOMAIN, "(lit ?l))))", "(lit ?l)))", None),
    "parenthesis too many": (DOMAIN, "(lit ?l - lamp)", "(lit ?l - lamp))", None),
    "unknown type": (DOMAIN, "(lit ?l - lamp)", "(lit ?l - lam)", "did you mean"),
    "unknown predicate": (DOMAIN, "(and (lit ?l))", "(and (lighted ?l))", None),
    "misspelt predicate": (DOMAIN, "(and (wired ?s ?l))", "(and (wird ?s ?l))", "did you mean"),
    "unknown variable": (DOMAIN, "(and (lit ?l))", "(and (lit ?x))", None),
    "number of arguments": (DOMAIN, "(and (wired ?s ?l))", "(and (wired ?s))", None),
    "order of arguments": (DOMAIN, "(and (wired ?s ?l))", "(and (wired ?l ?s))", None),
    "misspelt section": (DOMAIN, "(:predicates", "(:predicate", "did you mean"),
    "misspelt part": (DOMAIN, ":precondition", ":preconditions", "did you mean"),
    "misspelt requirement": (DOMAIN, ":typing", ":types", None),
    "unsupported section": (DOMAIN, "(:action flip", "(:durative-action flip", None),
    "twice the same predicate": (DOMAIN, "(wired ?s - switch ?l - lamp)", "(lit ?s - switch)", None),
    "question mark forgotten": (DOMAIN, "(and (lit ?l))", "(and (lit l))", None),
    "effect with or": (DOMAIN, "(and (lit ?l))", "(or (lit ?l))", None),
    "not a domain": (DOMAIN, "(define (domain", "(define (problem", None),
    "empty domain": (DOMAIN, DOMAIN, "", None),
    "other domain": (PROBLEM, "(:domain lamps)", "(:domain lamp)", None),
    "unknown object": (PROBLEM, "(wired s1 l1)", "(wired s1 l2)", 'declare "l2 - lamp" under (:objects ...)'),
    "object of another type": (PROBLEM, "(wired s1 l1)", "(wired l1 l1)", None),
    "atom without parentheses": (PROBLEM, "(wired s1 l1)", "wired s1 l1", None),
    "variable in the goal": (PROBLEM, "(lit l1)", "(lit ?l)", None),
    "no goal": (PROBLEM, "(:goal (lit l1))", "", None),
    "parenthesis in the plan": (PLAN, "(flip s1 l1)", "(flip s1 l1", None),
}


def _written(directory: Path, wrong: str, right: str, slip: str) -> list[Path]:
    """Domain, problem and plan, with a slip in the one that is ``wrong``."""
    paths = []
    for name, text in (("domain.pddl", DOMAIN), ("problem.pddl", PROBLEM), ("plan", PLAN)):
        if text == wrong:
            assert text.count(right) == 1
            text = text.replace(right, slip)
        (directory / name).write_text(text)
        paths.append(directory / name)
    return paths


def test_the_files_are_right_without_a_slip(tmd: Tmd, tmp_path: Path) -> None:
    assert tmd("validate", *_written(tmp_path, "", "", "")).code == ExitCode.OK


@pytest.mark.parametrize(("wrong", "right", "slip", "hint"), SLIPS.values(), ids=list(SLIPS))
def test_slips_in_pddl(tmd: Tmd, tmp_path: Path, wrong: str, right: str, slip: str, hint: str | None) -> None:
    paths = _written(tmp_path, wrong, right, slip)
    at_fault = paths[(DOMAIN, PROBLEM, PLAN).index(wrong)]
    _check_fault(tmd("validate", *paths), at_fault, hint)


def _check_fault(ended: Ended, file: Path, hint: str | None) -> None:
    """One line with the place, the source line as it stands there, a caret at the column."""
    assert (ended.code, ended.out) == (ExitCode.BAD_INPUT, ""), ended
    first, *rest = ended.err.splitlines()
    match = re.fullmatch(re.escape(f"error: {file}") + r":(\d+):(\d+): (.+)", first)
    assert match, first
    line, column = int(match[1]), int(match[2])
    source = [*file.read_text().splitlines(), ""][line - 1]
    if source:
        assert rest[0] == f"  {source}"
        assert rest[1] == "  " + " " * (column - 1) + "^"
    if hint:
        assert rest[-1].startswith(f"hint: {hint}")


PLANS = {
    "another action": ("(flop s1 l1)\n", "flop"),
    "another object": ("(flip s2 l1)\n", "s2"),
    "another number": ("(flip s1)\n", "flip"),
    "another type": ("(flip l1 s1)\n", "flip"),
}


@pytest.mark.parametrize(("plan", "named"), PLANS.values(), ids=list(PLANS))
def test_a_plan_for_another_problem(tmd: Tmd, tmp_path: Path, plan: str, named: str) -> None:
    paths = _written(tmp_path, PLAN, PLAN, plan)
    ended = tmd("validate", *paths)
    assert ended.code == ExitCode.INVALID_PLAN
    assert ended.out.startswith(f"invalid: {paths[2]}:1:1: step 1, ")
    assert named in ended.out
    assert ended.err == ""


ENVIRONMENTS = {
    "tab": ("  counter1", "\tcounter1", 4),
    "no colon": ("domain: kitchen", "domain kitchen", None),
    "brace never closed": ("{class: counter}", "{class: counter", None),
    "no class": ("{class: counter}", "{at: on pot1}", 4),
    "unknown class": ("{class: counter}", "{class: countr}", 4),
    "unknown key": ("{class: counter}", "{class: counter, colour: red}", 4),
    "unknown place": ("on counter1", "on counter2", 5),
    "no place": ("on counter1", "counter1", 5),
    "unknown relation": ("on counter1", "under counter1", 5),
    "unknown state": ("{class: pot,", "{class: pot, states: {sleepy: true},", 5),
    "unknown part": ("{class: pot,", "{class: pot, parts: {wing: {}},", 5),
    "same object twice": ("  pot1:", "  counter1:", 5),
    "name in capitals": ("  pot1:", "  Pot1:", 5),
    "another domain": ("domain: kitchen", "domain: kitchn", None),
    "a list": (ENVIRONMENT, "- a\n- b\n", None),
    "empty": (ENVIRONMENT, "", None),
}


@pytest.mark.parametrize(("right", "slip", "line"), ENVIRONMENTS.values(), ids=list(ENVIRONMENTS))
@pytest.mark.parametrize("arguments", [["compile"], ["ground", "--text", "take the pot", "--environment"]])
def test_slips_in_environments(
    tmd: Tmd, tmp_path: Path, arguments: list[str], right: str, slip: str, line: int | None
) -> None:
    path = tmp_path / "mine.yaml"
    assert ENVIRONMENT.count(right) == 1
    path.write_text(ENVIRONMENT.replace(right, slip))
    ended = tmd(*arguments, path)
    assert (ended.code, ended.out) == (ExitCode.BAD_INPUT, ""), ended
    assert re.match(r"error: .+\n", ended.err)
    if line:
        assert ended.err.startswith(f"error: {path}:{line}:"), ended.err


@pytest.mark.parametrize("content", [b"\xff\xfe\x00", b"name: \xe9\n", b"\x00\x01\x02"])
@pytest.mark.parametrize("command", ["compile", "validate"])
def test_files_that_are_no_text(tmd: Tmd, tmp_path: Path, command: str, content: bytes) -> None:
    path = tmp_path / ("mine.yaml" if command == "compile" else "domain.pddl")
    path.write_bytes(content)
    more = [] if command == "compile" else [BLOCKS / "p01.pddl", BLOCKS / "plans" / "valid-sussman.plan"]
    ended = tmd(command, path, *more)
    assert (ended.code, ended.out) == (ExitCode.BAD_INPUT, "")
    assert ended.err.startswith(f"error: {path}:1:")


def test_a_directory_is_no_file(tmd: Tmd, tmp_path: Path) -> None:
    ended = tmd("validate", BLOCKS / "domain.pddl", tmp_path, tmp_path)
    assert (ended.code, ended.out) == (ExitCode.BAD_INPUT, "")
    assert "Is a directory" in ended.err


def test_an_error_as_json(tmd: Tmd, tmp_path: Path) -> None:
    paths = _written(tmp_path, DOMAIN, "(and (wired ?s ?l))", "(and (wird ?s ?l))")
    ended = tmd("validate", *paths, "--json")
    assert json.loads(ended.out) == {
        "error": {
            "code": 31,
            "name": "BAD_INPUT",
            "message": 'unknown predicate "wird"',
            "location": {"file": str(paths[0]), "line": 9, "column": 25},
            "hint": 'did you mean "wired"?',
        }
    }
    assert ended.err.startswith(f"error: {paths[0]}:9:25: ")


def test_a_wrong_command_line_as_json(tmd: Tmd) -> None:
    ended = tmd("validate", "--json")
    assert ended.code == json.loads(ended.out)["error"]["code"] == ExitCode.USAGE


def test_nothing_moves_the_cursor(tmd: Tmd, tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_text(ENVIRONMENT.replace("class: pot", 'class: "\\e[2J\\r"'))
    ended = tmd("compile", path)
    assert ended.code == ExitCode.BAD_INPUT
    assert "\x1b" not in ended.err and "\r" not in ended.err


def test_a_long_line_is_cut_around_the_fault(tmd: Tmd, tmp_path: Path) -> None:
    padding = " ".join(f"c{i}" for i in range(500))
    path = tmp_path / "problem.pddl"
    text = PROBLEM.replace("l1 - lamp", f"l1 {padding} - lamp s2 - swich")
    domain, _, plan = _written(tmp_path, "", "", "")
    path.write_text(text)
    ended = tmd("validate", domain, path, plan)
    error, source, caret, *_ = ended.err.splitlines()
    assert "swich" in error
    assert len(source) <= 110
    assert source[caret.index("^") :].startswith(("swich", "s2"))


DATA_SETS = {
    "empty directory": {},
    "empty file": {"data.xml": ""},
    "truncated": {"data.xml": "<root>\n<point><text>Boil wat"},
    "not XML": {"data.xml": "text, objective\n"},
    "another root": {"data.xml": "<points></points>"},
    "no classes": {"data.xml": "<root></root>"},
    "truncated classes": {"data.xml": "<root></root>", "Objects.xml": "<objects><object>"},
}


@pytest.mark.parametrize("files", DATA_SETS.values(), ids=list(DATA_SETS))
def test_data_sets_that_are_damaged(tmd: Tmd, tmp_path: Path, files: dict[str, str]) -> None:
    directory = tmp_path / "veil"
    directory.mkdir()
    for name, text in files.items():
        (directory / name).write_text(text)
    ended = tmd("experiment", "--task", "all", "--data", "veil500", "--out", "o", "--veil500", directory)
    assert (ended.code, ended.out) == (ExitCode.BAD_DATA, ""), ended
    assert re.match(r"error: .+\n", ended.err)
    assert not (tmp_path / "o").exists()
