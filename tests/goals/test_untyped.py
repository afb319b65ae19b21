"""Requests in a domain without types, names without separators, things that act, and means."""

from __future__ import annotations

from pathlib import Path

import pytest

import tmd
from tests.goals.conftest import assert_ends, plain_world
from tmd.language.parser import parse
from tmd.pddl.inferred_types import with_inferred_types
from tmd.pddl.model import hierarchy
from tmd.pddl.reading.reader import parse_domain, parse_problem
from tmd.pddl.validator import validate

DOMAIN = """
(define (domain cobbler)
  (:requirements :strips :negative-preconditions)
  (:predicates (shoe ?s) (boot ?s) (sandal ?s) (place ?p) (dye ?d) (tool ?t) (press ?t) (brush ?t) (apprentice ?a)
               (lies ?s ?p) (fitted ?t ?p) (dyed ?s ?d) (laceMissing ?s) (polished ?s) (minds ?a ?t) (fresh ?d))
  (:action carryAcross :parameters (?s ?from ?to)
    :precondition (and (shoe ?s) (place ?from) (place ?to) (lies ?s ?from))
    :effect (and (lies ?s ?to) (not (lies ?s ?from))))
  (:action threadInLace :parameters (?s) :precondition (and (shoe ?s) (laceMissing ?s)) :effect (not (laceMissing ?s)))
  (:action polish :parameters (?s ?t ?p) :precondition (and (shoe ?s) (brush ?t) (tool ?t) (fitted ?t ?p) (lies ?s ?p))
    :effect (polished ?s))
  (:action colour :parameters (?s ?d) :precondition (and (shoe ?s) (dye ?d) (fresh ?d)) :effect (dyed ?s ?d))
  (:action post :parameters (?a ?t) :precondition (and (apprentice ?a) (tool ?t)) :effect (minds ?a ?t)))
"""
PROBLEM = """
(define (problem monday) (:domain cobbler)
 (:objects redBoot brownBoot clog slipper bench shelf hook tan navy softBrush bigPress ida olaf)
 (:init (shoe redBoot) (shoe brownBoot) (shoe clog) (shoe slipper) (boot redBoot) (boot brownBoot) (sandal clog)
        (sandal slipper) (place bench) (place shelf) (place hook) (dye tan) (dye navy) (fresh tan) (tool softBrush)
        (tool bigPress) (brush softBrush) (press bigPress) (apprentice ida) (apprentice olaf) (fitted softBrush bench)
        (fitted bigPress hook) (lies redBoot shelf) (lies brownBoot shelf) (lies clog bench) (lies slipper hook)
        (laceMissing redBoot) (laceMissing brownBoot))
 (:goal (and)))
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return plain_world(tmp_path_factory.mktemp("cobbler"), DOMAIN, PROBLEM)


def test_predicates_that_actions_require_are_types() -> None:
    problem = parse_problem(PROBLEM, parse_domain(DOMAIN))
    typed = with_inferred_types(problem)
    types = hierarchy(typed.domain)
    kinds = {o.name: types.ancestors(o.types[0]) for o in typed.objects}
    assert kinds["softbrush"][:2] == ("brush", "tool")
    assert kinds["clog"][:2] == ("sandal", "shoe")  # boots and sandals are all the shoes
    lies = next(p for p in typed.domain.predicates if p.name == "lies")
    assert [p.types for p in lies.parameters] == [("shoe",), ("place",)]
    assert typed.init == problem.init
    assert with_inferred_types(typed) is typed


def test_plans_and_goals_are_those_of_the_problem_as_written(folder: Path) -> None:
    grounded = tmd.load_domain(str(folder)).ground("Put the clog on the hook.", folder / "problem.pddl")
    problem = parse_problem(PROBLEM, parse_domain(DOMAIN))
    assert grounded.world.task.problem.objects == problem.objects
    assert validate(problem, grounded.plans[0].instructions).valid


@pytest.mark.parametrize(
    ("text", "held", "gone"),
    [
        (
            "Carry all the boots to the hook.",
            {"(lies redboot hook)", "(lies brownboot hook)", "(lies clog bench)"},
            set(),
        ),
        ("Colour every sandal with tan.", {"(dyed clog tan)", "(dyed slipper tan)"}, {"(dyed redboot tan)"}),
        ("The brown boot has lost its lace; thread one in.", {"(lacemissing redboot)"}, {"(lacemissing brownboot)"}),
        ("Polish the slipper with the soft brush.", {"(polished slipper)"}, set()),
        ("Ida should mind the press.", {"(minds ida bigpress)"}, {"(minds olaf bigpress)"}),
    ],
)
def test_a_domain_without_types_is_read_as_one_with_them(
    folder: Path, text: str, held: set[str], gone: set[str]
) -> None:
    assert_ends(folder, text, held, gone)


def test_a_tool_that_no_action_uses_is_told(folder: Path) -> None:
    grounded = tmd.load_domain(str(folder)).ground("Polish the slipper with the press.", folder / "problem.pddl")
    assert any("'with press'" in str(warning) for warning in grounded.warnings)


def test_a_place_beside_a_state_is_asked_for_as_well() -> None:
    said = parse("The bucket should be empty and in the shed.").clauses
    assert [(clause.verb, clause.direct, [r.target for r in clause.relations]) for clause in said] == [
        ("empty", ("bucket",), []),
        ("put", ("bucket",), ["shed"]),
    ]


def test_a_particle_stays_in_its_clause() -> None:
    said = parse("Shut the window, the lamp on the desk should be off.").clauses
    assert [(clause.verb, clause.direct) for clause in said] == [("shut", ("window",)), ("turn_off", ("lamp",))]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("Colour the clog navy.", "navy"),
        ("Put the hook on the shelf.", "hook"),
    ],
)
def test_what_does_not_fit_is_told(folder: Path, text: str, reason: str) -> None:
    grounded = tmd.load_domain(str(folder)).ground(text, folder / "problem.pddl")
    assert not grounded.plans
    assert reason in grounded.reason
