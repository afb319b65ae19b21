"""The model of the paper as rows of the table: full, its ablations, and our variants of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Self

import numpy as np

from tmd.energy.energy import Energy
from tmd.energy.infer import Inference
from tmd.energy.learn import Learned, learn_weights
from tmd.energy.plans import RankedPlan
from tmd.energy.statistics import Statistics, count
from tmd.energy.weights import Weights, named_weights
from tmd.evaluation.dataset import Dataset, Example
from tmd.evaluation.metrics import EPSILON, ied
from tmd.evaluation.prediction import Prediction, Served
from tmd.language import Clause, parse
from tmd.pddl.task import Bits, Cube
from tmd.planning.backends import IN_PROCESS, make
from tmd.planning.result import Answer, Filled, Planner, Unreachable
from tmd.veil.library import Library, learn, run
from tmd.veil.world import World

START = "hand_set"
"""The weights that learning begins with."""


class NoLatent:
    """A planner that never plans: what is not executable as it stands is refused."""

    def fill(self, state: Bits, goal: Sequence[Cube]) -> Answer:
        """Nothing, where the goal holds."""
        if any(cube.holds(state) for cube in goal):
            return Filled((), state, 0)
        return Unreachable("it would need instructions that nobody said")


class Crf:
    """The energy and its inference.

    Args:
        learned: Whether the weights are learned; otherwise they are those set by hand.
        latent: Whether the planner may add what was left unsaid; without it this is *No latent nodes*.
        pair_nouns: The extension of :mod:`tmd.veil.instantiate`.
        beam: As for :class:`~tmd.energy.infer.Inference`.
        trim: As there.
        proposals: How many plans are looked at for each training example.
        most_examples: At most so many training examples of each world are learned from, drawn at random.
        rounds: How often plans are proposed anew.
    """

    def __init__(
        self,
        *,
        learned: bool = True,
        latent: bool = True,
        pair_nouns: bool = True,
        beam: int = 3,
        trim: int | None = None,
        proposals: int = 10,
        most_examples: int = 60,
        rounds: int = 2,
    ) -> None:
        self.learned = learned
        self.latent = latent
        self.pair_nouns = pair_nouns
        self.beam = beam
        self.trim = trim
        self.proposals = proposals
        self.most_examples = most_examples
        self.rounds = rounds

    def fit(self, examples: Sequence[Example], data: Dataset, random: np.random.Generator) -> Self:
        """Build a library for each kind of world, and learn its weights."""
        self.libraries_ = libraries(examples, data)
        self.statistics_ = {world: count(library) for world, library in self.libraries_.items()}
        self._fillers: dict[str, Planner] = {}
        self.learned_: dict[str, Learned] = {}
        self.weights_ = dict.fromkeys(self.libraries_, named_weights(START))
        if self.learned:
            for world in self.libraries_:
                own = [e for e in examples if e.world == world]
                self.learned_[world] = self._learn(own, data, random)
                self.weights_[world] = self.learned_[world].weights
        return self

    def predict(self, example: Example, data: Dataset, random: np.random.Generator) -> Prediction:
        """The plan of least energy."""
        if example.world not in self.libraries_:
            return Prediction()
        library, statistics = self.libraries_[example.world], self.statistics_[example.world]
        plans = self._plans(example, data, library, statistics, self.weights_[example.world], top=1)
        return as_prediction(plans[0], self._clauses(example, data)) if plans else Prediction()

    def _learn(self, examples: Sequence[Example], data: Dataset, random: np.random.Generator) -> Learned:
        """Weights for one kind of world. A training example never sees templates of its own environment."""
        order = random.permutation(len(examples))[: self.most_examples]
        chosen = [examples[int(i)] for i in sorted(order)]
        whole = self.libraries_[chosen[0].world]
        held_out = {name: whole.without(name) for name in sorted({e.environment for e in chosen})}
        tables = {name: count(library) for name, library in held_out.items()}

        def propose(number: int, weights: Weights) -> list[tuple[RankedPlan, float]]:
            example = chosen[number]
            library, statistics = held_out[example.environment], tables[example.environment]
            plans = self._plans(example, data, library, statistics, weights, top=self.proposals)
            return [(plan, loss(plan, example, data.world(example.environment))) for plan in plans]

        return learn_weights(propose, len(chosen), named_weights(START), random, rounds=self.rounds)

    def _plans(
        self,
        example: Example,
        data: Dataset,
        library: Library,
        statistics: Statistics,
        weights: Weights,
        *,
        top: int,
    ) -> tuple[RankedPlan, ...]:
        world = data.world(example.environment)
        inference = Inference(
            world,
            library,
            Energy(weights, statistics, world),
            self._filler(example.environment, world),
            beam=self.beam,
            trim=self.trim,
            top=top,
            pair_nouns=self.pair_nouns,
        )
        return inference.infer(self._clauses(example, data), world.task.init).plans

    def _clauses(self, example: Example, data: Dataset) -> Sequence[Clause]:
        return parse(example.demonstration.text, data.lexicon).clauses

    def _filler(self, environment: str, world: World) -> Planner:
        if environment not in self._fillers:
            self._fillers[environment] = make(IN_PROCESS, world.task) if self.latent else NoLatent()
        return self._fillers[environment]


def as_prediction(plan: RankedPlan, clauses: Sequence[Clause]) -> Prediction:
    """A plan with what it does for each clause, and why."""
    served = tuple(
        Served(
            clause.text,
            clause.verb,
            tuple(step.instruction for step in choice.steps if step.latent),
            tuple(step.instruction for step in choice.steps if not step.latent),
            choice.source,
            choice.factors,
        )
        for clause, choice in zip(clauses, plan.choices, strict=True)
    )
    return Prediction(plan.instructions, served)


def loss(plan: RankedPlan, example: Example, world: World) -> float:
    """How far a plan is from what the person did, from 0 to 1: half IED, half END under the planning rules."""
    first = world.task.init
    mine, gold = first ^ plan.state, first ^ run(world, first, example.gold)
    same = (mine & gold).bit_count() / ((mine | gold).bit_count() + EPSILON) if mine or gold else 1.0
    return 1 - (ied(plan.instructions, example.gold) / 100 + same) / 2


def libraries(examples: Sequence[Example], data: Dataset) -> dict[str, Library]:
    """A library for each kind of world."""
    return {
        world: learn((e.demonstration for e in examples if e.world == world), data.world, data.lexicon)
        for world in sorted({example.world for example in examples})
    }
