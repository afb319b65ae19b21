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
    """Weights learned for one kind of world. A curve may also be plain numbers: the loss of one round each."""

    weights: dict[str, float]
    curve: tuple[CurvePoint | float, ...]

    @property
    def points(self) -> list[CurvePoint]:
        """The curve."""
        return [
            point if isinstance(point, CurvePoint) else CurvePoint(round=number, epoch=0, loss=point)
            for number, point in enumerate(self.curve)
        ]


class Fit(JsonRecord):
    """Weights that one model learned from one training set, by kind of world."""

    WHAT = "what a model of tmd experiment learned"
    REMAKE = "remove that file; the page will lack its curve"

    model: str
    trained_in: tuple[str, ...]
    worlds: dict[str, WorldFit]
