"""Goals of demonstrations: each fault has its kind and its place in the line."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from tmd.check.checker import Checker
from tmd.check.diagnostic import SEVERITY, Diagnostic, Severity

ROOT = Path(__file__).resolve().parents[2]
TEXT = "Put the red block on the green block."
PLAN = ["pick_up(red_block)", "stack(red_block, green_block)"]


def found(tmp_path: Path, *goals: str | None, domain: str = "01_blocks", **changes: object) -> list[Diagnostic]:
    """What is told of a corpus that has one demonstration for each goal."""
    problems, place = tmp_path / "problems", f"domains/{domain}"
    shutil.copytree(ROOT / place, tmp_path / place)
    shutil.copytree(ROOT / "problems" / domain / "environments", problems / domain / "environments")
    file = problems / domain / "shown" / "demonstrations.jsonl"
    file.parent.mkdir()
    said = {"task": "shown", "environment": "yard1", "text": TEXT, "segments": [{"text": TEXT, "instructions": PLAN}]}
    lines = [{"id": f"d{n}", **said, **changes, "goal": goal} for n, goal in enumerate(goals)]
    file.write_text("".join(json.dumps(line) + "\n" for line in lines))
    checker = Checker(tmp_path / "domains", None, problems)
    checker.check(file)
    checker.finish()
    return checker.findings.sorted()


def test_goals_that_are_reached_and_missing_ones_are_no_faults(tmp_path: Path) -> None:
    reached = ["(on red_block green_block)", "(exists (?x - block) (and (on ?x green_block) (clear ?x)))", None]
    assert found(tmp_path, *reached) == []


@pytest.mark.parametrize(
    ("goal", "code", "at"),
    [
        ("(on green_block red_block)", "goal-not-reached", 0),
        ("(and (on red_block green_block)", "unclosed-parenthesis", 0),
        ("(and (on red_block green_block)\n (onn red_block green_block))", "unknown-predicate", 35),
        ("(on red_block purple_block)", "unknown-object", 14),
        ("(on red_block)", "wrong-arity", 0),
        ("red_block", "syntax", 0),
        ("(exists (?x - blok) (on ?x green_block))", "unknown-type", 14),
        ("(forall (?x - block) (on ?x ?y))", "free-variable", 28),
    ],
)
def test_a_fault_of_a_goal_has_its_kind_and_place(tmp_path: Path, goal: str, code: str, at: int) -> None:
    (fault,) = found(tmp_path, "(clear red_block)", goal)
    assert fault.code == code
    assert SEVERITY[code] is Severity.ERROR
    assert fault.source is not None
    assert fault.location.line == 2
    assert fault.location.column == fault.source.index('"goal": "') + len('"goal": "') + at + 1
    assert "the goal of 'd1'" in fault.message


def test_every_goal_of_a_file_is_looked_at(tmp_path: Path) -> None:
    told = found(tmp_path, "(on", "(hand_empty)", "(clear green_block)")
    assert [(fault.location.line, fault.code) for fault in told] == [
        (1, "unclosed-parenthesis"),
        (3, "goal-not-reached"),
    ]


def test_what_cannot_be_executed_is_told_before_its_goal(tmp_path: Path) -> None:
    segments = [{"text": TEXT, "instructions": PLAN[1:]}]
    assert [fault.code for fault in found(tmp_path, "(clear green_block)", segments=segments)] == ["not-executable"]


def test_a_plan_that_was_corrected_need_not_reach_the_goal(tmp_path: Path) -> None:
    assert found(tmp_path, "(on red_block green_block)", proposed=PLAN[:1]) == []


def test_goals_in_environments_of_yaml(tmp_path: Path) -> None:
    plan = ["moveto(cup1)", "grasp(cup1)", "moveto(shelf1)", "keep(cup1, shelf1, on)"]
    said: dict[str, object] = {"environment": "corner1", "segments": [{"text": TEXT, "instructions": plan}]}
    goals = ("(at cup1 shelf1 on)", "(at cup1 shelf1 under)", "(exists (?x - item) (holding pr2 ?x))")
    told = found(tmp_path, *goals, domain="02_table", **said)
    assert [fault.code for fault in told] == ["unknown-object", "goal-not-reached"]
