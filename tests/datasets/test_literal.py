"""The literal domain against a second implementation of the same rules, written directly in Python sets."""

from __future__ import annotations

import re
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

from tmd.datasets.veil500 import (
    ForcedExecution,
    VeilData,
    VeilEnvironment,
    absent_types,
    compile_environment,
    from_veil,
    rollout,
    to_veil,
)
from tmd.datasets.veil500.compile import DISPATCH
from tmd.datasets.veil500.forms import RELATIONS, pddl_name
from tmd.datasets.veil500.relations import initial_relations
from tmd.pddl.model import GroundAtom, Instruction, State
from tmd.pddl.semantics import applicable, apply

POURED = ("Water", "Coffee", "Coke", "EnergyDrink", "IceCream", "Chocolate", "CanadaDry", "Vanilla", "Salt")
TV, REMOTE = "Tv_1", "Tv_1Remote_1"


class Direct:
    """The rules of the data set's simulator, action by action, over plain sets."""

    def __init__(self, environment: VeilEnvironment) -> None:
        self.objects = environment.by_name
        self.true = {(o.name, s) for o in environment.objects for s, v in o.states.items() if v}
        self.near: set[str] = set()
        self.held: set[str] = set()
        self.relations = {
            (RELATIONS[kind], thing, place) for thing, kind, place in initial_relations(environment, "literal")
        }

    def facts(self) -> tuple[frozenset[object], ...]:
        return frozenset(self.true), frozenset(self.near), frozenset(self.held), frozenset(self.relations)

    # --- conditions: nothing holds of an unknown object

    def is_(self, name: str, state: str) -> bool:
        return (name, state) in self.true

    def can(self, name: str, affordance: str) -> bool:
        return name in self.objects and affordance in self.objects[name].affordances

    # --- effects: nothing happens to an unknown object or an undeclared state

    def put(self, name: str, state: str, value: bool) -> None:
        if name in self.objects and state in self.objects[name].states:
            (self.true.add if value else self.true.discard)((name, state))

    def relate(self, relation: str, a: str, b: str) -> None:
        if a in self.objects and b in self.objects:
            self.relations.add((relation, a, b))

    def hold(self, name: str, value: bool) -> None:
        if name in self.objects:
            (self.held.add if value else self.held.discard)(name)

    def step(self, text: str) -> bool:
        """Execute by force; whether it was executable."""
        verb, *args = text.split()
        rule: Callable[..., bool] | None = getattr(self, f"do_{verb}_{len(args)}", None)
        if rule is None:
            return False
        if not all(arg in self.objects for arg in (args[::2] if verb == "keep" else args)):
            rule(*args)
            return False
        return rule(*args)

    def do_moveto_1(self, x: str) -> bool:
        if x in self.objects:
            self.near.add(x)
        spared = self.held | {x}
        self.relations = {(r, a, b) for r, a, b in self.relations if not (r == "Near" and a == x and b not in spared)}
        return True

    def do_grasp_1(self, x: str) -> bool:
        fine = self.can(x, "IsGraspable") and x in self.near and x not in self.held
        self.hold(x, True)
        self.near.discard(x)
        self.relations = {(r, a, b) for r, a, b in self.relations if x not in (a, b) or a == b}
        return fine

    def do_release_1(self, x: str) -> bool:
        fine = x in self.held
        self.hold(x, False)
        return fine

    def do_keep_3(self, x: str, relation: str, z: str) -> bool:
        if relation not in ("On", "In", "Inside", "Near"):
            return False
        if (relation, z) == ("In", "GarbageBag_1"):
            fine = x in self.held and z in self.held
        elif (relation, z) == ("In", "Microwave"):
            fine = x in self.held and z in self.near and self.is_("Microwave", "DoorIsOpen")
        else:
            fine = x in self.held and z in self.near
        self.hold(x, False)
        if relation != "Inside":
            self.relate(relation, x, z)
        if (relation, z) == ("On", "Sink") and self.is_("SinkKnob", "TapIsOn"):
            self.put(x, "Water", True)
        return fine

    def do_turn_1(self, k: str) -> bool:
        if k == "SinkKnob":
            on = self.is_(k, "TapIsOn")
            self.put(k, "TapIsOn", not on)
            if not on and k in self.objects:
                for relation, a, b in list(self.relations):
                    if relation == "On" and b == "Sink":
                        self.put(a, "Water", True)
            return "Sink" in self.near
        if re.fullmatch(r"StoveKnob_[1-4]", k):
            if k in self.objects:
                fire = f"StoveFire{k[-1]}"
                self.put("Stove", fire, not self.is_("Stove", fire))
            return "Stove" in self.near
        return False

    def do_press_1(self, b: str) -> bool:
        if b not in self.objects:
            return False
        if b == "MicrowaveButton":
            self.put("Microwave", "MicrowaveIsOn", not self.is_("Microwave", "MicrowaveIsOn"))
            return "Microwave" in self.near
        if b == "FridgeButton":
            on = self.is_("Fridge", "WaterDispenserIsOpen")
            self.put("Fridge", "WaterDispenserIsOpen", not on)
            for held in self.held if not on else ():
                self.put(held, "Water", True)
            return "Fridge" in self.near
        for carrier, reached in ((TV, TV in self.near), (REMOTE, REMOTE in self.held)):
            if b == f"{carrier}PowerButton":
                self.put(TV, "IsOn", not self.is_(TV, "IsOn"))
                return reached
            if b in (f"{carrier}ChannelUpButton", f"{carrier}ChannelDownButton"):
                self.change_channel(1 if "Up" in b else -1)
                return reached
            if b in (f"{carrier}VolumeUpButton", f"{carrier}VolumeDownButton"):
                if self.is_(TV, "IsOn"):
                    self.put(TV, "Volume", "Up" in b)
                return reached
        if b == f"{REMOTE}MuteButton":
            if self.is_(TV, "IsOn"):
                self.put(TV, "Volume", False)
            return TV in self.near
        return False

    def change_channel(self, by: int) -> None:
        here = [k for k in range(1, 7) if self.is_(TV, f"Channel{k}")]
        if self.is_(TV, "IsOn"):
            for k in here:
                self.put(TV, f"Channel{k}", False)
            for k in here:
                self.put(TV, f"Channel{(k - 1 + by) % 6 + 1}", True)

    def do_open_1(self, d: str) -> bool:
        if d == "Microwave":
            fine = d in self.near and not self.is_(d, "DoorIsOpen")
            self.put(d, "DoorIsOpen", True)
            self.put(d, "MicrowaveIsOn", False)
            return fine
        if d in ("FridgeLeftDoor", "FridgeRightDoor") and d in self.objects:
            state = d.removeprefix("Fridge") + "IsOpen"
            fine = "Fridge" in self.near and not self.is_("Fridge", state)
            self.put("Fridge", state, True)
            if d == "FridgeLeftDoor":
                self.put("Fridge", "WaterDispenserIsOpen", False)
            return fine
        if d == "BagOfChips_1":
            self.put(d, "IsOpen", True)
            return d in self.held
        return False

    def do_close_1(self, d: str) -> bool:
        if d == "Microwave":
            fine = d in self.near and self.is_(d, "DoorIsOpen")
            self.put(d, "DoorIsOpen", False)
            return fine
        if d in ("FridgeLeftDoor", "FridgeRightDoor") and d in self.objects:
            state = d.removeprefix("Fridge") + "IsOpen"
            fine = "Fridge" in self.near and self.is_("Fridge", state)
            self.put("Fridge", state, False)
            return fine
        return False

    def do_pour_1(self, x: str) -> bool:
        for content in (*POURED, "Ramen", "Egg"):
            self.put(x, content, False)
        return x in self.held

    def do_pour_2(self, x: str, y: str) -> bool:
        for content in POURED:
            if self.is_(x, content):
                self.put(y, content, True)
        return x in self.held and y in self.held

    def do_add_2(self, a: str, y: str) -> bool:
        if a == "IceCreamScoop":
            fine = "Spoon_1" in self.held and self.is_("Spoon_1", "ScoopsLeft")
            self.put(y, "IceCream", True)
            self.put("Spoon_1", "ScoopsLeft", False)
            return fine
        content = {"Salt_1": "Salt", "Ramen_1": "Ramen", "BoiledEgg_1": "Egg"}.get(a)
        if content is None:
            return False
        fine = a in self.held and y in self.held
        self.put(y, content, True)
        if a != "Salt_1":
            self.hold(a, False)
            self.relate("In", a, y)
        return fine

    def do_scoop_2(self, x: str, y: str) -> bool:
        fine = x in self.held and y in self.held and self.is_(y, "ScoopsLeft")
        self.put(x, "ScoopsLeft", True)
        return fine

    def do_squeeze_2(self, x: str, y: str) -> bool:
        if self.is_(x, "Chocolate"):
            self.put(y, "Chocolate", True)
        return x in self.held and y in self.held and self.can(x, "IsSqueezeable")

    def do_place_2(self, a: str, y: str) -> bool:
        if a not in ("Fork_1", "Spoon_1"):
            return False
        fine = y in self.held
        self.hold(y, False)
        self.put(y, a.removesuffix("_1"), True)
        self.relate("In", a, y)
        return fine

    def do_insert_2(self, x: str, y: str) -> bool:
        fine = self.is_(x, "CD") and x in self.held and y in self.held
        self.put(y, "CD", True)
        self.hold(x, False)
        self.relate("In", x, y)
        return fine

    def do_wait_0(self) -> bool:
        return True


