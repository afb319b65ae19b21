"""The tables of the energy: probabilities, and what the factors built on them say."""

from __future__ import annotations

import math

import pytest

from tmd.inference.energy import NAMES, EndStates, Energy, Frequencies, Weights, count
from tmd.library.library import learn
from tmd.pddl.model import Instruction
from tmd.world.corpus import Corpus

ONES = Weights(dict.fromkeys(NAMES, 1.0))


def test_surprise_is_the_smoothed_negative_logarithm() -> None:
    table = Frequencies(("grasp", "grasp", "grasp", "keep"))
    assert table.surprise("grasp") == pytest.approx(-math.log(4 / 7))
    assert table.surprise("keep") == pytest.approx(-math.log(2 / 7))
    assert table.surprise("fly") == pytest.approx(-math.log(1 / 7))
    assert Frequencies().surprise("anything") == 0.0


def test_end_states_are_smoothed_and_say_nothing_of_what_was_never_seen() -> None:
    table = EndStates()
    for lit in (True, True, False):
        table.add("stove", {("active",): lit})
    assert table.probability("stove", ("active",), True) == pytest.approx(3 / 5)
    assert table.probability("fridge", ("active",), True) == 0.5
    assert table.mean([("stove", {("active",): True}), ("fridge", {("opened",): False})]) == pytest.approx(0.55)
    assert table.mean([]) is None


def test_a_clause_that_turns_something_on_is_consistent_with_its_being_on(kitchen: Corpus) -> None:
    library = learn(kitchen.demonstrations("ramen"), kitchen.world, kitchen.lexicon)
    world = kitchen.world("kitchen1")
    energy = Energy(ONES, count(library), world)
    turned = world.task.by_instruction[Instruction("turn", ("stove1_knob1", "high"))].apply(world.task.init)
    off = energy.of_end("turn_on", ["stove1_burner1"], world.task.init)["inconsistent_end"]
    on = energy.of_end("turn_on", ["stove1_burner1"], turned)["inconsistent_end"]
    assert 0 <= on < off <= 1


def test_usual_instructions_cost_less_than_unusual_ones(kitchen: Corpus) -> None:
    library = learn(kitchen.demonstrations("ramen"), kitchen.world, kitchen.lexicon)
    energy = Energy(ONES, count(library), kitchen.world("kitchen1"))
    usual = energy.of_sequence([Instruction("grasp", ("pot1",))], 1, [])
    unusual = energy.of_sequence([Instruction("squeeze", ("raspberry_bottle1", "cup1", "in"))], 1, [])
    odd_object = energy.of_sequence([Instruction("grasp", ("fork1",))], 1, [])
    assert usual["instruction_prior"] < unusual["instruction_prior"]
    assert usual["parameter_prior"] < odd_object["parameter_prior"]
    assert usual["instruction_prior"] == odd_object["instruction_prior"]


def test_no_latent_instruction_costs_nothing(kitchen: Corpus) -> None:
    library = learn(kitchen.demonstrations("ramen"), kitchen.world, kitchen.lexicon)
    world = kitchen.world("kitchen1")
    energy = Energy(ONES, count(library), world)
    assert energy.of_latent([], world.task.init) == {}
    found = energy.of_latent([Instruction("find", ("pot1",))], world.task.init)
    assert set(found) == {
        "latent_description_length",
        "latent_instruction_prior",
        "latent_parameter_prior",
        "latent_inconsistent_end",
    }
    assert found["latent_description_length"] == 2.0
