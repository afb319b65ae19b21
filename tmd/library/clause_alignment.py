"""The alignment of the instructions of a segment with its clauses.

People align their instructions with the text only coarsely: a segment may hold several clauses. Its instructions are
divided among them in order, so that instructions go to the clause that speaks of their objects, and a cut falls where
the objects change. The best division is found by dynamic programming.
"""

from __future__ import annotations

from collections.abc import Sequence

from tmd.language.clause import Clause
from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits
from tmd.world.world import Mentions, Profiles

# What it costs to cut between two instructions that share an object.
_SAME_THING = 0.5
# What a mention of another part of the same whole counts, and one of the whole.
_SIBLING, _WHOLE = 0.8, 0.6
# What it costs to leave a clause without instructions.
_NOTHING_LEFT = 0.25


def split(
    clauses: Sequence[Clause],
    instructions: Sequence[Instruction],
    profiles: Profiles,
    mentions: Mentions,
    state: Bits,
) -> list[tuple[Instruction, ...]]:
    """Return the instructions of each clause: consecutive runs, some perhaps empty.

    ``clauses`` are those of the segment, at least one; ``state`` is the one in which the segment began.
    """
    if len(clauses) == 1:
        return [tuple(instructions)]
    speaks = [speaks_of(clause, mentions, state) for clause in clauses]
    fits = [[fit(instruction, said, profiles) for instruction in instructions] for said in speaks]
    cuts = [cut_cost(instructions, at, profiles) for at in range(len(instructions) + 1)]
    ends = _best_ends(fits, cuts)
    starts = [0, *ends[:-1]]
    return [tuple(instructions[a:b]) for a, b in zip(starts, ends, strict=True)]


def _best_ends(fits: Sequence[Sequence[float]], cuts: Sequence[float]) -> list[int]:
    """Return the end of each clause's run in the division of greatest fit; ties go to the later cut."""
    count = len(cuts)
    best: list[tuple[float, list[int]] | None] = [(0.0, [])] + [None] * (count - 1)
    for number, row in enumerate(fits):
        last = number == len(fits) - 1
        following: list[tuple[float, list[int]] | None] = [None] * count
        for begin in range(count):
            before = best[begin]
            if before is None:
                continue
            gained = before[0] - _NOTHING_LEFT
            for end in range(begin, count):
                if end > begin:
                    gained += row[end - 1] + (_NOTHING_LEFT if end == begin + 1 else 0.0)
                value = gained - (cuts[end] if 0 < end < count - 1 else 0.0)
                known = following[end]
                if (end == count - 1 or not last) and (known is None or value > known[0] - 1e-9):
                    following[end] = value, [*before[1], end]
        best = following
    found = best[count - 1]
    return found[1] if found is not None else [count - 1] * len(fits)


def speaks_of(clause: Clause, mentions: Mentions, state: Bits) -> dict[str, float]:
    """Return for each object how surely a clause mentions it, from 0 to 1."""
    found: dict[str, float] = {}
    for noun in clause.resolved():
        matches = mentions.of(noun, state)
        for match in matches:
            share = match.score / matches[0].score
            found[match.name] = max(found.get(match.name, 0.0), share)
    return found


def fit(instruction: Instruction, said: dict[str, float], profiles: Profiles) -> float:
    """Return how well an instruction fits a clause: the mean over its objects of how surely they are mentioned."""
    own = [_spoken_of(name, said, profiles) for name in _objects(instruction, profiles)]
    return sum(own) / len(own) if own else 0.0


def _spoken_of(name: str, said: dict[str, float], profiles: Profiles) -> float:
    """Return how surely an object is mentioned: itself, another part of its whole, or the whole."""
    found = said.get(name, 0.0)
    whole = profiles.wholes.get(name)
    if whole is None:
        return found
    siblings = max((said.get(part, 0.0) for _, part in profiles.parts[whole]), default=0.0)
    return max(found, _SIBLING * siblings, _WHOLE * said.get(whole, 0.0))


def cut_cost(instructions: Sequence[Instruction], at: int, profiles: Profiles) -> float:
    """Return the cost of a cut before instruction ``at``."""
    if not 0 < at < len(instructions):
        return 0.0
    here, there = (set(_objects(instruction, profiles)) for instruction in (instructions[at - 1], instructions[at]))
    return _SAME_THING if here & there else 0.0


def _objects(instruction: Instruction, profiles: Profiles) -> list[str]:
    return [argument for argument in instruction.args if argument not in profiles.constants]
