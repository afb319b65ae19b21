"""Costs of instructions: every planner takes the cheaper way, and a wrong cost is reported at its place."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

import pytest

from tmd.diagnostics import TmdError
from tmd.pddl.ground_formula import goal_cubes
from tmd.pddl.model import Atom
from tmd.pddl.writer import format_domain, format_problem
from tmd.planning.backends import make
from tmd.planning.result import Filled
from tmd.world.corpus import Corpus
from tmd.world.folder import DomainFolder
from tmd.world.world import World

DOMAIN = """(define (domain ferry) (:requirements :strips :typing) (:types parcel place)
  (:predicates (at ?x - parcel ?p - place) (road ?p ?q - place))
  (:action fly :parameters (?x - parcel ?p ?q - place) :precondition (at ?x ?p)
    :effect (and (at ?x ?q) (not (at ?x ?p))))
  (:action drive :parameters (?x - parcel ?p ?q - place) :precondition (and (at ?x ?p) (road ?p ?q))
    :effect (and (at ?x ?q) (not (at ?x ?p)))))"""
PROBLEM = """(define (problem coast) (:domain ferry) (:objects box - parcel a b c - place)
  (:init (at box a) (road a b) (road b c)) (:goal (and)))"""
PLANNERS = (
    "in-process",
    "in-process-first",
    pytest.param("fast-downward", marks=pytest.mark.skipif(find_spec("up_fast_downward") is None, reason="no engine")),
)


def coast(root: Path, skills: str) -> World:
    domain, problems = root / "domains" / "ferry", root / "problems" / "ferry"
    (problems / "environments").mkdir(parents=True)
    domain.mkdir(parents=True)
    (domain / "domain.pddl").write_text(DOMAIN)
    (domain / "skills.yaml").write_text(skills)
    (problems / "environments" / "coast.pddl").write_text(PROBLEM)
    return Corpus(DomainFolder(domain), problems).world("coast")


def plan(world: World, planner: str) -> list[str]:
    answer = make(planner, world.task).fill(world.task.init, goal_cubes(world.task, Atom("at", ("box", "c"))))
    assert isinstance(answer, Filled)
    return [instruction.name for instruction in answer.plan]


@pytest.mark.parametrize("planner", PLANNERS)
@pytest.mark.parametrize(("cost", "steps"), [("3", ["drive", "drive"]), ("2", None), ("1", ["fly"])])
def test_every_planner_takes_the_cheaper_way(tmp_path: Path, planner: str, cost: str, steps: list[str] | None) -> None:
    world = coast(tmp_path, f"skills: {{fly: {{skill: drive, object: x, cost: {cost}}}}}")
    found = plan(world, planner)
    assert found == steps if steps else found in (["drive", "drive"], ["fly"])


def test_other_programs_read_the_costs_in_pddl(tmp_path: Path) -> None:
    problem = coast(tmp_path, "skills: {fly: {skill: drive, object: x, cost: 3}}").task.problem
    assert "(:metric minimize (total-cost))" in format_problem(problem)
    text = format_domain(problem.domain)
    assert ":action-costs" in text
    assert "(increase (total-cost) 3)" in text
    assert "(increase (total-cost) 1)" in text


def test_without_costs_fewer_instructions_are_better(tmp_path: Path) -> None:
    world = coast(tmp_path, "skills: {fly: {skill: drive, object: x}}")
    assert not world.task.problem.minimize_cost
    assert plan(world, "in-process") == ["fly"]


@pytest.mark.parametrize(
    ("cost", "message"),
    [("-1", "greater than or equal to 0"), ("much", "a valid integer"), ('"3"', "a valid integer")],
)
def test_a_cost_is_a_whole_number_of_at_least_nought(tmp_path: Path, cost: str, message: str) -> None:
    with pytest.raises(TmdError) as raised:
        coast(tmp_path, f"skills:\n  fly: {{skill: drive, object: x, cost: {cost}}}")
    assert "skills.fly.cost" in str(raised.value)
    assert message in str(raised.value)
    place = raised.value.location
    assert place is not None
    assert place.line == 2
