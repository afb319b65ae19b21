"""Parts that only names speak of, numbers, and people who are here or not."""

from __future__ import annotations

from pathlib import Path

import pytest

import tmd
from tests.goals.conftest import assert_ends, end, plain_world, said

DOMAIN = """
(define (domain night_shift)
  (:requirements :adl)
  (:types ward guest tray window - object sealed_tray - tray)
  (:predicates (tray_is_in_ward ?t - tray ?w - ward) (guest_is_reading_on ?g - guest ?t - tray) (lit ?w - ward)
               (guest_is_wearing_bib ?g - guest) (guest_has_been_fed ?g - guest) (guest_is_ill ?g - guest)
               (wiped ?t - tray) (labelled ?t - sealed_tray) (ward_hatch_is_shut ?w - ward)
               (window-of ?n - window ?w - ward) (ajar ?n - window) (guest_has_tray ?g - guest ?t - tray))
  (:action carry :parameters (?t - tray ?from ?to - ward) :precondition (tray_is_in_ward ?t ?from)
    :effect (and (tray_is_in_ward ?t ?to) (not (tray_is_in_ward ?t ?from))))
  (:action light-on :parameters (?w - ward) :precondition (not (lit ?w)) :effect (lit ?w))
  (:action light-off :parameters (?w - ward) :precondition (lit ?w) :effect (not (lit ?w)))
  (:action cover_guest_with_bib :parameters (?g - guest) :precondition (not (guest_is_wearing_bib ?g))
    :effect (guest_is_wearing_bib ?g))
  (:action remove_bib_from_guest :parameters (?g - guest) :precondition (guest_is_wearing_bib ?g)
    :effect (not (guest_is_wearing_bib ?g)))
  (:action feed_guest :parameters (?g - guest) :precondition (not (guest_has_been_fed ?g))
    :effect (guest_has_been_fed ?g))
  (:action wipe :parameters (?t - tray) :precondition (not (wiped ?t)) :effect (wiped ?t))
  (:action label :parameters (?t - sealed_tray) :precondition (not (labelled ?t)) :effect (labelled ?t))
  (:action shut_ward_hatch :parameters (?w - ward) :precondition (not (ward_hatch_is_shut ?w))
    :effect (ward_hatch_is_shut ?w))
  (:action open_ward_hatch :parameters (?w - ward) :precondition (ward_hatch_is_shut ?w)
    :effect (not (ward_hatch_is_shut ?w)))
  (:action open-window :parameters (?n - window) :precondition (not (ajar ?n)) :effect (ajar ?n))
  (:action close-window :parameters (?n - window) :precondition (ajar ?n) :effect (not (ajar ?n)))
  (:action hand_over :parameters (?t - tray ?g - guest ?w - ward) :precondition (tray_is_in_ward ?t ?w)
    :effect (and (guest_has_tray ?g ?t) (not (tray_is_in_ward ?t ?w)))))
"""
PROBLEM = """
(define (problem monday) (:domain night_shift)
 (:objects ward1 ward2 ward3 - ward lena omar rita - guest tray1 tray2 tray3 - tray sealed1 - sealed_tray
           east-window west-window - window)
 (:init (tray_is_in_ward tray1 ward1) (tray_is_in_ward tray2 ward1) (tray_is_in_ward tray3 ward2)
        (tray_is_in_ward sealed1 ward2) (guest_is_reading_on lena tray2) (lit ward1) (lit ward2) (lit ward3)
        (guest_is_wearing_bib rita) (guest_is_ill omar) (window-of east-window ward1) (window-of west-window ward2)
        (ajar west-window) (ward_hatch_is_shut ward1))
 (:goal (and)))
"""


ISLES = """
(define (domain isles)
  (:requirements :typing)
  (:types barge crate place port yard region - object)
  (:predicates (barge-at ?p - place) (is_at ?c - crate ?p - place) (aboard ?c - crate)
               (in-region ?p - place ?r - region) (on ?c - crate ?o - crate))
  (:action sail :parameters (?x ?y - place) :precondition (barge-at ?x)
    :effect (and (barge-at ?y) (not (barge-at ?x))))
  (:action hoist :parameters (?c - crate ?p - place) :precondition (and (barge-at ?p) (is_at ?c ?p))
    :effect (and (aboard ?c) (not (is_at ?c ?p))))
  (:action lower :parameters (?c - crate ?p - place) :precondition (and (barge-at ?p) (aboard ?c))
    :effect (and (is_at ?c ?p) (not (aboard ?c))))
  (:action pile :parameters (?c ?o - crate ?p - place) :precondition (and (is_at ?c ?p) (is_at ?o ?p))
    :effect (on ?c ?o)))
"""
ISLES_PROBLEM = """
(define (problem dawn) (:domain isles)
 (:objects north_quay south_quay mill - place north south - region a b c - crate)
 (:init (barge-at mill) (is_at a mill) (is_at b mill) (is_at c north_quay) (in-region north_quay north)
        (in-region south_quay south) (in-region mill south))
 (:goal (and)))
"""


