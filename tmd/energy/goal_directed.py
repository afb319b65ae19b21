"""Inference with goals: Algorithm 1 over the steps of a text, each of which must reach what it asks for.

Templates, policy and planner propose *how*; the goal of a clause (:mod:`tmd.goals`) says *what*. A proposal that does
not reach it, or that undoes what an earlier clause asked for, is completed by the planner, and is none where that
fails. The energy ranks what is left. Not in the paper.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice

from tmd.energy.config import InferenceConfig
from tmd.energy.constraints import Constraints as Needs
from tmd.energy.energy import Energy
from tmd.energy.plans import Choice, Inferred, Path, RankedPlan, Refusal, Step, StepGoal, why_lost
from tmd.energy.proposers import PLANNER_SOURCE, Candidate, Instructions, Proposer, Situation
from tmd.goals.clause_goal import Refused, Why
from tmd.goals.follow import Constraints, Context, Follower, Target
from tmd.goals.steps import Role
from tmd.goals.steps import Step as GoalStep
from tmd.language.clause import Clause, Parsed
from tmd.pddl.model import And, Formula
from tmd.pddl.task import Bits, Cube, Task
from tmd.planning.eliminate import eliminate
from tmd.planning.result import Filled, Planner, Unreachable
from tmd.veil.world import World

PlannerOf = Callable[[Task], Planner]
"""Makes a planner for a task: the one of the environment, or it without what must not be done."""


@dataclass(frozen=True, slots=True)
class _Way:
    """A way through the first steps, with what must be known of it for the next."""

    path: Path
    context: Context
    goals: tuple[StepGoal, ...] = ()

    def taken(self, choice: Choice, end: Bits, context: Context, goal: StepGoal) -> _Way:
        """The way with what was chosen for one more step."""
        before = len(self.path.instructions)
        placed = replace(goal, first=before, last=before + len(choice.steps))
        return _Way(self.path.extended(choice, end), context, (*self.goals, placed))


_NOTHING = Choice(None, (), {}, {})


class GoalInference:
    """Inference in one environment, with goals.

    Args:
        world: The environment.
        energy: The factors, weighed.
        proposers: They propose candidates, and judge them.
        config: The model.
        follower: Says what each step asks for.
        planner: Makes the planner that fills gaps and reaches goals.
        resort: Makes the planner that is asked where that one gives up.
        shown: Whether a demonstration has the verb of a clause.
    """

    def __init__(
        self,
        world: World,
        energy: Energy,
        proposers: Sequence[Proposer],
        config: InferenceConfig,
        follower: Follower,
        planner: PlannerOf,
        resort: PlannerOf,
        shown: Callable[[Clause], bool],
    ) -> None:
        self.world = world
        self.energy = energy
        self.proposers = tuple(proposers)
        self.config = config
        self.follower = follower
        self.planner = planner
        self.resort = resort
        self.shown = shown
        self.needs = Needs(world.task)

    def infer(self, parsed: Parsed, state: Bits, top: int = 1) -> Inferred:
        """The ``top`` best distinct plans for a text from ``state``, or why there is none."""
        begun = self.follower.begin(parsed, state)
        if isinstance(begun, Refused):
            return Inferred((), (), (0, begun))
        steps, context, constraints = begun
        text = _Text(self, parsed.clauses, constraints, top)
        ways = [_Way(Path(0.0, state), context)]
        for step in steps:
            found = text.forward(step, ways)
            if isinstance(found, Refused):
                return Inferred((), tuple(text.refusals), (step.number, found))
            ways = found
        plans = [RankedPlan(way.path.choices, way.path.state, goals=way.goals) for way in _distinct(ways, top)]
        told = tuple(replace(p, why=why_lost(p, plans[0])) if place else p for place, p in enumerate(plans))
        return Inferred(told, tuple(text.refusals))


class _Text:
    """The inference of one text."""

    def __init__(self, inference: GoalInference, clauses: Sequence[Clause], constraints: Constraints, top: int) -> None:
        self.inference = inference
        self.clauses = clauses
        self.task = constraints.task
        self.planner = inference.planner(self.task)
        self.resort: Planner | None = None
        self.far = True
        self.top = top
        self.refusals: dict[Refusal, None] = {}

    def forward(self, step: GoalStep, ways: Sequence[_Way]) -> list[_Way] | Refused:
        """One step, from each of the ways so far; the best that lead on."""
        found: list[_Way] = []
        refused: Refused | None = None
        for way in ways:
            self.far = not found  # what takes long is planned for once, on the best way that there is
            answer = self._from(step, way)
            if isinstance(answer, Refused):
                refused = refused or answer
            else:
                found += answer
        if not found:
            assert refused is not None
            return refused
        ends: dict[Bits, list[_Way]] = {}
        for way in sorted(found, key=lambda way: way.path.order):
            ends.setdefault(way.path.state, []).append(way)
        kept = list(islice(ends.values(), self.inference.config.beam))
        return [way for same in kept for way in _distinct(same, self.top)]

    def _from(self, step: GoalStep, way: _Way) -> list[_Way] | Refused:
        follower = self.inference.follower
        said = follower.target(step, way.context, way.path.state)
        if isinstance(said, Refused):
            return self._without_goal(step, way, said)
        target, context = said
        if target.goal is None or target.already:
            goal = _step_goal(target)
            after = follower.reached(target, context, way.path.state)
            return [way.taken(_NOTHING, way.path.state, after, goal)]
        return self._towards(replace(way, context=context), target)

    def _without_goal(self, step: GoalStep, way: _Way, refused: Refused) -> list[_Way] | Refused:
        """What was shown for the verb, where it was shown and nothing says what for, or where a guess is allowed."""
        guess = self.inference.config.guess
        shown = refused.why is Why.UNKNOWN_VERB and self.inference.shown(step.clause) and step.role is Role.MAIN
        if not (guess or shown):
            return refused
        noted = _noted(step, refused) if guess else _as_shown(step)
        proposed = self._proposed(step, way, None) if step.role is Role.MAIN else []
        if not proposed and not guess:
            return refused
        choices = proposed or [(_NOTHING, way.path.state)]
        return [way.taken(choice, end, way.context, noted) for choice, end in choices]

    def _towards(self, way: _Way, target: Target) -> list[_Way] | Refused:
        """Every way of reaching the goal of a step that was proposed or planned."""
        planned = self._planned(target, way.path.state)
        if isinstance(planned, Refused) and self._in_passing(target, way.path.state):
            after = self.inference.follower.reached(target, way.context, way.path.state)
            note = "not all of it at once: done with what follows"
            goal = replace(_step_goal(target), formula=None, note=note)
            return [way.taken(_NOTHING, way.path.state, replace(after, kept=way.context.kept), goal)]
        if isinstance(planned, Refused):
            return self._without_goal(target.step, way, planned)
        instructions, aim = planned
        found = []
        candidates = [self._choice(target.step, way, PLANNER_SOURCE, (), instructions, {"generated": 1.0})]
        if target.step.role is Role.MAIN:
            candidates += self._proposed(target.step, way, (target, aim))
        for choice, end in candidates:
            after = self.inference.follower.reached(target, way.context, end)
            found.append(way.taken(choice, end, after, _step_goal(target)))
        return found

    def _in_passing(self, target: Target, state: Bits) -> bool:
        """Whether each part of a goal can be reached, but not all at once, and the next clause goes on with them.

        *Pick up the boxes and the cans and put them in the bag*: nobody has so many hands.
        """
        goal, number = target.goal, target.step.number
        following = self.clauses[number + 1] if number + 1 < len(self.clauses) else None
        if goal is None or not isinstance(goal.formula, And) or following is None:
            return False
        direct = set(target.step.clause.direct)
        goes_on = any(direct & set(names) for names in following.antecedents.values())
        reader = self.inference.follower.reader
        return goes_on and all(
            isinstance(self.planner.fill(state, reader.grounder.cubes(part)), Filled) for part in goal.formula.parts
        )

    # ------------------------------------------------------------------ planning

    def _planned(self, target: Target, state: Bits) -> tuple[Instructions, tuple[Cube, ...]] | Refused:
        """The planner's way to the goal, with what must be so on the way; and which aim could be reached."""
        begun: Instructions = ()
        for ways in target.ways:
            answer = self._fill(state, ways, far=False)
            if isinstance(answer, Filled):
                begun, state = (*begun, *answer.plan), answer.state
        reason = ""
        for aim in target.aims:
            answer = self._fill(state, aim)
            if isinstance(answer, Filled):
                return (*begun, *answer.plan), aim
            if isinstance(answer, Unreachable):
                reason = reason or answer.reason
        if reason:
            return Refused(Why.IMPOSSIBLE, f"'{_said(target)}' cannot be done here: {reason}")
        return Refused(
            Why.GAVE_UP,
            f"no plan was found for '{_said(target)}'; nothing is proven",
            "ask another planner with --planner",
        )

    def _fill(self, state: Bits, aim: Sequence[Cube], *, far: bool = True) -> Filled | Unreachable | None:
        """The quick planner's answer, or else that of the one that goes further."""
        answer = self.planner.fill(state, aim)
        if isinstance(answer, Filled | Unreachable) or not (far and self.far and self.inference.config.last_resort):
            return answer if isinstance(answer, Filled | Unreachable) else None
        if self.resort is None:
            self.resort = self.inference.resort(self.task)
        answer = self.resort.fill(state, aim)
        if isinstance(answer, Filled):
            shorter = eliminate(answer.plan, self.task, state, aim)
            return Filled(shorter, self._simulated(state, shorter), len(shorter))
        return answer if isinstance(answer, Unreachable) else None

    # ------------------------------------------------------------------ proposals

    def _proposed(
        self, step: GoalStep, way: _Way, wanted: tuple[Target, tuple[Cube, ...]] | None
    ) -> list[tuple[Choice, Bits]]:
        """What templates and policy propose, as far as it reaches the goal, or can be completed so that it does."""
        situation = Situation(self.clauses, step.number, [way.path])
        found: list[tuple[Choice, Bits]] = []
        for candidate in islice(self._queue(situation), self.inference.config.tried):
            answer = self._executable(candidate, way.path.state)
            if answer is None:
                continue
            latent, own = answer
            whole = (*latent, *own)
            if wanted is not None:
                rest = self._completed(way.path.state, whole, *wanted)
                if rest is None:
                    continue
                own = (*own, *rest)
            found.append(self._choice(step, way, candidate.source, latent, own, candidate.raw))
        return found

    def _queue(self, situation: Situation) -> Iterator[Candidate]:
        proposed = []
        for proposer in self.inference.proposers:
            for candidate in proposer.propose(situation):
                if isinstance(candidate, Refusal):
                    self.refusals[candidate] = None
                else:
                    proposed.append(candidate)
        yield from sorted(proposed, key=lambda candidate: candidate.energy)

    def _executable(self, candidate: Candidate, state: Bits) -> tuple[Instructions, Instructions] | None:
        """What must be done before a candidate, and the candidate; ``None`` where it cannot be done, or must not."""
        if any(i not in self.task.by_instruction for i in candidate.instructions):
            return None
        answer = self.planner.fill(state, self.inference.needs.of(candidate.instructions))
        return (answer.plan, candidate.instructions) if isinstance(answer, Filled) else None

    def _completed(
        self, state: Bits, instructions: Instructions, target: Target, aim: tuple[Cube, ...]
    ) -> Instructions | None:
        """What is missing after ``instructions`` to reach the goal; ``None`` where that is too much, or was missed."""
        for ways in target.ways:
            if not any(cube.holds(s) for s in self._trace(state, instructions) for cube in ways):
                return None
        end = self._simulated(state, instructions)
        answer = self.planner.fill(end, aim)
        return answer.plan if isinstance(answer, Filled) else None

    def _trace(self, state: Bits, instructions: Instructions) -> Iterator[Bits]:
        yield state
        for instruction in instructions:
            state = self.task.by_instruction[instruction].apply(state)
            yield state

    def _simulated(self, state: Bits, instructions: Instructions) -> Bits:
        for instruction in instructions:
            state = self.inference.world.task.by_instruction[instruction].apply(state)
        return state

    def _choice(
        self,
        step: GoalStep,
        way: _Way,
        source: str,
        latent: Instructions,
        own: Instructions,
        raw: Mapping[str, float],
    ) -> tuple[Choice, Bits]:
        """A candidate weighed."""
        energy, world = self.inference.energy, self.inference.world
        state = way.path.state
        middle = self._simulated(state, latent)
        end = self._simulated(middle, own)
        steps = tuple(Step(i, step.number, latent=True) for i in latent)
        steps += tuple(Step(i, step.number, latent=False) for i in own)
        situation = Situation(self.clauses, step.number, [way.path])
        names = world.mentions.meant(situation.clause, [a for i in own for a in i.args], state)
        factors = dict(raw)
        if source == PLANNER_SOURCE:
            factors |= energy.of_sequence(own, len(own), names)
        factors |= energy.of_end(situation.clause.verb, names, end)
        factors |= energy.of_latent(latent, middle)
        for proposer in self.inference.proposers:
            factors |= proposer.judge(situation, (*latent, *own), end)
        return Choice(source, steps, energy.weigh(factors), factors), end


