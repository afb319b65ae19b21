"""Words that count: nothing that was said is silently lost, and what is excepted is left alone."""

from __future__ import annotations

import re

import pytest

from tests.bundled import kit
from tests.goals.conftest import goals, said, steps
from tmd.goals.preferences import AS_BEFORE, NOT_LEFT, ODDS, READINGS, SUBSTANCES, THINGS
from tmd.goals.reasons import nearest_verbs
from tmd.goals.words import family


@pytest.mark.parametrize(
    ("place", "text", "word"),
    [
        ("kitchen/kitchen1", "Bring me the honey jar.", "honey jar"),
        ("kitchen/kitchen1", "Put the striped cup on the table.", "striped"),
        ("kitchen/kitchen1", "Take the cup to the pantry.", "pantry"),
        ("kitchen/kitchen1", "Put the mug on the table next to the piano.", "piano"),
        ("kitchen/kitchen1", "Put three cups on the table.", "not 3"),
        ("kitchen/kitchen1", "Open the cupboard using the crowbar.", "crowbar"),
        ("kitchen/kitchen1", "Pour half of the milk into the cup.", "half"),
        ("kitchen/kitchen1", "Put the mug where the piano is.", "piano"),
        ("living_room/room1", "Turn on the garden lamp.", "garden lamp"),
        ("living_room/room1", "Turn on the lamp by the piano.", "piano"),
        ("living_room/room5", "Turn off all the lamps except the one by the piano.", "piano"),
    ],
)
def test_a_word_that_fits_nothing_here_refuses_the_step(place: str, text: str, word: str) -> None:
    domain, environment = place.split("/")
    grounded = said(domain, environment, text)
    assert not grounded.plans
    assert word in grounded.reason


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("Pour milk into each cup except the one with water.", {"cup2"}),
        ("Each cup gets some milk, but don't bother with the one that has water in it.", {"cup2"}),
        ("Pour milk into each cup, but leave the one with water in it as it is.", {"cup2"}),
        ("Put the cups on the table, except the one on the counter.", {"cup2"}),
    ],
)
def test_what_is_taken_from_a_whole_gets_nothing(text: str, expected: set[str]) -> None:
    grounded = said("kitchen", "kitchen5", text)
    assert grounded.plans
    assert set(re.findall(r"\bcup\d", " ".join(goals(grounded)))) == expected


def test_an_exception_that_nothing_fits_gives_a_warning() -> None:
    grounded = said("living_room", "room5", "Turn off all the lamps except the one by the shelf.")
    assert any("exception" in warning for warning in map(str, grounded.warnings))


def test_a_guess_may_leave_a_word_out() -> None:
    grounded = kit("kitchen").ground("Put the striped cup on the table.", "kitchen1", guess=True)
    assert goals(grounded) == ["(at cup1 table1 on)"]


@pytest.mark.parametrize(
    ("place", "text", "excepted"),
    [
        ("living_room/room1", "Switch everything off apart from the lamp.", "lamp1"),
        ("living_room/room1", "Put the pillows on the sofa except the one on the armchair.", "pillow2"),
        ("kitchen/kitchen1", "Close all doors except the fridge door.", "fridge1_door"),
    ],
)
def test_no_instruction_handles_what_is_excepted(place: str, text: str, excepted: str) -> None:
    domain, environment = place.split("/")
    grounded = said(domain, environment, text)
    assert excepted in grounded.dialogue.constraints.untouched
    assert not any(re.search(rf"\b{excepted}\b", step) for step in steps(grounded))


def test_a_generic_verb_means_no_more_specific_one() -> None:
    assert "throw" not in family("put")
    assert "put" in family("toss")
    assert "stop" not in family("pause")


def test_it_is_what_made_the_condition_true() -> None:
    grounded = said("living_room", "room1", "If a pillow is on the armchair, carry it to the shelf.")
    assert goals(grounded)[-1] == "(at pillow2 shelf1 on)"


