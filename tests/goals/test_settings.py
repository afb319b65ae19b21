"""States in the names of actions, predicates of what goes on, nouns of actions with two places, and afterthoughts."""

from __future__ import annotations

from pathlib import Path

import pytest

import tmd
from tests.goals.conftest import assert_ends, end, goals, plain_world, said

DOMAIN = """
(define (domain harbour_light)
  (:requirements :typing :negative-preconditions)
  (:types lamp ship band crate quay hold - object)
  (:predicates (facing ?l - lamp ?s - ship) (amber ?l - lamp) (have_log ?s - ship ?b - band)
               (at ?c - crate ?q - quay) (inHold ?c - crate ?h - hold))
  (:action swivel :parameters (?l - lamp ?new ?old - ship) :precondition (facing ?l ?old)
    :effect (and (facing ?l ?new) (not (facing ?l ?old))))
  (:action setAmber :parameters (?l - lamp) :precondition (not (amber ?l)) :effect (amber ?l))
  (:action setBlue :parameters (?l - lamp) :precondition (amber ?l) :effect (not (amber ?l)))
  (:action keep_log :parameters (?l - lamp ?s - ship ?b - band) :precondition (facing ?l ?s) :effect (have_log ?s ?b))
  (:action load :parameters (?c - crate ?h - hold ?q - quay) :precondition (at ?c ?q)
    :effect (and (inHold ?c ?h) (not (at ?c ?q))))
  (:action unload :parameters (?c - crate ?h - hold ?q - quay) :precondition (inHold ?c ?h)
    :effect (and (at ?c ?q) (not (inHold ?c ?h)))))
"""
PROBLEM = """
(define (problem dusk) (:domain harbour_light)
 (:objects northLamp southLamp eastLamp - lamp trawler tanker tug - ship radar sonar - band
           figs dates - crate westQuay - quay forwardHold - hold)
 (:init (facing northLamp tug) (facing southLamp tug) (facing eastLamp tanker) (amber northLamp) (amber southLamp)
        (at dates westQuay) (inHold figs forwardHold))
 (:goal (and)))
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return plain_world(tmp_path_factory.mktemp("harbour_light"), DOMAIN, PROBLEM)


@pytest.mark.parametrize(
    ("text", "held", "gone"),
    [
        ("Face the north lamp towards the trawler.", {"(facing northlamp trawler)"}, set()),
        ("Set the north lamp to blue.", set(), {"(amber northlamp)"}),
        ("Switch the east lamp to amber.", {"(amber eastlamp)"}, set()),
        ("Turn all the lamps blue except the south one.", {"(amber southlamp)"}, {"(amber northlamp)"}),
        ("The east lamp should be amber, please.", {"(amber eastlamp)"}, set()),
        ("If the north lamp is amber, make it blue.", set(), {"(amber northlamp)"}),
        ("Is the east lamp blue? Then set it to amber.", {"(amber eastlamp)"}, set()),
        ("I need a radar log of the trawler.", {"(have_log trawler radar)"}, set()),
        ("Keep a log of the tanker on sonar.", {"(have_log tanker sonar)"}, set()),
        ("Get the figs out of the hold.", set(), {"(inhold figs forwardhold)"}),
    ],
)
def test_what_names_of_actions_and_predicates_say(folder: Path, text: str, held: set[str], gone: set[str]) -> None:
    assert_ends(folder, text, held, gone)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("Keep a radar log of the lighthouse.", "radar log"),
        ("Keep a log of the tanker with the crane.", "log"),
        ("Set the north lamp to green.", "green"),
    ],
)
def test_what_no_place_of_a_noun_takes_is_told(folder: Path, text: str, reason: str) -> None:
    grounded = tmd.load_domain(str(folder)).ground(text, folder / "problem.pddl")
    assert not grounded.plans
    assert reason in grounded.reason


@pytest.mark.parametrize(
    ("environment", "text", "held"),
    [
        ("kitchen/kitchen3", "Warm up some milk, please. Either mug is fine.", {"(hot mug1)", "(hot mug2)"}),
        ("kitchen/kitchen1", "I want the mug to stand on the table.", {"(at mug1 table1 on)"}),
        ("kitchen/kitchen1", "The mug should be where the plate is.", {"(at mug1 cupboard1 in)"}),
        (
            "living_room/room5",
            "Make popcorn, and put it in a bowl, not the one with the chips.",
            {"(contains bowl1 popped_corn)"},
        ),
        ("kitchen/kitchen1", "I don't like coffee. Put the mug on the table.", {"(at mug1 table1 on)"}),
        ("kitchen/kitchen3", "Put a mug on the counter. Actually, make that a bowl.", {"(at bowl1 counter1 on)"}),
        ("living_room/room2", "Clear the mug away to the sideboard.", {"(at mug1 sideboard1 on)"}),
        ("kitchen/kitchen1", "Put the mug on the table and leave it there.", {"(at mug1 table1 on)"}),
    ],
)
def test_said_behind_a_request_or_beside_it(environment: str, text: str, held: set[str]) -> None:
    domain, _, name = environment.partition("/")
    grounded = said(domain, name, text)
    assert goals(grounded)
    assert not held.isdisjoint(end(grounded))


def test_what_is_poured_out_of_where_it_is_said_to_be() -> None:
    grounded = said("kitchen", "kitchen4", "Tip out the water that's in the pot on the stove.")
    assert "(contains pot1 water)" not in end(grounded)


def test_a_scoop_of_each_in_its_own_bowl() -> None:
    text = "Put a scoop of vanilla in one bowl and a scoop of chocolate in the other."
    facts = end(said("kitchen", "kitchen3", text))
    kinds = ("vanilla", "chocolate")
    held = [[f"(contains bowl{number} {kind}_ice_cream)" in facts for kind in kinds] for number in (1, 2)]
    assert sorted(held) == [[False, True], [True, False]]


def test_all_that_lies_somewhere_goes_together() -> None:
    facts = end(said("living_room", "room1", "Pick up whatever's lying on the floor and put it on the armchair."))
    assert {"(at magazine1 armchair1 on)", "(at pillow1 armchair1 on)"} <= facts


CLUB = """
(define (domain club)
  (:requirements :typing)
  (:types guest game table drink slope - object)
  (:predicates (seated ?g - guest ?t - table) (waiting ?g - guest) (knows ?g - guest ?b - game)
               (served ?g - guest ?d - drink) (tilted ?t - table ?s - slope))
  (:action seat :parameters (?g - guest ?t - table) :precondition (waiting ?g)
    :effect (and (seated ?g ?t) (not (waiting ?g))))
  (:action explain-rules :parameters (?b - game ?g - guest ?t - table) :precondition (seated ?g ?t)
    :effect (knows ?g ?b))
  (:action serve :parameters (?d - drink ?g - guest ?t - table) :precondition (seated ?g ?t) :effect (served ?g ?d))
  (:action tilt :parameters (?t - table ?old ?new - slope) :precondition (tilted ?t ?old)
    :effect (and (tilted ?t ?new) (not (tilted ?t ?old)))))
"""
CLUB_PROBLEM = """
(define (problem evening) (:domain club)
 (:objects lena omar - guest ludo halma - game hall-table den-table - table cocoa cider - drink level steep - slope)
 (:init (seated lena hall-table) (waiting omar) (tilted hall-table level) (tilted den-table level))
 (:goal (and)))
"""


@pytest.mark.parametrize(
    ("text", "held"),
    [
        ("Seat Omar at the den table.", "(seated omar den-table)"),
        ("Explain ludo to Lena.", "(knows lena ludo)"),
        ("Bring Lena a cocoa.", "(served lena cocoa)"),
        ("Tilt the den table steep.", "(tilted den-table steep)"),
    ],
)
def test_guests_are_served(tmp_path: Path, text: str, held: str) -> None:
    assert_ends(plain_world(tmp_path, CLUB, CLUB_PROBLEM), text, {held}, set())
