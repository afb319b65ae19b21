"""The printed plan says which reading it takes where others have plans as well."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.bundled import kit
from tmd.inference.ranking import LostGoal
from tmd.pddl.model import Atom
from tmd.view.answer_text import grounded_text

HELD, READ = Atom("holding", ("pr2", "cup1")), Atom("holding", ("pr2", "book1"))


@pytest.mark.parametrize(
    ("others", "line"),
    [
        ([LostGoal(HELD, "", "energy +3", planned=True)], "taken so, not: cup1 is in the hand"),
        (
            [LostGoal(HELD, "", "energy +3", planned=True), LostGoal(READ, "", "energy +4", planned=True)],
            "taken so, not: cup1 is in the hand, or 1 more",
        ),
        ([LostGoal(HELD, "", "cannot be done here")], None),
    ],
)
def test_one_line_names_the_readings_that_were_not_taken(others: list[LostGoal], line: str | None) -> None:
    grounded = kit("02_table").ground("Put the cup on the first table.", "corner2")
    (goal,) = grounded.plans[0].goals
    plan = replace(grounded.plans[0], goals=(replace(goal, others=tuple(others)),))
    text = [each.strip() for each in grounded_text(replace(grounded, plans=(plan,))).splitlines()]
    assert [each for each in text if each.startswith("taken so")] == ([line] if line else [])
