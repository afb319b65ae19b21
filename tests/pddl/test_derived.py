"""What is derived: from itself as well, and written out where planners do not know it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmd.diagnostics import TmdError
from tmd.pddl.derived import strata, unfolded, without_derived
from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.model import GroundAtom, Instruction, Problem, universe
from tmd.pddl.reading.reader import parse_domain, parse_problem, with_goal
from tmd.pddl.semantics import bindings, close, holds, instantiate
from tmd.pddl.validator import validate
from tmd.pddl.writer import format_domain, format_problem

CANAL = Path(__file__).parent / "cases" / "canal"
WAYS = """\
(define (domain ways)
  (:requirements :strips :typing :negative-preconditions :disjunctive-preconditions :derived-predicates)
  (:types town - object)
  (:predicates (road ?a ?b - town) (reach ?a ?b - town) (cut-off ?a - town) (here ?a - town) (told ?a - town))
  (:derived (reach ?x ?y) (or (road ?x ?y) (exists (?z - town) (and (road ?x ?z) (reach ?z ?y)))))
  (:derived (cut-off ?x) (forall (?y - town) (not (reach ?x ?y))))
  (:action block
    :parameters (?a ?b - town)
    :precondition (road ?a ?b)
    :effect (not (road ?a ?b)))
  (:action tell
    :parameters (?a ?b - town)
    :precondition (and (here ?a) (reach ?a ?b))
    :effect (told ?b)))
"""
TOWNS = """\
(define (problem four)
  (:domain ways)
  (:objects a b c d - town)
  (:init (here a) (road a b) (road b c) (road c d))
  (:goal (and (told d) (cut-off b))))
"""


def _towns() -> Problem:
    return parse_problem(TOWNS, parse_domain(WAYS))


def test_what_follows_from_itself_is_followed_to_the_end() -> None:
    problem = _towns()
    assert GroundAtom("reach", ("a", "d")) in problem.init
    assert GroundAtom("reach", ("d", "a")) not in problem.init
    assert {atom.args for atom in problem.init if atom.predicate == "cut-off"} == {("d",)}
    shorter = close(problem.init - {GroundAtom("road", ("b", "c"))}, problem)
    assert GroundAtom("reach", ("a", "d")) not in shorter and GroundAtom("cut-off", ("b",)) in shorter


def test_a_plan_is_judged_by_what_is_derived_anew() -> None:
    problem = _towns()
    tell, block = Instruction("tell", ("a", "d")), Instruction("block", ("b", "c"))
    assert validate(problem, [tell, block]).valid
    late = validate(problem, [block, tell])
    assert late.step == 2 and "(reach a d)" in late.reason


def test_reading_what_was_written_gives_the_same() -> None:
    problem = _towns()
    domain = parse_domain(format_domain(problem.domain))
    again = parse_problem(format_problem(problem), domain)
    assert domain == problem.domain and again == problem
    assert "reach" not in format_problem(problem).split("(:goal")[0]


def test_what_is_derived_from_itself_cannot_be_written_out() -> None:
    with pytest.raises(TmdError, match='"reach" is derived from itself') as caught:
        ground(_towns())
    assert caught.value.location is not None and caught.value.location.line == 5


def test_the_order_of_derivation() -> None:
    axioms = parse_domain(WAYS).derived
    groups = strata(axioms)
    assert groups is not None
    assert [[a.head.predicate for a in group] for group in groups] == [["reach"], ["cut-off"]]


def test_written_out_conditions_mean_the_same() -> None:
    problem = parse_problem(
        (CANAL / "p01.pddl").read_text(), parse_domain((CANAL / "domain.pddl").read_text(), "domain.pddl")
    )
    plain = without_derived(problem)
    assert not plain.domain.derived and all(p.name != "busy" for p in plain.domain.predicates)
    for goal in ("(busy low)", "(free l1)", "(forall (?p - place) (busy ?p))", "(open-way low l1)"):
        asked = with_goal(problem, goal)
        assert holds(asked.goal, problem.init, problem) == holds(unfolded(asked).goal, plain.init, plain)


def test_a_rule_about_fewer_objects_does_not_hold_of_others() -> None:
    text = (
        "(define (domain d) (:requirements :typing :derived-predicates) (:types box tin - object)"
        " (:predicates (shut ?x - object) (safe ?x - object)) (:derived (safe ?t - tin) (shut ?t))"
        " (:action look :parameters () :precondition (and) :effect (shut t)))"
    )
    domain = parse_domain(text.replace("(:predicates", "(:constants t - tin b - box) (:predicates"))
    problem = parse_problem("(define (problem p) (:domain d) (:init (shut b) (shut t)) (:goal (safe b)))", domain)
    assert {str(a) for a in problem.init if a.predicate == "safe"} == {"(safe t)"}
    plain = unfolded(replace(problem, goal=problem.goal))
    assert not holds(plain.goal, plain.init, plain)


MIXED = """\
(define (domain mixed)
  (:requirements :adl :derived-predicates)
  (:types hub town - object)
  (:predicates (road ?a ?b - object) (reach ?a ?b - object) (near ?a - object) (all-near))
  (:derived (reach ?x ?y) (or (road ?x ?y) (exists (?z - town) (and (reach ?x ?z) (reach ?z ?y)))))
  (:derived (near ?x - hub) (reach a ?x))
  (:derived (near ?x - town) (forall (?h - hub) (or (near ?h) (reach ?h ?x))))
  (:derived (all-near) (forall (?h - hub) (near ?h))))
"""


@given(st.sets(st.tuples(st.sampled_from("abcd"), st.sampled_from("abcd"))))
def test_derived_atoms_are_those_that_follow_one_by_one(roads: set[tuple[str, str]]) -> None:
    text = MIXED.replace("(:predicates", "(:constants a b - town c d - hub)\n  (:predicates")
    init = " ".join(f"(road {one} {two})" for one, two in roads)
    domain = parse_domain(text)
    problem = parse_problem(f"(define (problem p) (:domain mixed) (:init {init}) (:goal (and)))", domain)
    expected = {atom for atom in problem.init if atom.predicate == "road"}
    before: set[GroundAtom] = set()
    while before != expected:
        before = set(expected)
        for axiom in domain.derived:
            for binding in bindings(axiom.parameters, universe(problem), {}):
                if holds(axiom.condition, frozenset(before), problem, binding):
                    expected.add(instantiate(axiom.head, binding))
    assert problem.init == expected
