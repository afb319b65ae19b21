"""Candidates from every proposer, ranked by weights that were learned on the metrics themselves. Not in the paper.

A text has candidates of four proposers, all executable: the plans of least energy of the models ``goals`` and
``policy``, sequences drawn from the policy, and what people did for the nearest training texts. A linear function of
what is known of each before it is scored picks one. What counts most is the similarity expected under what people may
do, which is minimum Bayes risk, under two views of them: the policy's draws, and the neighbours' sequences.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from tmd.evaluation.models.paper_models import Crf, planner_for, policy_of
from tmd.evaluation.models.prediction import Prediction
from tmd.evaluation.runs.dataset import Dataset, Example
from tmd.inference.bayes_risk import SequenceCompleter, similarities
from tmd.inference.config import GOALS, POLICY
from tmd.language import parse
from tmd.pddl.model import Instruction

PLANS, DRAWN, NEIGHBOURS = 10, 64, 30
"""How many candidates of each proposer there are at most."""
SHARPNESS = 3
"""The power to which the likeness of a neighbour's text is its weight: the nearest one counts most."""
PROPOSERS = ("goals", "policy", "drawn", "neighbours")
_LONGEST = 2.5
"""A length is a multiple of the usual one, and this at most."""
WEIGHTS: Mapping[str, float] = {
    "drawn IED": 0.7508,
    "drawn END": 0.2023,
    "neighbours IED": 0.2102,
    "neighbours END": 0.0547,
    "drawn IED squared": 0.0518,
    "drawn END squared": 0.2765,
    "drawn IED by END": -0.6042,
    "length": 0.0304,
    "length squared": -0.0090,
    "empty": 0.0146,
    "of goals": 0.0434,
    "of policy": 0.0184,
    "of drawn": -0.0025,
    "of neighbours": 0.0139,
    "first of goals": 0.0079,
    "first of policy": 0.0047,
    "nearest neighbour": -0.0367,
}
"""The weights, learned by ``experiments/ranking/rank.py`` on VEIL-500's environments 1-8, all tasks of both worlds."""
FEATURES = tuple(WEIGHTS)


@dataclass(frozen=True, slots=True)
class Candidates:
    """The candidate plans for one text.

    Attributes:
        proposed: For each of :data:`PROPOSERS` the numbers of its candidates, likeliest first.
        features: C × :data:`FEATURES`; each column has mean 0, as only differences between candidates count.
    """

    plans: tuple[tuple[Instruction, ...], ...]
    proposed: Mapping[str, tuple[int, ...]]
    features: NDArray[np.float64]


