"""A run's directory: what was asked for, what is done, what came out.

``config.json`` what was asked for, ``fits/`` what was learned on each training set, ``parts/`` one file for each model
and fold as soon as it is done, ``predictions.jsonl`` and ``metrics.json`` what came out, ``report.html`` the page,
``provenance.json`` when and where, ``log.txt`` what happened. Files appear whole or not at all, so several processes
may work in one directory at once.
"""

from __future__ import annotations

import json
import logging
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from tmd.diagnostics import OutputError, TmdError
from tmd.evaluation.runs.folds import Fold
from tmd.evaluation.runs.jobs import EvaluationJob, JobOutcome, journal_files
from tmd.evaluation.runs.provenance import revision
from tmd.files import make_directory, write_text
from tmd.pddl.reading.syntax import read_text
from tmd.records.fit import Fit, WorldFit
from tmd.records.metrics import Metrics
from tmd.records.prediction import PredictionRecord

PREDICTIONS = "predictions.jsonl"
METRICS_FILE = "metrics.json"
LOG = "tmd.experiment"
"""The logger above those of all runs; its warnings are shown to the user as well."""


class _Log(logging.FileHandler):
    """A log file whose write errors are ignored: all that matters is written elsewhere."""

    def handleError(self, record: logging.LogRecord) -> None:  # noqa: N802
        """Ignore the error."""


class RunDirectory:
    """A run's directory."""

    def __init__(self, path: Path, identity: dict[str, Any]) -> None:
        self.path = path
        self.identity = identity
        self.log = logging.getLogger(f"{LOG}.{path}")

    @property
    def fits(self) -> Path:
        """The directory of learned weights."""
        return self.path / "fits"

    @contextmanager
    def entered(self) -> Iterator[None]:
        """Make the directory, or go on in it, and keep a log meanwhile.

        Raises:
            OutputError: It cannot be written, or holds another run.
        """
        make_directory(self.path / "parts")
        # First the parts, then the configuration: another process writes it before its first part.
        started = any((self.path / "parts").iterdir())
        self._claim(started)
        handler = self._handler()
        self.log.setLevel(logging.INFO)
        logging.getLogger(LOG).propagate = False
        self.log.addHandler(handler)
        try:
            self.log.info("revision: %s", revision())
            yield
        except BaseException as error:
            self.log.info("stopped: %s", error if isinstance(error, Exception) else type(error).__name__)
            raise
        finally:
            self.log.removeHandler(handler)
            with suppress(OSError):
                handler.close()

    def _claim(self, started: bool) -> None:
        path = self.path / "config.json"
        try:
            found = path.read_text(encoding="utf-8") if path.exists() else None
        except (OSError, UnicodeDecodeError):
            found = ""
        hint = "give another --out, or remove that directory"
        if found is None and started:
            raise OutputError(f"{self.path} holds parts of a run, but {path.name} is missing", hint=hint)
        text = json.dumps(self.identity, indent=2, ensure_ascii=False) + "\n"
        if found is None:
            write_text(path, text)
        elif found != text:
            raise OutputError(f"{self.path} holds another run{_difference(found, self.identity)}", hint=hint)

    def _handler(self) -> logging.Handler:
        path = self.path / "log.txt"
        try:
            handler = _Log(path, encoding="utf-8")
        except OSError as error:
            raise OutputError(
                f"{path} cannot be written: {error.strerror}", hint="name a directory you may write to"
            ) from None
        handler.setFormatter(logging.Formatter("%(asctime)s %(message)s"))
        return handler

    def left_of(self, unit: EvaluationJob, folds: dict[str, Fold]) -> EvaluationJob | None:
        """Return the unit with its unfinished folds and its learned weights; ``None`` if all folds are done."""
        waiting = tuple(name for name in unit.folds if self.part(unit.model, folds[name]) is None)
        if not waiting:
            self._tidy(unit)
            return None
        return EvaluationJob(unit.model, unit.training_set, waiting, self._saved(unit))

    def part(self, model: str, fold: Fold) -> list[PredictionRecord] | None:
        """Return the predictions of one model on one fold; ``None`` if there are none, or they are damaged."""
        path = self._part_path(model, fold.name)
        if not path.exists():
            return None
        try:
            lines = PredictionRecord.from_lines(read_text(path), str(path))
        except TmdError as error:
            self.log.warning("damaged, so to be done again: %s: %s", path.name, error.message)
            return None
        about = [(line.id, line.task, line.environment, line.model, line.fold) for line in lines]
        wanted = [(each.id, each.task, each.environment, model, fold.name) for each in fold.test]
        if not lines or about != wanted:
            self.log.warning("damaged, so to be done again: %s: its lines are of other examples", path.name)
            return None
        return lines

    def _part_path(self, model: str, fold: str) -> Path:
        return self.path / "parts" / f"{model}-{fold}.jsonl"

    def _saved(self, unit: EvaluationJob) -> Mapping[str, WorldFit] | None:
        path = self.fits / f"{unit.name}.json"
        if not path.exists():
            return None
        reason = "it is of another model"
        try:
            saved = Fit.from_text(read_text(path), str(path))
            if saved.model == unit.model:
                return saved.worlds
        except TmdError as error:
            reason = error.message
        self.log.warning("damaged, so to be learned again: %s: %s", path.name, reason)
        return None

    def keep(self, outcome: JobOutcome) -> None:
        """Write what came out of a unit.

        Raises:
            OutputError: It cannot be written.
        """
        if outcome.fit is not None:
            write_text(make_directory(self.fits) / f"{outcome.unit.name}.json", outcome.fit)
        for fold, text in outcome.parts.items():
            write_text(self._part_path(outcome.unit.model, fold), text)
            self.log.info("done: %s fold %s", outcome.unit.model, fold)
        self._tidy(outcome.unit)

    def _tidy(self, unit: EvaluationJob) -> None:
        for path in journal_files(self.fits, unit):
            with suppress(OSError):
                path.unlink(missing_ok=True)

    def finish(self, predictions: Iterable[PredictionRecord], metrics: Metrics) -> None:
        """Write what came out of the run.

        Raises:
            OutputError: It cannot be written.
        """
        write_text(self.path / PREDICTIONS, "".join(prediction.to_line() for prediction in predictions))
        write_text(self.path / METRICS_FILE, json.dumps(metrics.to_value(), indent=2) + "\n")
        self.log.info("finished")


def _difference(found: str, identity: dict[str, Any]) -> str:
    """Return the first setting in which an existing run differs, as part of a message."""
    try:
        other = json.loads(found)
    except ValueError:
        return ", or config.json is damaged"
    if isinstance(other, dict):
        for name, value in identity.items():
            if other.get(name) != value:
                return f": its {name} is {json.dumps(other.get(name))}, not {json.dumps(value)}"
    return ""
