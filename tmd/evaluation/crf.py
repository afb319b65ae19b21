"""The model of the paper as rows of the table: full, its ablations, and our variants of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from statistics import median
from typing import Any, Self
from weakref import WeakKeyDictionary

import numpy as np

from tmd.energy.energy import Energy
from tmd.energy.factors import AKIN
from tmd.energy.infer import FEW, Inference
from tmd.energy.journal import Journal
from tmd.energy.learn import Learned, learn_weights
from tmd.energy.plans import RankedPlan
from tmd.energy.statistics import Statistics, count
from tmd.energy.weights import NAMES, OURS, Weights, named_weights
from tmd.errors import TmdError
from tmd.evaluation.dataset import Example, Worlds
from tmd.evaluation.metrics import EPSILON, ied
from tmd.evaluation.prediction import Prediction, Served
from tmd.evaluation.tree import InstructionTree
from tmd.language import Clause, parse
from tmd.pddl.task import Bits, Cube
from tmd.planning.backends import IN_PROCESS, make
from tmd.planning.filler import QUICK
from tmd.planning.result import Answer, Filled, Planner, Unreachable
from tmd.veil.corpus import Corpus
from tmd.veil.library import Library, learn, run, whole
from tmd.veil.world import World

_SPOKEN = ("nl", "pcc", "cons", "cover")
"""The factors that read the clause."""
_LATENT = ("latent_dscpl", "latent_inpr", "latent_para", "latent_cons")
"""The factors of what was left unsaid."""
_BLIND = ("cons", *_LATENT)
"""The factors that need to know what instructions do."""


class NoLatent:
    """A planner that never plans: what is not executable as it stands is refused."""

    def fill(self, state: Bits, goal: Sequence[Cube]) -> Answer:
        """Nothing, where the goal holds."""
        if any(cube.holds(state) for cube in goal):
            return Filled((), state, 0)
        return Unreachable("it would need instructions that nobody said")


_PLANNERS: WeakKeyDictionary[Worlds, dict[str, Planner]] = WeakKeyDictionary()
"""One planner for each environment of a data set: what one model has asked, no other has to ask again.

