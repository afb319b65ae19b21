"""Instruction-Tree Search (section VII), after Bollini et al.: from words to instructions, the world unseen."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np

from tmd.evaluation.dataset import Dataset, Example
from tmd.evaluation.prediction import Prediction, by_clause
from tmd.evaluation.tree_features import (
    EARLIER,
    FIRST,
    MENTIONED,
    POSSIBLE,
    STOP,
    Features,
    Floats,
    Ints,
    Menu,
    Node,
    followers,
    properties,
    steps,
)
from tmd.evaluation.tree_reward import Made, ascend, likelihood, log_probabilities
from tmd.evaluation.tree_syntax import Syntax, Things, learn_syntax
from tmd.language import Clause, parse
from tmd.pddl.model import Instruction
from tmd.veil.library import lessons

_WORD = re.compile(r"[a-z0-9']+")
_COVER = 0.99
"""This share of the training sequences is not longer than what is searched."""
_DIGITS = 9
"""Rewards are rounded before they are compared, so that equal ones stay equal whatever the order of a sum."""
_NO_STATE = 0


@dataclass(frozen=True, slots=True)
class Reward:
    """What is learned of one kind of world.

    Attributes:
        features: The features, with the syntactical constraints.
        theta: Their weights.
        before: The mean log-likelihood of a training choice with all weights zero.
        after: The same with the weights learned.
    """

    features: Features
    theta: Floats
    before: float
    after: float


class InstructionTree:
    """A log-linear reward searches over the sequence of instructions for every clause.

    P(next instruction | words of the clause, sequence so far) ∝ exp(θ·φ) over what the syntactical constraints
    (:mod:`tmd.evaluation.tree_syntax`) allow; φ is in :mod:`tmd.evaluation.tree_features`. The reward of a
    sequence is its log-probability and a bonus for its length; a beam search finds the best one, clause by clause.
    Which objects there are is known, in which state they are is not: neither states nor preconditions are read.

    A clause for which the demonstration has no instructions teaches nothing: most of them come from the alignment,
    which gives all that was done for a piece of text to one of its clauses.

    Args:
        beam: How many sequences of a length are looked at further.
        bonus: Reward for each instruction. The likeliest sequence is shorter than the usual one; this makes up.
        slack: A sequence is given up when its reward is this much below that of the best complete one.
        certain: From which share on what went before counts as needed (``learn_syntax``).
        rounds: How often the training data are gone through.
        rate: Step size of the ascent.
        ridge: Weight of the squared weights.
    """

    def __init__(
        self,
        *,
        beam: int = 5,
        bonus: float = 0.5,
        slack: float = 3.0,
        certain: float = 0.95,
        rounds: int = 8,
        rate: float = 0.2,
        ridge: float = 3.0,
    ) -> None:
        self.beam = beam
        self.bonus = bonus
        self.slack = slack
        self.certain = certain
        self.rounds = rounds
        self.rate = rate
        self.ridge = ridge

    def fit(self, examples: Sequence[Example], data: Dataset, random: np.random.Generator) -> Self:
        """Learn constraints, features and weights for each kind of world."""
        self._menus: dict[str, Menu] = {}
        self.rewards_: dict[str, Reward] = {}
        for world in sorted({example.world for example in examples}):
            lessons = _lessons([e for e in examples if e.world == world], data)
            self.rewards_[world] = self._learn(lessons, random)
        return self

    def predict(self, example: Example, data: Dataset, random: np.random.Generator) -> Prediction:
        """The sequence of the greatest reward for each clause, one clause after the other."""
        reward = self.rewards_.get(example.world)
        if reward is None:
            return Prediction()
        menu = self._menu(example.environment, reward, data)
        earlier: list[Clause] = []
        served: list[tuple[Clause, tuple[Instruction, ...], str | None]] = []
        for clause in parse(example.demonstration.text, data.lexicon).clauses:
            done = tuple(i for _, made, _ in served for i in made)
            served.append((clause, self._search(reward, menu, clause, earlier, done), None))
            earlier.append(clause)
        return by_clause(served)

    def _learn(self, lessons: Sequence[_Lesson], random: np.random.Generator) -> Reward:
        sequences = [(lesson.things, [made for _, made in lesson.clauses]) for lesson in lessons]
        syntax = learn_syntax(sequences, certain=self.certain, cover=_COVER)
        features = _number(lessons, syntax)
        menus: dict[Things, Menu] = {}
        data = []
        for lesson in lessons:
            if lesson.things not in menus:
                menus[lesson.things] = Menu(features, lesson.things, syntax.menu(lesson.things))
            data += _steps_made(lesson, menus[lesson.things])
        theta = ascend(features, data, random, rounds=self.rounds, rate=self.rate, ridge=self.ridge)
        choices = max(sum(len(made.choices) for made in data), 1)
        before, after = (likelihood(features, weights, data) / choices for weights in (np.zeros_like(theta), theta))
        return Reward(features, theta, before, after)

    def _menu(self, environment: str, reward: Reward, data: Dataset) -> Menu:
        """The environment's instructions of a seen shape."""
        world = data.world(environment)
        menu = self._menus.get(environment)
        if menu is None or menu.things.world is not world:
            things = Things(world)
            menu = self._menus[environment] = Menu(reward.features, things, reward.features.syntax.menu(things))
        return menu

    def _search(
        self, reward: Reward, menu: Menu, clause: Clause, earlier: Sequence[Clause], done: tuple[Instruction, ...]
    ) -> tuple[Instruction, ...]:
        """Beam search; of equally good sequences the one that was found first."""
        features = reward.features
        levels = mentioned(clause, earlier, menu.things)
        menu = _with_mentioned(menu, levels)
        words = features.known(bag(clause))
        found: tuple[float, tuple[Instruction, ...]] = (-np.inf, ())
        beam: list[tuple[float, tuple[Instruction, ...]]] = [(0.0, ())]
        for length in range(features.syntax.longest + 1):
            at = steps(menu, words, levels, [Node(done, own) for _, own in beam])
            logs = np.round(log_probabilities(features, reward.theta, at), _DIGITS)
            longer = []
            for (total, own), row in zip(beam, logs, strict=True):
                if total + row[-1] > found[0]:
                    found = (float(total + row[-1]), own)
                best = np.argsort(-row[:-1], kind="stable")[: self.beam].tolist()
                longer += [(round(total + float(row[i]) + self.bonus, _DIGITS), (*own, menu.choices[i])) for i in best]
            longer.sort(key=lambda node: -node[0])
            beam = [node for node in longer[: self.beam] if node[0] >= found[0] - self.slack and np.isfinite(node[0])]
            if not beam or length == features.syntax.longest:
                break
        return found[1]


