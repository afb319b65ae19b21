"""What is told of an object is what PDDL says of it, each fact once and in its place."""

from __future__ import annotations

import pytest

from tmd.diagnostics import TmdError
from tmd.goals.wording import Wording
from tmd.pddl.model import GroundAtom
from tmd.studio.demonstrations.session import Session
from tmd.view.panels import about
from tmd.world.corpus import Corpus
from tmd.world.world import World


def test_parts_states_relations_and_edges(kitchen1: World) -> None:
    words = Wording(kitchen1.task.problem)
    knob = about("stove1_knob1", kitchen1, kitchen1.task.init)
    assert [*map(words.fact, knob["What controls what"])] == ["working stove1_knob1 starts and stops stove1_burner1"]
    assert knob["States"] == [GroundAtom("set_to", ("stove1_knob1", "off"))]
    fridge = about("fridge1", kitchen1, kitchen1.task.init)
    assert GroundAtom("at", ("milk1", "fridge1", "in")) in fridge["Relations"]
    assert GroundAtom("guards", ("fridge1_door", "fridge1")) in fridge["What controls what"]
    with pytest.raises(TmdError, match="there is no object 'knob'"):
        about("knob", kitchen1, kitchen1.task.init)


def test_every_fact_of_an_object_is_told_once(kitchen1: World) -> None:
    for name in kitchen1.profiles.objects:
        found = about(name, kitchen1, kitchen1.task.init)
        told = [atom for atoms in found.values() for atom in atoms]
        assert len(set(told)) == len(told)
        assert {atom for atom in kitchen1.task.names(kitchen1.task.init) if name in atom.args} <= set(told)


def test_a_session_tells_of_the_state_that_is_looked_at(kitchen: Corpus, kitchen1: World) -> None:
    session = Session(kitchen1, "Open the fridge.", kitchen.lexicon)
    for operator in ("moveto", "open"):
        target = "fridge1" if operator == "moveto" else "fridge1_door"
        found = [o for o in kitchen1.task.operators if o.instruction == (operator, (target,))]
        if not found[0].applicable(session.state):
            session.do(next(o for o in kitchen1.task.operators if o.instruction == ("find", (target,))).instruction)
        session.do(found[0].instruction)
    opened = GroundAtom("opened", ("fridge1_door",))
    assert opened in about("fridge1_door", kitchen1, session.state)["States"]
    session.goto(0)
    assert opened not in about("fridge1_door", kitchen1, session.state)["States"]
