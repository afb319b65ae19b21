"""No false alarms: PDDL of many styles, all of it valid, gives no error; random valid PDDL neither."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tmd.check.checker import Checker
from tmd.check.diagnostic import Severity
from tmd.check.pddl_file import check_domain_text, check_problem_text

CASES = {
    "blocks without types": (
        "(define (domain b) (:requirements :strips) (:predicates (on ?x ?y) (clear ?x) (holding ?x) (empty))"
        "(:action take :parameters (?x ?y) :precondition (and (on ?x ?y) (clear ?x) (empty))"
        " :effect (and (holding ?x) (clear ?y) (not (on ?x ?y)) (not (clear ?x)) (not (empty)))))",
        "(define (problem p) (:domain b) (:objects a b) (:init (on a b) (clear a) (empty)) (:goal (holding a)))",
    ),
    "gripper with types as predicates": (
        "(define (domain g) (:predicates (room ?r) (ball ?b) (at ?b ?r) (robby ?r) (carry ?b))"
        "(:action move :parameters (?f ?t) :precondition (and (room ?f) (room ?t) (robby ?f))"
        " :effect (and (robby ?t) (not (robby ?f))))"
        "(:action pick :parameters (?b ?r) :precondition (and (ball ?b) (room ?r) (at ?b ?r) (robby ?r))"
        " :effect (and (carry ?b) (not (at ?b ?r)))))",
        "(define (problem p) (:domain g) (:objects x y z) (:init (room x) (room y) (ball z) (at z y) (robby x))"
        "(:goal (carry z)))",
    ),
    "logistics with a hierarchy": (
        "(define (domain l) (:requirements :strips :typing) (:types truck plane - vehicle vehicle package - movable"
        " airport depot - place place city movable - object)"
        "(:predicates (at ?m - movable ?p - place) (in ?p - package ?v - vehicle) (of ?p - place ?c - city))"
        "(:action load :parameters (?p - package ?v - vehicle ?l - place) :precondition (and (at ?p ?l) (at ?v ?l))"
        " :effect (and (in ?p ?v) (not (at ?p ?l))))"
        "(:action drive :parameters (?t - truck ?a ?b - place ?c - city) :precondition (and (at ?t ?a) (of ?a ?c)"
        " (of ?b ?c)) :effect (and (at ?t ?b) (not (at ?t ?a)))))",
        "(define (problem p) (:domain l) (:objects t - truck k - package a - airport d - depot c - city)"
        "(:init (at t a) (at k d) (of a c) (of d c)) (:goal (in k t)))",
    ),
    "either types": (
        "(define (domain e) (:requirements :typing) (:types cat dog) (:predicates (fed ?x - (either cat dog)))"
        "(:action feed :parameters (?x - (either cat dog)) :effect (fed ?x)))",
        "(define (problem p) (:domain e) (:objects tom - cat rex - dog) (:init) (:goal (and (fed tom) (fed rex))))",
    ),
    "constants": (
        "(define (domain c) (:requirements :typing) (:types place) (:constants home - place)"
        "(:predicates (at ?p - place)) (:action go :parameters (?p - place) :precondition (at home)"
        " :effect (and (at ?p) (not (at home)))))",
        "(define (problem p) (:domain c) (:objects shop - place) (:init (at home)) (:goal (at shop)))",
    ),
    "a constant listed again": (
        "(define (domain c) (:constants home) (:predicates (at ?p)) (:action go :parameters (?p)"
        " :precondition (at home) :effect (at ?p)))",
        "(define (problem p) (:domain c) (:objects home shop) (:init (at home)) (:goal (at shop)))",
    ),
    "negative preconditions": (
        "(define (domain n) (:requirements :strips :negative-preconditions) (:predicates (on ?x))"
        "(:action flip :parameters (?x) :precondition (not (on ?x)) :effect (on ?x)))",
        "(define (problem p) (:domain n) (:objects a) (:init) (:goal (on a)))",
    ),
    "quantifiers": (
        "(define (domain q) (:requirements :adl) (:types box) (:predicates (open ?b - box) (done) (near ?a ?b - box))"
        "(:action end :precondition (and (forall (?b - box) (open ?b)) (exists (?a ?b - box) (near ?a ?b)))"
        " :effect (done)) (:action open :parameters (?b - box) :effect (forall (?c - box) (when (near ?b ?c)"
        " (open ?c)))))",
        "(define (problem p) (:domain q) (:objects a b - box) (:init (near a b) (near b a)) (:goal (done)))",
    ),
    "equality": (
        "(define (domain q) (:requirements :strips :equality :negative-preconditions) (:predicates (m ?x ?y))"
        "(:action marry :parameters (?x ?y) :precondition (not (= ?x ?y)) :effect (m ?x ?y)))",
        "(define (problem p) (:domain q) (:objects a b) (:init) (:goal (m a b)))",
    ),
    "action costs": (
        "(define (domain k) (:requirements :strips :typing :action-costs) (:types city) (:predicates (at ?c - city)"
        " (road ?a ?b - city)) (:functions (total-cost) - number (length ?a ?b - city) - number)"
        "(:action drive :parameters (?a ?b - city) :precondition (and (at ?a) (road ?a ?b))"
        " :effect (and (at ?b) (not (at ?a)) (increase (total-cost) (length ?a ?b)))))",
        "(define (problem p) (:domain k) (:objects a b - city) (:init (= (total-cost) 0) (at a) (road a b)"
        " (= (length a b) 7)) (:goal (at b)) (:metric minimize (total-cost)))",
    ),
    "costs under the name of fluents": (
        "(define (domain k) (:requirements :typing :fluents) (:predicates (p)) (:functions (total-cost))"
        "(:action a :effect (and (p) (increase (total-cost) 3))))",
        "(define (problem p) (:domain k) (:init (= (total-cost) 0)) (:goal (p)) (:metric minimize (total-cost)))",
    ),
    "upper case": (
        "(DEFINE (DOMAIN U) (:REQUIREMENTS :STRIPS) (:PREDICATES (P ?X)) (:ACTION A :PARAMETERS (?x)"
        " :PRECONDITION (AND) :EFFECT (p ?X)))",
        "(define (Problem x) (:Domain u) (:Objects O) (:INIT) (:goal (P o)))",
    ),
    "comments in odd places": (
        "; one (\n(define ; two )\n (domain ; three\n c) (:predicates ; four (((\n (p) ;; five\n)\n(:action a;six\n"
        " :effect;seven\n(p);eight\n)) ; nine\n",
        "(define (problem p) (:domain c);(\n(:init);)\n(:goal ;\n(p)))",
    ),
    "imply and or": (
        "(define (domain i) (:requirements :adl) (:predicates (p ?x) (q ?x)) (:action a :parameters (?x)"
        " :precondition (and (imply (p ?x) (q ?x)) (or (p ?x) (not (q ?x)))) :effect (p ?x)))",
        "(define (problem p) (:domain i) (:objects a) (:init) (:goal (or (p a) (q a))))",
    ),
    "no parameters and no precondition": (
        "(define (domain z) (:predicates (p)) (:action a :parameters () :effect (p)))",
        "(define (problem p) (:domain z) (:init) (:goal (p)))",
    ),
    "nested and": (
        "(define (domain z) (:predicates (p) (q) (r)) (:action a :precondition (and (and (p)) (and (and (q))))"
        " :effect (and (and (r)) (and (not (p))))))",
        "(define (problem p) (:domain z) (:init (and (p) (q))) (:goal (and (and (r)))))",
    ),
    "object as a type": (
        "(define (domain o) (:requirements :typing) (:types a - object object) (:predicates (p ?x - object))"
        "(:action s :parameters (?x - a) :effect (p ?x)))",
        "(define (problem p) (:domain o) (:objects x - a y - object) (:init (p y)) (:goal (p x)))",
    ),
    "types and objects of one name": (
        "(define (domain s) (:requirements :typing) (:types robot) (:predicates (robot ?r - robot) (go ?r - robot))"
        "(:action robot :parameters (?robot - robot) :precondition (robot ?robot) :effect (go ?robot)))",
        "(define (problem p) (:domain s) (:objects robot - robot) (:init (robot robot)) (:goal (go robot)))",
    ),
    "dashes and underscores": (
        "(define (domain d-1_x) (:predicates (is-at_2 ?x-1)) (:action do-it :parameters (?x-1)"
        " :precondition (and) :effect (is-at_2 ?x-1)))",
        "(define (problem p-1_2) (:domain d-1_x) (:objects a-1 b_2) (:init) (:goal (is-at_2 a-1)))",
    ),
    "a predicate twice in init": (
        "(define (domain t) (:predicates (p) (q)) (:action a :precondition (p) :effect (q)))",
        "(define (problem p) (:domain t) (:init (p) (p)) (:goal (q)))",
    ),
    "negated goals": (
        "(define (domain t) (:requirements :negative-preconditions) (:predicates (p))"
        "(:action a :precondition (p) :effect (not (p))))",
        "(define (problem p) (:domain t) (:init (p)) (:goal (not (p))))",
    ),
    "forall over several variables": (
        "(define (domain f) (:requirements :adl) (:types a b) (:predicates (p ?x - a ?y - b)) (:action s :effect"
        " (forall (?x - a ?y ?z - b) (when (p ?x ?y) (p ?x ?z)))))",
        "(define (problem p) (:domain f) (:objects i - a j k - b) (:init (p i j)) (:goal (p i k)))",
    ),
    "delete and add of what moves": (
        "(define (domain m) (:predicates (at ?x) (way ?x ?y)) (:action go :parameters (?x ?y)"
        " :precondition (and (at ?x)"
        " (way ?x ?y)) :effect (and (not (at ?x)) (at ?y))))",
        "(define (problem p) (:domain m) (:objects a b) (:init (at a) (way a b)) (:goal (at b)))",
    ),
    "many requirements": (
        "(define (domain r) (:requirements :strips :typing :adl :equality :negative-preconditions"
        " :quantified-preconditions :conditional-effects :action-costs) (:predicates (p)) (:action a :effect (p)))",
        "(define (problem p) (:domain r) (:requirements :strips) (:objects) (:init) (:goal (p)))",
    ),
    "constants and either": (
        "(define (domain h) (:requirements :typing) (:types car bike - thing thing) (:constants van - car)"
        "(:predicates (parked ?x - thing) (gone ?x - (either car bike))) (:action leave"
        " :parameters (?x - (either car bike)) :precondition (parked ?x) :effect (and (gone ?x) (not (parked ?x)))))",
        "(define (problem p) (:domain h) (:objects b - bike) (:init (parked b) (parked van)) (:goal (gone van)))",
    ),
    "sections in another order": (
        "(define (domain v) (:action a :effect (p)) (:predicates (p)))",
        "(define (problem p) (:goal (p)) (:init) (:domain v))",
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_valid_pddl_has_no_errors(tmp_path: Path, name: str) -> None:
    domain, problem = CASES[name]
    (tmp_path / "domain.pddl").write_text(domain)
    (tmp_path / "p01.pddl").write_text(problem)
    checker = Checker()
    checker.check(tmp_path)
    checker.finish()
    told = checker.findings.sorted()
    assert [str(d) for d in told if d.severity is Severity.ERROR] == []
    lints = {"unreachable-goal", "never-applies", "never-produced", "type-without-objects", "goal-holds"}
    assert not {d.code for d in told} & lints


def test_a_domain_without_predicates() -> None:
    assert check_domain_text("(define (domain d) (:predicates))", "d").faults == []


NAMES = [f"p{n}" for n in range(4)]


@st.composite
def conditions(draw: st.DrawFn, scope: list[str], depth: int = 2) -> str:
    kind = draw(st.sampled_from(["atom", "not", "and", "or", "forall", "exists", "imply", "="] if depth else ["atom"]))
    if kind == "atom":
        return f"({draw(st.sampled_from(NAMES))} {draw(st.sampled_from(scope))})"
    if kind == "=":
        return f"(= {draw(st.sampled_from(scope))} {draw(st.sampled_from(scope))})"
    if kind in ("forall", "exists"):
        variable = f"?v{depth}{len(scope)}"
        return f"({kind} ({variable} - t) {draw(conditions([*scope, variable], depth - 1))})"
    count = {"not": 1, "imply": 2}.get(kind) or draw(st.integers(0, 3))
    return f"({kind} {' '.join(draw(conditions(scope, depth - 1)) for _ in range(count))})"


@settings(max_examples=80, deadline=None)
@given(st.data())
def test_random_valid_pddl_has_no_errors(data: st.DataObject) -> None:
    scope = ["?x", "?y", "c"]
    actions = "\n".join(
        f"(:action a{n} :parameters (?x - t ?y - s) :precondition {data.draw(conditions(scope))}\n"
        f" :effect (and ({data.draw(st.sampled_from(NAMES))} ?x) (when {data.draw(conditions(scope))} (not (p0 ?y)))))"
        for n in range(data.draw(st.integers(1, 3)))
    )
    predicates = " ".join(f"({name} ?x - t)" for name in NAMES)
    types = "(:requirements :adl) (:types s - t t) (:constants c - t)"
    domain = f"(define (domain d) {types} (:predicates {predicates}) {actions})"
    goal = data.draw(conditions(["o", "c"]))
    problem = f"(define (problem p) (:domain d) (:objects o - s) (:init (p1 o) (p2 c)) (:goal {goal}))"
    checked = check_domain_text(domain, "d")
    faults = [*checked.faults, *check_problem_text(problem, "p", checked).faults]
    assert checked.sound
    assert {fault.code for fault in faults} <= {
        "never-applies", "unused-parameter", "unused-predicate", "parent-after-child", "goal-holds", "unreachable-goal",
        "contradictory-effects", "said-twice",
    }  # fmt: skip
