"""Runs: they resume, they say what is wrong, and the bytes are the same however many processes."""

from __future__ import annotations

import errno
import json
import os
import re
import shlex
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from tmd import files as atomic
from tmd.diagnostics import OutputError, TmdError
from tmd.evaluation.models import model
from tmd.evaluation.report.report import write_report
from tmd.evaluation.runs import experiment
from tmd.evaluation.runs.config import ExperimentConfig
from tmd.evaluation.runs.experiment import run
from tmd.evaluation.runs.provenance import read_provenance
from tmd.evaluation.summary import summarise
from tmd.pddl.plan_file import parse_instruction

ROOT = Path(__file__).parents[2]
QUICK = ("empty", "chance", "nearest")


def config(out: Path, **changes: object) -> ExperimentConfig:
    base = ExperimentConfig("ramen", out, models=QUICK, domains=ROOT / "domains", problems=ROOT / "problems")
    return replace(base, **changes)  # type: ignore[arg-type]


def bench(out: Path, **changes: object) -> ExperimentConfig:
    """A run in the laboratory, where less is to be read and ground."""
    return config(out, task="bench_work", domain="lab_bench", models=("empty", "chance"), **changes)


def outcome(out: Path) -> dict[str, bytes]:
    return {name: (out / name).read_bytes() for name in ("config.json", "predictions.jsonl", "metrics.json")}


def test_a_run_writes_what_it_promises(tmp_path: Path) -> None:
    metrics = run(config(tmp_path, test_environments=(1, 3)))
    lines = [json.loads(line) for line in (tmp_path / "predictions.jsonl").read_text().splitlines()]
    assert len(lines) == 20 * len(QUICK)
    assert {"id", "task", "environment", "model", "predicted", "gold", "executable"} <= lines[0].keys()
    assert [line["model"] for line in lines] == [m for m in QUICK for _ in range(20)]
    for line in lines:
        assert [str(parse_instruction(step)) for step in line["gold"]] == line["gold"]
    told = metrics.to_value()
    assert json.loads((tmp_path / "metrics.json").read_text()) == told
    rows = told["models"]
    assert list(rows) == list(QUICK)
    assert all(row["n"] == row["tasks"]["ramen"]["n"] == 20 for row in rows.values())
    assert rows["empty"]["IED"] == pytest.approx(0.0, abs=0.01)
    assert rows["empty"]["executable"] == 100.0
    assert rows["nearest"]["IED"] > rows["chance"]["IED"]
    assert rows["nearest"]["END"] > rows["empty"]["END"]
    page = write_report(tmp_path).read_text()
    assert "nearest" in page
    assert "<script" not in page


def test_processes_and_interruptions_change_no_byte(tmp_path: Path) -> None:
    one, two = tmp_path / "one", tmp_path / "two"
    run(bench(one))
    run(bench(two, jobs=2))
    assert outcome(one) == outcome(two)
    removed = sorted((two / "parts").iterdir())[::3]
    kept = {p: p.stat().st_mtime_ns for p in sorted((two / "parts").iterdir()) if p not in removed}
    for part in removed:
        part.unlink()
    (two / "metrics.json").unlink()
    run(bench(two))
    assert outcome(one) == outcome(two)
    assert all(p.stat().st_mtime_ns == time for p, time in kept.items()), "finished work was done again"


def test_the_provenance_adds_up_the_time_of_what_was_done(tmp_path: Path) -> None:
    asked = bench(tmp_path, jobs=2)
    run(asked)
    first = read_provenance(tmp_path)
    assert first is not None
    text = (tmp_path / "provenance.json").read_text()
    run(asked, collect_only=True)
    run(asked)
    assert (tmp_path / "provenance.json").read_text() == text, "nothing was left to do"
    (tmp_path / "provenance.json").write_text(json.dumps(first.to_value() | {"seconds": 1000.0}))
    next((tmp_path / "parts").iterdir()).unlink()
    run(asked)
    second = read_provenance(tmp_path)
    assert second is not None and second.seconds >= 1000
    assert shlex.split(second.command)[1:] == [
        "--domains", str(ROOT / "domains"), "--problems", str(ROOT / "problems"),
        "experiment", "--task", "bench_work", "--domain", "lab_bench", "--models", "empty,chance", "--jobs", "2",
        "--out", str(tmp_path),
    ]  # fmt: skip