class Translation:
    """PDDL states in the words of :class:`Direct`."""

    def __init__(self, environment: VeilEnvironment) -> None:
        self.names = environment.names
        self.states = {s.lower(): s for o in environment.objects for s in o.states}

    def facts(self, state: State) -> tuple[frozenset[object], ...]:
        def those(predicate: str) -> list[GroundAtom]:
            return [atom for atom in state if atom.predicate == predicate]

        return (
            frozenset((self.names[o], self.states[s]) for _, (o, s) in those("is")),
            frozenset(self.names[x] for _, (_, x) in those("near")),
            frozenset(self.names[x] for _, (_, x) in those("holding")),
            frozenset((RELATIONS[r], self.names[a], self.names[b]) for _, (a, b, r) in those("at")),
        )


def differences(environment: VeilEnvironment, simulator: ForcedExecution, sequence: list[Instruction]) -> int:
    """Steps at which the two implementations disagree about the state or about what is executable."""
    direct, words = Direct(environment), Translation(environment)
    spelled = {pddl_name(name): name for name in (*DISPATCH, *environment.by_name)}
    done = simulator.run(sequence)
    different = int(direct.facts() != words.facts(done.task.decode(done.states[0])))
    for number, instruction in enumerate(sequence):
        executable = direct.step(to_veil(instruction, spelled))
        state = done.task.decode(done.states[number + 1])
        same = direct.facts() == words.facts(state) and executable == (number not in done.failures)
        different += not same
    return different


