"""Output of the commands: the documented JSON, the same bytes every time, nothing half-written."""

from __future__ import annotations

import json
import os
import pty
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.conftest import BLOCKS, ROOT, Tmd
from tmd.diagnostics import ExitCode
from tmd.evaluation.models.model import MODELS
from tmd.inference.config import PRESETS

DOMAIN, PROBLEM = BLOCKS / "domain.pddl", BLOCKS / "p01.pddl"
TEXT = "Fill the pot with water."
GROUND_KEYS = [
    "text", "domain", "environment", "clauses", "skipped", "unseen_verbs", "unknown_nouns", "plans", "refusals",
    "refused", "warnings", "environment_file", "made_with",
]  # fmt: skip
PLAN_KEYS = ["steps", "energy", "factors", "valid", "cost", "why_not_first", "choices", "goal", "goals"]


def test_ground_json(tmd: Tmd, environment: Path) -> None:
    ended = tmd("ground", "--environment", environment, "--text", TEXT, "--top", "2", "--json")
    assert ended.code == ExitCode.OK
    told = json.loads(ended.out)
    assert list(told) == GROUND_KEYS
    assert (told["text"], told["domain"], told["environment"]) == (TEXT, "kitchen", "mine")
    assert [clause["verb"] for clause in told["clauses"]] == ["fill"]
    assert 1 <= len(told["plans"]) <= 2
    for place, plan in enumerate(told["plans"]):
        assert list(plan) == PLAN_KEYS
        assert plan["valid"] is True
        assert (plan["why_not_first"] is None) == (place == 0)
        assert plan["energy"] == pytest.approx(sum(plan["factors"].values()), abs=1e-5)
        for step in plan["steps"]:
            assert list(step) == ["action", "args", "clause", "latent"]
            assert step["clause"] == 0
    energies = [plan["energy"] for plan in told["plans"]]
    assert energies == sorted(energies)


def test_a_grounded_plan_passes_the_validator(tmd: Tmd, tmp_path: Path, environment: Path) -> None:
    """The plan of one command is executed by another, from the environment compiled by a third."""
    told = json.loads(tmd("ground", "--environment", environment, "--text", TEXT, "--json").out)
    problem, plan = tmp_path / "mine.pddl", tmp_path / "plan"
    assert tmd("compile", environment, "--goal", "(contains pot1 water)", "--output", problem).code == ExitCode.OK
    steps = told["plans"][0]["steps"]
    plan.write_text("".join(f"({' '.join([s['action'], *s['args']])})\n" for s in steps))
    ended = tmd("validate", "kitchen", problem, plan, "--json")
    assert ended.code == ExitCode.OK, ended
    assert json.loads(ended.out)["cost"] == told["plans"][0]["cost"]
    plan.write_text(plan.read_text().splitlines()[-1] + "\n")
    assert tmd("validate", "kitchen", problem, plan).code == ExitCode.INVALID_PLAN


def test_a_pddl_problem_is_an_environment(tmd: Tmd, tmp_path: Path, environment: Path) -> None:
    problem = tmp_path / "mine.pddl"
    tmd("compile", environment, "--output", problem)
    ended = tmd("ground", "--environment", problem, "--domain", "kitchen", "--text", TEXT, "--json")
    assert ended.code == ExitCode.OK
    told, theirs = (
        json.loads(out)
        for out in (ended.out, tmd("ground", "--environment", environment, "--text", TEXT, "--json").out)
    )
    assert told.pop("environment_file") == str(problem) and theirs.pop("environment_file") == str(environment)
    assert told == theirs


def test_the_reference_planner_finds_plans_of_the_same_cost(tmd: Tmd) -> None:
    costs = {}
    for planner in ("in-process", "fast-downward"):
        told = json.loads(tmd("plan", DOMAIN, PROBLEM, "--planner", planner, "--json").out)
        assert list(told) == ["status", "planner", "plan", "cost", "optimal", "reason"]
        assert (told["status"], told["planner"], told["reason"]) == ("solved", planner, None)
        costs[planner] = (told["cost"], len(told["plan"]))
    assert costs["in-process"] == costs["fast-downward"] == (6, 6)


