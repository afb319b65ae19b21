"""A unit that was killed goes on: what was learned is kept, what was begun is in a journal."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self

import numpy as np
import pytest

from tmd.evaluation.models import model
from tmd.evaluation.models.paper_models import Crf
from tmd.evaluation.models.prediction import Prediction
from tmd.evaluation.runs import jobs
from tmd.evaluation.runs.config import ExperimentConfig
from tmd.evaluation.runs.dataset import Dataset, Example
from tmd.evaluation.runs.experiment import run
from tmd.inference.energy import NAMES, Weights
from tmd.records.fit import WorldFit

ROOT = Path(__file__).parents[2]
STEPS = 5


@dataclass(frozen=True)
class Found:
    weights: Weights
    curve: tuple[Any, ...]


class Toy(Crf):
    """Learns in five steps a random number each, and predicts so many instructions of the person's own."""

    journal: Path | None = None
    fits = 0
    restores = 0
    dies_after: int | None = None
    dies_predicting = False
    read: list[str]

    def fit(self, examples: Sequence[Example], data: Dataset, random: np.random.Generator) -> Self:
        Toy.fits += 1
        drawn = [float(number) for number in random.random(STEPS)]
        known = len(self.journal.read_text().splitlines()) if self.journal and self.journal.exists() else 0
        for step in range(known, STEPS):
            if step == Toy.dies_after:
                raise KeyboardInterrupt
            if self.journal:
                with self.journal.open("a") as file:
                    file.write(f"{drawn[step]}\n")
        values = [float(line) for line in self.journal.read_text().splitlines()] if self.journal else drawn
        self.learned_ = {
            "kitchen": Found(
                Weights({"environment_distance": sum(values)}), ({"round": 0, "epoch": 0, "loss": values[0]},)
            )
        }
        return self

    def restore(self, examples: Sequence[Example], data: Dataset, saved: Mapping[str, WorldFit]) -> Self:
        Toy.restores += 1
        world = saved["kitchen"]
        self.learned_ = {"kitchen": Found(Weights(world.weights), world.curve)}
        return self

    def predict(self, example: Example, data: Dataset, random: np.random.Generator) -> Prediction:
        if Toy.dies_predicting:
            raise KeyboardInterrupt
        count = int(10 * self.learned_["kitchen"].weights["environment_distance"] + random.integers(4)) % 7
        return Prediction(example.gold[:count])


@pytest.fixture(autouse=True)
def toy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(model, "MODELS", {**model.MODELS, "toy": Toy})
    for name, value in (("fits", 0), ("restores", 0), ("dies_after", None), ("dies_predicting", False)):
        monkeypatch.setattr(Toy, name, value)


def config(out: Path, **changes: object) -> ExperimentConfig:
    base = ExperimentConfig("ramen", out, models=("toy",), domains=ROOT / "domains", problems=ROOT / "problems")
    return replace(base, **changes)  # type: ignore[arg-type]


def outcome(out: Path) -> dict[str, bytes]:
    """All files but the log and the provenance."""
    files = sorted(p for p in out.rglob("*") if p.is_file() and p.name not in ("log.txt", "provenance.json"))
    return {str(p.relative_to(out)): p.read_bytes() for p in files}


def test_folds_with_one_training_set_share_a_fit(tmp_path: Path) -> None:
    run(config(tmp_path))
    assert Toy.fits == 5
    assert len(list((tmp_path / "parts").iterdir())) == 10


def test_what_was_learned_is_told(tmp_path: Path) -> None:
    run(config(tmp_path))
    found = sorted((tmp_path / "fits").iterdir())
    assert [p.name for p in found] == [
        f"toy-affogato+ramen_{r}.json" for r in ("1,3-5", "1-2,4-5", "1-3,5", "1-4", "2-5")
    ]
    said = json.loads(found[0].read_text())
    assert said["model"] == "toy"
    assert said["trained_in"] == ["kitchen1", "kitchen3", "kitchen4", "kitchen5"]
    world = said["worlds"]["kitchen"]
    assert list(world["weights"]) == list(NAMES)
    assert world["weights"]["environment_distance"] > 0
    assert world["curve"][0]["round"] == 0
    assert len({p.read_text() for p in found}) == 5, "each training set draws its own numbers"


