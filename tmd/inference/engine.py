"""Inference in one environment: one engine for all presets."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tmd.inference.forward_pass import ForwardPass, InferenceSetup
from tmd.inference.goal_pass import GoalPass
from tmd.inference.ranking import Inferred
from tmd.pddl.model import Formula
from tmd.pddl.task import Bits
from tmd.readers.interface import Dialogue
from tmd.world.verb_clause import VerbClause


@dataclass(frozen=True)
class Inference(InferenceSetup):
    """Inference in one environment. Nothing of a request is kept between calls, so threads may share it."""

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
        if self.config.goals:
            return GoalPass(self, dialogue, top, chosen or {}).infer(state)
        return self.infer_clauses(dialogue.clauses, state, top)

    def infer_clauses(self, clauses: Sequence[VerbClause], state: Bits, top: int = 1) -> Inferred:
        """Return the ``top`` best distinct plans for clauses without goals: Algorithm 1 of the paper."""
        return ForwardPass(self, clauses, self.world.task, top).infer(state)