class Ranked:
    """A row of the table. ``weights`` say what each of :data:`FEATURES` counts for."""

    def __init__(self, weights: Mapping[str, float] = WEIGHTS) -> None:
        self.weights = np.array([weights.get(name, 0.0) for name in FEATURES])

    def fit(self, examples: Sequence[Example], data: Dataset, random: np.random.Generator) -> Self:
        """Keep the examples and learn from them what ``goals`` and ``policy`` learn."""
        self._examples = tuple(examples)
        self._tree = policy_of(self._examples, data)
        self._models = {
            "goals": Crf(GOALS, learned=False).fit(examples, data, random),
            "policy": Crf(POLICY, learned=False).fit(examples, data, random),
        }
        return self

    def predict(self, example: Example, data: Dataset, random: np.random.Generator) -> Prediction:
        """Return the candidate with the greatest weighed sum; of equal ones the first."""
        found = self.candidates(example, data)
        best = int(np.argmax(np.round(found.features @ self.weights, 9)))
        return Prediction(found.plans[best])

    def candidates(self, example: Example, data: Dataset) -> Candidates:
        """Return the candidates of all proposers for a text; the sequence of the example is not used."""
        world = data.world(example.environment)
        completer = SequenceCompleter(world, planner_for(data, example.environment, POLICY.cap))
        policy = self._tree.policy(example.environment, example.world, data)
        clauses = parse(example.demonstration.text, data.lexicon).clauses
        drawn = policy.sample(clauses, DRAWN, np.random.default_rng(0)) if policy is not None and clauses else []
        near, likeness = self._neighbours(example)
        made = {name: [p.instructions for p in m.plans(example, data, top=PLANS)] for name, m in self._models.items()}
        made["drawn"] = [completer.plan(tuple(sequence)).instructions for sequence in drawn]
        made["neighbours"] = [completer.plan((other.gold,)).instructions for other in near]
        plans = list(dict.fromkeys(plan for own in made.values() for plan in own)) or [()]
        number = {plan: place for place, plan in enumerate(plans)}
        proposed = {name: tuple(number[plan] for plan in dict.fromkeys(own)) for name, own in made.items()}
        people = [tuple(i for own in sequence for i in own) for sequence in drawn]
        theirs = [other.gold for other in near]
        scorer = data.scorer(example.environment)
        scorer.prepare((*plans, *people, *theirs))  # with another task in between, changes could not be compared
        under = {
            "drawn": _mean(similarities(plans, people, scorer.changed), np.ones(len(people))),
            "neighbours": _mean(similarities(plans, theirs, scorer.changed), likeness**SHARPNESS),
        }
        usual = float(np.mean([len(sequence) for sequence in people])) if people else 0.0
        return Candidates(tuple(plans), proposed, _features(plans, proposed, under, usual))

    def _neighbours(self, example: Example) -> tuple[list[Example], NDArray[np.float64]]:
        """Return the training examples of the nearest texts, and their similarity: the cosine of the words' tf-idf."""
        pool = [other for other in self._examples if other.world == example.world]
        bags = [Counter(re.findall(r"[a-z0-9']+", e.demonstration.text.lower())) for e in (example, *pool)]
        frequency = Counter(word for bag in bags[1:] for word in bag)
        column = {word: place for place, word in enumerate(sorted({*bags[0], *frequency}))}
        rows = np.zeros((len(bags), len(column)))
        for row, bag in zip(rows, bags, strict=True):
            for word, count in bag.items():
                row[column[word]] = (1 + np.log(count)) * np.log((len(pool) + 1) / (frequency[word] + 0.5))
        lengths = np.linalg.norm(rows, axis=1)
        likeness = np.round(rows[1:] @ rows[0] / np.maximum(lengths[1:] * lengths[0], 1e-12), 9)
        order = np.argsort(-likeness, kind="stable")[:NEIGHBOURS]
        return [pool[place] for place in order.tolist()], np.maximum(likeness[order], 0.0)


def _mean(similar: NDArray[np.float64], weights: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the weighed mean over people of shape (2, C, people), as (2, C); 0 where there are none."""
    total = weights.sum()
    found: NDArray[np.float64] = similar @ weights / total if total else np.zeros(similar.shape[:2])
    return found


def _features(
    plans: Sequence[tuple[Instruction, ...]],
    proposed: Mapping[str, tuple[int, ...]],
    under: Mapping[str, NDArray[np.float64]],
    usual: float,
) -> NDArray[np.float64]:
    drawn, near = under["drawn"], under["neighbours"]
    lengths = np.array([len(plan) for plan in plans], dtype=np.float64)
    length = np.minimum(lengths / max(usual, 1.0), _LONGEST)
    columns = [*drawn, *near, drawn[0] ** 2, drawn[1] ** 2, drawn[0] * drawn[1], length, length**2, lengths == 0]
    for names in (proposed, {name: own[:1] for name, own in proposed.items() if name != "drawn"}):
        for name in PROPOSERS:
            if name in names:
                column = np.zeros(len(plans))
                column[list(names[name])] = 1
                columns.append(column)
    found = np.stack(columns, axis=1)
    centred: NDArray[np.float64] = found - found.mean(axis=0)
    return centred
