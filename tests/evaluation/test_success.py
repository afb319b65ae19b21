"""Success: whether the goal of a text holds at the end of a prediction, from one prediction to the page of a run."""

from __future__ import annotations

import io
import json
import re
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console

from tmd.diagnostics import TmdError
from tmd.evaluation.metrics import Scorer
from tmd.evaluation.report.predictions import best_and_worst
from tmd.evaluation.report.report import print_table, write_report
from tmd.evaluation.runs.config import ExperimentConfig
from tmd.evaluation.runs.dataset import BundledData, _read_once
from tmd.evaluation.runs.experiment import run
from tmd.evaluation.runs.finished_run import read_run
from tmd.evaluation.summary import compare, summarise
from tmd.pddl.forced_execution import rollout
from tmd.pddl.model import Formula, Problem
from tmd.pddl.plan_file import parse_instruction
from tmd.pddl.reading.reader import read_problem, with_goal
from tmd.pddl.semantics import holds
from tmd.records.metrics import TESTED, Metrics
from tmd.records.prediction import PredictionRecord
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).parents[2]
BLOCKS = ROOT / "problems" / "01_blocks"
TEXT = "Take the red block."
MODELS = ("empty", "chance")
HELD, AT_FIRST = "(exists (?x - block) (holding ?x))", "(hand_empty)"


@pytest.fixture(scope="module")
def yard() -> Problem:
    return read_problem(BLOCKS / "environments" / "yard1.pddl", DomainFolder(ROOT / "domains" / "01_blocks").domain)


def corpus(directory: Path, *goals: str | None) -> Path:
    """Problems with a demonstration for each goal in each of two environments."""
    shutil.copytree(BLOCKS / "environments", directory / "01_blocks" / "environments")
    segments = [{"text": "Take the red block", "instructions": ["pick_up(red_block)"]}]
    lines = []
    for place in ("yard1", "yard2"):
        steps = segments if place == "yard1" else [{**segments[0], "instructions": []}]
        for number, goal in enumerate(goals, 1):
            said: dict[str, Any] = {
                "id": f"shown-{place}-{number}",
                "task": "shown",
                "environment": place,
                "text": TEXT,
            }
            lines.append(said | {"segments": steps, "goal": goal})
    (directory / "01_blocks" / "shown").mkdir()
    text = "".join(json.dumps(line) + "\n" for line in lines)
    (directory / "01_blocks" / "shown" / "demonstrations.jsonl").write_text(text)
    return directory


def config(problems: Path, out: Path) -> ExperimentConfig:
    return ExperimentConfig("all", out, domain="01_blocks", domains=ROOT / "domains", problems=problems, models=MODELS)


@pytest.fixture
def mixed(tmp_path: Path) -> ExperimentConfig:
    """A run whose examples have goals that hold at first, that do not, and none."""
    _read_once.cache_clear()
    return config(corpus(tmp_path / "problems", AT_FIRST, HELD, None), tmp_path / "out")


def lines_of(out: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in (out / "predictions.jsonl").read_text().splitlines()]


def condition(text: str, problem: Problem) -> Formula:
    return with_goal(problem, text).goal


@pytest.mark.parametrize(
    ("plan", "goal", "reached"),
    [
        ([], AT_FIRST, True),
        ([], HELD, False),
        (["pick_up(red_block)"], HELD, True),
        (["pick_up(red_block)", "put_down(red_block)"], HELD, False),
        # by force, as END: nothing is held, and still the block is stacked
        (["stack(red_block, green_block)"], "(on red_block green_block)", True),
        (["fly(red_block)", "pick_up(red_block)", "pick_up(nobody)"], "(holding red_block)", True),
        (["pick_up(red_block)"], "(and (not (clear red_block)) (forall (?x - block) (not (on ?x ?x))))", True),
        ([], "(forall (?x - block) (on_table ?x))", True),
    ],
)
def test_a_goal_is_looked_up_where_end_looks(yard: Problem, plan: list[str], goal: str, reached: bool) -> None:
    scorer = Scorer(yard)
    steps = [parse_instruction(step) for step in plan]
    assert scorer.reaches(steps, condition(goal, yard)) is reached
    assert holds(condition(goal, yard), rollout(yard, steps).decoded()[-1], yard) is reached


