"""The predictions of a model as a report shows them: the best and the worst, and errors by instruction."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from tmd.evaluation.report.alignment import AlignedStep, Mark, align, name
from tmd.records.prediction import PredictionRecord

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
        mark: The kind of the step.
        symbol: Its sign.
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
