"""The main path: what a person says, and a world, become ranked plans that PDDL vouches for.

Read this first; each call goes to the package of that name (the boxes of Figure 3 of the paper)::

    corpus = open_corpus("kitchen")
    knowledge = known(corpus)                           # learned from the demonstrations, and kept
    world = corpus.world("kitchen1")
    for plan in ground("Boil some water in the pot.", world, knowledge.library, reward=knowledge.reward).plans:
        print(plan.energy, *plan.instructions)
"""

from __future__ import annotations

from weakref import WeakKeyDictionary

from tmd.goals.sources.table import GoalTable
from tmd.goals.text_following import Follower, goal_reader
from tmd.grounded import Grounded
from tmd.inference.algorithm1 import Inference
from tmd.inference.bayes_risk import PLANS, decided
from tmd.inference.config import DEFAULT, PRESETS, InferenceConfig
from tmd.inference.energy import Energy, Weights, count, named_weights
from tmd.inference.goal_directed import GoalInference
from tmd.inference.policy import Policy, Reward
from tmd.inference.proposers import SequenceModel, proposers_of
from tmd.inference.ranking import Inferred
from tmd.language.clause import Clause, Parsed
from tmd.language.parser import ClauseParser, parse
from tmd.pddl.task import Task
from tmd.pddl.validator import validate
from tmd.planning.backends import IN_PROCESS, last_resort, make
from tmd.planning.gap_filler import GapFiller
from tmd.planning.result import Planner
from tmd.veil.library import Library
from tmd.veil.world import World


def ground(
    text: str,
    world: World,
    library: Library,
    weights: Weights | None = None,
    *,
    reward: Reward | None = None,
    goals: GoalTable | None = None,
    config: InferenceConfig = PRESETS[DEFAULT],
    planner: str = IN_PROCESS,
    top: int = 1,
    parser: ClauseParser = parse,
) -> Grounded:
    """Ground ``text`` in ``world``.

    Args:
        text: What the person said.
        world: The environment.
        library: The templates.
        weights: What each factor counts for; those of the model where none are given.
        reward: What the policy was learned to be; without it the model has none.
        goals: What verbs were learned to mean, beside what the lexicon declares.
        config: The model.
        planner: Which planner fills in what was left unsaid.
        top: How many distinct plans are wanted.
        parser: What reads the text.

    Raises:
        TmdError: The planner is unknown or not installed, or the lexicon declares something that is wrong.
    """
    parsed = parser(text, library.lexicon)
    energy = Energy(weights or named_weights(config.weights), count(library), world, akin=config.akin)
    policy = Policy(reward, world) if config.policy and reward is not None else None
    planners = TaskPlanners(world.task, _quick(planner, world, config.cap), planner, config)
    inferred = infer(parsed, world, library, energy, planners, config, policy=policy, goals=goals, top=top)
    unseen = tuple(dict.fromkeys(c.verb for c in parsed.clauses if not library.propose(c)))
    known = config.goals or len(unseen) < len(parsed.clauses)
    forbids = any(not (clause.result or clause.implied) for clause in parsed.constraints)
    asked = known and (parsed.clauses or forbids)  # to be told only what not to do asks for nothing
    plans = tuple(plan for plan in inferred.plans if plan.instructions or asked)
    verdicts = tuple(validate(world.task.problem, plan.instructions) for plan in plans)
    return Grounded(parsed, plans, verdicts, inferred.refusals, unseen, world, library, config, inferred.refused)


_FILLERS: WeakKeyDictionary[World, dict[int, GapFiller]] = WeakKeyDictionary()


def _quick(name: str, world: World, cap: int) -> Planner:
    """The planner for gaps: what the one in this process derives of an environment serves every text in it."""
    if name != IN_PROCESS:
        return make(name, world.task, cap=cap)
    known = _FILLERS.setdefault(world, {})
    if cap not in known:
        known[cap] = GapFiller(world.task, cap=cap)
    known[cap].forget()
    return known[cap]


def infer(
    parsed: Parsed,
    world: World,
    library: Library,
    energy: Energy,
    planners: TaskPlanners,
    config: InferenceConfig,
    *,
    policy: SequenceModel | None = None,
    goals: GoalTable | None = None,
    top: int = 1,
) -> Inferred:
    """The plans for clauses, here and in the experiments: Algorithm 1, with goals where the model has them."""
    wanted = max(top, PLANS) if config.samples and policy is not None else top
    found = _least_energy(parsed, world, library, energy, planners, config, policy, goals, wanted)
    if not config.samples or policy is None:
        return found
    return decided(found, parsed.clauses, world, policy, planners.quick(world.task), config, top)


def _least_energy(
    parsed: Parsed,
    world: World,
    library: Library,
    energy: Energy,
    planners: TaskPlanners,
    config: InferenceConfig,
    policy: SequenceModel | None,
    goals: GoalTable | None,
    top: int,
) -> Inferred:
    proposers = proposers_of(config, world, library, energy, policy)
    if not config.goals:
        inference = Inference(world, energy, planners.quick(world.task), proposers, config)
        return inference.infer(parsed.clauses, world.task.init, top)
    reader = goal_reader(world, library.lexicon, goals, sources=config.sources, guess=config.guess)
    follower = Follower(reader)

    def shown(clause: Clause) -> bool:
        return bool(library.propose(clause))

    directed = GoalInference(world, energy, proposers, config, follower, planners.quick, planners.resort, shown)
    return directed.infer(parsed, world.task.init, top)


class TaskPlanners:
    """Planners for an environment, and for it without what must not be done.

    Args:
        task: The environment.
        quick: Its planner for gaps.
        name: The name of that planner.
        config: The model.
    """

    def __init__(self, task: Task, quick: Planner, name: str, config: InferenceConfig) -> None:
        self._task = task
        self._quick = quick
        self._name = name
        self._config = config

    def quick(self, task: Task) -> Planner:
        """The planner for gaps."""
        return self._quick if task is self._task else make(self._name, task, cap=self._config.cap)

    def resort(self, task: Task) -> Planner:
        """The planner for what that one gave up on."""
        return last_resort(task) if self._name == IN_PROCESS else make(self._name, task)
