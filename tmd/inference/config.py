"""Presets: the energy that inference minimises, and the extent of its search.

``tmd ground --model``, ``import tmd`` and the rows of the experiments take the same presets, so what ships is what was
measured. The ablations of the paper are presets with one thing changed (:mod:`tmd.evaluation.models.paper_models`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from tmd.diagnostics import TmdError
from tmd.pddl.reading.syntax import nearest
from tmd.short_repr import short_repr

AKIN = 0.75
"""Value of a noun, in extended presets, that differs from another only by a modifier."""


@short_repr(lambda config: f"with weights {config.weights}")
@dataclass(frozen=True, slots=True)
class InferenceConfig:
    """A preset: how clauses become plans.

    Attributes:
        weights: The name of the weights (``tmd/inference/data``); where weights are learned, those that learning begins
            with.
        extended: Whether the paper's factors and rules are extended: nouns paired in order of mention, akin nouns,
            Δ_cover.
        policy: Whether a policy, learned from the same demonstrations, proposes sequences beside the templates and
            judges all candidates by the words of the clause (Δ_words).
        goals: Whether each clause has a PDDL goal, which every plan for it must reach (:mod:`tmd.goals`).
        sources: Where the meaning of a clause may come from (:data:`tmd.goals.tables.SOURCES`).
        latent: Whether the planner may add unsaid instructions; without it this is *No latent nodes*.
        knowledge: Whether the robot knows preconditions and effects; without them *No Domain Knowledge*: every
            candidate counts as executable, nothing is added to it, and the environment stays as it was.
        language: Whether the robot reads the text; otherwise *No NL Instructions*. Rows of the experiments only.
        beam: Number of environments that each α_j keeps; ``None`` keeps all, which is exact.
        trim: Maximum number of leading instructions of a template that are trimmed; ``None`` for any number.
        generated: Number of sequences of the policy for each clause and environment.
        few: Number of templates below which the policy is trusted less than half: with n its judgement counts
            n / (n + ``few``), and its proposals are charged (n + ``few``) / n. Few demonstrations are better repeated
            as they were shown. 0 trusts it always.
        tried: Number of proposals of templates and policy that are completed to the goal of a clause.
        guess: Whether anything is proposed for a verb that has no templates; with goals, whether a plan may be made
            where the request cannot be done, or is not understood.
        cap: Generated states after which a search of the in-process planner gives up.
        last_resort: Whether planners that are content with any plan are asked for the goal of a clause where the
            optimal search gave up.
        close: The difference of energies up to which two readings of a request count as equally good, so that the user
            is asked which one is meant.
        samples: Number of sequences drawn from the policy, against which the expected loss of each plan decides
            (:mod:`tmd.inference.bayes_risk`); 0 decides by energy.
        orderly: Whether finished plans are put in order, things are taken back, and drinks are kept unmixed. People who
            demonstrate do so seldom, so the experiments compare plans without it, as without declared restoration.
        drawn_candidates: Whether those sequences are candidates as well, where no declared goal must be reached.
    """

    weights: str
    extended: bool = False
    policy: bool = False
    goals: bool = False
    latent: bool = True
    knowledge: bool = True
    language: bool = True
    beam: int | None = 3
    trim: int | None = None
    generated: int = 5
    sources: tuple[str, ...] = ("declared", "learned", "actions")  # not imported: the command line starts with this
    tried: int = 6
    few: float = 20.0
    guess: bool = False
    cap: int = 2_000  # what people leave unsaid is short: a candidate that needs more is not the best one
    last_resort: bool = True
    close: float = 10.0
    samples: int = 0
    orderly: bool = True
    drawn_candidates: bool = True

    @property
    def akin(self) -> float:
        """The value of akin nouns, as for :func:`tmd.inference.energy.clause_distance`."""
        return AKIN if self.extended else 0.0


PAPER = InferenceConfig("paper")
PAPER_EXTENDED = InferenceConfig("paper_extended", extended=True)
POLICY = InferenceConfig("policy", extended=True, policy=True)
GOALS = InferenceConfig("goals", extended=True, policy=True, goals=True, beam=1)
BAYES_RISK = replace(GOALS, sources=("declared",), samples=64)

PRESETS: Mapping[str, InferenceConfig] = {
    "goals": GOALS,
    "bayes_risk": BAYES_RISK,
    "policy": POLICY,
    "paper_extended": PAPER_EXTENDED,
    "paper": PAPER,
}
"""The models by name, from what ships by default to the paper's as printed. Each is a row of the experiments."""
DEFAULT = "goals"
_RENAMED = {"stating": "goals", "generating": "policy", "extended": "paper_extended"}


def preset(name: str) -> InferenceConfig:
    """Return the preset of that name.

    Raises:
        TmdError: There is none.
    """
    if name in _RENAMED:
        raise TmdError(f"the model '{name}' is now called '{_RENAMED[name]}'")
    if name not in PRESETS:
        raise TmdError(f"there is no model '{name}'", hint=nearest(name, list(PRESETS), what="models"))
    return PRESETS[name]
