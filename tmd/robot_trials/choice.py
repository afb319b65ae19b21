"""Which predictions of a run a robot carries out: in each environment one, of the model that ships."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tmd.evaluation.runs.finished_run import Run
from tmd.evaluation.runs.summary import EMPTY
from tmd.inference.config import DEFAULT
from tmd.records.prediction import PredictionRecord


@dataclass(frozen=True, slots=True)
class TrialChoice:
    """A prediction to carry out.

    Attributes:
        environment: Where.
        model: The row.
        line: The prediction; ``None`` where no prediction of the row can be executed there under PDDL.
    """

    environment: str
    model: str
    line: PredictionRecord | None


def choices(run: Run) -> list[TrialChoice]:
    """One for each environment that was tested in, in the order of the run.

    The row is the model that ships, so that the films show what users get; where a run is without it, the row with the
    greatest END on average, in a tie the last. Of its predictions in an environment the first is taken that can be
    executed under PDDL, and that reaches its goal if one does.
    """
    rows = [name for name in run.metrics.models if name != EMPTY]
    if not rows:
        return []
    best = DEFAULT if DEFAULT in rows else max(reversed(rows), key=lambda name: run.metrics.models[name].average.END)
    lines = run.of(best)
    environments = sorted({line.environment for line in lines})
    return [
        TrialChoice(where, best, _first([line for line in lines if line.environment == where and _works(line)]))
        for where in environments
    ]


def _first(lines: Sequence[PredictionRecord]) -> PredictionRecord | None:
    """The first that reaches its goal, or the first."""
    return next((line for line in lines if line.success), next(iter(lines), None))


def _works(line: PredictionRecord) -> bool:
    return line.executable and bool(line.predicted)
