"""The page: whole without anything else, the same bytes each time, and true to the plan up to where it breaks."""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Iterator
from dataclasses import replace
from hashlib import sha256

import pytest

from tests.view.conftest import TEXT, corpus
from tests.view.reading import Reader
from tmd.grounded import Grounded
from tmd.inference.ranking import Choice, PlanStep, RankedPlan, RejectedProposal
from tmd.language import parse
from tmd.language.clause import Parsed
from tmd.pddl.model import Domain, GroundAtom, Instruction, Problem, State, TypedName
from tmd.pddl.plan_file import parse_instruction
from tmd.pddl.semantics import apply
from tmd.pddl.validator import Status
from tmd.records.run import RanStep
from tmd.view.page import render, shown_steps
from tmd.view.subject import PlannedStep, Ran, Subject, grounded_subject
from tmd.world.world import World


@pytest.fixture(scope="module")
def subject(kitchen: World, grounded: Grounded) -> Subject:
    return grounded_subject(TEXT, kitchen, grounded.parsed, grounded.plans, grounded.rejected, made=[("seed", "0")])


def planned(*texts: str) -> tuple[PlannedStep, ...]:
    return tuple(PlannedStep(parse_instruction(text)) for text in texts)


def test_the_page_is_whole_and_loads_nothing(subject: Subject) -> None:
    page = render(subject)
    reader = Reader(page.html)
    assert page.verdict.valid and page.html == render(subject).html
    assert not {"link", "iframe", "object", "embed", "base", "form"} & reader.tags()
    for _, attributes in reader.elements:
        assert not any(name.startswith("on") for name in attributes)
        for name in ("src", "href"):
            assert attributes.get(name, "#").startswith(("#", "data:"))
    assert not re.search("https?:", page.html) and "url(" not in page.html
    ids = [attributes["id"] for _, attributes in reader.elements if "id" in attributes]
    targets = [a["href"][1:] for _, a in reader.elements if "href" in a]
    assert len(ids) == len(set(ids)) and set(targets) <= set(ids)


def test_the_script_is_the_one_that_the_page_allows(subject: Subject) -> None:
    html = render(subject).html
    (script,) = re.findall(r"<script>(.*?)</script>", html, re.DOTALL)
    assert f"script-src 'sha256-{b64encode(sha256(script.encode()).digest()).decode()}'" in html


def test_the_page_has_steps_facts_candidates_and_how_it_was_made(subject: Subject, grounded: Grounded) -> None:
    reader = Reader(render(subject).html)
    for number, instruction in enumerate(grounded.plans[0].instructions, start=1):
        assert {"id": f"step-{number}"}.items() <= reader.of_class("step")[number - 1].items()
        assert str(instruction) in reader.text
    assert "(contains cup1 water)" in reader.text and "clause 2" in reader.text and "seed" in reader.text
    assert all(plan.why in reader.text for plan in grounded.plans)


def test_facts_are_what_pddl_says(kitchen: World, subject: Subject) -> None:
    state: State = kitchen.task.problem.init
    for shown in shown_steps(kitchen.task.problem, subject.steps)[0]:
        after = apply(shown.planned.instruction, state, kitchen.task.problem)
        assert (set(shown.added), set(shown.removed)) == (after - state, state - after)
        state = after


def test_a_plan_that_breaks_is_shown_up_to_there(kitchen: World) -> None:
    steps = planned("find(cup1)", "grasp(cup1)", "moveto(fridge1)")
    shown, verdict = shown_steps(kitchen.task.problem, steps)
    assert verdict.status is Status.BROKEN_PRECONDITION
    assert [(s.reached, bool(s.broken)) for s in shown] == [(True, False), (True, True), (False, False)]
    reader = Reader(render(Subject("broken", kitchen.task.problem, steps)).html)
    assert "its precondition (near pr2 cup1) does not hold" in reader.text and "Not reached." in reader.text


@pytest.mark.parametrize("text", ["fly(cup1)", "grasp(cup77)", "grasp(cup1, cup1)", "grasp(pr2)", "grasp()"])
def test_nonsense_is_shown_as_the_step_that_breaks(kitchen: World, text: str) -> None:
    page = render(Subject("broken", kitchen.task.problem, planned(text)))
    assert page.verdict.status is Status.BAD_INSTRUCTION and "Here the plan breaks." in page.html


