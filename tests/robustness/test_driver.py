"""A short run of the driver of experiments/robustness: nothing fails, and it would tell if something did."""

from __future__ import annotations

import time
from pathlib import Path
from random import Random

import pytest

from experiments.robustness import fuzz, kills
from experiments.robustness.mutate import damaged, damaged_json


@pytest.fixture(scope="module")
def ground(tmp_path_factory: pytest.TempPathFactory) -> fuzz.Ground:
    made = fuzz.Ground(tmp_path_factory.mktemp("robustness") / "ground")
    made.prepare()
    return made


@pytest.mark.parametrize("kind", fuzz.KINDS)
def test_nothing_damaged_ends_in_an_internal_error(ground: fuzz.Ground, kind: str) -> None:
    for number in range(2):
        case = fuzz.KINDS[kind](ground, Random(f"suite-{number}"))
        outcome = ground.run(case)
        assert not outcome.fault, (case, outcome)
        ground.restore()


def test_a_case_is_decided_by_its_seed(ground: fuzz.Ground) -> None:
    data = ground.kept["problems/04_tea/environments/pantry1.yaml"]
    one, two = (damaged(data, Random("7-12")) for _ in range(2))
    assert one == two != data
    record = ground.kept["ground.json"]
    assert damaged_json(record, Random(3)) == damaged_json(record, Random(3)) != record


def test_what_fails_is_told_and_saved(ground: fuzz.Ground, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(arguments: object) -> int:
        raise ZeroDivisionError("division by zero")

    monkeypatch.setattr(fuzz, "run_tmd", broken)
    (ground.folder / "said.txt").write_text("Something else.")
    case = fuzz.Case(("parse", "--text-file", "said.txt"))
    outcome = ground.run(case)
    assert outcome.fault == "internal error"
    fuzz.save(ground, case, outcome, tmp_path / "case")
    assert sorted(p.name for p in (tmp_path / "case").iterdir()) == ["case.json", "said.txt", "stdin"]
    ground.restore()
    assert (ground.folder / "said.txt").read_bytes() == ground.kept["said.txt"]


def test_what_hangs_is_told(ground: fuzz.Ground, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fuzz, "SECONDS", 0.2)
    monkeypatch.setattr(fuzz, "run_tmd", lambda arguments: time.sleep(20))
    assert ground.run(fuzz.Case(("parse",))).fault.startswith("over ")


@pytest.mark.parametrize("name", ["compile"])
def test_a_killed_command_leaves_nothing_and_goes_on(tmp_path: Path, name: str) -> None:
    killer = kills.Killer(kills.JOBS[name], tmp_path / "kill")
    for number in range(2):
        assert killer.kill(Random(f"suite-{number}")) == ""
