"""Proposers: each says what may be done for a clause in an environment, and may judge what the others say.

The paper has one, the templates of the demonstrations (section V-A). A policy stands beside it; whoever writes another
gives it to :class:`~tmd.inference.engine.Inference` as well. The goals that every proposal has to reach are the affair
of :mod:`tmd.inference.goal_pass`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from tmd.inference.config import InferenceConfig
from tmd.inference.energy import Energy, Factors
from tmd.inference.ranking import Path, RejectedProposal
from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits
from tmd.veil.library import Library
from tmd.veil.template import Instantiation, Template, instantiate
from tmd.veil.world import World
from tmd.world.verb_clause import VerbClause

Instructions = tuple[Instruction, ...]
POLICY_SOURCE = "policy"
"""The source of a sequence that was made from no demonstration."""
PLANNER_SOURCE = "planner"
"""The source of a sequence that the planner made for the goal of a clause."""


@dataclass(frozen=True, eq=False)
class Situation:
    """A clause in an environment: what proposers are asked about. Each is itself only, so it may be a key.

    Attributes:
        clauses: All clauses of the text.
        number: Which of them it is about, from 0.
        ways: The ways to the environment, cheapest first; at least one.
    """

    clauses: Sequence[VerbClause]
    number: int
    ways: Sequence[Path]

    @property
    def state(self) -> Bits:
        """The environment E'_{j-1}."""
        return self.ways[0].state

    @cached_property
    def done(self) -> Instructions:
        """What is done on the cheapest way there."""
        return self.ways[0].instructions

    @property
    def clause(self) -> VerbClause:
        """The clause C_j."""
        return self.clauses[self.number]

    @property
    def earlier(self) -> Sequence[VerbClause]:
        """The clauses before it."""
        return self.clauses[: self.number]


@dataclass(frozen=True, slots=True)
class Proposal:
    """What may be done for a clause, before the planner is asked what else that needs.

    Attributes:
        source: The demonstration or the proposer that it comes from.
        instructions: The sequence I_j.
        names: The objects that its clause speaks of.
        raw: The factors of ψ_j that are known already, not weighed.
        energy: The same, weighed and summed: what the candidate costs at least.
    """

    source: str
    instructions: Instructions
    names: tuple[str, ...]
    raw: Factors
    energy: float


class Proposer(Protocol):
    """A source of candidates. It keeps nothing of a text between calls."""

    def propose(self, situation: Situation) -> Iterable[Proposal | RejectedProposal]:
        """Candidates for a clause in an environment, and why there are not more."""
        ...

    def judge(self, situation: Situation, instructions: Instructions, end: Bits) -> Factors:
        """Factors of any candidate, whoever proposed it: ``instructions`` is all that is done, up to ``end``."""
        return {}


class TemplateProposer(Proposer):
    """The paper's: every template of the clause's verb, instantiated here, and all of its trimmings.

    Args:
        world: The environment.
        library: The templates.
        energy: The factors, weighed.
        config: The model.
    """

    def __init__(self, world: World, library: Library, energy: Energy, config: InferenceConfig) -> None:
        self.world = world
        self.library = library
        self.energy = energy
        self.config = config

    def propose(self, situation: Situation) -> Iterator[Proposal | RejectedProposal]:
        """Each distinct trimmed instantiation, at its cheapest."""
        best: dict[tuple[Instructions, tuple[str, ...]], Proposal] = {}
        for template in self.library.distinct(situation.clause, self.world):
            for proposed in self._of_template(template, situation):
                if isinstance(proposed, RejectedProposal):
                    yield proposed
                    continue
                key = proposed.instructions, proposed.names
                if key not in best or proposed.energy < best[key].energy:
                    best[key] = proposed
        yield from best.values()

    def _of_template(self, template: Template, situation: Situation) -> Iterator[Proposal | RejectedProposal]:
        clause, state = situation.clause, situation.state
        made = instantiate(template, clause, self.world, state, pair_nouns=self.config.extended)
        if made is None:
            yield RejectedProposal(situation.number, template.source, "there is no object for one of its variables")
            return
        first = self._first_possible(made.instructions) if self.config.knowledge else 0
        if first:
            reason = f"{made.instructions[first - 1]} can never be done here"
            yield RejectedProposal(situation.number, template.source, reason)
        yield from self._trimmings(made, situation, first)

    def _first_possible(self, instructions: Instructions) -> int:
        """The first t for which nothing in I[t..] is impossible in this environment."""
        for t in range(len(instructions), 0, -1):
            if instructions[t - 1] not in self.world.task.by_instruction:
                return t
        return 0

    def _trimmings(self, made: Instantiation, situation: Situation, first: int) -> Iterator[Proposal]:
        """I[t..] for every t from ``first`` on that is allowed."""
        whole = made.instructions
        fixed = self.energy.of_template(made, situation.clause)
        names = self.world.mentions.meant(situation.clause, made.grounding.values(), situation.state)
        most = len(whole) if self.config.trim is None else min(self.config.trim, len(whole))
        for t in range(first, most + 1):
            raw = {**fixed, **self.energy.of_sequence(whole[t:], len(whole), names)}
            yield Proposal(made.template.source, whole[t:], names, raw, self.energy.total(raw))