Its searches are short: what people leave unsaid is, and a candidate that needs more is not the best one.
"""


def planner_for(data: Worlds, environment: str) -> Planner:
    """The planner of an environment."""
    known = _PLANNERS.setdefault(data, {})
    if environment not in known:
        known[environment] = make(IN_PROCESS, data.world(environment).task, cap=QUICK)
    return known[environment]


@dataclass(frozen=True, slots=True)
class _Taught:
    """What examples teach, but for the weights."""

    library: Library
    statistics: Statistics
    tree: InstructionTree | None


class Crf:
    """The energy and its inference.

    Args:
        learned: Whether the weights are learned; otherwise they are those named by ``start``.
        start: The weights that learning begins with.
        latent: Whether the planner may add what was left unsaid; without it this is *No latent nodes*.
        knowledge: Whether the robot knows what its instructions need and do; without it *No Domain Knowledge*.
        language: Whether the robot hears what is said; without it *No NL Instructions*: as many steps as the median
            of the demonstrations has, each by any template.
        extended: Our extensions: nouns paired in order of mention, akin nouns, Δ_cover.
        generate: A log-linear policy, learned from the same demonstrations, proposes sequences as well and judges all
            candidates by the words of the clause (Δ_words).
        state: The planner proposes the shortest way to what the clause states as well, and all candidates are judged
            by whether it holds in the end (Δ_stated).
        beam: As for :class:`~tmd.energy.infer.Inference`.
        trim: As there.
        proposals: How many plans are looked at for each training example.
        most_examples: At most so many training examples of each world are learned from, drawn at random.
        rounds: How often plans are proposed anew.
        journal: Where ``fit`` writes down how far it is, and goes on from; may be set later.
    """

    def __init__(
        self,
        *,
        learned: bool = True,
        start: str = "original",
        latent: bool = True,
        knowledge: bool = True,
        language: bool = True,
        extended: bool = False,
        generate: bool = False,
        state: bool = False,
        beam: int = 3,
        trim: int | None = None,
        proposals: int = 10,
        most_examples: int = 20,
        rounds: int = 2,
        journal: Path | None = None,
    ) -> None:
        self.learned = learned
        self.start = start
        self.latent = latent
        self.knowledge = knowledge
        self.language = language
        self.extended = extended
        self.generate = generate
        self.state = state
        self.beam = beam
        self.trim = trim
        self.proposals = proposals
        self.most_examples = most_examples
        self.rounds = rounds
        self.journal = journal

    @property
    def factors(self) -> tuple[str, ...]:
        """The factors that this model weighs."""
        absent = (
            *(() if self.extended else OURS),
            *(() if self.generate else ("words", "generated")),
            *(() if self.state else ("stated",)),
            *(() if self.language else _SPOKEN),
            *(() if self.knowledge else _BLIND),
            *(() if self.latent else _LATENT),
        )
        return tuple(name for name in NAMES if name not in absent)

    def fit(self, examples: Sequence[Example], data: Worlds, random: np.random.Generator) -> Self:
        """Build a library for each kind of world, and learn its weights."""
        self._prepare(examples, data)
        for world in self.libraries_ if self.learned else ():
            own = [e for e in examples if e.world == world]
            self.learned_[world] = self._learn(world, own, data, random)
            self.weights_[world] = self.learned_[world].weights
        return self

    def restore(self, examples: Sequence[Example], data: Worlds, saved: dict[str, Any]) -> Self:
        """The model as :meth:`fit` left it: the library is built again, the weights are those ``saved``.

        Raises:
            TmdError: What was saved is not what this model learns.
        """
        self._prepare(examples, data)
        for world in self.libraries_ if self.learned else ():
            self.learned_[world] = self._kept(world, saved)
            self.weights_[world] = self.learned_[world].weights
        return self

    def _kept(self, world: str, saved: dict[str, Any]) -> Learned:
        try:
            kept = saved["worlds"][world]
            weights = {str(name): float(value) for name, value in kept["weights"].items()}
            curve = tuple(dict(point) for point in kept["curve"])
        except (KeyError, TypeError, ValueError, AttributeError):
            raise TmdError(
                f"what was learned for the world '{world}' is damaged", hint="remove fits/ of the run and run again"
            ) from None
        strange = sorted(name for name, value in weights.items() if value and name not in self.factors)
        if strange:
            raise TmdError(
                f"weights of another model: {', '.join(strange)}", hint="remove fits/ of the run and run again"
            )
        return Learned(Weights(weights), curve)

    def predict(self, example: Example, data: Worlds, random: np.random.Generator) -> Prediction:
        """The plan of least energy."""
        plans = self.plans(example, data, top=1)
        return as_prediction(plans[0], self._clauses(example, data)) if plans else Prediction()

    def plans(self, example: Example, data: Worlds, *, top: int) -> tuple[RankedPlan, ...]:
        """The best plans, cheapest first; none in a world that was not learned."""
        if example.world not in self.libraries_:
            return ()
        taught = _Taught(self.libraries_[example.world], self.statistics_[example.world], self.tree_)
        return self._plans(example, data, taught, self.weights_[example.world], top=top)

    def _prepare(self, examples: Sequence[Example], data: Worlds) -> None:
        self.libraries_ = libraries(examples, data)
        if not self.language:
            self.libraries_ = {world: whole(library) for world, library in self.libraries_.items()}
            self.steps_ = {world: _usual_steps(examples, world) for world in self.libraries_}
            self._told_nothing: dict[tuple[object, ...], tuple[RankedPlan, ...]] = {}
        self.statistics_ = {world: count(library) for world, library in self.libraries_.items()}
        self.learned_: dict[str, Learned] = {}
        self.tree_ = self._policy(examples, data)
        start = named_weights(self.start)
        mine = Weights({name: start[name] for name in self.factors})
        self.weights_ = dict.fromkeys(self.libraries_, mine)

    def _learn(self, name: str, examples: Sequence[Example], data: Worlds, random: np.random.Generator) -> Learned:
        """Weights for one kind of world. A training example never sees what its own environment taught.

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
        start = named_weights(self.start)
        return learn_weights(
            propose, len(chosen), start, random, factors=self.factors, rounds=self.rounds, journal=journal
        )

    def _without(self, name: str, group: frozenset[str], examples: Sequence[Example], data: Worlds) -> _Taught:
        """What the other examples teach."""
        others = [e for e in examples if e.demonstration.id not in group]
        library = self.libraries_[name].filtered(lambda template: template.source not in group)
        if not self.language:
            library = whole(library)
        return _Taught(library, count(library), self._policy(others, data))

    def _before(self, name: str, example: Example) -> _Taught:
        """What all but ``example`` teach."""
        own = example.demonstration.id
        library = self.libraries_[name].filtered(lambda template: template.source != own)
        return _Taught(library, count(library), self.tree_)

    def _policy(self, examples: Sequence[Example], data: Worlds) -> InstructionTree | None:
        # its own seed: a model that is restored has the same policy
        random = np.random.default_rng(0)
        return InstructionTree(grounded=True).fit(examples, data, random) if self.generate else None

    def _plans(
        self,
        example: Example,
        data: Worlds,
        taught: _Taught,
        weights: Weights,
        *,
        top: int,
    ) -> tuple[RankedPlan, ...]:
        """What inference finds. Told nothing it finds the same for every example in an environment."""
        infer = partial(self._infer, example, data, taught, weights, top=top)
        if self.language:
            return infer()
        key = example.environment, len(taught.library), tuple(weights.values.items()), top
        if key not in self._told_nothing:
            self._told_nothing[key] = infer()
        return self._told_nothing[key]

    def _infer(
        self,
        example: Example,
        data: Worlds,
        taught: _Taught,
        weights: Weights,
        *,
        top: int,
    ) -> tuple[RankedPlan, ...]:
        world = data.world(example.environment)
        inference = Inference(
            world,
            taught.library,
            Energy(weights, taught.statistics, world, akin=AKIN if self.extended else 0.0),
            planner_for(data, example.environment) if self.latent else NoLatent(),
            beam=self.beam,
            trim=self.trim,
            top=top,
            pair_nouns=self.extended,
            knowledge=self.knowledge,
            policy=taught.tree.policy(example.environment, example.world, data) if taught.tree else None,
            plan_stated=self.state,
            few=FEW if self.state else 0.0,
        )
        return inference.infer(self._clauses(example, data), world.task.init).plans

    def _clauses(self, example: Example, data: Worlds) -> Sequence[Clause]:
        if not self.language:
            return [Clause("")] * self.steps_[example.world]
        return parse(example.demonstration.text, data.lexicon).clauses


