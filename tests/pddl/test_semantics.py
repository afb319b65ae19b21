"""What conditions and instructions mean, case by case."""

from __future__ import annotations

from itertools import pairwise, product

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tmd.diagnostics import TmdError
from tmd.pddl import narrowing, semantics
from tmd.pddl.model import (
    And,
    Exists,
    Forall,
    Formula,
    GroundAtom,
    Imply,
    Instruction,
    Not,
    Or,
    Problem,
    State,
    Universe,
    parts_of,
    universe,
)
from tmd.pddl.reading.reader import parse_domain, parse_problem
from tmd.pddl.writer import format_formula

DOMAIN = """
(define (domain d) (:requirements :adl)
  (:types a - object b - a)
  (:predicates (p ?x - a) (q ?x - a) (r ?x ?y - a) (n))
  (:action swap :parameters (?x ?y - a) :precondition (and (p ?x) (or (q ?x) (not (n))))
    :effect (and (when (p ?x) (and (not (p ?x)) (q ?x))) (when (q ?x) (and (not (q ?x)) (p ?x)))
                 (forall (?z - b) (when (r ?x ?z) (r ?z ?y)))))
  (:action both :parameters () :effect (and (not (n)) (n) (when (n) (not (n)))))
  (:action nested :parameters (?x - a)
    :effect (when (p ?x) (and (when (q ?x) (n)) (forall (?z - a) (when (r ?x ?z) (q ?z)))))))
"""
PROBLEM = "(define (problem x) (:domain d) (:objects u - a v w - b) (:init (p u) (r u v)) (:goal {}))"


def _problem(goal: str = "(and)") -> Problem:
    return parse_problem(PROBLEM.format(goal), parse_domain(DOMAIN))


def _state(*atoms: str) -> State:
    return frozenset(GroundAtom(w[0], tuple(w[1:])) for w in (a.split() for a in atoms))


@pytest.mark.parametrize(
    ("goal", "expected", "broken"),
    [
        ("(and)", True, None),
        ("(or)", False, "(or)"),
        ("(p u)", True, None),
        ("(p v)", False, "(p v)"),
        ("(not (p u))", False, "(not (p u))"),
        ("(and (p u) (q u) (q v))", False, "(q u)"),
        ("(or (q u) (p u))", True, None),
        ("(or (q u) (q v))", False, "(or (q u) (q v))"),
        ("(not (or (q u) (p u)))", False, "(not (p u))"),
        ("(not (and (p u) (r u v)))", False, "(not (and (p u) (r u v)))"),
        ("(imply (q u) (p v))", True, None),
        ("(imply (p u) (p v))", False, "(imply (p u) (p v))"),
        ("(= u u)", True, None),
        ("(= u v)", False, "(= u v)"),
        ("(not (= u u))", False, "(not (= u u))"),
        ("(forall (?x - b) (not (p ?x)))", True, None),
        ("(forall (?x - a) (p ?x))", False, "(p v)"),
        ("(not (exists (?x ?y - a) (r ?x ?y)))", False, "(not (r u v))"),
        ("(exists (?x - b) (exists (?y - a) (r ?y ?x)))", True, None),
        ("(exists (?x - b) (p ?x))", False, "(exists (?x - b) (p ?x))"),
        ("(forall (?x - a) (exists (?y - a) (= ?x ?y)))", True, None),
        ("(not (not (p u)))", True, None),
    ],
)
def test_holds(goal: str, expected: bool, broken: str | None) -> None:
    problem = _problem(goal)
    assert semantics.holds(problem.goal, problem.init, problem) == expected
    found = semantics.first_false(problem.goal, problem.init, problem)
    assert (found.text if found else None) == broken
    if found and found.atom:
        assert (found.atom in problem.init) != found.positive


