"""Proposers: sources of candidate sequences for a clause, which may also judge the candidates of the others.

The paper has one, the templates of the demonstrations (section V-A); the policy is another. Further ones are passed to
:class:`~tmd.inference.goal_pass.Inference`, which completes proposals to a goal.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

from tmd.inference.config import InferenceConfig
from tmd.inference.energy import Energy, Factors
from tmd.inference.policy.model import Policy
from tmd.inference.ranking import RejectedProposal, Way
from tmd.library.library import Library
from tmd.library.template import Instantiation, Template, instantiate
from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits
from tmd.world.verb_clause import VerbClause
from tmd.world.world import World

Instructions = tuple[Instruction, ...]
POLICY_SOURCE = "policy"
"""The source of a sequence that was made from no demonstration."""
PLANNER_SOURCE = "planner"
"""The source of a sequence that the planner made for the goal of a clause."""


@dataclass(frozen=True, eq=False)
class Situation:
    """A clause in an environment: what proposers are asked about. Each is itself only, so it may be a key."""

    clauses: Sequence[VerbClause]
    number: int
    way: Way

    @property
    def state(self) -> Bits:
        """The environment E'_{j-1}."""
        return self.way.state

    @cached_property
    def done(self) -> Instructions:
        """The instructions of the cheapest way there."""
        return self.way.instructions

    @property
    def clause(self) -> VerbClause:
        """The clause C_j."""
        return self.clauses[self.number]


@dataclass(frozen=True, slots=True)
class Proposal:
    """A candidate sequence for a clause, before the planner is asked for the further instructions that it needs.

    Attributes:
        source: The demonstration or the proposer that it comes from.
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
        """Yield candidates for a clause in an environment, and those that are impossible."""
        ...

    def judge(self, situation: Situation, instructions: Instructions, end: Bits) -> Factors:
        """Return factors of any proposer's candidate: all its instructions lead to ``end``."""
        return {}


@dataclass(frozen=True)
class TemplateProposer(Proposer):
    """The paper's: every template of the clause's verb, instantiated here, and all of its trimmings."""

    world: World
    library: Library
    energy: Energy
    config: InferenceConfig

    def propose(self, situation: Situation) -> Iterator[Proposal | RejectedProposal]:
        """Yield each distinct trimmed instantiation, at its cheapest."""
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
        """Return the first t for which nothing in I[t..] is impossible in this environment."""
        for t in range(len(instructions), 0, -1):
            if instructions[t - 1] not in self.world.task.by_instruction:
                return t
        return 0

    def _trimmings(self, made: Instantiation, situation: Situation, first: int) -> Iterator[Proposal]:
        """Yield I[t..] for every allowed t from ``first`` on."""
        whole = made.instructions
        fixed = self.energy.of_template(made, situation.clause)
        names = self.world.mentions.meant(situation.clause, made.grounding.values(), situation.state)
        most = len(whole) if self.config.trim is None else min(self.config.trim, len(whole))
        for t in range(first, most + 1):
            raw = {**fixed, **self.energy.of_sequence(whole[t:], len(whole), names)}
            yield Proposal(made.template.source, whole[t:], names, raw, self.energy.total(raw))


@dataclass(frozen=True)
class PolicyProposer(Proposer):
    """Proposes sequences of a policy, and judges all by the words of the clause. Not in the paper.

    It has no say about a clause whose templates all have verbs that it does not know: it is older than the library.
    """

    policy: Policy
    world: World
    library: Library
    energy: Energy
    config: InferenceConfig

    @cached_property
    def trust(self) -> float:
        """The weight of its judgement: few demonstrations are better repeated as they were shown."""
        known = max(len(self.library), 1)
        return known / (known + self.config.few)

    def propose(self, situation: Situation) -> Iterator[Proposal]:
        """Yield the likeliest sequences, without what can never be done here."""
        clause = situation.clause
        if not self._has_say(clause):
            return
        found: dict[Instructions, Proposal] = {}
        for _, proposed in self.policy.best(situation.clauses, situation.number, situation.done, self.config.generated):
            kept = tuple(i for i in proposed if i in self.world.task.by_instruction)
            names = self.world.mentions.meant(clause, [a for i in kept for a in i.args], situation.state)
            raw = {"policy_proposal": 1.0 / self.trust, **self.energy.of_sequence(kept, len(kept), names)}
            found.setdefault(kept, Proposal(POLICY_SOURCE, kept, names, raw, self.energy.total(raw)))
        yield from found.values()

    def judge(self, situation: Situation, instructions: Instructions, end: Bits) -> Factors:
        """Return Δ_words."""
        if not self._has_say(situation.clause):
            return {}
        surprise = self.policy.surprise(situation.clauses, situation.number, situation.done, instructions)
        return {"language_model": surprise * self.trust}

    def _has_say(self, clause: VerbClause) -> bool:
        verbs = dict.fromkeys(template.clause.verb for template in self.library.distinct(clause, self.world))
        return any(map(self.policy.knows, verbs)) if verbs else self.config.guess


def proposers_of(
    config: InferenceConfig, world: World, library: Library, energy: Energy, policy: Policy | None = None
) -> list[Proposer]:
    """Return the proposers of a model; it has no policy where none is given."""
    found: list[Proposer] = [TemplateProposer(world, library, energy, config)]
    if config.policy and policy is not None:
        found.append(PolicyProposer(policy, world, library, energy, config))
    return found
