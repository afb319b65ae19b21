"""Detours are left out; what is left does the same."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from tmd.library.library import tidy
from tmd.pddl.model import Instruction
from tmd.pddl.plan_file import parse_instruction
from tmd.pddl.validator import validate
from tmd.world.corpus import Corpus
from tmd.world.world import run

TAKE = ("find(mug1)", "moveto(mug1)", "grasp(mug1)")
STEPS = (*TAKE, "moveto(sink1)", "keep(mug1, sink1, in)", "release(mug1)", "turn(sink1_handle, high)", "wait()")


def tidied(kitchen: Corpus, *lines: str) -> list[str]:
    world = kitchen.world("kitchen1")
    return [str(i) for i in tidy([parse_instruction(line) for line in lines], world, world.task.init)]


def test_what_changes_nothing_is_left_out(kitchen: Corpus) -> None:
    assert tidied(kitchen, "find(mug1)", *TAKE, "find(mug1)") == list(TAKE)


def test_a_way_there_and_back_is_left_out(kitchen: Corpus) -> None:
    assert tidied(kitchen, *TAKE, "moveto(sink1)", "turn(sink1_handle, high)", "moveto(mug1)", "moveto(sink1)") == [
        *TAKE,
        "moveto(sink1)",
        "turn(sink1_handle, high)",
    ]


def test_waiting_is_kept(kitchen: Corpus) -> None:
    assert tidied(kitchen, "wait()", "wait()") == ["wait()", "wait()"]


def test_what_can_never_be_done_is_kept(kitchen: Corpus) -> None:
    assert tidied(kitchen, "grasp(stove1)") == ["grasp(stove1)"]


@given(lines=st.lists(st.sampled_from(STEPS), max_size=14))
def test_the_end_is_the_same_and_what_could_be_executed_still_can(lines: list[str], kitchen: Corpus) -> None:
    world = kitchen.world("kitchen1")
    whole = [parse_instruction(line) for line in lines]
    left = tidy(whole, world, world.task.init)
    assert run(world, world.task.init, left) == run(world, world.task.init, whole)
    assert len(left) <= len(whole)
    assert left.count(Instruction("wait")) <= whole.count(Instruction("wait"))
    assert tidy(left, world, world.task.init) == left
    if validate(world.task.problem, whole).valid:
        assert validate(world.task.problem, left).valid
