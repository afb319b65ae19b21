"""Learning a policy from demonstrations: constraints, features, and the weights of a log-linear reward."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

import numpy as np

from tmd.inference.policy.features import (
    STOP,
    Features,
    Ints,
    KnownObjects,
    Menu,
    Node,
    Syntax,
    followers,
    learn_syntax,
    properties,
    steps,
)
from tmd.inference.policy.policy import Made, Reward, ascend, bag, likelihood, mentioned, nothing
from tmd.language.clause import Clause
from tmd.language.lexicon.lexicon import Lexicon
from tmd.pddl.model import Instruction
from tmd.veil.demonstration import Demonstration
from tmd.veil.library import lessons
from tmd.veil.world import World

_COVER = 0.99
"""This share of the training sequences is not longer than what is searched."""


class PolicyLesson(NamedTuple):
    """A demonstration as it is learned from: each clause (or none) with its well-formed instructions."""

    things: KnownObjects
    clauses: list[tuple[Clause | None, tuple[Instruction, ...]]]


def learn_policy(
    demonstrations: Iterable[Demonstration],
    world_of: Callable[[str], World],
    lexicon: Lexicon,
    random: np.random.Generator,
    *,
    grounded: bool = True,
    certain: float = 0.95,
    rounds: int = 8,
    rate: float = 0.2,
    ridge: float = 3.0,
    tell: Callable[[float], None] | None = None,
) -> Reward:
    """Learn the constraints, the features and their weights.

    A clause for which a demonstration has no instructions teaches nothing: most of them come from the alignment,
    which gives all that was done for a piece of text to one of its clauses.

    Args:
        demonstrations: The corpus.
        world_of: The world of an environment, by the environment's name.
        lexicon: The words of the domain.
        random: The order in which the data are gone through.
        grounded: Whether the reward also knows which objects the clause's nouns may mean.
        certain: From which share on what went before counts as needed (``learn_syntax``).
        rounds: How often the training data are gone through.
        rate: Step size of the ascent.
        ridge: Weight of the squared weights.
        tell: Is told which share of the ascent, which takes the longest, is done.
    """
    lessons = study(demonstrations, world_of, lexicon)
    sequences = [(lesson.things, [made for _, made in lesson.clauses]) for lesson in lessons]
    syntax = learn_syntax(sequences, certain=certain, cover=_COVER)
    features = number_features(lessons, syntax, grounded=grounded)
    menus: dict[KnownObjects, Menu] = {}
    data = []
    for lesson in lessons:
        if lesson.things not in menus:
            menus[lesson.things] = Menu(features, lesson.things, syntax.menu(lesson.things))
        data += steps_made(lesson, menus[lesson.things], grounded=grounded)
    theta = ascend(features, data, random, rounds=rounds, rate=rate, ridge=ridge, tell=tell)
    choices = max(sum(len(made.choices) for made in data), 1)
    before, after = (likelihood(features, weights, data) / choices for weights in (np.zeros_like(theta), theta))
    return Reward(features, theta, before, after)


def study(
    demonstrations: Iterable[Demonstration], world_of: Callable[[str], World], lexicon: Lexicon
) -> list[PolicyLesson]:
    """What each demonstration shows, clause by clause, without instructions that are not well-formed."""
    known: dict[str, KnownObjects] = {}
    found = []
    for demonstration in demonstrations:
        place = demonstration.environment
        if place not in known:
            known[place] = KnownObjects(world_of(place))
        things = known[place]
        pairs: list[tuple[Clause | None, tuple[Instruction, ...]]] = [
            (lesson.clause, tuple(i for i in lesson.instructions if things.well_formed(i)))
            for lesson in lessons(demonstration, world_of(place), lexicon)
        ]
        found.append(PolicyLesson(things, pairs))
    return found


def number_features(lessons: Sequence[PolicyLesson], syntax: Syntax, *, grounded: bool) -> Features:
    """Number the features that the training data have."""
    words: set[str] = set()
    seen: set[tuple[str, ...]] = set()
    for things, clauses in lessons:
        before: Instruction | None = None
        for clause, made in clauses:
            words.update(bag(clause, grounded=grounded) if clause is not None else ())
            for position, instruction in enumerate(made):
                words.update(followers(before, position, things))
                seen.update(properties(instruction, things))
                before = instruction
            words.update(followers(before, len(made), things))
    return Features(words, seen, syntax)


def steps_made(lesson: PolicyLesson, menu: Menu, *, grounded: bool) -> list[Made]:
    """The sequence of each clause as choices from the menu, with the STOP at its end."""
    found = []
    done: tuple[Instruction, ...] = ()
    earlier: list[Clause] = []
    for clause, made in lesson.clauses:
        if clause is not None and made:
            nodes = [Node(done, made[:length]) for length in range(len(made) + 1)]
            levels = mentioned(clause, earlier, lesson.things) if grounded else nothing(lesson.things)
            at = steps(menu, menu.features.known(bag(clause, grounded=grounded)), levels, nodes)
            choices: Ints = np.array([menu.index[choice] for choice in (*made, STOP)], np.int64)
            # the constraints are only almost always kept; what was done was possible
            at.allowed[np.arange(len(choices)), choices] = True
            found.append(Made(at, choices))
        if clause is not None:
            earlier.append(clause)
        done += made
    return found
