"""Relations that no preposition names: a label is on what is labelled, and who needs a crate shall receive it."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.goals.conftest import assert_ends, plain_world

DOMAIN = """
(define (domain depot)
  (:requirements :typing :negative-preconditions)
  (:types crate place clerk)
  (:predicates (labelled ?c - crate) (sealed ?c - crate) (stamped ?c - crate) (at ?c - crate ?p - place)
               (holding ?c - crate) (free) (received ?k - clerk ?c - crate))
  (:action label :parameters (?c - crate) :precondition (not (labelled ?c)) :effect (labelled ?c))
  (:action stamp :parameters (?c - crate) :precondition (not (stamped ?c)) :effect (stamped ?c))
  (:action seal :parameters (?c - crate) :precondition (not (sealed ?c)) :effect (sealed ?c))
  (:action pick-up :parameters (?c - crate ?p - place) :precondition (and (at ?c ?p) (free))
    :effect (and (holding ?c) (not (free)) (not (at ?c ?p))))
  (:action put-down :parameters (?c - crate ?p - place) :precondition (holding ?c)
    :effect (and (at ?c ?p) (free) (not (holding ?c))))
  (:action hand-over :parameters (?c - crate ?k - clerk) :precondition (holding ?c)
    :effect (and (received ?k ?c) (free) (not (holding ?c)))))
"""
PROBLEM = """
(define (problem yard) (:domain depot)
 (:objects crate1 crate2 crate3 - crate dock ramp - place miller - clerk)
 (:init (at crate1 dock) (at crate2 dock) (at crate3 ramp) (labelled crate1) (stamped crate2) (free))
 (:goal (and)))
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return plain_world(tmp_path_factory.mktemp("depot"), DOMAIN, PROBLEM)


@pytest.mark.parametrize(
    ("text", "held", "gone"),
    [
        ("Put a label on crate 2.", {"(labelled crate2)"}, {"(labelled crate3)"}),
        ("Stick a stamp on crate 1.", {"(stamped crate1)"}, {"(stamped crate3)"}),
        ("If crate 2 has no label, seal it.", {"(sealed crate2)"}, {"(labelled crate2)"}),
        ("If crate 1 has no label, seal it.", set(), {"(sealed crate1)"}),
        ("If crate 1 has a label, seal it.", {"(sealed crate1)"}, set()),
        ("Every crate should have a label.", {"(labelled crate2)", "(labelled crate3)"}, set()),
        ("No crate should be without a stamp.", {"(stamped crate1)", "(stamped crate3)"}, set()),
        ("Seal the crates that have no label.", {"(sealed crate2)", "(sealed crate3)"}, {"(sealed crate1)"}),
        ("Seal the crates without a label.", {"(sealed crate2)", "(sealed crate3)"}, {"(sealed crate1)"}),
        ("Seal the crates if they are labelled.", {"(sealed crate1)"}, {"(sealed crate2)", "(sealed crate3)"}),
        ("Seal the crates, but only if they have no label.", {"(sealed crate2)"}, {"(sealed crate1)"}),
        ("Stamp all crates if they are at the ramp.", {"(stamped crate3)"}, {"(stamped crate1)"}),
        ("Carry all crates that have a stamp to the ramp.", {"(at crate2 ramp)"}, {"(at crate1 ramp)"}),
    ],
)
def test_a_mark_is_a_state_of_what_has_it(folder: Path, text: str, held: set[str], gone: set[str]) -> None:
    assert_ends(folder, text, held, gone)


@pytest.mark.parametrize("text", ["Miller needs crate 2.", "Give Miller crate 2.", "Miller should have crate 2."])
def test_what_somebody_needs_is_what_the_only_such_predicate_says(folder: Path, text: str) -> None:
    assert_ends(folder, text, {"(received miller crate2)"}, {"(received miller crate1)"})
