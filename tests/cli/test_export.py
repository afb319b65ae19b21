"""``tmd export``: from every kind of source, and what is said where something is wrong."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from tests.cli.conftest import BLOCKS, ROOT, Tmd, run_tmd
from tmd.diagnostics import ExitCode

DOMAIN, PROBLEM = BLOCKS / "domain.pddl", BLOCKS / "p01.pddl"
PLAN = BLOCKS / "plans" / "valid-sussman.plan"
HIDE = "import sys; sys.modules['up_fast_downward'] = None"
STEPS = [["find", "pot1"], ["moveto", "pot1"], ["grasp", "pot1"]]


@pytest.fixture
def tmd(tmp_path: Path) -> Tmd:
    """As the usual one; nothing here grounds a text, so nothing has to be learned first."""
    return lambda *arguments, **options: run_tmd(arguments, tmp_path, **options)


def found(directory: Path) -> dict[str, str]:
    files = (path for path in directory.rglob("*") if path.is_file())
    return {path.relative_to(directory).as_posix(): path.read_text(encoding="utf-8") for path in files}


def test_a_problem_and_the_plan_that_is_found(tmd: Tmd, tmp_path: Path) -> None:
    ended = tmd("export", PROBLEM, "out")
    assert (ended.code, ended.err) == (ExitCode.OK, "")
    assert ended.out.splitlines() == ["out/domain.pddl", "out/problem.pddl", "out/plan.plan"]
    checked = tmd("validate", "out/domain.pddl", "out/problem.pddl", "out/plan.plan")
    assert checked.out == "valid: 6 instructions, cost 6\n"
    again = tmd("export", "out/problem.pddl", "again")
    assert again.code == ExitCode.OK
    assert found(tmp_path / "again") == found(tmp_path / "out")


def test_several_formats(tmd: Tmd, tmp_path: Path) -> None:
    names = "ipc,strips,durative,plansys2,bt"
    ended = tmd("export", PROBLEM, "out", "--plan", PLAN, "--format", names)
    assert sorted(ended.out.split()) == sorted(f"out/{path}" for path in found(tmp_path / "out"))
    for plan in ("ipc", "durative"):
        assert tmd("validate", DOMAIN, PROBLEM, f"out/{plan}/plan.plan").code == ExitCode.OK
    strips = (f"out/strips/{name}" for name in ("domain.pddl", "problem.pddl", "plan.plan"))
    assert tmd("validate", *strips).code == ExitCode.OK


def test_the_same_bytes_whatever_the_order_of_hashes(tmd: Tmd, tmp_path: Path) -> None:
    names = "adl,strips,plansys2,bt"
    for seed in ("1", "2"):
        arguments = ("export", PROBLEM, seed, "--plan", PLAN, "--format", names)
        assert tmd(*arguments, env={"PYTHONHASHSEED": seed}).code == ExitCode.OK
    one, two = ({p.name: p.read_bytes() for p in (tmp_path / s).rglob("*.*")} for s in ("1", "2"))
    assert one == two


def test_an_environment_and_a_plan(tmd: Tmd, tmp_path: Path, environment: Path) -> None:
    plan = tmp_path / "mine.plan"
    plan.write_text("".join(f"({' '.join(step)})\n" for step in STEPS))
    ended = tmd("export", environment, "out", "--plan", plan)
    assert (ended.code, ended.err) == (ExitCode.OK, "")
    assert "(holding pr2 pot1)" in found(tmp_path / "out")["problem.pddl"].partition("(:goal")[2]


def test_an_environment_and_a_goal(tmd: Tmd, tmp_path: Path, environment: Path) -> None:
    ended = tmd("export", environment, "out", "--goal", "(holding pr2 pot1)", "--format", "ipc")
    assert ended.code == ExitCode.OK
    assert found(tmp_path / "out")["plan.plan"].startswith("(find pot1)\n(moveto pot1)\n(grasp pot1)\n")


def test_what_ground_printed(tmd: Tmd, tmp_path: Path) -> None:
    value = json.loads(tmd("ground", "--environment", "kitchen1", "--text", "Take the cup.", "--json").out)
    (tmp_path / "g.json").write_text(json.dumps(value))
    assert tmd("export", "g.json", "out", "--format", "ipc").code == ExitCode.OK
    (tmp_path / "g.json").write_text(json.dumps({**value, "plans": []}))
    ended = tmd("export", "g.json", "none")
    assert (ended.code, ended.err) == (ExitCode.NOT_GROUNDED, "no plan: g.json has no plan\n")
    del value["warnings"]
    (tmp_path / "g.json").write_text(json.dumps(value))
    ended = tmd("export", "g.json", "none")
    assert (ended.code, ended.err) == (
        ExitCode.BAD_INPUT,
        "error: g.json is not what tmd ground --json prints: warnings: the key is missing\n"
        "hint: it was written by an older version of tmd: make it again with tmd ground --json\n",
    )


CASES = {
    "no-format": (ExitCode.USAGE, [PROBLEM, "out", "--format", "adll"], "there is no 'adll': did you mean \"adl\""),
    "no-source": (ExitCode.BAD_INPUT, ["none.pddl", "out"], "none.pddl:1:1: cannot be read"),
    "no-environment": (ExitCode.BAD_INPUT, ["kitchen99", "out", "--text", "x"], "there is no environment 'kitchen99'"),
    "no-domain": (ExitCode.BAD_INPUT, [PROBLEM, "out", "--domain", "blcks"], "there is no domain 'blcks'"),
    "no-plan-file": (ExitCode.BAD_INPUT, [PROBLEM, "out", "--plan", "none.plan"], "none.plan:1:1: cannot be read"),
    "bad-goal": (ExitCode.BAD_INPUT, [PROBLEM, "out", "--goal", "(on a z)"], 'unknown object "z"'),
    "bad-plan": (
        ExitCode.INVALID_PLAN,
        [PROBLEM, "out", "--plan", BLOCKS / "plans" / "invalid-not-clear.plan"],
        "plan:2:1: step 1, pick-up(a): its precondition (clear a) does not hold",
    ),
    "goal-missed": (
        ExitCode.INVALID_PLAN,
        [PROBLEM, "out", "--plan", BLOCKS / "plans" / "invalid-goal.plan"],
        "at the end the goal",
    ),
    "nothing-named": (ExitCode.USAGE, ["out"], "Missing argument 'PROBLEM'"),
    "nothing-said": (ExitCode.USAGE, ["kitchen1", "out"], "give one of --text, --text-file, --plan and --goal"),
    "text-and-plan": (ExitCode.USAGE, ["kitchen1", "out", "--text", "x", "--plan", PLAN], "give one of --text"),
    "no-json": (ExitCode.BAD_INPUT, [ROOT / "docs" / "cli.json", "out"], "cannot be read"),
    "not-empty": (ExitCode.CANNOT_WRITE, [PROBLEM, BLOCKS], "cannot be written: it is not empty"),
    "a-file": (ExitCode.CANNOT_WRITE, [PROBLEM, PLAN], "cannot be written: it is not a directory"),
}


@pytest.mark.parametrize(("code", "arguments", "message"), CASES.values(), ids=list(CASES))
def test_what_is_wrong_is_told(
    tmd: Tmd, tmp_path: Path, code: ExitCode, arguments: list[str | Path], message: str
) -> None:
    ended = tmd("export", *arguments)
    assert (ended.code, ended.out) == (code, "")
    assert message in ended.err
    assert len(ended.err.splitlines()) <= 4
    assert "Traceback" not in ended.err
    assert not list(tmp_path.iterdir())


ALIKE = """
(define (domain shelves)
  (:requirements :strips :typing)
  (:types place thing)
  (:predicates (at ?x - thing ?p - place) (held ?x - thing) (take ?x - thing){more})
  (:action take
    :parameters (?x - thing ?p - place) :precondition (at ?x ?p) :effect (and (held ?x) (take ?x) (not (at ?x ?p))))
  (:action place
    :parameters (?x - thing ?p - place) :precondition (held ?x) :effect (and (at ?x ?p) (not (held ?x)))))
