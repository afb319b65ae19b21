"""Requests about parts of rooms, those who act, places spoken of, and one thing alone."""

from __future__ import annotations

from pathlib import Path

import pytest

import tmd
from tests.goals.conftest import assert_ends, end, goals, plain_world
from tmd.language.parser import parse

DOMAIN = """
(define (domain lighthouse)
  (:requirements :strips :typing :negative-preconditions)
  (:types room crew lostParcel cart machine coat - object)
  (:constants cellar - room pump siren - machine)
  (:predicates (isIn ?c - crew ?r - room) (hatch_locked ?r - room) (lamps_on ?r - room) (scrubbed ?r - room)
               (small ?r - room) (lies ?p - lostParcel ?r - room) (on_hook ?p - lostParcel) (waits_at ?c - cart
                ?r - room)
               (on_rope ?c - cart ?w - crew) (isDirty ?c - cart) (isWet ?c - cart) (isRunning ?m - machine)
               (wears ?c - crew ?k - coat) (hangs ?k - coat) (dusty ?m - machine))
  (:action walk :parameters (?c - crew ?from ?to - room) :precondition (isIn ?c ?from)
    :effect (and (isIn ?c ?to) (not (isIn ?c ?from))))
  (:action lock_hatch :parameters (?c - crew ?r - room) :precondition (not (hatch_locked ?r)) :effect (hatch_locked ?r))
  (:action unlock_hatch :parameters (?c - crew ?r - room) :precondition (hatch_locked ?r)
    :effect (not (hatch_locked ?r)))
  (:action switch_on_lamps :parameters (?c - crew ?r - room) :precondition (isIn ?c ?r) :effect (lamps_on ?r))
  (:action switch_off_lamps :parameters (?c - crew ?r - room) :precondition (isIn ?c ?r) :effect (not (lamps_on ?r)))
  (:action scrub :parameters (?c - crew ?r - room) :precondition (and (isIn ?c ?r) (not (scrubbed ?r)))
    :effect (scrubbed ?r))
  (:action carry_parcel :parameters (?c - crew ?p - lostParcel ?from ?to - room)
    :precondition (and (isIn ?c ?from) (lies ?p ?from)) :effect (and (lies ?p ?to) (not (lies ?p ?from))))
  (:action hang :parameters (?c - crew ?p - lostParcel) :precondition (not (on_hook ?p)) :effect (on_hook ?p))
  (:action haul_cart :parameters (?c - crew ?k - cart ?from ?to - room) :precondition (waits_at ?k ?from)
    :effect (and (waits_at ?k ?to) (not (waits_at ?k ?from))))
  (:action put_on_rope :parameters (?c - crew ?k - cart) :precondition (not (on_rope ?k ?c)) :effect (on_rope ?k ?c))
  (:action wash :parameters (?c - crew ?k - cart) :precondition (isRunning pump)
    :effect (and (isWet ?k) (not (isDirty ?k))))
  (:action start :parameters (?c - crew ?m - machine) :precondition (not (isRunning ?m)) :effect (isRunning ?m))
  (:action put_on_coat :parameters (?c - crew ?k - coat) :precondition (hangs ?k)
    :effect (and (wears ?c ?k) (not (hangs ?k))))
  (:action wipe_down :parameters (?c - crew ?m - machine) :precondition (dusty ?m) :effect (not (dusty ?m)))
  (:action halt :parameters (?c - crew ?m - machine) :precondition (isRunning ?m) :effect (not (isRunning ?m))))
"""
PROBLEM = """
(define (problem storm) (:domain lighthouse)
 (:objects attic gallery - room ida olaf - crew tin crate - lostParcel redCart oldCart - cart
           cellar_bell - machine wool_coat rain_coat - coat)
 (:init (isIn ida gallery) (isIn olaf attic) (hatch_locked cellar) (lamps_on attic) (lamps_on gallery) (scrubbed attic)
        (small attic) (small cellar) (lies tin gallery) (lies crate attic) (waits_at redCart cellar)
        (waits_at oldCart gallery) (isDirty redCart) (isWet redCart) (isDirty oldCart) (isRunning siren)
        (hangs wool_coat) (hangs rain_coat) (dusty siren))
 (:goal (and)))
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return plain_world(tmp_path_factory.mktemp("lighthouse"), DOMAIN, PROBLEM)


@pytest.mark.parametrize(
    ("text", "held", "gone"),
    [
        # a part stands for the whole that it belongs to, and the other way round
        ("Lock the gallery.", {"(hatch_locked gallery)"}, set()),
        ("Walk to the cellar and unlock the hatch.", set(), {"(hatch_locked cellar)"}),
        (
            "Ida, walk to the attic and switch its lamps off.",
            {"(isin ida attic)", "(lamps_on gallery)"},
            {"(lamps_on attic)"},
        ),
        ("Lamps off in the gallery.", {"(lamps_on attic)"}, {"(lamps_on gallery)"}),
        ("Turn the lamps off in the attic and the gallery.", set(), {"(lamps_on attic)", "(lamps_on gallery)"}),
        ("The hatch of the cellar is locked. Open it.", set(), {"(hatch_locked cellar)"}),
        ("The gallery should be dark.", {"(lamps_on attic)"}, {"(lamps_on gallery)"}),
        # those who are addressed act, and everyone may
        ("Olaf, go to the cellar.", {"(isin olaf cellar)", "(isin ida gallery)"}, set()),
        ("Ida, wait in the attic.", {"(isin ida attic)"}, set()),
        ("Everybody should be in the cellar.", {"(isin ida cellar)", "(isin olaf cellar)"}, {"(lies tin cellar)"}),
        ("Carry the crate to the cellar, and put the tin back.", {"(lies crate cellar)", "(lies tin gallery)"}, set()),
        ("Everyone has to go to the cellar.", {"(isin ida cellar)", "(isin olaf cellar)"}, set()),
        # what still has to be done
        ("If the gallery has to be scrubbed, scrub it.", {"(scrubbed gallery)"}, set()),
        (
            "If the attic needs to be scrubbed, lock it, otherwise lock the gallery.",
            {"(hatch_locked gallery)"},
            {"(hatch_locked attic)"},
        ),
        ("The gallery needs scrubbing and the cellar does too.", {"(scrubbed gallery)", "(scrubbed cellar)"}, set()),
        # what is out of a place, in there, or there already
        ("The red cart should be out of the cellar.", set(), {"(waits_at redcart cellar)"}),
        (
            "Once the red cart is out of the cellar, haul the old cart into it.",
            {"(waits_at oldcart cellar)"},
            {"(waits_at redcart cellar)"},
        ),
        ("Unlock the cellar. Take the tin and put it in there.", {"(lies tin cellar)"}, {"(hatch_locked cellar)"}),
        ("Carry the tin to the cellar unless it is already there.", {"(lies tin cellar)"}, set()),
        ("Carry the tin in with the crate.", {"(lies tin attic)", "(lies crate attic)"}, set()),
        # what is to be had, or need not be done
        ("The attic gets the tin.", {"(lies tin attic)"}, set()),
        ("The attic and the cellar get a parcel each.", {"(lies tin cellar)", "(lies crate attic)"}, set()),
        ("Is the cellar scrubbed? It should be.", {"(scrubbed cellar)"}, set()),
        ("Scrub the cellar. If the attic is small, lock it.", {"(scrubbed cellar)", "(hatch_locked attic)"}, set()),
        # what is taken off, only taken, or stays
        ("Wipe the dust off the siren.", set(), {"(dusty siren)"}),
        ("Get the tin from the gallery, put it in the cellar and lock the attic.", {"(lies tin cellar)"}, set()),
        ("All parcels go in the cellar, only the tin stays put.", {"(lies tin gallery)", "(lies crate cellar)"}, set()),
        # a thing that is named after where it is
        ("Start the bell in the cellar.", {"(isrunning cellar_bell)"}, {"(isrunning pump)"}),
        # one thing alone, and all but one
        ("Only the tin should be in the attic.", {"(lies tin attic)"}, {"(lies crate attic)"}),
        ("Nothing but the tin should be in the gallery.", {"(lies tin gallery)"}, set()),
        ("Lock all but the attic.", {"(hatch_locked gallery)"}, {"(hatch_locked attic)"}),
        ("Neither of the machines should be running.", set(), {"(isrunning siren)", "(isrunning pump)"}),
        # words of names
        ("Put all the lost parcels in the cellar.", {"(lies tin cellar)", "(lies crate cellar)"}, set()),
        ("Wash the red cart.", set(), {"(isdirty redcart)"}),
        (
            "Haul the old cart in the attic and then wash the red one.",
            {"(waits_at oldcart attic)"},
            {"(isdirty redcart)"},
        ),
        ("Give the old cart a bath.", set(), {"(isdirty oldcart)"}),
        ("Get the pump going.", {"(isrunning pump)"}, set()),
        ("We don't need the siren any longer, so stop it.", set(), {"(isrunning siren)"}),
    ],
)
def test_a_request_ends_as_it_was_meant(folder: Path, text: str, held: set[str], gone: set[str]) -> None:
    assert_ends(folder, text, held, gone)


@pytest.mark.parametrize(
    ("text", "dressed"),
    [
        ("Everyone has to put on a coat.", {"ida", "olaf"}),
        ("Ida and Olaf have to put on a coat.", {"ida", "olaf"}),
        ("Everybody except Ida has to put on a coat.", {"olaf"}),
        ("Everybody in the attic has to put on a coat.", {"olaf"}),
    ],
)
def test_each_one_who_is_meant_acts(folder: Path, text: str, dressed: set[str]) -> None:
    grounded = tmd.load_domain(str(folder)).ground(text, folder / "problem.pddl")
    assert {fact.split()[1] for fact in end(grounded) if fact.startswith("(wears ")} == dressed


@pytest.mark.parametrize("text", ["Scrub the attic.", "Put the old cart in the gallery."])
def test_what_is_so_for_good_is_nothing_to_do(folder: Path, text: str) -> None:
    grounded = tmd.load_domain(str(folder)).ground(text, folder / "problem.pddl")
    assert goals(grounded)
    assert not grounded.plans[0].instructions


@pytest.mark.parametrize("text", ["Haul the red cart.", "Display the tin."])
def test_what_says_too_little_is_refused(folder: Path, text: str) -> None:
    assert not tmd.load_domain(str(folder)).ground(text, folder / "problem.pddl").plans


def test_those_who_are_named_hold_what_is_on_the_rope(folder: Path) -> None:
    grounded = tmd.load_domain(str(folder)).ground("Put the red cart on the rope.", folder / "problem.pddl")
    assert any("on_rope redcart" in goal for goal in goals(grounded))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("Give the pot a wash and a rinse.", [("wash", ("pot",)), ("rinse", ("pot",))]),
        ("Put the lamps up in the hall and down in the shed.", [("put_up", ("lamp",)), ("put_down", ("lamp",))]),
        ("If the lid is shut and not dirty, open it.", [("open", ("it",))]),
        ("The lamp should be off before you close the door.", [("turn_off", ("lamp",)), ("close", ("door",))]),
    ],
)
def test_nothing_that_was_said_is_lost(text: str, said: list[tuple[str, tuple[str, ...]]]) -> None:
    found = parse(text)
    assert [(clause.verb, clause.direct) for clause in found.clauses] == said
    assert not found.constraints


@pytest.mark.parametrize(
    ("text", "states"),
    [
        ("If the lid is shut and not dirty, open it.", ["shut", "not_dirty"]),
        ("If the dog is in the yard and she isn't fed, feed her.", [None, "not_fed"]),
    ],
)
def test_each_part_of_a_condition_counts(text: str, states: list[str | None]) -> None:
    (condition,) = parse(text).clauses[0].conditions
    assert [clause.result for clause in condition.clauses] == states