class SequenceModel(Protocol):
    """A learned distribution over instruction sequences given the words of a clause."""

    def knows(self, verb: str) -> bool:
        """Whether it was learned from demonstrations with that verb."""
        ...

    def best(
        self, clauses: Sequence[VerbClause], number: int, done: Sequence[Instruction], count: int
    ) -> Sequence[tuple[float, Instructions]]:
        """The ``count`` likeliest sequences for a clause of a text, each after its score, likeliest first."""
        ...

    def sample(
        self, clauses: Sequence[VerbClause], count: int, random: np.random.Generator
    ) -> Sequence[tuple[Instructions, ...]]:
        """``count`` sequences for a whole text, drawn from the distribution, clause by clause."""
        ...

    def surprise(
        self,
        clauses: Sequence[VerbClause],
        number: int,
        done: Sequence[Instruction],
        instructions: Sequence[Instruction],
    ) -> float:
        """The mean of -ln P over a sequence and its end, never negative."""
        ...


class PolicyProposer(Proposer):
    """A policy proposes sequences of its own, and judges all by the words of the clause. Not in the paper.

    It has no say about a clause whose templates all have verbs that it does not know: it is older than the library.

    Args:
        policy: What was learned, for this environment.
        world: The environment.
        library: The templates.
        energy: The factors, weighed.
        config: The model.
    """

    def __init__(
        self, policy: SequenceModel, world: World, library: Library, energy: Energy, config: InferenceConfig
    ) -> None:
        self.policy = policy
        self.world = world
        self.library = library
        self.energy = energy
        self.config = config
        known = max(len(library), 1)
        self.trust = known / (known + config.few)

    def propose(self, situation: Situation) -> Iterator[Proposal]:
        """The likeliest sequences, without what can never be done here."""
        clause = situation.clause
        if not self._has_say(clause):
            return
        found: dict[Instructions, Proposal] = {}
        for _, proposed in self.policy.best(situation.clauses, situation.number, situation.done, self.config.generated):
            kept = tuple(i for i in proposed if i in self.world.task.by_instruction)
            names = self.world.mentions.meant(clause, [a for i in kept for a in i.args], situation.state)
            raw = {"generated": 1.0 / self.trust, **self.energy.of_sequence(kept, len(kept), names)}
            found.setdefault(kept, Proposal(POLICY_SOURCE, kept, names, raw, self.energy.total(raw)))
        yield from found.values()

    def judge(self, situation: Situation, instructions: Instructions, end: Bits) -> Factors:
        """Δ_words."""
        if not self._has_say(situation.clause):
            return {}
        surprise = self.policy.surprise(situation.clauses, situation.number, situation.done, instructions)
        return {"words": surprise * self.trust}

    def _has_say(self, clause: VerbClause) -> bool:
        verbs = dict.fromkeys(template.clause.verb for template in self.library.distinct(clause, self.world))
        return any(map(self.policy.knows, verbs)) if verbs else self.config.guess


def proposers_of(
    config: InferenceConfig,
    world: World,
    library: Library,
    energy: Energy,
    policy: SequenceModel | None = None,
) -> list[Proposer]:
    """The proposers of a model; it has no policy where none is given."""
    found: list[Proposer] = [TemplateProposer(world, library, energy, config)]
    if config.policy and policy is not None:
        found.append(PolicyProposer(policy, world, library, energy, config))
    return found
