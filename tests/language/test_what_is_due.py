"""What things should be, have or be spared, and the plain clauses that such sentences stand for."""

from __future__ import annotations

import pytest

from tmd.language import parse, print_clause
from tmd.language.syntax.reading import denies


def clauses(text: str) -> list[str]:
    return [print_clause(c) for c in parse(text).clauses]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        # what "they" of things are to be
        ("The plants are dry. They need to be watered.", ["(water, [them])"]),
        (
            "Look at the cups. They must be on the shelf.",
            ["(look, [cup], at: -> cup)", "(put, [them, shelf], on: them -> shelf)"],
        ),
        ("The guests are here. They should be seated soon. Shut the gate.", ["(shut, [gate])"]),
        # a question or a statement that "should be" takes up
        ("Is the window shut? It should be.", ["(close, [it])"]),
        ("Are the lamps off? They should be.", ["(turn_off, [them])"]),
        ("Wash the mug. Is the lamp on?", ["(wash, [mug])"]),
        # several states, each a clause
        ("Make the floor clean and dry.", ["(make, [floor])", "(make, [floor])"]),
        ("Both windows shut and locked, please.", ["(close, [window])", "(be, [window])"]),
        # a part of a statement without a predicate of its own
        ("The lamps should be off and the radio before we leave.", ["(turn_off, [lamp])", "(turn_off, [radio])"]),
        # the state that a verb leaves
        ("Push open the door and swing shut the hatch.", ["(push, [door])", "(swing, [hatch])"]),
        # several owners and receivers
        (
            "The sofa and the bench get a rug each.",
            ["(be, [sofa, rug], with: sofa -> rug)", "(be, [bench, rug], with: bench -> rug)"],
        ),
        ("Give the fern and the ivy a drop.", ["(give, [fern, ivy, drop], to: drop -> fern, to: drop -> ivy)"]),
        ("Every piece of furniture needs a label.", ["(be, [furniture, label], with: furniture -> label)"]),
        # where something goes behind a comma
        (
            "Put all toys in the chest but the ball, which belongs in the shed.",
            [
                "(put, [toy, chest, ball], in: toy -> chest, except: toy -> ball)",
                "(put, [ball, shed], in: ball -> shed)",
            ],
        ),
        (
            "Put what lies on the floor in the crate.",
            ["(put, [everything, floor, crate], on: everything -> floor, in: everything -> crate)"],
        ),
        (
            "Take the rope to the shed, which must be locked.",
            ["(take, [rope, shed], to: rope -> shed)", "(lock, [shed])"],
        ),
        (
            "The rope belongs in the shed, which must be shut.",
            ["(put, [rope, shed], in: rope -> shed)", "(close, [shed])"],
        ),
        ("Fill the jug, which you should rinse.", ["(fill, [jug])", "(rinse, [jug])"]),
        ("Get the rope, which should be in the shed.", ["(get, [rope, shed], in: rope -> shed)"]),
        ("Take the jug, which should be full, to the table.", ["(take, [jug, table], to: jug -> table)"]),
        ("The carpets want beating.", ["(beat, [carpet])"]),
        ("I only want the radio on for the guests.", ["(turn_on, [radio, guest], for: radio -> guest)"]),
        ("I want the rope put in the shed.", ["(put, [rope, shed], in: rope -> shed)"]),
        ("Fill the jug, I can hardly lift it.", ["(fill, [jug])"]),
        ("I can not reach the bell. Ring it.", ["(ring, [it])"]),
        (
            "Turn the radio on and the lamp in the hall off.",
            ["(turn_on, [radio])", "(turn_off, [lamp, hall], in: lamp -> hall)"],
        ),
        ("The radio should be on, with the rope in the shed.", ["(turn_on, [radio])"]),
        # "there" as a place, beside a particle, and behind "back"
        ("Open the chest and put the rope there.", ["(open, [chest])", "(put, [rope, there], at: rope -> there)"]),
        ("Switch the lamp on there.", ["(switch_on, [lamp])"]),
        ("Wash the jug, then put it back there.", ["(wash, [jug])", "(put_back, [it])"]),
        (
            "The rope should be in the shed and the lamp on by then.",
            ["(put, [rope, shed], in: rope -> shed)", "(turn_on, [lamp])"],
        ),
        # what is taken from a whole behind a statement, a place or a thing
        (
            "Each cup gets some milk, except the one that is full.",
            ["(be, [cup, milk, one], except: cup -> one, with: cup -> milk)"],
        ),
        # titles
        ("Tea for Ann: boil the water.", ["(boil, [water])"]),
        ("The radio: put it in the crate.", ["(put, [radio, crate], in: radio -> crate)"]),
    ],
)
def test_what_is_due(text: str, expected: list[str]) -> None:
    assert clauses(text) == expected


@pytest.mark.parametrize(
    "text",
    [
        "Water the fern. If the soil is wet, there is no need.",
        "Water the fern. Don't bother if the soil is wet.",
        "Water the fern. If the soil is wet you don't have to.",
        "Water the fern, unless the soil is wet.",
    ],
)
def test_what_need_not_be_done_under_a_condition_is_done_otherwise(text: str) -> None:
    (water,) = parse(text).clauses
    assert print_clause(water) == "(water, [fern])"
    assert [(c.clauses[0].direct, c.clauses[0].result, denies(c)) for c in water.conditions] == [
        (("soil",), "wet", True)
    ]


def test_a_condition_of_another_deed_that_is_spared_is_none_of_the_first() -> None:
    (water,) = parse("Water the fern. If the bowl is full, don't bother filling the tub.").clauses
    assert not water.conditions


def test_what_is_in_it_speaks_of_a_place() -> None:
    (put,) = parse("Put the disc in the player unless there is already something in it.").clauses
    assert put.conditions[0].clauses[0].antecedents["it"][0] == "player"


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("The fridge is wide open, and the cupboard as well! Close them.", ("fridge", "cupboard")),
        ("The cup is in the sink. The plate too. Put them on the shelf.", ("cup", "plate")),
    ],
)
def test_too_goes_on_with_a_statement(text: str, meant: tuple[str, ...]) -> None:
    (clause,) = parse(text).clauses
    assert clause.meant("them") == meant


def test_too_goes_on_with_a_request_behind_its_reason() -> None:
    assert clauses("Close the fridge, it is getting warm, and the cupboard too.") == [
        "(close, [fridge])",
        "(close, [cupboard])",
    ]
