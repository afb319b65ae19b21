"""Goals on the page: in words, ticked off at the step after which they hold, and told from mere executability."""

from __future__ import annotations

import json
import re
from dataclasses import replace

import pytest

from tests.bundled import kit
from tests.view.conftest import corpus
from tests.view.reading import Reader
from tmd.diagnostics import TmdError
from tmd.ground import Grounded, ground
from tmd.inference.ranking import StepGoal
from tmd.knowledge import known
from tmd.pddl.model import TRUE, Formula, GroundAtom
from tmd.pddl.plan_file import parse_instruction
from tmd.pddl.reading.reader import with_goal
from tmd.records.grounding import GroundingRecord
from tmd.view.candidates import candidates
from tmd.view.goals import ShownGoal, all_reached, doubts, followed
from tmd.view.grounding_record import grounding_record
from tmd.view.meaning import meanings
from tmd.view.page import render
from tmd.view.subject import PlannedStep, Subject, grounded_subject
from tmd.world.world import World

TEXT = "Open the drawer. Take the key and put it on the table. Close the drawer. Close the drawer."
PLAN = [
    "moveto(desk1)",
    "open(desk1_drawer)",
    "grasp(key1, desk1_drawer, in)",
    "moveto(table1)",
    "keep(key1, table1, on)",
]


@pytest.fixture(scope="module")
def study() -> World:
    return corpus("03_drawer").world("study1")


def condition(world: World, text: str) -> Formula:
    return with_goal(world.task.problem, text).goal


def standing(world: World, text: str, *, already: bool = False, last: int = 0) -> ShownGoal:
    goal = StepGoal(0, "", condition(world, text), already=already, last=last)
    (found,) = followed([goal], world.task.problem, map(parse_instruction, PLAN))
    return found


def test_when_a_goal_holds(study: World) -> None:
    assert standing(study, "(opened desk1_drawer)", last=2).standing == "holds after step 2"
    assert standing(study, "(holding pr2 key1)", last=3).standing == "holds after step 3, until step 5"
    assert standing(study, "(not (opened desk1_drawer))", already=True).standing == "already so, until step 2"
    assert standing(study, "(at pen1 desk1 on)", already=True).standing == "already so"
    assert standing(study, "(opened desk1_drawer)", already=True, last=4).standing == "already so since step 2"
    assert standing(study, "(at pen1 table1 on)", last=5).standing == "not reached"
    assert standing(study, "(at key1 table1 on)", last=99).standing == "not reached"


def test_what_has_no_goal_is_told(study: World) -> None:
    notes = ("the condition does not hold", "a guess: nobody has shown what 'fly' means", "nothing that a state shows")
    goals = [
        StepGoal(0, "", None, note=notes[0]),
        StepGoal(0, "", None, note=notes[1]),
        StepGoal(0, "", TRUE, note=notes[2]),
    ]
    shown = followed(goals, study.task.problem, ())
    assert [s.told for s in shown] == [f"nothing is done: {notes[0]}", notes[1], notes[2]]
    assert [s.standing for s in shown] == ["", "", ""]
    assert all_reached([shown[0], shown[2]]) and not all_reached(shown)


@pytest.fixture(scope="module")
def told(study: World) -> Grounded:
    knowledge = known(corpus("03_drawer"))
    return ground(TEXT, study, knowledge.library, reward=knowledge.reward, goals=knowledge.goals)


def subject_of(told: Grounded) -> Subject:
    return grounded_subject(TEXT, told.world, told.parsed, told.plans, told.rejected)


def test_the_page_ticks_goals_off(told: Grounded) -> None:
    html = render(subject_of(told)).html
    reader = Reader(html)
    assert "✓ reaches its goals" in reader.text and "✗" not in reader.text
    assert len(reader.of_class("goals")) == 1
    assert "(already so)" not in reader.text and "already so" in reader.text
    for words in ("the drawer desk1_drawer is open", "key1 is on table1"):
        assert words in reader.text
    step = next(n for n, i in enumerate(told.plans[0].instructions, start=1) if str(i) == "keep(key1, table1, on)")
    place = html.index(f'id="step-{step}"')
    assert place < html.index("key1 is on table1", place) < html.index(f'id="step-{step + 1}"')


def test_goals_that_are_not_reached_are_no_tick(told: Grounded, study: World) -> None:
    wrong = StepGoal(0, "x", condition(study, "(at pen1 table1 on)"), last=1)
    plan = replace(told.plans[0], goals=(wrong, *told.plans[0].goals[1:]))
    reader = Reader(render(replace(subject_of(told), plans=(plan,))).html)
    assert "✗ executable, but not all of its goals are reached" in reader.text and "not reached" in reader.text


def test_executable_is_not_reached(study: World) -> None:
    steps = tuple(PlannedStep(parse_instruction(text)) for text in PLAN)
    assert "✓ executable:" in Reader(render(Subject("x", study.task.problem, steps)).html).text
    aimed = with_goal(study.task.problem, "(at key1 table1 on)")
    assert "✓ reaches its goal:" in Reader(render(Subject("x", aimed, steps)).html).text


