"""The main path: turn a request and an environment into ranked, validated plans.

Read this first; each call goes to the package of that name (the boxes of Figure 3 of the paper)::

    corpus = open_corpus("kitchen")
    knowledge = known(corpus)                           # learned from the demonstrations, and kept
    world = corpus.world("kitchen1")
    for plan in ground("Boil some water in the pot.", world, knowledge.library, reward=knowledge.reward).plans:
        print(plan.energy, *plan.instructions)
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import lru_cache, partial
from typing import TypeAlias
from weakref import WeakKeyDictionary

from tmd.diagnostics import OptionError, Refusal, RefusalKind
from tmd.goals.sources.table import LEARNED, GoalTable, PutBack
from tmd.goals.tables import declared_goals
from tmd.goals.wording import Wording
from tmd.grounded import Grounded
from tmd.inference.bayes_risk import PLANS, decided
from tmd.inference.config import DEFAULT, PRESETS, InferenceConfig
from tmd.inference.energy import Energy, Weights, count, named_weights
from tmd.inference.goal_pass import Inference
from tmd.inference.policy.model import Policy, Reward
from tmd.inference.proposers import proposers_of
from tmd.inference.ranking import Inferred, RankedPlan
from tmd.language.lexicon.lexicon import Lexicon
from tmd.library.library import Library
from tmd.pddl.grounding.ground_task import ground_condition
from tmd.pddl.model import TRUE, Atom, Formula
from tmd.pddl.task import Cube
from tmd.pddl.validator import validate
from tmd.planning.backends import IN_PROCESS, TaskPlanners, make
from tmd.planning.gap_filler import GapFiller
from tmd.planning.result import Planner
from tmd.readers.interface import Dialogue, Question, Reader
from tmd.readers.rules import RuleReader
from tmd.world.world import World

# Conditions of objects, each as a disjunction of cubes.
Restored: TypeAlias = tuple[tuple[Cube, ...], ...]
# Asks the user a question; returns the number of the option, or ``None`` where there is no answer.
Ask = Callable[[Question], int | None]


def ground(
    request: str,
    world: World,
    library: Library,
    weights: Weights | None = None,
    *,
    reward: Reward | None = None,
    goals: GoalTable | None = None,
    config: InferenceConfig = PRESETS[DEFAULT],
    planner: str = IN_PROCESS,
    top: int = 1,
    reader: Reader | None = None,
    ask: Ask | None = None,
) -> Grounded:
    """Ground ``request`` in ``world``.

    Args:
        request: The user's words.
        world: The environment.
        library: The templates.
        weights: The weights of the factors; by default those of the preset.
        reward: The learned policy; without it the preset has none.
        goals: The goals that demonstrations teach, beside those that the lexicon declares.
        config: The preset.
        planner: The planner that fills in what was left unsaid.
        top: The number of distinct plans.
        reader: The reader; by default the offline reader of grammar and lexicon.
        ask: Asks the user where two readings differ; without it the likeliest is taken.

    Raises:
        TmdError: The planner is unknown or not installed, the reader cannot work, the preset has no goals and the
            reader is not the default, or the lexicon is wrong.
    """
    if reader is not None and not config.goals:
        raise OptionError(
            "this model plans without goals, so only the rules can read for it", hint="leave --reader out"
        )
    reader = reader or reader_of(config, library, goals)
    energy = Energy(weights or named_weights(config.weights), count(library), world, akin=config.akin)
    policy = Policy(reward, world) if config.policy and reward is not None else None
    planners = TaskPlanners(world.task, _quick(planner, world, config.cap), planner, config.cap)
    restored = restored_of(world, library, goals, config)

    def inferred(dialogue: Dialogue, chosen: Mapping[int, Formula]) -> Inferred:
        further = partial(infer, policy=policy, restored=restored, top=top, chosen=chosen)
        return further(dialogue, world, library, energy, planners, config)

    dialogue = reader.begin(request, world, world.task.init)
    found, question = _asked(dialogue, inferred, ask or _nobody)
    while (objection := _objection(reader, dialogue, found, world)) is not None:
        again = reader.revise(dialogue, objection.message)
        if again is None:
            number = found.refused[0] if found.refused is not None else None
            found = replace(found, plans=(), refused=(number, objection))
            break
        dialogue = again
        found, question = _asked(dialogue, inferred, ask or _nobody)
    return _grounded(dialogue, found, world, library, config, question)


def _grounded(
    dialogue: Dialogue,
    found: Inferred,
    world: World,
    library: Library,
    config: InferenceConfig,
    question: Question | None,
) -> Grounded:
    """Return the result, with the validator's verdict on each plan."""
    unseen = tuple(dict.fromkeys(c.verb for c in dialogue.clauses if not library.propose(c)))
    known = config.goals or len(unseen) < len(dialogue.clauses)
    wording = Wording(world.task.problem)
    plans = tuple(_worded(plan, wording) for plan in found.plans if plan.instructions or (known and dialogue.asks))
    verdicts = tuple(validate(world.task.problem, plan.instructions) for plan in plans)
    open_question = question if plans else None
    return Grounded(
        dialogue, plans, verdicts, found.rejected, unseen, world, library, config, found.refused, open_question
    )


def _worded(plan: RankedPlan, wording: Wording) -> RankedPlan:
    """Return a plan whose goals have words."""
    goals = (replace(g, words=wording.goal(g.formula)) if g.formula not in (None, TRUE) else g for g in plan.goals)
    return replace(plan, goals=tuple(goals))


