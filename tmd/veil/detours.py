"""Leaving out what changes nothing: people and inference make detours.

An instruction that leaves the environment as it is, and a run of instructions after which it is as it was before, are
left out. What is left ends in the same state, and is executable if the whole was. An instruction without arguments
(*wait*) is kept: what it is for shows in no state.
"""

from __future__ import annotations

from collections.abc import Sequence

from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits
from tmd.veil.world import World


def tidy(instructions: Sequence[Instruction], world: World, state: Bits) -> tuple[Instruction, ...]:
    """The instructions without detours, begun in ``state``; one that can never apply here is left where it is."""
    kept: list[Instruction] = []
    states = [state]
    for instruction in instructions:
        operator = world.task.by_instruction.get(instruction)
        after = operator.apply(states[-1]) if operator is not None else states[-1]
        if operator is None or not instruction.args:
            kept.append(instruction)
            states.append(after)
            continue
        if after in states:
            back = states.index(after)
            del kept[back:], states[back + 1 :]
        else:
            kept.append(instruction)
            states.append(after)
    return tuple(kept)
