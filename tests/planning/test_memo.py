"""What is remembered: exact answers, and plans carried over to other states."""

from __future__ import annotations

from collections.abc import Callable
from random import Random

import pytest

from tmd.pddl.semantics import regress
from tmd.pddl.task import Bits, Cube, Operator, Task
from tmd.planning.gap_filler import GapFiller, needs_before, needs_of
from tmd.planning.result import Filled, GaveUp
from tmd.planning.search.in_process import OptimalSearch

Walk = Callable[[Task, Random, int], list[Bits]]
Kitchen = Callable[[str], Task]


def perturbed(state: Bits, needs: Cube, size: int, random: Random) -> Bits:
    """A state that meets the same needs and is otherwise anything."""
    noise = random.getrandbits(size) & random.getrandbits(size)
    return (state ^ noise) & ~needs.negative | needs.positive


def executed(plan: list[Operator], state: Bits) -> Bits | None:
    for operator in plan:
        if not operator.applicable(state):
            return None
        state = operator.apply(state)
    return state


@pytest.mark.parametrize("name", ["pantry", "kitchen3"])
def test_plans_work_from_every_state_that_meets_their_needs(
    name: str, any_kitchen: Kitchen, pantry: Task, walk: Walk
) -> None:
    task = pantry if name == "pantry" else any_kitchen(name)
    search = OptimalSearch(task)
    random = Random(3)
    checked = 0
    for state in walk(task, random, 40):
        goal = random.choice(task.operators).precondition
        answer = search.fill(state, (goal,), 2000)
        if not isinstance(answer, Filled) or not answer.plan:
            continue
        plan = [task.by_instruction[instruction] for instruction in answer.plan]
        needs = needs_of(plan, state, goal)
        assert needs.holds(state)
        for _ in range(30):
            end = executed(plan, perturbed(state, needs, len(task.atoms), random))
            assert end is not None
            assert goal.holds(end)
            checked += 1
    assert checked > 300


def test_needs_are_part_of_the_weakest_precondition(pantry: Task, walk: Walk) -> None:
    """Every state that meets them is in one of the regressed cubes."""
    random = Random(8)
    for state in walk(pantry, random, 60):
        for operator in pantry.operators:
            if not operator.applicable(state):
                continue
            after = operator.apply(state)
            wanted = random.getrandbits(len(pantry.atoms))
            goal = Cube(after & wanted, wanted & ~after & random.getrandbits(len(pantry.atoms)))
            needs = needs_before(operator, state, goal)
            weakest = regress(goal, operator)
            for _ in range(5):
                other = perturbed(state, needs, len(pantry.atoms), random)
                assert any(cube.holds(other) for cube in weakest)


def test_hits_are_valid_and_their_cost_is_proved_again(any_kitchen: Kitchen, walk: Walk) -> None:
    """A hit works and is never cheaper than a fresh plan; it may be dearer, which is why it has to be asked for."""
    task = any_kitchen("kitchen3")
    filler = GapFiller(task, generalise=True)
    fresh = GapFiller(task)
    random = Random(4)
    goals = [operator.precondition for operator in random.sample(task.operators, 12)]
    same = 0
    for seed in range(3):
        for state in walk(task, Random(seed), 10):
            for goal in goals:
                before = filler.counters.generalised
                answer = filler.fill(state, (goal,))
                if filler.counters.generalised > before:
                    assert isinstance(answer, Filled)
                    plan = [task.by_instruction[instruction] for instruction in answer.plan]
                    assert executed(plan, state) == answer.state
                    again = fresh.fill(state, (goal,))
                    assert isinstance(again, Filled)
                    assert again.cost <= answer.cost
                    same += again.cost == answer.cost
    assert filler.counters.generalised > 80
    assert same > filler.counters.generalised // 2


def test_the_exact_memo_changes_no_answer(any_kitchen: Kitchen, walk: Walk) -> None:
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


def test_forgetting_makes_answers_independent_of_the_past(any_kitchen: Kitchen, walk: Walk) -> None:
    task = any_kitchen("kitchen3")
    goal = (task.operators[-1].precondition,)
    filler = GapFiller(task, generalise=True)
    for state in walk(task, Random(2), 10):
        filler.fill(state, goal)
    filler.forget()
    assert filler.fill(task.init, goal) == GapFiller(task, generalise=True).fill(task.init, goal)
