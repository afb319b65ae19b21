"""Proposals of which clause a step serves: in the order of the text, never against what the person said."""

from __future__ import annotations

from itertools import pairwise

from hypothesis import given, settings
from hypothesis import strategies as st

from tmd.language import parse
from tmd.library.library import learn
from tmd.pddl.plan_file import parse_instruction
from tmd.studio.demonstrations.alignment import NO_HABITS, Habits, propose
from tmd.world.corpus import Corpus
from tmd.world.world import World

TEXT = "Fill the kettle with water, put it on the stove and turn the burner on. Wait until it boils."
DONE = [
    "find(kettle1)", "moveto(kettle1)", "grasp(kettle1)", "moveto(sink1)", "keep(kettle1, sink1, in)",
    "turn(sink1_handle, high)", "turn(sink1_handle, off)",
    "grasp(kettle1)", "moveto(stove1)", "keep(kettle1, stove1_burner1, on)",
    "turn(stove1_knob1, high)",
    "wait()",
]  # fmt: skip
GOLD = (0,) * 7 + (1,) * 3 + (2, 3)


def test_what_others_did_for_a_verb_says_where_the_next_begins(kitchen: Corpus, kitchen1: World) -> None:
    others = [d for d in kitchen.demonstrations("ramen") if d.environment != "kitchen1"]
    habits = Habits.of(learn(others, kitchen.world, kitchen.lexicon))
    clauses = parse(TEXT, kitchen.lexicon).clauses
    done = [parse_instruction(line) for line in DONE]
    assert propose(clauses, done, kitchen1, {}, habits) == GOLD
    for steps in (7, 10, 11):
        assert propose(clauses, done[:steps], kitchen1, {}, habits) == GOLD[:steps]


@settings(max_examples=60)
@given(
    steps=st.lists(st.sampled_from(DONE), max_size=12),
    pins=st.dictionaries(st.integers(0, 11), st.integers(0, 3), max_size=5),
)
def test_marks_are_kept_and_clauses_stay_in_order(
    kitchen: Corpus, kitchen1: World, steps: list[str], pins: dict[int, int]
) -> None:
    kept = dict(zip(sorted(k for k in pins if k < len(steps)), sorted(pins.values()), strict=False))
    clauses = parse(TEXT, kitchen.lexicon).clauses
    found = propose(clauses, [parse_instruction(line) for line in steps], kitchen1, kept, NO_HABITS)
    assert len(found) == len(steps)
    assert all(a <= b for a, b in pairwise(found))
    assert all(found[step] == clause for step, clause in kept.items())
    assert all(0 <= clause < 4 for clause in found)