@pytest.fixture(scope="module")
def isles(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return plain_world(tmp_path_factory.mktemp("isles"), ISLES, ISLES_PROBLEM)


@pytest.mark.parametrize(
    ("text", "held", "gone"),
    [
        ("Put a on b.", {"(on a b)"}, {"(on b a)"}),
        ("Take crate a to the north.", {"(is_at a north_quay)"}, set()),
        ("Bring the barge to the south quay.", {"(barge-at south_quay)"}, set()),
        (
            "Take a to the north quay, then sail to the south quay.",
            {"(is_at a north_quay)", "(barge-at south_quay)"},
            set(),
        ),
        ("Bring b to the south quay and come back.", {"(is_at b south_quay)", "(barge-at mill)"}, set()),
        ("Sail to the north quay and take a there.", {"(is_at a north_quay)"}, set()),
        ("Move a to the south quay and carry it back.", {"(is_at a mill)"}, set()),
    ],
)
def test_who_acts_where_and_back(isles: Path, text: str, held: set[str], gone: set[str]) -> None:
    assert_ends(isles, text, held, gone)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return plain_world(tmp_path_factory.mktemp("night_shift"), DOMAIN, PROBLEM)


@pytest.mark.parametrize(
    ("text", "held", "gone"),
    [
        ("Turn off all the lights except the one in ward 1.", {"(lit ward1)"}, {"(lit ward2)", "(lit ward3)"}),
        ("Switch the light in ward 2 off.", {"(lit ward1)", "(lit ward3)"}, {"(lit ward2)"}),
        ("Open the hatches of all wards.", set(), {"(ward_hatch_is_shut ward1)"}),
        ("The hatch of ward 2 should be shut.", {"(ward_hatch_is_shut ward2)"}, {"(ward_hatch_is_shut ward3)"}),
        (
            "The hatch of ward 2 has to be shut and the one of ward 1 open.",
            {"(ward_hatch_is_shut ward2)"},
            {"(ward_hatch_is_shut ward1)"},
        ),
        ("Put a bib on Lena.", {"(guest_is_wearing_bib lena)"}, {"(guest_is_wearing_bib omar)"}),
        ("Take the bib off Rita.", set(), {"(guest_is_wearing_bib rita)"}),
        ("Feed Omar, but don't put a bib on him.", {"(guest_has_been_fed omar)"}, {"(guest_is_wearing_bib omar)"}),
        (
            "Feed every guest that isn't ill.",
            {"(guest_has_been_fed lena)", "(guest_has_been_fed rita)"},
            {"(guest_has_been_fed omar)"},
        ),
        ("Wipe all the trays but number 2.", {"(wiped tray1)", "(wiped tray3)"}, {"(wiped tray2)"}),
        ("Wipe every tray except the one Lena is using.", {"(wiped tray1)", "(wiped tray3)"}, {"(wiped tray2)"}),
        ("Wipe the tray Lena is reading on.", {"(wiped tray2)"}, {"(wiped tray1)"}),
        ("Wipe all the trays, but leave tray 3 alone.", {"(wiped tray1)", "(wiped tray2)"}, {"(wiped tray3)"}),
        (
            "Move all the trays from ward 1 to ward 3.",
            {"(tray_is_in_ward tray1 ward3)", "(tray_is_in_ward tray2 ward3)", "(tray_is_in_ward tray3 ward2)"},
            set(),
        ),
        ("Turn the light in ward 3 off and bring tray 1 there.", {"(tray_is_in_ward tray1 ward3)"}, {"(lit ward3)"}),
        ("Close the window in ward 2.", set(), {"(ajar west-window)"}),
        ("If the window in ward 1 is closed, open it.", {"(ajar east-window)"}, set()),
        ("Give Omar the tray that is in ward 2.", set(), {"(tray_is_in_ward tray1 ward2)"}),
    ],
)
def test_the_state_that_is_asked_for(folder: Path, text: str, held: set[str], gone: set[str]) -> None:
    assert_ends(folder, text, held, gone)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("Wipe all the trays except tray 9.", "tray 9"),
        ("Wipe all the trays except the sofa.", "sofa"),
        ("Label tray 1.", "'label' does not apply to 'tray 1' here"),
        ("Bring Emma tray 1.", "emma"),
    ],
)
def test_what_is_not_there_is_told(folder: Path, text: str, reason: str) -> None:
    found = tmd.load_domain(str(folder)).ground(text, folder / "problem.pddl")
    assert not found.plans
    assert reason in found.reason.lower()


@pytest.mark.parametrize(
    ("environment", "text", "held", "gone"),
    [
        ("kitchen3", "Emma has a cold, so pour some milk into the mug for her.", {"(contains mug1 milk)"}, set()),
        ("kitchen3", "My neighbour needs some milk in the mug.", {"(contains mug1 milk)"}, set()),
        ("kitchen3", "Open the fridge. The guests have to see it.", {"(opened fridge1_door)"}, set()),
        (
            "room1",
            "Put the game in the console, but don't play it yet.",
            {"(at game_disc1 console1 in)"},
            {"(active console1_drive)"},
        ),
        ("room5", "The two lamps can be off.", set(), {"(active lamp1)", "(active floor_lamp1)"}),
        ("room5", "Turn the two lamps off.", set(), {"(active lamp1)", "(active floor_lamp1)"}),
    ],
)
def test_people_who_are_not_here_and_two_things(environment: str, text: str, held: set[str], gone: set[str]) -> None:
    domain = "kitchen" if environment.startswith("kitchen") else "living_room"
    facts = end(said(domain, environment, text))
    assert held <= facts and not gone & facts


def test_what_nothing_here_can_throw_away_is_told() -> None:
    assert "cannot be done here" in said("kitchen", "kitchen1", "Throw away the egg.").reason


@pytest.mark.parametrize("name", ["is", "been", "has", "has-been", "be_is", "at", "on-off"])
def test_a_predicate_may_have_any_name(tmp_path: Path, name: str) -> None:
    domain = f"""(define (domain d) (:requirements :strips) (:predicates ({name} ?x))
      (:action touch :parameters (?x) :precondition (not ({name} ?x)) :effect ({name} ?x)))"""
    folder = plain_world(tmp_path, domain, "(define (problem p) (:domain d) (:objects box) (:init) (:goal (and)))")
    assert_ends(folder, "Touch the box.", {f"({name} box)"}, set())
