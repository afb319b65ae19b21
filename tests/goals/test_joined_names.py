"""Requests in a world whose names are written together: ``RedBoat``, ``paintBoat``, ``GateOpen``."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.goals.conftest import assert_ends, plain_world
from tmd.language.lexicon.names import split_name

DOMAIN = """(define (domain Harbour)
  (:requirements :adl)
  (:types Pier Boat Sail Parcel - object)
  (:predicates (RobotAt ?p - Pier) (BoatAt ?b - Boat ?p - Pier) (Rigged ?s - Sail ?b - Boat)
    (SailAt ?s - Sail ?p - Pier)
    (Torn ?s - Sail) (Painted ?b - Boat) (GateOpen ?p - Pier) (ParcelAt ?x - Parcel ?p - Pier) (Weighed ?x - Parcel))
  (:action goTo :parameters (?a ?b - Pier) :precondition (RobotAt ?a) :effect (and (RobotAt ?b) (not (RobotAt ?a))))
  (:action rigSail :parameters (?s - Sail ?b - Boat ?p - Pier)
    :precondition (and (RobotAt ?p) (BoatAt ?b ?p) (SailAt ?s ?p)) :effect (and (Rigged ?s ?b) (not (SailAt ?s ?p))))
  (:action patchUp :parameters (?s - Sail ?p - Pier)
    :precondition (and (RobotAt ?p) (Torn ?s)) :effect (not (Torn ?s)))
  (:action paintBoat :parameters (?b - Boat ?p - Pier)
    :precondition (and (RobotAt ?p) (BoatAt ?b ?p)) :effect (Painted ?b))
  (:action raiseGate :parameters (?p - Pier) :precondition (RobotAt ?p) :effect (GateOpen ?p))
  (:action lowerGate :parameters (?p - Pier) :precondition (RobotAt ?p) :effect (not (GateOpen ?p)))
  (:action lowerParcel :parameters (?x - Parcel ?p - Pier) :precondition (RobotAt ?p) :effect (ParcelAt ?x ?p))
  (:action weigh :parameters (?x - Parcel ?p - Pier)
    :precondition (and (RobotAt ?p) (ParcelAt ?x ?p)) :effect (Weighed ?x)))"""
PROBLEM = """(define (problem Monday) (:domain Harbour)
  (:objects NorthPier SouthPier - Pier RedBoat BlueBoat - Boat RedSail BlueSail SpareSail - Sail
    ParcelCook ParcelTailor - Parcel)
  (:init (RobotAt NorthPier) (BoatAt RedBoat NorthPier) (BoatAt BlueBoat SouthPier) (Rigged RedSail RedBoat)
    (Rigged BlueSail BlueBoat) (SailAt SpareSail NorthPier) (Torn RedSail) (Torn BlueSail) (Torn SpareSail)
    (GateOpen NorthPier) (GateOpen SouthPier) (ParcelAt ParcelCook NorthPier) (ParcelAt ParcelTailor NorthPier))
  (:goal (and)))"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write the world."""
    return plain_world(tmp_path_factory.mktemp("harbour"), DOMAIN, PROBLEM)


@pytest.mark.parametrize(
    ("text", "held", "gone"),
    [
        ("Paint the red boat.", {"(painted redboat)"}, set()),
        ("Patch up the sail of the blue boat.", {"(torn redsail)", "(torn sparesail)"}, {"(torn bluesail)"}),
        ("Patch up the blue boat's sail.", {"(torn redsail)"}, {"(torn bluesail)"}),
        ("Close all the pier gates.", set(), {"(gateopen northpier)", "(gateopen southpier)"}),
        (
            "The blue boat needs painting and the red boat must be painted.",
            {"(painted redboat)", "(painted blueboat)"},
            set(),
        ),
        ("The blue boat could do with some paint.", {"(painted blueboat)"}, set()),
        ("No boat may stay unpainted.", {"(painted redboat)", "(painted blueboat)"}, set()),
        ("Paint every boat you can find.", {"(painted redboat)", "(painted blueboat)"}, set()),
        ("Weigh the parcel for the cook.", {"(weighed parcelcook)"}, {"(weighed parceltailor)"}),
        (
            "Weigh the parcel to the cook and the one to the tailor.",
            {"(weighed parcelcook)", "(weighed parceltailor)"},
            set(),
        ),
        (
            "If the gate of the south pier is open, close it; if it isn't, paint the blue boat.",
            {"(gateopen northpier)"},
            {"(gateopen southpier)", "(painted blueboat)"},
        ),
        (
            "If the blue boat is painted, paint the red boat; if it isn't, weigh the parcel for Tailor.",
            {"(weighed parceltailor)"},
            {"(painted redboat)"},
        ),
        ("Any boat that isn't painted should be painted.", {"(painted redboat)", "(painted blueboat)"}, set()),
    ],
)
def test_requests_end_as_they_ask(folder: Path, text: str, held: set[str], gone: set[str]) -> None:
    assert_ends(folder, text, held, gone)


@pytest.mark.parametrize(
    ("name", "parts"),
    [
        ("redbike", ("red", "bike")),
        ("iswet", ("is", "wet")),
        ("RedBike_2", ("red", "bike", "2")),
        ("doorisopen", ("door", "is", "open")),
        ("moveto", ("move", "to")),
        ("microwave", ("microwave",)),
        ("gripper", ("gripper",)),
        ("openable", ("openable",)),
        ("qxzzyv", ("qxzzyv",)),
    ],
)
def test_joined_names_are_taken_apart_into_known_words(name: str, parts: tuple[str, ...]) -> None:
    """Known words, affixes and unknown names stay whole."""
    assert split_name(name) == parts
