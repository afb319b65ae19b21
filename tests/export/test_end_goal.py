"""What a text asks for, taken all in all."""

from __future__ import annotations

import pytest

from tests.view.conftest import corpus
from tmd.export.end_goal import end_goal
from tmd.inference.ranking import RankedPlan, StepGoal
from tmd.pddl.model import GroundAtom
from tmd.pddl.reading.reader import with_goal
from tmd.pddl.writer import format_formula

END = (
    GroundAtom("contains", ("cup1", "water")),
    GroundAtom("at", ("cup1", "microwave1", "in")),
    GroundAtom("opened", ("fridge1_door",)),
)
"""What holds at the end, of all that the goals below speak of."""
FULL = "(or (contains cup1 water) (contains mug1 water))"

CASES = [
    (["(contains cup1 water)", "(opened fridge1_door)"], "(and (contains cup1 water) (opened fridge1_door))"),
    (["(opened microwave1_door)", "(contains cup1 water)"], "(contains cup1 water)"),
    (["(and (contains cup1 water) (opened microwave1_door))"], "(contains cup1 water)"),
    (["(contains cup1 water)", None, "(contains cup1 water)"], "(contains cup1 water)"),
    ([FULL], FULL),
    ([FULL, "(opened fridge1_door)"], f"(and {FULL} (opened fridge1_door))"),
    ([FULL, "(at cup1 microwave1 in)"], "(and (contains cup1 water) (at cup1 microwave1 in))"),
    ([FULL, "(not (contains mug1 milk))"], f"(and {FULL} (not (contains mug1 milk)))"),
    (["(opened microwave1_door)"], "(and)"),
    ([None], "(and)"),
]


@pytest.mark.parametrize(("asked", "whole"), CASES)
def test_what_is_asked_for_all_in_all(asked: list[str | None], whole: str) -> None:
    task = corpus("kitchen").world("kitchen1").task
    formulas = [None if text is None else with_goal(task.problem, text).goal for text in asked]
    goals = tuple(StepGoal(number, "", formula) for number, formula in enumerate(formulas))
    state = 0
    for atom in END:
        state |= 1 << task.index[atom]
    found = end_goal(RankedPlan((), state, goals=goals), task)
    assert found is not None and format_formula(found) == whole


def test_a_model_without_goals_states_none() -> None:
    assert end_goal(RankedPlan((), 0), corpus("kitchen").world("kitchen1").task) is None