"""
ALIKE_PROBLEM = """
(define (problem one) (:domain shelves) (:objects place left right - place thing book - thing)
  (:init (at thing left) (at book left)) (:goal (and (at thing right) (at book place))))
"""


def test_one_name_for_two_kinds_is_exported_to_all_formats(tmd: Tmd, tmp_path: Path) -> None:
    pytest.importorskip("up_fast_downward")
    (tmp_path / "domain.pddl").write_text(ALIKE.format(more=""))
    (tmp_path / "p.pddl").write_text(ALIKE_PROBLEM)
    ended = tmd("export", "p.pddl", "out", "--format", "all")
    assert ended.code == ExitCode.OK
    assert re.fullmatch(r"warning: other tools refuse names, which are written differently: .*\n", ended.err)
    assert len(list((tmp_path / "out").iterdir())) == 7


def test_a_format_that_fails_does_not_keep_the_others_back(tmd: Tmd, tmp_path: Path) -> None:
    pytest.importorskip("up_fast_downward")
    (tmp_path / "domain.pddl").write_text(ALIKE.format(more=""))
    (tmp_path / "p.pddl").write_text(ALIKE_PROBLEM)
    assert tmd("export", "p.pddl", "plan", "--format", "ipc").code == ExitCode.OK
    plan = ("--plan", "plan/plan.plan")
    ended = tmd("export", "p.pddl", "out", "--format", "sas,adl,bt", *plan, before=HIDE)
    assert ended.code == ExitCode.MISSING_TOOL
    assert {path.split("/")[1] for path in ended.out.split()} == {"adl", "bt"}
    assert sorted(ended.out.split()) == sorted(f"out/{path}" for path in found(tmp_path / "out"))
    assert re.search(r"^not written: sas: .*\n\Z", ended.err, re.MULTILINE)
    only = tmd("export", "p.pddl", "two", "--format", "sas", *plan, before=HIDE)
    assert (only.code, only.out, (tmp_path / "two").exists()) == (ExitCode.MISSING_TOOL, "", False)


def test_an_exported_plan_is_a_plan_for_the_environment(tmd: Tmd, tmp_path: Path) -> None:
    goal = ("--goal", "(at key1 table1 on)", "--planner", "in-process")
    assert tmd("export", "study1", "s", *goal).code == ExitCode.OK
    ended = tmd("export", "study1", "out", "--plan", "s/plan.plan")
    assert (ended.code, ended.err) == (ExitCode.OK, "")
    assert "(grasp key1 desk1_drawer in)" in found(tmp_path / "out")["plan.plan"]
    file = ROOT / "problems" / "03_drawer" / "environments" / "study1.yaml"
    for environment in ("study1", file):
        checked = tmd("validate", "03_drawer", environment, "s/plan.plan")
        assert checked.out == "valid: 5 instructions, cost 5\n"
    (tmp_path / "s" / "plan.plan").write_text("(grasp key1 desk1_drawer in)\n")
    assert tmd("validate", "03_drawer", "study1", "s/plan.plan").code == ExitCode.INVALID_PLAN
    assert tmd("validate", "03_drawer", "study9", "s/plan.plan").code == ExitCode.BAD_INPUT


def test_plans_of_pddl_environments(tmd: Tmd, tmp_path: Path) -> None:
    (tmp_path / "b.plan").write_text("(pick_up red_block)\n(stack red_block green_block)\n")
    assert tmd("validate", "01_blocks", "yard1", "b.plan").out == "valid: 2 instructions, cost 2\n"
    file = ROOT / "problems" / "01_blocks" / "environments" / "yard1.pddl"
    ended = run_tmd(("export", file, "out", "--text", "Put the red block on the green block."), tmp_path)
    assert (ended.code, ended.err) == (ExitCode.OK, "")
    assert "(:goal (on red_block green_block))" in found(tmp_path / "out")["problem.pddl"]


def test_no_plan(tmd: Tmd, tmp_path: Path) -> None:
    ended = tmd("export", PROBLEM, "out", "--goal", "(and (on a b) (on b a))")
    assert (ended.code, ended.out) == (ExitCode.UNREACHABLE, "")
    assert re.fullmatch(r"no plan: .+\n", ended.err)
    assert not list(tmp_path.iterdir())


def test_overwriting_keeps_other_files(tmd: Tmd, tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    ended = tmd("export", PROBLEM, ".", "--plan", PLAN, "--overwrite")
    assert ended.code == ExitCode.OK
    assert set(found(tmp_path)) == {"mine.txt", "domain.pddl", "problem.pddl", "plan.plan"}


def test_an_overlapping_plan_is_taken_with_a_warning(tmd: Tmd, tmp_path: Path) -> None:
    lines = [line for line in PLAN.read_text().splitlines() if line.startswith("(")]
    (tmp_path / "t.plan").write_text("".join(f"{number}.0: {line} [3.0]\n" for number, line in enumerate(lines)))
    ended = tmd("validate", DOMAIN, PROBLEM, "t.plan")
    assert (ended.code, ended.out) == (ExitCode.OK, "valid: 6 instructions, cost 6\n")
    assert ended.err == "warning: t.plan:2:6: instructions overlap in time; they are taken one after the other\n"


def test_every_command_reads_what_planners_print(tmd: Tmd, tmp_path: Path) -> None:
    steps = [line.strip("()") for line in PLAN.read_text().splitlines() if line.startswith("(")]
    for name, log in {
        "fd.log": "".join(
            ["[t=0.0s] Solution found!\n", *(f"{step} (1)\n" for step in steps), "Plan length: 6 step(s).\n"]
        ),
        "api.json": json.dumps({"result": {"plan": [{"name": f"({step})"} for step in steps]}}),
    }.items():
        (tmp_path / name).write_text(log)
        assert tmd("validate", DOMAIN, PROBLEM, name).out == "valid: 6 instructions, cost 6\n"
        assert tmd("view", name, "--problem", PROBLEM).code == ExitCode.OK
        assert tmd("export", PROBLEM, name.partition(".")[0], "--plan", name, "--format", "ipc").code == ExitCode.OK
    ended = tmd("export", PROBLEM, "none", "--plan", DOMAIN)
    assert (ended.code, ended.err.count("error: ")) == (ExitCode.BAD_INPUT, 1)
