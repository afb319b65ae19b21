"""Inference in one environment: one engine for all presets."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tmd.inference.config import InferenceConfig
from tmd.inference.energy import Energy
from tmd.inference.forward_pass import ForwardPass, InferenceSetup, Planners, Restoration
from tmd.inference.goal_pass import GoalPass
from tmd.inference.proposers import Proposer
from tmd.inference.ranking import Inferred
from tmd.pddl.model import Formula
from tmd.pddl.task import Bits
from tmd.readers.interface import Dialogue
from tmd.world.verb_clause import VerbClause
from tmd.world.world import World


class Inference:
    """Inference in one environment. Nothing of a request is kept between calls, so threads may share it.

    Args:
        world: The environment.
        energy: The factors with their weights.
        planners: The environment's planners.
        proposers: The sources of candidates; each also judges the candidates of the others.
        config: The preset.
        restoration: What people undo unasked.
    """

    def __init__(
        self,
        world: World,
        energy: Energy,
        planners: Planners,
        proposers: Sequence[Proposer],
        config: InferenceConfig,
        restoration: Restoration | None = None,
    ) -> None:
        self.setup = InferenceSetup(world, energy, planners, tuple(proposers), config, restoration or Restoration())

    def infer(
        self, dialogue: Dialogue, state: Bits, top: int = 1, chosen: Mapping[int, Formula] | None = None
    ) -> Inferred:
        """Return the ``top`` best distinct plans for a request.

        Args:
            dialogue: The request as it was read.
            state: The state in which it was made.
            top: The number of plans.
            chosen: The answers to questions: for steps, the goal that is meant.
        """
        if self.setup.config.goals:
            return GoalPass(self.setup, dialogue, top, chosen or {}).infer(state)
        return self.infer_clauses(dialogue.clauses, state, top)

    def infer_clauses(self, clauses: Sequence[VerbClause], state: Bits, top: int = 1) -> Inferred:
        """Return the ``top`` best distinct plans for clauses without goals: Algorithm 1 of the paper."""
        return ForwardPass(self.setup, clauses, self.setup.world.task, top).infer(state)
