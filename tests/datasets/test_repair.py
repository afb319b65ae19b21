"""Putting lost actions back: on deliberate gaps, and the numbers of the release."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import pytest

from tmd.datasets.veil500 import Point, Repairer, VeilData, VeilGroup, compile_environment, from_veil, repaired, to_veil
from tmd.datasets.veil500 import repair as repairing
from tmd.datasets.veil500.repair import Executability, Repaired
from tmd.pddl.model import And, Atom, Effect, Equals, Not, Problem, TypedName


def point(small: VeilData, *groups: str, world: str = "kitchen") -> Point:
    """A demonstration with these groups of actions."""
    base = next(p for p in small.points if p.world == world)
    parsed = [tuple(from_veil(text) for text in group.split(", ") if text) for group in groups]
    return replace(base, groups=tuple(VeilGroup((n,), actions) for n, actions in enumerate(parsed)))


def repair(one: Point, data: VeilData) -> Repaired:
    return Repairer(replace(data, points=(one,))).repair(one)


@pytest.mark.parametrize(
    ("groups", "inserted", "step"),
    [
        (("moveto Mug_1", "grasp Kettle"), "moveto Kettle", 1),
        (("moveto Mug_1, moveto Sink", "keep Mug_1 On Sink"), "grasp Mug_1", 2),
        (("moveto Mug_1, grasp Mug_1, moveto Mug_1", "grasp Mug_1"), "release Mug_1", 3),
        (("moveto Mug_1, grasp Mug_1, moveto Microwave", "keep Mug_1 In Microwave"), "open Microwave", 3),
        (("moveto Fridge", "close FridgeLeftDoor"), "open FridgeLeftDoor", 1),
        (("", "turn SinkKnob, wait"), "moveto Sink", 0),
        (("moveto Tv_1", "press Tv_1PowerButton, press Tv_1Remote_1PowerButton"), None, None),
        (("grasp Mug_1", "moveto Mug_1"), None, None),  # not in the last group
        (("moveto Sink", "keep Mug_1 On Sink"), None, None),  # a grasp would not be executable
        (("moveto Sink", "keep Mug_1 On Stove"), None, None),  # two facts are missing
        (("moveto Sink", "moveto Unicorn_1"), None, None),  # nothing can help
        (("moveto Sink", "dance Mug_1"), None, None),
        (("moveto Sink", "turn SinkKnob"), None, None),  # nothing to do
        (("",), None, None),
    ],
)
def test_one_missing_fact(small: VeilData, groups: tuple[str, ...], inserted: str | None, step: int | None) -> None:
    before = point(small, *groups)
    done = repair(before, small)
    names = small.environment_of(before).names
    assert (done.inserted and to_veil(done.inserted, names), done.step) == (inserted, step)
    if inserted is None:
        assert done.point == before
    else:
        assert step is not None
        assert done.point.instructions[step] == from_veil(inserted)
        without = list(done.point.instructions)
        del without[step]
        assert tuple(without) == before.instructions
        assert [g.segments for g in done.point.groups] == [g.segments for g in before.groups]


def test_remote_in_hand(small: VeilData) -> None:
    before = point(small, "moveto Tv_1Remote_1", "press Tv_1Remote_1PowerButton", world="living_room")
    assert repair(before, small).inserted == from_veil("grasp Tv_1Remote_1")


def exclusive(problem: Problem) -> Problem:
    """Return the problem with ``moveto`` also ending being near every other thing that is not held."""
    other = TypedName("?other", ("thing",))
    away = And((Not(Equals("?x", "?other")), Not(Atom("holding", ("pr2", "?other")))))
    leave = Effect(Atom("near", ("pr2", "?other")), False, away, (other,))
    actions = tuple(
        replace(action, effects=(*action.effects, leave)) if action.name == "moveto" else action
        for action in problem.domain.actions
    )
    return replace(problem, domain=replace(problem.domain, actions=actions))


def repairer_of(data: VeilData, *, exclusive_near: bool) -> Repairer:
    """With ``exclusive_near``, coming near one thing ends being near the others, as the data set's authors meant."""
    with pytest.MonkeyPatch.context() as other:
        if exclusive_near:
            other.setattr(repairing, "compile_environment", lambda place: exclusive(compile_environment(place)))
        return Repairer(data)