def pool(environment: VeilEnvironment, rng: np.random.Generator, pairs: int = 250) -> list[Instruction]:
    """Actions of every form: all with one argument, some with more, on any objects and on unknown ones."""
    names = [o.name for o in environment.objects]
    some = [*names, "Unicorn_1", "Spoon_1", "Salt_1", "Cd_1", "BagOfChips_1"]
    texts = [f"{verb} {x}" for verb in ("moveto", "grasp", "release", "pour") for x in some]
    texts += [f"{verb} {x}" for verb in ("turn", "press", "open", "close") for x in some]
    graspable = [o.name for o in environment.objects if "IsGraspable" in o.affordances]
    for _ in range(pairs):
        x, y = rng.choice(graspable), rng.choice(some)
        relation = rng.choice(["On", "In", "Inside", "Near", "Under"])
        texts.append(f"keep {x} {relation} {y}")
        x, y = rng.choice(some), rng.choice(some)
        verb = rng.choice(["pour", "scoop", "squeeze", "insert", "place", "add", "keep"])
        texts.append(f"keep {x} {relation} {y}" if verb == "keep" else f"{verb} {x} {y}")
        verb, x = [
            ("add", "Salt_1"), ("add", "Ramen_1"), ("add", "BoiledEgg_1"), ("add", "IceCreamScoop"),
            ("scoop", "Spoon_1"), ("place", "Fork_1"), ("place", "Spoon_1"), ("insert", "Cd_1"),
            ("squeeze", "Syrup_2"),
        ][rng.integers(9)]  # fmt: skip
        texts.append(f"{verb} {x} {y}")
    for z in ("Sink", "Microwave", "GarbageBag_1"):
        texts += [f"keep {x} {r} {z}" for x in graspable for r in ("On", "In", "Inside")]
    texts += ["scoop Spoon_1 IceCream_1", "wait", "wait 3", "fly Mug_1", "moveto", "insert Cd_1 Xbox_1"]
    return sorted({from_veil(text) for text in texts})


