"""Learning the weights by stochastic gradient descent (section VI-F).

For each training example inference proposes plans; each plan is a vector of factors and has a loss against what the
person did. The target is the plan of least loss that inference can reach at all, y*. The objective is the
structured hinge with margin rescaling: for each example

    max_y [ loss(y) - loss(y*) + E(y*) - E(y) ] ≥ 0,

plus a small quadratic term that keeps the weights near where they began. It is convex in the weights, and its
subgradient is the difference of two factor vectors. Factors are costs, so weights are kept from falling below zero.
Plans are proposed again with the weights of each round, and the old ones are kept: the most violating plan of a
round is among them.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from tmd.files import make_directory, writing
from tmd.inference.energy import FIXED, NAMES, Weights
from tmd.inference.ranking import RankedPlan

Pool: TypeAlias = dict[tuple[float, ...], None]
"""The distinct plans proposed for one example, in their order: the factors of each, then its loss in [0, 1]."""


@dataclass(frozen=True, slots=True)
class Learned:
    """The outcome of learning.

    Attributes:
        curve: For each epoch ``round``, ``epoch``, the mean ``loss`` over the examples of the plan that the weights
            prefer among those proposed so far, and the mean hinge (``objective``). Epoch 0 is before the first step
            of a round: there ``loss`` is that of the plans that inference itself has just chosen.
    """

    weights: Weights
    curve: tuple[Mapping[str, float], ...]


Propose = Callable[[int, Weights], Sequence[tuple[RankedPlan, float]]]
"""The plans, cheapest first, for the example of that number under those weights, each with its loss."""


def vector_of(plan: RankedPlan) -> Vector:
    """Return the factors of a plan before they are weighed."""
    raw = plan.raw
    return np.array([raw.get(name, 0.0) for name in NAMES])


def learn_weights(
    propose: Propose,
    examples: int,
    start: Weights,
    random: np.random.Generator,
    *,
    factors: Collection[str] = NAMES,
    rounds: int = 3,
    epochs: int = 20,
    rate: float = 0.1,
    pull: float = 1e-3,
    journal: Journal | None = None,
) -> Learned:
    """Learn weights from ``examples`` training examples.

    ``propose`` does inference and loss for one of the ``examples``, which are visited in the order that ``random``
    draws. All but ``factors`` keep weight 0. In each of ``rounds`` plans are proposed again, and there are ``epochs``
    passes over the examples. ``rate`` is the step of the descent, in units of each factor's spread, and ``pull`` how
    strongly weights are drawn to ``start``. Proposals are kept in the ``journal``, and read again after an
    interruption.
    """
    fixed = {name: start[name] for name in FIXED}
    start = Weights({name: start[name] for name in NAMES if name in factors})
    pools: list[Pool] = [{} for _ in range(examples)]
    weights = start
    curve: list[Mapping[str, float]] = []
    for number in range(1, rounds + 1):
        chosen = []
        for example, pool in enumerate(pools):
            proposed = journal.read(number, example) if journal else None
            if proposed is None:
                proposed = [(vector_of(plan), loss) for plan, loss in propose(example, weights)]
                if journal:
                    journal.write(number, example, proposed)
            for vector, loss in proposed:
                pool[*vector.tolist(), loss] = None
            if proposed:
                chosen.append(proposed[0][1])
        descent = descend(pools, start, random, factors=factors, epochs=epochs, rate=rate, pull=pull)
        weights = descent.weights
        losses = [float(np.mean(chosen)) if chosen else 0.0, *descent.losses]
        curve += [
            {"round": number, "epoch": epoch, "loss": loss, "objective": objective}
            for epoch, (loss, objective) in enumerate(zip(losses, descent.objectives, strict=True))
        ]
    return Learned(_with_fixed(weights, start, fixed), tuple(curve))


@dataclass(frozen=True, slots=True)
class Descent:
    """The outcome of a descent: weights, for each epoch the mean loss, and before and after each the mean hinge."""

    weights: Weights
    losses: tuple[float, ...]
    objectives: tuple[float, ...]


def descend(
    pools: Sequence[Pool],
    start: Weights,
    random: np.random.Generator,
    *,
    factors: Collection[str] = NAMES,
    epochs: int,
    rate: float,
    pull: float,
) -> Descent:
    """Descend along stochastic subgradients of the hinge over fixed pools.

    The result is the mean of the iterates up to the epoch whose preferred plans have the least mean loss, the start
    included, the latest of equals: the hinge bounds the loss, but the aim is a small loss.
    """
    useful = [_table(pool) for pool in pools if len(pool) > 1]
    if not useful:
        return Descent(start, (0.0,) * epochs, (0.0,) * (epochs + 1))
    scale = _spread(useful)
    free = np.array([name in factors for name in NAMES])
    origin = np.array([start[name] for name in NAMES]) * scale
    origin = origin / max(float(np.abs(origin).sum()), 1e-9) * len(NAMES)
    current = origin.copy()
    total = np.zeros_like(current)
    tables = [(values / scale, losses) for values, losses in useful]
    first, hinge = _judge(tables, origin)
    losses, objectives = [], [hinge]
    least, kept = first, origin
    for epoch in range(epochs):
        step = rate / (1 + epoch)
        for index in random.permutation(len(tables)):
            current = np.where(free, _step(current, origin, *tables[int(index)], step, pull), 0.0)
            total += current
        mean = total / ((epoch + 1) * len(tables))
        loss, objective = _judge(tables, mean)
        losses.append(loss)
        objectives.append(objective)
        if loss <= least:
            least, kept = loss, mean
    learned = zip(NAMES, kept / scale, strict=True)
    weights = Weights({name: float(value) for name, value in learned if name in factors})
    return Descent(weights, tuple(losses), tuple(objectives))


def _with_fixed(learned: Weights, start: Weights, fixed: Mapping[str, float]) -> Weights:
    """Return learned weights with those set by hand, which keep their share of the whole."""
    before, after = (sum(abs(weights[name]) for name in NAMES) for weights in (start, learned))
    share = after / before if before else 1.0
    return Weights({**learned.values, **{name: value * share for name, value in fixed.items() if value}})


def _table(pool: Pool) -> tuple[Vector, Vector]:
    """Return the factors of the plans in a pool, shape (plans, factors), and their losses."""
    rows = np.array(list(pool))
    return np.ascontiguousarray(rows[:, :-1]), np.ascontiguousarray(rows[:, -1])


def _judge(tables: Sequence[tuple[Vector, Vector]], weights: Vector) -> tuple[float, float]:
    """Return the mean loss of the plans that ``weights`` prefer, and the mean hinge."""
    chosen, hinges = [], []
    for factors, losses in tables:
        energies = factors @ weights
        chosen.append(float(losses[int(np.argmin(energies))]))
        target = _target(energies, losses)
        hinges.append(float(np.max((losses - losses[target]) - (energies - energies[target]))))
    return float(np.mean(chosen)), float(np.mean(hinges))


def _target(energies: Vector, losses: Vector) -> int:
    """Return y*: among the plans of least loss the one of least energy."""
    best = np.flatnonzero(losses == losses.min())
    return int(best[np.argmin(energies[best])])


def _step(current: Vector, origin: Vector, factors: Vector, losses: Vector, step: float, pull: float) -> Vector:
    """Take one subgradient step on one example; weights stay non-negative."""
    energies = factors @ current
    target = _target(energies, losses)
    violation = (losses - losses[target]) - (energies - energies[target])
    worst = int(np.argmax(violation))
    gradient = pull * (current - origin)
    if violation[worst] > 0:
        gradient = gradient + factors[target] - factors[worst]
    stepped: Vector = np.maximum(0.0, current - step * gradient)
    return stepped


def _spread(tables: Sequence[tuple[Vector, Vector]]) -> Vector:
    """Return the mean spread of each factor within the pools, which scales its steps; 1 for no spread."""
    spreads = np.mean([np.std(factors, axis=0) for factors, _ in tables], axis=0)
    found: Vector = np.where(spreads > 1e-9, spreads, 1.0)
    return found


Vector = NDArray[np.float64]
"""A number for each of :data:`~tmd.inference.energy.NAMES`."""
Proposed = list[tuple[Vector, float]]
"""Plans, cheapest first: the factors of each before they are weighed, and its loss."""


class Journal:
    """Proposals by round and example.

    A line that was cut off by a kill is dropped, and what comes after it as well. ``part`` says what the lines are
    about, where several learners share a file.
    """

    def __init__(self, path: Path, part: str = "") -> None:
        self.path = path
        self.part = part
        self._known: dict[tuple[int, int], Proposed] = {}
        if path.is_file():
            self._load()

    def read(self, number: int, example: int) -> Proposed | None:
        """Return the plans that were proposed for an example in a round, if any."""
        return self._known.get((number, example))

    def write(self, number: int, example: int, proposed: Sequence[tuple[Vector, float]]) -> None:
        """Add a line.

        Raises:
            OutputError: It cannot be written.
        """
        plans = [[vector.tolist(), loss] for vector, loss in proposed]
        line = json.dumps({"part": self.part, "round": number, "example": example, "plans": plans})
        make_directory(self.path.parent)
        with writing(self.path), self.path.open("a", encoding="utf-8") as file:
            file.write(line + "\n")

    def _load(self) -> None:
        whole = 0
        text = self.path.read_bytes()
        for line in text.splitlines(keepends=True):
            try:
                entry = json.loads(line) if line.endswith(b"\n") else None
                if entry is None:
                    break
                plans = [(np.array(vector, dtype=np.float64), float(loss)) for vector, loss in entry["plans"]]
                if entry["part"] == self.part:
                    self._known[entry["round"], entry["example"]] = plans
            except (ValueError, KeyError, TypeError, RecursionError):
                break
            whole += len(line)
        if whole < len(text):
            with self.path.open("r+b") as file:
                file.truncate(whole)
