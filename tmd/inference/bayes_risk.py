"""Deciding by expected loss (minimum Bayes risk): the plan that is nearest to the plans of people.

People who do the same task do it differently, so the likeliest sequence is like few of theirs. The policy is a
distribution over what they do; sequences drawn from it stand for them. The loss of a plan against a sequence is half
that of the instruction edit distance and half that of what is changed in the end (IED and END, under the planning
rules), and the plan of least mean loss is chosen. Candidates are the plans of least energy and, where no declared goal
says what must be reached, the drawn sequences as well, made executable. Not in the paper.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from tmd.inference.config import InferenceConfig
from tmd.inference.policy.model import Policy
from tmd.inference.ranking import Choice, Inferred, PlanStep, RankedPlan, why_lost
from tmd.pddl.model import Instruction
from tmd.pddl.semantics import Constraints
from tmd.pddl.task import Bits
from tmd.planning.result import Filled, Planner
from tmd.world.verb_clause import VerbClause
from tmd.world.world import World, run

PLANS = 10
"""Number of plans of least energy that are considered."""
RISK = "expected_loss"
"""The name of the factor by which such plans are ranked."""
SAMPLE_SOURCE = "policy sample"
"""The source of a plan that was drawn from the policy."""
# The draws depend on text and environment alone.
_SEED = 0
# Maximum number of instructions that are put before one that does not apply; with more it is left out.
_FILLED = 3
_SHARE_OF_IED = 0.5
# Sources of goals that every plan must reach, so that drawn sequences are not candidates.
_STATED = frozenset({"declared", "model"})

Drawn = Sequence[tuple[Instruction, ...]]
"""A sequence that was drawn, clause by clause."""
Changed = Callable[[tuple[Instruction, ...]], Bits]
"""Returns the atoms that a sequence changes."""


def decided(
    inferred: Inferred,
    clauses: Sequence[VerbClause],
    world: World,
    policy: Policy,
    planner: Planner,
    config: InferenceConfig,
    top: int,
) -> Inferred:
    """Return the ``top`` plans of least expected loss, among those that inference found and those that were drawn.

    There should be about :data:`PLANS` plans; where inference refuses the text, that stays. ``planner`` fills in the
    instructions that a drawn one needs.
    """
    if not inferred.plans or not clauses:
        return replace(inferred, plans=inferred.plans[:top])
    drawn = policy.sample(clauses, config.samples, np.random.default_rng(_SEED))
    plans = {plan.instructions: plan for plan in inferred.plans}
    open_ended = not any(goal.source in _STATED for plan in inferred.plans for goal in plan.goals)
    if open_ended and config.drawn_candidates:
        completer = SequenceCompleter(world, planner)
        for sequence in dict.fromkeys(tuple(sequence) for sequence in drawn):
            plan = completer.plan(sequence)
            plans.setdefault(plan.instructions, plan)
    people = [tuple(i for own in sequence for i in own) for sequence in drawn]
    losses = expected_losses(list(plans), people, world)
    order = sorted(zip(losses.tolist(), plans.values(), strict=True), key=lambda pair: (pair[0], pair[1].instructions))
    ranked = [_with_risk(plan, loss) for loss, plan in order[:top]]
    explained = (replace(plan, why=why_lost(plan, ranked[0]) if place else "") for place, plan in enumerate(ranked))
    return replace(inferred, plans=tuple(explained))


def _with_risk(plan: RankedPlan, loss: float) -> RankedPlan:
    """Return the plan with its expected loss, in percent, in the place of its energy."""
    factors = [{RISK: 100 * loss} if not number else {} for number in range(len(plan.choices))]
    choices = (replace(choice, factors=own) for choice, own in zip(plan.choices, factors, strict=True))
    return replace(plan, choices=tuple(choices))


def expected_losses(
    plans: Sequence[tuple[Instruction, ...]], people: Sequence[tuple[Instruction, ...]], world: World
) -> NDArray[np.float64]:
    """Return the mean loss of each plan against all sequences, from 0 to 1, under the planning rules."""
    similar, same = similarities(plans, people, lambda sequence: _changed(sequence, world)).mean(axis=2)
    found: NDArray[np.float64] = 1 - (_SHARE_OF_IED * similar + (1 - _SHARE_OF_IED) * same)
    return np.round(found, 9)  # equal ones stay equal for any order of a sum


def similarities(
    plans: Sequence[tuple[Instruction, ...]], people: Sequence[tuple[Instruction, ...]], changed: Changed
) -> NDArray[np.float64]:
    """Return IED and END of each plan with each sequence, from 0 to 1: 2 x plans x people.

    ``changed`` returns the changes of a sequence, by the rules of END.
    """
    from rapidfuzz import process  # most models decide by energy
    from rapidfuzz.distance import Levenshtein

    codes = {i: chr(number) for number, i in enumerate(dict.fromkeys(i for s in (*plans, *people) for i in s), start=1)}
    mine, theirs = (["".join(codes[i] for i in sequence) for sequence in group] for group in (plans, people))
    similar = process.cdist(mine, theirs, scorer=Levenshtein.normalized_similarity, dtype=np.float64)
    ends = {sequence: changed(sequence) for sequence in dict.fromkeys((*plans, *people))}
    same = np.array([[_alike(ends[plan], ends[other]) for other in people] for plan in plans], dtype=np.float64)
    shape = len(plans), len(people)
    return np.stack([np.reshape(similar, shape), np.reshape(same, shape)])


def _changed(sequence: Sequence[Instruction], world: World) -> Bits:
    """Return the atoms that are otherwise after a sequence, without instructions that are impossible here."""
    return run(world, world.task.init, sequence) ^ world.task.init


def _alike(a: Bits, b: Bits) -> float:
    """Return the share of the changes of either that both have, from 0 to 1; 1 where neither changes anything."""
    return (a & b).bit_count() / (a | b).bit_count() if a or b else 1.0


class SequenceCompleter:
    """Makes sequences executable: puts in missing instructions, and leaves out impossible ones."""

    def __init__(self, world: World, planner: Planner) -> None:
        self.world = world
        self.planner = planner
        self.constraints = Constraints(world.task)
        self._needed = cache(self._missing)

    def plan(self, sequence: Drawn) -> RankedPlan:
        """Return the sequence as a plan, with a choice for each clause."""
        state = self.world.task.init
        choices = []
        for number, own in enumerate(sequence):
            steps: list[PlanStep] = []
            for instruction in own:
                added, state = self._done(instruction, state)
                steps += [PlanStep(i, number, latent=i is not instruction) for i in added]
            choices.append(Choice(SAMPLE_SOURCE, tuple(steps), {}, {}))
        return RankedPlan(tuple(choices), state)

    def _done(self, instruction: Instruction, state: Bits) -> tuple[list[Instruction], Bits]:
        operators = self.world.task.by_instruction
        operator = operators.get(instruction)
        if operator is None:
            return [], state
        needed = self._needed(instruction, state)
        if needed is None:
            return [], state
        for each in needed:
            state = operators[each].apply(state)
        after = operator.apply(state)
        if after == state and instruction.args:  # what has no arguments, waiting, changes nothing by itself
            return list(needed), state
        return [*needed, instruction], after

    def _missing(self, instruction: Instruction, state: Bits) -> tuple[Instruction, ...] | None:
        """Return what must be done before an instruction; ``None`` for more than a few instructions."""
        if self.world.task.by_instruction[instruction].applicable(state):
            return ()
        answer = self.planner.fill(state, self.constraints.of((instruction,)))
        return answer.plan if isinstance(answer, Filled) and len(answer.plan) <= _FILLED else None
