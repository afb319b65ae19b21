"""Each factor on cases worked out by hand."""

from __future__ import annotations

import pytest

from tmd.inference import energy
from tmd.language.clause import Clause
from tmd.library.template import Instantiation, Template
from tmd.pddl.model import Instruction
from tmd.world.world import differences, shared

FULL = {("filled",): True, ("hot",): False, ("contains", "water"): True}
EMPTY = {("filled",): False, ("hot",): False, ("contains", "water"): False}
OTHER = {("opened",): True, ("hot",): False}


def instantiation(
    before: dict[str, dict[tuple[str, ...], bool]], after: dict[str, dict[tuple[str, ...], bool]]
) -> Instantiation:
    grounding = {z: f"{z[1:]}_before" for z in before}
    template = Template("t", Clause("take", ("cup", "water")), "e", (), grounding, {}, {}, before, {}, {}, {}, ())
    return Instantiation(template, (), {z: f"{z[1:]}_after" for z in after}, after)


def test_differences_count_states_that_only_one_can_have() -> None:
    assert differences(FULL, EMPTY) == pytest.approx(2 / 3)
    assert differences(FULL, OTHER) == pytest.approx(3 / 4)
    assert differences(FULL, FULL) == 0.0
    assert differences({}, {}) == 0.0
    assert shared(FULL, EMPTY) == 1
    assert shared(FULL, OTHER) == 1


def test_every_factor_has_words_for_people() -> None:
    titles = [energy.title(name) for name in energy.NAMES]
    assert len(set(titles)) == len(titles)
    assert not any("_" in title for title in titles)


def test_environment_distance_is_the_mean_over_variables() -> None:
    case = instantiation({"?z1": FULL, "?z2": FULL}, {"?z1": EMPTY, "?z2": FULL})
    assert energy.environment_distance(case) == pytest.approx((2 / 3 + 0) / 2)
    assert energy.environment_distance(instantiation({}, {})) == 0.0


def test_clause_distance_is_one_minus_jaccard_of_the_resolved_objects() -> None:
    assert energy.clause_distance(Clause("a", ("cup", "water")), Clause("a", ("cup", "milk"))) == pytest.approx(2 / 3)
    assert energy.clause_distance(Clause("a", ("cup",)), Clause("a", ("it",), antecedents={"it": ("cup",)})) == 0.0
    assert energy.clause_distance(Clause("a"), Clause("a")) == 0.0
    assert energy.clause_distance(Clause("a"), Clause("a", ("cup",))) == 1.0


def test_clause_distance_gives_part_of_a_noun_for_one_with_a_modifier() -> None:
    syrup, raspberry = Clause("add", ("syrup",)), Clause("add", ("raspberry_syrup",))
    assert energy.clause_distance(syrup, raspberry, akin=0.0) == 1.0
    assert energy.clause_distance(syrup, raspberry, akin=0.75) == pytest.approx(1 - 0.75 / 1.25)
    assert energy.clause_distance(syrup, raspberry) == energy.clause_distance(raspberry, syrup)
    assert energy.clause_distance(Clause("add", ("syrup", "cup")), Clause("add", ("syrup", "syrup"))) == 0.5
    assert not energy.akin_nouns("cup", "hiccup")


def test_parameter_similarity_is_the_share_of_changed_objects() -> None:
    case = instantiation({"?z1": FULL, "?z2": FULL}, {"?z1": FULL, "?z2": FULL})
    assert energy.parameter_similarity(case) == 1.0
    same = Instantiation(case.template, (), {**case.grounding, "?z1": "z1_before"}, case.profiles)
    assert energy.parameter_similarity(same) == 0.5


def test_parameter_cardinality_compares_the_numbers_of_objects() -> None:
    assert energy.parameter_cardinality(Clause("a", ("cup",)), Clause("b", ("pot",))) == 0.0
    assert energy.parameter_cardinality(Clause("a", ("cup", "pot")), Clause("b", ("pot",))) == 1.0


def test_description_length_counts_arguments_plus_one() -> None:
    assert energy.description_length([Instruction("wait"), Instruction("keep", ("a", "b", "on"))]) == 5.0
    assert energy.description_length([]) == 0.0


def test_trimming_is_the_square_of_what_is_missing() -> None:
    assert energy.trimming(2, 5) == 9.0
    assert energy.trimming(5, 5) == 0.0


def test_objects_not_touched_is_the_share_of_the_clause_that_is_not_touched() -> None:
    assert energy.objects_not_touched(["bowl1", "stove1"], {"bowl1", "pot1"}) == 0.5
    assert energy.objects_not_touched(["bowl1"], {"bowl1"}) == 0.0
    assert energy.objects_not_touched([], {"bowl1"}) == 0.0
