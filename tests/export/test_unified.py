"""unified-planning and back; ANML and protocol buffers are read by unified-planning itself."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from tests.export.conftest import planned_case
from tmd.diagnostics import TmdError
from tmd.export.planned_problem import Planned
from tmd.export.unified import (
    from_unified_planning,
    plan_from_unified_planning,
    plan_to_unified_planning,
    to_unified_planning,
)
from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.model import Instruction
from tmd.pddl.validator import validate

pytestmark = pytest.mark.filterwarnings("ignore")
Outside = Any
"""Something of unified-planning, which ships no types."""


def test_there_and_back_is_the_same_task(small: Planned) -> None:
    problem = to_unified_planning(small.problem)
    again = from_unified_planning(problem, domain=small.problem.domain.name)
    ours, theirs = ground(small.problem), ground(again)
    assert ours.atoms == theirs.atoms
    assert ours.operators == theirs.operators
    assert (ours.init, ours.goal) == (theirs.init, theirs.goal)
    assert again.domain.name == small.problem.domain.name


def test_plans_go_there_and_back(small: Planned) -> None:
    problem = to_unified_planning(small.problem)
    plan = plan_to_unified_planning(small.plan, problem)
    assert plan_from_unified_planning(plan) == small.plan
    assert validate(from_unified_planning(problem), plan_from_unified_planning(plan)).cost == small.cost


def test_a_demonstration_of_the_kitchen_goes_there_and_back() -> None:
    source = planned_case("living_room/movie_night")
    problem = to_unified_planning(source.problem)
    names = {o.name for o in problem.all_objects}
    assert names == {o.name for o in source.problem.all_objects()}
    assert validate(from_unified_planning(problem), source.plan).valid


def test_its_validator_takes_the_plan() -> None:
    from unified_planning.engines import SequentialPlanValidator

    source = planned_case("blocks")
    problem = to_unified_planning(source.problem)
    verdict = SequentialPlanValidator().validate(problem, plan_to_unified_planning(source.plan, problem))
    assert verdict.status.name == "VALID"


def test_a_plan_that_does_not_fit_is_told() -> None:
    problem = to_unified_planning(planned_case("blocks").problem)
    for step in (Instruction("fly"), Instruction("pick-up", ("z",)), Instruction("pick-up")):
        with pytest.raises(TmdError, match="cannot be said in this problem"):
            plan_to_unified_planning([step], problem)
    with pytest.raises(TmdError, match="is not a sequence"):
        plan_from_unified_planning(object())


def _shed(change: Callable[[Outside, Outside, Outside], None]) -> Outside:
    """A small problem of unified-planning, with one thing changed."""
    import unified_planning.model as up

    problem = up.Problem("shed")
    lit = up.Fluent("lit")
    problem.add_fluent(lit, default_initial_value=False)
    action = up.InstantaneousAction("switch")
    problem.add_goal(lit())
    change(problem, lit, action)
    problem.add_action(action)
    return problem


def _adds_a_name(problem: Outside, lit: Outside, action: Outside) -> None:
    import unified_planning.model as up

    problem.add_object(up.Object("3 lamps", problem.environment.type_manager.UserType("lamp")))
    action.add_effect(lit, True)


def _adds_a_number(problem: Outside, lit: Outside, action: Outside) -> None:
    import unified_planning.model as up

    level = up.Fluent("level", problem.environment.type_manager.IntType())
    problem.add_fluent(level, default_initial_value=0)
    action.add_increase_effect(level, 1)


def _adds_a_metric(problem: Outside, lit: Outside, action: Outside) -> None:
    from unified_planning.model.metrics import MaximizeExpressionOnFinalState

    problem.add_quality_metric(MaximizeExpressionOnFinalState(problem.environment.expression_manager.Int(1)))


def _adds_time(problem: Outside, lit: Outside, action: Outside) -> None:
    import unified_planning.model as up

    problem.add_action(up.DurativeAction("burn"))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (_adds_a_name, "'3 lamps' is not a name in PDDL"),
        (_adds_a_number, "not supported: numeric fluents"),
        (_adds_a_metric, "the metric .* is not supported"),
        (_adds_time, "has durative actions, which are not supported"),
    ],
)
def test_what_is_not_supported_is_named(change: Callable[..., None], message: str) -> None:
    with pytest.raises(TmdError, match=message):
        from_unified_planning(_shed(change))


def test_conditions_of_every_kind() -> None:
    def build(problem: Outside, lit: Outside, action: Outside) -> None:
        import unified_planning.shortcuts as up

        lamp = problem.environment.type_manager.UserType("lamp")
        on = up.Fluent("on", problem.environment.type_manager.BoolType(), x=lamp)
        problem.add_fluent(on, default_initial_value=False)
        problem.add_object(up.Object("l1", lamp))
        x = up.Variable("x", lamp)
        action.add_precondition(up.Iff(lit(), up.Exists(on(x), x)))
        action.add_precondition(up.Implies(up.FALSE(), lit()))
        action.add_precondition(up.Or(up.Not(lit()), up.Forall(up.Not(up.Equals(x, problem.object("l1"))), x)))
        action.add_effect(on(x), True, forall=[x])
        action.add_effect(lit, True)

    problem = from_unified_planning(_shed(build))
    assert [o.name for o in problem.domain.constants] == ["l1"]
    assert validate(problem, [Instruction("switch")]).valid
