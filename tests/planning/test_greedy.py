"""The search that is content with any plan: what it finds works, and what it does not find is not there."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import pytest
from hypothesis import given, settings

from tmd.diagnostics import TmdError
from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.reading.reader import parse_domain, parse_problem
from tmd.pddl.task import Bits, Cube, Task
from tmd.planning.backends import IN_PROCESS, IN_PROCESS_FIRST, EachAlone, InTurn, PartByPart, last_resort, make
from tmd.planning.gap_filler import eliminate
from tmd.planning.result import Answer, Filled, GaveUp, Unreachable
from tmd.planning.search.greedy import ENTRY, Line, put, take
from tmd.planning.search.in_process import FirstSearch, OptimalSearch

from .test_search import canonical, random_tasks


@settings(max_examples=75, deadline=None)
@given(random_tasks())
def test_a_plan_is_found_where_there_is_one_and_it_works(task: Task) -> None:
    search = FirstSearch(task, backend="python")
    answer = search.fill(task.init, task.goal)
    expected = canonical(task, task.init, task.goal)
    if expected is None:
        assert isinstance(answer, Unreachable)
        return
    assert isinstance(answer, Filled)
    assert any(cube.holds(answer.state) for cube in task.goal) and answer.cost >= expected[0]
    state = task.init
    for instruction in answer.plan:
        assert task.by_instruction[instruction].applicable(state)
        state = task.by_instruction[instruction].apply(state)
    assert state == answer.state


def test_both_forms_find_the_same_plan(any_kitchen: Callable[[str], Task]) -> None:
    pytest.importorskip("numba", reason="needs numba")
    task = any_kitchen("kitchen3")
    goals = [Cube(1 << atom) for atom in range(0, len(task.atoms), 41)]
    slow, quick = FirstSearch(task, backend="python", cap=30), FirstSearch(task, backend="numba", cap=30)
    for goal in goals:
        assert slow.fill(task.init, (goal,)) == quick.fill(task.init, (goal,))
        assert slow.generated == quick.generated


def test_its_plans_of_what_the_optimal_search_can_do_are_little_dearer(any_kitchen: Callable[[str], Task]) -> None:
    task = any_kitchen("kitchen2")
    optimal, first = OptimalSearch(task), FirstSearch(task)
    least, found = 0, 0
    for atom in range(0, len(task.atoms), 11):
        best = optimal.fill(task.init, (Cube(1 << atom),), 2_000)
        if isinstance(best, Filled):
            any_plan = first.fill(task.init, (Cube(1 << atom),))
            assert isinstance(any_plan, Filled)
            least, found = least + best.cost, found + any_plan.cost
    assert least > 50 and least <= found <= 1.2 * least


def test_a_line_gives_the_least_first_and_equals_in_order_of_arrival() -> None:
    values = [5, 3, 8, 3, 1, 5, 9, 1, 1, 0, 7, 3]
    line = Line([0] * ENTRY, [0, 0])
    for number, value in enumerate(values):
        line = put(line, value, number, -number)
    left = [take(line) for _ in values]
    assert line.number[0] == 0 and all(operator == -node for node, operator in left)
    assert all((values[a], a) < (values[b], b) for (a, _), (b, _) in pairwise(left))


def test_who_is_asked_next_is_asked_only_where_the_one_before_gave_up(any_kitchen: Callable[[str], Task]) -> None:
    task = any_kitchen("kitchen1")
    optimal = make(IN_PROCESS, task, cap=2_000)
    goals = [(Cube(1 << atom),) for atom in range(0, len(task.atoms), 11)]
    answers = ((optimal.fill(task.init, goal), goal) for goal in goals)
    goal = next(goal for answer, goal in answers if isinstance(answer, Filled) and answer.cost > 4)
    assert isinstance(make(IN_PROCESS, task, cap=1).fill(task.init, goal), GaveUp)
    first = make(IN_PROCESS_FIRST, task).fill(task.init, goal)
    assert isinstance(first, Filled)
    gives_up, finds = make(IN_PROCESS, task, cap=1), make(IN_PROCESS_FIRST, task)
    assert InTurn((gives_up, finds)).fill(task.init, goal) == first
    assert InTurn((finds, Refusing())).fill(task.init, goal) == first
    with pytest.raises(TmdError, match="nobody"):
        InTurn((gives_up, Refusing())).fill(task.init, goal)
    assert isinstance(InTurn((gives_up,)).fill(task.init, goal), GaveUp)


def test_each_alternative_is_asked_for_alone(any_kitchen: Callable[[str], Task]) -> None:
    task = any_kitchen("kitchen1")
    first = make(IN_PROCESS_FIRST, task)
    answers = {(Cube(1 << atom),): first.fill(task.init, (Cube(1 << atom),)) for atom in range(0, len(task.atoms), 58)}
    ways = sorted((a.cost, goal) for goal, a in answers.items() if isinstance(a, Filled) and a.cost)
    never = (Cube(1, 1),)  # true and false at once
    assert isinstance(first.fill(task.init, never), Unreachable)
    (cheap, (near,)), (dear, (far,)) = ways[0], ways[-1]
    assert cheap < dear
    alone = EachAlone(first)
    assert alone.fill(task.init, (far, *never, near)) == answers[near,]
    assert isinstance(alone.fill(task.init, never), Unreachable)
    assert isinstance(alone.fill(task.init, (*never, *never)), Unreachable)
    assert isinstance(EachAlone(make(IN_PROCESS_FIRST, task, cap=1)).fill(task.init, (far, *never)), GaveUp)
    holding = (far, Cube(0, 0))
    assert alone.fill(task.init, holding) == Filled((), task.init, 0)


class Refusing:
    def fill(self, state: Bits, goal: Sequence[Cube]) -> Answer:
        raise TmdError("nobody was to be asked")


def test_the_last_resort_answers_what_the_optimal_search_gives_up_on(any_kitchen: Callable[[str], Task]) -> None:
    task = any_kitchen("kitchen3")
    wanted = [a for a in task.atoms if a.predicate == "contains" and a.args[-1] == "cooked_ramen"]
    if not wanted:
        pytest.skip("nothing is cooked in this kitchen")
    goal = (Cube(1 << task.index[wanted[0]]),)
    assert isinstance(OptimalSearch(task).fill(task.init, goal, 500), GaveUp)
    answer = last_resort(task).fill(task.init, goal)
    assert isinstance(answer, Filled)
    shorter = eliminate(answer.plan, task, task.init, goal)
    assert goal[0].holds(answer.state) and len(shorter) <= len(answer.plan)


def test_many_parts_are_reached_one_after_another() -> None:
    domain = parse_domain(
        "(define (domain house) (:requirements :strips :typing) (:types lamp)"
        " (:predicates (by ?x - lamp) (lit ?x - lamp) (dark ?x - lamp))"
        " (:action go :parameters (?x ?y - lamp) :precondition (by ?x)"
        " :effect (and (by ?y) (not (by ?x)))) (:action light :parameters (?x - lamp)"
        " :precondition (and (by ?x) (dark ?x)) :effect (and (lit ?x) (not (dark ?x)))))"
    )
    lamps = [f"l{n}" for n in range(12)]
    init = " ".join(f"(dark {lamp})" for lamp in lamps)
    goal = " ".join(f"(lit {lamp})" for lamp in lamps)
    things = f"(:objects {' '.join(lamps)} - lamp) (:init (by l0) {init}) (:goal (and {goal}))"
    task = ground(parse_problem(f"(define (problem home) (:domain house) {things})", domain))
    answer = PartByPart(task).fill(task.init, task.goal)
    assert isinstance(answer, Filled)
    assert any(cube.holds(answer.state) for cube in task.goal)
    assert len(answer.plan) == 2 * len(lamps) - 1


def test_an_instruction_may_reach_more_than_it_was_made_ready_for(any_kitchen: Callable[[str], Task]) -> None:
    """Powder and water in a cup that heats: waiting makes it hot, and makes coffee of the powder that was put in."""
    task = any_kitchen("kitchen1")
    index = {str(atom): number for number, atom in enumerate(task.atoms)}
    wanted = ("(contains cup1 coffee)", "(contains cup1 sugar)", "(hot cup1)")
    goal = (Cube(sum(1 << index[atom] for atom in wanted), 0),)
    assert isinstance(PartByPart(task).fill(task.init, goal), GaveUp)
    answer = PartByPart(task, patient=True).fill(task.init, goal)
    assert isinstance(answer, Filled) and goal[0].holds(answer.state)
    assert goal[0].holds(task.trace(task.init, answer.plan)[-1])


def test_parts_that_exclude_each_other_are_given_up(pantry: Task) -> None:
    assert isinstance(PartByPart(pantry).fill(pantry.init, (Cube(1, 1),)), GaveUp)
