"""What a finished run left in its directory, read and checked."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from tmd.diagnostics import TmdError
from tmd.pddl.reading.syntax import read_text
from tmd.records.fit import Fit
from tmd.records.metrics import Metrics
from tmd.records.prediction import PredictionRecord


@dataclass(frozen=True, slots=True)
class Run:
    """A finished run.

    Attributes:
        metrics: ``metrics.json``.
        lines: ``predictions.jsonl``.
        fits: ``fits/``, by file name; empty where nothing was learned or kept.
    """

    metrics: Metrics
    lines: tuple[PredictionRecord, ...]
    fits: dict[str, Fit] = field(default_factory=dict)

    def of(self, model: str) -> list[PredictionRecord]:
        """The predictions of one row."""
        return [line for line in self.lines if line.model == model]


def read_run(directory: Path) -> Run:
    """Read a run's directory.

    Raises:
        TmdError: It holds no finished run, a file of it is damaged, or it is of a version that cannot be read.
    """
    path = directory / "metrics.json"
    metrics = Metrics.from_text(_text(path), str(path))
    path = directory / "predictions.jsonl"
    lines = tuple(PredictionRecord.from_lines(_text(path), str(path)))
    unknown = sorted({line.model for line in lines} ^ set(metrics.models))
    if unknown:
        told = f"{directory}: metrics.json and predictions.jsonl differ on the row '{unknown[0]}'"
        raise TmdError(told, hint=PredictionRecord.MEND)
    folder = directory / "fits"
    files = sorted(folder.glob("*.json")) if folder.is_dir() else []
    return Run(metrics, lines, {file.stem: Fit.from_text(read_text(file), str(file)) for file in files})


def _text(path: Path) -> str:
    if not path.exists():
        told = f"{path.parent}: holds no finished run: there is no {path.name}"
        raise TmdError(told, hint=PredictionRecord.MEND)
    return read_text(path)
