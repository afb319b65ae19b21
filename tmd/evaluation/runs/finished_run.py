"""The files of a finished run, read and checked, with the records of robot trials in its ``robot/``.

``robot/ENVIRONMENT.json`` is one trial, with its film and its filmstrip beside it; ``robot/skipped.json`` says why
there are none.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import quote

from tmd.diagnostics import TmdError
from tmd.evaluation.runs.provenance import read_provenance
from tmd.pddl.reading.syntax import read_text
from tmd.records.fit import Fit
from tmd.records.metrics import Metrics
from tmd.records.prediction import PredictionRecord
from tmd.records.provenance import Provenance
from tmd.records.trial import Skip, Trial

FOLDER = "robot"
SKIPPED = "skipped.json"
_MEDIA = frozenset({".mp4", ".gif", ".png", ".jpg"})


@dataclass(frozen=True, slots=True)
class Run:
    """A finished run.

    Attributes:
        lines: ``predictions.jsonl``.
        fits: ``fits/``, by file name; empty where nothing was learned or kept.
        provenance: ``provenance.json``; ``None`` where there is none.
    """

    metrics: Metrics
    lines: tuple[PredictionRecord, ...]
    fits: dict[str, Fit] = field(default_factory=dict)
    provenance: Provenance | None = None

    def of(self, model: str) -> list[PredictionRecord]:
        """Return the predictions of one row."""
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
        message = f"{directory}: metrics.json and predictions.jsonl differ on the row '{unknown[0]}'"
        raise TmdError(message, hint=PredictionRecord.REPAIR)
    folder = directory / "fits"
    files = sorted(folder.glob("*.json")) if folder.is_dir() else []
    fits = {file.stem: Fit.from_text(read_text(file), str(file)) for file in files}
    return Run(metrics, lines, fits, read_provenance(directory))


def _text(path: Path) -> str:
    if not path.exists():
        message = f"{path.parent}: holds no finished run: there is no {path.name}"
        raise TmdError(message, hint=PredictionRecord.REPAIR)
    return read_text(path)


@dataclass(frozen=True, slots=True)
class Trials:
    """All trials of a run, or why there are none."""

    directory: Path
    found: tuple[Trial, ...] = ()
    skipped: str = ""


def read_trials(run: Path) -> Trials | None:
    """Return the trials in a run's directory; ``None`` where nobody asked for any.

    Raises:
        TmdError: A record is damaged.
    """
    folder = run / FOLDER
    if not folder.is_dir():
        return None
    files = sorted(path for path in folder.glob("*.json") if path.name != SKIPPED)
    found = tuple(read_trial(path) for path in files)
    skip = folder / SKIPPED
    if not found and not skip.is_file():
        return None
    return Trials(folder, found, "" if found else Skip.from_text(read_text(skip), str(skip)).reason)


def read_trial(path: Path) -> Trial:
    """Return one record.

    Raises:
        TmdError: It is damaged, or cannot be read.
    """
    return Trial.from_text(read_text(path), str(path))


def films(trials: Trials | None) -> dict[str, str]:
    """Return films, posters and filmstrips by file name, as addresses relative to the run's directory."""
    found = trials.found if trials else ()
    names = [name for trial in found for name in (trial.film, trial.strip, trial.poster)]
    return {
        name: f"{trials.directory.name}/{quote(Path(name).name)}"
        for name in filter(None, names)
        if trials and Path(name).suffix in _MEDIA and (trials.directory / Path(name).name).is_file()
    }