def test_a_seed_changes_chance_and_nothing_else(tmp_path: Path) -> None:
    rows = [run(bench(tmp_path / str(seed), seed=seed)).models for seed in (0, 1)]
    assert rows[0]["empty"] == rows[1]["empty"]
    assert rows[0]["chance"] != rows[1]["chance"]


def test_a_directory_that_holds_another_run_is_left_alone(tmp_path: Path) -> None:
    run(config(tmp_path, models=("empty",)))
    before = outcome(tmp_path)
    with pytest.raises(OutputError, match="another run"):
        run(config(tmp_path, models=("empty",), seed=5))
    assert outcome(tmp_path) == before


def test_what_differs_is_told(tmp_path: Path) -> None:
    run(config(tmp_path, models=("empty",)))
    with pytest.raises(OutputError, match="its seed is 0, not 5"):
        run(config(tmp_path, models=("empty",), seed=5))
    with pytest.raises(OutputError, match=r"its drop_sentences is 0.0, not 0.5"):
        run(config(tmp_path, models=("empty",), drop_sentences=0.5))


@pytest.mark.parametrize(
    "damage",
    [
        lambda text: "{",
        lambda text: text[: len(text) // 2],
        lambda text: "".join(text.splitlines(keepends=True)[:-1]),
        lambda text: text.replace('"model": "empty"', '"model": "chance"'),
        lambda text: text.replace('"IED"', '"IEED"'),
        lambda text: "[1]\n",
        lambda text: "",
        lambda text: re.sub(r'"task": "[a-z_]*", ', "", text, count=1),
        lambda text: re.sub(r'"task": "[a-z_]*"', '"task": "another"', text, count=1),
        lambda text: re.sub(r'"environment": "[a-z0-9]*"', '"environment": "elsewhere"', text, count=1),
        lambda text: re.sub(r'"IED": [0-9.]+', '"IED": "5"', text, count=1),
        lambda text: re.sub(r'"IED": [0-9.]+', '"IED": 5e9', text, count=1),
    ],
    ids=[
        "no JSON",
        "cut",
        "line lost",
        "of another model",
        "no score",
        "no object",
        "empty",
        "no task",
        "another task",
        "another environment",
        "a score that is text",
        "a score out of range",
    ],
)
def test_a_damaged_part_is_done_again(tmp_path: Path, damage: Callable[[str], str]) -> None:
    quick = config(tmp_path, models=("empty",), test_environments=(1, 2))
    run(quick)
    before = outcome(tmp_path)
    (part,) = (tmp_path / "parts").iterdir()
    part.write_text(damage(part.read_text()))
    run(quick)
    assert outcome(tmp_path) == before
    assert f"damaged, so to be done again: {part.name}" in (tmp_path / "log.txt").read_text()


def test_parts_without_a_configuration_are_left_alone(tmp_path: Path) -> None:
    run(config(tmp_path, models=("empty",)))
    (tmp_path / "config.json").unlink()
    with pytest.raises(OutputError, match=r"config\.json is missing"):
        run(config(tmp_path, models=("empty",)))


@pytest.mark.parametrize("text", ["{", "[]", "\udcff"])
def test_a_damaged_configuration_is_another_run(tmp_path: Path, text: str) -> None:
    run(config(tmp_path, models=("empty",)))
    (tmp_path / "config.json").write_bytes(text.encode(errors="surrogateescape"))
    with pytest.raises(OutputError, match="holds another run"):
        run(config(tmp_path, models=("empty",)))


def test_the_report_is_made_again_from_the_parts(tmp_path: Path) -> None:
    quick = config(tmp_path, models=("empty", "chance"))
    run(quick)
    before = outcome(tmp_path)
    (tmp_path / "metrics.json").unlink()
    (tmp_path / "predictions.jsonl").write_text("")
    parts = {p: p.stat().st_mtime_ns for p in (tmp_path / "parts").iterdir()}
    run(quick, collect_only=True)
    assert outcome(tmp_path) == before
    assert {p: p.stat().st_mtime_ns for p in (tmp_path / "parts").iterdir()} == parts
    next(iter(parts)).unlink()
    with pytest.raises(TmdError, match="1 of 20 parts are not done"):
        run(quick, collect_only=True)


@pytest.mark.parametrize("kind", [errno.EROFS, errno.ENOSPC, errno.EACCES])
def test_what_cannot_be_written_is_told_in_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: int) -> None:
    """The file system refuses the second file: the part, after the configuration."""
    written = atomic._write
    calls: list[Path] = []

    def refuse(path: Path, data: bytes, flags: int) -> None:
        calls.append(path)
        if len(calls) > 1:
            raise OSError(kind, os.strerror(kind), str(path))
        written(path, data, flags)

    monkeypatch.setattr(atomic, "_write", refuse)
    with pytest.raises(OutputError, match=os.strerror(kind)):
        run(config(tmp_path, models=("empty",)))
    monkeypatch.undo()
    assert not list((tmp_path / "parts").iterdir())
    run(config(tmp_path, models=("empty",)))


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full here")
def test_a_full_disk(tmp_path: Path) -> None:
    quick = config(tmp_path, models=("empty",), test_environments=(1,))
    run(quick)
    (tmp_path / "predictions.jsonl").unlink()
    (tmp_path / "predictions.jsonl").symlink_to("/dev/full")
    (tmp_path / "log.txt").unlink()
    (tmp_path / "log.txt").symlink_to("/dev/full")
    with pytest.raises(OutputError, match=r"predictions\.jsonl cannot be written: No space left"):
        run(quick)


