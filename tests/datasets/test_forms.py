from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmd.datasets.veil500 import VeilData, from_veil, mentioned, to_veil
from tmd.datasets.veil500.forms import pddl_name, reserved
from tmd.diagnostics import DataError
from tmd.pddl.model import Instruction

NAMES = {"mug_1": "Mug_1", "sink": "Sink", "icecreamscoop": "IceCreamScoop", "spoon_1": "Spoon_1"}


@pytest.mark.parametrize(
    ("veil_text", "instruction"),
    [
        ("moveto Mug_1", Instruction("moveto", ("mug_1",))),
        ("keep Mug_1 On Sink", Instruction("keep", ("mug_1", "sink", "on"))),
        ("keep Mug_1 In Sink", Instruction("keep", ("mug_1", "sink", "in"))),
        ("keep Mug_1 Inside Sink", Instruction("keep", ("mug_1", "sink", "inside"))),
        ("keep Mug_1 Near Sink", Instruction("keep", ("mug_1", "sink", "next_to"))),
        ("scoop Spoon_1 IceCream_1", Instruction("scoopfrom", ("spoon_1", "icecream_1"))),
        ("add IceCreamScoop Mug_1", Instruction("scoopto", ("spoon_1", "mug_1"))),
        ("add Salt_1 Mug_1", Instruction("add", ("salt_1", "mug_1"))),
        ("pour Mug_1", Instruction("pour_out", ("mug_1",))),
        ("pour Kettle Mug_1", Instruction("pour", ("kettle", "mug_1"))),
        ("press Tv_1Remote_1MuteButton", Instruction("press", ("tv_1remote_1mutebutton",))),
        ("wait", Instruction("wait")),
        ("wait 5", Instruction("wait", ("5",))),
        ("fly Mug_1", Instruction("fly", ("mug_1",))),
    ],
)
def test_forms(veil_text: str, instruction: Instruction) -> None:
    assert from_veil(veil_text) == instruction
    names = {pddl_name(token): token for token in veil_text.split()[1:]} | NAMES
    assert to_veil(instruction, names) == veil_text


@pytest.mark.parametrize("text", ["", "  ", "moveto Mug-1", "moveto (Mug_1)", "keep Mug_1, Sink"])
def test_not_an_action(text: str) -> None:
    with pytest.raises(DataError):
        from_veil(text)


def test_only_the_spoon_scoops() -> None:
    with pytest.raises(DataError, match="no action for"):
        to_veil(Instruction("scoopto", ("fork_1", "mug_1")), NAMES)


def test_mentioned_is_what_the_action_names() -> None:
    assert mentioned(from_veil("keep Mug_1 On Sink")) == ("mug_1", "sink")
    assert mentioned(from_veil("add IceCreamScoop Mug_1")) == ("icecreamscoop", "mug_1")
    assert mentioned(from_veil("wait")) == ()


@given(st.from_regex(r"[A-Z][A-Za-z0-9_]{0,12}", fullmatch=True))
def test_pddl_names_are_legal_and_free(name: str) -> None:
    found = pddl_name(name)
    assert re.fullmatch(r"[a-z][a-z0-9_]*", found)
    assert found not in reserved()


def test_every_recorded_action_survives_both_ways(veil: VeilData) -> None:
    text = (veil.directory / "data.xml").read_text()
    actions = re.findall(r"<action>(.*?)</action>", text)
    instructions = [i for point in veil.points for i in point.instructions]
    environments = [veil.environment_of(point).names for point in veil.points for _ in point.instructions]
    assert [to_veil(i, n) for i, n in zip(instructions, environments, strict=True)] == actions
