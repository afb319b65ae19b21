"""The package ``pddl`` and back: the same task, or a refusal that says why."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.export.conftest import planned_case
from tmd.diagnostics import TmdError
from tmd.export.pddl_package import from_pddl, to_pddl
from tmd.export.planned_problem import Planned
from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.model import Problem
from tmd.pddl.reading.reader import parse_domain, parse_problem, read_problem
from tmd.pddl.validator import validate
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).resolve().parents[2]
BUNDLED = {
    folder.name: sorted((ROOT / "problems" / folder.name).glob("*.pddl"))
    for folder in sorted((ROOT / "domains").iterdir())
    if (folder / "domain.pddl").is_file()
}


def same(ours: Problem, theirs: Problem) -> bool:
    one, other = ground(ours), ground(theirs)
    return (one.atoms, one.operators, one.init, one.goal) == (other.atoms, other.operators, other.init, other.goal)


@pytest.mark.parametrize("name", BUNDLED)
def test_a_problem_of_each_bundled_domain_comes_back(name: str) -> None:
    domain = DomainFolder(ROOT / "domains" / name).domain
    problem = read_problem(BUNDLED[name][0], domain) if BUNDLED[name] else Problem("empty", domain)
    theirs = to_pddl(problem)
    assert {constant.name for constant in theirs.objects | theirs.domain.constants} == {
        known.name for known in problem.all_objects()
    }
    again = from_pddl(theirs)
    assert same(problem, again)
    assert {action.name for action in again.domain.actions} == {action.name for action in domain.actions}
    assert {*again.domain.predicates} == {*domain.predicates}
    assert (again.name, again.domain.name) == (problem.name, problem.domain.name)
    assert (again.minimize_cost, again.function_values) == (problem.minimize_cost, problem.function_values)


def test_there_and_back_is_the_same_task(small: Planned) -> None:
    again = from_pddl(to_pddl(small.problem))
    assert same(small.problem, again)
    verdict = validate(again, small.plan)
    assert verdict.valid
    assert verdict.cost == small.cost


def test_a_problem_without_its_domain_is_refused() -> None:
    from pddl.core import Problem as Theirs

    with pytest.raises(TmdError, match=r"the problem 'lone' has no domain \(set problem.domain"):
        from_pddl(Theirs("lone", domain_name="shed"))


def _theirs(more: str, effect: str = "(lit)") -> object:
    """A small problem of the package, with something more in its domain."""
    from pddl.parser.domain import DomainParser
    from pddl.parser.problem import ProblemParser

    domain = f"""(define (domain shed)
      (:requirements :strips :derived-predicates :non-deterministic :numeric-fluents)
      (:predicates (lit) (dark)) {more} (:action switch :parameters () :precondition (dark) :effect {effect}))"""
    problem = ProblemParser()("(define (problem one) (:domain shed) (:init (dark)) (:goal (lit)))")
    problem.domain = DomainParser()(domain)
    return problem


@pytest.mark.parametrize(
    ("more", "effect", "message"),
    [
        (
            "(:derived (dark) (not (lit)))",
            "(lit)",
            '"dark" is derived, so it cannot be made true or false at the start',
        ),
        ("", "(oneof (lit) (dark))", "the domain shed:.*oneof"),
        ("(:functions (level))", "(and (lit) (increase (level) 1))", "the domain shed:.*"),
    ],
)
def test_what_is_not_supported_is_named(more: str, effect: str, message: str) -> None:
    with pytest.raises(TmdError, match=message):
        from_pddl(_theirs(more, effect))


def test_what_the_package_refuses_is_told() -> None:
    domain = parse_domain("(define (domain d) (:predicates (define)) (:action a :effect (define)))")
    with pytest.raises(TmdError, match="the package pddl cannot take the problem 'p'"):
        to_pddl(parse_problem("(define (problem p) (:domain d) (:goal (define)))", domain))


def test_a_demonstration_of_the_kitchen_is_valid_there_and_back() -> None:
    source = planned_case("kitchen/ramen")
    assert validate(from_pddl(to_pddl(source.problem)), source.plan).valid
