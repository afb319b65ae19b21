"""What a plan keeps that only goes somewhere."""

from __future__ import annotations

from tmd.pddl.model import GroundAtom
from tmd.pddl.plan_file import parse_instruction
from tmd.pddl.task import Cube
from tmd.planning.gap_filler import eliminate
from tmd.world.corpus import Corpus
from tmd.world.world import run


def test_a_plan_is_left_with_what_it_needs(kitchen: Corpus) -> None:
    world = kitchen.world("kitchen1")
    goal = (Cube(1 << world.task.index[GroundAtom("at", ("pot1", "table1", "on"))], 0),)
    needed = ["find(pot1)", "moveto(pot1)", "grasp(pot1)", "moveto(table1)", "keep(pot1, table1, on)"]
    detour = ["moveto(sink1)", "turn(sink1_handle, high)", *needed[:2], "moveto(stove1)", "moveto(pot1)", *needed[2:]]
    plan = [parse_instruction(line) for line in detour]
    kept = eliminate(plan, world.task, world.task.init, goal)
    assert [str(instruction) for instruction in kept] == needed
    assert any(cube.holds(run(world, world.task.init, kept)) for cube in goal)
