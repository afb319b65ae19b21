"""A policy: a learned distribution over instruction sequences given the words of a clause.

It is the reward of the paper's Instruction-Tree baseline, and beyond the paper a second source of candidates for
inference (the preset ``policy``).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tmd.inference.policy.features import (
    POSSIBLE,
    STOP,
    ClauseContext,
    Features,
    Floats,
    Ints,
    KnownObjects,
    context_of,
    verb_word,
)
from tmd.inference.policy.menu import Menu, Node, Steps, steps
from tmd.pddl.model import Instruction
from tmd.world.verb_clause import VerbClause
from tmd.world.world import World

# Rewards are rounded before they are compared, so that equal ones stay equal for any order of a sum.
_ROUNDED = 9
MOST = 12.0
"""The surprise of a choice that training makes impossible."""
# Number of sequences of each length that the beam search extends.
_BEAM = 5
# Reward for each instruction, because the likeliest sequence is shorter than the usual one.
_BONUS = 0.5
# A sequence is given up when its reward is this much below that of the best complete one.
_SLACK = 3.0


def log_probabilities(features: Features, theta: Floats, at: Steps) -> Floats:
    """Return ln P(instruction | words, sequence so far), H × C: exp(θ·φ), normalised over the allowed choices."""
    parts, menu = features.parts(theta), at.menu
    words = parts.local[at.context.words].sum(axis=0)
    if parts.text is not None:
        words = words + share_of_word(at.context) * parts.text[at.context.text].sum(axis=0)
    rows = words + np.stack([parts.local[words].sum(axis=0) for words in at.followers])
    # few choices are allowed at any step, and an instruction has few of the many properties: a product of matrices
    # would take ten times as long
    possible = at.open
    padded = np.pad(rows, ((0, 0), (0, 1)))
    worth = padded[:, menu.having[possible]].sum(axis=2) + parts.paired[at.pairs].sum(axis=2)
    worth += (at.reals @ parts.reals)[:, possible]
    if features.grounded:
        of_facts = at.facts @ parts.facts.T  # H × (things + 1) × places
        worth += of_facts[:, menu.args[possible], menu.places[possible]].sum(axis=2)
    worth[at.closed] = -np.inf
    reward: Floats = np.full(at.allowed.shape, -np.inf)
    reward[:, possible] = worth
    reward -= reward.max(axis=1, keepdims=True)
    logs: Floats = reward - np.log(np.exp(reward).sum(axis=1, keepdims=True))
    return logs


def share_of_word(context: ClauseContext) -> float:
    """Return the weight of each word of the whole text: a long text has many that say little."""
    return 1.0 / float(np.sqrt(max(len(context.text), 1)))


@dataclass(frozen=True, slots=True)
class Reward:
    """The learned reward of one domain.

    Attributes:
        features: The features, with the syntactical constraints.
        before: The mean log-likelihood of a training choice with all weights zero.
        after: The same with the weights learned.
    """

    features: Features
    theta: Floats
    before: float
    after: float


class Policy:
    """A learned reward in one environment."""

    def __init__(self, reward: Reward, world: World) -> None:
        things = KnownObjects(world)
        self.reward = reward
        self.menu = Menu(reward.features, things, reward.features.syntax.menu(things))
        self._last: tuple[tuple[object, ...], tuple[Menu, ClauseContext]] | None = None

    def knows(self, verb: str) -> bool:
        """Return whether it was learned from demonstrations with that verb."""
        return verb_word(verb) in self.reward.features.words

    def best(
        self, clauses: Sequence[VerbClause], number: int, done: Sequence[Instruction], count: int = 1
    ) -> list[tuple[float, tuple[Instruction, ...]]]:
        """Return the ``count`` sequences of the greatest reward for a clause, by beam search, greatest first.

        ``done`` are the instructions for the clauses before it. At least one sequence is found, perhaps the empty one.
        """
        features = self.reward.features
        menu, context = self._read(clauses, number)
        found: list[tuple[float, tuple[Instruction, ...]]] = []
        beam: list[tuple[float, tuple[Instruction, ...]]] = [(0.0, ())]
        for _ in range(features.syntax.longest + 1):
            at = steps(menu, context, [Node(tuple(done), own) for _, own in beam])
            logs = np.round(log_probabilities(features, self.reward.theta, at), _ROUNDED)
            longer = []
            for (total, own), row in zip(beam, logs, strict=True):
                found.append((float(total + row[-1]), own))
                following = np.argsort(-row[:-1], kind="stable")[:_BEAM].tolist()
                longer += [
                    (round(total + float(row[i]) + _BONUS, _ROUNDED), (*own, menu.choices[i])) for i in following
                ]
            found = sorted(found, key=lambda node: -node[0])[:count]
            worst = found[-1][0] if len(found) == count else -np.inf
            longer.sort(key=lambda node: -node[0])
            beam = [node for node in longer[:_BEAM] if node[0] >= worst - _SLACK and np.isfinite(node[0])]
            if not beam:
                break
        return found

    def sample(
        self, clauses: Sequence[VerbClause], count: int, random: np.random.Generator
    ) -> list[tuple[tuple[Instruction, ...], ...]]:
        """Draw ``count`` sequences for a whole text, clause by clause; some may be equal."""
        drawn: list[tuple[tuple[Instruction, ...], ...]] = [()] * count
        before: list[tuple[Instruction, ...]] = [()] * count
        for number in range(len(clauses)):
            own = self._sampled(clauses, number, before, random)
            drawn = [(*parts, part) for parts, part in zip(drawn, own, strict=True)]
            before = [(*earlier, *part) for earlier, part in zip(before, own, strict=True)]
        return drawn

    def _sampled(
        self,
        clauses: Sequence[VerbClause],
        number: int,
        before: Sequence[tuple[Instruction, ...]],
        random: np.random.Generator,
    ) -> list[tuple[Instruction, ...]]:
        """Draw a sequence for one clause after each of those ``before``."""
        features = self.reward.features
        menu, context = self._read(clauses, number)
        own: list[tuple[Instruction, ...]] = [()] * len(before)
        going = list(range(len(before)))
        for _ in range(features.syntax.longest):
            nodes = list(dict.fromkeys(Node(before[i], own[i]) for i in going))
            shares = np.exp(log_probabilities(features, self.reward.theta, steps(menu, context, nodes))).cumsum(axis=1)
            sums = dict(zip(nodes, np.round(shares / shares[:, -1:], _ROUNDED), strict=True))
            still = []
            for i, draw in zip(going, random.random(len(going)).tolist(), strict=True):
                row = int(np.searchsorted(sums[Node(before[i], own[i])], draw, side="right"))
                choice = menu.choices[min(row, len(menu.choices) - 1)]
                if choice != STOP:
                    own[i] = (*own[i], choice)
                    still.append(i)
            going = still
            if not going:
                break
        return own

    def surprise(
        self,
        clauses: Sequence[VerbClause],
        number: int,
        done: Sequence[Instruction],
        instructions: Sequence[Instruction],
    ) -> float:
        """Return the mean of -ln P over a sequence and its end; each term is at most :data:`MOST`."""
        menu, context = self._read(clauses, number)
        own = tuple(instructions)
        nodes = [Node(tuple(done), own[:length]) for length in range(len(own) + 1)]
        logs = log_probabilities(self.reward.features, self.reward.theta, steps(menu, context, nodes))
        each = [
            min(MOST, -float(logs[row, menu.index[choice]])) if choice in menu.index else MOST
            for row, choice in enumerate((*own, STOP))
        ]
        return round(sum(each) / len(each), _ROUNDED)

    def _read(self, clauses: Sequence[VerbClause], number: int) -> tuple[Menu, ClauseContext]:
        """Return the choices and the context of a clause; those of the last one are remembered."""
        key = (number, *((c.text, c.verb, c.resolved()) for c in clauses))
        last = self._last
        if last is None or last[0] != key:
            menu = self.menu
            context = context_of(clauses, number, menu.features, menu.things)
            last = self._last = key, (_with_mentioned(menu, context.levels), context)
        return last[1]


def _with_mentioned(menu: Menu, levels: Ints) -> Menu:
    """Return the menu of a grounded policy with instructions of unseen shapes about the clause's objects."""
    if not menu.features.grounded:
        return menu
    names = list(menu.things.kinds)
    about = [names[number] for number in np.flatnonzero(levels >= POSSIBLE)]
    more = set(menu.features.syntax.about(menu.things, about)) - set(menu.choices)
    return Menu(menu.features, menu.things, sorted({*menu.choices[:-1], *more})) if more else menu
