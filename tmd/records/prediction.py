"""``predictions.jsonl`` and ``parts/`` of ``tmd experiment``: a line for each prediction."""

from __future__ import annotations

from typing import Annotated, TypeAlias

from pydantic import Field

from tmd.json_record import JsonRecord

Score: TypeAlias = Annotated[float, Field(ge=0, le=100, strict=True)]


class PredictedClause(JsonRecord):
    """Predicted instructions for one clause."""

    text: str
    verb: str
    latent: tuple[str, ...]
    said: tuple[str, ...]
    source: str | None
    factors: dict[str, float]

    @property
    def steps(self) -> tuple[str, ...]:
        """All that was done for it."""
        return (*self.latent, *self.said)


class SegmentRecord(JsonRecord):
    """A piece of the text, and what the person did for it."""

    text: str
    instructions: tuple[str, ...]


class PredictionRecord(JsonRecord):
    """A prediction with its scores. Instructions are in the data set's own notation; ``text`` is what the model read.

    ``success`` is whether the goal of the text holds at the end: null where the example has none, left out in runs of
    versions that did not look at goals.
    """

    WHAT = "a prediction of tmd experiment"
    REMAKE = "run the experiment again, into another directory"
    REPAIR = "run the same `tmd experiment` again; finished work is not redone"

    id: str | int
    task: str
    environment: str
    model: str
    fold: str
    text: str
    predicted: tuple[str, ...]
    gold: tuple[str, ...]
    executable: bool
    success: bool | None = None
    IED: Score = Field(description="Scores run from 0 to 100; larger is better.")
    END: Score
    EED: Score
    EED_trim: Score
    clauses: tuple[PredictedClause, ...] = Field(description="Empty for models that do not work by clauses.")
    segments: tuple[SegmentRecord, ...]

    @property
    def whole(self) -> bool:
        """Return whether the clauses' instructions are the prediction; if not, the model changed it afterwards."""
        return tuple(step for clause in self.clauses for step in clause.steps) == self.predicted