def walk(
    simulator: ForcedExecution, actions: list[Instruction], rng: np.random.Generator, steps: int
) -> list[Instruction]:
    """A random sequence in which about three of four steps are executable.

    Now and then everything that an action names is fetched first.
    """
    verbs = sorted({action.name for action in actions})
    by_verb = {verb: [a for a in actions if a.name == verb] for verb in verbs}
    available = set(actions)
    state = simulator.task.init
    sequence: list[Instruction] = []
    while len(sequence) < steps:
        fetch = rng.random() < 0.1
        for _ in range(12):
            own = by_verb[verbs[rng.integers(len(verbs))]]
            action = own[rng.integers(len(own))]
            if fetch or simulator.step(state, action)[1] or rng.random() < 0.05:
                break
        before = [Instruction(verb, (x,)) for x in action.args for verb in ("moveto", "grasp")] if fetch else []
        for step in (*(i for i in before if i in available), action):
            sequence.append(step)
            state = simulator.step(state, step)[0]
    return sequence


def compare_at_random(environment: VeilEnvironment, seed: int, walks: int, steps: int) -> set[str]:
    """Random sequences: no difference. Returns the verbs that were executed."""
    rng = np.random.default_rng(seed)
    actions = pool(environment, rng)
    simulator = ForcedExecution(compile_environment(environment), actions, absent_types(environment))
    executed: set[str] = set()
    for _ in range(walks):
        sequence = walk(simulator, actions, rng, steps)
        assert differences(environment, simulator, sequence) == 0
        failed = set(simulator.run(sequence).failures)
        executed |= {i.name for number, i in enumerate(sequence) if number not in failed}
    return executed


KITCHEN_VERBS = {
    *("moveto", "grasp", "release", "keep", "turn", "press", "open", "close", "pour", "pour_out"),
    *("add", "scoopfrom", "scoopto", "squeeze", "place", "wait"),
}
ROOM_VERBS = {"moveto", "grasp", "release", "keep", "press", "open", "insert", "wait"}


@pytest.mark.parametrize(("key", "verbs"), [(("kitchen", 2), KITCHEN_VERBS), (("living_room", 1), ROOM_VERBS)])
def test_same_as_the_direct_interpreter(small: VeilData, key: tuple[str, int], verbs: set[str]) -> None:
    assert verbs <= compare_at_random(small.environments[key], seed=0, walks=8, steps=400)


@pytest.mark.parametrize(
    ("key", "texts"),
    [
        # under a running tap only On the sink fills, and only turning it on does
        (("kitchen", 2), "moveto Sink, turn SinkKnob, grasp Kettle, keep Kettle In Sink, keep Kettle On Sink"),
        (("kitchen", 2), "keep Kettle On Sink, turn SinkKnob, pour Kettle, turn SinkKnob, turn SinkKnob"),
        (("kitchen", 2), "keep Mug_1 Near Sink, keep Kettle Inside Sink, keep Plate_1 On Sink, turn SinkKnob"),
        # the dispenser fills what is held, and only when it starts
        (("kitchen", 2), "grasp Kettle, grasp Plate_1, press FridgeButton, pour Kettle, press FridgeButton"),
        (("kitchen", 2), "press FridgeButton, grasp Kettle, open FridgeLeftDoor, press FridgeButton"),
        # noodles and eggs are added, not poured on
        (("kitchen", 2), "add Ramen_1 Kettle, add Salt_1 Kettle, pour Kettle Plate_1, pour Kettle Mug_1, pour Kettle"),
        (("kitchen", 2), "add BoiledEgg_1 Plate_1, pour Plate_1 Kettle, add BoiledEgg_1 Kettle, pour Plate_1"),
        (("kitchen", 2), "squeeze Syrup_1 Mug_1, squeeze Syrup_2 Mug_1, squeeze Mug_1 Syrup_1, squeeze Syrup_1 Mug_1"),
        (("kitchen", 2), "open Microwave, press MicrowaveButton, open Microwave, close Microwave"),
        (("kitchen", 2), "turn StoveKnob_1, turn StoveKnob_2, turn StoveKnob_1, turn StoveKnob_4, turn StoveKnob_5"),
        (("kitchen", 2), "grasp Kettle, keep Mug_1 Near Kettle, moveto Mug_1, release Kettle, moveto Mug_1"),
        (("living_room", 1), "press Tv_1ChannelUpButton, press Tv_1PowerButton" + ", press Tv_1ChannelUpButton" * 7),
        (("living_room", 1), "press Tv_1PowerButton" + ", press Tv_1Remote_1ChannelDownButton" * 7),
        (("living_room", 1), "press Tv_1Remote_1MuteButton, press Tv_1PowerButton, press Tv_1Remote_1MuteButton"),
        (("living_room", 1), "press Tv_1VolumeDownButton, press Tv_1PowerButton, press Tv_1VolumeDownButton, "
         "press Tv_1VolumeUpButton"),
        (("living_room", 1), "insert Xbox_1 Cd_1, insert Cd_1 Xbox_1, insert Xbox_1 Cd_1, insert Cd_1 Book_1"),
    ],
)  # fmt: skip
def test_same_on_chosen_sequences(small: VeilData, key: tuple[str, int], texts: str) -> None:
    environment = small.environments[key]
    sequence = [from_veil(text) for text in texts.split(", ")]
    simulator = ForcedExecution(compile_environment(environment), sequence, absent_types(environment))
    assert differences(environment, simulator, sequence) == 0
    fetched = [Instruction(v, (x,)) for i in sequence for x in i.args for v in ("moveto", "grasp")]
    assert differences(environment, simulator, [*fetched, *sequence]) == 0


