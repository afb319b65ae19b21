"""``metrics.json`` of ``tmd experiment``: means over examples and paired tests between rows."""

from __future__ import annotations

from typing import Any

from pydantic import Field

from tmd.json_record import JsonRecord
from tmd.records.prediction import PredictionRecord

# The share of predictions at whose end the goal of the text holds, in percent, of the examples that have a goal.
SUCCESS = "success"
# What every example is scored by.
METRICS = ("IED", "EED", "EED_trim", "END")
# What rows are compared in.
TESTED = (SUCCESS, *METRICS)
# The share of predictions whose every instruction could be executed, in percent.
EXECUTABLE = "executable"
COLUMNS = (*TESTED, EXECUTABLE)


class Means(JsonRecord):
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
        """Return the mean of a column of :data:`COLUMNS`; ``None`` for success without goals."""
        value: float | None = getattr(self, column)
        return value

    def se(self, column: str) -> float | None:
        """Return the standard error of the mean."""
        value: float | None = getattr(self, f"{column}_se")
        return value


class Row(Means):
    """A model: over all examples, by task, and the average over tasks."""

    tasks: dict[str, Means]
    average: Means


class Difference(JsonRecord):
    """Difference of two rows in one metric."""

    difference: float
    low: float
    high: float
    p: float
    p_holm: float

    def reversed(self) -> Difference:
        """Return the same, the other way round."""
        turned = {"difference": -self.difference, "low": -self.high, "high": -self.low}
        return self.model_copy(update=turned)


class Pair(JsonRecord):
    """Two rows compared; in success only where examples have goals."""

    a: str
    b: str
    success: Difference | None = None
    IED: Difference
    EED: Difference
    EED_trim: Difference
    END: Difference

    def of(self, metric: str) -> Difference | None:
        """Return the difference in a metric; ``None`` where the rows are not compared in it."""
        found: Difference | None = getattr(self, metric)
        return found

    def seen_from(self, row: str) -> Pair:
        """Return the pair with ``row`` first, if it is one of the two."""
        if row != self.b:
            return self
        turned = {metric: found.reversed() for metric in TESTED if (found := self.of(metric)) is not None}
        return self.model_copy(update={"a": self.b, "b": self.a, **turned})


class Significance(JsonRecord):
    """All paired tests."""

    examples: int
    texts: int
    resamples: int
    level: float
    pairs: tuple[Pair, ...]


class FoldSizes(JsonRecord):
    """Numbers of examples that a fold trains and tests on, and the name of its training set."""

    train: int
    test: int
    training_set: str


class Metrics(JsonRecord):
    """The means of each row, how rows differ, and what was asked for."""

    WHAT = "the metrics of tmd experiment"
    REMAKE = PredictionRecord.REMAKE
    REPAIR = PredictionRecord.REPAIR

    models: dict[str, Row] = Field(min_length=1)
    floor: Row | None = Field(description="The row that predicts nothing; null if it was not run.")
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
        """Metrics that rows are compared in."""
        return tuple(metric for metric in TESTED if all(p.of(metric) is not None for p in self.significance.pairs))