def _distinct(ways: Sequence[_Way], count: int) -> list[_Way]:
    """The ``count`` cheapest ways that differ in what is done."""
    kept: dict[Instructions, _Way] = {}
    for way in sorted(ways, key=lambda way: way.path.order):
        if len(kept) == count:
            break
        kept.setdefault(way.path.instructions, way)
    return list(kept.values())


def _said(target: Target) -> str:
    return " ".join(target.step.clause.text.split())


def _step_goal(target: Target) -> StepGoal:
    goal = target.goal
    formula: Formula | None = goal.formula if goal is not None else None
    row = goal.row if goal is not None else None
    note = "; ".join(n for n in (target.note, *(goal.notes if goal is not None else ())) if n)
    return StepGoal(
        target.step.number,
        _said(target),
        formula,
        row.source if row is not None else "",
        row.pattern if row is not None else "",
        target.already,
        note,
    )


def _as_shown(step: GoalStep) -> StepGoal:
    """A step whose verb was shown too seldom to tell what it is for."""
    verb = step.clause.verb.replace("_", " ")
    note = f"done as it was shown: nothing says what '{verb}' is to bring about"
    return StepGoal(step.number, " ".join(step.clause.text.split()), None, note=note)


def _noted(step: GoalStep, refused: Refused) -> StepGoal:
    """A step without a goal: what is done for it is a guess."""
    return StepGoal(step.number, " ".join(step.clause.text.split()), None, note=f"a guess: {refused.message}")
