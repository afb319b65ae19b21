"""Algorithm 1 of the paper (section VI-E): the forward pass over the clauses, and the best plans it leads to.

α_j maps each environment that clause j can end in to the cheapest ways of getting there. The comments name the lines of
the paper. Beyond it, others than the templates may propose (:mod:`tmd.inference.proposers`), α_j may be cut to a beam,
and candidates wait in a queue in the order of their least possible energy, so that most of the dear ones need no
planner. :mod:`tmd.inference.goal_pass` adds goals that every candidate must reach.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice

from tmd.inference.config import InferenceConfig
from tmd.inference.energy import Energy
from tmd.inference.proposers import Instructions, Proposal, Proposer, Situation
from tmd.inference.ranking import Choice, Inferred, PlanStep, RankedPlan, RejectedProposal, Way, why_lost
from tmd.pddl.domain_traits import passing_predicates
from tmd.pddl.semantics import Constraints
from tmd.pddl.task import Bits, Cube, Task, atoms_in
from tmd.planning.backends import TaskPlanners
from tmd.planning.result import Answer, Filled, GaveUp, NoPlanner, Planner, Unreachable
from tmd.world.verb_clause import VerbClause
from tmd.world.world import World

NOTHING = Choice(None, (), {}, {})
"""The choice for a clause for which nothing is done."""


@dataclass(frozen=True)
class InferenceSetup:
    """The fixed inputs of inference in one environment. Nothing of a request is kept in it.

    ``restored`` are conditions that hold at the end of no plan unless they did at the start, or the request asks for
    them.
    """

    world: World
    energy: Energy
    planners: TaskPlanners
    proposers: Sequence[Proposer]
    config: InferenceConfig
    restored: Sequence[tuple[Cube, ...]] = ()


class ForwardPass:
    """The forward pass over the clauses of one request.

    ``task`` is that of the environment, without what the request forbids; ``top`` is the number of distinct plans.
    """

    def __init__(self, setup: InferenceSetup, clauses: Sequence[VerbClause], task: Task, top: int) -> None:
        self.setup = setup
        self.config = setup.config
        self.world = setup.world
        self.clauses = clauses
        self.task = task
        self.top = top
        self.planner: Planner = setup.planners.quick(task) if self.config.latent else NoPlanner()
        self.constraints = Constraints(setup.world.task)
        self.rejected: dict[RejectedProposal, None] = {}  # a set that keeps its order

    def infer(self, state: Bits) -> Inferred:
        """Return the best distinct plans for the clauses from ``state``."""
        ways = [Way(0.0, state)]  # α_0[E'_0] = 0
        for number in range(len(self.clauses)):
            ways = self._forward(number, ways)
        return Inferred(self.ranked(ways), tuple(self.rejected))

    def ranked(self, ways: Sequence[Way]) -> tuple[RankedPlan, ...]:
        """Return the cheapest distinct plans, each with the reason why it is not the first."""
        plans = [RankedPlan(w.choices, w.state, goals=w.goals) for w in distinct(ways, self.top)]
        return tuple(replace(p, why=why_lost(p, plans[0])) if place else p for place, p in enumerate(plans))

    def _forward(self, number: int, ways: Sequence[Way]) -> list[Way]:
        """Compute α_j from α_{j-1}: Forward-Inference(j)."""
        alpha = by_state(ways)
        groups = {Situation(self.clauses, number, group[0]): group for group in alpha.values()}
        found: dict[Bits, list[Way]] = {}
        for bound, situation, candidate in self.queue(groups):  # lines 3 to 7
            if self._settled(found, bound):
                break
            match self._answer(situation.state, candidate.instructions):  # lines 8 and 9
                case Filled(latent):
                    choice, end = self.weighed(situation, candidate, latent)  # lines 10 and 11
                    found.setdefault(end, []).extend(w.extended(choice, end) for w in groups[situation])  # line 12
                case Unreachable(reason):
                    self.rejected[RejectedProposal(number, candidate.source, reason)] = None
                case GaveUp(limit):
                    reason = f"the planner gave up at {limit}"
                    self.rejected[RejectedProposal(number, candidate.source, reason)] = None
        if not found:  # an unseen verb, or nothing that can be done: α_j = α_{j-1}
            return [way.extended(NOTHING, state) for state, group in alpha.items() for way in group]
        return self.pruned((way for group in found.values() for way in group), self.config.beam)

    def queue(self, situations: Iterable[Situation]) -> list[tuple[float, Situation, Proposal]]:
        """Return every candidate with its least possible energy, the cheapest first; the planner can only add to it."""
        found = []
        for situation in situations:
            for proposed in (p for proposer in self.setup.proposers for p in proposer.propose(situation)):
                if isinstance(proposed, RejectedProposal):
                    self.rejected[proposed] = None
                else:
                    found.append((situation.way.energy + proposed.energy, situation, proposed))
        return sorted(found, key=lambda item: item[0])

    def _settled(self, found: dict[Bits, list[Way]], bound: float) -> bool:
        """Return whether no candidate of energy ``bound`` or more can enter the beam or the best plans any more.

        Without a beam every candidate counts, and where weights are negative, since then ``bound`` is no bound.
        """
        if self.config.beam is None:
            return False
        least = bound + self.setup.energy.least_more()
        cheaper = [sum(way.energy < least for way in ways) for ways in found.values()]
        return sum(map(bool, cheaper)) >= self.config.beam and sum(cheaper) >= self.top

    def _answer(self, state: Bits, instructions: Instructions) -> Answer:
        """Ask callSymbolicPlanner for getConstraints: what must be done before ``instructions``."""
        if not self.config.knowledge:
            return Filled((), state, 0)
        return self.planner.fill(state, self.constraints.of(instructions))

    def weighed(
        self, situation: Situation, proposal: Proposal, latent: Instructions, aim: Sequence[Cube] = ()
    ) -> tuple[Choice, Bits]:
        """Return the choice of a candidate with all its factors, and the state that it ends in (Φ, lines 10 and 11).

        ``latent`` are the planner's instructions (I_jl); ``aim`` is the goal that is reached, if there is one.
        """
        energy, own, names = self.setup.energy, proposal.instructions, proposal.names
        factors, end = dict(proposal.raw), situation.state  # ψ_j
        if self.config.knowledge:  # a robot without knowledge takes its environment to stay as it was
            middle = self.world.task.trace(situation.state, latent)[-1]  # E_j, line 10
            end = self.world.task.trace(middle, own)[-1]  # E'_j, line 11
            factors |= energy.of_end(situation.clause.verb, names, end)  # ψ'_j
            factors |= energy.of_latent(latent, middle)  # ψ_jl and ψ'_jl
            if aim:
                changed = (end ^ situation.state) & self.lasting & ~atoms_in(aim)
                factors["changes_not_asked_for"] = float(changed.bit_count())
            for proposer in self.setup.proposers:
                factors |= proposer.judge(situation, (*latent, *own), end)
        steps = tuple(PlanStep(i, situation.number, latent=True) for i in latent)
        steps += tuple(PlanStep(i, situation.number, latent=False) for i in own)
        return Choice(proposal.source, steps, energy.weigh(factors), factors), end

    @cached_property
    def lasting(self) -> Bits:
        """The atoms that do not pass by themselves."""
        passing = passing_predicates(self.task.problem.domain)
        return self.task.where(lambda atom: atom.predicate not in passing)

    def pruned(self, found: Iterable[Way], beam: int | None) -> list[Way]:
        """Return the cheapest ways to each of the ``beam`` cheapest environments; ``None`` keeps all."""
        ends = by_state(sorted(found, key=lambda way: way.order))
        return [way for group in islice(ends.values(), beam) for way in distinct(group, self.top)]


def by_state(ways: Iterable[Way]) -> dict[Bits, list[Way]]:
    """Group ways by the state that they end in; the order is kept."""
    found: dict[Bits, list[Way]] = {}
    for way in ways:
        found.setdefault(way.state, []).append(way)
    return found


def distinct(ways: Iterable[Way], count: int) -> list[Way]:
    """Return the ``count`` cheapest ways that differ in their instructions, the cheapest first."""
    kept: dict[Instructions, Way] = {}
    for way in sorted(ways, key=lambda way: way.order):
        if len(kept) == count:
            break
        kept.setdefault(way.instructions, way)
    return list(kept.values())
