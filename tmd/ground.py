"""The main path: what a person says, and a world, become ranked plans that PDDL vouches for.

Read this first; each call goes to the room of that name (the boxes of Figure 3 of the paper)::

    corpus = open_corpus("kitchen")
    knowledge = study(corpus)                           # or what `tmd learn` saved: recall(corpus)
    world = corpus.world("kitchen1")
    for plan in ground("Boil some water in the pot.", world, knowledge.library, reward=knowledge.reward).plans:
        print(plan.energy, *plan.instructions)
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

from tmd.energy.energy import Energy
from tmd.energy.factors import AKIN
from tmd.energy.infer import FEW, Inference
from tmd.energy.plans import RankedPlan, Refusal
from tmd.energy.statistics import count
from tmd.energy.weights import Weights, named_weights
from tmd.errors import TmdError
from tmd.language import parse
from tmd.language.clause import Parsed
from tmd.pddl.syntax import nearest
from tmd.pddl.validator import Verdict, validate
from tmd.planning.backends import IN_PROCESS, last_resort, make
from tmd.planning.filler import QUICK
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


@dataclass(frozen=True, slots=True)
class Model:
    """Which energy is minimised: the paper's, or one with extensions of ours.

    Attributes:
        weights: The name of its weights.
        extended: Nouns paired in order of mention, akin nouns, Δ_cover.
        generate: A policy, learned from the same demonstrations, proposes as well (Δ_words).
        state: The planner proposes ways to what the clause states as well (Δ_stated).
    """

    weights: str
    extended: bool = True
    generate: bool = False
    state: bool = False


MODELS: Mapping[str, Model] = {
    "stating": Model("stating", generate=True, state=True),
    "generating": Model("generating", generate=True),
    "extended": Model("hand_set"),
    "paper": Model("original", extended=False),
}
"""The models by name, ours first; they are the rows of the experiments that do not learn their weights."""
DEFAULT = "stating"


def make_model(name: str) -> Model:
    """The model of that name.

    Raises:
        TmdError: There is none.
    """
    if name not in MODELS:
        raise TmdError(f"there is no model '{name}'", hint=nearest(name, list(MODELS), what="models"))
    return MODELS[name]


def ground(
    text: str,
    world: World,
    library: Library,
    weights: Weights | None = None,
    *,
    reward: Reward | None = None,
    model: Model = MODELS[DEFAULT],
    planner: str = IN_PROCESS,
    beam: int | None = 3,
    trim: int | None = None,
    top: int = 1,
) -> Grounded:
    """Ground ``text`` in ``world``.

    Args:
        text: What the person said.
        world: The environment.
        library: The templates.
        weights: What each factor counts for; those of the model where none are given.
        reward: What the policy was learned to be; without it the model has none.
        model: The energy.
        planner: Which planner fills in what was left unsaid.
        beam: How many environments are followed from clause to clause; ``None`` follows all.
        trim: How many leading instructions of a template may be dropped; ``None`` is any number.
        top: How many distinct plans are wanted.

    Raises:
        TmdError: The planner is unknown or not installed.
    """
    parsed = parse(text, library.lexicon)
    inference = Inference(
        world,
        library,
        Energy(weights or named_weights(model.weights), count(library), world, akin=AKIN if model.extended else 0.0),
        make(planner, world.task),
        beam=beam,
        trim=trim,
        top=top,
        pair_nouns=model.extended,
        policy=Policy(reward, world) if reward is not None and model.generate else None,
        plan_stated=model.state,
        few=FEW,
        guess=False,
        goal_filler=make(planner, world.task, cap=QUICK) if planner == IN_PROCESS else None,
        last_resort=partial(last_resort, world.task) if planner == IN_PROCESS else None,
    )
    inferred = inference.infer(parsed.clauses, world.task.init)
    unseen = tuple(dict.fromkeys(c.verb for c in parsed.clauses if not library.propose(c)))
    plans = tuple(plan for plan in inferred.plans if plan.instructions or len(unseen) < len(parsed.clauses))
    verdicts = tuple(validate(world.task.problem, plan.instructions) for plan in plans)
    return Grounded(parsed, plans, verdicts, inferred.refusals, unseen)
