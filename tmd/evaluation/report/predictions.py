"""The predictions of a model as a report shows them: aligned, the best and the worst, and errors by instruction."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum

from tmd.records.prediction import PredictionRecord


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


# Stands for the instruction that is not there, on either side.
NOTHING = "(nothing)"


def _names(step: AlignedStep, predicted: Sequence[str], recorded: Sequence[str]) -> tuple[str, str]:
    """Return the names of the recorded and of the predicted instruction of a step of an alignment."""
    gold = NOTHING if step.gold is None else name(recorded[step.gold])
    return gold, NOTHING if step.predicted is None else name(predicted[step.predicted])


def by_instruction(lines: Iterable[PredictionRecord]) -> Counter[tuple[str, str]]:
    """Count the pairs of recorded and predicted instructions that are aligned, by name.

    The whole sequences are aligned, as IED does. A substitution by the same instruction with other arguments has
    the same name twice, as a match has; :data:`NOTHING` stands where one is missing or superfluous.
    """
    found: Counter[tuple[str, str]] = Counter()
    for line in lines:
        for step in align(line.predicted, line.gold):
            found[_names(step, line.predicted, line.gold)] += 1
    return found


# How many of the best, and how many of the worst.
SHOWN = 10
# Each mark has a sign, so that nothing hangs on colour.
SYMBOLS = {Mark.MATCH: "✓", Mark.SUBSTITUTED: "≠", Mark.MISSING: "−", Mark.SUPERFLUOUS: "+"}


@dataclass(frozen=True, slots=True)
class ExampleStep:
    """Line of an alignment as it is shown.

    Attributes:
        predicted: The predicted instruction, empty if one is missing.
        gold: The recorded instruction, empty if the predicted one is superfluous.
        clause: The number of the clause it was predicted for, from 1; ``None`` where it is not known.
        latent: Whether it was left unsaid.
    """

    mark: Mark
    symbol: str
    predicted: str
    gold: str
    clause: int | None
    latent: bool


@dataclass(frozen=True, slots=True)
class ShownPrediction:
    """Prediction as it is shown, aligned with the recorded instructions; ``longest`` is its largest weighed factor."""

    line: PredictionRecord
    steps: tuple[ExampleStep, ...]
    longest: float


def best_and_worst(
    lines: Sequence[PredictionRecord], count: int = SHOWN
) -> tuple[list[ShownPrediction], list[ShownPrediction]]:
    """Return the best by success, IED, END and EED, best first; and of the others the worst, worst first.

    What has no goal stands between what reached its goal and what did not.
    """
    order = sorted(lines, key=_rank)
    best, rest = order[:count], order[count:]
    return [shown(line) for line in best], [shown(line) for line in reversed(rest[-count:])]


def _rank(line: PredictionRecord) -> tuple[int, float, float, float, str, str]:
    success = {True: 0, None: 1, False: 2}[line.success]
    return success, -line.IED, -line.END, -line.EED, line.environment, str(line.id)


def shown(line: PredictionRecord) -> ShownPrediction:
    """Return a prediction as it is shown."""
    origins = [
        (number, latent)
        for number, clause in enumerate(line.clauses, 1)
        for steps, latent in ((clause.latent, True), (clause.said, False))
        for _ in steps
    ]
    whole = line.whole
    steps = []
    for step in align(line.predicted, line.gold):
        origin = origins[step.predicted] if whole and step.predicted is not None else (None, False)
        predicted = "" if step.predicted is None else line.predicted[step.predicted]
        gold = "" if step.gold is None else line.gold[step.gold]
        steps.append(ExampleStep(step.mark, SYMBOLS[step.mark], predicted, gold, *origin))
    longest = max((abs(value) for clause in line.clauses for value in clause.factors.values()), default=0.0)
    return ShownPrediction(line, tuple(steps), longest)
