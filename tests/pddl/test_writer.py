"""Reading, writing and the portable form."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from tmd.diagnostics import TmdError
from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.model import And, Atom, Effect, Exists, Forall, Formula, Imply, Not, Or, Problem, TypedName
from tmd.pddl.normalise import portable
from tmd.pddl.reading.reader import parse_domain, parse_problem
from tmd.pddl.writer import format_domain, format_problem

from .conftest import each_random_problem

HEAD = "(define (domain d) (:requirements :adl :action-costs) (:types a b c - object s - a) "


def _effects(text: str) -> tuple[Effect, ...]:
    predicates = "(:predicates (p ?x) (q ?x) (r ?x ?y) (n)) (:functions (total-cost))"
    domain = parse_domain(f"{HEAD} {predicates} (:action act :parameters (?v) :effect {text}))")
    return domain.actions[0].effects


def test_effects_come_out_flat() -> None:
    inner = "(and (when (p ?x) (when (or (q ?x) (n)) (r ?x ?v))) (forall (?y) (not (r ?x ?y))))"
    first, second = _effects(f"(when (n) (forall (?x) {inner}))")
    assert first.parameters == (TypedName("?x"),)
    n, p = Atom("n"), Atom("p", ("?x",))
    assert first.condition == And((n, p, Or((Atom("q", ("?x",)), n))))
    assert (first.atom, first.positive) == (Atom("r", ("?x", "?v")), True)
    assert second.parameters == (TypedName("?x"), TypedName("?y"))
    assert (second.condition, second.positive) == (n, False)


def test_no_effect_is_no_effect() -> None:
    assert _effects("(and)") == _effects("()") == _effects("(when (n) (and))") == ()


def test_comments_beside_predicates_are_kept() -> None:
    text = """(define (domain d) (:predicates
      (p ?x) ; what p means
      ; a comment by itself
      (q
        ?x)  ;;  over two lines
      (m) (n)) ; of the last one
    )"""
    domain = parse_domain(text)
    assert {p.name: p.comment for p in domain.predicates} == {
        "p": "what p means",
        "q": "over two lines",
        "m": "",
        "n": "of the last one",
    }
    again = parse_domain(format_domain(domain))
    assert [p.comment for p in again.predicates] == [p.comment for p in domain.predicates]


@each_random_problem
def test_random_problems_survive(random_problem: Problem) -> None:
    domain = parse_domain(format_domain(random_problem.domain))
    assert domain == random_problem.domain
    problem = parse_problem(format_problem(random_problem), domain)
    assert problem == random_problem
    assert hash(problem) == hash(random_problem)


def _names(formula: Formula) -> Iterator[TypedName]:
    match formula:
        case Not(part):
            yield from _names(part)
        case And(parts) | Or(parts):
            for inner in parts:
                yield from _names(inner)
        case Imply(left, right):
            yield from (*_names(left), *_names(right))
        case Forall(parameters, part) | Exists(parameters, part):
            yield from (*parameters, *_names(part))
        case _:
            return


@each_random_problem
def test_portable_form_of_random_problems(random_problem: Problem) -> None:
    """The same operators and atoms, no either anywhere, every requirement by name."""
    plain = portable(random_problem)
    text = format_domain(plain.domain) + format_problem(plain)
    assert "either" not in text and ":adl" not in text
    assert parse_problem(format_problem(plain), parse_domain(format_domain(plain.domain))) == plain
    before, after = ground(random_problem), ground(plain)
    assert (before.atoms, before.init, before.goal, before.operators) == (
        after.atoms,
        after.init,
        after.goal,
        after.operators,
    )
    assert all(len(n.types) == 1 for n in _names(plain.goal))


def test_flat_effects_are_what_is_written(problem: Problem) -> None:
    text = re.sub(r"\s+", " ", re.sub(";.*", "", format_domain(problem.domain)))
    assert ":precondition ()" not in text
    assert not re.search(r"\(when \((?:[^()]|\([^()]*\))*\) \((when|and|forall)", text)


@pytest.mark.parametrize(
    ("either", "other", "fits"),
    [("a b", "a b c", True), ("a b", "b c", False), ("s b", "a", False), ("a s", "s", True), ("b a", "a b", True)],
)
def test_either_needs_siblings(either: str, other: str, fits: bool) -> None:
    predicates = f"(:predicates (p ?x - (either {either})) (q ?x - (either {other})))"
    goal = f"(:goal (exists (?x - (either {either})) (p ?x)))" if fits else "(:goal (and))"
    domain = parse_domain(f"{HEAD} {predicates})")
    problem = parse_problem(f"(define (problem x) (:domain d) (:init) {goal})", domain)
    if fits:
        assert "either" not in format_domain(portable(problem).domain) + format_problem(portable(problem))
    else:
        with pytest.raises(TmdError, match="cannot be written for other planners") as caught:
            portable(problem)
        assert caught.value.location is not None and caught.value.hint


def test_the_portable_form_is_the_problem_itself_where_it_can_be() -> None:
    domain = parse_domain("(define (domain d) (:requirements :strips) (:predicates (p)))")
    problem = parse_problem("(define (problem x) (:domain d) (:init (p)) (:goal (p)))", domain)
    assert portable(problem) == problem


@pytest.mark.parametrize("number", ["1.5", "-1", "1e3", "9" * 5000, "9" * 400 + ".0"])
def test_costs_are_whole_numbers(number: str) -> None:
    domain = parse_domain(f"{HEAD} (:predicates (p)) (:functions (total-cost) (f)))")
    text = f"(define (problem x) (:domain d) (:init (= (f) {number})) (:goal (p)))"
    with pytest.raises(TmdError, match="numbers other than whole ones"):
        parse_problem(text, domain)


def test_values_and_metric() -> None:
    domain = parse_domain(f"{HEAD} (:predicates (p)) (:functions (total-cost) (f ?x - a)))")
    text = """(define (problem x) (:domain d) (:requirements :equality) (:objects k - s m - a)
      (:init (and (p) (= (f k) 3)) (not (p2))  (= (f m) 2.0) (= (total-cost) 0))
      (:goal (not (= k m))) (:metric minimize (total-cost)))""".replace("(not (p2))", "")
    problem = parse_problem(text, domain)
    assert {str(k): v for k, v in problem.function_values.items()} == {"(f k)": 3, "(f m)": 2}
    assert problem.minimize_cost and problem.requirements == (":equality",)
    assert parse_problem(format_problem(problem), domain) == problem