def reader_of(config: InferenceConfig, library: Library, goals: GoalTable | None) -> RuleReader:
    """Return the offline reader of a preset; its dialogues have no goals where the preset has none."""
    sources = config.sources if config.goals else None
    return RuleReader(library.lexicon, goals, sources=sources, guess=config.guess)


@lru_cache(maxsize=16)
def restored_in(
    world: World,
    lexicon: Lexicon,
    learned: frozenset[PutBack] = frozenset(),
    unrestored: frozenset[PutBack] = frozenset(),
) -> tuple[tuple[Cube, ...], ...]:
    """Return what no plan leaves behind in an environment: each condition for each object, as cubes.

    ``learned`` is what demonstrations undo; it counts where the lexicon declares nothing. ``unrestored`` is what they
    leave as it came about, whatever the lexicon declares.
    """
    task, kinds = world.task, world.mentions.kinds
    declared = declared_goals(lexicon, task.problem.domain).restored
    found: list[tuple[Formula, str]] = []
    if declared or lexicon.restored is not None:
        kept = {(p.predicate, p.kind) for p in unrestored}
        found = [(c, name) for c in declared for name in sorted(kinds) if (_state_named(c), kinds[name]) not in kept]
    else:
        for name in sorted(kinds):
            found += [(Atom(p.predicate, ("?x",)), name) for p in sorted(learned) if p.kind == kinds[name]]
    cubes = (ground_condition(task, condition, {"?x": name}) for condition, name in found)
    return tuple(dict.fromkeys(each for each in cubes if each and Cube() not in each))


def _state_named(condition: Formula) -> str:
    """Return the predicate of a condition that is an atom of one thing; empty for others."""
    return condition.predicate if isinstance(condition, Atom) and len(condition.terms) == 1 else ""


def restored_of(
    world: World, library: Library, goals: GoalTable | None, config: InferenceConfig, *, declared: bool = True
) -> Restored:
    """Return what no plan of a preset leaves behind; without ``declared``, only what demonstrations undo."""
    if not config.goals:
        return ()
    lexicon = library.lexicon
    if not declared:
        lexicon = replace(lexicon, restored=None, base=replace(lexicon.base, restored=()))
    if goals is None or LEARNED not in config.sources:
        return restored_in(world, lexicon)
    return restored_in(world, lexicon, goals.put_back, goals.unrestored)


def _asked(
    dialogue: Dialogue, inferred: Callable[[Dialogue, Mapping[int, Formula]], Inferred], ask: Ask
) -> tuple[Inferred, Question | None]:
    """Return the plans, after asking every question that can be answered, and the question that was not answered.

    Of a reader's question that was not answered, the likeliest option that can be carried out is taken.
    """
    chosen: dict[int, Formula] = {}
    question = dialogue.question
    if question is not None:
        answer = ask(question)
        if answer is None:
            return _first_option(dialogue, inferred, question)
        chosen[question.step] = question.options[answer].formula
    while True:
        found = inferred(dialogue, chosen)
        if found.question is None or (answer := ask(found.question)) is None:
            return found, found.question
        chosen[found.question.step] = found.question.options[answer].formula


def _first_option(
    dialogue: Dialogue, inferred: Callable[[Dialogue, Mapping[int, Formula]], Inferred], question: Question
) -> tuple[Inferred, Question]:
    """Return the plans for the first option that has some, or else why the first has none."""
    first: Inferred | None = None
    for number, option in enumerate(question.options):
        found = inferred(dialogue, {question.step: option.formula})
        if found.plans:
            return found, replace(question, taken=number)
        first = first or found
    assert first is not None
    return first, question


def _nobody(question: Question) -> int | None:
    """Return ``None``: nobody is there to answer."""


def _objection(reader: Reader, dialogue: Dialogue, found: Inferred, world: World) -> Refusal | None:
    """Return why the plans of a dialogue are not acceptable, where the reader may do better."""
    if found.refused is not None:
        refusal = found.refused[1]
        proven = refusal.kind in (RefusalKind.IMPOSSIBLE, RefusalKind.CONTRADICTION)
        return refusal if proven and dialogue.refusal is None else None
    objection = reader.objection(dialogue, found.plans[0].instructions, world) if found.plans else None
    if objection is None:
        return None
    return Refusal(RefusalKind.NOT_UNDERSTOOD, f"the plan is not what was asked: {objection}")


_FILLERS: WeakKeyDictionary[World, dict[int, GapFiller]] = WeakKeyDictionary()


def _quick(name: str, world: World, cap: int) -> Planner:
    """Return the planner for gaps; the in-process planner is cached for each environment."""
    if name != IN_PROCESS:
        return make(name, world.task, cap=cap)
    known = _FILLERS.setdefault(world, {})
    if cap not in known:
        known[cap] = GapFiller(world.task, cap=cap)
    known[cap].forget()
    return known[cap]


def infer(
    dialogue: Dialogue,
    world: World,
    library: Library,
    energy: Energy,
    planners: TaskPlanners,
    config: InferenceConfig,
    *,
    policy: Policy | None = None,
    restored: Restored = (),
    top: int = 1,
    chosen: Mapping[int, Formula] | None = None,
) -> Inferred:
    """Return the plans for a request as it was read, here and in the experiments."""
    by_risk = config.samples > 0 and policy is not None
    proposers = proposers_of(config, world, library, energy, policy)
    inference = Inference(world, energy, planners, proposers, config, restored)
    found = inference.infer(dialogue, world.task.init, max(top, PLANS) if by_risk else top, chosen)
    if not by_risk:
        return found
    assert policy is not None
    return decided(found, dialogue.clauses, world, policy, planners.quick(world.task), config, top)