def test_a_plan_file_passes_the_validator(tmd: Tmd, tmp_path: Path) -> None:
    ended = tmd("plan", DOMAIN, PROBLEM, "--output", "found.plan")
    assert (ended.code, ended.out, ended.err) == (ExitCode.OK, "", "")
    assert tmd("validate", DOMAIN, PROBLEM, tmp_path / "found.plan").out == "valid: 6 instructions, cost 6\n"


def test_validate_json(tmd: Tmd) -> None:
    ended = tmd("validate", DOMAIN, PROBLEM, BLOCKS / "plans" / "invalid-not-clear.plan", "--json")
    told = json.loads(ended.out)
    assert list(told) == ["valid", "status", "step", "line", "instruction", "broken", "reason", "cost"]
    assert told["valid"] is False
    assert (told["status"], told["step"], told["line"]) == ("broken-precondition", 1, 2)
    assert (told["instruction"], told["broken"]) == ("(pick-up a)", "(clear a)")


def test_parse_json(tmd: Tmd) -> None:
    text = "Take the cup and put it in the microwave. Foo, bar."
    told = json.loads(tmd("parse", "--text", text, "--json").out)
    assert list(told) == ["clauses", "skipped"]
    first, second, *_ = told["clauses"]
    assert first == {
        "verb": "take",
        "objects": ["cup"],
        "relations": [],
        "text": "Take the cup",
        "direct": ["cup"],
        "phrases": {"cup": {"definite": True}},
        "span": [0, 12],
    }
    assert (second["verb"], second["objects"]) == ("put", ["it", "microwave"])
    assert second["relations"] == [["in", "it", "microwave"]]
    assert second["antecedents"] == {"it": ["cup"]}
    for piece in (*told["clauses"], *told["skipped"]):
        assert text[piece["span"][0] : piece["span"][1]] == piece["text"]


def test_parse_tells_constraints_and_conditions(tmd: Tmd) -> None:
    text = "If the door is not open, open it. Do not take the cup. Leave the key where it is."
    told = json.loads(tmd("parse", "--text", text, "--json").out)
    assert list(told) == ["clauses", "constraints", "skipped"]
    assert [(c["verb"], c["mood"]) for c in told["constraints"]] == [("take", "avoid")]
    assert text[slice(*told["constraints"][0]["span"])] == told["constraints"][0]["text"]
    assert tmd("parse", "--text", text).out == (
        "clauses\n"
        "  1. (open, [it])   it = door; if the door is not open: not (be, [door]; state: open)\n"
        "  2. (leave, [key])   to be kept\n"
        "constraints\n"
        "  not to be done: (take, [cup])\n"
    )


@pytest.mark.parametrize(
    "arguments",
    [
        ["parse", "--json", "--text", "take the cup, fill it, put it on the stove"],
        ["compile", ROOT / "problems" / "kitchen" / "environments" / "kitchen1.yaml"],
        ["plan", DOMAIN, PROBLEM, "--json"],
        ["ground", "--environment", "pantry1", "--text", "fill the kettle and put the tea bag in the cup", "--json"],
    ],
    ids=lambda arguments: arguments[0],
)
def test_the_same_bytes_every_time(tmd: Tmd, arguments: list[str | Path]) -> None:
    runs = [tmd(*arguments, env={"PYTHONHASHSEED": seed}) for seed in ("1", "2")]
    assert runs[0] == runs[1]
    assert runs[0].code == ExitCode.OK


@pytest.mark.parametrize("encoding", ["utf-8", "ascii", "latin-1"])
def test_output_is_utf8_whatever_the_terminal_says(tmd: Tmd, encoding: str) -> None:
    ended = tmd("parse", "--text", "take the café", "--json", env={"PYTHONIOENCODING": encoding})
    assert "take the café" in ended.out


def test_text_from_a_file_and_from_standard_input(tmd: Tmd, tmp_path: Path) -> None:
    (tmp_path / "said.txt").write_bytes(b"\xef\xbb\xbftake the cup\r\n")
    wanted = tmd("parse", "--text", "take the cup\r\n", "--json")
    assert wanted.code == ExitCode.OK
    assert tmd("parse", "--text-file", "said.txt", "--json") == wanted
    assert tmd("parse", "--text-file", "-", "--json", stdin=b"take the cup\r\n") == wanted


def test_text_that_is_not_utf8(tmd: Tmd) -> None:
    ended = tmd("parse", "--text-file", "-", stdin=b"take \xff cup")
    assert ended.code == ExitCode.BAD_INPUT
    assert ended.err == "error: standard input: byte 6 is not UTF-8\nhint: send UTF-8\n"