def test_a_run_tells_success_of_what_has_a_goal(mixed: ExperimentConfig) -> None:
    metrics = run(mixed).to_value()
    empty = [line for line in lines_of(mixed.out) if line["model"] == "empty"]
    assert {(line["id"][-1], line["success"]) for line in empty} == {("1", True), ("2", False), ("3", None)}
    row = metrics["models"]["empty"]
    assert (row["n"], row["goals"], row["success"]) == (6, 4, 50.0)
    assert row["success_se"] == pytest.approx(100 * (1 / 3) ** 0.5 / 2, abs=1e-3)
    assert (row["tasks"]["shown"]["success"], row["average"]["success"], row["average"]["goals"]) == (50.0, 50.0, 4)
    (pair,) = metrics["significance"]["pairs"]
    assert pair["success"].keys() == pair["END"].keys()
    page = write_report(mixed.out).read_text(encoding="utf-8")
    assert "of the 4 examples that have a goal" in page
    assert '<th class="n" scope="col">n</th><th class="n" scope="col">success %</th>' in page
    assert ">no success<" in page


def test_without_goals_there_is_no_such_column(tmp_path: Path) -> None:
    plain = config(corpus(tmp_path / "problems", None, None), tmp_path / "out")
    metrics = run(plain).to_value()
    assert {line["success"] for line in lines_of(plain.out)} == {None}
    row = metrics["models"]["empty"]
    assert (row["goals"], row["success"], row["success_se"], row["average"]["success"]) == (0, None, None, None)
    assert metrics["significance"]["pairs"][0]["success"] is None
    assert "uccess" not in shown(metrics)
    page = write_report(plain.out).read_text(encoding="utf-8")
    assert "uccess" not in page
    # parts of an earlier version, which did not tell it, are as good
    before = (plain.out / "predictions.jsonl").read_bytes()
    old = without_success(plain.out / "parts")
    run(plain)
    assert all(part.stat().st_mtime_ns == time for part, time in old.items())
    assert (plain.out / "predictions.jsonl").read_bytes() != before


def without_success(parts: Path) -> dict[Path, int]:
    """Make parts those of an earlier version; when each was changed."""
    for part in parts.iterdir():
        lines = [json.loads(line) for line in part.read_text().splitlines()]
        part.write_text("".join(json.dumps({k: line[k] for k in line if k != "success"}) + "\n" for line in lines))
    return {part: part.stat().st_mtime_ns for part in parts.iterdir()}


def test_a_finished_run_of_an_earlier_version_still_has_its_page(mixed: ExperimentConfig) -> None:
    run(mixed)
    for name in ("predictions.jsonl", "metrics.json"):
        path = mixed.out / name
        found = [json.loads(line) for line in path.read_text().splitlines()] if name[0] == "p" else []
        data = found or [json.loads(path.read_text())]
        path.write_text("".join(json.dumps(forgotten(item)) + "\n" for item in data))
    assert read_run(mixed.out).metrics.columns == ("IED", "EED", "EED_trim", "END", "executable")
    assert "uccess" not in write_report(mixed.out).read_text(encoding="utf-8")
    assert "uccess" not in shown(json.loads((mixed.out / "metrics.json").read_text()))


def forgotten(data: Any) -> Any:  # noqa: ANN401
    """JSON without what an earlier version did not write."""
    if isinstance(data, dict):
        return {k: forgotten(v) for k, v in data.items() if k not in ("success", "success_se", "goals")}
    return [forgotten(item) for item in data] if isinstance(data, list) else data


def test_goals_that_came_later_are_another_run(mixed: ExperimentConfig, tmp_path: Path) -> None:
    run(mixed)
    _read_once.cache_clear()
    with pytest.raises(TmdError, match=r"holds another run: its fingerprint is .*give another --out"):
        run(replace(mixed, problems=corpus(tmp_path / "others", AT_FIRST, HELD, HELD)))


@pytest.mark.parametrize("goal", ["(holding red_blck)", "(holding"])
def test_a_goal_that_cannot_be_read_stops_a_run_before_it_begins(tmp_path: Path, goal: str) -> None:
    problems = corpus(tmp_path / "problems", goal)
    with pytest.raises(TmdError, match=r"demonstrations\.jsonl:1:\d+: the goal of 'shown-yard1-1'"):
        BundledData("all", "01_blocks", ROOT / "domains", problems)


def prediction(model: str, number: int, success: bool | None, text: str | None = None) -> dict[str, Any]:
    said = {"id": number, "environment": "e", "task": "tu"[number % 2], "text": text or f"text {number}"}
    scores = dict.fromkeys(("IED", "END", "EED", "EED_trim"), 50.0)
    return {"model": model, "executable": True, "success": success} | said | scores


