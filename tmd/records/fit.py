"""``fits/`` of ``tmd experiment``: what one model learned from one training set."""

from __future__ import annotations

from tmd.json_record import JsonRecord


class CurvePoint(JsonRecord):
    """One pass over the examples: ``loss`` from 0 to 1, ``objective`` as it is made small."""

    round: int
    epoch: int
    loss: float | None = None
    objective: float | None = None


class WorldFit(JsonRecord):
    """Weights learned for one kind of world, and the curve of their learning."""

    weights: dict[str, float]
    curve: tuple[CurvePoint, ...]


class Fit(JsonRecord):
    """Weights that one model learned from one training set, by kind of world."""

    WHAT = "what a model of tmd experiment learned"
    REMAKE = "remove that file; the page will lack its curve"

    model: str
    trained_in: tuple[str, ...]
    worlds: dict[str, WorldFit]
