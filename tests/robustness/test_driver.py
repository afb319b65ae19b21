"""A short run of the driver of experiments/robustness: nothing fails, and it would tell if something did."""

from __future__ import annotations

import os
import time
from pathlib import Path
from random import Random

import pytest

from experiments.robustness import cases, kills, workspace
from experiments.robustness.mutate import damaged, damaged_json
from experiments.robustness.workspace import Case, Outcome, Workspace, kind_of_failure, save


@pytest.fixture(scope="module")
def space(tmp_path_factory: pytest.TempPathFactory) -> Workspace:
    made = Workspace(tmp_path_factory.mktemp("robustness") / "outer" / "inner" / "space")
    made.prepare()
    return made


def test_nothing_damaged_ends_in_an_internal_error(space: Workspace) -> None:
    failed: list[tuple[int, Case, Outcome]] = []
    kinds = set()
    number, last = 0, 80
    while number < last:
        made = space.batch(
            number, last - number, lambda n: cases.case(space, 1, n), lambda *failure: failed.append(failure)
        )
        for number, kind, outcome in made:
            kinds.add(kind)
            assert not outcome.fault, (number, kind, outcome)
        number += 1
    assert len(kinds) >= 8


def test_a_case_is_decided_by_its_seed(space: Workspace) -> None:
    data = space.kept["problems/04_tea/environments/pantry1.yaml"]
    one, two = (damaged(data, Random("7-12")) for _ in range(2))
    assert one == two != data
    record = space.kept["ground.json"]
    assert damaged_json(record, Random(3)) == damaged_json(record, Random(3)) != record
    made = []
    for _ in range(2):
        made.append((cases.case(space, 3, 5), sorted((n, (space.folder / n).read_bytes()) for n in space.changed())))
        space.restore()
    assert made[0] == made[1]


def test_what_fails_is_told_and_saved(space: Workspace, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(arguments: object) -> int:
        raise ZeroDivisionError("division by zero")

    monkeypatch.setattr(workspace, "run_tmd", broken)
    (space.folder / "said.txt").write_text("Something else.")
    case = Case(("parse", "--text-file", "said.txt"))
    outcome = space.run(case)
    assert outcome.fault == "internal error"
    save(space, case, outcome, tmp_path / kind_of_failure(case, outcome), "1-2")
    (kept,) = tmp_path.iterdir()
    assert kept.name.startswith("internal-error-parse-")
    assert sorted(p.name for p in kept.iterdir()) == ["case.json", "said.txt", "stdin"]
    space.restore()
    assert (space.folder / "said.txt").read_bytes() == space.kept["said.txt"]


def _hangs(arguments: object) -> int:
    time.sleep(20)
    return 0


def _leaves_a_process(arguments: object) -> int:
    if os.fork() == 0:
        time.sleep(20)
        os._exit(0)
    return 0


def _leaves_a_draft(arguments: object) -> int:
    Path(".x.pddl.1a2b3c4d.77.part").touch()
    return 0


def _changes_an_input(arguments: object) -> int:
    Path("said.txt").write_text("x")
    return 0


@pytest.mark.parametrize("batched", [False, True])
@pytest.mark.parametrize(
    ("command", "fault"),
    [
        (_hangs, "over 0 s"),
        (_leaves_a_process, "1 processes alive after two seconds"),
        (_leaves_a_draft, "left behind: .x.pddl.1a2b3c4d.77.part"),
        (_changes_an_input, "changed: said.txt"),
        (lambda arguments: 1 / 0, "internal error"),
        (lambda arguments: os._exit(3), "code 3"),
    ],
)
def test_whatever_goes_wrong_is_told(
    space: Workspace, monkeypatch: pytest.MonkeyPatch, command: object, fault: str, batched: bool
) -> None:
    monkeypatch.setattr(workspace, "SECONDS", 0.3)
    monkeypatch.setattr(workspace, "PATIENCE", 0.3)
    monkeypatch.setattr(workspace, "run_tmd", command)
    case = Case(("parse", "--text", "x"))
    if batched:
        told = [outcome.fault for _, _, outcome in space.batch(7, 3, lambda n: ("x", case), lambda *failure: None)]
        assert told == [fault]
    else:
        assert space.run(case).fault == fault
        space.restore()
    assert not list(space.changed())


@pytest.mark.parametrize("name", ["compile"])
def test_a_killed_command_leaves_nothing_and_goes_on(tmp_path: Path, name: str) -> None:
    killer = kills.Disturber(kills.JOBS[name], tmp_path / "kill")
    for number in range(2):
        assert killer.kill(Random(f"suite-{number}")) == ""
