"""The main path: what a person says, and a world, become ranked plans that PDDL vouches for.

Read this first; each call goes to the room of that name (the boxes of Figure 3 of the paper)::

    corpus = open_corpus("kitchen")
    knowledge = known(corpus)                           # learned from the demonstrations, and kept
    world = corpus.world("kitchen1")
    for plan in ground("Boil some water in the pot.", world, knowledge.library, reward=knowledge.reward).plans:
        print(plan.energy, *plan.instructions)
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

from tmd.energy.algorithm1 import Inference
from tmd.energy.config import DEFAULT, PRESETS, InferenceConfig
from tmd.energy.energy import Energy
from tmd.energy.plans import RankedPlan, Refusal
from tmd.energy.proposers import proposers_of
from tmd.energy.statistics import count
from tmd.energy.weights import Weights, named_weights
from tmd.language import parse
from tmd.language.clause import Parsed
from tmd.pddl.validator import Verdict, validate
from tmd.planning.backends import IN_PROCESS, last_resort, make
from tmd.policy.policy import Policy, Reward
from tmd.veil.library import Library
from tmd.veil.world import World


@dataclass(frozen=True, slots=True)
class Grounded:
    """A grounded text.

    Attributes:
        parsed: The clauses, and what of the text no clause accounts for.
        plans: The plans, cheapest first; empty where nothing could be grounded.
        verdicts: For each plan what the validator says of it.
        refusals: Candidates that cannot be executed here, and why.
        unseen: The verbs that no demonstration has, in order of mention.
    """

    parsed: Parsed
    plans: tuple[RankedPlan, ...]
    verdicts: tuple[Verdict, ...]
    refusals: tuple[Refusal, ...]
    unseen: tuple[str, ...]


def ground(
    text: str,
    world: World,
    library: Library,
    weights: Weights | None = None,
    *,
    reward: Reward | None = None,
    config: InferenceConfig = PRESETS[DEFAULT],
    planner: str = IN_PROCESS,
    top: int = 1,
) -> Grounded:
    """Ground ``text`` in ``world``.

    Args:
        text: What the person said.
        world: The environment.
        library: The templates.
        weights: What each factor counts for; those of the model where none are given.
        reward: What the policy was learned to be; without it the model has none.
        config: The model.
        planner: Which planner fills in what was left unsaid.
        top: How many distinct plans are wanted.

    Raises:
        TmdError: The planner is unknown or not installed.
    """
    parsed = parse(text, library.lexicon)
    energy = Energy(weights or named_weights(config.weights), count(library), world, akin=config.akin)
    policy = Policy(reward, world) if config.policy and reward is not None else None
    resort = partial(last_resort, world.task) if planner == IN_PROCESS else None
    proposers = proposers_of(config, world, library, energy, policy, resort)
    inference = Inference(world, energy, make(planner, world.task, cap=config.cap), proposers, config)
    inferred = inference.infer(parsed.clauses, world.task.init, top)
    unseen = tuple(dict.fromkeys(c.verb for c in parsed.clauses if not library.propose(c)))
    plans = tuple(plan for plan in inferred.plans if plan.instructions or len(unseen) < len(parsed.clauses))
    verdicts = tuple(validate(world.task.problem, plan.instructions) for plan in plans)
    return Grounded(parsed, plans, verdicts, inferred.refusals, unseen)
