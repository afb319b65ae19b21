"""The instructions of a segment are divided among its clauses."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmd.language import parse
from tmd.library.clause_alignment import split
from tmd.pddl.model import Instruction
from tmd.pddl.plan_file import parse_instruction
from tmd.world.corpus import Corpus

TAKE = ("find(mug1)", "moveto(mug1)", "grasp(mug1)")
PUT = ("moveto(sink1)", "keep(mug1, sink1, in)")
RUN = ("turn(sink1_handle, high)", "turn(sink1_handle, off)")


def divided(kitchen: Corpus, text: str, *lines: str) -> list[list[str]]:
    world = kitchen.world("kitchen1")
    instructions = [parse_instruction(line) for line in lines]
    clauses = parse(text, kitchen.lexicon).clauses
    found = split(clauses, instructions, world.profiles, world.mentions, world.task.init)
    return [[str(i) for i in own] for own in found]


def test_one_clause_has_everything(kitchen: Corpus) -> None:
    assert divided(kitchen, "fill the mug", *TAKE, *PUT, *RUN) == [[*TAKE, *PUT, *RUN]]


def test_each_clause_has_what_is_about_its_objects(kitchen: Corpus) -> None:
    text = "Take the mug. Put it in the sink. Turn on the tap."
    assert divided(kitchen, text, *TAKE, *PUT, *RUN) == [list(TAKE), list(PUT), list(RUN)]


def test_a_clause_that_nothing_was_done_for_has_nothing(kitchen: Corpus) -> None:
    text = "Take the mug. Smile at the spoon."
    first, *rest = divided(kitchen, text, *TAKE)
    assert first == list(TAKE)
    assert not any(rest)


def test_no_instructions(kitchen: Corpus) -> None:
    assert divided(kitchen, "take the mug and put it in the sink") == [[], []]


@pytest.mark.parametrize("text", ["Take the mug and put it in the sink, then open the tap.", "Take it. Boil it. Wait."])
@given(lines=st.lists(st.sampled_from((*TAKE, *PUT, *RUN, "wait()", "grasp(nothing7)")), max_size=9))
def test_nothing_is_lost_and_the_order_is_kept(text: str, lines: list[str], kitchen: Corpus) -> None:
    found = divided(kitchen, text, *lines)
    assert [line for own in found for line in own] == [str(parse_instruction(line)) for line in lines]
    assert len(found) == len(parse(text, kitchen.lexicon).clauses)
    assert Instruction("wait") == parse_instruction("wait()")