def test_a_condition_of_any_thing_means_all_that_meet_it() -> None:
    grounded = said("living_room", "room4", "If a bottle is empty, carry it to the shelf.")
    assert goals(grounded)[-1].count("shelf1") == 2


@pytest.mark.parametrize(
    "text",
    [
        "There is a mug on the shelf. Carry it to the table.",
        "The mug on the shelf is new, so bring the mug to the table.",
    ],
)
def test_a_statement_tells_which_thing_is_meant(text: str) -> None:
    assert goals(said("kitchen", "kitchen2", text)) == ["(at mug2 table1 on)"]


@pytest.mark.parametrize("clause", ["that is on the table", "you see on the table"])
def test_a_relative_clause_never_says_where_a_thing_shall_go(clause: str) -> None:
    grounded = said("living_room", "room3", f"Bring me the book {clause}.")
    assert not grounded.plans
    assert grounded.reason.endswith("no book here is on the table")


def test_a_heading_that_only_sums_up_may_mean_nothing() -> None:
    grounded = said("living_room", "room1", "Tidy the armchair: whatever is on it belongs on the sofa.")
    assert "(and (at pillow2 sofa1 on) (at blanket1 sofa1 on))" in goals(grounded)


def test_what_a_heading_is_about_is_where_its_details_are() -> None:
    grounded = said("living_room", "room3", "Clear the floor: the book onto the shelf.")
    assert goals(grounded) == ["(at book1 shelf1 on)", ""]


def test_what_a_button_does_is_asked_for() -> None:
    grounded = said("kitchen", "kitchen3", "Press the button that opens the microwave.")
    assert goals(grounded)[-1] == "(opened microwave1_door)"


def test_a_title_asks_for_nothing() -> None:
    grounded = said("living_room", "room5", "Popcorn and a film tonight! Put the movie in the console.")
    assert goals(grounded) == ["(at dvd1 console1 in)"]
    assert said("kitchen", "kitchen3", "mug2: water, hot. Microwave off.").reason


def test_an_origin_tells_which_place_is_meant() -> None:
    assert goals(said("kitchen", "kitchen2", "Pour milk into the mug from the shelf.")) == ["(contains mug2 milk)"]


def test_it_is_rather_what_something_was_put_in() -> None:
    grounded = said("kitchen", "kitchen4", "Put the milk in the fridge and close it.")
    assert goals(grounded)[-1] == "(not (opened fridge1_door))"
    opened = said("living_room", "room5", "Pull up the blind, put the juice in the fridge and close it.")
    assert goals(opened)[-1] == "(not (opened fridge1_door))"


def test_to_empty_is_not_to_pour_into() -> None:
    assert goals(said("living_room", "room4", "Empty the bowl with the peanuts.")) == ["(not (filled bowl1))"]


def test_a_state_that_nothing_can_be_in_is_refused() -> None:
    grounded = said("living_room", "room4", "All lights off, win closed.")
    assert "nothing here says whether light is closed" in grounded.reason


def test_a_substance_is_its_vessel_or_its_supply() -> None:
    """Both readings are candidates; the plan that takes fewer steps is the first."""
    grounded = said("living_room", "room5", "Pour the juice in the glass and put the juice in the fridge.")
    assert goals(grounded)[-1] == "(or (at juice_carton1 fridge1 in) (at glass1 fridge1 in))"


def test_an_unknown_verb_names_the_nearest_known_ones() -> None:
    assert nearest_verbs("hone", {"sharpen", "open", "take"}) == ["sharpen"]
    assert nearest_verbs("flurble", {"open"}) == []


def test_preferences_have_names_reasons_and_examples() -> None:
    table = (*THINGS, *SUBSTANCES, *NOT_LEFT, *AS_BEFORE, *READINGS)
    assert len({preference.name for preference in table}) == len(table)
    assert all(preference.reason and preference.example.endswith(".") for preference in table)
    assert sorted(ODDS) == sorted(rule.name for rule in table)
