"""What there is to know of a domain before anybody speaks: all of it comes from its demonstrations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tmd.energy.weights import Weights
from tmd.policy.learn import learn_policy
from tmd.policy.policy import Reward
from tmd.veil.corpus import Corpus
from tmd.veil.library import Library, learn

_SEED = 0
"""The policy's own: the same demonstrations teach the same."""


@dataclass(frozen=True, slots=True)
class Knowledge:
    """What was learned of a domain.

    Attributes:
        library: The templates.
        reward: What the policy was learned to be; ``None`` where there are no demonstrations.
        weights: Weights that were learned on the demonstrations, if any were.
    """

    library: Library
    reward: Reward | None = None
    weights: Weights | None = None


def study(corpus: Corpus, tell: Callable[[float], None] | None = None) -> Knowledge:
    """Learn library and policy from all demonstrations of a domain.

    Args:
        corpus: The domain.
        tell: Is told which share of the policy, which takes the longest, is learned.

    Raises:
        TmdError: A demonstration is wrong, or cannot be executed in its environment.
    """
    demonstrations = corpus.demonstrations()
    library = learn(demonstrations, corpus.world, corpus.lexicon)
    if not len(library):
        return Knowledge(library)
    random = np.random.default_rng(_SEED)
    return Knowledge(library, learn_policy(demonstrations, corpus.world, corpus.lexicon, random, tell=tell))
