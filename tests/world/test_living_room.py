"""What the living room has and the kitchen has not: things with parts that are carried, steps, players, bags."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest

from tmd.pddl.model import GroundAtom, Problem, State
from tmd.pddl.plan_file import parse_instruction
from tmd.pddl.semantics import apply, first_broken
from tmd.world.compile import compile_problem
from tmd.world.environment import load_environment
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).parents[2]
TO_THE_REMOTE = "find(remote1) moveto(remote1) grasp(remote1)"
TO_THE_TV = "moveto(tv1)"


@cache
def room(name: str) -> Problem:
    environment = load_environment(ROOT / "problems/living_room/environments" / f"{name}.yaml")
    return compile_problem(environment, DomainFolder(ROOT / "domains/living_room"))


def atom(text: str) -> GroundAtom:
    predicate, *args = text.split()
    return GroundAtom(predicate, tuple(args))


def after(name: str, steps: str) -> State:
    """The state of a room after some instructions, each of which can be executed."""
    state = room(name).init
    for step in steps.replace(") ", ")|").split("|"):
        broken = first_broken(parse_instruction(step), state, room(name))
        assert broken is None, f"{step}: {broken}"
        state = apply(parse_instruction(step), state, room(name))
    return state


def refused(name: str, steps: str, last: str) -> str:
    """The precondition that keeps ``last`` from being executed after ``steps``."""
    broken = first_broken(parse_instruction(last), after(name, steps), room(name))
    assert broken is not None, f"{last} can be executed"
    return broken.text


def test_a_remote_control_is_joined_to_the_television_of_its_room_only_where_there_is_one() -> None:
    assert atom("controls remote1_power_button tv1") in room("room1").init
    assert atom("shifts remote1_volume_down_button tv1_speaker down") in room("room4").init
    for name in ("room2", "room5"):
        assert not any(a.args[0].startswith("remote") for a in room(name).init if a.args)


def test_buttons_of_a_remote_control_are_neither_on_the_map_nor_seen_through_a_drawer() -> None:
    init = room("room3").init
    assert atom("found pr2 tv1_power_button") in init
    assert atom("found pr2 remote1_power_button") not in init
    assert {atom("hidden remote1"), atom("hidden remote1_power_button")} <= init
    assert not any(
        a.predicate == "hidden" for a in after("room3", "moveto(drawer1) open(drawer1)") if "remote1" in a.args
    )


def test_a_remote_control_works_in_the_hand_only_and_from_wherever_it_is_carried() -> None:
    assert "carried" in refused("room1", "find(remote1) moveto(remote1)", "press(remote1_power_button)")
    carried = after("room1", f"{TO_THE_REMOTE} moveto(armchair1)")
    assert {atom("near pr2 remote1"), atom("near pr2 remote1_power_button")} <= carried
    assert atom("active tv1") in after("room1", f"{TO_THE_REMOTE} moveto(armchair1) press(remote1_power_button)")
    let_go = after("room1", f"{TO_THE_REMOTE} moveto(armchair1) release(remote1) moveto(tv1)")
    assert atom("at remote1 armchair1 on") in let_go
    assert atom("near pr2 remote1_power_button") not in let_go


@pytest.mark.parametrize(
    ("presses", "channel"),
    [(0, "channel1"), (1, "channel2"), (3, "channel4"), (4, "channel1"), (-1, "channel4"), (-3, "channel2")],
)
def test_channels_go_round(presses: int, channel: str) -> None:
    button = "tv1_channel_up_button" if presses > 0 else "tv1_channel_down_button"
    end = after("room1", " ".join([TO_THE_TV, "press(tv1_power_button)", *[f"press({button})"] * abs(presses)]))
    assert [a for a in end if a.predicate == "set_to" and a.args[0] == "tv1_screen"] == [
        atom(f"set_to tv1_screen {channel}")
    ]


def test_the_volume_has_two_ends_and_nothing_shifts_while_the_television_is_off() -> None:
    louder = ["press(tv1_volume_up_button)"] * 3
    assert atom("set_to tv1_speaker loud") in after("room2", " ".join([TO_THE_TV, "press(tv1_power_button)", *louder]))
    assert "active" in refused("room2", TO_THE_TV, "press(tv1_volume_up_button)")


def test_a_player_takes_one_disc_and_plays_it_while_it_is_on() -> None:
    take = "moveto(drawer1) open(drawer1) find(dvd1) moveto(dvd1) grasp(dvd1)"
    assert "loaded" in refused("room3", f"{take} moveto(console1)", "insert(dvd1, console1)")
    swapped = f"{take} find(game_disc1) moveto(game_disc1) grasp(game_disc1) moveto(console1) insert(dvd1, console1)"
    playing = f"{swapped} press(console1_play_button)"
    assert atom("active console1_drive") in after("room3", playing)
    assert atom("active console1_drive") not in after("room3", f"{playing} press(console1_power_button)")
    taken_out = after("room3", f"{playing} release(game_disc1) grasp(dvd1)")
    assert not {atom("active console1_drive"), atom("loaded console1"), atom("at dvd1 console1 in")} & taken_out
    assert "active" in refused("room4", "moveto(dvd_player1)", "press(dvd_player1_play_button)")
    assert "loaded" in refused("room5", "moveto(console1)", "press(console1_play_button)")


def test_a_bag_takes_things_while_it_is_open_and_carries_them() -> None:
    bag = "moveto(drawer1) open(drawer1) find(garbage_sack1) moveto(garbage_sack1) grasp(garbage_sack1)"
    box = "find(pizza_box2) moveto(pizza_box2) grasp(pizza_box2)"
    assert "shut" in refused("room3", f"{bag} {box}", "keep(pizza_box2, garbage_sack1, in)")
    filled = f"{bag} open(garbage_sack1) {box} keep(pizza_box2, garbage_sack1, in)"
    tied = after("room3", f"{filled} close(garbage_sack1) moveto(fridge1) keep(garbage_sack1, fridge1, next_to)")
    assert {atom("at pizza_box2 garbage_sack1 in"), atom("hidden pizza_box2")} <= tied
    assert "garbage_sack1" in refused("room3", f"{bag} open(garbage_sack1)", "keep(garbage_sack1, garbage_sack1, in)")


def test_corn_pops_in_a_closed_microwave_only() -> None:
    sachet = "find(popcorn_sachet1) moveto(popcorn_sachet1) grasp(popcorn_sachet1) moveto(microwave1)"
    inside = f"{sachet} open(microwave1_door) keep(popcorn_sachet1, microwave1, in)"
    popped = atom("contains popcorn_sachet1 popped_corn")
    assert popped in after("room3", f"{inside} close(microwave1_door) press(microwave1_button) wait()")
    assert popped not in after("room3", f"{inside} press(microwave1_button) wait()")


def test_rubbish_is_poured_into_an_open_bin_and_gone() -> None:
    bowl = "find(bowl2) moveto(bowl2) grasp(bowl2) moveto(bin1)"
    end = after("room5", f"{bowl} pour(bowl2, bin1)")
    assert not {atom("filled bowl2"), atom("contains bowl2 chips"), atom("filled bin1")} & end
    assert "shut" in refused("room5", f"moveto(bin1) close(bin1_lid) {bowl}", "pour(bowl2, bin1)")
