"""Instruction-Tree Search (section VII), after Bollini et al.: from words to instructions, the world unseen."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Self

import numpy as np

from tmd.evaluation.models.prediction import Prediction, by_clause
from tmd.evaluation.runs.dataset import Example, Worlds
from tmd.inference.policy.learning import learn_policy
from tmd.inference.policy.model import Policy, Reward
from tmd.language import parse
from tmd.pddl.model import Instruction


class InstructionTree:
    """A log-linear reward searches over the sequence of instructions for every clause.

    P(next instruction | words of the clause, sequence so far) ∝ exp(θ·φ) over what the syntactical constraints
    (:func:`~tmd.inference.policy.features.learn_syntax`) allow; φ is in :mod:`tmd.inference.policy.menu`. The reward of
    a sequence is its log-probability and a bonus for its length; a beam search finds the best one, clause by clause.
    Which objects there are is known, in which state they are is not: neither states nor preconditions are read.

    A clause for which the demonstration has no instructions teaches nothing: most of them come from the alignment,
    which gives all that was done for a piece of text to one of its clauses. ``rounds`` is the number of passes over the
    training data. A ``grounded`` reward also knows which objects the nouns of a clause may mean: the paper's baseline
    has the words alone, with this it is a row of ours.
    """

    def __init__(self, *, rounds: int = 8, grounded: bool = False) -> None:
        self.rounds = rounds
        self.grounded = grounded

    def fit(self, examples: Sequence[Example], data: Worlds, random: np.random.Generator) -> Self:
        """Learn constraints, features and weights for each kind of world."""
        self._policies: dict[str, Policy] = {}
        self.rewards_: dict[str, Reward] = {}
        for world in sorted({example.world for example in examples}):
            self.rewards_[world] = learn_policy(
                [e.demonstration for e in examples if e.world == world],
                data.world,
                random,
                grounded=self.grounded,
                rounds=self.rounds,
            )
        return self

    def predict(self, example: Example, data: Worlds, random: np.random.Generator) -> Prediction:
        """Return the sequence of the greatest reward for each clause, one clause after the other."""
        policy = self.policy(example.environment, example.world, data)
        if policy is None:
            return Prediction()
        clauses = parse(example.demonstration.text, data.lexicon).clauses
        done: list[tuple[Instruction, ...]] = []
        for number in range(len(clauses)):
            so_far = tuple(instruction for made in done for instruction in made)
            done.append(policy.best(clauses, number, so_far)[0][1])
        return by_clause(clauses, [(made, None) for made in done])

    def policy(self, environment: str, world: str, data: Worlds) -> Policy | None:
        """Return the learned policy for one environment; ``None`` in a kind of world that training did not have."""
        reward = self.rewards_.get(world)
        if reward is None:
            return None
        ground = data.world(environment)
        policy = self._policies.get(environment)
        if policy is None or policy.menu.things.world is not ground:
            policy = self._policies[environment] = Policy(reward, ground)
        return policy
