"""What is offered for an object are its ground actions, and reasons are those of the preconditions."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tmd.diagnostics import TmdError
from tmd.goals.wording import Wording
from tmd.pddl.model import GroundAtom
from tmd.pddl.plan_file import parse_instruction
from tmd.pddl.task import Bits
from tmd.studio.environment_view import Setting
from tmd.world.corpus import Corpus
from tmd.world.folder import DomainFolder
from tmd.world.world import World

ROOT = Path(__file__).parents[2]
DOMAINS = ["01_blocks", "04_tea", "kitchen", "lab_bench", "living_room"]


def first_world(name: str) -> World:
    corpus = Corpus(DomainFolder(ROOT / "domains" / name), ROOT / "problems" / name)
    return corpus.world(corpus.environments()[0])


@pytest.mark.parametrize("domain", DOMAINS)
def test_offers_are_the_ground_actions(domain: str) -> None:
    world = first_world(domain)
    setting = Setting(world, Path())
    seen = {operator.instruction for operator in setting.offers(None)}
    assert all(not instruction.args for instruction in seen)
    for name in world.objects.types_of:
        parts = {part for _, part in world.profiles.parts.get(name, ())}
        found = [operator.instruction for operator in setting.offers(name)]
        assert all(not i.args or {name, *parts} & set(i.args) for i in found)
        assert found == sorted(found, key=lambda i: name not in i.args)  # its own first
        seen.update(found)
    assert seen == set(world.task.by_instruction)


def reasons(world: World, state: Bits) -> Callable[[str], str]:
    wording, decoded = Wording(world.task.problem), world.task.decode(state)
    return lambda line: wording.broken(parse_instruction(line), decoded)


def test_a_reason_says_what_is_missing_or_in_the_way(kitchen1: World) -> None:
    why = reasons(kitchen1, kitchen1.task.init)
    assert why("find(fridge1)") == ""
    assert why("open(fridge1_door)") == "needs: fridge1_door is within reach"
    assert why("keep(mug1, fridge1, in)") == "needs: mug1 is in a hand"
    assert why("find(milk1)") == "not while milk1 is behind a closed door"


def test_reasons_look_into_quantifiers_and_disjunctions(kitchen1: World) -> None:
    tea = first_world("04_tea")
    assert reasons(tea, tea.task.init)("grasp(cup1)") == "needs: counter1 is within reach"
    state = kitchen1.task.init
    for name, thing in (
        *((n, "mug1") for n in ("find", "moveto", "grasp")),
        ("find", "fridge1"),
        ("moveto", "fridge1"),
    ):
        state = next(o for o in kitchen1.task.operators if o.instruction == (name, (thing,))).apply(state)
    assert (
        reasons(kitchen1, state)("keep(mug1, fridge1, in)") == "not while the inside of fridge1 is behind a closed door"
    )


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
        Setting(kitchen1, Path()).offers("mug")