def test_conditions_read_the_old_state() -> None:
    swap = Instruction("swap", ("u", "w"))
    problem = _problem()
    assert semantics.apply(swap, _state("p u", "r u v"), problem) == _state("q u", "r u v", "r v w")
    assert semantics.apply(swap, _state("q u"), problem) == _state("p u")
    assert semantics.apply(swap, _state("p u", "q u"), problem) == _state("p u", "q u"), "adding wins"
    chain = semantics.apply(swap, _state("r u v", "r v w"), problem)
    assert chain == _state("r u v", "r v w"), "the new (r v w) is not read again"


def test_adding_wins_over_deleting() -> None:
    both = Instruction("both")
    assert semantics.apply(both, _state("n"), _problem()) == _state("n")
    assert semantics.apply(both, _state(), _problem()) == _state("n")


def test_the_outer_condition_of_a_nested_when_counts() -> None:
    nested = Instruction("nested", ("u",))
    problem = _problem()
    assert semantics.apply(nested, _state("q u", "r u v"), problem) == _state("q u", "r u v")
    assert semantics.apply(nested, _state("p u", "q u", "r u v"), problem) == _state("p u", "q u", "r u v", "n", "q v")


def test_forced_execution_does_not_read_the_precondition() -> None:
    swap = Instruction("swap", ("v", "w"))
    problem = _problem()
    assert not semantics.applicable(swap, problem.init, problem)
    broken = semantics.first_broken(swap, problem.init, problem)
    assert broken and (broken.text, broken.atom, broken.positive) == ("(p v)", GroundAtom("p", ("v",)), True)
    assert semantics.apply(swap, problem.init, problem) == problem.init


@pytest.mark.parametrize(
    ("instruction", "message", "hint"),
    [
        (Instruction("swop", ("u", "v")), 'unknown action "swop"', 'did you mean "swap"?'),
        (Instruction("swap", ("u",)), '"swap" takes 2 argument(s), found 1', "declared as swap(?x, ?y)"),
        (Instruction("swap", ("u", "uu")), 'unknown object "uu"', 'did you mean "u"?'),
    ],
)
def test_bad_instructions(instruction: Instruction, message: str, hint: str) -> None:
    problem = _problem()
    for function in (semantics.apply, semantics.applicable, semantics.first_broken):
        with pytest.raises(TmdError) as caught:
            function(instruction, problem.init, problem)
        assert message in caught.value.message
        assert caught.value.hint == hint


def test_wrong_type() -> None:
    problem = parse_problem(
        "(define (problem x) (:domain d) (:objects u - a k - object) (:init) (:goal (and)))",
        parse_domain(DOMAIN),
    )
    with pytest.raises(TmdError, match=r'"k" in swap.* is of type "object", .y needs a'):
        semantics.bind(problem, Instruction("swap", ("u", "k")))


def test_bound_text_leaves_quantified_variables_alone() -> None:
    problem = _problem("(exists (?x - b) (p ?x))")
    assert format_formula(problem.goal, {"?x": "u"}) == "(exists (?x - b) (p ?x))"


_NAMES = st.sampled_from(["?x", "?y", "?z", "u", "v"])
_LITERAL = st.one_of(
    st.builds("({} {})".format, st.sampled_from(["p", "q"]), _NAMES),
    st.builds("(r {} {})".format, _NAMES, _NAMES),
    st.builds("(= {} {})".format, _NAMES, _NAMES),
)
_CONDITION = st.recursive(
    _LITERAL,
    lambda inner: st.one_of(
        st.builds("(not {})".format, inner),
        st.builds("({} {} {})".format, st.sampled_from(["and", "or", "imply"]), inner, inner),
        st.builds("({} (?w - b) (or (r ?w ?x) {}))".format, st.sampled_from(["forall", "exists"]), inner),
    ),
    max_leaves=6,
)
_ATOMS = [f"{p} {x}" for p in "pq" for x in "uvw"] + [f"r {x} {y}" for x in "uvw" for y in "uvw"]


