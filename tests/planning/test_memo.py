"""Answers that are remembered."""

from __future__ import annotations

from collections.abc import Callable
from random import Random

import pytest

from tmd.pddl.task import Bits, Task
from tmd.planning.gap_filler import GapFiller
from tmd.planning.result import Filled, GaveUp

Walk = Callable[[Task, Random, int], list[Bits]]
Kitchen = Callable[[str], Task]


def test_remembered_answers_are_those_of_a_search(any_kitchen: Kitchen, walk: Walk) -> None:
    task = any_kitchen("kitchen3")
    remembering, forgetting = GapFiller(task), GapFiller(task)
    random = Random(6)
    questions = [(state, random.choice(task.operators).precondition) for state in walk(task, random, 15)]
    for state, goal in questions + questions[::-1]:
        forgetting.forget()
        assert remembering.fill(state, (goal,)) == forgetting.fill(state, (goal,))


def test_failures_are_remembered(pantry: Task, monkeypatch: pytest.MonkeyPatch) -> None:
    filler = GapFiller(pantry, backend="python", cap=3)
    assert filler.fill(pantry.init, pantry.goal) == GaveUp("3 generated states")
    monkeypatch.setattr(filler._search, "fill", None)
    assert filler.fill(pantry.init, pantry.goal) == GaveUp("3 generated states")


def test_forgotten_answers_are_searched_again(pantry: Task) -> None:
    filler = GapFiller(pantry, backend="python")
    first = filler.fill(pantry.init, pantry.goal)
    filler._search.generated = 0
    filler.forget()
    assert isinstance(first, Filled) and filler.fill(pantry.init, pantry.goal) == first
    assert filler._search.generated > 0