def _groups(examples: Sequence[Example]) -> dict[str | int, frozenset[str]]:
    """For each example those that must teach it nothing: all of its environment, or it alone where there is but one."""
    places = {e.environment for e in examples}
    if len(places) == 1:
        return {e.id: frozenset({e.demonstration.id}) for e in examples}
    by_place = {p: frozenset(e.demonstration.id for e in examples if e.environment == p) for p in places}
    return {e.id: by_place[e.environment] for e in examples}


def _corrects(example: Example) -> bool:
    """Whether it is a correction of a plan that was proposed."""
    return example.demonstration.proposed is not None


def as_prediction(plan: RankedPlan, clauses: Sequence[Clause]) -> Prediction:
    """A plan with what it does for each clause, and why."""
    served = tuple(
        Served(
            clause.text,
            clause.verb,
            tuple(step.instruction for step in choice.steps if step.latent),
            tuple(step.instruction for step in choice.steps if not step.latent),
            choice.source,
            choice.factors,
        )
        for clause, choice in zip(clauses, plan.choices, strict=True)
    )
    return Prediction(plan.instructions, served)


def loss(plan: RankedPlan, example: Example, world: World) -> float:
    """How far a plan is from what the person did, from 0 to 1: half IED, half END under the planning rules.

    The one who judges knows those rules, whatever the robot knows. A plan that a person corrected is as far as can be.
    """
    if plan.instructions == example.demonstration.proposed:
        return 1.0
    first = world.task.init
    mine, gold = (first ^ run(world, first, done) for done in (plan.instructions, example.gold))
    same = (mine & gold).bit_count() / ((mine | gold).bit_count() + EPSILON) if mine or gold else 1.0
    return 1 - (ied(plan.instructions, example.gold) / 100 + same) / 2


def libraries(examples: Sequence[Example], data: Worlds) -> dict[str, Library]:
    """A library for each kind of world."""
    return {
        world: learn((e.demonstration for e in examples if e.world == world), data.world, data.lexicon)
        for world in sorted({example.world for example in examples})
    }


def _usual_steps(examples: Sequence[Example], world: str) -> int:
    """The median number of segments with instructions in the demonstrations of a world."""
    done = [sum(bool(s.instructions) for s in e.demonstration.segments) for e in examples if e.world == world]
    return int(median(done)) if done else 0


ROWS: dict[str, Callable[[], Crf]] = {
    "no_nl": partial(Crf, language=False),
    "no_domain": partial(Crf, knowledge=False),
    "no_latent": partial(Crf, latent=False),
    "full": Crf,
    "hand_set": partial(Crf, learned=False),
    "extended": partial(Crf, extended=True, start="hand_set"),
    "generating": partial(Crf, learned=False, extended=True, generate=True, start="generating"),
    "stating": partial(Crf, learned=False, extended=True, generate=True, state=True, start="stating"),
    "stating_learned": partial(Crf, extended=True, generate=True, state=True, start="stating"),
    "extended_hand_set": partial(Crf, learned=False, extended=True, start="hand_set"),
}
"""The model of the paper, its ablations, and our variants."""


def weights_of(corpus: Corpus, random: np.random.Generator) -> Learned:
    """Weights for the model ``stating``, learned on all demonstrations of a domain.

    Raises:
        TmdError: A demonstration is wrong.
    """
    name = corpus.folder.name
    examples = [Example(d.id, d.task, name, d.environment, 0, d) for d in corpus.demonstrations()]
    return ROWS["stating_learned"]().fit(examples, corpus, random).learned_[name]
