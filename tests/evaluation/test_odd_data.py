"""Data sets that nobody would wish for: one environment, one demonstration, contradictions, nothing said."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest

import tmd
from tmd import ExperimentConfig, TmdError, run_experiment

ROOT = Path(__file__).parents[2]
Records = list[dict[str, Any]]


@pytest.fixture
def config(tmp_path: Path) -> Callable[[Records], ExperimentConfig]:
    """A run on demonstrations in the pantries."""
    shutil.copytree(ROOT / "problems" / "04_tea", tmp_path / "problems" / "04_tea")

    def made(records: Records) -> ExperimentConfig:
        path = tmp_path / "problems" / "04_tea" / "tea" / "demonstrations.jsonl"
        path.write_text("".join(json.dumps(record) + "\n" for record in records))
        return ExperimentConfig(
            "all",
            tmp_path / "run",
            domain="04_tea",
            domains=ROOT / "domains",
            problems=tmp_path / "problems",
            models=("policy", "goals", "bayes_risk", "ranked"),
        )

    return made


def demonstrations() -> Records:
    path = ROOT / "problems" / "04_tea" / "tea" / "demonstrations.jsonl"
    return [json.loads(line) for line in path.read_text().splitlines()]


def scores(config: ExperimentConfig) -> dict[str, Any]:
    run_experiment(config)
    found: dict[str, Any] = json.loads((config.out / "metrics.json").read_text())["models"]
    return found


@pytest.mark.parametrize("count", [1, 2])
def test_one_environment_is_told_as_such(config: Callable[[Records], ExperimentConfig], count: int) -> None:
    with pytest.raises(TmdError, match="no environment but pantry1") as told:
        run_experiment(config(demonstrations()[:count]))
    assert told.value.hint is not None and "second environment" in told.value.hint


def test_one_demonstration_each_is_learned_from(config: Callable[[Records], ExperimentConfig]) -> None:
    found = scores(config([demonstrations()[0], demonstrations()[2]]))
    assert all(row["executable"] == 100 for row in found.values())
    assert found["goals"]["success"] == 100


def test_contradictions_are_learned_from(config: Callable[[Records], ExperimentConfig]) -> None:
    one, _, other = demonstrations()
    contrary = deepcopy(one)
    contrary["id"] += "-not"
    for segment in contrary["segments"]:
        segment["instructions"] = []
    contrary["segments"][0]["instructions"] = ["moveto(cup1)", "grasp(cup1)"]
    contrary.pop("end_state", None)
    contrary.pop("goal", None)
    found = scores(config([one, contrary, other]))
    assert all(row["executable"] == 100 for row in found.values())


def test_where_nothing_is_said_nothing_is_done(config: Callable[[Records], ExperimentConfig]) -> None:
    records = demonstrations()
    for record in records:
        done = [line for segment in record["segments"] for line in segment["instructions"]]
        record["text"], record["segments"] = "", [{"text": "", "instructions": done}]
    found = scores(config(records))
    assert {n: row["IED"] for n, row in found.items() if n != "ranked" and row["IED"] > 0.02} == {}


def test_a_verb_that_nobody_showed_is_told_as_such(config: Callable[[Records], ExperimentConfig]) -> None:
    made = config(demonstrations()[:1])
    kit = tmd.load_domain("04_tea", domains=made.domains, problems=made.problems)
    grounded = kit.ground("Juggle the cup.", "pantry2")
    assert not grounded.plans and "juggle" in grounded.reason.lower()
