"""Table II as it is printed."""

from __future__ import annotations

import pytest

from tmd.evaluation.models.model import MODELS
from tmd.evaluation.report.rows import METRICS, OURS, TABLE_2, TASKS, in_order, title


@pytest.mark.parametrize("name", TABLE_2)
def test_the_printed_average_is_the_mean_of_the_tasks(name: str) -> None:
    row = TABLE_2[name]
    for number, _ in enumerate(METRICS):
        mean = sum(row.of(task)[number] for task in TASKS) / len(TASKS)
        assert row.average[number] == pytest.approx(mean, abs=0.11)


def test_some_numbers_as_printed() -> None:
    assert TABLE_2["full"].of("ramen") == (67.3, 49.4)
    assert TABLE_2["full"].average == (63.0, 61.3)
    assert TABLE_2["no_nl"].of("coffee") == (39.2, 43.9)
    assert TABLE_2["nearest"].of("affogato") == (45.4, 49.2)


def test_the_papers_rows_come_in_its_order() -> None:
    assert in_order(["empty", "full", "paper", "chance"]) == ["chance", "full"]


def test_every_model_has_a_title() -> None:
    assert {name for name in MODELS if title(name) == name} == set()
    assert not OURS.keys() & TABLE_2.keys()