def test_a_killed_fit_goes_on_from_its_journal(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run(config(tmp_path / "whole"))
    begun = tmp_path / "begun"
    monkeypatch.setattr(Toy, "dies_after", 3)
    with pytest.raises(KeyboardInterrupt):
        run(config(begun))
    (journal,) = (begun / "fits").glob("*.jsonl")
    assert len(journal.read_text().splitlines()) == 3
    monkeypatch.setattr(Toy, "dies_after", 2)  # the unit that was begun is past that, the next one is not
    with pytest.raises(KeyboardInterrupt):
        run(config(begun))
    (second,) = (begun / "fits").glob("*.jsonl")
    assert second != journal
    assert journal.with_name(journal.name.replace(".journal.jsonl", ".json")).is_file()
    monkeypatch.setattr(Toy, "dies_after", None)
    run(config(begun))
    assert outcome(begun) == outcome(tmp_path / "whole"), "the journals are gone as well"


def test_a_unit_killed_while_it_predicts_learns_nothing_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run(config(tmp_path / "whole"))
    begun = tmp_path / "begun"
    monkeypatch.setattr(Toy, "dies_predicting", True)
    with pytest.raises(KeyboardInterrupt):
        run(config(begun))
    assert not list((begun / "parts").iterdir())
    monkeypatch.setattr(Toy, "dies_predicting", False)
    monkeypatch.setattr(Toy, "fits", 0)
    run(config(begun))
    assert (Toy.fits, Toy.restores) == (4, 1)
    assert outcome(begun) == outcome(tmp_path / "whole")


@pytest.mark.parametrize("text", ["", "{", "[]", '{"model": "other", "worlds": {}}', '{"model": "toy"}'])
def test_what_was_learned_is_learned_again_if_its_file_is_damaged(tmp_path: Path, text: str) -> None:
    run(config(tmp_path))
    before = outcome(tmp_path)
    fit = tmp_path / "fits" / "toy-affogato+ramen_1-4.json"
    fit.write_text(text)
    (tmp_path / "parts" / "toy-kitchen5b.jsonl").unlink()
    run(config(tmp_path))
    assert (Toy.fits, Toy.restores) == (6, 0)
    assert outcome(tmp_path) == before


def test_one_lost_part_is_done_alone(tmp_path: Path) -> None:
    run(config(tmp_path))
    before = outcome(tmp_path)
    other = tmp_path / "parts" / "toy-kitchen5a.jsonl"
    time = other.stat().st_mtime_ns
    (tmp_path / "parts" / "toy-kitchen5b.jsonl").unlink()
    run(config(tmp_path))
    assert (Toy.fits, Toy.restores) == (5, 1)
    assert outcome(tmp_path) == before
    assert other.stat().st_mtime_ns == time


def test_rows_do_not_depend_on_what_else_is_tested(tmp_path: Path) -> None:
    """The same training set learns the same, and the same example draws the same numbers, whatever the folds are."""
    run(config(tmp_path / "one"))
    run(config(tmp_path / "all", task="all", models=("empty", "toy")))
    run(config(tmp_path / "given", test_environments=(5,)))
    rows = {}
    for name in ("one", "all", "given"):
        lines = map(json.loads, (tmp_path / name / "predictions.jsonl").read_text().splitlines())
        rows[name] = {p["id"]: p["predicted"] for p in lines if p["model"] == "toy" and p["task"] == "ramen"}
    assert rows["all"] == rows["one"]
    assert rows["given"].items() < rows["one"].items()
    assert len(rows["given"]) == 10


def test_a_journal_belongs_to_one_process(tmp_path: Path) -> None:
    unit = jobs.EvaluationJob("toy", "t", ("f",))
    first, second = Toy(), Toy()
    with jobs._journal(first, unit, tmp_path), jobs._journal(second, unit, tmp_path):
        assert first.journal == tmp_path / "toy-t.journal.jsonl"
        assert second.journal is None
    third = Toy()
    with jobs._journal(third, unit, tmp_path):
        assert third.journal == first.journal


def test_models_read_what_is_left_of_a_text(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    read: dict[str, list[str]] = {"toy": [], "other": []}
    trained: set[str] = set()

    class Other(Toy):
        name = "other"

        def fit(self, examples: Sequence[Example], data: Dataset, random: np.random.Generator) -> Self:
            trained.update(example.demonstration.text for example in examples)
            return super().fit(examples, data, random)

        def predict(self, example: Example, data: Dataset, random: np.random.Generator) -> Prediction:
            read[self.name].append(example.demonstration.text)
            return super().predict(example, data, random)

    class Same(Other):
        name = "toy"

    monkeypatch.setattr(model, "MODELS", {"other": Other, "toy": Same})
    run(config(tmp_path, models=("other", "toy"), drop_sentences=0.5))
    assert read["toy"] == read["other"]
    demonstrations = (ROOT / "problems" / "kitchen" / "ramen" / "demonstrations.jsonl").read_text().splitlines()
    whole = {d["id"]: d for d in map(json.loads, demonstrations)}
    texts = {d["text"] for d in whole.values()}
    assert texts <= trained, "training texts stay whole"
    lines = [json.loads(line) for line in (tmp_path / "predictions.jsonl").read_text().splitlines()]
    shorter = 0
    for line in lines:
        own = whole[line["id"]]
        assert line["text"] in read["toy"]
        assert [s["text"] for s in line["segments"]] == [s["text"] for s in own["segments"]]
        assert line["gold"] == [i for s in own["segments"] for i in s["instructions"]]
        shorter += line["text"] != own["text"]
    assert shorter > 20
