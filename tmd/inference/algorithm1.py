"""Algorithm 1 of the paper (section VI-E): the forward pass over the clauses, and the best plans it leads to.

α_j maps each environment that clause j can end in to the cheapest ways of getting there. The comments name the lines of
the paper. Beyond it, others than the templates may propose (:mod:`tmd.inference.proposers`), α_j may be cut to a beam,
and candidates wait in a queue in the order of what they cost at least, so that most of the dear ones need no planner.
The same over the goals of clauses is :mod:`tmd.inference.goal_directed`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tmd.inference.config import InferenceConfig
from tmd.inference.energy import Energy
from tmd.inference.proposers import Instructions, Proposal, Proposer, Situation
from tmd.inference.ranking import Choice, Inferred, Path, PlanStep, Refusal, cheapest, ranked
from tmd.language.clause import Clause
from tmd.pddl.semantics import Constraints
from tmd.pddl.task import Bits
from tmd.planning.result import Filled, GaveUp, NoPlanner, Planner, Unreachable
from tmd.veil.world import World

Alpha = dict[Bits, list[Path]]
Refusals = dict[Refusal, None]  # a set that keeps its order


class Inference:
    """Inference in one environment. Nothing of a text is kept between calls.

    Args:
        world: The environment.
        energy: The factors, weighed.
        planner: Finds what was left unsaid.
        proposers: They propose candidates, and judge them.
        config: The model.
    """

    def __init__(
        self, world: World, energy: Energy, planner: Planner, proposers: Sequence[Proposer], config: InferenceConfig
    ) -> None:
        self.world = world
        self.energy = energy
        self.planner = planner if config.latent else NoPlanner()
        self.proposers = tuple(proposers)
        self.beam = config.beam
        self.knowledge = config.knowledge
        self.constraints = Constraints(world.task)

    def infer(self, clauses: Sequence[Clause], state: Bits, top: int = 1) -> Inferred:
        """The ``top`` best distinct plans for ``clauses`` from ``state``."""
        refusals: Refusals = {}
        alpha: Alpha = {state: [Path(0.0, state)]}  # α_0[E'_0] = 0
        for number in range(len(clauses)):
            alpha = self._forward(clauses, number, alpha, top, refusals)
        return Inferred(ranked((path for ways in alpha.values() for path in ways), top), tuple(refusals))

    def _forward(self, clauses: Sequence[Clause], number: int, alpha: Alpha, top: int, refusals: Refusals) -> Alpha:
        """Forward-Inference(j): α_j from α_{j-1}."""
        found: Alpha = {}
        situations = [Situation(clauses, number, ways) for ways in alpha.values()]
        for bound, situation, candidate in self._queue(situations, refusals):  # lines 3 to 7
            if self._settled(found, bound, top):
                break
            match self._answer(situation.state, candidate.instructions):  # lines 8 and 9
                case Filled(latent):
                    self._update(found, situation, candidate, latent)  # lines 10 to 12
                case Unreachable(reason):
                    refusals[Refusal(number, candidate.source, reason)] = None
                case GaveUp(limit):
                    refusals[Refusal(number, candidate.source, f"the planner gave up at {limit}")] = None
        if not found:  # an unseen verb, or nothing that can be done: α_j = α_{j-1}
            nothing = Choice(None, (), {}, {})
            return {state: [path.extended(nothing, state) for path in ways] for state, ways in alpha.items()}
        kept = {end: cheapest(paths, top) for end, paths in found.items()}
        return {end: kept[end] for end in sorted(kept, key=lambda end: kept[end][0].order)[: self.beam]}

    def _queue(self, situations: Iterable[Situation], refusals: Refusals) -> list[tuple[float, Situation, Proposal]]:
        """Every candidate in every E'_{j-1}, by what it costs at least; the planner can only add to that."""
        queue = []
        for situation in situations:
            for proposed in (p for proposer in self.proposers for p in proposer.propose(situation)):
                if isinstance(proposed, Refusal):
                    refusals[proposed] = None
                else:
                    queue.append((situation.ways[0].energy + proposed.energy, situation, proposed))
        return sorted(queue, key=lambda item: item[0])

    def _settled(self, found: Alpha, bound: float, top: int) -> bool:
        """Whether no candidate that costs ``bound`` or more can enter the beam or the best plans any more.

        Without a beam every candidate counts; so it does where weights are negative, since then ``bound`` is none.
        """
        if self.beam is None:
            return False
        least = bound + self.energy.least_more()
        cheaper = [sum(path.energy < least for path in paths) for paths in found.values()]
        return sum(map(bool, cheaper)) >= self.beam and sum(cheaper) >= top

    def _answer(self, state: Bits, instructions: Instructions) -> Filled | Unreachable | GaveUp:
        """What callSymbolicPlanner says to getConstraints: what must be done before ``instructions``."""
        if not self.knowledge:
            return Filled((), state, 0)
        return self.planner.fill(state, self.constraints.of(instructions))

    def _update(self, found: Alpha, situation: Situation, candidate: Proposal, latent: Instructions) -> None:
        """Φ, the energy, and α_j[E'_j], for a candidate with what the planner puts before it."""
        own = candidate.instructions
        middle = self._simulated(situation.state, latent)  # E_j, line 10
        end = self._simulated(middle, own)  # E'_j, line 11
        steps = tuple(PlanStep(i, situation.number, latent=True) for i in latent)
        steps += tuple(PlanStep(i, situation.number, latent=False) for i in own)
        raw = dict(candidate.raw)  # ψ_j
        if self.knowledge:
            raw |= self.energy.of_end(situation.clause.verb, candidate.names, end)  # ψ'_j
            raw |= self.energy.of_latent(latent, middle)  # ψ_jl and ψ'_jl
            for proposer in self.proposers:
                raw |= proposer.judge(situation, (*latent, *own), end)
        choice = Choice(candidate.source, steps, self.energy.weigh(raw), raw)
        found.setdefault(end, []).extend(path.extended(choice, end) for path in situation.ways)  # line 12

    def _simulated(self, state: Bits, instructions: Instructions) -> Bits:
        """Φ. A robot without knowledge takes its environment to stay as it was."""
        for instruction in instructions if self.knowledge else ():
            state = self.world.task.by_instruction[instruction].apply(state)
        return state
