"""Learning a policy from demonstrations."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cache
from typing import NamedTuple

import numpy as np

from tmd.inference.policy.features import (
    STOP,
    Features,
    Floats,
    Ints,
    KnownObjects,
    Syntax,
    bag,
    context_of,
    followers,
    learn_syntax,
    properties,
)
from tmd.inference.policy.menu import FACT_PLACES, Menu, Node, Steps, steps
from tmd.inference.policy.model import Reward, log_probabilities, share_of_word
from tmd.library.library import lessons
from tmd.pddl.model import Instruction
from tmd.world.demonstration import Demonstration
from tmd.world.verb_clause import VerbClause
from tmd.world.world import World

# Sequences between two steps of the ascent.
_BATCH = 8
_SMALL = 1e-6
# Weight of the squared weights, of the paper's baseline and of a grounded policy.
_RIDGE = 3.0
# A grounded policy has a smaller weight for fewer demonstrations: what one or two of them show is imitated closely.
_MANY = 100
# Step size of the ascent.
_RATE = 0.2


class Made(NamedTuple):
    """A sequence of the training data: its steps, and the number of the choice that was made at each."""

    at: Steps
    choices: Ints


def likelihood(features: Features, theta: Floats, data: Sequence[Made], gradient: Floats | None = None) -> float:
    """Return the log-likelihood of the choices made, and add its gradient to ``gradient``."""
    total = 0.0
    for at, choices in data:
        rows = np.arange(len(choices))
        logs = log_probabilities(features, theta, at)
        total += float(logs[rows, choices].sum())
        if gradient is None:
            continue
        # observed features less expected ones
        rest = -np.exp(logs)
        rest[rows, choices] += 1
        parts, menu = features.parts(gradient), at.menu
        possible = at.open  # of the others nothing is expected
        having = rest[:, possible] @ menu.properties[possible]
        parts.local[at.context.words] += having.sum(axis=0)
        if parts.text is not None:
            parts.text[at.context.text] += share_of_word(at.context) * having.sum(axis=0)
        for words, row in zip(at.followers, having, strict=True):
            parts.local[words] += row
        weights = np.repeat(rest[at.allowed], at.pairs.shape[2])
        pairs, which = at.allowed_pairs
        parts.paired[pairs] += np.bincount(which, weights, minlength=len(pairs))
        parts.reals[:] += np.einsum("hc,hcr->r", rest, at.reals)
        if features.grounded:
            things = len(menu.things.numbers) + 1
            cells = menu.places * things + menu.args
            for row, allowed, facts in zip(rest, at.allowed, at.facts, strict=True):
                weights = np.repeat(row[allowed], menu.args.shape[1])
                named = np.bincount(cells[allowed].ravel(), weights, minlength=len(parts.facts) * things)
                parts.facts[:] += named.reshape(len(parts.facts), things) @ facts
    return total


def ascend(
    features: Features,
    data: Sequence[Made],
    random: np.random.Generator,
    *,
    rounds: int,
    rate: float,
    ridge: float,
    tell: Callable[[float], None] | None = None,
) -> Floats:
    """Maximise the log-likelihood less ridge/2 · Σ r θ², with r of :meth:`Features.ridge`.

    By stochastic gradient ascent from zero, with the step sizes of AdaGrad. ``tell`` is called with the share of the
    work that is done.
    """
    each = ridge * features.ridge()
    theta: Floats = np.zeros(features.size)
    squares: Floats = np.full(features.size, _SMALL)
    # there are a million weights: new arrays of that size would take longer than what is done with them
    gradient, change = np.empty_like(theta), np.empty_like(theta)
    for done in range(rounds):
        order = random.permutation(len(data)).tolist()
        for start in range(0, len(order), _BATCH):
            if tell is not None:
                tell((done + start / len(order)) / rounds)
            part = [data[number] for number in order[start : start + _BATCH]]
            np.multiply(theta, each, out=gradient)
            gradient *= -len(part) / len(data)
            likelihood(features, theta, part, gradient)
            squares += np.square(gradient, out=change)
            gradient *= rate
            theta += np.divide(gradient, np.sqrt(squares, out=change), out=change)
    return theta


class PolicyLesson(NamedTuple):
    """A demonstration as a lesson: each clause (or none) with its well-formed instructions."""

    things: KnownObjects
    clauses: list[tuple[VerbClause | None, tuple[Instruction, ...]]]


def learn_policy(
    demonstrations: Iterable[Demonstration],
    world_of: Callable[[str], World],
    random: np.random.Generator,
    *,
    grounded: bool = True,
    rounds: int = 8,
    tell: Callable[[float], None] | None = None,
) -> Reward:
    """Learn the constraints, the features and their weights.

    A clause for which a demonstration has no instructions teaches nothing: most of them come from the alignment, which
    gives all that was done for a piece of text to one of its clauses. A ``grounded`` reward also knows which objects
    the nouns of a clause may mean. ``rounds`` is the number of passes over the training data, in the order that
    ``random`` draws; ``tell`` is called with the share of the ascent, which takes the longest, that is done.
    """
    lessons = study(demonstrations, world_of)
    sequences = [(lesson.things, [made for _, made in lesson.clauses]) for lesson in lessons]
    syntax = learn_syntax(sequences)
    features = number_features(lessons, syntax, grounded=grounded)
    menu_of = cache(lambda things: Menu(features, things, syntax.menu(things)))
    data = [made for lesson in lessons for made in steps_made(lesson, menu_of(lesson.things))]
    ridge = _RIDGE * min(1.0, len(lessons) / _MANY) if grounded else _RIDGE
    theta = ascend(features, data, random, rounds=rounds, rate=_RATE, ridge=ridge, tell=tell)
    choices = max(sum(len(made.choices) for made in data), 1)
    before, after = (likelihood(features, weights, data) / choices for weights in (np.zeros_like(theta), theta))
    return Reward(features, theta, before, after)


def study(demonstrations: Iterable[Demonstration], world_of: Callable[[str], World]) -> list[PolicyLesson]:
    """Read the lessons of demonstrations, without instructions that are not well-formed."""
    things_of = cache(lambda place: KnownObjects(world_of(place)))
    found = []
    for demonstration in demonstrations:
        things = things_of(demonstration.environment)
        pairs: list[tuple[VerbClause | None, tuple[Instruction, ...]]] = [
            (lesson.clause, tuple(i for i in lesson.instructions if things.well_formed(i)))
            for lesson in lessons(demonstration, things.world, things.world.mentions.lexicon)
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
    atoms = [atom for things in {lesson.things for lesson in lessons} for atom in things.world.task.atoms]
    facts = {(atom.predicate, place) for atom in atoms for place in range(len(atom.args[:FACT_PLACES]))}
    return Features(words, seen, syntax, facts if grounded else ())


def steps_made(lesson: PolicyLesson, menu: Menu) -> list[Made]:
    """Return the sequence of each clause as choices from the menu, with the STOP at its end."""
    found = []
    done: tuple[Instruction, ...] = ()
    clauses = [clause for clause, _ in lesson.clauses if clause is not None]
    number = 0
    for clause, made in lesson.clauses:
        if clause is not None and made:
            nodes = [Node(done, made[:length]) for length in range(len(made) + 1)]
            choices: Ints = np.array([menu.index[choice] for choice in (*made, STOP)], np.int64)
            at = steps(menu, context_of(clauses, number, menu.features, menu.things), nodes, choices)
            found.append(Made(at, choices))
        number += clause is not None
        done += made
    return found
