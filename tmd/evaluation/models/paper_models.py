"""The model of the paper as rows of the table: full, its ablations, and the presets of :mod:`tmd.inference.config`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from statistics import median
from typing import Self
from weakref import WeakKeyDictionary

import numpy as np

from tmd.diagnostics import TmdError
from tmd.evaluation.metrics import EPSILON, ied
from tmd.evaluation.models.instruction_tree import InstructionTree
from tmd.evaluation.models.prediction import Prediction, Served
from tmd.evaluation.runs.dataset import Example, Worlds
from tmd.goals.sources.demonstrations import learn_goals
from tmd.goals.sources.table import GoalTable
from tmd.ground import infer, reader_of, restored_of
from tmd.inference.config import BAYES_RISK, GOALS, PAPER, PAPER_EXTENDED, PRESETS, InferenceConfig
from tmd.inference.energy import FIXED, NAMES, OURS, Energy, Statistics, Weights, count, named_weights
from tmd.inference.ranking import RankedPlan
from tmd.inference.weight_learning import Journal, Learned, learn_weights
from tmd.language import parse
from tmd.language.clause import Clause, Parsed
from tmd.library.library import Library, learn, whole
from tmd.planning.backends import IN_PROCESS, TaskPlanners, make
from tmd.planning.result import Planner
from tmd.readers.interface import Dialogue
from tmd.records.fit import WorldFit
from tmd.world.corpus import Corpus
from tmd.world.world import World, run

_SPOKEN = ("clause_distance", "parameter_cardinality", "inconsistent_end", "objects_not_touched")
"""The factors that read the clause."""
_LATENT = ("latent_description_length", "latent_instruction_prior", "latent_parameter_prior", "latent_inconsistent_end")
"""The factors of latent instructions."""
_BLIND = ("inconsistent_end", *_LATENT)
"""The factors that need to know what instructions do."""


_PLANNERS: WeakKeyDictionary[Worlds, dict[tuple[str, int], Planner]] = WeakKeyDictionary()
"""One planner for each environment of a data set, so that models share its answers."""


def planner_for(data: Worlds, environment: str, cap: int) -> Planner:
    """Return the planner of an environment, which gives up after ``cap`` generated states."""
    known = _PLANNERS.setdefault(data, {})
    if (environment, cap) not in known:
        known[environment, cap] = make(IN_PROCESS, data.world(environment).task, cap=cap)
    return known[environment, cap]


_POLICIES: WeakKeyDictionary[Worlds, dict[tuple[str | int, ...], InstructionTree]] = WeakKeyDictionary()
"""The policies of a data set that were learned last, by the examples: several rows are trained on the same ones."""
_KEPT = 4
"""Each has some megabytes of weights; rows with the same training set come one after another."""


def policy_of(examples: tuple[Example, ...], data: Worlds) -> InstructionTree:
    """Return the policy that examples teach."""
    known = _POLICIES.setdefault(data, {})
    key = tuple(e.id for e in examples)
    if key not in known:
        if len(known) >= _KEPT:
            del known[next(iter(known))]
        # its own seed: a model that is restored has the same policy
        known[key] = InstructionTree(grounded=True).fit(examples, data, np.random.default_rng(0))
    return known[key]


@dataclass(frozen=True, slots=True)
class _Taught:
    """The knowledge that examples teach, without the weights."""

    library: Library
    statistics: Statistics
    tree: InstructionTree | None
    goals: GoalTable | None


class Crf:
    """The energy and its inference.

    ``journal`` is where ``fit`` writes down how far it is, and goes on from.

    Its weights are ``learned``, or else those of ``config``: in ``rounds``, with ``proposals`` plans for each of at
    most ``most_examples`` training examples of each world, drawn at random.
    """

    def __init__(
        self,
        config: InferenceConfig = PAPER,
        *,
        learned: bool = True,
        proposals: int = 10,
        most_examples: int = 20,
        rounds: int = 2,
    ) -> None:
        self.config = config
        self.learned = learned
        self.proposals = proposals
        self.most_examples = most_examples
        self.rounds = rounds
        self.journal: Path | None = None
        self._taught: dict[str, _Taught] = {}

    @property
    def factors(self) -> tuple[str, ...]:
        """The factors that this model weighs."""
        config = self.config
        absent = (
            *(() if config.extended else OURS),
            *(() if config.policy else ("language_model", "policy_proposal")),
            *(() if config.language else _SPOKEN),
            *(() if config.knowledge else _BLIND),
            *(() if config.latent else _LATENT),
        )
        return tuple(name for name in NAMES if name not in absent)

    def fit(self, examples: Sequence[Example], data: Worlds, random: np.random.Generator) -> Self:
        """Build a library for each kind of world, and learn its weights."""

        def learn_world(world: str) -> Learned:
            return self._learn(world, [e for e in examples if e.world == world], data, random)

        return self._with_weights(examples, data, learn_world)

    def restore(self, examples: Sequence[Example], data: Worlds, saved: Mapping[str, WorldFit]) -> Self:
        """Return the model as :meth:`fit` left it: the library is built again, the weights are those ``saved``.

        Raises:
            TmdError: What was saved is not what this model learns.
        """

        def saved_world(world: str) -> Learned:
            kept = saved.get(world)
            hint = "remove fits/ of the run and run again"
            if kept is None:
                raise TmdError(f"what was learned for the world '{world}' is damaged", hint=hint)
            known = (*self.factors, *FIXED)
            strange = sorted(name for name, value in kept.weights.items() if value and name not in known)
            if strange:
                raise TmdError(f"weights of another model: {', '.join(strange)}", hint=hint)
            return Learned(Weights(kept.weights), tuple(point.given() for point in kept.curve))

        return self._with_weights(examples, data, saved_world)

    def _with_weights(self, examples: Sequence[Example], data: Worlds, weights: Callable[[str], Learned]) -> Self:
        """Teach the model all but its weights, which are then those that ``weights`` gives for each kind of world."""
        self._taught = {}
        self.learned_: dict[str, Learned] = {}
        self._without_text: dict[tuple[object, ...], tuple[RankedPlan, ...]] = {}
        tree = self._policy(examples, data)
        for world, library in libraries(examples, data).items():
            self._taught[world] = self._knowledge(world, library, tree, examples, data)
        if not self.config.language:
            self.steps_ = {world: _usual_steps(examples, world) for world in self._taught}
        start = named_weights(self.config.weights)
        mine = Weights({name: start[name] for name in (*self.factors, *FIXED)})
        self.weights_ = dict.fromkeys(self._taught, mine)
        for world in self._taught if self.learned else ():
            self.learned_[world] = weights(world)
            self.weights_[world] = self.learned_[world].weights
        return self

    def _knowledge(
        self, world: str, library: Library, tree: InstructionTree | None, examples: Sequence[Example], data: Worlds
    ) -> _Taught:
        """Return the knowledge of examples of one kind of world, of which the library is made already."""
        known = library if self.config.language else whole(library)
        demonstrations = (e.demonstration for e in examples if e.world == world)
        goals = learn_goals(demonstrations, data.world, data.lexicon) if self.config.goals else None
        return _Taught(known, count(known), tree, goals)

    def predict(self, example: Example, data: Worlds, random: np.random.Generator) -> Prediction:
        """Return the plan of least energy."""
        plans = self.plans(example, data, top=1)
        return as_prediction(plans[0], self._clauses(example, data)) if plans else Prediction()

    def plans(self, example: Example, data: Worlds, *, top: int) -> tuple[RankedPlan, ...]:
        """Return the best plans, cheapest first; none in a world that was not learned."""
        taught = self._taught.get(example.world)
        return () if taught is None else self._plans(example, data, taught, self.weights_[example.world], top=top)

    def _learn(self, name: str, examples: Sequence[Example], data: Worlds, random: np.random.Generator) -> Learned:
        """Return weights for one kind of world. A training example never sees what its own environment taught.

        What corrects a plan is learned from in any case. It sees what was known when that plan was proposed: all but
        itself, so that the plan is among the proposals again. (The policy is that of all examples.)
        """
        order = sorted(random.permutation(len(examples)).tolist(), key=lambda i: not _corrects(examples[i]))
        chosen = [examples[i] for i in sorted(order[: self.most_examples])]
        left_out = _groups(examples)
        held_out = {
            group: self._without(name, group, examples, data)
            for group in dict.fromkeys(left_out[e.id] for e in chosen if not _corrects(e))
        }

        def propose(number: int, weights: Weights) -> list[tuple[RankedPlan, float]]:
            example = chosen[number]
            taught = self._before(name, example) if _corrects(example) else held_out[left_out[example.id]]
            plans = self._plans(example, data, taught, weights, top=self.proposals)
            return [(plan, loss(plan, example, data.world(example.environment))) for plan in plans]

        journal = Journal(self.journal, name) if self.journal else None
        start = named_weights(self.config.weights)
        return learn_weights(
            propose, len(chosen), start, random, factors=self.factors, rounds=self.rounds, journal=journal
        )

    def _without(self, name: str, group: frozenset[str], examples: Sequence[Example], data: Worlds) -> _Taught:
        """Return the knowledge of the other examples."""
        others = [e for e in examples if e.demonstration.id not in group]
        library = self._taught[name].library.filtered(lambda template: template.source not in group)
        return self._knowledge(name, library, self._policy(others, data), others, data)

    def _before(self, name: str, example: Example) -> _Taught:
        """Return the knowledge of all examples but one."""
        own = example.demonstration.id
        library = self._taught[name].library.filtered(lambda template: template.source != own)
        return replace(self._taught[name], library=library, statistics=count(library))

    def _policy(self, examples: Sequence[Example], data: Worlds) -> InstructionTree | None:
        return policy_of(tuple(examples), data) if self.config.policy else None

    def _plans(
        self, example: Example, data: Worlds, taught: _Taught, weights: Weights, *, top: int
    ) -> tuple[RankedPlan, ...]:
        """Return the plans of inference. Without language they are the same for every example in an environment."""
        if self.config.language:
            return self._infer(example, data, taught, weights, top)
        key = example.environment, len(taught.library), tuple(weights.values.items()), top
        if key not in self._without_text:
            self._without_text[key] = self._infer(example, data, taught, weights, top)
        return self._without_text[key]

    def _infer(
        self, example: Example, data: Worlds, taught: _Taught, weights: Weights, top: int
    ) -> tuple[RankedPlan, ...]:
        config, world = self.config, data.world(example.environment)
        energy = Energy(weights, taught.statistics, world, akin=config.akin)
        policy = taught.tree.policy(example.environment, example.world, data) if taught.tree else None
        planner = planner_for(data, example.environment, config.cap)
        planners = TaskPlanners(world.task, planner, IN_PROCESS, config.cap)
        if config.goals:
            # a refused text is scored by what --guess makes of it: nothing at all would be compared with nothing
            config = replace(config, guess=True, orderly=False)
        if config.language:
            reader = reader_of(config, taught.library, taught.goals)
            dialogue = reader.begin(example.demonstration.text, world, world.task.init)
        else:
            dialogue = Dialogue(Parsed("", self._clauses(example, data)))
        # people who demonstrate leave doors open and things in their hands: plans are compared without such tidying
        restored = restored_of(world, taught.library, taught.goals, config, declared=False)
        return infer(
            dialogue, world, taught.library, energy, planners, config, policy=policy, restored=restored, top=top
        ).plans

    def _clauses(self, example: Example, data: Worlds) -> tuple[Clause, ...]:
        """Return the clauses of a text; without language, as many empty ones as people usually need."""
        if not self.config.language:
            return (Clause(""),) * self.steps_[example.world]
        return parse(example.demonstration.text, data.lexicon).clauses


def _groups(examples: Sequence[Example]) -> dict[str | int, frozenset[str]]:
    """Return for each example those to leave out: all of its environment, or itself where there is only one."""
    places = {e.environment for e in examples}
    if len(places) == 1:
        return {e.id: frozenset({e.demonstration.id}) for e in examples}
    by_place = {p: frozenset(e.demonstration.id for e in examples if e.environment == p) for p in places}
    return {e.id: by_place[e.environment] for e in examples}


def _corrects(example: Example) -> bool:
    """Return whether it is a correction of a plan that was proposed."""
    return example.demonstration.proposed is not None


def as_prediction(plan: RankedPlan, clauses: Sequence[Clause]) -> Prediction:
    """Return a plan with what it does for each clause, or for each step of it where the model has goals, and why."""
    numbers = [goal.clause for goal in plan.goals] if plan.goals else range(len(clauses))
    served = tuple(
        Served(
            clause.text,
            clause.verb,
            tuple(step.instruction for step in choice.steps if step.latent),
            tuple(step.instruction for step in choice.steps if not step.latent),
            choice.source,
            choice.factors,
        )
        for clause, choice in zip((clauses[number] for number in numbers), plan.choices, strict=True)
    )
    return Prediction(plan.instructions, served)


def loss(plan: RankedPlan, example: Example, world: World) -> float:
    """Return the distance of a plan from the demonstration, from 0 to 1: half IED, half END under the planning rules.

    It uses those rules even where the model does not know them. A plan that a person corrected has distance 1.
    """
    if plan.instructions == example.demonstration.proposed:
        return 1.0
    first = world.task.init
    mine, gold = (first ^ run(world, first, done) for done in (plan.instructions, example.gold))
    same = (mine & gold).bit_count() / ((mine | gold).bit_count() + EPSILON) if mine or gold else 1.0
    return 1 - (ied(plan.instructions, example.gold) / 100 + same) / 2


def libraries(examples: Sequence[Example], data: Worlds) -> dict[str, Library]:
    """Return a library for each kind of world."""
    return {
        world: learn((e.demonstration for e in examples if e.world == world), data.world, data.lexicon)
        for world in sorted({example.world for example in examples})
    }


def _usual_steps(examples: Sequence[Example], world: str) -> int:
    """Return the median number of segments with instructions in the demonstrations of a world."""
    done = [sum(bool(s.instructions) for s in e.demonstration.segments) for e in examples if e.world == world]
    return int(median(done)) if done else 0


ROWS: dict[str, Callable[[], Crf]] = {
    "no_nl": partial(Crf, replace(PAPER, language=False)),
    "no_domain": partial(Crf, replace(PAPER, knowledge=False)),
    "no_latent": partial(Crf, replace(PAPER, latent=False)),
    "full": Crf,
    "paper_extended_learned": partial(Crf, PAPER_EXTENDED),
    "goals_learned": partial(Crf, GOALS),
    "bayes_risk_plans": partial(Crf, replace(BAYES_RISK, drawn_candidates=False), learned=False),
    **{name: partial(Crf, PRESETS[name], learned=False) for name in reversed(list(PRESETS))},
}
"""The model of the paper with learned weights, its ablations, and the presets as they ship."""


def weights_of(corpus: Corpus, random: np.random.Generator) -> Learned:
    """Return weights for the model ``goals``, learned on all demonstrations of a domain.

    Raises:
        TmdError: A demonstration is wrong.
    """
    name = corpus.folder.name
    examples = [Example(d.id, d.task, name, d.environment, 0, d) for d in corpus.demonstrations()]
    return ROWS["goals_learned"]().fit(examples, corpus, random).learned_[name]
