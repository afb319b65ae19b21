"""Instruction-Tree Search (section VII), after Bollini et al.: from words to instructions, the world unseen."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Self

import numpy as np

from tmd.evaluation.models.prediction import Prediction, by_clause
from tmd.evaluation.runs.dataset import Example, Worlds
from tmd.inference.policy.learning import learn_policy
from tmd.inference.policy.model import Policy, Reward
from tmd.language import Clause, parse
from tmd.pddl.model import Instruction


class InstructionTree:
    """A log-linear reward searches over the sequence of instructions for every clause.

    P(next instruction | words of the clause, sequence so far) ∝ exp(θ·φ) over what the syntactical constraints
    (:func:`~tmd.inference.policy.features.learn_syntax`) allow; φ is in :mod:`tmd.inference.policy.menu`. The reward of
    a sequence is its log-probability and a bonus for its length; a beam search finds the best one, clause by clause.
    Which objects there are is known, in which state they are is not: neither states nor preconditions are read.

    A clause for which the demonstration has no instructions teaches nothing: most of them come from the alignment,
    which gives all that was done for a piece of text to one of its clauses.

    Args:
        beam: How many sequences of a length are looked at further.
        bonus: Reward for each instruction. The likeliest sequence is shorter than the usual one; this makes up.
        slack: A sequence is given up when its reward is this much below that of the best complete one.
        certain: From which share on what went before counts as needed (``learn_syntax``).
        rounds: How often the training data are gone through.
        rate: Step size of the ascent.
        ridge: Weight of the squared weights; the usual one where none is given.
        grounded: Whether the reward also knows which objects the clause's nouns may mean. The paper's baseline has
            the words alone; with this it is a row of ours.
    """

    def __init__(
        self,
        *,
        beam: int = 5,
        bonus: float = 0.5,
        slack: float = 3.0,
        certain: float = 0.95,
        rounds: int = 8,
        rate: float = 0.2,
        ridge: float | None = None,
        grounded: bool = False,
    ) -> None:
        self.beam = beam
        self.bonus = bonus
        self.slack = slack
        self.certain = certain
        self.rounds = rounds
        self.rate = rate
        self.ridge = ridge
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
                certain=self.certain,
                rounds=self.rounds,
                rate=self.rate,
                ridge=self.ridge,
            )
        return self

    def predict(self, example: Example, data: Worlds, random: np.random.Generator) -> Prediction:
        """Return the sequence of the greatest reward for each clause, one clause after the other."""
        policy = self.policy(example.environment, example.world, data)
        if policy is None:
            return Prediction()
        served: list[tuple[Clause, tuple[Instruction, ...], str | None]] = []
        clauses = parse(example.demonstration.text, data.lexicon).clauses
        for number, clause in enumerate(clauses):
            done = tuple(i for _, made, _ in served for i in made)
            served.append((clause, policy.best(clauses, number, done)[0][1], None))
        return by_clause(served)

    def policy(self, environment: str, world: str, data: Worlds) -> Policy | None:
        """Return the learned policy for one environment; ``None`` in a kind of world that training did not have."""
        reward = self.rewards_.get(world)
        if reward is None:
            return None
        ground = data.world(environment)
        policy = self._policies.get(environment)
        if policy is None or policy.menu.things.world is not ground:
            policy = self._policies[environment] = Policy(
                reward, ground, grounded=self.grounded, beam=self.beam, bonus=self.bonus, slack=self.slack
            )
        return policy