def again(told: Grounded) -> GroundingRecord:
    """What was printed of a text, read back."""
    made_with = {
        "version": "0", "model": "goals", "weights": "goals", "planner": "in-process", "beam": 8, "trim": None, "top": 1
    }  # fmt: skip
    record = grounding_record(told, domain="03_drawer", environment_file=None, made_with=made_with)
    return GroundingRecord.from_text(json.dumps(record.to_value()), "x.json")


def test_what_was_printed_is_read_back(told: Grounded, study: World) -> None:
    record = again(told)
    parsed, plan = record.parsed(told.parsed.text), record.ranked()[0]
    assert plan.goals == told.plans[0].goals
    assert [choice.steps for choice in plan.choices] == [choice.steps for choice in told.plans[0].choices]
    assert meanings(parsed, plan, study) == meanings(told.parsed, told.plans[0], study)


@pytest.mark.parametrize(
    "change",
    [{"pddl": "(at"}, {"pddl": "(a) (b)"}, {"pddl": "(" * 9_999}, {"last": 999}, {"first": 3}, {"clause": 99}],
    ids=["cut short", "two goals", "too deep", "after the end", "first after last", "no such clause"],
)
def test_goals_that_cannot_be_are_refused(told: Grounded, change: dict[str, object]) -> None:
    value = again(told).to_value()
    value["plans"][0]["goals"][0].update(change)
    with pytest.raises(
        TmdError, match=r"x\.json is not what tmd ground --json prints: plans\.0|a plan is for a clause"
    ):
        GroundingRecord.from_value(value, "x.json")


def test_steps_need_not_follow_the_clauses(study: World) -> None:
    """A clause may be two steps, and none: the choices are those of the goals."""
    text = "When you have opened the drawer, take the key. Leave the pen where it is. Put the key on the table."
    knowledge = known(corpus("03_drawer"))
    found = ground(text, study, knowledge.library, reward=knowledge.reward, goals=knowledge.goals)
    assert [goal.clause for goal in found.plans[0].goals] == [0, 0, 2]
    assert [len(c.steps) for c in again(found).ranked()[0].choices] == [len(c.steps) for c in found.plans[0].choices]
    meant = meanings(found.parsed, found.plans[0], study)
    assert meant[0]["key"] == ("key1",) and meant[2]["table"] == ("table1",)
    reader = Reader(render(grounded_subject(text, study, found.parsed, found.plans)).html)
    assert "✓ reaches its goals" in reader.text
    assert re.findall(r'<tr><th scope="row">(\d)</th>', candidates(found.plans)) == ["1", "1", "3"]
    assert re.findall(r"<li value=\"(\d)\">", candidates(found.plans, narrow=True)) == ["1", "1", "3"]


def test_what_is_left_open_or_in_a_hand_is_doubtful_unless_it_was_asked_for(study: World) -> None:
    def told(text: str) -> list[str]:
        grounded = ground(text, study, known(corpus("03_drawer")).library)
        return doubts(grounded.parsed, grounded.plans[0], study)

    assert told("Open the drawer.") == []
    assert told("Put the key on the table.") == []
    assert told("Put the key on the table. Close the drawer.") == []
    grounded = ground("Put the key on the table.", study, known(corpus("03_drawer")).library)
    opened = 1 << study.task.index[GroundAtom("opened", ("desk1_drawer",))]
    untidy = replace(grounded.plans[0], state=grounded.plans[0].state | opened)
    left = "left at the end, not asked for: the drawer desk1_drawer is open"
    assert doubts(grounded.parsed, untidy, study) == [left]


@pytest.mark.parametrize(
    ("domain", "environment", "text", "left"),
    [
        ("kitchen", "kitchen4", "Close the fridge.", ()),  # its inside is behind a closed door
        ("kitchen", "kitchen5", "Turn the tap on.", ()),  # its handle stands at high
        ("lab_bench", "lab2", "The hotplate should be on low.", ()),  # its plate is active
        ("lab_bench", "lab1", "Put the sample in the centrifuge.", ()),  # its lid is shut again
        ("lab_bench", "lab1", "Spin the sample tube.", ("(active centrifuge1_rotor)",)),  # as demonstrations leave it
    ],
)
def test_what_follows_from_a_goal_is_not_doubtful(
    domain: str, environment: str, text: str, left: tuple[str, ...]
) -> None:
    grounded = kit(domain).ground(text, environment)
    lines = doubts(grounded.parsed, grounded.plans[0], grounded.world)
    assert lines == [f"left at the end, not asked for: {words}" for words in left]


def test_what_was_named_and_is_not_touched_is_doubtful(study: World) -> None:
    grounded = ground("Put the key on the table.", study, known(corpus("03_drawer")).library)
    plan = grounded.plans[0]
    idle = replace(plan, choices=tuple(replace(choice, steps=()) for choice in plan.choices), state=study.task.init)
    lines = doubts(grounded.parsed, idle, study)
    assert "'key' was named, and no step touches key1" in lines