def executability(data: VeilData, *, two_hands: bool = False, exclusive_near: bool = False) -> Executability:
    return repairer_of(data, exclusive_near=exclusive_near).executability(data.points, two_hands=two_hands)


def test_executability_of_a_small_set(small: VeilData) -> None:
    points = (
        point(small, "moveto Mug_1, grasp Mug_1, moveto Fork_1, grasp Fork_1, moveto Salt_1, grasp Salt_1"),
        point(small, "moveto Mug_1, moveto Sink, grasp Mug_1"),
    )
    data = replace(small, points=points)
    assert (executability(data).executable, executability(data).failing) == (2, 0)
    assert (executability(data, two_hands=True).executable, executability(data, two_hands=True).failing) == (1, 1)
    assert executability(data, exclusive_near=True).failing == 1
    assert executability(data).steps == 9


@pytest.mark.parametrize(
    ("exclusive_near", "as_released", "after_repair"),
    [
        (False, [(149, 268), (138, 309)], [(317, 65), (296, 110)]),
        (True, [(79, 959), (74, 1000)], [(133, 782), (126, 827)]),
    ],
)
def test_executability_of_the_release(
    released: VeilData,
    repaired_data: VeilData,
    repairer: Repairer,
    exclusive_near: bool,
    as_released: list[tuple[int, int]],
    after_repair: list[tuple[int, int]],
) -> None:
    """With any number of hands, and with two."""
    own = repairer_of(released, exclusive_near=True) if exclusive_near else repairer
    for data, expected in ((released, as_released), (repaired_data, after_repair)):
        found = [own.executability(data.points, two_hands=two_hands) for two_hands in (False, True)]
        assert [(each.executable, each.failing) for each in found] == expected


@pytest.fixture(scope="module")
def repairer(released: VeilData) -> Repairer:
    """Simulators of all environments: nothing takes longer here than to make them."""
    return Repairer(released)


@pytest.fixture(scope="module")
def repaired_data(released: VeilData) -> VeilData:
    return repaired(released)


def test_where_the_release_fails(released: VeilData, repairer: Repairer) -> None:
    first: list[tuple[Point, int]] = []
    verbs: Counter[str] = Counter()
    for demonstration in released.points:
        done = repairer.simulator(demonstration).run(demonstration.instructions)
        verbs.update(demonstration.instructions[step].name for step in done.failures)
        if done.first_failure is not None:
            first.append((demonstration, done.first_failure))
    last = [p for p, step in first if step >= len(p.instructions) - len(p.groups[-1].instructions)]
    assert (len(first), len(last)) == (211, 203)
    assert verbs == {
        "grasp": 155,
        "keep": 54,
        "turn": 15,
        "press": 12,
        "open": 10,
        "close": 9,
        "release": 7,
        "add": 2,
        "scoopto": 2,
        "insert": 1,
        "scoopfrom": 1,
    }


def test_size_of_what_sequences_change(released: VeilData, repairer: Repairer) -> None:
    sizes = []
    for demonstration in released.points:
        states = repairer.simulator(demonstration).run(demonstration.instructions).states
        sizes.append((states[0] ^ states[-1]).bit_count())
    assert (round(sum(sizes) / len(sizes), 1), sizes.count(0)) == (7.6, 6)


def test_placebo(repaired_data: VeilData, repairer: Repairer) -> None:
    """A move deleted from the last group of a sound sequence comes back, wherever its loss is noticed."""
    noticed = restored = 0
    for demonstration in repaired_data.points:
        last = demonstration.groups[-1]
        first = last.instructions[0] if last.instructions else None
        sound = repairer.simulator(demonstration).run(demonstration.instructions).executable
        if first is None or first.name != "moveto" or not sound:
            continue
        shorter = (*demonstration.groups[:-1], VeilGroup(last.segments, last.instructions[1:]))
        cut = replace(demonstration, groups=shorter)
        if repairer.simulator(cut).run(cut.instructions).executable:
            continue
        noticed += 1
        restored += repairer.repair(cut).inserted == first
    assert noticed > 50
    assert restored == noticed
