"""What a policy was learned to be, in two files: names and constraints as JSON, the weights as an array of numpy."""

from __future__ import annotations

import io
from collections.abc import Mapping
from typing import Any

import numpy as np

from tmd.inference.policy.action_constraints import Syntax
from tmd.inference.policy.features import Features
from tmd.inference.policy.policy import Reward


def reward_to_json(reward: Reward) -> dict[str, Any]:
    """All but the weights."""
    features = reward.features
    return {
        "words": list(features.words),
        "properties": [list(name) for name in features.properties],
        "shapes": [[name, list(kinds)] for name, kinds in features.syntax.shapes],
        "needs": [[name, place, list(earlier)] for (name, place), earlier in features.syntax.needs.items()],
        "longest": features.syntax.longest,
        "before": reward.before,
        "after": reward.after,
    }


def reward_from_json(data: Mapping[str, Any], weights: bytes) -> Reward:
    """The same again.

    Raises:
        KeyError, TypeError, ValueError: It is none.
    """
    syntax = Syntax(
        tuple((name, tuple(kinds)) for name, kinds in data["shapes"]),
        {(name, place): tuple(earlier) for name, place, earlier in data["needs"]},
        data["longest"],
    )
    features = Features(data["words"], (tuple(name) for name in data["properties"]), syntax)
    theta = np.load(io.BytesIO(weights), allow_pickle=False)
    if theta.shape != (features.size,) or theta.dtype != np.float64:
        raise ValueError("the weights are of another policy")
    return Reward(features, theta, float(data["before"]), float(data["after"]))


def weights_bytes(reward: Reward) -> bytes:
    """The weights as a ``.npy`` file."""
    buffer = io.BytesIO()
    np.save(buffer, reward.theta, allow_pickle=False)
    return buffer.getvalue()
