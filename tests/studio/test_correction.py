"""Editing a plan: every edit is what it says, breaks are found where they are, and repairing makes the plan work."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tmd.diagnostics import TmdError
from tmd.pddl.plan_file import parse_instruction
from tmd.pddl.validator import validate
from tmd.studio.demonstrations.correction import Correction
from tmd.studio.demonstrations.session import DemonstratedStep
from tmd.world.corpus import Corpus
from tmd.world.world import World

TEXT = "Take the mug and heat it in the microwave."
PLAN = [
    ("find(mug1)", 0), ("moveto(mug1)", 0), ("grasp(mug1)", 0),
    ("moveto(microwave1)", 1), ("open(microwave1_door)", 1), ("keep(mug1, microwave1, in)", 1),
    ("close(microwave1_door)", 1), ("press(microwave1_button)", 1), ("wait()", 1),
]  # fmt: skip


@pytest.fixture
def correction(kitchen: Corpus, kitchen1: World) -> Correction:
    return Correction(kitchen1, TEXT, [DemonstratedStep(parse_instruction(i), c) for i, c in PLAN], kitchen.lexicon)


def lines(correction: Correction) -> list[str]:
    return [str(step.instruction) for step in correction.steps]


def served(correction: Correction) -> list[tuple[str, int]]:
    """The steps, each with the clause that it is saved for."""
    return [(str(i), number) for number, segment in enumerate(correction.segments()) for i in segment.instructions]


def test_a_plan_that_works_is_not_broken(correction: Correction) -> None:
    assert correction.broken() is None
    assert correction.repair() == ()
    assert served(correction) == PLAN


def test_a_deleted_step_breaks_a_later_one_and_is_repaired(correction: Correction) -> None:
    correction.delete(5)
    found = correction.broken()
    assert found is not None
    assert lines(correction)[4] == "keep(mug1, microwave1, in)"
    assert found == (5, "not while the inside of microwave1 is behind a closed door")
    with pytest.raises(TmdError, match=r"step 5, keep\(mug1, microwave1, in\), does not apply"):
        correction.segments()
    assert [str(i) for i in correction.repair()] == ["open(microwave1_door)"]
    assert correction.broken() is None
    assert served(correction) == PLAN
    assert correction.undo()
    assert correction.broken() == found
    assert correction.redo()
    assert correction.broken() is None


def test_an_object_is_swapped_everywhere_or_in_one_step(correction: Correction) -> None:
    assert correction.swap("mug1", "cup1", 3) == 1
    assert lines(correction)[:3] == ["find(mug1)", "moveto(mug1)", "grasp(cup1)"]
    assert correction.undo()
    assert correction.swap("mug1", "cup1") == 4
    assert correction.broken() is None
    assert ("grasp(cup1)", 0) in served(correction)
    assert "grasp(mug1)" in [str(step.instruction) for step in correction.proposed]
    assert correction.swap("bowl1", "cup1") == 0


def test_parts_are_swapped_with_their_whole(correction: Correction) -> None:
    before = correction.steps
    assert correction.swap("microwave1", "fridge1", 5) == 1
    assert lines(correction)[4] == "open(fridge1_door)"
    with pytest.raises(TmdError, match='"counter1" in grasp\\(counter1\\) is of type "counter"'):
        correction.swap("mug1", "counter1")
    assert correction.undo()
    assert correction.steps == before


def test_steps_are_inserted_and_moved(correction: Correction) -> None:
    correction.insert(10, parse_instruction("open(microwave1_door)"))
    assert correction.broken() is None
    assert correction.steps[-1].clause == 1
    correction.insert(1, parse_instruction("find(cup1)"))
    correction.move(1, 2)
    assert lines(correction)[:3] == ["find(mug1)", "find(cup1)", "moveto(mug1)"]
    correction.move(11, 8)
    assert correction.broken() is not None


def test_what_cannot_be_edited(correction: Correction) -> None:
    before = correction.steps
    for edit, why in [
        (lambda: correction.delete(0), "no step 0"),
        (lambda: correction.delete(10), "no step 10"),
        (lambda: correction.move(1, 10), "no step 10"),
        (lambda: correction.insert(11, parse_instruction("wait()")), "no place 11"),
        (lambda: correction.insert(1, parse_instruction("fly()")), 'unknown action "fly"'),
        (lambda: correction.swap("mug1", "mugg"), "no object 'mugg'"),
        (lambda: correction.swap("mug", "mug1"), "no object 'mug'"),
        (lambda: correction.swap("mug1", "cup1", 10), "no step 10"),
    ]:
        with pytest.raises(TmdError, match=why):
            edit()
    assert correction.steps == before


def test_what_can_never_be_done_is_not_repaired(correction: Correction) -> None:
    correction.insert(1, parse_instruction("keep(fork1, microwave1, in)"))
    with pytest.raises(TmdError, match=r"keep\(fork1, microwave1, in\) can never be done here"):
        correction.repair()
    correction.undo()
    assert correction.broken() is None


@settings(max_examples=25)
@given(
    edits=st.lists(
        st.tuples(st.sampled_from(["delete", "move", "swap"]), st.integers(1, 9), st.integers(1, 9)), max_size=3
    )
)
def test_mending_makes_any_edited_plan_work_or_says_why_not(
    kitchen: Corpus, kitchen1: World, edits: list[tuple[str, int, int]]
) -> None:
    found = Correction(kitchen1, TEXT, [DemonstratedStep(parse_instruction(i), c) for i, c in PLAN], kitchen.lexicon)
    for edit, one, other in edits:
        if edit == "delete" and one <= len(found.steps):
            found.delete(one)
        elif edit == "move" and max(one, other) <= len(found.steps):
            found.move(one, other)
        elif edit == "swap":
            found.swap("mug1", "cup1", min(one, len(found.steps)) if found.steps else None)
    last = 0
    while (broken := found.broken()) is not None:
        assert broken[0] > last
        assert not validate(kitchen1.task.problem, [s.instruction for s in found.steps]).valid
        last = broken[0]
        try:
            assert found.repair()
        except TmdError as error:
            assert "\n" not in str(error)
            return
    assert validate(kitchen1.task.problem, found.instructions).valid
