"""The files of a finished run, read and checked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from tmd.diagnostics import TmdError
from tmd.evaluation.runs.config import BUNDLED
from tmd.json_record import json_value
from tmd.pddl.model import Instruction, Problem
from tmd.pddl.plan_file import parse_instruction
from tmd.pddl.reading.syntax import nearest, read_text
from tmd.records.fit import Fit
from tmd.records.metrics import Metrics
from tmd.records.prediction import PredictionRecord
from tmd.world.roots import Roots


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
        told = f"{directory}: metrics.json and predictions.jsonl differ on the row '{unknown[0]}'"
        raise TmdError(told, hint=PredictionRecord.REPAIR)
    folder = directory / "fits"
    files = sorted(folder.glob("*.json")) if folder.is_dir() else []
    return Run(metrics, lines, {file.stem: Fit.from_text(read_text(file), str(file)) for file in files})


def _text(path: Path) -> str:
    if not path.exists():
        told = f"{path.parent}: holds no finished run: there is no {path.name}"
        raise TmdError(told, hint=PredictionRecord.REPAIR)
    return read_text(path)


def predicted_plan(
    roots: Roots, run: Path, example: str | None, model: str | None
) -> tuple[Problem, tuple[Instruction, ...]]:
    """Return the environment and the predicted plan of one example of a run on the bundled data.

    Args:
        roots: Where domains and problems are.
        run: The directory of the run.
        example: Which example; the only one by default.
        model: Which row predicted it; the only one by default.

    Raises:
        TmdError: This is not a run, its data are not the bundled ones, or there is no such prediction.
    """
    domain = _domain(run)
    file = run / "predictions.jsonl"
    row = _chosen(PredictionRecord.from_lines(read_text(file), str(file)), example, model)
    _, world = roots.world(row.environment, domain)
    return world.task.problem, tuple(parse_instruction(text, file=str(file)) for text in row.predicted)


def _domain(run: Path) -> str | None:
    """Return the domain of a run on the bundled data."""
    path = run / "config.json"
    if not path.is_file() or not (run / "predictions.jsonl").is_file():
        raise TmdError(
            f"{run} is no directory of a finished run",
            hint="it has config.json and predictions.jsonl of tmd experiment",
        )
    config = json_value(read_text(path), str(path), hint=PredictionRecord.REPAIR)
    if not isinstance(config, dict):
        raise TmdError(f"{path} is not a JSON object", hint=PredictionRecord.REMAKE)
    if config.get("data", BUNDLED) != BUNDLED:
        raise TmdError(
            f"{run} is a run on {config['data']}; only plans in bundled environments are exported",
            hint="give a run on --data bundled",
        )
    return config.get("domain")


def _chosen(rows: Sequence[PredictionRecord], example: str | None, model: str | None) -> PredictionRecord:
    """Return the one prediction that is meant."""
    left = _filtered(rows, "model", "--model", model)
    left = _filtered(left, "id", "--example", example)
    if not left:
        raise TmdError("the run has no predictions", hint=PredictionRecord.REMAKE)
    return left[0]


def _filtered(rows: Sequence[PredictionRecord], key: str, option: str, value: str | None) -> Sequence[PredictionRecord]:
    known = list(dict.fromkeys(str(getattr(row, key)) for row in rows))
    if value is None:
        if len(known) > 1:
            raise TmdError(f"the run has predictions of several: give {option}", hint=nearest("", known, what=key))
        return rows
    if value not in known:
        raise TmdError(f"the run has no prediction with {option} {value}", hint=nearest(value, known, what=f"{key}s"))
    return [row for row in rows if str(getattr(row, key)) == value]
