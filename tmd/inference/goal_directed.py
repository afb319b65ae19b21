"""Inference with goals: Algorithm 1 over the steps of a text, each of which must reach what it asks for.

Templates, policy and planner propose *how*; the goal of a clause (:mod:`tmd.goals`) says *what*. A proposal that does
not reach it, or that undoes what an earlier clause asked for, is completed by the planner, and is none where that
fails; objects that it handles for nothing are left alone. The energy ranks what is left. What was opened or switched on
by the way is put back where people do so. Not in the paper.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice

from tmd.goals.clause_goal import Refused, Why, passing_predicates, text_of
from tmd.goals.grounder import TRUE
from tmd.goals.text_constraints import TextConstraints
from tmd.goals.text_following import Context, Follower, GoalStep, Role, Target
from tmd.inference.config import InferenceConfig
from tmd.inference.energy import Energy
from tmd.inference.proposers import PLANNER_SOURCE, POLICY_SOURCE, Instructions, Proposal, Proposer, Situation
from tmd.inference.ranking import Choice, Inferred, Path, PlanStep, RankedPlan, Refusal, StepGoal, why_lost
from tmd.language.clause import PERSONS, Clause, Mood, Parsed, Quantifier
from tmd.pddl.model import And, Formula, Instruction
from tmd.pddl.semantics import Constraints as Needs
from tmd.pddl.task import Bits, Cube, Task
from tmd.planning.gap_filler import eliminate, untouched
from tmd.planning.result import Answer, Filled, GaveUp, Planner, Unreachable
from tmd.veil.library import tidy
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


_KEPT_AT_MOST = 4
"""Maximum number of further steps to keep what earlier clauses reached: to open a door again, and to close it."""
_Executable = tuple[Proposal, Instructions, Instructions]
"""A candidate that can be done, what must be done before it, and its own instructions."""
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
        nothing = self._shows_nothing(steps, ways)
        if nothing is not None and constraints == TextConstraints(self.world.task) and not self.config.guess:
            return Inferred((), tuple(text.refusals), (0, nothing))
        ways = _distinct([text.finished(way, state) for way in ways], top)
        plans = [RankedPlan(way.path.choices, way.path.state, goals=way.goals) for way in ways]
        told = tuple(replace(p, why=why_lost(p, plans[0])) if place else p for place, p in enumerate(plans))
        return Inferred(told, tuple(text.refusals))

    def _shows_nothing(self, steps: Sequence[GoalStep], ways: Sequence[_Way]) -> Refused | None:
        """That nothing of a text leaves a trace, as far as this domain goes: *fold the blanket*."""
        asked = [step.clause for step in steps if step.role is Role.MAIN and step.clause.direct]
        goals = [goal for way in ways[:1] for goal in way.goals]
        if not asked or not goals or any(goal.formula != TRUE or not goal.row for goal in goals):
            return None
        message = f"'{text_of(asked[0])}' would leave everything here as it is: no predicate of this domain shows it"
        return Refused(Why.NOT_UNDERSTOOD, message, "say what shall be different afterwards, or allow guesses")


class _Text:
    """The inference of one text."""

    def __init__(
        self, inference: GoalInference, clauses: Sequence[Clause], constraints: TextConstraints, top: int
    ) -> None:
        self.inference = inference
        self.clauses = clauses
        self.task = constraints.task
        self.planner = inference.planner(self.task)
        self.resort: Planner | None = None
        self.far = True
        self.far_answers: dict[tuple[Bits, tuple[Cube, ...]], Answer] = {}
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
        beam = self.inference.config.beam
        kept = list(islice(ends.values(), beam and max(beam, self.top)))
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
        proposed = self._proposed(step, way) if step.role is Role.MAIN else []
        if not guess:
            proposed = [(choice, end) for choice, end in proposed if self._touches_all(step, choice)]
            if not proposed:
                return refused
            # it is said to be done as it was shown, which the policy's own sequences were not
            proposed = [each for each in proposed if each[0].source != POLICY_SOURCE] or proposed
        choices = proposed or [(_NOTHING, way.path.state)]
        return [way.taken(choice, end, way.context, noted) for choice, end in choices]

    def _is_missing(self, noun: str, step: GoalStep) -> bool:
        """Whether a noun that a clause says something of names nothing here, thing or substance."""
        referents = self.inference.follower.reader.referents
        named = not (referents.points_back(noun) or noun in (*step.clause.quantities, *PERSONS))
        return named and not referents.nouns.constants(noun, ("object",), self.inference.world.task.init)

    def _touches_all(self, step: GoalStep, choice: Choice) -> bool:
        """Whether what was shown has to do with everything that the clause names: all of *both bowls*, and the sink."""
        clause, profiles = step.clause, self.inference.world.profiles
        nouns = self.inference.follower.reader.nouns
        handled = {arg for taken in choice.steps for arg in taken.instruction.args}
        handled |= {profiles.wholes[name] for name in handled if name in profiles.wholes}
        for noun in (*clause.direct, *(r.target for r in clause.relations)):
            things = {n for n in nouns.things(noun, self.inference.world.task.init) if n in profiles.objects}
            every = clause.phrase(noun).quantifier is Quantifier.ALL
            if not things and (noun in clause.direct or self._is_missing(noun, step)):
                return False
            if things and not (things <= handled if every else things & handled):
                return False
        return True

    def finished(self, way: _Way, first: Bits) -> _Way:
        """A way through all steps, with what people put back in the end."""
        done = self._put_back(first, way.path.state, way.context, at_once=False)
        if not done or not way.path.choices:
            return way
        last = way.path.choices[-1]
        number = way.goals[-1].clause
        steps = (*last.steps, *(PlanStep(i, number, latent=True) for i in done))
        path = replace(way.path, choices=(*way.path.choices[:-1], replace(last, steps=steps)))
        path = replace(path, state=self._simulated(way.path.state, done))
        goal = way.goals[-1]
        return _Way(path, way.context, (*way.goals[:-1], replace(goal, last=goal.last + len(done))))

    def _towards(self, way: _Way, target: Target) -> list[_Way] | Refused:
        """Every way of reaching the goal of a step that was proposed or planned."""
        found = self._reaching(way, target)
        if isinstance(found, Refused) and self._in_passing(target, way.path.state):
            after = self.inference.follower.reached(target, way.context, way.path.state)
            note = "not all of it at once: done with what follows"
            goal = replace(_step_goal(target), formula=None, note=note)
            return [way.taken(_NOTHING, way.path.state, replace(after, kept=way.context.kept), goal)]
        if isinstance(found, Refused):
            return self._without_goal(target.step, way, found)
        ways = []
        for choice, end in found:
            after = self.inference.follower.reached(target, way.context, end)
            ways.append(way.taken(choice, end, after, _step_goal(target)))
        return ways

    def _in_passing(self, target: Target, state: Bits) -> bool:
        """Whether each part of a goal can be reached, but not all at once, and the next clause goes on with them.

        *Pick up the boxes and the cans and put them in the bag*: nobody has so many hands.
        """
        goal, number = target.goal, target.step.number
        following = self.clauses[number + 1] if number + 1 < len(self.clauses) else None
        if goal is None or not isinstance(goal.formula, And) or following is None or following.mood is not Mood.DO:
            return False
        direct = set(target.step.clause.direct)
        goes_on = any(direct & set(names) for names in following.antecedents.values())
        reader = self.inference.follower.reader
        return goes_on and all(
            isinstance(self.planner.fill(state, reader.grounder.cubes(part)), Filled) for part in goal.formula.parts
        )

    # ------------------------------------------------------------------ planning

    def _reaching(self, way: _Way, target: Target) -> list[tuple[Choice, Bits]] | Refused:
        """What is planned and proposed for the first aim that can be reached.

        Proposals come before the planner that goes far: what was shown is at hand, and better than any plan.
        """
        state = way.path.state
        begun: Instructions = ()
        for ways in target.ways:
            answer: Answer = self.planner.fill(state, ways)
            if isinstance(answer, GaveUp):
                answer = self._far(state, ways)
            if isinstance(answer, Filled):
                begun, state = (*begun, *answer.plan), answer.state
            elif isinstance(answer, Unreachable) and not self.inference.config.guess:
                return Refused(Why.IMPOSSIBLE, f"'{_said(target)}' cannot be done here: {answer.reason}")
        proposals = list(self._executables(target.step, way)) if target.step.role is Role.MAIN else []
        reason = ""
        for aim, answer in self._attempts(state, target.aims):
            if isinstance(answer, Unreachable):
                reason = reason or answer.reason
                continue
            found = [c for p in proposals if (c := self._completed(way, p, target, aim)) is not None]
            if isinstance(answer, GaveUp) and not found:
                answer = self._far(state, aim)
                if isinstance(answer, Filled) and not self._worth_it(state, answer, target.aims[-1]):
                    continue
            if isinstance(answer, Unreachable):
                reason = reason or answer.reason
            if isinstance(answer, Filled):
                own = self._with_put_back(way, (*begun, *answer.plan), target)
                found.append(self._choice(target.step, way, PLANNER_SOURCE, (), own, {"generated": 1.0}, aim))
            if found:
                return found
        if reason:
            return Refused(Why.IMPOSSIBLE, f"'{_said(target)}' cannot be done here: {reason}")
        return Refused(
            Why.GAVE_UP,
            f"no plan was found for '{_said(target)}'; nothing is proven",
            "ask another planner with --planner",
        )

    def _attempts(self, state: Bits, aims: Sequence[tuple[Cube, ...]]) -> Iterator[tuple[tuple[Cube, ...], Answer]]:
        """The aims that are worth a try with the quick planner's answer, the first one first.

        To keep what earlier clauses reached may cost a few steps. If it costs more, nobody meant it: the kettle stays
        hot no longer when its water is poured over the noodles.
        """
        *stronger, last = aims
        least = self.planner.fill(state, last)
        for aim in stronger if not isinstance(least, Unreachable) else ():
            if isinstance(least, Filled) and any(cube.holds(least.state) for cube in aim):
                yield aim, least
                continue
            answer = self.planner.fill(state, aim)
            if isinstance(least, Filled):
                if isinstance(answer, Filled) and len(answer.plan) <= len(least.plan) + _KEPT_AT_MOST:
                    yield aim, answer
            else:
                yield aim, answer
        yield last, least

    def _worth_it(self, state: Bits, answer: Filled, least: Sequence[Cube]) -> bool:
        """Whether what a plan keeps of earlier clauses costs no more than people would give for it."""
        if self.far_answers.get((state, tuple(least))) is answer:
            return True
        bare = self._far(state, least)
        return not isinstance(bare, Filled) or len(answer.plan) <= len(bare.plan) + _KEPT_AT_MOST

    def _far(self, state: Bits, aim: Sequence[Cube]) -> Answer:
        """The answer of the planner that goes further than the quick one."""
        if not (self.far and self.inference.config.last_resort):
            return GaveUp("the quick planner")
        asked = state, tuple(aim)
        if asked not in self.far_answers:
            self.far_answers[asked] = self._further(state, aim)
        return self.far_answers[asked]

    def _further(self, state: Bits, aim: Sequence[Cube]) -> Answer:
        if self.resort is None:
            self.resort = self.inference.resort(self.task)
        # what holds already is seldom undone on the way, and is much to look after for a planner: first without it
        open_ = tuple(dict.fromkeys(Cube(c.positive & ~state, c.negative & state) for c in aim))
        answer = self.resort.fill(state, open_)
        if isinstance(answer, Filled) and not any(cube.holds(answer.state) for cube in aim):
            answer = self.resort.fill(state, aim)
        if isinstance(answer, Filled):
            shorter = eliminate(answer.plan, self.task, state, aim)
            return Filled(shorter, self._simulated(state, shorter), len(shorter))
        return answer

    def _put_back(self, before: Bits, end: Bits, context: Context, *, at_once: bool) -> Instructions:
        """The instructions that undo what people undo by themselves, where that is a short way."""
        goal = self.inference.follower.put_back(before, end, context, at_once=at_once)
        answer = self.planner.fill(end, goal) if goal else None
        return answer.plan if isinstance(answer, Filled) else ()

    def _with_put_back(self, way: _Way, instructions: Instructions, target: Target) -> Instructions:
        """A sequence for a step, and what people undo at once when it is done."""
        end = self._simulated(way.path.state, instructions)
        after = self.inference.follower.reached(target, way.context, end)
        return (*instructions, *self._put_back(way.path.state, end, after, at_once=True))

    # ------------------------------------------------------------------ proposals

    def _proposed(self, step: GoalStep, way: _Way) -> list[tuple[Choice, Bits]]:
        """What templates and policy propose for a step without a goal, as far as it can be done."""
        return [
            self._choice(step, way, candidate.source, latent, own, candidate.raw)
            for candidate, latent, own in self._executables(step, way)
        ]

    def _executables(self, step: GoalStep, way: _Way) -> Iterator[_Executable]:
        """The likeliest candidates that can be done, each with what must be done before it."""
        situation = Situation(self.clauses, step.number, [way.path])
        for candidate in islice(self._queue(situation), self.inference.config.tried):
            if any(i not in self.task.by_instruction for i in candidate.instructions):
                continue
            answer = self.planner.fill(way.path.state, self.inference.needs.of(candidate.instructions))
            if isinstance(answer, Filled):
                yield candidate, answer.plan, candidate.instructions

    def _queue(self, situation: Situation) -> Iterator[Proposal]:
        proposed = []
        for proposer in self.inference.proposers:
            for candidate in proposer.propose(situation):
                if isinstance(candidate, Refusal):
                    self.refusals[candidate] = None
                else:
                    proposed.append(candidate)
        yield from sorted(proposed, key=lambda candidate: candidate.energy)

    def _completed(
        self, way: _Way, proposal: _Executable, target: Target, aim: tuple[Cube, ...]
    ) -> tuple[Choice, Bits] | None:
        """A proposal with what is missing to reach the goal; ``None`` where that is too much, or was missed.

        Objects that it handles for nothing are left alone.
        """
        candidate, latent, own = proposal
        state = way.path.state

        def on_the_way(instructions: Sequence[Instruction]) -> bool:
            trace = list(self._trace(state, instructions))
            return all(any(cube.holds(s) for s in trace for cube in ways) for ways in target.ways)

        def reached(instructions: Sequence[Instruction]) -> bool:
            end = self._simulated(state, instructions)
            return any(cube.holds(end) for cube in aim) and on_the_way(instructions)

        whole = (*latent, *own)
        if not on_the_way(whole):
            return None
        answer = self.planner.fill(self._simulated(state, whole), aim)
        if not isinstance(answer, Filled):
            return None
        whole = tidy((*whole, *answer.plan), self.inference.world, state)
        kept = list(untouched(whole, self.task, state, reached, self._lasting, self._contents))
        first = [i for i in latent if kept and kept[0] == i and kept.pop(0)]
        rest = self._with_put_back(way, (*first, *kept), target)[len(first) :]
        return self._choice(target.step, way, candidate.source, tuple(first), rest, candidate.raw, aim)

    @cached_property
    def _lasting(self) -> Bits:
        """The atoms that do not pass by themselves."""
        passing = passing_predicates(self.task.problem.domain)
        return sum(1 << bit for bit, atom in enumerate(self.task.atoms) if atom.predicate not in passing)

    @cached_property
    def _contents(self) -> Bits:
        """The atoms that say what is in what: though that may be cooked by itself, it does not leave."""
        constants = set(self.inference.world.profiles.constants)
        inside = (len(a.args) == 2 and a.args[0] not in constants and a.args[1] in constants for a in self.task.atoms)
        return sum(1 << bit for bit, found in enumerate(inside) if found)

    def _trace(self, state: Bits, instructions: Sequence[Instruction]) -> Iterator[Bits]:
        yield state
        for instruction in instructions:
            state = self.task.by_instruction[instruction].apply(state)
            yield state

    def _simulated(self, state: Bits, instructions: Sequence[Instruction]) -> Bits:
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
        aim: Sequence[Cube] = (),
    ) -> tuple[Choice, Bits]:
        """A candidate weighed; ``aim`` is what it reaches."""
        energy, world = self.inference.energy, self.inference.world
        state = way.path.state
        middle = self._simulated(state, latent)
        end = self._simulated(middle, own)
        steps = tuple(PlanStep(i, step.number, latent=True) for i in latent)
        steps += tuple(PlanStep(i, step.number, latent=False) for i in own)
        situation = Situation(self.clauses, step.number, [way.path])
        names = world.mentions.meant(situation.clause, [a for i in own for a in i.args], state)
        factors = dict(raw)
        if source == PLANNER_SOURCE:
            factors |= energy.of_sequence(own, len(own), names)
        factors |= energy.of_end(situation.clause.verb, names, end)
        factors |= energy.of_latent(latent, middle)
        if aim:
            asked: Bits = 0
            for cube in aim:
                asked |= cube.positive | cube.negative
            factors["unasked"] = float(((end ^ state) & self._lasting & ~asked).bit_count())
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
