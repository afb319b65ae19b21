"""What sentences ask for in the kitchens and living rooms of VEIL-500: the meanings that the sane domain declares."""

from __future__ import annotations

import pytest

from tmd.datasets.veil500 import VeilData
from tmd.evaluation.runs.dataset import ALL, VeilDataset
from tmd.ground import ground
from tmd.grounded import Grounded
from tmd.library.library import Library


def said(small: VeilData, world: str, text: str) -> Grounded:
    """What comes of a text in the small data set, from declared meanings and planning alone."""
    data = VeilDataset(small.directory, ALL)
    environment = next(f"{w}{number}" for w, number in small.environments if w == world)
    return ground(text, data.world(environment), Library(data.lexicon))


def end(grounded: Grounded) -> set[str]:
    assert grounded.plans, grounded.reason
    assert grounded.verdicts[0].valid
    return {str(atom) for atom in grounded.world.task.decode(grounded.plans[0].state)}


@pytest.mark.parametrize(
    ("world", "text", "holds"),
    [
        ("kitchen", "Leave the plate in the sink.", {"(at plate_1 sink on)"}),
        ("kitchen", "Put all the mugs in the sink.", {"(at mug_1 sink on)"}),
        ("kitchen", "Fill the mug with water.", {"(is mug_1 water)"}),
        ("kitchen", "Open the microwave.", {"(is microwave doorisopen)"}),
        ("kitchen", "Add the ramen to the pot.", {"(at ramen_1 kettle in)"}),
        ("kitchen", "Add some salt to the pot.", {"(is kettle salt)"}),
        ("kitchen", "Heat the mug.", {"(hot mug_1)"}),
        ("living_room", "Put the book on the couch.", {"(at book_1 loveseat_1 on)"}),
        ("living_room", "Switch on the television.", {"(is tv_1 ison)"}),
        ("living_room", "Pick up the remote.", {"(holding pr2 tv_1remote_1)"}),
    ],
)
def test_what_is_said_holds_at_the_end(small: VeilData, world: str, text: str, holds: set[str]) -> None:
    assert holds <= end(said(small, world, text))


def test_a_pot_on_the_stove_stands_on_a_burner(small: VeilData) -> None:
    burners = {f"(at kettle stovefire_{number} on)" for number in (1, 2)}
    assert burners & end(said(small, "kitchen", "Put the pot on the stove."))


def test_of_the_burners_that_one_is_lit_that_the_pot_stands_on(small: VeilData) -> None:
    holds = end(said(small, "kitchen", "Put the pot on the stove and turn the stove on."))
    assert [n for n in (1, 2) if f"(at kettle stovefire_{n} on)" in holds] == [
        n for n in (1, 2) if f"(lit stovefire_{n})" in holds
    ]


def test_what_goes_into_the_sink_stays_there_when_the_next_thing_does(small: VeilData) -> None:
    grounded = said(small, "kitchen", "Put the plate in the sink. Put the fork and the mug in the sink.")
    assert {"(at plate_1 sink on)", "(at fork_1 sink on)", "(at mug_1 sink on)"} <= end(grounded)
