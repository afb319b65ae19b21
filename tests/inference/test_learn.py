"""Learning weights: the hinge is descended, the start is kept where there is nothing to learn, seeds decide."""

from __future__ import annotations

import numpy as np
import pytest

from tmd.inference.energy import NAMES, Weights, named_weights
from tmd.inference.ranking import Choice, RankedPlan
from tmd.inference.weight_learning import Pool, descend, learn_weights, vector_of

START = named_weights("paper_extended")


def plan(**raw: float) -> RankedPlan:
    return RankedPlan((Choice("t", (), {}, raw),), 0)


def pool(*plans: tuple[RankedPlan, float]) -> Pool:
    return {(*vector_of(one).tolist(), loss): None for one, loss in plans}


def energy(weights: Weights, one: RankedPlan) -> float:
    return float(sum(weights[name] * value for name, value in one.raw.items()))


def test_a_vector_has_a_number_for_each_factor() -> None:
    vector = vector_of(plan(environment_distance=0.5, trimming=4.0))
    assert vector.shape == (len(NAMES),)
    assert vector[NAMES.index("trimming")] == 4.0
    assert vector.sum() == 4.5


def test_what_the_start_gets_wrong_is_learned() -> None:
    # the better plan is the one whose clause is less alike: the opposite of what the start believes
    random = np.random.default_rng(1)
    pools = []
    for _ in range(30):
        noise = float(random.random()) * 0.1
        pools.append(
            pool(
                (plan(clause_distance=0.6, inconsistent_end=0.1 + noise), 0.1),
                (plan(clause_distance=0.2, inconsistent_end=0.9 - noise), 0.8),
            )
        )
    good, bad = plan(clause_distance=0.6, inconsistent_end=0.15), plan(clause_distance=0.2, inconsistent_end=0.85)
    assert energy(START, good) > energy(START, bad)
    learned = descend(pools, START, np.random.default_rng(0), epochs=30, rate=0.1, pull=1e-3).weights
    assert energy(learned, good) < energy(learned, bad)


def test_weights_stay_non_negative() -> None:
    pools = [pool((plan(environment_distance=1.0), 0.0), (plan(environment_distance=0.0), 1.0)) for _ in range(20)]
    learned = descend(pools, START, np.random.default_rng(0), epochs=50, rate=1.0, pull=0.0).weights
    assert all(learned[name] >= 0.0 for name in NAMES)


def test_nothing_to_learn_from_leaves_the_start() -> None:
    pools = [
        pool(),
        pool((plan(environment_distance=1.0), 0.3)),
        pool((plan(environment_distance=1.0), 0.3), (plan(environment_distance=1.0), 0.3)),
    ]
    assert descend(pools, START, np.random.default_rng(0), epochs=5, rate=0.1, pull=0.0).weights is START


def test_rounds_propose_with_the_weights_of_the_round_before() -> None:
    asked: list[Weights] = []

    def propose(number: int, weights: Weights) -> list[tuple[RankedPlan, float]]:
        asked.append(weights)
        plans = [
            (plan(clause_distance=0.9, inconsistent_end=0.1), 0.1),
            (plan(clause_distance=0.1, inconsistent_end=0.9), 0.8),
        ]
        return sorted(plans, key=lambda item: energy(weights, item[0]))

    learned = learn_weights(propose, 4, START, np.random.default_rng(0), rounds=3, epochs=30)
    assert all(asked[0][name] == START[name] for name in NAMES)
    assert asked[4] is not START
    assert learned.curve[0]["loss"] == pytest.approx(0.8)
    assert learned.curve[-1]["loss"] == pytest.approx(0.1)


def test_the_seed_decides() -> None:
    pools = [
        pool(
            (plan(environment_distance=float(i % 3), clause_distance=0.5), i / 10),
            (plan(environment_distance=1.0, clause_distance=float(i % 2)), 0.5),
        )
        for i in range(9)
    ]
    randoms = [np.random.default_rng(seed) for seed in (0, 0, 1)]
    outcomes = [descend(pools, START, random, epochs=3, rate=0.1, pull=1e-3).weights for random in randoms]
    assert outcomes[0] == outcomes[1]
    assert outcomes[0] != outcomes[2]
