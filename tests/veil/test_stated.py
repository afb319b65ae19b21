"""What a clause states, as facts; and what a plan keeps that only goes there."""

from __future__ import annotations

import pytest

from tmd.energy.factors import delta_stated
from tmd.language import parse
from tmd.pddl.plan_file import parse_instruction
from tmd.planning.eliminate import eliminate
from tmd.veil.corpus import Corpus
from tmd.veil.library import run
from tmd.veil.stated import stated

STATES = [
    ("kitchen3", "Take some coffee in a cup.", {"(contains cup1 coffee)", "(contains cup2 coffee)"}),
    ("kitchen1", "Put the pot on the table.", {"(at pot1 table1 on)"}),
    ("kitchen1", "Fill the pot with water.", {"(contains pot1 water)"}),
    ("kitchen1", "Take the pot.", set()),
    ("kitchen1", "Take the milk from the fridge.", set()),
]


@pytest.mark.parametrize(("environment", "text", "facts"), STATES, ids=[text for _, text, _ in STATES])
def test_relations_become_facts(environment: str, text: str, facts: set[str], kitchen: Corpus) -> None:
    world = kitchen.world(environment)
    found = stated(parse(text, kitchen.lexicon).clauses[0], world, world.task.init)
    said = {
        str(atom)
        for cubes in found
        for cube in cubes
        for n, atom in enumerate(world.task.atoms)
        if cube.positive >> n & 1
    }
    assert bool(said) == bool(facts)
    assert not facts or said & facts
    assert all("table1" in fact for fact in said) or "table" not in text


def test_what_holds_already_tells_which_thing_is_meant(kitchen: Corpus) -> None:
    world = kitchen.world("kitchen1")
    clause = parse("Put the pot on the table.", kitchen.lexicon).clauses[0]
    (cubes,) = stated(clause, world, world.task.init)
    assert delta_stated([cubes], world.task.init) == 1
    done = world.task.init | cubes[0].positive
    assert delta_stated([cubes], done) == 0
    assert stated(clause, world, done) == []
    assert delta_stated([], done) == 0


def test_a_plan_is_left_with_what_it_needs(kitchen: Corpus) -> None:
    world = kitchen.world("kitchen1")
    clause = parse("Put the pot on the table.", kitchen.lexicon).clauses[0]
    (goal,) = stated(clause, world, world.task.init)
    needed = ["find(pot1)", "moveto(pot1)", "grasp(pot1)", "moveto(table1)", "keep(pot1, table1, on)"]
    detour = ["moveto(sink1)", "turn(sink1_handle, high)", *needed[:2], "moveto(stove1)", "moveto(pot1)", *needed[2:]]
    plan = [parse_instruction(line) for line in detour]
    kept = eliminate(plan, world.task, world.task.init, goal)
    assert [str(instruction) for instruction in kept] == needed
    assert any(cube.holds(run(world, world.task.init, kept)) for cube in goal)
