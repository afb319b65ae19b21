"""Goals that are impossible, and the guarantee that nothing possible is called so."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations
from random import Random

import pytest

from tmd.pddl.model import GroundAtom
from tmd.pddl.task import Bits, Cube, Task
from tmd.planning.gap_filler import GapFiller
from tmd.planning.result import Filled, Unreachable
from tmd.planning.unsolvable import Counts, Impossible, Mutexes, null_space

Walk = Callable[[Task, Random, int], list[Bits]]
Kitchen = Callable[[str], Task]


def goal_of(task: Task, *atoms: str) -> Cube:
    bits = 0
    for text in atoms:
        predicate, *arguments = text.split()
        bits |= 1 << task.index[GroundAtom(predicate, tuple(arguments))]
    return Cube(bits, 0)


@pytest.mark.parametrize("name", ["kitchen1", "kitchen3"])
def test_no_reached_state_has_an_exclusive_pair_or_breaks_a_law(name: str, any_kitchen: Kitchen, walk: Walk) -> None:
    task = any_kitchen(name)
    counts = Counts(task, task.init)
    everything = (1 << len(task.atoms)) - 1
    for seed in range(15):
        for state in walk(task, Random(seed), 40):
            assert counts.mutexes.covers(state)
            assert counts.clash(Cube(state, everything & ~state)) is None


def test_the_same_holds_in_the_pantry_from_every_state(pantry: Task, walk: Walk) -> None:
    everything = (1 << len(pantry.atoms)) - 1
    for start in walk(pantry, Random(1), 10):
        counts = Counts(pantry, start)
        for seed in range(10):
            walked = start
            random = Random(seed)
            for _ in range(30):
                walked = random.choice([o for o in pantry.operators if o.applicable(walked)]).apply(walked)
                assert counts.mutexes.covers(walked)
                assert counts.clash(Cube(walked, everything & ~walked)) is None


def test_nothing_is_in_two_places(any_kitchen: Kitchen) -> None:
    task = any_kitchen("kitchen1")
    mutexes = Mutexes(task, task.init)
    places = [atom for atom in task.atoms if atom.predicate == "at" and atom.args[0] == "mug1"]
    assert len(places) > 10
    for one, other in combinations(places, 2):
        assert mutexes.clash(Cube(1 << task.index[one] | 1 << task.index[other], 0)) is not None


def test_two_can_be_held_and_three_cannot(any_kitchen: Kitchen) -> None:
    task = any_kitchen("kitchen1")
    filler = GapFiller(task)
    held = ["holding pr2 mug1", "holding pr2 cup1", "holding pr2 bowl1"]
    assert isinstance(filler.fill(task.init, (goal_of(task, *held[:2]),)), Filled)
    answer = filler.fill(task.init, (goal_of(task, *held),))
    assert isinstance(answer, Unreachable)
    assert "holding" in answer.reason


def test_what_is_cooked_keeps_the_water_that_it_was_cooked_in(any_kitchen: Kitchen) -> None:
    task = any_kitchen("kitchen1")
    mutexes = Mutexes(task, task.init)
    egg, water = (goal_of(task, f"contains bowl1 {content}") for content in ("boiled_egg", "water"))
    assert mutexes.clash(Cube(egg.positive, water.positive)) is not None
    assert mutexes.clash(Cube(egg.positive | water.positive, 0)) is None


def test_laws_are_found(pantry: Task) -> None:
    counts = Counts(pantry, pantry.init)
    laws = [(dict(law.weights), law.total) for law in counts.laws]
    assert ({"here": 1}, 1) in laws
    assert ({"at": 1, "held": 1}, 4) in laws
    assert ({"both_used": 2, "held": -1, "one_used": 1}, 0) in laws


def test_impossible_goals_end_without_a_search_to_the_cap(any_kitchen: Kitchen) -> None:
    task = any_kitchen("kitchen1")
    filler = GapFiller(task)
    goal = goal_of(task, "at mug1 table1 on", "at mug1 counter1 on")
    answer = filler.fill(task.init, (goal,))
    assert isinstance(answer, Unreachable)
    assert "exclude each other" in answer.reason
    assert filler._search.generated < 5_000


def test_one_possible_cube_is_enough(any_kitchen: Kitchen) -> None:
    task = any_kitchen("kitchen1")
    impossible = goal_of(task, "at mug1 table1 on", "at mug1 counter1 on")
    possible = goal_of(task, "at mug1 table1 on")
    assert Impossible(task).reason(task.init, (impossible, possible)) is None
    assert isinstance(GapFiller(task).fill(task.init, (impossible, possible)), Filled)


def test_states_that_break_the_laws_are_not_judged_by_them(any_kitchen: Kitchen) -> None:
    """Forced instructions lead to states that no plan reaches."""
    task = any_kitchen("kitchen1")
    place, other = goal_of(task, "at mug1 table1 on").positive, goal_of(task, "at mug1 sink1 in").positive
    strange = task.init | place | other
    assert not Mutexes(task, task.init).covers(strange)
    goal = Cube(place | other | goal_of(task, "found pr2 cup1").positive, 0)
    assert Impossible(task).reason(strange, (goal,)) is None
    answer = GapFiller(task).fill(strange, (goal,))
    assert isinstance(answer, Filled)
    assert answer.cost == 1


def test_null_space() -> None:
    assert null_space([], 2) == [[1, 0], [0, 1]]
    assert null_space([[1, 0], [0, 1]], 2) == []
    assert null_space([[1, 1, 0], [0, 2, 3]], 3) == [[3, -3, 2]]


def test_a_task_of_very_many_things_is_not_looked_through(
    any_kitchen: Kitchen, monkeypatch: pytest.MonkeyPatch
) -> None:
    task = any_kitchen("kitchen1")
    goal = [goal_of(task, "at mug1 table1 on", "at mug1 counter1 on")]
    assert Impossible(task).reason(task.init, goal) is not None
    monkeypatch.setattr("tmd.planning.unsolvable._MOST_PAIRS", 1_000)
    assert Impossible(task).reason(task.init, goal) is None
