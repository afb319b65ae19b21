"""Learning the weights by stochastic gradient descent (section VI-F).

For each training example inference proposes plans; each plan is a vector of factors and has a loss against what the
person did. The target is the plan of least loss that inference can reach at all, y*. The objective is the
structured hinge with margin rescaling: for each example

    max_y [ loss(y) - loss(y*) + E(y*) - E(y) ] ≥ 0,

plus a small quadratic term that keeps the weights near where they began. It is convex in the weights, and its
subgradient is the difference of two factor vectors. Factors are costs, so weights are kept from falling below zero.
Plans are proposed anew with the weights of each round, and the old ones are kept: the most violating plan of a
round is among them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from tmd.energy.plans import RankedPlan
from tmd.energy.weights import NAMES, Weights

Vector = NDArray[np.float64]
"""A number for each of :data:`~tmd.energy.weights.NAMES`."""


@dataclass(slots=True)
class Pool:
    """The plans proposed for one example: factor vectors, shape (plans, factors), and losses in [0, 1]."""

    factors: list[Vector] = field(default_factory=list)
    losses: list[float] = field(default_factory=list)
    _known: set[tuple[object, ...]] = field(default_factory=set)

    def add(self, plan: RankedPlan, loss: float) -> None:
        """Take up a plan, once."""
        vector = vector_of(plan)
        key = (*vector.tolist(), loss)
        if key not in self._known:
            self._known.add(key)
            self.factors.append(vector)
            self.losses.append(loss)


@dataclass(frozen=True, slots=True)
class Learned:
    """What learning gives: weights, and for each round the mean loss of the plans that inference chose."""

    weights: Weights
    curve: tuple[float, ...]


Propose = Callable[[int, Weights], Sequence[tuple[RankedPlan, float]]]
"""The plans, cheapest first, for the example of that number under those weights, each with its loss."""


def vector_of(plan: RankedPlan) -> Vector:
    """The factors of a plan before they are weighed."""
    raw = plan.raw
    return np.array([raw.get(name, 0.0) for name in NAMES])


def learn_weights(
    propose: Propose,
    examples: int,
    start: Weights,
    random: np.random.Generator,
    *,
    rounds: int = 3,
    epochs: int = 20,
    rate: float = 0.1,
    pull: float = 1e-3,
) -> Learned:
    """Learn weights from ``examples`` training examples.

    Args:
        propose: Inference and loss for one example.
        examples: How many examples there are.
        start: Where to begin.
        random: The order in which examples are visited.
        rounds: How often plans are proposed anew.
        epochs: Passes over the examples in each round.
        rate: The step of the descent, in units of each factor's spread.
        pull: How strongly weights are drawn to ``start``.
    """
    pools = [Pool() for _ in range(examples)]
    weights = start
    curve: list[float] = []
    for _ in range(rounds):
        chosen = []
        for number, pool in enumerate(pools):
            plans = propose(number, weights)
            for plan, loss in plans:
                pool.add(plan, loss)
            if plans:
                chosen.append(plans[0][1])
        curve.append(float(np.mean(chosen)) if chosen else 0.0)
        weights = descend(pools, start, random, epochs=epochs, rate=rate, pull=pull)
    return Learned(weights, tuple(curve))


def descend(
    pools: Sequence[Pool], start: Weights, random: np.random.Generator, *, epochs: int, rate: float, pull: float
) -> Weights:
    """Stochastic subgradient descent on the hinge over fixed pools, returning the mean of the iterates."""
    useful = [pool for pool in pools if len(pool.losses) > 1]
    if not useful:
        return start
    scale = _spread(useful)
    origin = np.array([start[name] for name in NAMES]) * scale
    origin = origin / max(float(np.abs(origin).sum()), 1e-9) * len(NAMES)
    current = origin.copy()
    total = np.zeros_like(current)
    steps = 0
    tables = [(np.array(pool.factors) / scale, np.array(pool.losses)) for pool in useful]
    for epoch in range(epochs):
        step = rate / (1 + epoch)
        for index in random.permutation(len(tables)):
            current = _step(current, origin, *tables[int(index)], step, pull)
            total += current
            steps += 1
    mean = total / steps / scale
    return Weights({name: float(value) for name, value in zip(NAMES, mean, strict=True)})


def _step(current: Vector, origin: Vector, factors: Vector, losses: Vector, step: float, pull: float) -> Vector:
    """One subgradient step on one example; weights stay non-negative."""
    energies = factors @ current
    best = losses == losses.min()
    target = int(np.flatnonzero(best)[np.argmin(energies[best])])
    violation = (losses - losses[target]) - (energies - energies[target])
    worst = int(np.argmax(violation))
    gradient = pull * (current - origin)
    if violation[worst] > 0:
        gradient = gradient + factors[target] - factors[worst]
    stepped: Vector = np.maximum(0.0, current - step * gradient)
    return stepped


def _spread(pools: Sequence[Pool]) -> Vector:
    """The mean spread of each factor within the pools, so that a step means the same for each; 1 where it is none."""
    spreads = np.mean([np.std(np.array(pool.factors), axis=0) for pool in pools], axis=0)
    found: Vector = np.where(spreads > 1e-9, spreads, 1.0)
    return found
