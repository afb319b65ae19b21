"""What is read off the names of a domain without a lexicon: parts, persons, clearing, and putting back."""

from __future__ import annotations

from pathlib import Path

import pytest

import tmd
from tests.goals.conftest import assert_ends, end, plain_world

DOMAIN = """(define (domain store)
  (:requirements :strips :typing :negative-preconditions)
  (:types porter room parcel guest - object)
  (:predicates (porter_at ?p - porter ?r - room) (parcel_in ?x - parcel ?r - room) (held ?x - parcel)
    (hands_free ?p - porter) (has ?g - guest ?x - parcel) (guest_in ?g - guest ?r - room) (door_open ?r - room)
    (lid_on ?x - parcel))
  (:action walk :parameters (?p - porter ?from ?to - room) :precondition (porter_at ?p ?from)
    :effect (and (porter_at ?p ?to) (not (porter_at ?p ?from))))
  (:action pick_up :parameters (?p - porter ?x - parcel ?r - room)
    :precondition (and (porter_at ?p ?r) (parcel_in ?x ?r) (hands_free ?p))
    :effect (and (held ?x) (not (parcel_in ?x ?r)) (not (hands_free ?p))))
  (:action put_down :parameters (?p - porter ?x - parcel ?r - room)
    :precondition (and (porter_at ?p ?r) (held ?x))
    :effect (and (parcel_in ?x ?r) (hands_free ?p) (not (held ?x))))
  (:action hand_over :parameters (?p - porter ?x - parcel ?g - guest ?r - room)
    :precondition (and (porter_at ?p ?r) (guest_in ?g ?r) (held ?x))
    :effect (and (has ?g ?x) (hands_free ?p) (not (held ?x))))
  (:action open_door :parameters (?p - porter ?r - room) :precondition (porter_at ?p ?r) :effect (door_open ?r))
  (:action close_door :parameters (?p - porter ?r - room) :precondition (porter_at ?p ?r) :effect (not (door_open ?r)))
  (:action close_parcel :parameters (?p - porter ?x - parcel ?r - room)
    :precondition (and (porter_at ?p ?r) (parcel_in ?x ?r)) :effect (lid_on ?x)))"""
PROBLEM = """(define (problem morning) (:domain store)
  (:objects porter_1 - porter cellar attic hall - room parcel_1 parcel_2 parcel_3 - parcel ann bert - guest)
  (:init (porter_at porter_1 hall) (hands_free porter_1) (parcel_in parcel_1 cellar) (parcel_in parcel_2 cellar)
    (parcel_in parcel_3 attic) (door_open cellar) (door_open attic) (guest_in ann hall) (guest_in bert attic))
  (:goal (and)))"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Write the world."""
    return plain_world(tmp_path_factory.mktemp("store"), DOMAIN, PROBLEM)


@pytest.mark.parametrize(
    ("text", "held", "gone"),
    [
        ("Clear the cellar.", {}, {"(parcel_in parcel_1 cellar)", "(parcel_in parcel_2 cellar)"}),
        ("Shut all the doors.", {}, {"(door_open cellar)", "(door_open attic)"}),
        ("Put the lids on the parcels.", {"(lid_on parcel_1)", "(lid_on parcel_2)", "(lid_on parcel_3)"}, {}),
        ("Send the porter to the attic.", {"(porter_at porter_1 attic)"}, {}),
        ("Put parcel 1 in the attic, then put it back where it was.", {"(parcel_in parcel_1 cellar)"}, {}),
        ("Parcel 2 for Ann.", {"(has ann parcel_2)"}, {}),
        ("Bert is waiting. Give him parcel 1.", {"(has bert parcel_1)"}, {}),
        ("Take the package from the attic to the hall.", {"(parcel_in parcel_3 hall)"}, {}),
        ("If the attic is empty, open its door, otherwise clear it.", {}, {"(parcel_in parcel_3 attic)"}),
        ("Put parcel 3 where parcel 1 is.", {"(parcel_in parcel_3 cellar)"}, {}),
        ("Don't drop anything. Carry parcel 3 to the hall.", {"(parcel_in parcel_3 hall)"}, {}),
    ],
)
def test_requests_end_as_they_ask(folder: Path, text: str, held: set[str], gone: set[str]) -> None:
    assert_ends(folder, text, held, gone)


def test_a_prohibition_that_nothing_can_check_is_told(folder: Path) -> None:
    grounded = tmd.load_domain(str(folder)).ground("Clear the attic, don't scratch it.", folder / "problem.pddl")
    assert any("scratch" in warning for warning in grounded.warnings)


def test_a_fragment_that_names_nothing_known_is_left_out_with_a_warning(folder: Path) -> None:
    grounded = tmd.load_domain(str(folder)).ground("What a day! Shut the attic door.", folder / "problem.pddl")
    assert "(door_open attic)" not in end(grounded)
    assert any("day" in warning.lower() for warning in grounded.warnings)


@pytest.mark.parametrize("name", ["on-table", "on_table", "ontable"])
def test_a_place_that_is_no_thing_is_a_predicate(tmp_path: Path, name: str) -> None:
    (tmp_path / "domain.pddl").write_text(
        f"""(define (domain heap) (:requirements :strips :typing)
          (:types block - object)
          (:predicates (on ?x ?y - block) ({name} ?x - block) (clear ?x - block))
          (:action lift :parameters (?x ?y - block) :precondition (and (on ?x ?y) (clear ?x))
            :effect (and ({name} ?x) (clear ?y) (not (on ?x ?y))))
          (:action pile :parameters (?x ?y - block) :precondition (and ({name} ?x) (clear ?x) (clear ?y))
            :effect (and (on ?x ?y) (not ({name} ?x)) (not (clear ?y)))))"""
    )
    (tmp_path / "problem.pddl").write_text(
        f"""(define (problem three) (:domain heap) (:objects red_block blue_block green_block - block)
          (:init (on red_block blue_block) ({name} blue_block) ({name} green_block) (clear red_block)
            (clear green_block)) (:goal (and)))"""
    )
    domain = tmd.load_domain(str(tmp_path))
    lifted = domain.ground("Put everything on the table.", tmp_path / "problem.pddl")
    assert f"({name} red_block)" in end(lifted)
    told = domain.ground("Put the block that is on the table on the red one.", tmp_path / "problem.pddl")
    assert end(told) & {"(on blue_block red_block)", "(on green_block red_block)"}
    assert not domain.ground("Put the red block on the floor.", tmp_path / "problem.pddl").plans
