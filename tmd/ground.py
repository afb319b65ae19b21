"""The main path: what a person says, and a world, become ranked plans that PDDL vouches for.

Read this first; each call goes to the room of that name (the boxes of Figure 3 of the paper)::

    corpus = Corpus(find_domain("kitchen"), find_root("problems") / "kitchen")
    library = learn(corpus.demonstrations(), corpus.world, corpus.lexicon)
    world = corpus.world("kitchen1")
    for plan in ground("Boil some water in the pot.", world, library).plans:
        print(plan.energy, *plan.instructions)
"""

from __future__ import annotations

from dataclasses import dataclass

from tmd.energy.energy import Energy
from tmd.energy.infer import Inference
from tmd.energy.plans import RankedPlan, Refusal
from tmd.energy.statistics import count
from tmd.energy.weights import Weights, named_weights
from tmd.language import parse
from tmd.language.clause import Parsed
from tmd.pddl.validator import Verdict, validate
from tmd.planning.backends import IN_PROCESS, make
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
        weights: What each factor counts for; those set by hand where none are given.
        planner: Which planner fills in what was left unsaid.
        beam: How many environments are followed from clause to clause; ``None`` follows all.
        trim: How many leading instructions of a template may be dropped; ``None`` is any number.
        top: How many distinct plans are wanted.

    Raises:
        TmdError: The planner is unknown or not installed.
    """
    parsed = parse(text, library.lexicon)
    filler = make(planner, world.task)
    energy = Energy(weights or named_weights("hand_set"), count(library), world)
    inference = Inference(world, library, energy, filler, beam=beam, trim=trim, top=top)
    inferred = inference.infer(parsed.clauses, world.task.init)
    unseen = tuple(dict.fromkeys(c.verb for c in parsed.clauses if not library.propose(c)))
    plans = tuple(plan for plan in inferred.plans if plan.instructions or len(unseen) < len(parsed.clauses))
    verdicts = tuple(validate(world.task.problem, plan.instructions) for plan in plans)
    return Grounded(parsed, plans, verdicts, inferred.refusals, unseen)
