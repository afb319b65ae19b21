"""Answers that are remembered."""

from __future__ import annotations

from collections.abc import Callable
from random import Random

from tmd.pddl.task import Bits, Task
from tmd.planning.gap_filler import GapFiller
from tmd.planning.result import GaveUp

Walk = Callable[[Task, Random, int], list[Bits]]
Kitchen = Callable[[str], Task]


def test_the_memo_changes_no_answer(any_kitchen: Kitchen, walk: Walk) -> None:
    task = any_kitchen("kitchen3")
    with_memo, without = GapFiller(task), GapFiller(task, memo=False)
    random = Random(6)
    questions = [(state, random.choice(task.operators).precondition) for state in walk(task, random, 15)]
    for state, goal in questions + questions[::-1]:
        assert with_memo.fill(state, (goal,)) == without.fill(state, (goal,))
    assert with_memo.counters.exact >= len(questions) - with_memo.counters.held


def test_failures_are_remembered(pantry: Task) -> None:
    filler = GapFiller(pantry, backend="python", cap=3)
    first = filler.fill(pantry.init, pantry.goal)
    generated = filler.counters.generated
    assert first == GaveUp("3 generated states")
    assert filler.fill(pantry.init, pantry.goal) == first
    assert filler.counters.generated == generated


def test_forgotten_answers_are_searched_again(pantry: Task) -> None:
    filler = GapFiller(pantry, backend="python")
    first = filler.fill(pantry.init, pantry.goal)
    filler.forget()
    assert filler.fill(pantry.init, pantry.goal) == first
    assert (filler.counters.searched, filler.counters.exact) == (2, 0)
