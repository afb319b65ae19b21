"""What a part of a text takes up from another: states, places, order, and names with number words."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.goals.conftest import assert_ends, end, goals, plain_world, said, steps

DOMAIN = """
(define (domain stable)
  (:requirements :typing :negative-preconditions)
  (:types stall animal tool - object)
  (:predicates (inStall ?a - animal ?s - stall) (lies ?t - tool ?s - stall) (held ?t - tool) (free)
               (latched ?s - stall) (brushed ?a - animal) (rinsed ?t - tool))
  (:action lead :parameters (?a - animal ?x ?y - stall) :precondition (and (inStall ?a ?x) (not (latched ?y)))
    :effect (and (inStall ?a ?y) (not (inStall ?a ?x))))
  (:action latch :parameters (?s - stall) :precondition (not (latched ?s)) :effect (latched ?s))
  (:action unlatch :parameters (?s - stall) :precondition (latched ?s) :effect (not (latched ?s)))
  (:action brush :parameters (?a - animal) :precondition (free) :effect (brushed ?a))
  (:action lift :parameters (?t - tool ?s - stall) :precondition (and (lies ?t ?s) (free))
    :effect (and (held ?t) (not (free)) (not (lies ?t ?s))))
  (:action lay :parameters (?t - tool ?s - stall) :precondition (held ?t)
    :effect (and (lies ?t ?s) (free) (not (held ?t))))
  (:action rinse :parameters (?t - tool) :precondition (held ?t) :effect (rinsed ?t)))
"""
PROBLEM = """
(define (problem noon) (:domain stable)
 (:objects StallOne StallTwo StallThree StallFour - stall pony goat - animal fork bucket - tool)
 (:init (inStall pony StallOne) (inStall goat StallTwo) (latched StallTwo) (free)
        (lies fork StallOne) (lies bucket StallOne))
 (:goal (and)))
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return plain_world(tmp_path_factory.mktemp("stable"), DOMAIN, PROBLEM)


@pytest.mark.parametrize(
    ("text", "held", "gone"),
    [
        ("Lead the pony to stall four.", {"(inStall pony StallFour)"}, set()),
        ("Pony to stall four, then brush it.", {"(inStall pony StallFour)", "(brushed pony)"}, set()),
        ("Stall one isn't latched. It should be.", {"(latched StallOne)"}, set()),
        ("Brush the pony. No, not the pony, the goat.", {"(brushed goat)"}, {"(brushed pony)"}),
        ("Brush the pony, hang on, no, the goat.", {"(brushed goat)"}, {"(brushed pony)"}),
        ("The bucket in stall one goes to stall three.", {"(lies bucket StallThree)"}, set()),
        ("The fork should be in stall two, sorry, in stall three.", {"(lies fork StallThree)"}, set()),
        (
            "I don't want anything lying in stall one any more.",
            set(),
            {"(lies fork StallOne)", "(lies bucket StallOne)"},
        ),
        ("The fork is dirty, into stall four with it.", {"(lies fork StallFour)"}, set()),
        ("The fork stays here, the bucket I need in stall four.", {"(lies bucket StallFour)"}, set()),
    ],
)
def test_what_is_left_out_is_taken_up(folder: Path, text: str, held: set[str], gone: set[str]) -> None:
    assert_ends(folder, text, {fact.lower() for fact in held}, {fact.lower() for fact in gone})


def test_a_glass_of_something_with_something_is_one_glass() -> None:
    facts = end(said("kitchen", "kitchen2", "Serve me a glass of coffee with sugar."))
    assert {"(contains glass1 coffee)", "(contains glass1 sugar)"} <= facts


def test_what_is_in_a_vessel_is_poured_from_it() -> None:
    facts = end(said("kitchen", "kitchen4", "Tip the water that is in the pot on burner 2 into the coffee pot."))
    assert "(contains coffee_pot1 water)" in facts
    assert "(contains pot1 water)" not in facts


def test_the_second_subject_is_denied_what_the_first_one_has() -> None:
    text = "The mug on the coffee maker must have coffee in it, the mug on the counter mustn't."
    facts = end(said("kitchen", "kitchen3", text))
    assert "(contains mug1 coffee)" in facts
    assert "(contains mug2 coffee)" not in facts


def test_what_is_to_come_first_is_done_first_beside_a_statement() -> None:
    text = "The egg is in the fridge, please boil it in the pot (throw out the coffee first!)."
    grounded = said("kitchen", "kitchen5", text)
    facts = end(grounded)
    assert "(contains pot1 boiled_egg)" in facts
    assert "(contains pot1 coffee)" not in facts


def test_a_place_may_be_named_before() -> None:
    facts = end(said("kitchen", "kitchen1", "Before you close the cupboard, put the mug in."))
    assert "(at mug1 cupboard1 in)" in facts
    assert "(opened cupboard1_door)" not in facts


def test_a_vessel_does_not_stay_in_the_bin() -> None:
    grounded = said("living_room", "room5", "Pour the chips out of the bowl into the bin.")
    assert "(at bowl2 bin1 in)" not in end(grounded)


def test_talk_does_not_ask_for_anything() -> None:
    grounded = said("kitchen", "kitchen2", "Steaks on the grill, quick, go go go!")
    assert not grounded.plans
    assert "steak" in str(grounded)


def test_a_question_with_have_asks_for_a_state() -> None:
    grounded = said("living_room", "room1", "It is stuffy, but might I have the window opened?")
    assert goals(grounded) == ["(opened window1)"]
    assert steps(grounded)
