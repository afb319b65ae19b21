"""A session is what its steps make of the environment, whatever was undone, marked or looked at in between."""

from __future__ import annotations

import unicodedata
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tmd.diagnostics import TmdError
from tmd.language.parser import MAX_WORDS
from tmd.pddl.plan_file import parse_instruction
from tmd.pddl.semantics import apply
from tmd.studio.demonstrations.clause_spans import MAX_CHARACTERS, clean, cut
from tmd.studio.demonstrations.session import MAX_STEPS, Session
from tmd.world.corpus import Corpus
from tmd.world.world import World

TEXT = "Fill the kettle with water, put it on the stove and turn the burner on. Wait until it boils."
DONE = ["find(kettle1)", "moveto(kettle1)", "grasp(kettle1)", "moveto(sink1)", "keep(kettle1, sink1, in)"]


def session(world: World, corpus: Corpus, text: str = TEXT, done: list[str] = DONE) -> Session:
    found = Session(world, text, corpus.lexicon)
    for line in done:
        found.do(parse_instruction(line))
    return found


def check(found: Session) -> None:
    """The states are those of PDDL's own semantics, and the segments are in the order of the text."""
    world = found.world
    state = world.task.init
    for number, step in enumerate(found.steps, start=1):
        before = world.task.decode(state)
        state = world.task.encode(apply(step.instruction, before, world.task.problem))
        if number == found.cursor:
            assert found.state == state
    if found.cursor == 0:
        assert found.state == world.task.init
    clauses = [step.clause for step in found.steps]
    assert all(a <= b for a, b in pairwise(clauses))
    assert all(found.steps[number - 1].clause == clause for number, clause in found.pins.items())
    assert tuple(i for s in found.segments() for i in s.instructions) == found.instructions


MOVES = st.lists(
    st.tuples(st.sampled_from(["do", "do", "do", "undo", "redo", "goto", "mark"]), st.integers(0, 10**6)), max_size=25
)


@settings(max_examples=60)
@given(moves=MOVES)
def test_a_session_is_what_its_steps_make(kitchen: Corpus, kitchen1: World, moves: list[tuple[str, int]]) -> None:
    found = Session(kitchen1, TEXT, kitchen.lexicon)
    for move, number in moves:
        if move == "do":
            able = [o for o in kitchen1.task.operators if o.applicable(found.state)]
            found.do(able[number % len(able)].instruction)
        elif move == "goto":
            found.goto(number % (len(found.steps) + 1))
        elif move == "mark":
            if found.steps:
                step, clause = number % len(found.steps) + 1, number // 50 % len(found.clauses)
                found.mark(step, clause)
                assert found.steps[step - 1].clause == clause
                assert found.steps[step - 1].marked
        else:
            before = found.steps
            moved = found.undo() if move == "undo" else found.redo()
            assert moved or found.steps == before
        check(found)
    steps, pins = found.steps, found.pins
    again = Session(kitchen1, TEXT, kitchen.lexicon, instructions=found.instructions, pins=pins)
    assert (again.steps, again.pins) == (steps, pins)
    while found.undo():
        pass
    assert found.steps == ()


def test_what_does_not_apply_is_refused_and_nothing_changes(kitchen: Corpus, kitchen1: World) -> None:
    found = session(kitchen1, kitchen)
    before = found.steps, found.state
    for line, why in [
        ("grasp(mug1)", "step 6, grasp(mug1), does not apply: needs: mug1 is within reach"),
        ("turn(sink1_handle, off)", "not while the knob sink1_handle stands at off"),
        ("keep(mug1, sink1, in)", "needs: mug1 is in a hand"),
        ("grasp(nothing)", 'unknown object "nothing"'),
        ("fly()", 'unknown action "fly"'),
    ]:
        with pytest.raises(TmdError) as caught:
            found.do(parse_instruction(line))
        assert why in str(caught.value)
    assert (found.steps, found.state) == before


def test_looking_back_undoes_nothing_but_acting_there_does(kitchen: Corpus, kitchen1: World) -> None:
    found = session(kitchen1, kitchen)
    found.goto(2)
    assert len(found.steps) == 5
    found.do(parse_instruction("find(mug1)"))
    assert [str(s.instruction) for s in found.steps] == ["find(kettle1)", "moveto(kettle1)", "find(mug1)"]
    assert found.undo()
    assert [str(s.instruction) for s in found.steps] == DONE
    assert found.redo()
    assert not found.redo()
    with pytest.raises(TmdError, match="no step 9"):
        found.goto(9)


def test_marking_one_step_moves_those_beside_it(kitchen: Corpus, kitchen1: World) -> None:
    found = session(kitchen1, kitchen)
    assert [step.clause for step in found.steps] == [0] * 5
    found.mark(3, 2)
    assert [step.clause for step in found.steps][2:] == [2, 2, 2]
    found.mark(4, 1)
    clauses = [step.clause for step in found.steps]
    assert clauses[3] == 1
    assert clauses[2] <= 1
    assert [step.marked for step in found.steps] == [False, False, False, True, False]
    for step, clause in ((0, 0), (6, 0), (1, 4), (1, -1)):
        with pytest.raises(TmdError, match="there is no"):
            found.mark(step, clause)
    assert found.undo()
    assert found.steps[2].marked


@settings(max_examples=200)
@given(text=st.text(max_size=60) | st.lists(st.sampled_from([*TEXT.split(), "and", ",", "<b>", "wait"])).map(" ".join))
def test_any_text_is_cleaned_and_cut_into_pieces_that_are_found_again(text: str, kitchen: Corpus) -> None:
    try:
        cleaned = clean(text)
    except TmdError as error:
        assert "\n" not in str(error)
        return
    assert cleaned == cleaned.strip()
    assert not any(unicodedata.category(c) in ("Cc", "Cs") for c in cleaned)
    after = 0
    for piece in cut(cleaned, kitchen.lexicon):
        assert cleaned[piece.start : piece.end] == piece.text
        assert piece.text
        assert cleaned.find(piece.text, after) == piece.start
        after = piece.end


def test_texts_that_are_refused(kitchen: Corpus, kitchen1: World) -> None:
    for text, why in [
        ("", "is empty"),
        ("\x00\x1b \u2028", "is empty"),
        ("a" * (MAX_CHARACTERS + 1), "characters"),
        ("go " * (MAX_WORDS + 1), "1,001 words"),
        ("take \ud800", "character 6"),
    ]:
        with pytest.raises(TmdError, match=why):
            Session(kitchen1, text, kitchen.lexicon)
    assert clean("take\x07the <b>cup</b>\n") == "take the <b>cup</b>"


def test_a_demonstration_has_an_end(kitchen: Corpus, kitchen1: World) -> None:
    found = session(kitchen1, kitchen, "Wait.", ["wait()"] * MAX_STEPS)
    with pytest.raises(TmdError, match="at most"):
        found.do(parse_instruction("wait()"))


def test_a_text_without_a_clause_is_one_piece(kitchen: Corpus, kitchen1: World) -> None:
    found = session(kitchen1, kitchen, "asdf", ["wait()"])
    assert [(piece.text, piece.clause) for piece in found.clauses] == [("asdf", None)]
    assert found.segments()[0].instructions == found.instructions
