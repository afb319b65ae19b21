"""The last step of an experiment: one prediction for each environment is carried out, filmed, and shown in the page."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from html import unescape
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("pybullet", reason="needs the extra robot")
pytest.importorskip("PIL", reason="needs the extra robot")
pytest.importorskip("imageio_ffmpeg", reason="needs the extra robot")

from tests.cli.conftest import run_tmd
from tmd.diagnostics import ExitCode, TmdError
from tmd.evaluation.report.report import write_report
from tmd.evaluation.runs.config import ExperimentConfig
from tmd.evaluation.runs.finished_run import Trials, read_run, read_trials
from tmd.evaluation.summary import summarise
from tmd.records.prediction import PredictionRecord
from tmd.records.trial import Trial
from tmd.robot_trials import trials as performing
from tmd.robot_trials.trials import carry_out_predictions, choices, orders_of

ROOT = Path(__file__).parents[2]
TEXT = "Find the <b>mug</b>."
SHORT = ["find(mug1)"]


def clause(text: str, latent: list[str]) -> dict[str, Any]:
    return {"text": text, "verb": "find", "latent": latent, "said": SHORT, "source": None, "factors": {}}


def line(environment: str, number: int, model: str = "full", **changes: object) -> dict[str, Any]:
    made = {
        "id": f"ramen-{environment}-{number}", "task": "ramen", "environment": environment, "model": model, "fold": "f",
        "text": TEXT, "predicted": SHORT, "gold": SHORT, "executable": True, "IED": 50.0, "END": 50.0, "EED": 50.0,
        "EED_trim": 50.0, "clauses": [clause("Find  the mug", [])], "segments": [],
    }  # fmt: skip
    return made | changes


def finished(out: Path, lines: Sequence[dict[str, Any]], models: tuple[str, ...] = ("full",)) -> ExperimentConfig:
    """The directory of a run that has these predictions."""
    config = ExperimentConfig("ramen", out, models=models, domains=ROOT / "domains", problems=ROOT / "problems")
    metrics = summarise(lines, models) | {
        "config": config.identity(""),
        "folds": {"f": {"train": 1, "test": 1, "training_set": "f"}},
    }
    out.mkdir(exist_ok=True)
    (out / "metrics.json").write_text(json.dumps(metrics))
    (out / "predictions.jsonl").write_text("".join(json.dumps(each) + "\n" for each in lines))
    return config


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[ExperimentConfig, Trials]:
    """Two kitchens, and in one of them nothing can be executed."""
    out = tmp_path_factory.mktemp("trials") / "run"
    config = finished(
        out, [line("kitchen1", 1), line("kitchen2", 1, executable=False), line("kitchen2", 2, predicted=[])]
    )
    return config, carry_out_predictions(config, "kinematic")


def test_a_trial_is_a_record_a_film_and_a_strip(made: tuple[ExperimentConfig, Trials]) -> None:
    import imageio.v3 as iio

    config, trials = made
    one, two = trials.found
    assert (one.status, one.reason, one.repairs, one.asked.id) == ("done", "", 0, "ramen-kitchen1-1")
    assert [(str(s.instruction), s.number, s.outcome) for s in one.steps] == [("find(mug1)", 1, "ok")]
    assert "in view" in one.steps[0].told
    assert (one.film, one.strip, one.poster) == ("kitchen1.mp4", "kitchen1.png", "kitchen1.jpg")
    assert (trials.directory / "kitchen1.jpg").read_bytes()[:3] == b"\xff\xd8\xff"  # a JPEG
    assert sum(1 for _ in iio.imiter(trials.directory / "kitchen1.mp4")) > 10
    assert (two.status, two.film, two.asked.plan) == ("no_plan", None, ())
    assert sorted(path.name for path in (config.out / "robot").iterdir()) == [
        "kitchen1.jpg", "kitchen1.json", "kitchen1.mp4", "kitchen1.png", "kitchen2.json",
    ]  # fmt: skip


def test_the_page_shows_it_and_loads_nothing(made: tuple[ExperimentConfig, Trials]) -> None:
    page = write_report(made[0].out).read_text(encoding="utf-8")
    assert 'preload="none" poster="robot/kitchen1.jpg" src="robot/kitchen1.mp4"' in page
    assert 'src="robot/kitchen1.png"' in page
    assert not re.search(r'(?:src|href)="(?!data:|#|robot/)', page)
    assert "img-src 'self' file:; media-src 'self' file:" in page
    assert "no prediction of full can be executed there under PDDL" in page
    assert "Find the &lt;b&gt;mug&lt;/b&gt;." in page
    assert "<b>mug" not in page


class Counted:
    """Counts what is carried out, and does not do it."""

    def __init__(self) -> None:
        self.environments: list[str] = []

    def __call__(self, job: performing.Job, orders: object) -> Trial:
        self.environments.append(job.asked.environment)
        return Trial(asked=job.asked, status="done")


@pytest.fixture
def counted(monkeypatch: pytest.MonkeyPatch) -> Counted:
    found = Counted()
    monkeypatch.setattr(performing, "_carried_out", found)
    return found


def test_what_is_done_is_kept(made: tuple[ExperimentConfig, Trials], counted: Counted) -> None:
    config, before = made
    told: list[tuple[int, int]] = []
    assert carry_out_predictions(config, "kinematic", progress=lambda done, of: told.append((done, of))) == before
    assert (counted.environments, told) == ([], [(2, 2)])


@pytest.fixture
def two(tmp_path: Path, counted: Counted) -> Iterator[ExperimentConfig]:
    """A run with two trials that were made."""
    config = finished(tmp_path / "run", [line("kitchen1", 1), line("kitchen2", 1)])
    carry_out_predictions(config, "kinematic")
    assert counted.environments == ["kitchen1", "kitchen2"]
    counted.environments.clear()
    yield config


def test_what_is_missing_or_damaged_is_done_again(two: ExperimentConfig, counted: Counted) -> None:
    folder = two.out / "robot"
    whole = (folder / "kitchen1.json").read_text()
    (folder / "kitchen1.json").write_text(whole[:50])
    (folder / "kitchen3.json").write_text(whole)
    (folder / "kitchen2.unfinished.mp4").write_text("cut off")
    with pytest.raises(
        TmdError, match=r"kitchen1\.json:\d+:\d+: this is not valid JSON: .*let the robot act again: --step robot"
    ):
        read_trials(two.out)
    carry_out_predictions(two, "kinematic")
    assert counted.environments == ["kitchen1"]
    assert (folder / "kitchen1.json").read_text() == whole
    assert sorted(path.name for path in folder.iterdir()) == ["kitchen1.json", "kitchen2.json"]


def test_another_mode_or_prediction_is_another_trial(two: ExperimentConfig, counted: Counted) -> None:
    carry_out_predictions(two, "physics")
    assert counted.environments == ["kitchen1", "kitchen2"]
    counted.environments.clear()
    finished(two.out, [line("kitchen1", 1), line("kitchen2", 1, predicted=["find(bowl1)"])])
    carry_out_predictions(two, "physics")
    assert counted.environments == ["kitchen2"]


def test_a_scene_that_cannot_be_built_is_told(tmp_path: Path) -> None:
    config = finished(tmp_path / "run", [line("kitchen99", 1)])
    (trial,) = carry_out_predictions(config, "kinematic").found
    assert trial.status == "no_scene"
    assert "kitchen99" in trial.reason


@pytest.mark.parametrize(
    ("changes", "reason"),
    [({"domain": "veil500_sane"}, "has no skills.yaml"), ({"data": "veil500"}, "VEIL-500"), ({}, "pybullet")],
)
def test_why_the_robot_does_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, changes: dict[str, Any], reason: str
) -> None:
    config = replace(finished(tmp_path / "run", [line("kitchen1", 1)]), **changes)
    if not changes:
        monkeypatch.setitem(sys.modules, "pybullet", None)
    trials = carry_out_predictions(config, "kinematic")
    assert trials.found == ()
    assert reason in trials.skipped
    page = unescape(write_report(config.out).read_text(encoding="utf-8"))
    assert f"The robot did nothing: {trials.skipped}" in page
    assert [path.name for path in (config.out / "robot").iterdir()] == ["skipped.json"]


def test_the_best_row_and_the_first_that_works(tmp_path: Path) -> None:
    lines = [line("kitchen1", 1, "full"), line("kitchen1", 1, "paper", END=70.0, executable=False)]
    lines += [line("kitchen1", 2, "paper", END=20.0), line("kitchen1", 3, "paper", END=100.0)]
    lines += [line("kitchen1", 1, "empty", predicted=[], END=99.0)]
    finished(tmp_path, lines, ("empty", "full", "paper"))
    (choice,) = choices(read_run(tmp_path))
    assert choice.model == "paper"
    assert choice.line is not None and choice.line.id == "ramen-kitchen1-2"


def test_orders_say_which_words_they_are_for() -> None:
    clauses = [
        {"text": "Find\n it", "verb": "find", "latent": ["moveto(mug1)"], "said": SHORT, "source": None, "factors": {}}
    ]
    (first, second) = orders_of(
        PredictionRecord.model_validate(line("k", 1, predicted=["moveto(mug1)", *SHORT], clauses=clauses))
    )
    assert (first.latent, first.clause, first.text) == (True, 0, "Find it")
    assert (second.latent, str(second.instruction)) == (False, "find(mug1)")
    (other,) = orders_of(PredictionRecord.model_validate(line("k", 1, clauses=clauses)))
    assert (other.clause, other.text) == (None, ""), "the whole sequence was changed afterwards"


def test_the_command_without_a_simulator(tmp_path: Path) -> None:
    """It ends well, and says why nothing was carried out."""
    options = ("experiment", "--task", "tea", "--domain", "04_tea", "--models", "empty,chance", "--out", "run")
    hide = "import sys; sys.modules['pybullet'] = None"
    ended = run_tmd((*options, "--jobs", "1", "--robot", "kinematic"), tmp_path, before=hide)
    assert ended.code == ExitCode.OK, ended.err
    assert "the robot did nothing: pybullet is not installed: pip install 'tell-me-dave[robot]'" in ended.err
    assert "The robot did nothing: pybullet" in (tmp_path / "run" / "report.html").read_text(encoding="utf-8")


def test_options_that_do_not_go_together(tmp_path: Path) -> None:
    ended = run_tmd(("experiment", "--task", "ramen", "--out", "run", "--step", "robot", "--robot", "off"), tmp_path)
    assert ended.code == ExitCode.USAGE
    assert "--step robot and --robot off do not go together" in ended.err
