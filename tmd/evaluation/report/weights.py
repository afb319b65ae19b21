"""The weights that a row learned, over its training sets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

from tmd.records.fit import Fit, WorldFit

# How many weights are shown.
_SHOWN = 40
# Mean, least and largest weight over the training sets; ``None`` where no set has the factor.
_Cell: TypeAlias = tuple[float, float, float] | None


@dataclass(frozen=True, slots=True)
class LearnedWeights:
    """Weights that one row learned.

    Attributes:
        model: The row.
        sets: The number of its training sets.
        losses: The mean loss of the first and of the last epoch; ``None`` if no curve was kept.
        worlds: The kinds of world.
        weights: The largest weights, by factor: a cell for each kind of world.
        smaller: How many are left out.
    """

    model: str
    sets: int
    losses: tuple[float, float] | None
    worlds: tuple[str, ...]
    weights: tuple[tuple[str, tuple[_Cell, ...]], ...]
    smaller: int


def learned(fits: Sequence[Fit], model: str) -> LearnedWeights:
    """Return the weights that one row learned, and how its loss fell."""
    own = [fit for fit in fits if fit.model == model]
    found = [world for fit in own for world in fit.worlds.values()]
    worlds = tuple(sorted({world for fit in own for world in fit.worlds}))
    names = dict.fromkeys(name for world in found for name in world.weights)
    weights = {name: tuple(_spread(own, world, name) for world in worlds) for name in names}
    kept = set(sorted(weights, key=lambda name: -_size(weights[name]))[:_SHOWN])
    shown = tuple((name, cells) for name, cells in weights.items() if name in kept)
    return LearnedWeights(model, len(own), _losses(found), worlds, shown, len(weights) - len(shown))


def _spread(fits: Sequence[Fit], world: str, name: str) -> _Cell:
    found = [fit.worlds[world].weights for fit in fits if world in fit.worlds]
    values = [weights[name] for weights in found if name in weights]
    return (sum(values) / len(values), min(values), max(values)) if values else None


def _size(cells: Sequence[_Cell]) -> float:
    return max(abs(cell[0]) for cell in cells if cell)


def _losses(worlds: Sequence[WorldFit]) -> tuple[float, float] | None:
    """Return the mean loss of the first and of the last epoch."""
    curves = [[point.loss for point in world.curve if point.loss is not None] for world in worlds]
    ends = [(curve[0], curve[-1]) for curve in curves if curve]
    if not ends:
        return None
    return sum(first for first, _ in ends) / len(ends), sum(last for _, last in ends) / len(ends)
