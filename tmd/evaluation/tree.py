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
MOST = 12.0
"""The surprise of what training makes impossible."""


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


class Policy:
    """A learned reward in one environment.

    Args:
        reward: What was learned.
        menu: The environment's instructions of a seen shape.
        grounded: As for :class:`InstructionTree`; so are the rest.
        beam: How many sequences of a length are looked at further.
        bonus: Reward for each instruction.
        slack: How far below the best complete sequence one is still looked at.
    """

    def __init__(self, reward: Reward, menu: Menu, *, grounded: bool, beam: int, bonus: float, slack: float) -> None:
        self.reward = reward
        self.menu = menu
        self.grounded = grounded
        self.beam = beam
        self.bonus = bonus
        self.slack = slack
        self._last: tuple[tuple[object, ...], tuple[Menu, Ints, Ints]] | None = None

    def best(
        self, clause: Clause, earlier: Sequence[Clause], done: Sequence[Instruction], count: int = 1
    ) -> list[tuple[float, tuple[Instruction, ...]]]:
        """The ``count`` sequences of the greatest reward for a clause, by beam search, greatest first.

        Args:
            clause: The clause.
            earlier: The clauses before it.
            done: The instructions that were chosen for those.
            count: How many are wanted; at least one is found, perhaps the empty one.
        """
        features = self.reward.features
        menu, words, levels = self._read(clause, earlier)
        found: list[tuple[float, tuple[Instruction, ...]]] = []
        beam: list[tuple[float, tuple[Instruction, ...]]] = [(0.0, ())]
        for _ in range(features.syntax.longest + 1):
            at = steps(menu, words, levels, [Node(tuple(done), own) for _, own in beam])
            logs = np.round(log_probabilities(features, self.reward.theta, at), _DIGITS)
            longer = []
            for (total, own), row in zip(beam, logs, strict=True):
                found.append((float(total + row[-1]), own))
                following = np.argsort(-row[:-1], kind="stable")[: self.beam].tolist()
                longer += [
                    (round(total + float(row[i]) + self.bonus, _DIGITS), (*own, menu.choices[i])) for i in following
                ]
            found = sorted(found, key=lambda node: -node[0])[:count]
            worst = found[-1][0] if len(found) == count else -np.inf
            longer.sort(key=lambda node: -node[0])
            beam = [node for node in longer[: self.beam] if node[0] >= worst - self.slack and np.isfinite(node[0])]
            if not beam:
                break
        return found

    def surprise(
        self,
        clause: Clause,
        earlier: Sequence[Clause],
        done: Sequence[Instruction],
        instructions: Sequence[Instruction],
    ) -> float:
        """The mean of -ln P over ``instructions`` and the end of the sequence; each is at most :data:`MOST`."""
        menu, words, levels = self._read(clause, earlier)
        own = tuple(instructions)
        nodes = [Node(tuple(done), own[:length]) for length in range(len(own) + 1)]
        logs = log_probabilities(self.reward.features, self.reward.theta, steps(menu, words, levels, nodes))
        each = [
            min(MOST, -float(logs[row, menu.index[choice]])) if choice in menu.index else MOST
            for row, choice in enumerate((*own, STOP))
        ]
        return round(sum(each) / len(each), _DIGITS)

    def _read(self, clause: Clause, earlier: Sequence[Clause]) -> tuple[Menu, Ints, Ints]:
        """The choices, the clause's words, and how far it mentions things; that of the last clause is remembered."""
        key = tuple((c.text, c.verb, c.resolved()) for c in (clause, *earlier))
        if self._last is None or self._last[0] != key:
            self._last = key, self._reading(clause, earlier)
        return self._last[1]

    def _reading(self, clause: Clause, earlier: Sequence[Clause]) -> tuple[Menu, Ints, Ints]:
        words = self.reward.features.known(bag(clause, grounded=self.grounded))
        if not self.grounded:
            return self.menu, words, nothing(self.menu.things)
        levels = mentioned(clause, earlier, self.menu.things)
        return _with_mentioned(self.menu, levels), words, levels


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
        grounded: Whether the reward also knows which objects the clause's nouns may mean. The paper's baseline has
            the words alone; with this it is a row of ours.
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
        grounded: bool = False,
    ) -> None:
        self.beam = beam
        self.bonus = bonus
        self.slack = slack
        self.certain = certain
        self.rounds = rounds
        self.rate = rate
        self.ridge = ridge
        self.grounded = grounded

    def fit(self, examples: Sequence[Example], data: Dataset, random: np.random.Generator) -> Self:
        """Learn constraints, features and weights for each kind of world."""
        self._policies: dict[str, Policy] = {}
        self.rewards_: dict[str, Reward] = {}
        for world in sorted({example.world for example in examples}):
            lessons = _lessons([e for e in examples if e.world == world], data)
            self.rewards_[world] = self._learn(lessons, random)
        return self

    def predict(self, example: Example, data: Dataset, random: np.random.Generator) -> Prediction:
        """The sequence of the greatest reward for each clause, one clause after the other."""
        policy = self.policy(example.environment, example.world, data)
        if policy is None:
            return Prediction()
        earlier: list[Clause] = []
        served: list[tuple[Clause, tuple[Instruction, ...], str | None]] = []
        for clause in parse(example.demonstration.text, data.lexicon).clauses:
            done = tuple(i for _, made, _ in served for i in made)
            served.append((clause, policy.best(clause, earlier, done)[0][1], None))
            earlier.append(clause)
        return by_clause(served)

    def _learn(self, lessons: Sequence[_Lesson], random: np.random.Generator) -> Reward:
        sequences = [(lesson.things, [made for _, made in lesson.clauses]) for lesson in lessons]
        syntax = learn_syntax(sequences, certain=self.certain, cover=_COVER)
        features = _number(lessons, syntax, grounded=self.grounded)
        menus: dict[Things, Menu] = {}
        data = []
        for lesson in lessons:
            if lesson.things not in menus:
                menus[lesson.things] = Menu(features, lesson.things, syntax.menu(lesson.things))
            data += _steps_made(lesson, menus[lesson.things], grounded=self.grounded)
        theta = ascend(features, data, random, rounds=self.rounds, rate=self.rate, ridge=self.ridge)
        choices = max(sum(len(made.choices) for made in data), 1)
        before, after = (likelihood(features, weights, data) / choices for weights in (np.zeros_like(theta), theta))
        return Reward(features, theta, before, after)

    def policy(self, environment: str, world: str, data: Dataset) -> Policy | None:
        """What was learned, ready for one environment; ``None`` in a kind of world that training did not have."""
        reward = self.rewards_.get(world)
        if reward is None:
            return None
        ground = data.world(environment)
        policy = self._policies.get(environment)
        if policy is None or policy.menu.things.world is not ground:
            things = Things(ground)
            menu = Menu(reward.features, things, reward.features.syntax.menu(things))
            policy = self._policies[environment] = Policy(
                reward, menu, grounded=self.grounded, beam=self.beam, bonus=self.bonus, slack=self.slack
            )
        return policy


class _Lesson(NamedTuple):
    """A demonstration as it is learned from: each clause (or none) with its well-formed instructions."""

    things: Things
    clauses: list[tuple[Clause | None, tuple[Instruction, ...]]]


def bag(clause: Clause, *, grounded: bool) -> list[str]:
    """The words of a clause, its verb, and one that every clause has; ``grounded`` with what its pronouns stand for."""
    resolved = clause.resolved() if grounded else ()
    return ["", *_WORD.findall(clause.text.lower()), f"verb {clause.verb}", *resolved]


def nothing(things: Things) -> Ints:
    """The levels of :func:`mentioned` where nothing is."""
    levels: Ints = np.zeros(len(things.kinds) + 1, np.int64)
    return levels


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


def _number(lessons: Sequence[_Lesson], syntax: Syntax, *, grounded: bool) -> Features:
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


def _steps_made(lesson: _Lesson, menu: Menu, *, grounded: bool) -> list[Made]:
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
