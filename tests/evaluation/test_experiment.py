"""Runs: folds never leak, runs resume, and the bytes are the same however many processes."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from tmd.errors import OutputError, TmdError
from tmd.evaluation import experiment, models
from tmd.evaluation.dataset import BundledData
from tmd.evaluation.experiment import ExperimentConfig, run
from tmd.evaluation.folds import given_fold, halves
from tmd.evaluation.report import write_report
from tmd.evaluation.summary import summarise
from tmd.pddl.plan_file import parse_instruction

ROOT = Path(__file__).parents[2]
QUICK = ("empty", "chance", "nearest")


@pytest.fixture(scope="module")
def data() -> BundledData:
    return BundledData("ramen", "kitchen", ROOT / "domains", ROOT / "problems")


def config(out: Path, **changes: object) -> ExperimentConfig:
    base = ExperimentConfig("ramen", out, models=QUICK, domains=ROOT / "domains", problems=ROOT / "problems")
    return replace(base, **changes)  # type: ignore[arg-type]


def outcome(out: Path) -> dict[str, bytes]:
    return {name: (out / name).read_bytes() for name in ("config.json", "predictions.jsonl", "metrics.json")}


def test_five_kitchens_make_ten_folds_that_test_everything_once(data: BundledData) -> None:
    folds = halves(data.examples)
    assert len(folds) == 10
    assert sorted(e.id for f in folds for e in f.test) == sorted(e.id for e in data.examples)
    for fold in folds:
        assert not {e.environment for e in fold.train} & {e.environment for e in fold.test}
        assert len(fold.train) == 40


def test_environment_numbers_choose_the_fold(data: BundledData) -> None:
    (fold,) = given_fold(data.examples, None, {2, 3})
    assert {e.number for e in fold.test} == {2, 3}
    assert {e.number for e in fold.train} == {1, 4, 5}
    (fold,) = given_fold(data.examples, {1}, None)
    assert {e.number for e in fold.test} == {2, 3, 4, 5}


@pytest.mark.parametrize(("train", "test"), [({1, 2}, {2}), ({1}, {9}), ({9}, {1}), (set(range(1, 6)), None)])
def test_folds_that_leak_or_are_empty_are_refused(data: BundledData, train: set[int], test: set[int] | None) -> None:
    with pytest.raises(TmdError):
        given_fold(data.examples, train, test)


def test_a_run_writes_what_it_promises(tmp_path: Path) -> None:
    metrics = run(config(tmp_path))
    lines = [json.loads(line) for line in (tmp_path / "predictions.jsonl").read_text().splitlines()]
    assert len(lines) == 50 * len(QUICK)
    assert {"id", "task", "environment", "model", "predicted", "gold", "executable"} <= lines[0].keys()
    assert [line["model"] for line in lines] == [m for m in QUICK for _ in range(50)]
    for line in lines:
        assert [str(parse_instruction(step)) for step in line["gold"]] == line["gold"]
    rows = metrics["models"]
    assert json.loads((tmp_path / "metrics.json").read_text()) == metrics
    assert list(rows) == list(QUICK)
    assert all(row["n"] == row["tasks"]["ramen"]["n"] == 50 for row in rows.values())
    assert rows["empty"]["IED"] == pytest.approx(0.0, abs=0.01)
    assert rows["empty"]["executable"] == 100.0
    assert rows["nearest"]["IED"] > rows["chance"]["IED"]
    assert rows["nearest"]["END"] > rows["empty"]["END"]
    page = write_report(tmp_path).read_text()
    assert "nearest" in page
    assert "<script" not in page


def test_processes_and_interruptions_change_no_byte(tmp_path: Path) -> None:
    one, two = tmp_path / "one", tmp_path / "two"
    quick = ("empty", "chance")
    run(config(one, models=quick))
    run(config(two, models=quick, jobs=2))
    assert outcome(one) == outcome(two)
    removed = sorted((two / "parts").iterdir())[::3]
    kept = {p: p.stat().st_mtime_ns for p in sorted((two / "parts").iterdir()) if p not in removed}
    for part in removed:
        part.unlink()
    (two / "metrics.json").unlink()
    run(config(two, models=quick))
    assert outcome(one) == outcome(two)
    assert all(p.stat().st_mtime_ns == time for p, time in kept.items()), "finished work was done again"


def test_a_seed_changes_chance_and_nothing_else(tmp_path: Path) -> None:
    quick = ("empty", "chance")
    rows = [run(config(tmp_path / str(seed), models=quick, seed=seed))["models"] for seed in (0, 1)]
    assert rows[0]["empty"] == rows[1]["empty"]
    assert rows[0]["chance"] != rows[1]["chance"]


def test_a_directory_that_holds_another_run_is_left_alone(tmp_path: Path) -> None:
    run(config(tmp_path, models=("empty",)))
    before = outcome(tmp_path)
    with pytest.raises(OutputError, match="another run"):
        run(config(tmp_path, models=("empty",), seed=5))
    assert outcome(tmp_path) == before


def test_a_damaged_part_is_named(tmp_path: Path) -> None:
    run(config(tmp_path, models=("empty",)))
    part = sorted((tmp_path / "parts").iterdir())[0]
    part.write_text("{")
    with pytest.raises(OutputError, match=part.name):
        run(config(tmp_path, models=("empty",)))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"models": ("nearst",)}, "nearest"),
        ({"task": "ramne"}, "ramen"),
        ({"data": "veil500"}, "--veil500"),
        ({"domain": "kichen"}, "kitchen"),
        ({"test_environments": (7,)}, "environments 7"),
    ],
)
def test_a_wrong_configuration_is_refused_before_anything_is_written(
    tmp_path: Path, changes: dict[str, object], message: str
) -> None:
    with pytest.raises(TmdError) as caught:
        run(config(tmp_path / "out", **changes))
    assert message in str(caught.value)
    assert not (tmp_path / "out" / "metrics.json").exists()


def test_means_and_standard_errors() -> None:
    predictions = [
        {"model": "m", "task": task, "IED": v, "EED": v, "EED_trim": v, "END": v, "executable": v > 50}
        for task, v in (("a", 0.0), ("a", 100.0), ("b", 50.0), ("b", 50.0))
    ]
    row = summarise(predictions, ["m"])["models"]["m"]
    assert (row["n"], row["IED"], row["executable"]) == (4, 50.0, 25.0)
    assert row["IED_se"] == pytest.approx(40.8248 / 2, abs=1e-3)
    assert row["tasks"]["b"]["IED_se"] == 0.0


def test_every_model_has_a_row_to_be_asked_for() -> None:
    assert set(experiment.DEFAULT_MODELS) <= set(models.MODELS)
