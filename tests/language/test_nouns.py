"""Nouns to things: the order of evidence, numbers, parts, ties."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmd.language import Lexicon
from tmd.language.lexicon.nouns import ALIAS, NAME, WORDNET, NounMatch, rank, similarity

THINGS = (
    NounMatch("microwave1", "microwave", ("device", "object")),
    NounMatch("microwave1_door", "door", ("part",), ("microwave",)),
    NounMatch("fridge1", "fridge", ("appliance",)),
    NounMatch("fridge1_door", "door", (), ("fridge",)),
    NounMatch("stove1", "stove"),
    *(NounMatch(f"stove1_burner{n}", "burner", (), ("stove",)) for n in (10, 2, 1, 3)),
    NounMatch("mug2", "mug", ("container",)),
    NounMatch("mug1", "mug", ("container",)),
    NounMatch("kettle1", "kettle", ("container",)),
    NounMatch("water", "water"),
    NounMatch("sink1_tap", "tap", (), ("sink", "water")),
    NounMatch("LongCup_1", "LongCup"),
    NounMatch("couch1", "Loveseat"),
)
LEXICON = Lexicon(nouns={"pot": ("kettle", "mug"), "mug": ("kettle",)})


@pytest.mark.parametrize(
    ("noun", "first", "how"),
    [
        ("microwave", "microwave1", NAME),
        ("fridge_door", "fridge1_door", NAME),
        ("burner_3", "stove1_burner3", NAME),
        ("second_burner", "stove1_burner2", NAME),
        ("burner_two", "stove1_burner2", NAME),
        ("burner", "stove1_burner1", NAME),
        ("mugs", "mug1", NAME),
        ("water", "water", NAME),
        ("water_tap", "sink1_tap", NAME),
        ("long_cup", "LongCup_1", NAME),
        ("Long-Cup", "LongCup_1", NAME),
        ("loveseat", "couch1", NAME),
        ("container", "kettle1", NAME),
        ("pot", "kettle1", ALIAS),
        ("second_pot", "mug1", ALIAS),
        ("refrigerator", "fridge1", ALIAS),
        ("icebox", "fridge1", WORDNET),
        ("sofa", "couch1", ALIAS),
        ("faucet", "sink1_tap", ALIAS),
        ("spigot", "sink1_tap", WORDNET),
    ],
)
def test_first_choice(noun: str, first: str, how: str) -> None:
    best = rank(noun, THINGS, LEXICON)[0]
    assert (best.name, best.how) == (first, how)


@pytest.mark.parametrize("noun", ["banana", "movie", "", "zzz", "3"])
def test_not_here(noun: str) -> None:
    assert rank(noun, THINGS, LEXICON) == []


def test_the_order_of_evidence() -> None:
    assert {m.how for m in rank("pot", THINGS, LEXICON)} == {ALIAS}
    assert [m.name for m in rank("mug", THINGS, LEXICON)] == ["mug1", "mug2"]


def test_a_lone_door_is_every_door_and_a_fridge_door_one() -> None:
    assert [m.name for m in rank("door", THINGS)] == ["fridge1_door", "microwave1_door"]
    assert [m.name for m in rank("fridge_door", THINGS)] == ["fridge1_door"]


def test_a_number_that_is_not_there_lowers_the_score() -> None:
    assert rank("mug_7", THINGS)[0].score == rank("mug", THINGS)[0].score / 2


def test_similarity_is_that_of_wu_and_palmer() -> None:
    assert similarity("sofa", "couch") == 1.0
    assert 0.7 < similarity("mug", "cup") < 1.0
    assert similarity("mug", "sofa") < 0.7
    assert similarity("mug", "zzz") == 0.0
    assert similarity("cup", "mug") == similarity("mug", "cup")


@given(st.permutations(THINGS), st.sampled_from(["burner", "door", "mug", "container", "sofa", "pot", "cup"]))
def test_the_order_of_candidates_does_not_matter(things: list[NounMatch], noun: str) -> None:
    assert rank(noun, things, LEXICON) == rank(noun, THINGS, LEXICON)


@given(st.text(max_size=30))
def test_any_noun_is_survived(noun: str) -> None:
    assert all(0 < match.score <= 1 for match in rank(noun, THINGS, LEXICON))
