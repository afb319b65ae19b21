"""The goal of a demonstration: it is read in its environment, and its faults have their place in the line."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from experiments.check_demonstrations import check
from tmd.diagnostics import TmdError
from tmd.pddl.model import Problem
from tmd.pddl.reading.reader import read_problem
from tmd.world.corpus import replay
from tmd.world.demonstration import Demonstration, check_goal, demonstration_line, read_demonstrations, read_goal
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).parents[2]
BLOCKS = ROOT / "problems" / "01_blocks"
TEXT = "Put the red block on the green block."
PLAN = ["pick_up(red_block)", "stack(red_block, green_block)"]
REACHED = "(and (on red_block green_block) (exists (?x - block) (on_table ?x)))"


def line(goal: str | None, **changes: str) -> str:
    said: dict[str, Any] = {"id": "d1", "task": "stacking", "environment": "yard1", "text": TEXT}
    said["segments"] = [{"text": TEXT, "instructions": PLAN, "goal": "(not this)"}]
    return json.dumps(said | ({} if goal is None else {"goal": goal}) | changes)


@pytest.fixture(scope="module")
def yard() -> Problem:
    return read_problem(BLOCKS / "environments" / "yard1.pddl", DomainFolder(ROOT / "domains" / "01_blocks").domain)


def one(tmp_path: Path, text: str) -> Demonstration:
    file = tmp_path / "demonstrations.jsonl"
    file.write_text("\n" + text + "\n", encoding="utf-8")
    return read_demonstrations(file)[0]


def fault(demonstration: Demonstration, problem: Problem) -> TmdError:
    with pytest.raises(TmdError) as caught:
        replay(demonstration, problem)
    return caught.value


def test_a_goal_that_is_reached(tmp_path: Path, yard: Problem) -> None:
    found = one(tmp_path, line(REACHED))
    last = replay(found, yard)[-1]
    check_goal(found, yard, last)
    assert one(tmp_path, demonstration_line(found)) == found
    assert read_goal(one(tmp_path, line(None)), yard) is None


@pytest.mark.parametrize(
    ("goal", "at", "code", "said"),
    [
        ("(and (on red_block green_blck))", "green_blck", "unknown-object", 'did you mean "green_block"'),
        ("(und (on red_block green_block))", "(on", "not-supported", "nested terms"),
        ("(and (clear red_block)\n\t(onn red_block green_block))", "onn", "unknown-predicate", 'mean "on"'),
        ("(on red_block)", "(on", "wrong-arity", "takes 2"),
        ("(on red_block ?x)", "?x", "free-variable", "?x"),
        ("(and (on red_block green_block)", "(and", "unclosed-parenthesis", "never closed"),
        ("(clear red_block) (hand_empty)", "(clear", "syntax", "a goal is one condition"),
        ("", "", "syntax", "a goal is one condition"),
        (
            "; \u2028 😀 ü\n(on green_block red_block)",
            ";",
            "goal-not-reached",
            "(on green_block red_block) does not hold",
        ),
        ("; 😀 ü\n(on green_block red_blck)", "red_blck", "unknown-object", "red_blck"),
    ],
)
@pytest.mark.parametrize("plain", [True, False], ids=["as it is", "escaped"])
def test_a_fault_has_its_place_in_the_line(
    tmp_path: Path, yard: Problem, goal: str, at: str, code: str, said: str, plain: bool
) -> None:
    text = json.dumps(json.loads(line(goal)), ensure_ascii=not plain)
    found = fault(one(tmp_path, text), yard)
    assert found.code == code
    assert said in str(found)
    assert "the goal of 'd1'" in found.message
    assert found.location is not None
    assert (Path(found.location.file).name, found.location.line) == ("demonstrations.jsonl", 2)
    assert found.source == text
    begun = text.rindex('"goal": "') + len('"goal": "')
    assert found.location.column - 1 == text.index(at, begun)


def test_a_demonstration_that_is_in_no_file_has_no_place(tmp_path: Path, yard: Problem) -> None:
    found = one(tmp_path, line("(on red_block)"))
    assert fault(replace(found, location=None), yard).location is None


@pytest.mark.parametrize("depth", [50, 20_000])
def test_a_goal_may_nest_deeply(tmp_path: Path, yard: Problem, depth: int) -> None:
    found = one(tmp_path, line("(and " * depth + "(on green_block red_block)" + ")" * depth))
    assert fault(found, yard).code == ("goal-not-reached" if depth == 50 else "nested-too-deeply")


def test_all_corpora_are_played_those_with_pddl_environments_too(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(BLOCKS / "environments", tmp_path / "01_blocks" / "environments")
    corpus = tmp_path / "01_blocks" / "stacking" / "demonstrations.jsonl"
    corpus.parent.mkdir()
    lines = [line(REACHED), line(None, id="d2"), line("(clear green_block)", id="d3"), line("(on", id="d4")]
    corpus.write_text("\n".join([*lines, line(REACHED, id="d5", environment="yard7")]) + "\n")
    assert check(corpus) == 3
    said = capsys.readouterr().out
    assert "4 demonstrations" not in said
    assert ": d3: " in said
    assert "(clear green_block) does not hold at the end" in said
    assert "never closed" in said
    assert "yard7" in said
    assert "5 demonstrations, 3 fail" in said
