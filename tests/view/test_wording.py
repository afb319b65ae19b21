"""Conditions in words: those of the comments in the domain, with nothing in them that was not said."""

from __future__ import annotations

import pytest

from tests.view.conftest import corpus
from tmd.goals.wording import Wording
from tmd.pddl.model import Atom, GroundAtom, Not, Problem, TypedName
from tmd.pddl.reading.reader import parse_domain, with_goal


@pytest.fixture(scope="module")
def problem() -> Problem:
    return corpus("kitchen").world("kitchen1").task.problem


CONDITIONS = {
    "(contains cup1 water)": "there is some water in cup1",
    "(at mug1 counter1 next_to)": "mug1 is next to counter1",
    "(opened fridge1_door)": "fridge1_door is open",
    "(not (opened fridge1_door))": "fridge1_door is closed",
    "(not (contains cup1 water))": "there is no water in cup1",
    "(not (filled cup1))": "there is nothing in cup1",
    "(not (hot cup1))": "cup1 and what it contains are not hot",
    "(not (at cup1 sink1 in))": "cup1 is not in sink1",
    "(and (at cup1 sink1 in) (at mug1 sink1 in))": "cup1 and mug1 are in sink1",
    "(and (opened fridge1_door) (opened microwave1_door))": "fridge1_door and microwave1_door are open",
    "(and (not (opened fridge1_door)) (not (opened microwave1_door)))": "fridge1_door and microwave1_door are closed",
    "(and (not (at cup1 sink1 in)) (not (at cup1 counter1 on)))": "cup1 is not in sink1 or on counter1",
    "(or (not (filled cup1)) (not (filled mug1)))": "for cup1 or mug1: there is nothing in it",
    "(and (found pr2 cup1) (found pr2 mug1))": "the robot knows where cup1 is, and the robot knows where mug1 is",
    "(or (and (contains cup1 coffee) (hot cup1)) (and (contains mug1 coffee) (hot mug1)))": (
        "for cup1 or mug1: there is some coffee in it, and it and what it contains are hot"
    ),
    "(or (and (hot pot1) (contains cup1 coffee)) (and (hot pot1) (filled mug1)))": (
        "pot1 and what it contains are hot, and there is some coffee in cup1 or something in mug1"
    ),
    "(and (contains cup1 water) (hot cup1))": "there is some water in cup1, and cup1 and what it contains are hot",
    "(or (at mug1 counter1 on) (at mug1 counter2 on))": "mug1 is on counter1 or counter2",
    "(or (hot cup1) (hot mug1) (hot pot1) (hot bowl1))": "cup1, mug1, pot1 or 1 other and what it contains are hot",
    "(or (contains cup1 water) (contains cup1 milk))": "there is some water or milk in cup1",
    "(or (at mug1 fridge1 in) (at mug1 fridge1 on))": "mug1 is in fridge1 or on fridge1",
    "(or (hot cup1) (filled cup1))": "cup1 and what it contains are hot, or there is something in cup1",
    "(and (hot pot1) (or (hot cup1) (and (filled cup1) (filled mug1))))": (
        "pot1 and what it contains are hot, and (cup1 and what it contains are hot, or "
        "there is something in cup1 and mug1)"
    ),
    "(and (hot cup1) (not (contains cup1 milk)) (filled cup1) (not (contains cup1 sugar)) (not (hot mug1)))": (
        "cup1 and what it contains are hot, and there is no milk or sugar in cup1, and something in cup1, "
        "and mug1 and what it contains are not hot"
    ),
    "(and)": "nothing",
    "(exists (?x - thing) (hot ?x))": "(exists (?x - thing) (hot ?x))",
}


@pytest.mark.parametrize("text", CONDITIONS)
def test_conditions_in_words(problem: Problem, text: str) -> None:
    assert Wording(problem).condition(with_goal(problem, text).goal) == CONDITIONS[text]


