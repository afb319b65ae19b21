"""The sane domain: physics, and that it only forbids what the literal one allows."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pytest

from tmd.datasets.veil500 import Rollout, VeilData, VeilEnvironment, compile_environment, from_veil, rollout
from tmd.datasets.veil500.forms import Semantics
from tmd.datasets.veil500.relations import RelationRule
from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.model import GroundAtom, Instruction

THREE_THINGS = "moveto Mug_1, grasp Mug_1, moveto Fork_1, grasp Fork_1, moveto Salt_1, grasp Salt_1"
MUTED = "moveto Tv_1Remote_1, grasp Tv_1Remote_1, moveto Tv_1, press Tv_1Remote_1MuteButton"
BOILED = "moveto Stove, turn StoveKnob_1, moveto Mug_1, grasp Mug_1, moveto StoveFire_1, keep Mug_1 On StoveFire_1"


def run(small: VeilData, texts: str, world: str = "kitchen", semantics: Semantics = "sane") -> Rollout:
    environment = next(e for e in small.environments.values() if e.world == world)
    problem = compile_environment(environment, semantics)
    return rollout(problem, [from_veil(text) for text in texts.split(", ")])


def last(done: Rollout) -> set[str]:
    return {str(atom) for atom in done.decoded()[-1]}


@pytest.mark.parametrize(
    ("world", "texts", "failures"),
    [
        ("kitchen", "moveto Mug_1, moveto Sink, grasp Mug_1", (2,)),
        ("kitchen", THREE_THINGS, (5,)),
        ("kitchen", "moveto IceCream_1, grasp IceCream_1", (1,)),
        ("kitchen", "moveto Fridge, open FridgeLeftDoor, moveto IceCream_1, grasp IceCream_1", ()),
        ("kitchen", "moveto Mug_1, grasp Mug_1, moveto Fridge, keep Mug_1 Inside Fridge", (3,)),
        ("kitchen", "moveto Mug_1, grasp Mug_1, moveto SinkKnob, keep Mug_1 On SinkKnob", (3,)),
        ("kitchen", "moveto Microwave, open Microwave, press MicrowaveButton", (2,)),
        ("kitchen", "moveto Mug_1, grasp Mug_1, pour Mug_1 Mug_1", (2,)),
        ("kitchen", "moveto Microwave, open Microwave, open Microwave", (2,)),
        ("living_room", "moveto Tv_1, press Tv_1Remote_1MuteButton", (1,)),
        ("living_room", MUTED, ()),
        ("living_room", "moveto Xbox_1, grasp Xbox_1, moveto Cd_1, grasp Cd_1, insert Cd_1 Xbox_1", ()),
        ("living_room", "moveto BagOfChips_1, grasp BagOfChips_1, open BagOfChips_1", ()),
        ("living_room", "moveto BagOfChips_1, open BagOfChips_1", (1,)),
    ],
)  # fmt: skip
def test_what_can_be_done(small: VeilData, world: str, texts: str, failures: tuple[int, ...]) -> None:
    assert run(small, texts, world).failures == failures


@pytest.mark.parametrize(
    ("texts", "true", "false"),
    [
        (
            "moveto Kettle, grasp Kettle, moveto Sink, keep Kettle On Sink, turn SinkKnob",
            ["(at kettle sink on)", "(is kettle water)", "(near pr2 sink)"],
            ["(one_hand_used pr2)", "(near pr2 kettle)", "(at kettle stovefire_1 on)"],
        ),
        (
            BOILED,
            ["(hot mug_1)", "(boiling mug_1)", "(is stove stovefire1)"],
            ["(hot plate_1)"],
        ),
        (
            "moveto Stove, turn StoveKnob_1",
            ["(hot kettle)"],
            ["(boiling kettle)"],
        ),
        (
            "moveto Microwave, press MicrowaveButton",
            ["(hot plate_1)", "(shut_away plate_1)"],
            ["(hot mug_1)"],
        ),
        (
            "moveto Microwave, press MicrowaveButton, open Microwave",
            ["(is microwave doorisopen)"],
            ["(is microwave microwaveison)", "(shut_away plate_1)"],
        ),
        (
            "moveto Fridge, open FridgeLeftDoor, open FridgeRightDoor, close FridgeLeftDoor",
            [],
            ["(shut_away icecream_1)"],
        ),
        (
            "moveto Fridge, open FridgeLeftDoor, close FridgeLeftDoor",
            ["(shut_away icecream_1)"],
            [],
        ),
        (
            "moveto Mug_1, grasp Mug_1, moveto Kettle, grasp Kettle, pour Mug_1 Kettle",
            ["(is kettle water)", "(is kettle coffee)", "(both_hands_used pr2)"],
            ["(is mug_1 water)", "(is mug_1 coffee)"],
        ),
        (
            "moveto Mug_1, grasp Mug_1, moveto Counter_1, release Mug_1",
            ["(at mug_1 counter_1 on)"],
            ["(one_hand_used pr2)"],
        ),
        (
            "moveto Syrup_1, grasp Syrup_1, moveto Mug_1, grasp Mug_1, squeeze Syrup_1 Mug_1",
            ["(is mug_1 vanilla)"],
            ["(is mug_1 chocolate)"],
        ),
    ],
)  # fmt: skip
def test_what_it_does(small: VeilData, texts: str, true: list[str], false: list[str]) -> None:
    done = run(small, texts)
    assert done.executable
    facts = last(done)
    assert [fact for fact in true if fact not in facts] == []
    assert [fact for fact in false if fact in facts] == []


@pytest.mark.parametrize(("semantics", "stays"), [("sane", True), ("literal", False)])
def test_things_stay_on_what_is_carried(small: VeilData, semantics: Semantics, stays: bool) -> None:
    texts = (
        "moveto Fork_1, grasp Fork_1, moveto GarbageBag_1, keep Fork_1 Inside GarbageBag_1, grasp GarbageBag_1"
        if semantics == "sane"
        else "moveto Fork_1, grasp Fork_1, moveto GarbageBag_1, grasp GarbageBag_1, "
        "keep Fork_1 In GarbageBag_1, moveto GarbageBag_1, release GarbageBag_1, grasp GarbageBag_1"
    )
    done = run(small, texts, semantics=semantics)
    assert done.executable
    assert ("(at fork_1 garbagebag_1 in)" in last(done)) == stays


def _kind(instruction: Instruction) -> tuple[str, ...]:
    """What random walks draw from evenly: the verb, for ``keep`` the relation, and places with doors by themselves."""
    if instruction.name == "keep":
        door = instruction.args[1] if instruction.args[1] in ("microwave", "fridge") else ""
        return "keep", instruction.args[2], door
    return (instruction.name,)


def _walk(environment: VeilEnvironment, rng: np.random.Generator, walks: int, steps: int) -> list[list[Instruction]]:
    """Random sequences that are executable in the sane domain, of many different verbs.

    Now and then an instruction is drawn whether or not it can be executed, hands are emptied, a door is opened, and
    most of what it names is fetched, as far as that can be done.
    """
    task = ground(compile_environment(environment, "sane"))
    kinds = sorted({_kind(operator.instruction) for operator in task.operators})
    by_kind = {kind: [o.instruction for o in task.operators if _kind(o.instruction) == kind] for kind in kinds}
    openings = [("moveto", "fridge"), ("open", "fridgeleftdoor")]
    places = ("sink", "stove", "microwave", "fridge", "tv_1")
    found = []
    for _ in range(walks):
        state = task.init
        sequence: list[Instruction] = []
        while len(sequence) < steps:
            own = by_kind[kinds[rng.integers(len(kinds))]]
            wanted = own[rng.integers(len(own))]
            plan = [wanted]
            if rng.random() < 0.3:
                held = [a.args[1] for a in task.names(state) if a.predicate == "holding"]
                pairs = [("release", x) for x in held] + openings
                fetched = [x for x in wanted.args if rng.random() < 0.8]
                pairs += [(verb, x) for x in fetched for verb in ("moveto", "grasp")]
                if len(wanted.args) == 1:
                    pairs.append(("moveto", places[rng.integers(len(places))]))
                plan = [Instruction(verb, (x,)) for verb, x in pairs] + plan
            for instruction in plan:
                operator = task.by_instruction.get(instruction)
                if operator is not None and operator.applicable(state):
                    state = operator.apply(state)
                    sequence.append(instruction)
        found.append(sequence)
    return found


def _used(sequences: Iterable[list[Instruction]]) -> set[str]:
    return {instruction.name for sequence in sequences for instruction in sequence}


def test_executable_here_is_executable_there(small: VeilData) -> None:
    used: set[str] = set()
    for seed, environment in enumerate(small.environments.values()):
        sequences = _walk(environment, np.random.default_rng(seed), walks=8, steps=300)
        for sequence in sequences:
            assert rollout(compile_environment(environment), sequence).failures == ()
        used |= _used(sequences)
    verbs = {"moveto", "grasp", "release", "keep", "turn", "press", "open", "close", "pour", "pour_out"}
    assert used >= verbs | {"add", "scoopfrom", "scoopto", "squeeze", "insert", "wait"}


def test_executable_here_is_executable_there_in_every_environment(veil: VeilData) -> None:
    relations: tuple[RelationRule, ...] = ("honest", "literal")
    for number, environment in enumerate(veil.environments.values()):
        problems = [compile_environment(environment, "literal", each) for each in relations]
        for sequence in _walk(environment, np.random.default_rng(50 + number), walks=2, steps=100):
            assert all(rollout(problem, sequence).failures == () for problem in problems)


def test_hands_are_counted(small: VeilData) -> None:
    for seed, environment in enumerate(small.environments.values()):
        problem = compile_environment(environment, "sane")
        for sequence in _walk(environment, np.random.default_rng(seed), walks=2, steps=120):
            for state in rollout(problem, sequence).decoded():
                held = sum(atom.predicate == "holding" for atom in state)
                one = GroundAtom("one_hand_used", ("pr2",)) in state
                both = GroundAtom("both_hands_used", ("pr2",)) in state
                assert (held, one, both) in {(0, False, False), (1, True, False), (2, False, True)}
                assert sum(atom.predicate == "near" for atom in state) <= 1