def test_ten_thousand_words(tmd: Tmd, environment: Path) -> None:
    text = b"boil water in the pot. " * 2000
    assert tmd("parse", "--text-file", "-", "--json", stdin=text).code == ExitCode.OK
    ended = tmd("ground", "--environment", environment, "--text-file", "-", stdin=text)
    assert (ended.code, ended.out) == (ExitCode.BAD_INPUT, "")
    assert ended.err.startswith("error: the text has 10,000 words; at most 1,000 ")


def test_a_million_characters(tmd: Tmd) -> None:
    ended = tmd("parse", "--text-file", "-", stdin=b"a" * 1_000_001)
    assert ended.code == ExitCode.BAD_INPUT
    assert "more than 1,000,000" in ended.err


def test_what_is_unknown_is_told_by_models_without_goals(tmd: Tmd, environment: Path) -> None:
    text = f"{TEXT} Flurble it. Put the zebra in the sink."
    ended = tmd("ground", "--environment", environment, "--model", "policy", "--text", text, "--json")
    told = json.loads(ended.out)
    assert told["unseen_verbs"] == ["flurble"]
    assert told["unknown_nouns"] == ["zebra"]
    assert "warning: no demonstration has the verb 'flurble'" in ended.err
    assert "warning: nothing here is called 'zebra'" in ended.err
    assert ended.err.splitlines() == [f"warning: {warning}" for warning in told["warnings"]]


@pytest.mark.parametrize("options", [["--guess"], ["--model", "policy"]], ids=["guess", "policy"])
def test_what_is_only_alike_in_meaning_is_told(tmd: Tmd, environment: Path, options: list[str]) -> None:
    ended = tmd("ground", "--environment", environment, "--text", "Put the cauldron in the sink.", *options)
    said = re.search(
        "nothing here is called 'cauldron'; by likeness of meaning it was taken for ([a-z0-9_]+)", ended.err
    )
    assert said and said[1] in ended.out
    assert "likeness" not in tmd("ground", "--environment", environment, "--text", "Put the pot in the sink.").err


def test_a_no_is_json_too(tmd: Tmd, environment: Path) -> None:
    ended = tmd("ground", "--environment", environment, "--text", "Flurble the pot.", "--json")
    assert ended.code == ExitCode.NOT_GROUNDED
    assert json.loads(ended.out)["plans"] == []


def test_output_is_not_half_written(tmd: Tmd, tmp_path: Path, environment: Path) -> None:
    target = tmp_path / "out.pddl"
    target.write_text("before")
    ended = tmd("compile", environment, "--goal", "(nonsense)", "--output", target)
    assert ended.code == ExitCode.BAD_INPUT
    assert target.read_text() == "before"


def test_domains_of_ones_own(tmd: Tmd, tmp_path: Path) -> None:
    """A folder with a plain domain.pddl is a domain; it has no demonstrations yet, and models that need them say so."""
    folder = tmp_path / "own" / "blocks"
    folder.mkdir(parents=True)
    (folder / "domain.pddl").write_bytes(DOMAIN.read_bytes())
    roots = ("--domains", tmp_path / "own", "--problems", tmp_path)
    assert tmd(*roots, "plan", "blocks", PROBLEM).code == ExitCode.OK
    asked = (*roots, "ground", "--environment", PROBLEM, "--domain", "blocks", "--text", "take block a")
    ended = tmd(*asked, "--model", "policy")
    assert ended.code == ExitCode.NOT_GROUNDED
    assert "the domain has no demonstrations" in ended.err
    ended = tmd(*asked)
    assert ended.code == ExitCode.NOT_GROUNDED
    assert ended.err.startswith("no plan: clause 1: ")


CLOSED = {
    "help": (["--help"], ExitCode.OK),
    "version": (["--version"], ExitCode.OK),
    "wrong": (["bogus"], ExitCode.USAGE),
    "parse": (["parse", "--text", "Boil water.", "--json"], ExitCode.OK),
    "standard input": (["parse", "--text-file", "-"], ExitCode.BAD_INPUT),
    "view": (["view", "-"], ExitCode.BAD_INPUT),
    "check": (["check", BLOCKS], ExitCode.OK),
}


