"""Parts that only the names of predicates and actions speak of: the bed of a room that is ``bed-made``."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.goals.conftest import assert_ends, plain_world

DOMAIN = """
(define (domain ward)
  (:requirements :typing :negative-preconditions)
  (:types room thing - object linen - thing)
  (:predicates (robotAt ?r - room) (thingAt ?t - thing ?r - room) (carrying ?t - thing) (free)
               (bed-made ?r - room) (window-open ?r - room) (floor-mopped ?r - room) (bin-full ?r - room)
               (name-tagged ?t - thing) (waxed ?t - thing) (in-locker ?t - thing ?r - room) (gate-open))
  (:action move :parameters (?a ?b - room) :precondition (robotAt ?a)
    :effect (and (robotAt ?b) (not (robotAt ?a))))
  (:action pick-up :parameters (?t - thing ?r - room) :precondition (and (robotAt ?r) (thingAt ?t ?r) (free))
    :effect (and (carrying ?t) (not (free)) (not (thingAt ?t ?r))))
  (:action put-down :parameters (?t - thing ?r - room) :precondition (and (robotAt ?r) (carrying ?t))
    :effect (and (thingAt ?t ?r) (free) (not (carrying ?t))))
  (:action stow :parameters (?t - thing ?r - room) :precondition (and (robotAt ?r) (carrying ?t))
    :effect (and (in-locker ?t ?r) (free) (not (carrying ?t))))
  (:action make-bed :parameters (?l - linen ?r - room) :precondition (and (robotAt ?r) (carrying ?l))
    :effect (and (bed-made ?r) (free) (not (carrying ?l))))
  (:action open-window :parameters (?r - room) :precondition (robotAt ?r) :effect (window-open ?r))
  (:action shut-window :parameters (?r - room) :precondition (robotAt ?r) :effect (not (window-open ?r)))
  (:action mop-floor :parameters (?r - room) :precondition (robotAt ?r) :effect (floor-mopped ?r))
  (:action empty-bin :parameters (?r - room) :precondition (robotAt ?r) :effect (not (bin-full ?r)))
  (:action tag-name :parameters (?t - thing) :precondition (carrying ?t) :effect (name-tagged ?t))
  (:action wax :parameters (?t - thing) :precondition (carrying ?t) :effect (waxed ?t))
  (:action open-gate :parameters () :precondition (free) :effect (gate-open))
  (:action close-gate :parameters () :precondition (free) :effect (not (gate-open))))
"""
PROBLEM = """
(define (problem night) (:domain ward)
 (:objects room-11 room-12 room-13 - room tray vase - thing sheets - linen)
 (:init (robotAt room-11) (thingAt tray room-12) (thingAt vase room-13) (thingAt sheets room-13) (free) (gate-open)
        (window-open room-11) (bin-full room-11) (bin-full room-12) (bed-made room-11))
 (:goal (and)))
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return plain_world(tmp_path_factory.mktemp("ward"), DOMAIN, PROBLEM)


@pytest.mark.parametrize(
    ("text", "held", "gone"),
    [
        ("Make the bed in 12.", {"(bed-made room-12)"}, {"(bed-made room-13)"}),
        ("The bed in room 12 needs making.", {"(bed-made room-12)"}, {"(bed-made room-13)"}),
        ("If the bed in 12 isn't made, make it.", {"(bed-made room-12)"}, {"(bed-made room-13)"}),
        ("Make the bed in 12 and open the window there.", {"(window-open room-12)"}, {"(window-open room-13)"}),
        ("Empty all bins that are full.", set(), {"(bin-full room-11)", "(bin-full room-12)"}),
        ("Mop all rooms except 13.", {"(floor-mopped room-12)"}, {"(floor-mopped room-13)"}),
        ("Put the tray in the locker in 13.", {"(in-locker tray room-13)"}, set()),
        ("Put a name on the vase.", {"(name-tagged vase)"}, {"(name-tagged tray)"}),
        ("Give the vase some wax.", {"(waxed vase)"}, {"(waxed tray)"}),
        ("Close the gate.", set(), {"(gate-open)"}),
        ("Leave the robot in room 12.", {"(robotat room-12)"}, set()),
        ("The tray has to be waxed and put in room 11.", {"(waxed tray)", "(thingat tray room-11)"}, set()),
        ("Is the window in room 11 open? If so, shut it, if not, mop room 12.", set(), {"(window-open room-11)"}),
        ("If the window in 12 isn't open yet, do it.", {"(window-open room-12)"}, set()),
        ("If the window in 12 is open, mop 12, otherwise mop 13 and open the window there.",
         {"(floor-mopped room-13)", "(window-open room-13)"}, {"(floor-mopped room-12)"}),
        ("If the window in 11 is open, mop 12, otherwise mop 13 and empty the bin in 12.",
         {"(floor-mopped room-12)", "(bin-full room-12)"}, {"(floor-mopped room-13)"}),
    ],
)  # fmt: skip
def test_a_part_is_what_predicates_say_of_its_place(folder: Path, text: str, held: set[str], gone: set[str]) -> None:
    assert_ends(folder, text, held, gone)
