"""The oracles of each proposer, and what ranking makes of their candidates: nested cross-validation with p values.

``python experiments/ranking/rank.py DIRECTORY``: what ``experiments/ranking/candidates.py`` wrote. Each of the four
folds is tested once. What a ranker has to choose (the share of the neighbours, the strength of the ridge, the
temperature) is chosen on the three others, each left out in turn, and its weights are then learned on all three.
Prints the oracles (the best candidate with hindsight), a table of rankers, the differences between neighbouring rows
with p values, and the weights that all four folds teach, which the row ``ranked`` has.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tmd.evaluation.models.ranked import FEATURES, PROPOSERS
from tmd.evaluation.summary import compare

Floats = NDArray[np.float64]
METRICS = ("IED", "END")
SHARES = (0.0, 0.1, 0.2, 0.3, 0.5)
RIDGES = (0.1, 1.0, 10.0, 50.0)
TEMPERATURES = (0.02, 0.05, 0.1)
RISK_RIDGE = 1e-4
STEPS, RATE = 150, 0.006


@dataclass(frozen=True, eq=False)
class Text:
    """A text with its candidates: ``features`` is C x F, ``scores`` is 2 x C, from 0 to 1."""

    known: dict[str, Any]
    features: Floats
    scores: Floats

    @property
    def fold(self) -> str:
        """The pair of environments that it is tested in, whichever the world."""
        return str(self.known["fold"]).split("-", 1)[1]


Ranker = Callable[[Text], int]
"""Says which candidate it takes."""
Learner = Callable[[Sequence[Text]], Ranker]


def first_of(proposer: str) -> Learner:
    """Takes what a proposer thinks the best."""

    def rank(text: Text) -> int:
        own = text.known["proposed"][proposer]
        return int(own[0]) if own else 0

    return lambda _: rank


def column(name: str) -> int:
    """The number of a feature."""
    return FEATURES.index(name)


def expected(text: Text, share: float) -> Floats:
    """The mean of IED and END that is expected of each candidate; ``share`` is how much the neighbours count."""
    drawn, near = ([f"{who} {metric}" for metric in METRICS] for who in ("drawn", "neighbours"))
    mean = [text.features[:, [column(name) for name in names]].mean(axis=1) for names in (drawn, near)]
    found: Floats = (1 - share) * mean[0] + share * mean[1]
    return found


def least_loss(among: Sequence[str], share: float) -> Ranker:
    """Takes the least expected loss, among the candidates of some proposers."""

    def rank(text: Text) -> int:
        own = sorted({number for name in among for number in text.known["proposed"][name]}) or [0]
        return int(own[int(np.argmax(expected(text, share)[own]))])

    return rank


def squares(ridge: float) -> Learner:
    """A linear function of the features, nearest to the scores in least squares within each text."""

    def learn(texts: Sequence[Text]) -> Ranker:
        return linear(least_squares(texts, ridge))

    return learn


def least_squares(texts: Sequence[Text], ridge: float) -> Floats:
    """The weights of :func:`squares`."""
    scale = _scale(texts)
    left, right = np.zeros((len(FEATURES), len(FEATURES))), np.zeros(len(FEATURES))
    for text in texts:
        wanted = text.scores.mean(axis=0)
        features = text.features / scale
        left += features.T @ features / len(wanted)
        right += features.T @ (wanted - wanted.mean()) / len(wanted)
    found: Floats = np.linalg.solve(left + ridge * np.eye(len(FEATURES)), right) / scale
    return found


def _scale(texts: Sequence[Text]) -> Floats:
    found: Floats = np.sqrt(np.mean([(text.features**2).mean(axis=0) for text in texts], axis=0)) + 1e-9
    return found


def expected_risk(temperature: float) -> Learner:
    """A linear function by which a candidate drawn from its softmax has the greatest score on average."""

    def learn(texts: Sequence[Text]) -> Ranker:
        return linear(risk_weights(texts, temperature))

    return learn


def risk_weights(texts: Sequence[Text], temperature: float) -> Floats:
    """The weights, by gradient ascent from those of least squares."""
    scale = _scale(texts)
    weights = least_squares(texts, RIDGES[-2]) * scale
    squared = np.full(len(weights), 1e-8)
    for _ in range(STEPS):
        gradient = -RISK_RIDGE * weights
        for text in texts:
            features, score = text.features / scale, text.scores.mean(axis=0)
            odds = features @ weights / temperature
            share = np.exp(odds - odds.max())
            share /= share.sum()
            gradient = gradient + features.T @ (share * (score - share @ score)) / temperature / len(texts)
        squared += gradient**2
        weights = weights + RATE * gradient / np.sqrt(squared)
    found: Floats = weights / scale
    return found


def linear(weights: Floats) -> Ranker:
    """Takes the greatest weighed sum."""
    return lambda text: int(np.argmax(np.round(text.features @ weights, 9)))


def chosen(learners: Sequence[Learner]) -> Learner:
    """The one of several that is best on folds left out of the training texts in turn, learned on all of these."""

    def learn(texts: Sequence[Text]) -> Ranker:
        return learners[best_of(learners, texts)](texts)

    return learn


def best_of(learners: Sequence[Learner], texts: Sequence[Text]) -> int:
    """The number of that one."""
    gains = [np.mean([score for _, score in tested(learner, texts)]) for learner in learners]
    return int(np.argmax(np.round(gains, 9)))


def tested(learner: Learner, texts: Sequence[Text]) -> list[tuple[Text, Floats]]:
    """Each text with the scores of what is picked for it by what the other folds teach."""
    found = []
    for fold in sorted({text.fold for text in texts}):
        rank = learner([text for text in texts if text.fold != fold])
        found += [(text, text.scores[:, rank(text)]) for text in texts if text.fold == fold]
    return found


def rankers() -> dict[str, Learner]:
    """The rows of the table, each a step beyond the one before."""

    def least(share: float) -> Learner:
        return lambda _: least_loss(PROPOSERS, share)

    return {
        "the plan of least energy, goals": first_of("goals"),
        "the plan of least energy, policy": first_of("policy"),
        "least expected loss among plans": lambda _: least_loss(("goals", "policy"), 0.0),
        "... among all candidates": least(0.0),
        "... of the neighbours' too": chosen([least(share) for share in SHARES]),
        "learned by least squares": chosen([squares(ridge) for ridge in RIDGES]),
        "learned by expected risk": chosen([expected_risk(temperature) for temperature in TEMPERATURES]),
    }


def main(directory: Path) -> None:
    """Print everything."""
    texts = [
        Text(entry, np.array(entry["features"]), np.array([entry[metric] for metric in METRICS]) / 100)
        for path in sorted(directory.glob("*.json"))
        for entry in json.loads(path.read_text())
    ]
    worlds = sorted({text.known["world"] for text in texts})
    count = np.mean([len(text.features) for text in texts])
    executable = np.mean([value for text in texts for value in text.known["executable"]])
    print(
        f"{len(texts)} texts, {count:.0f} candidates each, {executable:.1f} % of them executable\n\nOracles, IED / END"
    )
    for name in (*PROPOSERS, "all"):
        print(f"  {name:34}" + "  ".join(_oracle(name, texts, world) for world in (*worlds, "")))
    print("\nRankers, IED / END")
    predictions = []
    for name, learner in rankers().items():
        found = tested(learner, texts)
        cells = []
        for world in (*worlds, ""):
            own = [scores for text, scores in found if text.known["world"].endswith(world)]
            cells.append(_cell(world, np.mean(own, axis=0)))
        print(f"  {name:34}" + "  ".join(cells), flush=True)
        for text, scores in found:
            values = dict(zip(METRICS, (100 * scores).tolist(), strict=True))
            known = {key: text.known[key] for key in ("id", "environment", "text")}
            predictions.append(known | values | {"model": name})
    _print_differences(predictions)
    ridge = RIDGES[best_of([squares(value) for value in RIDGES], texts)]
    print(f"\nWeights that all folds teach by least squares, ridge {ridge}")
    for name, weight in zip(FEATURES, least_squares(texts, ridge).tolist(), strict=True):
        print(f'    "{name}": {weight:.4f},')


def _oracle(name: str, texts: Sequence[Text], world: str) -> str:
    best = []
    for text in texts:
        if text.known["world"].endswith(world):
            own = text.known["proposed"][name] if name != "all" else range(len(text.features))
            best.append(text.scores[:, list(own)].max(axis=1) if len(own) else np.zeros(2))
    return _cell(world, np.mean(best, axis=0))


def _cell(world: str, scores: Floats) -> str:
    return f"{world or 'both'} {100 * scores[0]:.1f} / {100 * scores[1]:.1f}"


def _print_differences(predictions: Sequence[dict[str, Any]]) -> None:
    names = list(rankers())
    found = compare(list(predictions), names, METRICS)
    table = {(pair["b"], pair["a"]): pair for pair in found["pairs"]}
    print("\nDifferences, with p of the sign-flip test by texts")
    for later, earlier in [(b, a) for a, b in pairwise(names)] + [(names[-2], names[1]), (names[-2], names[0])]:
        pair = table[later, earlier]
        cells = [f"{metric} {-pair[metric]['difference']:+.2f} (p {pair[metric]['p']:.4f})" for metric in METRICS]
        print(f"  {later} - {earlier}: " + ", ".join(cells))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
