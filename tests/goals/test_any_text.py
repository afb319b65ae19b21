"""Whatever is said: no fault but TmdError, every plan works, and what it is for holds where it was reached."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.goals.conftest import said
from tmd.diagnostics import TmdError
from tmd.grounded import Grounded
from tmd.pddl.semantics import holds
from tmd.pddl.validator import validate

WORDS = {
    "02_table": ("corner2", "put take the a both all every cup book table shelf on it and then if other everything"),
    "03_drawer": (
        "study2",
        "open close put take leave the a both all drawer pen key desk in on it and don't unless everything",
    ),
    "04_tea": (
        "pantry1",
        "make boil fill pour add the tea water milk cup kettle in with without and then no hot it stove",
    ),
}


def check(grounded: Grounded) -> None:
    """Every plan replays, and each goal that no later step undoes holds where it was reached."""
    world = grounded.world
    problem = world.task.problem
    for plan, verdict in zip(grounded.plans, grounded.verdicts, strict=True):
        assert verdict.valid
        assert validate(problem, plan.instructions).valid
        states = [world.task.init]
        for instruction in plan.instructions:
            states.append(world.task.by_instruction[instruction].apply(states[-1]))
        assert states[-1] == plan.state
        decoded = [world.task.decode(state) for state in states]
        for goal in plan.goals:
            assert 0 <= goal.first <= goal.last <= len(plan.instructions)
            if goal.formula is not None:
                assert holds(goal.formula, decoded[goal.last], problem), (goal.text, goal.formula)


@pytest.mark.parametrize("domain", sorted(WORDS))
def test_any_words(domain: str) -> None:
    environment, words = WORDS[domain]
    texts = st.lists(st.sampled_from([*words.split(), ".", ","]), min_size=1, max_size=9).map(" ".join)

    @settings(max_examples=25, deadline=None, derandomize=True)
    @given(texts)
    def run(text: str) -> None:
        try:
            grounded = said(domain, environment, text)
        except TmdError:
            return
        check(grounded)

    run()


@pytest.mark.parametrize(
    ("where", "text"),
    [
        ("02_table/corner2", "Put the book on a table, then put the cup on the other one, then take the cup."),
        ("03_drawer/study1", "Open the drawer, take the key, close the drawer and put the key on the table."),
        ("04_tea/pantry1", "Boil some water in the kettle, put the tea bag in the cup and pour the water into it."),
    ],
)
def test_long_texts(where: str, text: str) -> None:
    grounded = said(*where.split("/"), text)
    assert grounded.plans
    check(grounded)