def test_same_on_everything_recorded(veil: VeilData) -> None:
    steps = different = 0
    for key, environment in veil.environments.items():
        sequences = [list(point.instructions) for point in veil.points if point.key == key]
        simulator = ForcedExecution(compile_environment(environment), {i for s in sequences for i in s})
        different += sum(differences(environment, simulator, sequence) for sequence in sequences)
        steps += sum(len(sequence) for sequence in sequences)
    assert different == 0
    assert steps >= 7014 or len(veil.points) < 360


def test_same_on_sequences_from_elsewhere(veil: VeilData) -> None:
    """Predictions copied from elsewhere, from the other world even, name things that are not there."""
    rng = np.random.default_rng(3)
    for environment in veil.environments.values():
        chosen = rng.choice(len(veil.points), size=min(25, len(veil.points)), replace=False)
        sequences = [list(veil.points[i].instructions) for i in sorted(chosen)]
        known = {i for s in sequences for i in s}
        simulator = ForcedExecution(compile_environment(environment), known, absent_types(environment))
        assert sum(differences(environment, simulator, sequence) for sequence in sequences) == 0


def test_same_on_random_sequences_in_every_environment(veil: VeilData) -> None:
    for number, environment in enumerate(veil.environments.values()):
        compare_at_random(environment, seed=100 + number, walks=3, steps=200)


def test_simulator_is_the_semantics(small: VeilData) -> None:
    """Forced execution over bits is `tmd.pddl.semantics`, wherever that takes the instruction."""
    environment = small.environments["kitchen", 2]
    problem = compile_environment(environment)
    rng = np.random.default_rng(5)
    actions = pool(environment, rng, pairs=40)
    known = {o.name for o in problem.all_objects()}
    arity = {a.name: len(a.parameters) for a in problem.domain.actions}
    legal = [a for a in actions if set(a.args) <= known and arity.get(a.name) == len(a.args)]
    legal = [a for a in legal if ForcedExecution(problem, [a])._operators[a] is not None][::3]
    simulator = ForcedExecution(problem, legal)
    sequence = walk(simulator, legal, rng, 120)
    done = simulator.run(sequence)
    for number, (before, after) in enumerate(pairwise(done.decoded())):
        instruction = sequence[number]
        assert apply(instruction, before, problem) == after
        assert applicable(instruction, before, problem) == (number not in done.failures)


def test_unknown_things(small: VeilData) -> None:
    environment = small.environments["kitchen", 2]
    problem = compile_environment(environment)
    texts = ["moveto Mug_1", "grasp Mug_1", "keep Mug_1 On Unicorn_1", "fly Mug_1", "press Mug_1", "wait 5"]
    done = rollout(problem, [from_veil(text) for text in texts])
    assert done.failures == (2, 3, 4, 5)
    assert done.failures[:1] == (2,)
    states = done.decoded()
    held = GroundAtom("holding", ("pr2", "mug_1"))
    assert held in states[2] and held not in states[3]
    assert states[3] == states[4] == states[5] == states[6]
    assert not any("nobody" in arg for state in states for atom in state for arg in atom.args)


def test_preparing_changes_nothing(small: VeilData) -> None:
    problem = compile_environment(small.environments["kitchen", 2])
    sequence = [from_veil(t) for t in ("moveto Sink", "turn SinkKnob", "moveto Mug_1", "grasp Mug_1")]
    prepared = ForcedExecution(problem, [*sequence, from_veil("keep Mug_1 On Sink")]).run(sequence)
    assert prepared.decoded() == rollout(problem, sequence).decoded()