def _enumerated(formula: Formula, state: State, objects: Universe, binding: dict[str, str]) -> bool:
    """The meaning of a condition by its definition: every choice of objects is looked at."""
    if isinstance(formula, Forall | Exists):
        choices = product(*(objects.of(p.types) for p in formula.parameters))
        names = [p.name for p in formula.parameters]
        held = (_enumerated(formula.part, state, objects, binding | dict(zip(names, c, strict=True))) for c in choices)
        return all(held) if isinstance(formula, Forall) else any(held)
    parts = [_enumerated(part, state, objects, binding) for part in parts_of(formula)]
    match formula:
        case Not():
            return not parts[0]
        case And():
            return all(parts)
        case Or():
            return any(parts)
        case Imply():
            return not parts[0] or parts[1]
    return semantics.holds(formula, state, objects, binding)


@settings(max_examples=50)
@given(_CONDITION, st.sampled_from(["forall", "exists"]), st.lists(st.sampled_from(_ATOMS)))
def test_a_join_finds_what_enumeration_finds(condition: str, word: str, atoms: list[str]) -> None:
    domain = parse_domain(DOMAIN)
    problem = parse_problem(PROBLEM.format(f"({word} (?x ?z - a ?y - b) {condition})"), domain)
    state, objects = _state(*atoms), universe(problem)
    held = _enumerated(problem.goal, state, objects, {})
    assert semantics.holds(problem.goal, state, problem) == held
    assert (semantics.first_false(problem.goal, state, problem) is None) == held
    inner = problem.goal
    assert isinstance(inner, Forall | Exists)
    names = [p.name for p in inner.parameters]
    choices = [dict(zip(names, c, strict=True)) for c in product(*(objects.of(p.types) for p in inner.parameters))]
    found = semantics.solutions(inner.parameters, inner.part, state, objects, {})
    wanted = [choice for choice in choices if _enumerated(inner.part, state, objects, choice)]
    assert sorted(sorted(f.items()) for f in found) == sorted(sorted(w.items()) for w in wanted)


@settings(max_examples=50)
@given(_CONDITION, st.sampled_from(["forall", "exists"]), st.lists(st.sampled_from(_ATOMS)))
def test_a_narrowed_condition_holds_where_it_did(condition: str, word: str, atoms: list[str]) -> None:
    assume(condition.count("?w - b") < 2)  # no name is declared twice
    domain = parse_domain(DOMAIN)
    problem = parse_problem(PROBLEM.format(f"({word} (?x ?z - a ?y - b) {condition})"), domain)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(narrowing, "_LARGE", 0)
        narrow = narrowing.narrowed(problem)
    state = _state(*atoms)
    held = semantics.holds(problem.goal, state, problem)
    assert semantics.holds(narrow.goal, semantics.close(state, narrow), narrow) == held


def test_a_condition_over_many_objects_is_joined() -> None:
    """Six variables over sixty objects are 46 billion choices."""
    names = [f"o{number}" for number in range(60)]
    links = " ".join(f"(r {one} {two})" for one, two in pairwise(names))
    path = "(and (r ?a ?b) (r ?b ?c) (r ?c ?d) (r ?d ?e) (r ?e ?f))"
    quantified = "(?a ?c ?e ?b ?d ?f - a)"
    goals = {
        f"(exists {quantified} (and {path} (r ?f ?a)))": False,
        f"(exists {quantified} {path})": True,
        f"(exists {quantified} (and (= ?a ?b) (= ?b ?c) (= ?c ?d) (= ?d ?e) (r ?e ?a) (= ?f ?f)))": False,
        f"(forall {quantified} (imply {path} (or (q ?f) (not (p ?a)))))": True,
    }
    for goal, held in goals.items():
        text = f"(define (problem x) (:domain d) (:objects {' '.join(names)} - a) (:init {links}) (:goal {goal}))"
        problem = parse_problem(text, parse_domain(DOMAIN))
        assert (semantics.first_false(problem.goal, problem.init, problem) is None) == held
