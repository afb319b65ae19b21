"""Plans are improved as a whole: they leave what was not asked for as it was, and do nothing for nothing."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import tmd
from tests.bundled import kit
from tests.goals.conftest import end, plain_world, said, steps
from tmd.diagnostics import TmdError
from tmd.ground import restored_in
from tmd.inference.tidying import Need, PlanPart, Tidying
from tmd.language.lexicon.file import read_lexicon
from tmd.pddl.domain_traits import passing_predicates
from tmd.pddl.grounding.ground_task import ground_condition
from tmd.pddl.model import Atom, Instruction
from tmd.pddl.task import Bits, Cube
from tmd.planning.gap_filler import GapFiller
from tmd.world.corpus import Corpus
from tmd.world.world import World


def instructions(text: str) -> tuple[Instruction, ...]:
    """Read ``find cup1; grasp cup1``."""
    return tuple(Instruction(name, tuple(args)) for name, *args in (part.split() for part in text.split(";")))


def tidying(world: World, kitchen: Corpus) -> Tidying:
    passing = passing_predicates(world.task.problem.domain)
    lasting = sum(1 << bit for bit, atom in enumerate(world.task.atoms) if atom.predicate not in passing)
    restored = restored_in(world, kitchen.lexicon)
    return Tidying(world.task, GapFiller(world.task), restored, lasting, 0, lambda states: True)


def condition(world: World, *facts: str) -> tuple[Cube, ...]:
    atoms = [fact.split() for fact in facts]
    positive = sum(1 << world.task.index[a] for a in world.task.atoms if [a.predicate, *a.args] in atoms)
    return (Cube(positive, 0),)


def improved(world: World, kitchen: Corpus, *segments: tuple[str, tuple[Cube, ...]]) -> list[str]:
    plan = tuple(PlanPart(instructions(text), Need(goal)) for text, goal in segments)
    better = tidying(world, kitchen).improved(world.task.init, plan, (Cube(),))
    return [str(i) for segment in better for i in segment.instructions]


MILK = "moveto fridge1; open fridge1_door; find milk1; moveto milk1; grasp milk1; moveto table1; keep milk1 table1 on"


def test_a_door_is_shut_before_the_robot_goes_elsewhere(kitchen: Corpus) -> None:
    world = kitchen.world("kitchen1")
    plan = improved(world, kitchen, (MILK, condition(world, "at milk1 table1 on")))
    assert plan.index("close(fridge1_door)") < plan.index("moveto(table1)")


def test_what_was_asked_for_is_left_so(kitchen: Corpus) -> None:
    world = kitchen.world("kitchen1")
    opened = ("moveto fridge1; open fridge1_door", condition(world, "opened fridge1_door"))
    assert improved(world, kitchen, opened) == ["moveto(fridge1)", "open(fridge1_door)"]


def test_what_is_handled_for_nothing_is_left_alone(kitchen: Corpus) -> None:
    world = kitchen.world("kitchen1")
    detour = "find cup1; moveto cup1; grasp cup1; moveto table1; keep cup1 table1 on; moveto fridge1; open fridge1_door"
    plan = improved(world, kitchen, (detour, condition(world, "opened fridge1_door")))
    assert plan == ["moveto(fridge1)", "open(fridge1_door)"]


def test_a_copied_part_stays_as_it_is(kitchen: Corpus) -> None:
    world = kitchen.world("kitchen1")
    own = instructions("find cup1; moveto cup1; find cup1; grasp cup1")
    plan = (PlanPart(own, Need(fixed=True)),)
    better = tidying(world, kitchen).improved(world.task.init, plan, (Cube(),))
    assert better[0].instructions[: len(own)] == own


@pytest.mark.usefixtures("learned")
def test_hands_are_empty_unless_something_was_asked_into_them() -> None:
    scooped = said("kitchen", "kitchen4", "Put ice cream in the cup.")
    assert not any(fact.startswith("(holding") for fact in end(scooped))
    assert not any(step.startswith("release") for step in steps(scooped))
    assert "(holding pr2 cup1)" in end(said("kitchen", "kitchen4", "Hold the cup."))


def test_an_instruction_that_names_no_place_is_careless(kitchen: Corpus) -> None:
    world = kitchen.world("kitchen1")
    own = tidying(world, kitchen)
    assert {i.name for i in world.task.by_instruction if own.is_careless(i)} == {"release"}


@given(st.lists(st.integers(min_value=0), max_size=12))
@settings(max_examples=25, deadline=None)
def test_an_improved_plan_still_reaches_its_goal_and_is_no_longer(choices: Sequence[int]) -> None:
    from tests.bundled import corpus

    kitchen = corpus("kitchen")
    world = kitchen.world("kitchen1")
    plan, ends = _walk(world, choices)
    goal = (Cube(ends & ~world.task.init, world.task.init & ~ends),)
    better = tidying(world, kitchen).improved(world.task.init, (PlanPart(plan, Need(goal)),), (Cube(),))
    state = world.task.init
    for instruction in better[0].instructions:
        assert world.task.by_instruction[instruction].applicable(state)
        state = world.task.by_instruction[instruction].apply(state)
    assert goal[0].holds(state)
    assert len(better[0].instructions) <= len(plan)


def _walk(world: World, choices: Sequence[int]) -> tuple[tuple[Instruction, ...], Bits]:
    """Return an executable sequence, each instruction chosen by a number, and the state in which it ends."""
    state, plan = world.task.init, []
    for number in choices:
        usable = [o for o in world.task.operators if o.applicable(state)]
        plan.append(usable[number % len(usable)].instruction)
        state = usable[number % len(usable)].apply(state)
    return tuple(plan), state


def test_a_lexicon_says_what_is_restored(kitchen: Corpus, tmp_path: Path) -> None:
    world = kitchen.world("kitchen1")
    door = ground_condition(world.task, Atom("opened", ("fridge1_door",)))
    assert door in restored_in(world, kitchen.lexicon)
    (tmp_path / "lexicon.yaml").write_text("restored: []\n", encoding="utf-8")
    assert restored_in(world, read_lexicon(tmp_path / "lexicon.yaml")) == ()


FARM = """
(define (domain farm) (:requirements :typing) (:types cow field)
  (:predicates (herder ?f - field) (grazes ?c - cow ?f - field) (shut ?f - field))
  (:action drive :parameters (?c - cow ?a ?b - field) :precondition (and (herder ?a) (grazes ?c ?a))
    :effect (and (herder ?b) (grazes ?c ?b) (not (herder ?a)) (not (grazes ?c ?a))))
  (:action walk :parameters (?a ?b - field) :precondition (herder ?a)
    :effect (and (herder ?b) (not (herder ?a))))
  (:action close :parameters (?f - field) :precondition (herder ?f) :effect (shut ?f)))