def test_a_goal_that_is_not_reached_is_told() -> None:
    from tmd.pddl.reading.reader import with_goal

    problem = with_goal(corpus("02_table").world("corner2").task.problem, "(at cup1 table1 on)")
    page = render(Subject("goal", problem, planned("moveto(book1)")))
    assert page.verdict.status is Status.GOAL_NOT_REACHED and "the goal (at cup1 table1 on) does not hold" in page.html


def ran_step(**told: object) -> RanStep:
    """A step of a run, with what is not told as it mostly is."""
    usual = {"number": 1, "repair": False, "failure": None, "evidence": None, "effects": [], "mismatches": []}
    return RanStep.model_validate({**usual, "begin": 0, "end": 1, **told})


HOSTILE = '<script>alert(1)</script><img src=x onerror="alert(2)">&amp;"\''


def test_names_and_texts_are_only_text() -> None:
    """Problems need not come from a file: whatever an object is called, it does not become an element."""
    name = HOSTILE
    problem = Problem("p", Domain("d"), (TypedName(name, (HOSTILE,)),), frozenset({GroundAtom(HOSTILE, (name,))}))
    step = PlanStep(Instruction(HOSTILE, (name,)), 0, True)
    plan = RankedPlan((Choice(HOSTILE, (step,), {HOSTILE: 1.0}, {}),), 0, HOSTILE)
    done = ran_step(
        action=HOSTILE,
        args=[name],
        outcome="failed",
        failure=HOSTILE,
        effects=[{"fact": HOSTILE, "holds": True, "basis": "assumed", "how": HOSTILE}],
    )
    page = render(
        Subject(
            HOSTILE,
            problem,
            (PlannedStep(step.instruction, HOSTILE, HOSTILE),),
            plans=(plan,),
            refusals=(RejectedProposal(0, HOSTILE, HOSTILE),),
            ran=Ran(HOSTILE, HOSTILE, steps=(done,)),
            made=((HOSTILE, HOSTILE),),
        )
    )
    reader = Reader(page.html)
    assert [tag for tag, _ in reader.elements].count("script") == 1 and "img" not in reader.tags()
    assert HOSTILE in reader.text


def test_control_characters_and_half_characters_are_replaced(kitchen: World) -> None:
    text = "Take the cup\x00\x1b \ud800 now."
    page = render(grounded_subject(text, kitchen, Parsed(text, parse("Take the cup").clauses), []))
    page.html.encode("utf-8")
    assert not re.search("[\x00-\x08\x1b\x7f]", page.html)


def there_and_back() -> Iterator[str]:
    yield "find(cup1)"
    while True:
        yield "moveto(microwave1)"
        yield "press(microwave1_open_button)"
        yield "moveto(fridge1)"
        yield "open(fridge1_door)"
        yield "close(fridge1_door)"
        yield "moveto(microwave1)"
        yield "close(microwave1_door)"


def test_a_thousand_steps_stay_below_ten_megabytes(kitchen: World) -> None:
    texts = there_and_back()
    page = render(Subject("long", kitchen.task.problem, planned(*(next(texts) for _ in range(1_000)))))
    assert page.verdict.valid, page.verdict.reason
    assert len(page.html.encode()) < 10_000_000
    reader = Reader(page.html)
    assert len(reader.of_class("step")) == 1_000


def test_what_the_robot_did_stands_at_its_step(subject: Subject) -> None:
    steps = tuple(
        ran_step(**step)
        for step in (
            {"number": 1, "action": "find", "args": ["cup1"], "outcome": "ok", "effects": [
                {"fact": "(found pr2 cup1)", "holds": True, "basis": "inferred", "how": "a ray"}]},
            {"number": 2, "action": "moveto", "args": ["cup1"], "outcome": "failed", "failure": "the way is barred"},
            {"number": 2, "action": "open", "args": ["x"], "repair": True, "outcome": "mismatch", "mismatches": [
                {"fact": "(opened x)", "expected": True, "measured": "12 degrees"}]},
            {"number": 99, "action": "wait", "args": [], "outcome": "ok"},
        )
    )  # fmt: skip
    html = render(replace(subject, ran=Ran("stopped", "it gave up", 1, 2.0, steps))).html
    first, second = html.index('id="step-1"'), html.index('id="step-2"')
    third, last = html.index('id="step-3"'), html.index('id="candidates"')
    assert first < html.index("inferred: (found pr2 cup1)") < second
    assert second < html.index("the way is barred") < html.index("12 degrees") < third
    assert html.count("robot: ✓ ok") == 2 and html.rindex("robot: ✓ ok") < last
    assert "it gave up" in html and "repairs of the plan: 1" in html
