"""Plans and instructions as text."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmd.diagnostics import TmdError
from tmd.pddl.model import Instruction
from tmd.pddl.plan_file import parse_instruction, parse_plan
from tmd.pddl.writer import format_plan

names = st.from_regex(r"[a-z][a-z0-9_-]{0,8}", fullmatch=True)
instructions = st.builds(Instruction, names, st.lists(names, max_size=4).map(tuple))


@given(instructions)
def test_an_instruction_survives_being_written(instruction: Instruction) -> None:
    assert parse_instruction(str(instruction)) == instruction
    assert str(parse_instruction(str(instruction))) == str(instruction)


@given(st.lists(instructions), st.booleans(), st.none() | st.integers(0, 999))
def test_a_plan_survives_being_written(plan: list[Instruction], unit: bool, cost: int | None) -> None:
    read = parse_plan(format_plan(plan, cost, unit=unit))
    assert read.instructions == tuple(plan)
    assert not read.warnings


@given(st.text())
def test_any_text_is_an_instruction_or_a_clear_error(text: str) -> None:
    try:
        parse_instruction(text)
    except TmdError as error:
        assert "\n" not in error.message


@pytest.mark.parametrize(
    ("text", "line", "column", "message"),
    [
        ("(a b\n", 1, 1, "this step is not closed"),
        ("(a b)\n(c\n(d)\n", 2, 1, "this step is not closed"),
        ("(a b!c)\n", 1, 4, '"b!c" is not a name'),
        ("0.000: (a b!c) [1.0]\n", 1, 11, '"b!c" is not a name'),
        ("0.000: (a b) [1.0]\n(c)\n", 2, 1, "this line has no time"),
        ("a b\n", 1, 1, "there is no plan in this text"),
        ("Reading.\nNo solution: it is unsolvable.\n", 2, 1, "there is no plan here: none was found"),
        ("Solution found!\n(a b)\nPlan length: 3 step(s).\n", 2, 1, "it has 3 steps, and 1 stand here"),
    ],
)
def test_faults_of_plans(text: str, line: int, column: int, message: str) -> None:
    with pytest.raises(TmdError) as caught:
        parse_plan(text, "x.plan")
    assert message in caught.value.message
    assert caught.value.location is not None
    assert (caught.value.location.line, caught.value.location.column) == (line, column)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("keep mug1", "is not an instruction"),
        ("keep(mug1", "is not an instruction"),
        ("keep(mug1,,on)", "a name is missing"),
        ("keep(mug1, on,)", "a name is missing"),
        ("(mug1)", "a name is missing"),
        ("keep(mug1, o n)", '"o n" is not a name'),
        ("  keep(mug1, (on))", '"(on)" is not a name'),
        ("", "is not an instruction"),
    ],
)
def test_faults_of_instructions(text: str, message: str) -> None:
    with pytest.raises(TmdError) as caught:
        parse_instruction(text)
    assert message in caught.value.message


def test_spaces_and_case_do_not_matter() -> None:
    assert parse_instruction(" Keep ( Mug1 ,counter1,  ON ) ") == Instruction("keep", ("mug1", "counter1", "on"))
    assert parse_plan("\ufeff  (GRASP  mug1 ) ; now\r\n").instructions == (Instruction("grasp", ("mug1",)),)


POPF = """Number of literals: 9
Constructing lookup tables: [10%] [100%]
b (2.000 | 6.001)
; Plan found with metric 6.001
;;;; Solution Found
; States evaluated: 9
0.000: (grasp mug1)  [9.000]
;;;; Solution Found
; Cost: 6.001
; Time 0.01
0.000: (grasp mug1)  [5.000]
5.001: (wait)  [1.000]
"""


@pytest.mark.parametrize(
    "text",
    [
        "(grasp mug1)\n(wait)\n; cost = 2 (unit cost)\n",
        "0.000: (grasp mug1) [5.000]\n5.001: (wait) [1.000]\n",
        "0: (GRASP MUG1)\n1: (WAIT)\n",
        "5.0005: (wait) [D:1.000; C:0.1]\n0.0003: (grasp mug1) [D:5.001; C:0.1]\n",
        POPF,
        "plan: \n0:\t(grasp mug1)\t[5]\n5:\t(wait)\t[1]\n",
    ],
    ids=["ipc", "val", "steps", "lpg", "popf", "plansys2"],
)
def test_forms_of_plans(text: str) -> None:
    assert parse_plan(text).instructions == (Instruction("grasp", ("mug1",)), Instruction("wait"))


def test_a_plan_whose_instructions_overlap_says_where() -> None:
    plan = parse_plan("1.000: (b) [1.0]\n0.000: (a) [2.0]\n", "x.plan")
    assert plan.instructions == (Instruction("a"), Instruction("b"))
    assert [warning.partition(": ")[0] for warning in plan.warnings] == ["x.plan:1:8"]
    assert not parse_plan("0.000: (a) [1.0]\n1.000: (b) [1.0]\n").warnings


@given(st.text(alphabet="()[]:;. \t\nab01D\u0660"))
def test_any_text_is_a_plan_or_a_clear_error(text: str) -> None:
    try:
        parse_plan(text)
    except TmdError as error:
        assert "\n" not in error.message