class _Lesson(NamedTuple):
    """A demonstration as it is learned from: each clause (or none) with its well-formed instructions."""

    things: Things
    clauses: list[tuple[Clause | None, tuple[Instruction, ...]]]


def bag(clause: Clause) -> list[str]:
    """The words of a clause, its verb, what its pronouns stand for, and one that every clause has."""
    return ["", *_WORD.findall(clause.text.lower()), f"verb {clause.verb}", *clause.resolved()]


def mentioned(clause: Clause, earlier: Sequence[Clause], things: Things) -> Ints:
    """How far each thing is mentioned (0 not at all), by the evidence of words alone; with a last 0 for no thing."""
    numbers = {name: number for number, name in enumerate(things.kinds)}
    levels: Ints = np.zeros(len(numbers) + 1, np.int64)

    def mark(noun: str, likeliest: int, others: int) -> None:
        matches = things.world.mentions.of(noun, _NO_STATE)
        for match in matches:
            level = likeliest if match.score == matches[0].score else others
            levels[numbers[match.name]] = max(levels[numbers[match.name]], level)

    for before in earlier:
        for noun in before.resolved():
            mark(noun, EARLIER, 0)
    for place, noun in enumerate(clause.resolved()):
        mark(noun, MENTIONED if place else FIRST, POSSIBLE)
    return levels


def _with_mentioned(menu: Menu, levels: Ints) -> Menu:
    """The menu, with instructions of no seen shape about what the clause mentions."""
    names = list(menu.things.kinds)
    about = [names[number] for number in np.flatnonzero(levels >= POSSIBLE)]
    more = set(menu.features.syntax.about(menu.things, about)) - set(menu.choices)
    return Menu(menu.features, menu.things, sorted({*menu.choices[:-1], *more})) if more else menu


def _lessons(examples: Sequence[Example], data: Dataset) -> list[_Lesson]:
    known: dict[str, Things] = {}
    found = []
    for example in examples:
        if example.environment not in known:
            known[example.environment] = Things(data.world(example.environment))
        things = known[example.environment]
        pairs: list[tuple[Clause | None, tuple[Instruction, ...]]] = [
            (lesson.clause, tuple(i for i in lesson.instructions if things.well_formed(i)))
            for lesson in lessons(example.demonstration, data.world(example.environment), data.lexicon)
        ]
        found.append(_Lesson(things, pairs))
    return found


def _number(lessons: Sequence[_Lesson], syntax: Syntax) -> Features:
    """Number the features that the training data have."""
    words: set[str] = set()
    seen: set[tuple[str, ...]] = set()
    for things, clauses in lessons:
        before: Instruction | None = None
        for clause, made in clauses:
            words.update(bag(clause) if clause is not None else ())
            for position, instruction in enumerate(made):
                words.update(followers(before, position, things))
                seen.update(properties(instruction, things))
                before = instruction
            words.update(followers(before, len(made), things))
    return Features(words, seen, syntax)


def _steps_made(lesson: _Lesson, menu: Menu) -> list[Made]:
    """The sequence of each clause as choices from the menu, with the STOP at its end."""
    found = []
    done: tuple[Instruction, ...] = ()
    earlier: list[Clause] = []
    for clause, made in lesson.clauses:
        if clause is not None and made:
            nodes = [Node(done, made[:length]) for length in range(len(made) + 1)]
            at = steps(menu, menu.features.known(bag(clause)), mentioned(clause, earlier, lesson.things), nodes)
            choices: Ints = np.array([menu.index[choice] for choice in (*made, STOP)], np.int64)
            # the constraints are only almost always kept; what was done was possible
            at.allowed[np.arange(len(choices)), choices] = True
            found.append(Made(at, choices))
        if clause is not None:
            earlier.append(clause)
        done += made
    return found
