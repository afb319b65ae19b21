"""Worlds that declare no meanings and have no demonstrations: what verbs mean is read off their PDDL alone."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

import tmd
from tmd.evaluation.sentence_tests import Outcome, judge
from tmd.pddl.reading.reader import with_goal
from tmd.world.sentence_file import read_sentences

WORLDS = Path(__file__).parent / "worlds"
FLOORS = {
    "garden": (25, 0, 8),
    "bikeshop": (29, 0, 7),
    "ward": (26, 0, 7),
    "engine_room": (28, 2, 7),
    "theatre": (56, 0, 12),
}
"""How many requests are done right at least, how many are done wrong at most, how many impossible ones are refused."""


@pytest.mark.parametrize("world", sorted(path.name for path in (WORLDS / "problems").iterdir()))
def test_requests_in_a_world_without_rows_and_demonstrations(world: str) -> None:
    kit = tmd.load_domain(world, domains=WORLDS / "domains", problems=WORLDS / "problems")
    found: Counter[Outcome] = Counter()
    for test in read_sentences(WORLDS / "problems" / world / "requests.sentences.jsonl"):
        problem = kit.problem(test.environment)
        if test.goal is not None:
            assert with_goal(problem, test.goal, test.id).goal is not None
        found[judge(test, kit.ground(test.text, test.environment), problem).outcome] += 1
    right, wrong, refused = FLOORS[world]
    assert found[Outcome.RIGHT] >= right
    assert found[Outcome.WRONG] <= wrong
    assert found[Outcome.IMPOSSIBLE_REFUSED] >= refused