def test_rows_are_compared_in_success_where_there_are_goals() -> None:
    rows = [prediction("a", n, True if n < 6 else None) for n in range(9)]
    rows += [prediction("b", n, False if n < 6 else None) for n in range(9)]
    rows += [prediction("c", n, n == 0 if n < 6 else None) for n in range(9)]
    found = compare(rows, ["a", "b", "c"], TESTED)
    pairs = {(pair["a"], pair["b"]): pair for pair in found["pairs"]}
    assert (found["examples"], found["texts"]) == (9, 9)
    same = pairs["a", "b"]["success"]
    assert (same["difference"], same["low"], same["high"]) == (100.0, 100.0, 100.0)
    assert same["p"] == pytest.approx(2 / 2**6, abs=1e-4)
    assert same["p_holm"] == pytest.approx(3 * 2 / 2**6, abs=1e-3)
    assert pairs["b", "c"]["success"]["difference"] == pytest.approx(-100 / 6, abs=1e-3)
    assert pairs["a", "b"]["IED"]["p"] == 1.0


def test_the_same_text_is_one_draw_of_success() -> None:
    rows = [prediction(m, n, m == "a", "uv"[n % 2]) for m in "ab" for n in range(6)]
    assert compare(rows, ["a", "b"], TESTED)["pairs"][0]["success"]["p"] == pytest.approx(2 / 2**2)


def test_a_task_without_goals_does_not_count_in_the_average() -> None:
    rows = [prediction("m", n, n < 4 if n % 2 else None) for n in range(8)]
    row = summarise(rows, ["m"])["models"]["m"]
    assert row["tasks"]["t"]["success"] is None
    assert row["tasks"]["u"]["success"] == row["average"]["success"] == row["success"] == 50.0
    assert row["average"]["success_se"] == row["tasks"]["u"]["success_se"]
    assert (row["average"]["goals"], row["average"]["n"]) == (4, 8)


def test_a_page_on_tasks_with_and_without_goals(tmp_path: Path) -> None:
    plain = {"fold": "f", "predicted": [], "gold": [], "clauses": [], "segments": []}
    rows = [prediction(m, n, m == "full" if n % 2 else None) | plain for m in ("empty", "full") for n in range(12)]
    config = {"task": "all", "data": "bundled", "seed": 0}
    metrics = summarise(rows, ["empty", "full"]) | {
        "config": config,
        "folds": {"f": {"train": 1, "test": 12, "training_set": "f"}},
    }
    (tmp_path / "metrics.json").write_text(json.dumps(metrics))
    (tmp_path / "predictions.jsonl").write_text("".join(json.dumps(row) + "\n" for row in rows))
    page = write_report(tmp_path).read_text(encoding="utf-8")
    assert re.search(r'<td class="n">6</td><td class="n score">–', page), "a task without goals"
    assert re.search(r'<td class="n">6</td><td class="n score" style="--share: 1.000">100\.0', page), "one with goals"
    assert re.search(r'<code>empty</code></th><td class="n"><b>\+100\.0</b>', page)
    assert page.index(">success %<") < page.index(">IED<")


def shown(metrics: dict[str, Any], width: int = 100) -> str:
    out = io.StringIO()
    print_table(Metrics.model_validate(metrics), Console(file=out, width=width))
    return out.getvalue()


@pytest.mark.parametrize("width", [80, 120])
def test_success_is_the_first_column_of_the_table_on_the_screen(width: int) -> None:
    rows = ("empty", "full", "extended_hand_set")
    lines = [prediction(m, n, None if n < 2 else m != "empty") for m in rows for n in range(100)]
    config = {"task": "all", "data": "bundled", "seed": 0}
    said = shown(summarise(lines, rows) | {"config": config, "folds": {}}, width)
    assert said.index("success") < said.index("IED")
    assert "…" not in said
    assert "100.0" in next(line for line in said.splitlines() if line.lstrip().startswith("full"))
    assert "*" in next(line for line in said.splitlines() if line.lstrip().startswith("empty"))
    assert "Success is over the 98 examples that have a goal." in said


def test_the_best_predictions_reach_their_goals() -> None:
    plain = {"fold": "f", "predicted": [], "gold": [], "clauses": [], "segments": []}
    told = [(0, False, 90.0), (1, True, 10.0), (2, None, 50.0), (3, True, 20.0), (4, False, 5.0)]
    lines = [
        PredictionRecord.model_validate(prediction("m", n, s) | plain | {"IED": ied, "task": "t"}) for n, s, ied in told
    ]
    best, worst = best_and_worst(lines, 3)
    assert [item.line.id for item in best] == [3, 1, 2]
    assert [item.line.id for item in worst] == [4, 0]
