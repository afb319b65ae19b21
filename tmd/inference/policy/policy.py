"""A learned distribution over instruction sequences given the words of a clause, ready for one environment."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tmd.inference.policy.features import (
    EARLIER,
    FIRST,
    MENTIONED,
    POSSIBLE,
    REALS,
    STOP,
    Features,
    Floats,
    Ints,
    KnownObjects,
    Menu,
    Node,
    Steps,
    steps,
)
from tmd.language.clause import Clause
from tmd.pddl.model import Instruction
from tmd.veil.world import World

_BATCH = 8
"""Sequences between two steps of the ascent."""
_SMALL = 1e-6


class Made(NamedTuple):
    """A sequence of the training data: its steps, and the number of the choice that was made at each."""

    at: Steps
    choices: Ints


def log_probabilities(features: Features, theta: Floats, at: Steps) -> Floats:
    """Give ln P(instruction | words, sequence so far), H × C: exp(θ·φ), normalised over the choices allowed."""
    end = features.shape[0] * features.shape[1]
    table = theta[:end].reshape(features.shape)
    rows = table[at.words].sum(axis=0) + np.stack([table[words].sum(axis=0) for words in at.followers])
    reward = rows @ at.menu.properties.T + theta[end:-REALS][at.pairs].sum(axis=2) + at.reals @ theta[-REALS:]
    reward[~at.allowed] = -np.inf
    reward -= reward.max(axis=1, keepdims=True)
    logs: Floats = reward - np.log(np.exp(reward).sum(axis=1, keepdims=True))
    return logs


def likelihood(features: Features, theta: Floats, data: Sequence[Made], gradient: Floats | None = None) -> float:
    """The log-likelihood of the choices made. Its gradient is added to ``gradient``."""
    total = 0.0
    end = features.shape[0] * features.shape[1]
    for at, choices in data:
        rows = np.arange(len(choices))
        logs = log_probabilities(features, theta, at)
        total += float(logs[rows, choices].sum())
        if gradient is None:
            continue
        # the features that were met, less those that were to be expected
        rest = -np.exp(logs)
        rest[rows, choices] += 1
        table = gradient[:end].reshape(features.shape)
        having = rest @ at.menu.properties
        table[at.words] += having.sum(axis=0)
        for words, row in zip(at.followers, having, strict=True):
            table[words] += row
        weights = np.repeat(rest.ravel(), at.pairs.shape[2])
        gradient[end:-REALS] += np.bincount(at.pairs.ravel(), weights, minlength=features.size - REALS - end)
        gradient[-REALS:] += np.einsum("hc,hcr->r", rest, at.reals)
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
    """The weights θ by stochastic gradient ascent, with the step sizes of AdaGrad, from zero.

    What is raised is the log-likelihood less ridge/2 · |θ|². ``tell`` is told which share of the work is done.
    """
    theta: Floats = np.zeros(features.size)
    squares: Floats = np.full(features.size, _SMALL)
    for done in range(rounds):
        order = random.permutation(len(data)).tolist()
        for start in range(0, len(order), _BATCH):
            if tell is not None:
                tell((done + start / len(order)) / rounds)
            part = [data[number] for number in order[start : start + _BATCH]]
            gradient: Floats = theta * (-ridge * len(part) / len(data))
            likelihood(features, theta, part, gradient)
            squares += gradient**2
            theta += rate * gradient / np.sqrt(squares)
    return theta


_WORD = re.compile(r"[a-z0-9']+")
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
        world: The environment.
        grounded: Whether the reward knows which objects the clause's nouns may mean; as it was learned.
        beam: How many sequences of a length are looked at further.
        bonus: Reward for each instruction. The likeliest sequence is shorter than the usual one; this makes up.
        slack: A sequence is given up when its reward is this much below that of the best complete one.
    """

    def __init__(
        self,
        reward: Reward,
        world: World,
        *,
        grounded: bool = True,
        beam: int = 5,
        bonus: float = 0.5,
        slack: float = 3.0,
    ) -> None:
        things = KnownObjects(world)
        self.reward = reward
        self.menu = Menu(reward.features, things, reward.features.syntax.menu(things))
        self.grounded = grounded
        self.beam = beam
        self.bonus = bonus
        self.slack = slack
        self._last: tuple[tuple[object, ...], tuple[Menu, Ints, Ints]] | None = None

    def knows(self, verb: str) -> bool:
        """Whether it was learned from demonstrations with that verb."""
        return _verb(verb) in self.reward.features.words

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
        last = self._last
        if last is None or last[0] != key:
            last = self._last = key, self._reading(clause, earlier)
        return last[1]

    def _reading(self, clause: Clause, earlier: Sequence[Clause]) -> tuple[Menu, Ints, Ints]:
        words = self.reward.features.known(bag(clause, grounded=self.grounded))
        if not self.grounded:
            return self.menu, words, nothing(self.menu.things)
        levels = mentioned(clause, earlier, self.menu.things)
        return _with_mentioned(self.menu, levels), words, levels


def bag(clause: Clause, *, grounded: bool) -> list[str]:
    """The words of a clause, its verb, and one that every clause has; ``grounded`` with what its pronouns stand for."""
    resolved = clause.resolved() if grounded else ()
    return ["", *_WORD.findall(clause.text.lower()), _verb(clause.verb), *resolved]


def _verb(verb: str) -> str:
    """The word that stands for a clause's verb: no word of a text is like it."""
    return f"verb {verb}"


def nothing(things: KnownObjects) -> Ints:
    """The levels of :func:`mentioned` where nothing is."""
    levels: Ints = np.zeros(len(things.kinds) + 1, np.int64)
    return levels


def mentioned(clause: Clause, earlier: Sequence[Clause], things: KnownObjects) -> Ints:
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
