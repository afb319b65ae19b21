"""Learning goes on after a kill where it was, and ends with the same weights."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tmd.diagnostics import OutputError
from tmd.inference.energy import Weights, named_weights
from tmd.inference.ranking import Choice, RankedPlan
from tmd.inference.weight_learning import Journal, Learned, learn_weights

START = named_weights("paper")
EXAMPLES, ROUNDS = 5, 2


class KilledError(Exception):
    """The process was killed."""


class Inference:
    """Two plans for each example, cheapest first; killed when it has answered ``lives`` times."""

    def __init__(self, lives: int) -> None:
        self.lives = lives
        self.asked = 0

    def propose(self, number: int, weights: Weights) -> list[tuple[RankedPlan, float]]:
        if self.asked == self.lives:
            raise KilledError
        self.asked += 1
        factors = (
            {"clause_distance": 0.9, "inconsistent_end": 0.1 + number / 30},
            {"clause_distance": 0.1, "inconsistent_end": 1 / 3 + number / 7},
        )
        plans = [RankedPlan((Choice("t", (), {}, raw),), 0) for raw in factors]
        losses = [0.1, 0.8]
        ranked = sorted(
            zip(plans, losses, strict=True), key=lambda item: sum(weights[n] * v for n, v in item[0].raw.items())
        )
        return ranked


def fit(inference: Inference, path: Path | None) -> Learned:
    journal = Journal(path, "kitchen") if path else None
    random = np.random.default_rng(3)
    return learn_weights(inference.propose, EXAMPLES, START, random, rounds=ROUNDS, journal=journal)


@pytest.mark.parametrize("lives", range(EXAMPLES * ROUNDS))
def test_a_killed_fit_goes_on_and_learns_the_same(tmp_path: Path, lives: int) -> None:
    path = tmp_path / "fits" / "full.journal.jsonl"
    with pytest.raises(KilledError):
        fit(Inference(lives), path)
    again = Inference(EXAMPLES * ROUNDS)
    assert fit(again, path) == fit(Inference(EXAMPLES * ROUNDS), None)
    assert again.asked == EXAMPLES * ROUNDS - lives


def test_a_line_cut_off_is_done_again(tmp_path: Path) -> None:
    path = tmp_path / "j.jsonl"
    fit(Inference(EXAMPLES * ROUNDS), path)
    whole = path.read_bytes()
    path.write_bytes(whole[:-9])
    again = Inference(EXAMPLES * ROUNDS)
    fit(again, path)
    assert again.asked == 1
    assert path.read_bytes() == whole


def test_parts_of_one_file_are_kept_apart(tmp_path: Path) -> None:
    path = tmp_path / "j.jsonl"
    Journal(path, "kitchen").write(1, 0, [(np.zeros(2), 0.5)])
    Journal(path, "living_room").write(1, 0, [])
    assert Journal(path, "living_room").read(1, 0) == []
    kept = Journal(path, "kitchen").read(1, 0)
    assert kept is not None and kept[0][1] == 0.5
    assert Journal(path, "office").read(1, 0) is None
    assert [json.loads(line)["part"] for line in path.read_text().splitlines()] == ["kitchen", "living_room"]


def test_a_place_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match="cannot be written"):
        Journal(tmp_path).write(1, 0, [])
