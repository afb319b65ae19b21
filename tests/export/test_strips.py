"""Plan-resolved STRIPS: its plan works, and whatever it allows the problem allows."""

from __future__ import annotations

from random import Random

import pytest

from tests.export.conftest import Val, planned_case, random_planned
from tmd.export.planned_problem import Planned, planned
from tmd.export.strips import strips
from tmd.pddl import semantics
from tmd.pddl.model import TRUE, Atom, Instruction, State, conjuncts
from tmd.pddl.reading.reader import parse_domain, parse_problem
from tmd.pddl.validator import validate
from tmd.pddl.writer import format_domain, format_problem

SEEDS = 60
WALK = 12


def test_its_plan_works(source: Planned) -> None:
    found = strips(source)
    assert validate(found.problem, found.plan).valid
    assert tuple(found.instructions[step.name] for step in found.plan) == source.plan


def test_it_is_strips(source: Planned) -> None:
    domain = strips(source).problem.domain
    assert domain.requirements == (":strips",)
    assert domain.types == ()
    for action in domain.actions:
        assert action.parameters == ()
        assert all(isinstance(part, Atom) for part in conjuncts(action.precondition))
        assert all(effect.condition == TRUE and not effect.parameters for effect in action.effects)
        assert len({effect.atom for effect in action.effects}) == len(action.effects)


def test_names_stay(source: Planned) -> None:
    found = strips(source).problem
    known = {p.name for p in source.problem.domain.predicates}
    assert {p.name for p in found.domain.predicates} <= known | {f"not_{name}" for name in known}
    assert {o.name for o in found.all_objects()} <= {o.name for o in source.problem.all_objects()}
    assert found.name == source.problem.name
    assert found.domain.name == source.problem.domain.name


@pytest.mark.parametrize("typed", [True, False])
def test_it_survives_being_written(small: Planned, typed: bool) -> None:
    problem = strips(small, typed=typed).problem
    domain = parse_domain(format_domain(problem.domain))
    assert domain == problem.domain
    assert parse_problem(format_problem(problem), domain) == problem


def test_val_reads_it_and_takes_the_plan(small: Planned, val: Val) -> None:
    found = strips(small)
    domain, problem = format_domain(found.problem.domain), format_problem(found.problem)
    assert val.parse(domain, problem) == "Errors: 0, warnings: 0"
    assert val.valid(domain, problem, "".join(f"{step.pddl()}\n" for step in found.plan))


def _follows(source: Planned, seed: int) -> None:
    """On a random walk through the export, the problem itself does the same."""
    found = strips(source)
    rng = Random(seed)
    ours, theirs = found.problem.init, source.problem.init
    shown = {p.name for p in found.problem.domain.predicates} & {p.name for p in source.problem.domain.predicates}
    for _ in range(WALK):
        steps = [Instruction(action.name) for action in found.problem.domain.actions]
        open_ = [step for step in steps if semantics.applicable(step, ours, found.problem)]
        if not open_:
            return
        step = rng.choice(open_)
        instruction = found.instructions[step.name]
        assert semantics.applicable(instruction, theirs, source.problem)
        ours = semantics.apply(step, ours, found.problem)
        theirs = semantics.apply(instruction, theirs, source.problem)
        _same(ours, theirs, shown)


def _same(ours: State, theirs: State, shown: set[str]) -> None:
    """Every atom that the export has, positive or negated, tells the truth."""
    assert {atom for atom in ours if atom.predicate in shown} <= theirs
    for atom in ours:
        if atom.predicate not in shown:
            assert atom._replace(predicate=atom.predicate.removeprefix("not_")) not in theirs


@pytest.mark.parametrize("seed", range(SEEDS))
def test_whatever_it_allows_the_problem_allows(seed: int) -> None:
    source = random_planned(seed)
    if source is None:
        pytest.skip("nothing can be done in this problem")
    found = strips(source)
    assert validate(found.problem, found.plan).valid
    assert tuple(found.instructions[step.name] for step in found.plan) == source.plan
    _follows(source, seed)


@pytest.mark.parametrize("seed", range(5))
def test_walks_in_the_kitchen(seed: int) -> None:
    _follows(planned_case("kitchen/coffee"), seed)


SWITCH = """(define (domain switches) (:requirements :strips :negative-preconditions :conditional-effects)
  (:predicates (on ?x) (not_on ?x) (free))
  (:action flip :parameters (?x) :precondition (free)
    :effect (and (when (on ?x) (not (on ?x))) (when (not (on ?x)) (on ?x))))
)"""


def switches(plan: str, names: str = "a a-b") -> Planned:
    domain = parse_domain(SWITCH)
    goal = "(on a)" if plan.count("a") % 2 else "(not (on a))"
    text = f"(define (problem p) (:domain switches) (:objects {names}) (:init (free)) (:goal {goal}))"
    return planned(parse_problem(text, domain), [Instruction("flip", (name,)) for name in plan.split()])


def test_one_instruction_that_does_two_things_is_two_actions() -> None:
    found = strips(switches("a a a"))
    assert [step.name for step in found.plan] == ["flip-a", "flip-a-2", "flip-a"]


def test_a_predicate_named_like_a_negation_is_left_alone() -> None:
    found = strips(switches("a a"))
    assert {p.name for p in found.problem.domain.predicates} == {"on", "not_on_"}
