"""Who does it, what is put in whose place, and what a statement asks for without an instruction."""

from __future__ import annotations

from pathlib import Path

import pytest

import tmd
from tests.goals.conftest import assert_ends, end, goals, plain_world, said

DOMAIN = """
(define (domain boatyard)
  (:requirements :typing :negative-preconditions)
  (:types hand boat part dock tint - object)
  (:predicates (at ?h - hand ?d - dock) (moored ?b - boat ?d - dock) (lies ?p - part ?d - dock)
               (has ?h - hand ?p - part) (free ?h - hand) (mounted ?p - part ?b - boat)
               (open_slot ?b - boat) (scrubbed ?b - boat) (hull ?b - boat ?t - tint) (covered ?b - boat)
               (leaking ?b - boat))
  (:action stroll :parameters (?h - hand ?x ?y - dock) :precondition (at ?h ?x)
    :effect (and (at ?h ?y) (not (at ?h ?x))))
  (:action tow :parameters (?h - hand ?b - boat ?x ?y - dock) :precondition (and (at ?h ?x) (moored ?b ?x))
    :effect (and (moored ?b ?y) (at ?h ?y) (not (moored ?b ?x)) (not (at ?h ?x))))
  (:action scrub :parameters (?h - hand ?b - boat ?d - dock) :precondition (and (at ?h ?d) (moored ?b ?d))
    :effect (scrubbed ?b))
  (:action lift :parameters (?h - hand ?p - part ?d - dock) :precondition (and (at ?h ?d) (lies ?p ?d) (free ?h))
    :effect (and (has ?h ?p) (not (lies ?p ?d)) (not (free ?h))))
  (:action drop :parameters (?h - hand ?p - part ?d - dock) :precondition (and (at ?h ?d) (has ?h ?p))
    :effect (and (lies ?p ?d) (free ?h) (not (has ?h ?p))))
  (:action mount :parameters (?h - hand ?p - part ?b - boat ?d - dock)
    :precondition (and (at ?h ?d) (moored ?b ?d) (has ?h ?p) (open_slot ?b))
    :effect (and (mounted ?p ?b) (free ?h) (not (has ?h ?p)) (not (open_slot ?b))))
  (:action unmount :parameters (?h - hand ?p - part ?b - boat ?d - dock)
    :precondition (and (at ?h ?d) (moored ?b ?d) (mounted ?p ?b) (free ?h))
    :effect (and (has ?h ?p) (open_slot ?b) (not (mounted ?p ?b)) (not (free ?h))))
  (:action paint :parameters (?h - hand ?b - boat ?d - dock ?t - tint) :precondition (and (at ?h ?d) (moored ?b ?d))
    :effect (and (hull ?b ?t) (forall (?o - tint) (when (not (= ?o ?t)) (not (hull ?b ?o))))))
  (:action caulk :parameters (?h - hand ?b - boat ?d - dock) :precondition (and (at ?h ?d) (moored ?b ?d))
    :effect (not (leaking ?b)))
  (:action cover :parameters (?h - hand ?b - boat ?d - dock) :precondition (and (at ?h ?d) (moored ?b ?d))
    :effect (covered ?b))
  (:action uncover :parameters (?h - hand ?b - boat ?d - dock) :precondition (and (at ?h ?d) (moored ?b ?d))
    :effect (not (covered ?b))))
"""
PROBLEM = """
(define (problem noon) (:domain boatyard)
 (:objects Ana Tom - hand ferry yawl - boat old_rudder new_rudder - part dock1 dock2 dock3 - dock white green - tint)
 (:init (at Ana dock1) (at Tom dock2) (free Ana) (free Tom) (moored ferry dock1) (moored yawl dock2) (covered yawl)
        (mounted old_rudder ferry) (lies new_rudder dock3) (open_slot yawl) (hull ferry white) (hull yawl white)
        (leaking yawl))
 (:goal (and)))
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return plain_world(tmp_path_factory.mktemp("boatyard"), DOMAIN, PROBLEM)


@pytest.mark.parametrize(
    ("text", "held", "gone"),
    [
        ("Tom, scrub the ferry.", {"(scrubbed ferry)"}, {"(scrubbed yawl)"}),
        ("Have Ana scrub the yawl.", {"(scrubbed yawl)"}, {"(scrubbed ferry)"}),
        ("Ask Tom to scrub the yawl, please.", {"(scrubbed yawl)"}, set()),
        ("Tom, you can scrub the ferry now.", {"(scrubbed ferry)"}, set()),
        ("Could Ana tow the yawl to dock 3?", {"(moored yawl dock3)"}, set()),
        (
            "The rudder on the ferry is cracked. Swap it for the new one.",
            {"(mounted new_rudder ferry)"},
            {"(mounted old_rudder ferry)"},
        ),
        ("Put the new rudder on the yawl.", {"(mounted new_rudder yawl)"}, set()),
        ("Take the old rudder off the ferry.", set(), {"(mounted old_rudder ferry)"}),
        ("The ferry should be green.", {"(hull ferry green)"}, {"(hull ferry white)"}),
        ("The yawl should go green.", {"(hull yawl green)"}, {"(hull yawl white)"}),
        ("It's getting late, so I'd like the ferry scrubbed.", {"(scrubbed ferry)"}, set()),
        ("At the end of the day I want the yawl scrubbed.", {"(scrubbed yawl)"}, set()),
        ("Every boat, except the ferry, goes to dock 3.", {"(moored yawl dock3)", "(moored ferry dock1)"}, set()),
        ("Scrub the ferry, Tom's still busy on the other one.", {"(scrubbed ferry)"}, {"(scrubbed yawl)"}),
        ("Both boats get a scrub.", {"(scrubbed ferry)", "(scrubbed yawl)"}, set()),
        ("Scrub the ferry, the yawl doesn't need it.", {"(scrubbed ferry)"}, {"(scrubbed yawl)"}),
        ("You couldn't scrub the yawl, could you?", {"(scrubbed yawl)"}, {"(scrubbed ferry)"}),
        ("If the yawl is still at dock 2, could you tow it to dock 3?", {"(moored yawl dock3)"}, set()),
        ("If the yawl is at dock 3, could you scrub it?", set(), {"(scrubbed yawl)"}),
        (
            "Two things need to happen today: scrub the ferry and the yawl.",
            {"(scrubbed ferry)", "(scrubbed yawl)"},
            set(),
        ),
        ("You're looking at a dirty ferry. Scrub it.", {"(scrubbed ferry)"}, set()),
        ("Season's over: yawl uncovered, ferry covered.", {"(covered ferry)"}, {"(covered yawl)"}),
    ],
)
def test_the_state_that_is_asked_for(folder: Path, text: str, held: set[str], gone: set[str]) -> None:
    assert_ends(folder, text, {fact.lower() for fact in held}, {fact.lower() for fact in gone})


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("Scrub the ferry with the new rudder.", "cannot be done here"),
        ("Caulk the ferry.", "ferry is not 'leaking' anyway"),
        ("Put the new rudder into dock 9.", "dock 9"),
    ],
)
def test_what_no_action_takes_and_what_is_so_anyway(folder: Path, text: str, reason: str) -> None:
    found = tmd.load_domain(str(folder)).ground(text, folder / "problem.pddl")
    assert not found.plans
    assert reason in found.reason


@pytest.mark.parametrize(
    ("environment", "text", "held", "gone"),
    [
        (
            "kitchen4",
            "Put the milk in the fridge and the noodles in the cupboard, then close both of them.",
            {"(at milk1 fridge1 in)", "(at ramen1 cupboard1 in)"},
            {"(opened fridge1_door)", "(opened cupboard1_door)"},
        ),
        (
            "kitchen5",
            "Put the kettle on burner 2 and turn the corresponding knob to low.",
            {"(set_to stove1_knob2 low)"},
            set(),
        ),
        ("kitchen1", "Pour some milk into the cup, not the mug.", {"(contains cup1 milk)"}, {"(contains mug1 milk)"}),
        (
            "kitchen4",
            "Both eggs boiled in the pot, then vanilla ice cream in the bowl.",
            {"(contains bowl1 vanilla_ice_cream)"},
            {"(contains bowl1 raw_egg)", "(filled egg1)", "(filled egg2)"},
        ),
        (
            "kitchen4",
            "Close whatever doors are still open, would you?",
            set(),
            {"(opened fridge1_door)", "(opened cupboard1_door)"},
        ),
        ("kitchen1", "The milk can come out of the fridge, dinner is late.", set(), {"(at milk1 fridge1 in)"}),
        ("room1", "Get the movie in.", {"(at dvd1 console1 in)"}, set()),
        (
            "room4",
            "Every glass in the room goes on the trolley.",
            {"(at glass1 trolley1 on)", "(at glass2 trolley1 on)"},
            set(),
        ),
        ("room4", "The curtain I'd like open.", {"(opened window1_curtain)"}, set()),
        ("room5", "Floor lamp on high, the other lamp off.", {"(set_to floor_lamp1_knob high)"}, {"(active lamp1)"}),
    ],
)
def test_in_bundled_rooms(environment: str, text: str, held: set[str], gone: set[str]) -> None:
    domain = "kitchen" if environment.startswith("kitchen") else "living_room"
    facts = end(said(domain, environment, text))
    assert held <= facts and not gone & facts


def test_two_that_were_spoken_of_are_those_in_their_places() -> None:
    text = "There's a bottle lying on the floor and a blanket on the sofa. Bring these two to the snack table."
    assert goals(said("living_room", "room4", text)) == [
        "(and (at beer_bottle2 snack_table1 on) (at blanket1 snack_table1 on))"
    ]


def test_one_of_several_that_is_not_there_is_told() -> None:
    text = "There's a bottle on the floor and a cushion on the sofa. Bring them to the snack table."
    assert "no cushion here is on the sofa" in said("living_room", "room4", text).reason


def test_a_state_that_belongs_to_nothing_is_told() -> None:
    text = "Would it be possible to have a soda from the fridge on the snack table, already opened?"
    assert "'opened'" in said("living_room", "room5", text).reason
