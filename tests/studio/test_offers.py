"""What is offered for an object is what PDDL says of it, and the reasons are those of the preconditions."""

from __future__ import annotations

from pathlib import Path

import pytest

from tmd.diagnostics import TmdError
from tmd.pddl.model import GroundAtom
from tmd.pddl.semantics import applicable
from tmd.studio.applicable_actions import Offers
from tmd.view.wording import Wording
from tmd.world.corpus import Corpus
from tmd.world.folder import DomainFolder
from tmd.world.world import World

ROOT = Path(__file__).parents[2]
DOMAINS = ["01_blocks", "04_tea", "kitchen", "lab_bench", "living_room"]


def first_world(name: str) -> World:
    corpus = Corpus(DomainFolder(ROOT / "domains" / name), ROOT / "problems" / name)
    return corpus.world(corpus.environments()[0])


@pytest.mark.parametrize("domain", DOMAINS)
def test_offers_are_the_ground_actions_and_apply_where_pddl_says_so(domain: str) -> None:
    world = first_world(domain)
    offers = Offers(world)
    state = world.task.init
    decoded = world.task.decode(state)
    seen = {offer.instruction for group in offers.anywhere(state) for offer in group.offers}
    for name in world.objects.types_of:
        groups = offers.of(name, state)
        assert [(g.applies, g.action) for g in groups] == sorted(
            ((g.applies, g.action) for g in groups), key=lambda key: (not key[0], key[1])
        )
        for group in groups:
            assert [o.applies for o in group.offers] == sorted((o.applies for o in group.offers), reverse=True)
            for offer in group.offers:
                assert group.action == offer.instruction.name
                assert name in offer.instruction.args
                assert offer.applies == applicable(offer.instruction, decoded, world.task.problem)
                assert "?" not in offer.why
                seen.add(offer.instruction)
    assert seen == set(world.task.by_instruction)


def test_a_reason_says_what_is_missing_or_in_the_way(kitchen1: World) -> None:
    offers = Offers(kitchen1)
    found = {
        str(offer.instruction): offer.why
        for group in offers.of("fridge1", kitchen1.task.init, parts=True)
        for offer in group.offers
    }
    assert found["find(fridge1)"] == ""
    assert found["open(fridge1_door)"] == "needs: fridge1_door is within reach"
    assert found["keep(mug1, fridge1, in)"] == "needs: mug1 is in a hand"
    assert {o.why for g in offers.of("milk1", kitchen1.task.init) for o in g.offers if g.action == "find"} == {
        "not while milk1 is behind a closed door"
    }


def test_reasons_look_into_quantifiers_and_disjunctions(kitchen1: World) -> None:
    tea = first_world("04_tea")
    found = {str(o.instruction): o.why for g in Offers(tea).of("cup1", tea.task.init) for o in g.offers}
    assert found["grasp(cup1)"] == "needs: counter1 is within reach"
    state = kitchen1.task.init
    for line in ("find", "moveto", "grasp"):
        state = next(o for o in kitchen1.task.operators if o.instruction == (line, ("mug1",))).apply(state)
    for name in ("find", "moveto"):
        state = next(o for o in kitchen1.task.operators if o.instruction == (name, ("fridge1",))).apply(state)
    found = {str(o.instruction): o.why for g in Offers(kitchen1).of("mug1", state) for o in g.offers}
    assert found["keep(mug1, fridge1, in)"] == "not while the inside of fridge1 is behind a closed door"


def test_facts_in_words_or_as_they_are_written(kitchen1: World) -> None:
    words = Wording(kitchen1.task.problem)
    for atom, told in [
        (GroundAtom("at", ("mug1", "counter2", "next_to")), "mug1 is next to counter2"),
        (GroundAtom("active", ("microwave1",)), "microwave1 is working"),
        (GroundAtom("both_hands_used", ("pr2",)), "both hands hold something"),
        (GroundAtom("same_unit", ("a", "b")), "a and b belong to one object"),
        (GroundAtom("nobody_declared", ("a",)), "(nobody_declared a)"),
    ]:
        assert words.fact(atom) == told


def test_an_unknown_object_is_named(kitchen1: World) -> None:
    with pytest.raises(TmdError, match=r"there is no object 'mug' \(did you mean"):
        Offers(kitchen1).of("mug", kitchen1.task.init)