def test_goals_have_at_most_200_characters_and_the_rest_is_counted(problem: Problem) -> None:
    names = ("cup1", "mug1", "bowl1", "pot1", "plate1", "fork1", "spoon1", "kettle1")
    places = ("sink1 in", "counter1 on", "table1 on", "fridge1 in")
    different = " ".join(f"(at {name} {places[at % 4]}) (found pr2 {name})" for at, name in enumerate(names))
    goal = with_goal(problem, f"(and {different})").goal
    told = Wording(problem).goal(goal)
    assert 150 < len(told) <= 200
    kept = told.removesuffix(", and 7 more")
    assert kept != told and Wording(problem).condition(goal).startswith(f"{kept}, and ")
    assert Wording(problem).goal(with_goal(problem, "(hot cup1)").goal) == "cup1 and what it contains are hot"


def test_what_no_antonym_denies_keeps_its_verb() -> None:
    domain = parse_domain(
        """(define (domain d) (:requirements :typing) (:types t)
  (:predicates
    (lit ?x - t)      ; the lamp x is on
    (locked ?x - t)   ; the gate or door x is locked
    (fed ?x - t)      ; x got its food
    (warm ?x - t)     ; what is in x is warm
    (known ?x - t)    ; the robot knows where x is
    (full ?x - t)     ; x is full, and its lid is shut
    (dirty ?x - t)))  ; x is dirty""",
        "d",
    )
    wording = Wording(Problem("p", domain, (TypedName("a", ("t",)), TypedName("b", ("t",)))))

    def told(predicate: str) -> str:
        return wording.condition(Not(Atom(predicate, ("a",))))

    assert [told(name) for name in ("lit", "locked", "fed", "dirty")] == [
        "the lamp a is off", "a is unlocked", "not: a got its food", "a is clean"
    ]  # fmt: skip
    assert [told(name) for name in ("warm", "known", "full")] == [
        "what is in a is not warm", "the robot does not know where a is", "not: a is full, and its lid is shut"
    ]  # fmt: skip


def test_many_alternatives_are_counted(problem: Problem) -> None:
    names = ("cup1", "mug1", "bowl1", "pot1", "plate1")
    different = " ".join(f"(at {name} counter{1 + place % 2} on)" for place, name in enumerate(names))
    told = Wording(problem).condition(with_goal(problem, f"(or {different})").goal)
    assert told == "cup1 is on counter1, or mug1 is on counter2, or bowl1 is on counter1, or 2 others"


DOMAIN = """(define (domain d) (:requirements :typing) (:types t)
  (:predicates
    (owned ?x - t ?s - t)   ; ?x's owner is s, not x's x-ray
    (seen ?x - t)           ; somebody looked (for x in vain)
    (plain ?x - t)
    (rank ?a - t)           ; a is a good one
  ))"""


@pytest.mark.parametrize(
    ("atom", "told"),
    [
        (GroundAtom("owned", ("cup", "bob")), "cup's owner is bob, not cup's x-ray"),
        (GroundAtom("seen", ("cup",)), "seen cup"),
        (GroundAtom("plain", ("cup",)), "plain cup"),
        (GroundAtom("rank", ("cup",)), "rank cup"),
        (GroundAtom("plain", ("cup", "too", "many")), "plain cup too many"),
    ],
)
def test_whole_words_only_and_a_plain_fallback(atom: GroundAtom, told: str) -> None:
    objects = (TypedName("cup", ("t",)), TypedName("bob", ("t",)))
    wording = Wording(Problem("p", parse_domain(DOMAIN, "d"), objects))
    assert wording.condition(Atom(atom.predicate, atom.args)) == told
    assert wording.fact(atom) == (str(atom) if told.startswith(atom.predicate) else told)


def test_a_predicate_without_parameters() -> None:
    blocks = corpus("01_blocks")
    wording = Wording(blocks.world(blocks.environments()[0]).task.problem)
    assert wording.fact(GroundAtom("hand_empty")) == "nothing is in the hand"