@pytest.mark.parametrize("closed", [(1,), (0, 1, 2)], ids=str)
@pytest.mark.parametrize("command", CLOSED)
def test_closed_streams_are_as_good_as_nothing(tmp_path: Path, command: str, closed: tuple[int, ...]) -> None:
    arguments, code = CLOSED[command]
    redirections = " ".join(f"{number}{'<' if number == 0 else '>'}&-" for number in closed)
    line = f'"$@" {redirections}'
    done = subprocess.run(
        ["sh", "-c", line, "sh", sys.executable, "-m", "tmd", *map(str, arguments)],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        input=b"",
        capture_output=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == code
    told = (done.stdout + done.stderr).decode()
    assert "Traceback" not in told and "internal error" not in told


def test_an_experiment_shows_its_bar_on_a_terminal(tmp_path: Path) -> None:
    """With FORCE_COLOR every stream counts as one."""
    command = [sys.executable, "-m", "tmd", "experiment", "--task", "tea", "--domain", "04_tea", "--models", "empty"]
    done = subprocess.run(
        [*command, "--out", str(tmp_path / "run"), "--jobs", "1"],
        env={**os.environ, "FORCE_COLOR": "1"},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0
    assert "3/3" in done.stderr


def on_terminal(*arguments: str, **environ: str) -> str:
    """What a command shows on a terminal."""
    leader, follower = pty.openpty()
    environ = {**os.environ, "TERM": "xterm", "NO_COLOR": "", **environ}
    command = [sys.executable, "-m", "tmd", *arguments]
    subprocess.run(command, env=environ, stdout=follower, stderr=follower, timeout=60, check=False)
    shown = os.read(leader, 4_000).decode()
    os.close(follower)
    os.close(leader)
    return shown


def test_a_terminal_shows_colours_and_a_pipe_gets_none(tmd: Tmd) -> None:
    arguments = "ground", "corner2", "Put the cup on the first table."
    shown = on_terminal(*arguments)
    assert "\033[1mgoals\033[0m" in shown and "\033[32m\033[1mvalid\033[0m" in shown
    assert re.sub(r"\033\[\d+m", "", shown).replace("\r", "") == tmd(*arguments).out
    assert "\033[31m\033[1merror\033[0m: " in on_terminal("grond")
    for plain in ({"NO_COLOR": "1"}, {"TERM": "dumb"}):
        assert "\033" not in on_terminal("grond", **plain)
    assert "\033" not in tmd("grond").err


def test_a_list_names_what_ground_takes(tmd: Tmd) -> None:
    listed = tmd("list")
    assert listed.code == ExitCode.OK
    assert "kitchen\n  environments: kitchen1, kitchen2, " in listed.out
    *_, models, rows, planners = listed.out.splitlines()
    assert models == f"models: {', '.join(PRESETS)}"
    assert rows == f"models of experiments: {', '.join(MODELS)}"
    assert planners == "planners: auto, fast-downward, kairos, in-process, up:ENGINE"
    help_of_plan = " ".join(tmd("plan", "--help").out.split())
    assert all(name in help_of_plan for name in planners.removeprefix("planners: ").split(", "))


def test_a_misspelt_command_gets_the_nearest(tmd: Tmd) -> None:
    ended = tmd("grond", "--environment", "kitchen1")
    assert (ended.code, ended.err) == (
        ExitCode.USAGE,
        "error: there is no command 'grond': did you mean \"ground\"?\nhint: see tmd --help\n",
    )


def test_a_shell_gets_completions(tmd: Tmd, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = {"_TMD_COMPLETE": "bash_complete", "COMP_WORDS": "tmd pl", "COMP_CWORD": "1"}
    for name, value in asked.items():
        monkeypatch.setenv(name, value)
    assert tmd().out == "plain,plan\n"


def test_the_page_has_the_line_for_each_shell(tmd: Tmd) -> None:
    page = (ROOT / "docs" / "cli.md").read_text(encoding="utf-8")
    shells = re.findall(r"_TMD_COMPLETE=(\w+)_source tmd", page)
    assert shells == ["bash", "zsh", "fish"]
    for shell in shells:
        ended = tmd(env={"_TMD_COMPLETE": f"{shell}_source"})
        assert ended.code == ExitCode.OK and f"_TMD_COMPLETE={shell}_complete" in ended.out
