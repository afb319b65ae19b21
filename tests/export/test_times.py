"""PDDL 2.1 and PlanSys2: VAL takes both, and plans with times come back."""

from __future__ import annotations

import pytest

from tests.export.conftest import Val, planned_case
from tmd.export.durative import format_durative_domain, format_durative_problem, format_popf, format_temporal, token
from tmd.export.formats import FORMATS
from tmd.export.planned_problem import Planned
from tmd.export.strips import strips
from tmd.pddl.model import Instruction
from tmd.pddl.plan_file import parse_plan
from tmd.pddl.reading.reader import parse_domain


@pytest.mark.parametrize("name", ["durative", "plansys2"])
def test_val_reads_it_and_takes_the_plan(source: Planned, name: str, val: Val) -> None:
    files = FORMATS[name](source)
    assert val.parse(files["domain.pddl"], files["problem.pddl"]) == "Errors: 0, warnings: 0"
    assert val.valid(files["domain.pddl"], files["problem.pddl"], files["plan.plan"])


def test_val_refuses_two_things_at_once(val: Val) -> None:
    source = planned_case("blocks")
    files = FORMATS["durative"](source)
    hurried = files["plan.plan"].replace("[1.000]", "[1.000]").replace("1.010:", "0.500:")
    assert hurried != files["plan.plan"]
    assert not val.valid(files["domain.pddl"], files["problem.pddl"], hurried)


def test_plans_with_times_come_back(source: Planned) -> None:
    assert parse_plan(format_temporal(source.plan)).instructions == source.plan
    assert parse_plan(format_popf(source.plan)).instructions == source.plan
    plan = parse_plan(FORMATS["plansys2"](source)["plan.plan"])
    assert not plan.warnings
    assert plan.instructions == strips(source, typed=True).plan


def test_a_plan_with_times() -> None:
    plan = (Instruction("grasp", ("mug1",)), Instruction("wait"))
    assert format_temporal(plan) == "0.000: (grasp mug1) [1.000]\n1.010: (wait) [1.000]\n"
    assert format_popf(plan) == (
        ";;;; Solution Found\n; Cost: 2.010\n0.000: (grasp mug1)  [1.000]\n1.010: (wait)  [1.000]\n"
    )
    assert format_popf(()) == ";;;; Solution Found\n; Cost: 0.000\n"


def test_the_token_has_a_name_of_its_own() -> None:
    text = "(define (domain d) (:predicates (robot_free) (robot_free_)) (:action a :effect (robot_free)))"
    domain = parse_domain(text)
    assert token(domain) == "robot_free__"
    assert "(at start (not (robot_free__)))" in format_durative_domain(domain)


def test_costs_are_left_out(val: Val) -> None:
    source = planned_case("costs")
    assert source.problem.minimize_cost
    domain = format_durative_domain(source.portable.domain)
    problem = format_durative_problem(source.portable)
    assert "total-cost" not in domain + problem
    assert "(:metric minimize (total-time))" in problem