def test_a_directory_that_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="cannot be made"):
        run(config(tmp_path / "file" / "out", models=("empty",)))
    (tmp_path / "log.txt").mkdir()
    with pytest.raises(OutputError, match=r"log\.txt cannot be written"):
        run(config(tmp_path, models=("empty",)))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"models": ("nearst",)}, "nearest"),
        ({"task": "ramne"}, "ramen"),
        ({"data": "veil500"}, "--veil500"),
        ({"domain": "kichen"}, "kitchen"),
        ({"test_environments": (7,)}, "environments 7"),
        ({"train_tasks": ("affogatto",)}, "affogato"),
    ],
)
def test_a_wrong_configuration_is_refused_before_anything_is_written(
    tmp_path: Path, changes: dict[str, object], message: str
) -> None:
    with pytest.raises(TmdError) as caught:
        run(config(tmp_path / "out", **changes))
    assert message in str(caught.value)
    assert not (tmp_path / "out" / "metrics.json").exists()


def test_templates_are_those_of_the_folder_whatever_its_domain_is_called(tmp_path: Path) -> None:
    domains = tmp_path / "domains"
    for name in ("02_table", "base"):  # whose domain is called "table"
        shutil.copytree(ROOT / "domains" / name, domains / name)
    table = {"task": "set_table", "domain": "02_table", "domains": domains}
    with pytest.raises(TmdError, match=r"'02_table' has no templates\.yaml"):
        run(config(tmp_path / "none", models=("empty", "templates"), **table))
    assert not list((tmp_path / "none").glob("**/*.jsonl"))
    template = "{verb: put, objects: [x], variables: {x: beaker}, instructions: moveto ?x}"
    (domains / "02_table" / "templates.yaml").write_text(
        f"kinds: {{beaker: {{types: item, called: [cup]}}}}\ntemplates: [{template}]\n"
    )
    run(config(tmp_path / "out", models=("templates",), **table))
    assert "moveto(cup1)" in (tmp_path / "out" / "predictions.jsonl").read_text()


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
    assert set(experiment.DEFAULT_MODELS) <= set(model.MODELS)
