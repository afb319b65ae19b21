"""Sentence tests: their files, what becomes of them, and that the model that ships does not get worse at them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.bundled import kit
from tests.cli.conftest import run_tmd
from tmd.diagnostics import ExitCode, TmdError
from tmd.evaluation.sentence_tests import Outcome, SentenceResult, judge, report, summary
from tmd.pddl.reading.reader import with_goal
from tmd.world.sentence_file import SentenceTest, read_sentences

ROOT = Path(__file__).resolve().parents[1]
FILES = sorted(ROOT.glob("problems/*/*.sentences.jsonl"))
FLOORS = {
    "01_blocks": (0, 1),
    "02_table": (3, 0),
    "03_drawer": (3, 0),
    "04_tea": (3, 1),
    "lab_bench": (10, 3),
    "kitchen": (8, 3),
    "living_room": (8, 1),
}
"""For each domain how many are right at least, and how many impossible ones are refused at least."""
EVERY = {"kitchen": 6, "living_room": 6}
"""Of the long files, every so many lines."""
HAND = '{"id": "%s", "domain": "02_table", "environment": "corner1", "text": "%s", "goal": %s}\n'


def result(test: SentenceTest) -> SentenceResult:
    own = kit(test.domain)
    return judge(test, own.ground(test.text, test.environment), own.problem(test.environment))


def test_every_domain_of_the_ladder_has_some() -> None:
    assert {path.parent.name for path in FILES} == set(FLOORS)


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.parent.name)
def test_every_goal_can_be_read_in_its_environment(path: Path) -> None:
    tests = read_sentences(path)
    assert tests
    assert {test.domain for test in tests} == {path.parent.name}
    for test in tests:
        problem = kit(test.domain).problem(test.environment)
        assert test.text.strip()
        assert test.kinds
        if test.goal is not None:
            assert with_goal(problem, test.goal, "goal").goal is not None


@pytest.mark.parametrize("domain", sorted(FLOORS))
def test_the_model_that_ships_is_no_worse(domain: str, learned: Path) -> None:
    tests = [test for path in FILES if path.parent.name == domain for test in read_sentences(path)]
    counts = summary(result(test) for test in tests[:: EVERY.get(domain, 1)])
    right, refused = FLOORS[domain]
    assert counts.right >= right, counts
    assert counts.impossible_refused >= refused, counts


# ---------------------------------------------------------------- reading


GOOD = HAND % ("a", "Hand me the book.", '"(holding pr2 book1)"')


@pytest.mark.parametrize(
    ("line", "column", "message"),
    [
        ("{", 2, "this is not valid JSON"),
        ("[1]", 1, "this is not a sentence test: should be a JSON object"),
        ('{"id": "b"}', 1, "this is not a sentence test: domain: the key is missing"),
        (HAND % ("b", "Take it.", "7"), 1, "this is not a sentence test: goal: should be text"),
        (
            GOOD.replace(', "goal": "(holding pr2 book1)"', ""),
            1,
            "this is not a sentence test: goal: the key is missing",
        ),
        (GOOD, 1, "the id 'a' stands in this file twice"),
        ("[" * 100_000, 1, "too many levels"),
    ],
)
def test_a_fault_of_a_file_has_its_place(tmp_path: Path, line: str, column: int, message: str) -> None:
    path = tmp_path / "x.sentences.jsonl"
    path.write_text(f"{GOOD}\n{line}")
    with pytest.raises(TmdError, match=message) as raised:
        read_sentences(path)
    place = raised.value.location
    assert place is not None
    assert (place.file, place.line, place.column) == (str(path), 3, column)


def test_a_file_is_read_line_by_line(tmp_path: Path) -> None:
    path = tmp_path / "x.sentences.jsonl"
    path.write_text(f"\n{GOOD}\n" + (HAND % ("b", "Fly.", "null")).replace("}", ', "kind": ["easy", 3], "note": 1}'))
    first, second = read_sentences(path)
    assert (first.id, first.goal, first.kinds) == ("a", "(holding pr2 book1)", ())
    assert (second.id, second.goal, second.kinds) == ("b", None, ("easy",))
    assert first.location is not None
    assert first.location.line == 2
    with pytest.raises(TmdError):
        read_sentences(tmp_path / "none")


# ---------------------------------------------------------------- judging


def _test(text: str, goal: str | None) -> SentenceTest:
    return SentenceTest(id="a", domain="02_table", environment="corner1", text=text, goal=goal)


@pytest.mark.parametrize(
    ("text", "goal", "outcome"),
    [
        ("Hand me the book.", "(holding pr2 book1)", Outcome.RIGHT),
        ("Hand me the book.", "(holding pr2 cup1)", Outcome.WRONG),
        ("Hand me the book.", None, Outcome.IMPOSSIBLE_PLANNED),
        ("Take the unicorn.", None, Outcome.IMPOSSIBLE_REFUSED),
        ("Take the unicorn.", "(holding pr2 book1)", Outcome.REFUSED),
        ("Hmm!", "(holding pr2 book1)", Outcome.REFUSED),
    ],
)
def test_a_test_is_judged_by_the_state_at_the_end(text: str, goal: str | None, outcome: Outcome) -> None:
    found = result(_test(text, goal))
    assert found.outcome is outcome
    assert found.outcome.passed == (outcome in (Outcome.RIGHT, Outcome.IMPOSSIBLE_REFUSED))
    assert bool(found.plan) == (outcome in (Outcome.RIGHT, Outcome.WRONG, Outcome.IMPOSSIBLE_PLANNED))
    assert bool(found.reason) != (outcome is Outcome.RIGHT)
    assert report([found], "rules").to_value()["cases"][0]["outcome"] == outcome.value


def test_a_goal_that_is_none_is_told_with_the_id() -> None:
    with pytest.raises(TmdError, match="the goal of 'a': "):
        result(_test("Hand me the book.", "(holdign pr2 book1)"))


def test_the_summary_counts() -> None:
    test = _test("", None)
    outcomes = [*Outcome, Outcome.WRONG]
    results = [SentenceResult(test, o, warnings=("w",) if n == 1 else ()) for n, o in enumerate(outcomes)]
    assert summary(results).to_value() == {
        "n": 6, "right": 1, "wrong": 2, "wrong_warned": 1, "refused": 1, "impossible": 2, "impossible_refused": 1,
    }  # fmt: skip
    assert set(summary([]).to_value().values()) == {0}


# ---------------------------------------------------------------- the command


@pytest.mark.parametrize(("goal", "code"), [('"(holding pr2 book1)"', 0), ('"(holding pr2 cup1)"', 1), ("null", 1)])
def test_tmd_test(tmp_path: Path, goal: str, code: int) -> None:
    path = tmp_path / "x.sentences.jsonl"
    path.write_text((HAND % ("a", "Hand me the book.", goal)) + (HAND % ("b", "Take the unicorn.", "null")))
    ended = run_tmd(["test", "--cases", path, "--json"], ROOT)
    assert ended.code == code == (ExitCode.OK if code == 0 else ExitCode.TESTS_FAILED)
    told = json.loads(ended.out)
    assert set(told) == {"summary", "kinds", "reader", "cases"}
    assert [case["id"] for case in told["cases"]] == ["a", "b"]
    assert all(set(c) == {"id", "outcome", "plan", "goals", "warnings", "reason"} for c in told["cases"])
    assert told["cases"][0]["plan"] == ["(moveto book1)", "(grasp book1)"]
    assert told["cases"][1]["outcome"] == "impossible_refused"
    assert told["summary"]["n"] == 2


def test_tmd_test_wants_a_domain_or_files() -> None:
    ended = run_tmd(["test"], ROOT)
    assert ended.code == ExitCode.BAD_INPUT
    assert ended.err.startswith("error: name a domain, or files with --cases\nhint: ")
