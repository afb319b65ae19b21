"""What there is to know of a domain before anybody speaks: all of it comes from its demonstrations."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from tmd.goals.sources.demonstrations import learn_goals
from tmd.goals.sources.table import GoalTable
from tmd.inference.policy.policy import Reward
from tmd.inference.policy.training import learn_policy
from tmd.inference.weights import Weights
from tmd.veil.corpus import Corpus
from tmd.veil.demonstration import Demonstration
from tmd.veil.library import Library, learn

_SEED = 0
"""The policy's own: the same demonstrations teach the same."""
_LIBRARY = 0.15
"""The share of the work that the library is, roughly; the policy is the rest."""


@dataclass(frozen=True, slots=True)
class Knowledge:
    """What was learned of a domain.

    Attributes:
        library: The templates.
        reward: What the policy was learned to be; ``None`` where there are no demonstrations.
        weights: Weights that were learned on the demonstrations, if any were.
        goals: What verbs were learned to mean; ``None`` where there are no demonstrations.
    """

    library: Library
    reward: Reward | None = None
    weights: Weights | None = None
    goals: GoalTable | None = None


def study(corpus: Corpus, tell: Callable[[float], None] | None = None) -> Knowledge:
    """Learn library and policy from all demonstrations of a domain.

    Args:
        corpus: The domain.
        tell: Is told which share of the work is done.

    Raises:
        TmdError: A demonstration is wrong, or cannot be executed in its environment.
    """
    demonstrations = corpus.demonstrations()
    told = tell or _nobody
    library = learn(_counted(demonstrations, told), corpus.world, corpus.lexicon)
    if not len(library):
        return Knowledge(library)
    random = np.random.default_rng(_SEED)

    def on(share: float) -> None:
        told(_LIBRARY + (1 - _LIBRARY) * share)

    goals = learn_goals(demonstrations, corpus.world, corpus.lexicon)
    return Knowledge(library, learn_policy(demonstrations, corpus.world, corpus.lexicon, random, tell=on), goals=goals)


def _counted(demonstrations: Sequence[Demonstration], tell: Callable[[float], None]) -> Iterator[Demonstration]:
    """The demonstrations; ``tell`` is told how far they are taken."""
    for number, demonstration in enumerate(demonstrations):
        tell(_LIBRARY * number / len(demonstrations))
        yield demonstration


def _nobody(share: float) -> None:
    """Nobody wants to know."""
