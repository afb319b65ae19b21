"""The log-linear reward of the instruction tree: its likelihood, the gradient, and learning by ascent."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from tmd.inference.policy.features import REALS, Features, Floats, Ints, Steps

_BATCH = 8
"""Sequences between two steps of the ascent."""
_SMALL = 1e-6


class Made(NamedTuple):
    """A sequence of the training data: its steps, and the number of the choice that was made at each."""

    at: Steps
    choices: Ints


def log_probabilities(features: Features, theta: Floats, at: Steps) -> Floats:
    """Give ln P(instruction | words, sequence so far), H × C: exp(θ·φ), normalised over the choices allowed."""
    end = features.shape[0] * features.shape[1]
    table = theta[:end].reshape(features.shape)
    rows = table[at.words].sum(axis=0) + np.stack([table[words].sum(axis=0) for words in at.followers])
    reward = rows @ at.menu.properties.T + theta[end:-REALS][at.pairs].sum(axis=2) + at.reals @ theta[-REALS:]
    reward[~at.allowed] = -np.inf
    reward -= reward.max(axis=1, keepdims=True)
    logs: Floats = reward - np.log(np.exp(reward).sum(axis=1, keepdims=True))
    return logs


def likelihood(features: Features, theta: Floats, data: Sequence[Made], gradient: Floats | None = None) -> float:
    """The log-likelihood of the choices made. Its gradient is added to ``gradient``."""
    total = 0.0
    end = features.shape[0] * features.shape[1]
    for at, choices in data:
        rows = np.arange(len(choices))
        logs = log_probabilities(features, theta, at)
        total += float(logs[rows, choices].sum())
        if gradient is None:
            continue
        # the features that were met, less those that were to be expected
        rest = -np.exp(logs)
        rest[rows, choices] += 1
        table = gradient[:end].reshape(features.shape)
        having = rest @ at.menu.properties
        table[at.words] += having.sum(axis=0)
        for words, row in zip(at.followers, having, strict=True):
            table[words] += row
        weights = np.repeat(rest.ravel(), at.pairs.shape[2])
        gradient[end:-REALS] += np.bincount(at.pairs.ravel(), weights, minlength=features.size - REALS - end)
        gradient[-REALS:] += np.einsum("hc,hcr->r", rest, at.reals)
    return total


def ascend(
    features: Features,
    data: Sequence[Made],
    random: np.random.Generator,
    *,
    rounds: int,
    rate: float,
    ridge: float,
    tell: Callable[[float], None] | None = None,
) -> Floats:
    """The weights θ by stochastic gradient ascent, with the step sizes of AdaGrad, from zero.

    What is raised is the log-likelihood less ridge/2 · |θ|². ``tell`` is told which share of the work is done.
    """
    theta: Floats = np.zeros(features.size)
    squares: Floats = np.full(features.size, _SMALL)
    for done in range(rounds):
        order = random.permutation(len(data)).tolist()
        for start in range(0, len(order), _BATCH):
            if tell is not None:
                tell((done + start / len(order)) / rounds)
            part = [data[number] for number in order[start : start + _BATCH]]
            gradient: Floats = theta * (-ridge * len(part) / len(data))
            likelihood(features, theta, part, gradient)
            squares += gradient**2
            theta += rate * gradient / np.sqrt(squares)
    return theta
