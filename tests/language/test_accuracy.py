"""Exact-clause accuracy on the gold sets, with floors below what is reached."""

import os
from pathlib import Path

import pytest

from experiments.language.gold import Item, own_items, score, second_items, veil_items

FLOORS = {"tune": 0.97, "seen": 0.95}
SECOND_FLOORS = {"tune": 0.97, "held_out": 0.88}
"""``held_out`` lies below what was reached: nothing was tuned on it, so small changes move it either way."""


def _split(items: list[Item], split: str) -> list[Item]:
    return [item for item in items if item.split == split]


@pytest.mark.parametrize("split", FLOORS)
def test_own_texts(split: str) -> None:
    result = score(_split(own_items(), split))
    assert result.total >= 50
    assert result.share() >= FLOORS[split], result


@pytest.mark.parametrize("split", SECOND_FLOORS)
def test_texts_of_a_second_author(split: str) -> None:
    result = score(_split(second_items(), split))
    assert result.total >= 190
    assert result.share() >= SECOND_FLOORS[split], result


@pytest.mark.parametrize("split", FLOORS)
def test_texts_of_veil_500(split: str) -> None:
    directory = os.environ.get("VEIL500_DIR")
    if not directory:
        pytest.skip("VEIL500_DIR does not name a directory with VEIL-500's data.xml")
    result = score(_split(veil_items(Path(directory)), split))
    assert result.total >= 70
    assert result.share() >= FLOORS[split], result


def test_the_gold_quotes_no_text_of_the_data_set() -> None:
    path = Path(__file__).parent / "gold" / "veil500.jsonl"
    allowed = {"point", "split", "clauses", "verb", "objects", "relations", "stem"}
    for line in path.read_text(encoding="utf-8").splitlines():
        words = {w.strip(' "') for w in line.replace(":", '"').split('"') if w.strip(' "').isidentifier()}
        stems = {w for w in words - allowed if w not in ("tune", "seen", "null")}
        assert all(len(stem) < 15 for stem in stems), stems
