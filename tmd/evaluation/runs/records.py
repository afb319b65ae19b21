"""What a run left in its directory, read and checked."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator

from tmd.diagnostics import TmdError
from tmd.evaluation.runs.summary import COLUMNS, SUCCESS, TESTED


class _Record(BaseModel):
    """Part of a file. What a later version adds is passed over."""

    model_config = ConfigDict(frozen=True, extra="ignore")


class ClauseRecord(_Record):
    """What was done for one clause; see :class:`~tmd.evaluation.models.prediction.Served`."""

    text: str
    verb: str
    latent: list[str] = []
    said: list[str] = []
    source: str | None = None
    factors: dict[str, float] = {}


class SegmentRecord(_Record):
    """A piece of the text, and what the person did for it."""

    text: str
    instructions: list[str]


class Line(_Record):
    """A line of ``predictions.jsonl``."""

    id: str | int
    task: str
    environment: str
    model: str
    fold: str
    text: str
    predicted: list[str]
    gold: list[str]
    executable: bool
    success: bool | None = None
    IED: float
    END: float
    EED: float
    EED_trim: float
    clauses: list[ClauseRecord] = []
    segments: list[SegmentRecord] = []


class CurvePoint(_Record):
    """One pass over the examples: ``loss`` from 0 to 1, ``objective`` as it is made small."""

    round: int
    epoch: int
    loss: float | None = None
    objective: float | None = None


class WorldFit(_Record):
    """What was learned for one kind of world. A curve may also be plain numbers: the loss of one round each."""

    weights: dict[str, float]
    curve: list[CurvePoint] = []

    @field_validator("curve", mode="before")
    @classmethod
    def _plain_numbers(cls, curve: object) -> object:
        if not isinstance(curve, list):
            return curve
        return [{"round": n, "epoch": 0, "loss": p} if isinstance(p, float | int) else p for n, p in enumerate(curve)]


class Fit(_Record):
    """A file of ``fits/``: what one model learned from one training set."""

    name: str
    model: str
    trained_in: list[str] = []
    worlds: dict[str, WorldFit]


class Means(_Record):
    """Means over examples with their standard errors (``_se``); ``success`` and ``executable`` in percent.

    ``success`` is the mean over the ``goals`` examples that have a goal; ``None`` where none has, and in runs that were
    made before goals were looked at.
    """

    n: int
    goals: int = 0
    success: float | None = None
    success_se: float | None = None
    IED: float
    IED_se: float
    EED: float
    EED_se: float
    EED_trim: float
    EED_trim_se: float
    END: float
    END_se: float
    executable: float
    executable_se: float

    def mean(self, column: str) -> float | None:
        """The mean of a column of :data:`~tmd.evaluation.runs.summary.COLUMNS`; ``None`` for success without goals."""
        value: float | None = getattr(self, column)
        return value

    def se(self, column: str) -> float | None:
        """Its standard error."""
        value: float | None = getattr(self, f"{column}_se")
        return value


class Row(Means):
    """A model: over all examples, by task, and the average over tasks."""

    tasks: dict[str, Means]
    average: Means


class Difference(_Record):
    """How two rows differ in one metric."""

    difference: float
    low: float
    high: float
    p: float
    p_holm: float

    def reversed(self) -> Difference:
        """The same, the other way round."""
        turned = {"difference": -self.difference, "low": -self.high, "high": -self.low}
        return self.model_copy(update=turned)


class Pair(_Record):
    """Two rows compared; in success only where examples have goals."""

    a: str
    b: str
    success: Difference | None = None
    IED: Difference
    EED: Difference
    EED_trim: Difference
    END: Difference

    def of(self, metric: str) -> Difference | None:
        """The difference in a metric; ``None`` where the rows are not compared in it."""
        found: Difference | None = getattr(self, metric)
        return found

    def seen_from(self, row: str) -> Pair:
        """With ``row`` first, if it is one of the two."""
        if row != self.b:
            return self
        turned = {metric: found.reversed() for metric in TESTED if (found := self.of(metric)) is not None}
        return self.model_copy(update={"a": self.b, "b": self.a, **turned})


class Significance(_Record):
    """All paired tests; see :func:`~tmd.evaluation.significance.compare`."""

    examples: int
    texts: int
    resamples: int
    level: float
    pairs: list[Pair]


class FoldSizes(_Record):
    """How many examples a fold trains and tests on."""

    train: int
    test: int


class Metrics(_Record):
    """``metrics.json``."""

    models: dict[str, Row] = Field(min_length=1)
    floor: Row | None
    significance: Significance
    config: dict[str, Any]
    folds: dict[str, FoldSizes]

    @property
    def columns(self) -> tuple[str, ...]:
        """The columns of the tables: success only where some example has a goal."""
        told = any(row.success is not None for row in self.models.values())
        return COLUMNS if told else tuple(column for column in COLUMNS if column != SUCCESS)

    @property
    def tested(self) -> tuple[str, ...]:
        """What rows are compared in."""
        return tuple(metric for metric in TESTED if all(p.of(metric) is not None for p in self.significance.pairs))


@dataclass(frozen=True, slots=True)
class Run:
    """A finished run.

    Attributes:
        metrics: ``metrics.json``.
        lines: ``predictions.jsonl``.
        fits: ``fits/``, by file name; empty where nothing was learned or kept.
    """

    metrics: Metrics
    lines: tuple[Line, ...]
    fits: tuple[Fit, ...]

    def of(self, model: str) -> list[Line]:
        """The predictions of one row."""
        return [line for line in self.lines if line.model == model]


def read_run(directory: Path) -> Run:
    """Read a run's directory.

    Raises:
        TmdError: It holds no finished run, or a file of it is damaged.
    """
    metrics = _parse(Metrics, directory / "metrics.json", _text(directory / "metrics.json"))
    path = directory / "predictions.jsonl"
    # not splitlines(): texts may hold other ends of lines than \n
    lines = tuple(_parse(Line, path, text, n) for n, text in enumerate(_text(path).split("\n"), 1) if text.strip())
    unknown = sorted({line.model for line in lines} ^ set(metrics.models))
    if unknown:
        raise TmdError(f"{directory}: metrics.json and predictions.jsonl differ on the row '{unknown[0]}'", hint=_AGAIN)
    folder = directory / "fits"
    files = sorted(folder.glob("*.json")) if folder.is_dir() else []
    return Run(metrics, lines, tuple(_fit(file) for file in files))


_AGAIN = "run the same `tmd experiment` again; finished work is not redone"
_T = TypeVar("_T", bound=BaseModel)


def _fit(path: Path) -> Fit:
    text = _text(path)
    try:
        data = json.loads(text)
    except ValueError:
        data = None
    return _parse(Fit, path, json.dumps({**data, "name": path.stem}) if isinstance(data, dict) else text)


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise TmdError(f"{path.parent}: holds no finished run: there is no {path.name}", hint=_AGAIN) from None
    except OSError as error:
        raise TmdError(f"{path} cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise TmdError(f"{path}: damaged: not UTF-8", hint=_remedy(path)) from None


def _parse(kind: type[_T], path: Path, text: str, line: int | None = None) -> _T:
    try:
        return kind.model_validate_json(text)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        field = ".".join(map(str, first["loc"]))
        place = f"{path}:{line}" if line else str(path)
        raise TmdError(f"{place}: damaged: {f'{field}: ' if field else ''}{first['msg']}", hint=_remedy(path)) from None


def _remedy(path: Path) -> str:
    """What to do about a damaged file. What was learned is written only when something is left to learn."""
    return "remove that file; the page will lack its curve" if path.parent.name == "fits" else _AGAIN
