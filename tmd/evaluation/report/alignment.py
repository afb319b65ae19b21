"""Alignment of two sequences of instructions, step by step."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum


class Mark(StrEnum):
    """Kind of an aligned step. All but ``MATCH`` cost one in the edit distance of IED."""

    MATCH = "match"
    SUBSTITUTED = "substituted"
    MISSING = "missing"
    SUPERFLUOUS = "superfluous"


@dataclass(frozen=True, slots=True)
class AlignedStep:
    """One line of an alignment.

    Attributes:
        mark: What became of it.
        predicted: The place of the predicted instruction in its sequence; ``None`` where one is missing.
        gold: The place of the recorded instruction in its sequence; ``None`` where the predicted one is superfluous.
    """

    mark: Mark
    predicted: int | None
    gold: int | None


def words(instruction: str) -> tuple[str, ...]:
    """Return the lower-case words of an instruction, ``keep(mug1, sink1, on)`` or ``keep Mug_1 On Sink``.

    The first is the instruction's name.
    """
    return tuple(re.findall(r"[^\s(),]+", instruction.lower()))


def name(instruction: str) -> str:
    """Return the name of an instruction as it is written."""
    return next(iter(words(instruction)), "")


def align(predicted: Sequence[str], gold: Sequence[str]) -> tuple[AlignedStep, ...]:
    """Return a Levenshtein alignment: as few steps that do not match as possible.

    Of several such alignments one that puts most instructions of the same name beside each other is taken, as it
    reads best; of those, the one that matches earliest.
    """
    mine, theirs = [words(i) for i in predicted], [words(i) for i in gold]
    costs = _costs(mine, theirs)
    i = j = 0
    steps = []
    while i < len(mine) or j < len(theirs):
        here = costs[i][j]
        if i < len(mine) and j < len(theirs) and here == costs[i + 1][j + 1] + _beside(mine[i], theirs[j]):
            steps.append(AlignedStep(Mark.MATCH if mine[i] == theirs[j] else Mark.SUBSTITUTED, i, j))
            i, j = i + 1, j + 1
        elif j < len(theirs) and here == costs[i][j + 1] + _ALONE:
            steps.append(AlignedStep(Mark.MISSING, None, j))
            j += 1
        else:
            steps.append(AlignedStep(Mark.SUPERFLUOUS, i, None))
            i += 1
    return tuple(steps)


# One edit; more than any number of strangers, which are counted below it.
_EDIT = 1 << 20
# A step that is not aligned with one of its name.
_STRANGER = 1
_ALONE = _EDIT + _STRANGER


def _beside(a: tuple[str, ...], b: tuple[str, ...]) -> int:
    if a == b:
        return 0
    return _EDIT if a[:1] == b[:1] else _ALONE


def _costs(mine: Sequence[tuple[str, ...]], theirs: Sequence[tuple[str, ...]]) -> list[list[int]]:
    """Return ``costs[i][j]``: the least cost of aligning what follows i and j."""
    m = len(theirs)
    below = [_ALONE * (m - j) for j in range(m + 1)]
    costs = [below]
    for a in reversed(mine):
        row = [0] * m + [below[m] + _ALONE]
        for j in range(m - 1, -1, -1):
            row[j] = min(min(below[j], row[j + 1]) + _ALONE, below[j + 1] + _beside(a, theirs[j]))
        costs.append(row)
        below = row
    return costs[::-1]
