from __future__ import annotations

from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from tmd.inference.ranking import StepGoal
from tmd.pddl.model import GroundAtom, Instruction
from tmd.pddl.plan_file import parse_instruction
from tmd.pddl.reading.reader import with_goal
from tmd.studio.environment_view import Setting
from tmd.view.goals import in_words
from tmd.view.panels import changed, goal_list, notice, object_facts, step_list
from tmd.view.subject import PlannedStep
from tmd.world.world import World


@given(st.text())
def test_what_people_type_is_text(typed: str) -> None:
    said = typed + "<script>alert(1)</script><b>"
    for html in (
        notice(said, said),
        notice(said, fault=True),
        step_list([PlannedStep(Instruction(said, (said,)), said, latent=True)], 1),
        "".join(changed([GroundAtom("p", (said,))], [])),
    ):
        assert "<script" not in html
        assert "<b>" not in html


def test_goals_are_ticked_where_they_hold(kitchen1: World) -> None:
    problem = kitchen1.task.problem
    formulas = [with_goal(problem, text).goal for text in ("(hot pot1)", "(not (hot pot1))")]
    steps = [
        StepGoal(0, "x", formulas[0]),
        StepGoal(1, "y", formulas[1], already=True),
        StepGoal(2, "z", None, note="<b>"),
    ]
    goals = in_words(steps, problem)
    first, second, third = goal_list(goals, problem.init, problem).partition("</style>")[2].split("</li>")[:3]
    assert "○" in first and "pot1 and what it contains are hot" in first and "clause 1" in first
    assert "✓" in second and "already so" in second and "already so" not in first
    assert "–" in third and "nothing is done: &lt;b&gt;" in third
    assert "✓" in goal_list(goals[:1], problem.init | {GroundAtom("hot", ("pot1",))}, problem)
    assert goal_list([], problem.init, problem) == ""


def test_the_step_that_was_taken_last_is_told_by_a_sign_too() -> None:
    lines = [PlannedStep(parse_instruction(text), "clause 1") for text in ("find(pot1)", "moveto(pot1)")]
    html = step_list(lines, 1, ["<i>news</i>"])
    first, _, second = html.partition("moveto")
    assert 'aria-current="step"' in first and "▸" in first and "news" in first
    assert "aria-current" not in second


def test_an_object_is_told_in_words(kitchen1: World) -> None:
    wording = Setting(kitchen1, Path()).wording
    whole = object_facts("stove1", kitchen1, kitchen1.task.init, wording.fact)
    knob = object_facts("stove1_knob1", kitchen1, kitchen1.task.init, wording.fact)
    assert "<h4>stove1: stove</h4>" in whole and "stove1_knob1" in whole
    assert "of stove1</h4>" in knob and "stove1_burner1" in knob.partition("What controls what")[2]


def test_an_instruction_is_told_in_words(kitchen1: World) -> None:
    wording = Setting(kitchen1, Path()).wording
    for instruction, words in (
        ("moveto(pot1)", "Go and stand before pot1"),
        ("keep(pot1, sink1, in)", "Put pot1 in sink1"),
        ("turn(sink1_handle, high)", "Turn the knob sink1_handle to high"),
        ("juggle(a, b)", "juggle a, b"),
    ):
        assert wording.instruction(parse_instruction(instruction)) == words
    steps = [PlannedStep(parse_instruction(text), "clause 1") for text in ("wait()", "find(x)")]
    html = step_list(steps, 1, in_words=lambda instruction: "y" if instruction.args else "Let <time> pass")
    assert "▸ Let &lt;time&gt; pass</span>" in html and "<code>wait()</code>" in html
    assert 'title="find(x)"' in html and ">y</span>" in html and "<code>find(x)" not in html


def test_what_is_said_alike_is_told_apart(kitchen1: World) -> None:
    alike = [parse_instruction(line) for line in ("release(pot1)", "throw_up()", "throw(up)")]
    told = Setting(kitchen1, Path()).wording.by_words(alike)
    assert list(told) == ["Let pot1 fall", "throw up: throw_up()", "throw up: throw(up)"] and [*told.values()] == alike