"""
FIELDS = """
(define (problem two) (:domain farm) (:objects rosa lotte - cow north south - field)
  (:init (herder south) (grazes rosa north) (grazes lotte south)) (:goal (and)))
"""


def test_of_ways_of_one_length_that_is_taken_which_moves_less(tmp_path: Path) -> None:
    folder = plain_world(tmp_path, FARM, FIELDS)
    grounded = tmd.load_domain(str(folder)).ground("Close the north field.", folder / "problem.pddl")
    assert [str(step) for step in steps(grounded)] == ["walk(south, north)", "close(north)"]


@pytest.mark.parametrize("text", ["restored: opened\n", "restored: {opened: true}\n", "restored: [[a]]\n"])
def test_a_list_of_conditions_is_expected(text: str, tmp_path: Path) -> None:
    (tmp_path / "lexicon.yaml").write_text(text, encoding="utf-8")
    with pytest.raises(TmdError) as caught:
        read_lexicon(tmp_path / "lexicon.yaml")
    assert caught.value.location is not None and caught.value.location.line == 1


def test_a_tap_runs_only_while_something_is_under_it(kitchen: Corpus) -> None:
    world = kitchen.world("kitchen1")
    filling = "find cup1; moveto cup1; grasp cup1; moveto sink1; turn sink1_handle high; keep cup1 sink1 in"
    plan = improved(world, kitchen, (filling, condition(world, "contains cup1 water")))
    assert plan[-3:] == ["keep(cup1, sink1, in)", "turn(sink1_handle, high)", "turn(sink1_handle, off)"]


def test_what_was_taken_goes_back_to_where_it_was(kitchen: Corpus) -> None:
    world = kitchen.world("kitchen1")
    elsewhere = (
        "moveto fridge1; open fridge1_door; find milk1; moveto milk1; grasp milk1; moveto fridge1; close fridge1_door;"
        " find cup1; moveto cup1; open milk1; pour milk1 cup1; close milk1; moveto counter1; keep milk1 counter1 on"
    )
    plan = improved(world, kitchen, (elsewhere, condition(world, "contains cup1 milk")))
    assert plan[-2:] == ["keep(milk1, fridge1, in)", "close(fridge1_door)"]


def test_things_are_put_down_rather_than_dropped(kitchen: Corpus) -> None:
    world = kitchen.world("kitchen1")
    dropping = "find spoon1;moveto spoon1;grasp spoon1;find cup1;moveto cup1;grasp cup1;release spoon1"
    carrying = "moveto table1;keep cup1 table1 on"
    goal = condition(world, "at cup1 table1 on")
    plan = improved(world, kitchen, (dropping, (Cube(),)), (carrying, goal))
    assert not any(step.startswith("release") for step in plan)


@pytest.mark.usefixtures("learned")
@pytest.mark.parametrize(
    ("environment", "text", "once"),
    [
        ("kitchen2", "Boil the kettle, then pour the hot water in the glass.", "wait()"),
        ("kitchen3", "Fill the cup with water and do the same with the glass.", "keep(cup1, fridge1_dispenser, in)"),
    ],
)
def test_what_an_earlier_step_did_is_not_done_again(environment: str, text: str, once: str) -> None:
    grounded = kit("kitchen").ground(text, environment)
    assert [str(i) for i in grounded.plans[0].instructions].count(once) == 1


@pytest.mark.usefixtures("learned")
def test_milk_is_not_heated_by_hot_coffee() -> None:
    grounded = kit("kitchen").ground("I would like some hot milk.", "kitchen2")
    plan = grounded.plans[0]
    assert not any("coffee" in str(a) for a in grounded.world.task.names(plan.state & ~grounded.world.task.init))


def test_nothing_goes_through_another_vessel(kitchen: Corpus) -> None:
    world = kitchen.world("kitchen1")
    detour = (
        "find spoon1;moveto spoon1;grasp spoon1;find sugar_bowl1;moveto sugar_bowl1;scoopfrom spoon1 sugar_bowl1;"
        "find cup1;moveto cup1;scoopto spoon1 cup1;grasp cup1;find mug1;moveto mug1;pour cup1 mug1"
    )
    plan = improved(world, kitchen, (detour, condition(world, "contains mug1 sugar")))
    assert "scoopto(spoon1, mug1)" in plan
    assert not any("cup1" in step for step in plan)
