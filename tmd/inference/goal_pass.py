"""The forward pass over steps with goals. Not in the paper.

Templates, policy and planner propose *how*; the candidate goals of a step (:mod:`tmd.readers.interface`) say *what*. A
proposal that does not reach the goal, or that undoes what an earlier step reached, is completed by the planner, and is
dropped where that fails; objects that it handles for nothing are left alone. The energy ranks the rest, the reader's
prior being one factor. A finished plan is improved as a whole (:mod:`tmd.inference.tidying`).
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from itertools import islice, pairwise

from tmd.diagnostics import Refusal, RefusalKind
from tmd.inference.commitments import Commitment, aims, combined, commitments_of, constrained, kept_throughout, violated
from tmd.inference.forward_pass import NOTHING, ForwardPass, InferenceSetup
from tmd.inference.proposers import PLANNER_SOURCE, POLICY_SOURCE, Instructions, Proposal, Situation
from tmd.inference.ranking import Choice, Inferred, LostGoal, PlanStep, StepGoal, Way
from tmd.inference.tidying import Need, PlanPart, Tidying, moved, passes
from tmd.library.library import tidy
from tmd.pddl.domain_traits import single_valued
from tmd.pddl.ground_formula import TRUE, goal_cubes
from tmd.pddl.model import And, Formula, GroundAtom, Instruction
from tmd.pddl.semantics import Constraints
from tmd.pddl.task import Bits, Cube
from tmd.planning.gap_filler import GapFiller, eliminate
from tmd.planning.result import Answer, Filled, GaveUp, Unreachable
from tmd.readers.interface import CandidateGoal, Dialogue, PlanConstraints, Question, QuestionOption, Step
from tmd.world.verb_clause import VerbClause

# Maximum number of further steps to keep what earlier steps reached: to open a door again, and to close it.
_MOST_FURTHER_STEPS = 8
# Plans that are improved beyond those that are wanted, since some may become equal.
_SPARE = 2
# Attempts at a plan that spares what earlier steps did and is not longer than one that does it again.
_MOST_SPARED = 3
# Maximum number of different readings of a request that are followed at a time, each with its own beam.
_MOST_READINGS = 4
_FORBIDDEN = Refusal(RefusalKind.CONTRADICTION, "every plan that was found does what the request forbids")
PRIOR = "reading_prior"
"""The factor of the reader's prior: the negative logarithm of its belief in the candidate goal."""
# A proposal that can be carried out, and the planner's instructions before it.
_Executable = tuple[Proposal, Instructions]


@dataclass(frozen=True, slots=True)
class Target:
    """A candidate goal of a step in one state, with what must hold beside it.

    ``aims`` are what to plan for: the goal with all commitments, then with ever fewer of them. ``ways`` are conditions
    to be reached before the goal.
    """

    step: Step
    goal: CandidateGoal
    already: bool = False
    aims: tuple[tuple[Cube, ...], ...] = ()
    ways: tuple[tuple[Cube, ...], ...] = ()


class GoalPass(ForwardPass):
    """The forward pass over the steps of one dialogue.

    ``top`` is the number of distinct plans; ``chosen`` is as for :meth:`Inference.infer`.
    """

    def __init__(self, setup: InferenceSetup, dialogue: Dialogue, top: int, chosen: Mapping[int, Formula]) -> None:
        task = constrained(setup.world.task, dialogue.constraints)
        super().__init__(setup, dialogue.clauses, task, top)
        self.constraints = Constraints(self.task)
        self.dialogue = dialogue
        self.chosen = chosen
        self._may_go_far = True
        self._far_answer = cache(self._asked_afar)
        self._resort = cache(lambda brief: setup.planners.resort(self.task, brief=brief))

    def infer(self, state: Bits) -> Inferred:
        """Return the best distinct plans for the steps from ``state``, or the reason why there is none."""
        dialogue = self.dialogue
        if dialogue.refusal is not None:
            return Inferred((), (), (None, dialogue.refusal))
        kept = kept_throughout(dialogue.constraints.kept, -1, self.task)
        ways = [Way(0.0, state, memory=dialogue.memory, kept=kept)]
        for number, step in enumerate(dialogue.steps):
            found = self._over(number, step, ways)
            if isinstance(found, Refusal):
                return Inferred((), tuple(self.rejected), (step.number, found))
            ways = found
        refusal = self._without_effect(ways)
        if refusal is None:
            allowed = (w for w in ways if self._allowed(self.world.task.trace(state, w.instructions)))
            ways = sorted(allowed, key=lambda way: way.order)
            ways = self._all_finished(ways, state)
            refusal = None if ways else _FORBIDDEN
        if refusal is not None:
            return Inferred((), tuple(self.rejected), (0, refusal))
        return Inferred(self.ranked(ways), tuple(self.rejected), question=self._question(ways))

    def _over(self, number: int, step: Step, ways: Sequence[Way]) -> list[Way] | Refusal:
        """Return the best ways that lead on over one step, from each of the ways so far."""
        found: list[Way] = []
        refusal: Refusal | None = None
        for way in ways:
            self._may_go_far = not found  # the far planner takes long: only on the best way that leads on
            answer = self._from(number, step, way)
            if isinstance(answer, Refusal):
                refusal = refusal or answer
            else:
                found += answer
        if not found:
            assert refusal is not None
            return refusal
        beam = self.config.beam and max(self.config.beam, self.top)
        readings: dict[tuple[tuple[int, Formula], ...], list[Way]] = {}
        for way in sorted(found, key=lambda way: way.order):
            readings.setdefault(way.readings, []).append(way)
        return [way for group in islice(readings.values(), _MOST_READINGS) for way in self.pruned(group, beam)]

    def _from(self, number: int, step: Step, way: Way) -> list[Way] | Refusal:
        """Return the ways over one step from one way, over all its candidate goals."""
        read = self.dialogue.goals(step, way.state, way.memory)
        if isinstance(read, Refusal):
            return self._without_goal(step, way, read)
        keeps = kept_throughout(read.keeps, step.number, self.task)
        way = replace(way, memory=read.memory, kept=(*way.kept, *keeps))
        if not read.goals:
            goal = StepGoal(step.number, step.text, None, note=read.note)
            return [_taken(way, NOTHING, way.state, goal)]
        candidates = [goal for goal in read.goals if goal.formula == self.chosen.get(number, goal.formula)]
        if len(candidates) < 2:
            return self._to_candidate(step, way, (candidates or read.goals)[0])
        return self._to_candidates(number, step, way, candidates)

    def _to_candidates(
        self, number: int, step: Step, way: Way, candidates: Sequence[CandidateGoal]
    ) -> list[Way] | Refusal:
        """Return the ways to several candidate goals; each says why the other candidates lost."""
        reached: dict[int, list[Way]] = {}
        refusals: dict[int, Refusal] = {}
        for place, candidate in enumerate(candidates):
            taken = replace(way, readings=(*way.readings, (number, candidate.formula)))
            answer = self._to_candidate(step, taken, candidate)
            if isinstance(answer, Refusal):
                refusals[place] = answer
            else:
                reached[place] = answer
        if not reached:
            return refusals[0]
        least = {place: min(w.energy for w in ways) for place, ways in reached.items()}
        found = []
        for own, ways in reached.items():
            others = tuple(
                LostGoal(
                    other.formula,
                    other.explanation,
                    _why_lost(refusals.get(place), least.get(place), least[own]),
                    planned=place in reached,
                )
                for place, other in enumerate(candidates)
                if place != own
            )
            found += [replace(w, goals=(*w.goals[:-1], replace(w.goals[-1], others=others))) for w in ways]
        return found

    def _to_candidate(self, step: Step, way: Way, goal: CandidateGoal) -> list[Way] | Refusal:
        """Return the ways to one candidate goal."""
        if step.jointly and goal.formula != TRUE:
            beside = (step.number, step.number - step.main)
            way = replace(way, kept=tuple(replace(k, hard=k.hard or k.clause in beside) for k in way.kept))
        target = self._target(step, way, goal)
        if isinstance(target, Refusal):
            return target
        found = [(NOTHING, way.state)] if target.already else self._reaching(way, target)
        if not isinstance(found, Refusal):
            return [self._reached(way, target, choice, end) for choice, end in found]
        if self._reached_bit_by_bit(target, way.state):
            note = "postponed: will be achieved together with the next clause"
            postponed = replace(_step_goal(target), formula=None, note=note)
            memory = self.dialogue.reached(goal, way.state, way.memory)
            return [_taken(replace(way, memory=memory), NOTHING, way.state, postponed)]
        return self._without_goal(step, way, found)

    def _reached(self, way: Way, target: Target, choice: Choice, end: Bits) -> Way:
        """Return a way with the choice by which it reached a goal."""
        goal = target.goal
        if goal.formula != TRUE:
            memory = self.dialogue.reached(goal, end, way.memory)
            way = replace(way, memory=memory, kept=self._kept_after(target, way, end))
        return _taken(way, self._with_prior(choice, goal), end, _step_goal(target), self._need(target, way, end))

    def _need(self, target: Target, way: Way, end: Bits) -> Need:
        """Return what the instructions for a goal are for: the goal, and what must be kept at any price."""
        hard = [k for k in way.kept if k.hard and any(c.holds(end) for c in k.ways)]
        reached = tuple(c for c in target.goal.cubes if target.goal.formula != TRUE)
        return Need(combined(reached or (Cube(),), hard), target.ways)

    def _question(self, ways: Sequence[Way]) -> Question | None:
        """Return a question about the first step in which readings of nearly equal energy have different goals."""
        best, *others = sorted(ways, key=lambda way: way.order)
        near = [way for way in others if way.energy <= best.energy + self.config.close]
        for place, (number, formula) in enumerate(best.readings):
            rivals = [w.readings[place][1] for w in near if len(w.readings) > place and w.readings[place][0] == number]
            formulas = tuple(dict.fromkeys((formula, *rivals)))
            if len(formulas) > 1:
                text = f"What is meant by '{self.dialogue.steps[number].text}'?"
                return Question(text, number, tuple(QuestionOption("", each) for each in formulas))
        return None

    def _target(self, step: Step, way: Way, goal: CandidateGoal) -> Target | Refusal:
        """Return what to plan for to reach a goal on a way."""
        if goal.formula == TRUE:
            return Target(step, goal, already=True)
        own = tuple(a for a in aims(goal.cubes, way.kept, goal.released, self.task) if a)
        hard = [k for k in way.kept if k.hard]
        if not goal.cubes:
            return _impossible_goal(step)
        if not own or (hard and not combined(goal.cubes, hard)):
            return Refusal(RefusalKind.CONTRADICTION, f"'{step.clause.text}' contradicts what was said before")
        ways = tuple(goal_cubes(self.task, formula) for formula in goal.via)
        if not all(ways):
            return _impossible_goal(step)
        held = not ways and any(cube.holds(way.state) for cube in own[0])
        return Target(step, goal, held, own, ways)

    def _kept_after(self, target: Target, way: Way, end: Bits) -> tuple[Commitment, ...]:
        """Return the commitments after a step that ended in ``end``."""
        goal = target.goal
        cube = next((c for c in goal.cubes if c.holds(end)), goal.cubes[0])
        hard = {k.ways[:1] for k in way.kept if k.hard}
        fresh = tuple(k for k in commitments_of(cube, target.step.number, self.task) if k.ways[:1] not in hard)
        literals = {k.ways[:1] for k in fresh}
        still = tuple(
            k for k in way.kept if (k.hard or any(c.holds(end) for c in k.ways)) and k.ways[:1] not in literals
        )
        return (*still, *fresh)

    def _with_prior(self, choice: Choice, goal: CandidateGoal) -> Choice:
        """Return a choice with the reader's prior among its factors."""
        if not goal.log_prior:
            return choice
        raw = {**choice.raw, PRIOR: -goal.log_prior}
        return replace(choice, raw=raw, factors=self.setup.energy.weigh(raw))

    # ------------------------------------------------------------------ steps without a goal

    def _without_goal(self, step: Step, way: Way, refusal: Refusal) -> list[Way] | Refusal:
        """Return what demonstrations show for a verb whose goal is unknown, or a guess where guesses are allowed."""
        text = step.text
        if self.config.guess:
            proposed = self._proposed(step, way) if step.main else []
            goal = StepGoal(step.number, text, None, note=f"a guess: {refusal.message}")
            return [_taken(way, choice, end, goal) for choice, end in proposed or [(NOTHING, way.state)]]
        groups = self.dialogue.handled(step) if refusal.kind is RefusalKind.UNKNOWN_VERB and step.main else None
        if groups is None:
            return refusal
        shown = [
            (choice, end)
            for choice, end in self._proposed(step, way)
            if all(_handles(choice, group.names, group.every, self) for group in groups)
        ]
        if not shown:
            return refusal
        # the note says that the step is done as it was shown, which the policy's own sequences were not
        shown = [each for each in shown if each[0].source != POLICY_SOURCE] or shown
        verb = step.clause.verb.replace("_", " ")
        goal = StepGoal(step.number, text, None, note=f"copied from a demonstration; the goal of '{verb}' is unknown")
        return [_taken(way, choice, end, goal) for choice, end in shown]

    def _proposed(self, step: Step, way: Way) -> list[tuple[Choice, Bits]]:
        """Return what templates and policy propose for a step without a goal, as far as it can be carried out."""
        return [self._weighed(step, way, candidate, latent) for candidate, latent in self._executables(step, way)]

    def _without_effect(self, ways: Sequence[Way]) -> Refusal | None:
        """Return a refusal where no predicate of the domain can represent what was asked: *fold the blanket*."""
        asked = [step for step in self.dialogue.steps if step.main and step.direct]
        goals = [goal for way in ways[:1] for goal in way.goals]
        if not asked or not goals or self.config.guess or self.dialogue.constraints != PlanConstraints():
            return None
        if any(goal.formula != TRUE or not goal.row for goal in goals):
            return None
        text = asked[0].text or asked[0].clause.verb.replace("_", " ")
        message = f"no predicate of this domain can represent the result of '{text}'"
        return Refusal(RefusalKind.NOT_UNDERSTOOD, message, "say what shall be different afterwards, or allow guesses")

    def _allowed(self, states: Sequence[Bits]) -> bool:
        """Return whether states bring about nothing that the request forbids."""
        return violated(self.task, self.dialogue.constraints, states) is None

    # ------------------------------------------------------------------ planning

    def _reached_bit_by_bit(self, target: Target, state: Bits) -> bool:
        """Return whether each part of a goal can be reached, but not all at once, and the next clause goes on with it.

        *Pick up the boxes and the cans and put them in the bag*: nobody has so many hands.
        """
        formula = target.goal.formula
        if not isinstance(formula, And) or not target.step.continued or _is_for_places(target.step.clause):
            return False
        return all(isinstance(self.planner.fill(state, goal_cubes(self.task, p)), Filled) for p in formula.parts)

    def _reaching(self, way: Way, target: Target) -> list[tuple[Choice, Bits]] | Refusal:
        """Return what is planned and proposed for the first aim that can be reached.

        Proposals come before the far planner: what was shown is at hand, and better than any plan.
        """
        passed = self._on_the_way(target, way.state)
        if isinstance(passed, Refusal):
            return passed
        begun, state = passed
        proposals = list(self._executables(target.step, way)) if target.step.main else []
        reason = ""
        for wanted, first in self._attempts(state, target.aims):
            aim, quick = self._once(state, wanted, first, target)
            found = self._fit(way, () if isinstance(quick, Unreachable) else proposals, target, aim)
            pure = any(not self._foreign(way.state, end, aim) for _, end in found)
            answer = quick if pure else self._far_if_needed(quick, state, aim, target)
            if answer is not quick:
                aim, answer = self._once(state, aim, answer, target)
            if isinstance(answer, Unreachable):
                reason = reason or answer.reason
            elif isinstance(answer, Filled):
                plan = (*begun, *answer.plan)
                if self.config.guess or self._passes(target, way.state, plan):
                    planned = Proposal(PLANNER_SOURCE, plan, (), {"policy_proposal": 1.0}, 0.0)
                    found.append(self._weighed(target.step, way, planned, (), aim))
            if found:
                return self._undisturbing(found, state)
        if reason:
            return _impossible(target, reason)
        message = f"no plan was found for '{target.step.text}'; nothing is proven"
        return Refusal(RefusalKind.GAVE_UP, message, "ask another planner with --planner")

    def _fit(
        self, way: Way, proposals: Sequence[_Executable], target: Target, aim: tuple[Cube, ...]
    ) -> list[tuple[Choice, Bits]]:
        """Return the proposals completed to an aim, of which those are left that mix in the least unasked."""
        completed = [c for p in proposals if (c := self._completed(way, p, target, aim)) is not None]
        sequences = (tuple(step.instruction for step in choice.steps) for choice, _ in completed)
        pairs = zip(completed, sequences, strict=True)
        found = [c for c, own in pairs if not self._redone(way.state, own, aim, target)]
        foreign = [len(self._foreign(way.state, end, aim)) if self.config.orderly else 0 for _, end in found]
        return [c for c, count in zip(found, foreign, strict=True) if count == min(foreign)]

    def _undisturbing(self, found: Sequence[tuple[Choice, Bits]], state: Bits) -> list[tuple[Choice, Bits]]:
        """Return the choices but for those that move more than another one: all that it moves, and something else."""
        all_moved = [self._moved(state, end) for _, end in found]
        pairs = zip(found, all_moved, strict=True)
        return [choice for choice, own in pairs if not any(other < own for other in all_moved)]

    def _moved(self, state: Bits, end: Bits) -> frozenset[str]:
        """Return the objects that are somewhere else, or have other contents, in ``end``, and the changed contents."""
        changed = state ^ end
        return moved(self.task, changed & self.lasting) | frozenset(map(str, self.task.names(changed & self._contents)))

    def _on_the_way(self, target: Target, state: Bits) -> tuple[Instructions, Bits] | Refusal:
        """Return instructions through the conditions on the way to a goal, and the state they end in.

        A condition that no planner gets to is left to the proposals.
        """
        begun: Instructions = ()
        for ways in target.ways:
            answer: Answer = self.planner.fill(state, ways)
            if isinstance(answer, GaveUp):
                answer = self._far(state, ways)
            if isinstance(answer, Filled):
                begun, state = (*begun, *answer.plan), answer.state
            elif isinstance(answer, Unreachable) and not self.config.guess:
                return _impossible(target, answer.reason)
        return begun, state

    def _passes(self, target: Target, state: Bits, instructions: Sequence[Instruction]) -> bool:
        """Return whether instructions meet the conditions on the way to a goal, in their order."""
        return passes(target.ways, self.world.task.trace(state, instructions))

    def _far_if_needed(self, quick: Answer, state: Bits, aim: tuple[Cube, ...], target: Target) -> Answer:
        """Return the far planner's answer where the quick one gave up, unless its plan keeps too much at any price.

        Where the quick planner reaches the new goal, but not together with the earlier ones, these are often out of
        reach, and the far planner would take minutes to find nothing: it is asked briefly.
        """
        if not isinstance(quick, GaveUp):
            return quick
        least = target.aims[-1]
        answer = self._far(state, aim, brief=aim != least and isinstance(self.planner.fill(state, least), Filled))
        if aim != least and isinstance(answer, Filled) and not self._worth_it(state, answer, least):
            return quick
        return answer

    def _attempts(self, state: Bits, own: Sequence[tuple[Cube, ...]]) -> Iterator[tuple[tuple[Cube, ...], Answer]]:
        """Yield the aims that are worth a try, each with the quick planner's answer.

        Keeping what earlier steps reached may cost a few steps. If it costs more, nobody meant it: the kettle stays hot
        no longer when its water is poured over the noodles.
        """
        *stronger, last = own
        least = self.planner.fill(state, last)
        for unmixed in self._unmixed(state, least.state, own[0]) if isinstance(least, Filled) else ():
            answer = self.planner.fill(state, unmixed)
            if isinstance(answer, Filled) and isinstance(least, Filled) and _little_longer(answer, least):
                yield unmixed, answer
                break
        for aim in stronger if not isinstance(least, Unreachable) else ():
            if isinstance(least, Filled) and any(cube.holds(least.state) for cube in aim):
                yield aim, least
                continue
            answer = self.planner.fill(state, aim)
            if not (isinstance(answer, Filled) and isinstance(least, Filled)) or _little_longer(answer, least):
                yield aim, answer
        yield last, least

    def _once(
        self, state: Bits, aim: tuple[Cube, ...], answer: Answer, target: Target
    ) -> tuple[tuple[Cube, ...], Answer]:
        """Return an aim and a plan for it that does nothing over again that earlier steps did.

        The kettle stays hot no longer when its water is poured over the noodles. Where the plan can do without undoing
        it, the aim stays as it is.
        """
        while isinstance(answer, Filled) and (redone := self._redone(state, answer.plan, aim, target)):
            spare = self._sparing(state, aim, answer, target)
            if spare is not None:
                return aim, spare
            fewer = tuple(dict.fromkeys(Cube(c.positive & ~redone, c.negative) for c in aim))
            other = self.planner.fill(state, fewer)
            if isinstance(other, GaveUp):
                other = self._far(state, fewer, brief=True)
            if not isinstance(other, Filled):
                break
            aim, answer = fewer, other
        return aim, answer

    def _redone(self, state: Bits, instructions: Instructions, aim: Sequence[Cube], target: Target) -> Bits:
        """Return what earlier steps did, and instructions undo and do again: contents, what is hot or runs."""
        trace = self.world.task.trace(state, instructions)
        cube = next((c for c in aim if c.holds(trace[-1])), Cube())
        own = next((c for c in target.aims[-1] if c.holds(trace[-1])), Cube())
        kept = cube.positive & ~own.positive & state & self._made
        always = kept
        for each in trace:
            always &= each
        return kept & ~always

    def _sparing(self, state: Bits, aim: tuple[Cube, ...], answer: Filled, target: Target) -> Filled | None:
        """Return a plan that undoes nothing of what ``answer`` undoes and does again, where it is not longer."""
        usable, plan = self.task.by_instruction, answer.plan
        for _ in range(_MOST_SPARED):
            redone, trace = self._redone(state, plan, aim, target), self.world.task.trace(state, plan)
            undoing = {i for i, (a, b) in zip(plan, pairwise(trace), strict=True) if redone & a & ~b}
            usable = {i: operator for i, operator in usable.items() if i not in undoing}
            task = replace(self.task, operators=tuple(usable.values()), by_instruction=usable)
            found = GapFiller(task, cap=self.config.cap).fill(state, aim)
            if not isinstance(found, Filled) or len(found.plan) > len(answer.plan):
                return None
            plan = found.plan
            if not self._redone(state, plan, aim, target):
                return found
        return None

    @cached_property
    def _made(self) -> Bits:
        """The atoms that say what is in what, or tell of one thing alone."""
        return self._contents | self.task.where(lambda atom: len(atom.args) == 1)

    def _foreign(self, state: Bits, end: Bits, aim: Sequence[Cube]) -> frozenset[str]:
        """Return what else came into the vessels of an aim from ``state`` to ``end``: coffee, to heat milk."""
        cube = next((c for c in aim if c.holds(end)), Cube())
        vessels = {atom.args[0] for atom in self.task.names(cube.positive & self._contents)}
        gained = self.task.names(end & ~state & ~cube.positive & self._contents)
        return frozenset(atom.args[1] for atom in gained if atom.args[0] in vessels)

    def _unmixed(self, state: Bits, end: Bits, aim: Sequence[Cube]) -> Iterator[tuple[Cube, ...]]:
        """Yield an aim without what else came into its vessels from ``state`` to ``end``, then without parts of that.

        Nobody wants coffee in the hot milk, but noodles are cooked in water.
        """
        others = sorted(self._foreign(state, end, aim))
        for contents in (others, *([other] for other in others if len(others) > 1)) if others else ():
            yield tuple(self._without(cube, contents, state) for cube in aim)

    def _without(self, cube: Cube, contents: Collection[str], state: Bits) -> Cube:
        """Return a cube without some contents in its vessels, unless they are there in ``state`` or asked for."""
        vessels = {atom.args[0] for atom in self.task.names(cube.positive & self._contents)}
        atoms = self.task.names(self._contents & ~cube.positive & ~state)
        unwanted = self.task.encode(a for a in atoms if a.args[0] in vessels and a.args[1] in contents)
        return Cube(cube.positive, cube.negative | unwanted)

    def _worth_it(self, state: Bits, answer: Filled, least: Sequence[Cube]) -> bool:
        """Return whether keeping earlier goals costs no more steps than people would take for it."""
        quick = self.planner.fill(state, least)
        bare = quick if isinstance(quick, Filled) else self._far(state, least)
        return not isinstance(bare, Filled) or _little_longer(answer, bare)

    def _far(self, state: Bits, aim: Sequence[Cube], *, brief: bool = False) -> Answer:
        """Return the answer of the planner that goes further than the quick one."""
        if not (self._may_go_far and self.config.last_resort):
            return GaveUp("the quick planner")
        return self._far_answer(state, tuple(aim), brief)

    def _asked_afar(self, state: Bits, aim: tuple[Cube, ...], brief: bool) -> Answer:
        resort = self._resort(brief)
        # facts that hold already are seldom undone on the way and slow the planner down: first without them
        open_ = tuple(dict.fromkeys(Cube(c.positive & ~state, c.negative & state) for c in aim))
        answer = resort.fill(state, open_)
        if isinstance(answer, Filled) and not any(cube.holds(answer.state) for cube in aim):
            # where no way is short, first the alternative that is near without them: far ways to several take long
            near = tuple(c for c in aim if Cube(c.positive & ~state, c.negative & state).holds(answer.state))
            asked = ((resort, aim),) if brief else ((self._resort(True), aim), (resort, near))
            answers = (planner.fill(state, cubes) for planner, cubes in asked)
            answer = next((a for a in answers if not isinstance(a, GaveUp)), GaveUp("the planner"))
        return self._shortened(state, answer, aim) if isinstance(answer, Filled) else answer

    def _shortened(self, state: Bits, answer: Filled, aim: Sequence[Cube]) -> Filled:
        """Return a far plan without what it does not need, or one that mixes nothing in and is little longer."""
        shorter = eliminate(answer.plan, self.task, state, aim)
        cost = sum(self.task.by_instruction[i].cost for i in shorter)
        answer = Filled(shorter, self.world.task.trace(state, shorter)[-1], cost)
        for unmixed in self._unmixed(state, answer.state, aim):
            other = self._resort(True).fill(state, unmixed)
            if isinstance(other, Filled) and _little_longer(other, answer):
                return other
        return answer

    # ------------------------------------------------------------------ proposals

    def _executables(self, step: Step, way: Way) -> Iterator[_Executable]:
        """Yield the likeliest candidates that can be carried out, each with what must be done before it."""
        situation = Situation(self.clauses, step.number, way)
        candidates = (candidate for _, _, candidate in self.queue([situation]))
        for candidate in islice(candidates, self.config.tried):
            if any(i not in self.task.by_instruction for i in candidate.instructions):
                continue
            answer = self.planner.fill(way.state, self.constraints.of(candidate.instructions))
            if isinstance(answer, Filled):
                yield candidate, answer.plan

    def _completed(
        self, way: Way, proposal: _Executable, target: Target, aim: tuple[Cube, ...]
    ) -> tuple[Choice, Bits] | None:
        """Return a proposal completed to the goal; ``None`` where that takes too much, or a condition on the way fails.

        Objects that it handles for nothing are left alone.
        """
        candidate, latent = proposal
        state = way.state
        whole = (*latent, *candidate.instructions)
        if not self._passes(target, state, whole):
            return None
        answer = self.planner.fill(self.world.task.trace(state, whole)[-1], aim)
        if not isinstance(answer, Filled):
            return None
        whole = tidy((*whole, *answer.plan), self.world, state)
        kept = list(self._tidying.pruned(state, PlanPart(whole, Need(aim, target.ways))))
        first = [i for i in latent if kept and kept[0] == i and kept.pop(0)]
        return self._weighed(target.step, way, replace(candidate, instructions=tuple(kept)), tuple(first), aim)

    def _weighed(
        self, step: Step, way: Way, proposal: Proposal, latent: Instructions, aim: Sequence[Cube] = ()
    ) -> tuple[Choice, Bits]:
        """Return the choice of a candidate, and the state it ends in; ``aim`` is what it reaches."""
        situation, own, raw = Situation(self.clauses, step.number, way), proposal.instructions, proposal.raw
        names = self.world.mentions.meant(situation.clause, [a for i in own for a in i.args], way.state)
        if proposal.source == PLANNER_SOURCE:
            raw = {**raw, **self.setup.energy.of_sequence(own, len(own), names)}
        return self.weighed(situation, replace(proposal, names=names, raw=raw), latent, aim)

    @cached_property
    def _contents(self) -> Bits:
        """The atoms that say what is in what: food may be cooked by waiting, but it does not leave."""
        constants, values = set(self.world.profiles.constants), single_valued(self.task.problem.domain)

        def inside(atom: GroundAtom) -> bool:
            pair = len(atom.args) == 2 and atom.predicate not in values
            return pair and atom.args[0] not in constants and atom.args[1] in constants

        return self.task.where(inside)

    # ------------------------------------------------------------------ the whole plan

    @cached_property
    def _tidying(self) -> Tidying:
        restored, orderly = self.setup.restored, self.config.orderly
        return Tidying(self.task, self.planner, restored, self.lasting, self._contents, self._allowed, orderly)

    def _all_finished(self, ways: Sequence[Way], first: Bits) -> list[Way]:
        """Return the best ways, improved; where too many become equal, others follow as they are."""
        finished = {
            way.instructions: way for way in reversed([self._finished(w, first) for w in ways[: self.top + _SPARE]])
        }
        others = [way for way in ways[1:] if way.instructions not in finished]
        return [*reversed(finished.values()), *others[: max(self.top - len(finished), 0)]]

    def _finished(self, way: Way, first: Bits) -> Way:
        """Return a way through all steps, improved as a whole: with an end that people leave, and nothing needless."""
        if not way.instructions:
            return way
        plan = tuple(
            PlanPart(tuple(s.instruction for s in choice.steps), need)
            for choice, need in zip(way.choices, way.needs, strict=True)
        )
        # the last goal may be reached in another of its ways; later clauses speak of how the others were
        last = way.goals[-1].clause
        alone = not way.needs[-1].fixed and sum(goal.clause == last for goal in way.goals) == 1
        lasting = [k for k in way.kept if k.hard or not alone or k.clause != last]
        kept = combined((Cube(),), [k for k in lasting if any(c.holds(way.state) for c in k.ways)])
        better = self._tidying.improved(first, plan, kept)
        if better == plan:
            return way
        choices, goals, at = [], [], 0
        for choice, goal, segment in zip(way.choices, way.goals, better, strict=True):
            choices.append(_with_instructions(choice, segment.instructions, goal.clause))
            goals.append(replace(goal, first=at, last=at + len(segment.instructions)))
            at += len(segment.instructions)
        *_, end = self.world.task.trace(first, (i for segment in better for i in segment.instructions))
        return replace(way, state=end, choices=tuple(choices), goals=tuple(goals))


@dataclass(frozen=True)
class Inference(InferenceSetup):
    """Inference in one environment: one engine for all presets.

    Nothing of a request is kept between calls, so threads may share it.
    """

    def infer(
        self, dialogue: Dialogue, state: Bits, top: int = 1, chosen: Mapping[int, Formula] | None = None
    ) -> Inferred:
        """Return the ``top`` best distinct plans for a request.

        ``chosen`` has the answers to questions: for numbers of :attr:`Dialogue.steps` the goal that is meant.
        """
        if self.config.goals:
            return GoalPass(self, dialogue, top, chosen or {}).infer(state)
        return self.infer_clauses(dialogue.clauses, state, top)

    def infer_clauses(self, clauses: Sequence[VerbClause], state: Bits, top: int = 1) -> Inferred:
        """Return the ``top`` best distinct plans for clauses without goals: Algorithm 1 of the paper."""
        return ForwardPass(self, clauses, self.world.task, top).infer(state)


def _taken(way: Way, choice: Choice, end: Bits, goal: StepGoal, need: Need | None = None) -> Way:
    """Return a way with the choice for one more step, with its goal and what the choice is for."""
    before = len(way.instructions)
    placed = replace(goal, first=before, last=before + len(choice.steps))
    need = need or Need(fixed=bool(choice.steps))
    return replace(way.extended(choice, end), goals=(*way.goals, placed), needs=(*way.needs, need))


def _with_instructions(choice: Choice, instructions: Instructions, clause: int) -> Choice:
    """Return a choice with other instructions; those that it did not have are latent."""
    known = list(choice.steps)
    steps = []
    for instruction in instructions:
        at = next((at for at, step in enumerate(known) if step.instruction == instruction), None)
        steps.append(PlanStep(instruction, clause, latent=True) if at is None else known[at])
        known = known if at is None else known[at + 1 :]
    return replace(choice, steps=tuple(steps))


def _handles(choice: Choice, names: frozenset[str], every: bool, own: GoalPass) -> bool:
    """Return whether a choice handles one, or every one, of some objects; a part counts as its whole."""
    profiles = own.world.profiles
    handled = {arg for taken in choice.steps for arg in taken.instruction.args}
    handled |= {profiles.wholes[name] for name in handled if name in profiles.wholes}
    return names <= handled if every else bool(names & handled)


def _is_for_places(clause: VerbClause) -> bool:
    """Return whether a clause wants one thing in several places: it never gets there bit by bit."""
    sources = [source for _, source, _ in clause.resolved_relations() if source]
    return len(sources) > len(set(sources))


def _impossible(target: Target, reason: str) -> Refusal:
    return Refusal(RefusalKind.IMPOSSIBLE, f"'{target.step.text}' cannot be done here: {reason}")


def _impossible_goal(step: Step) -> Refusal:
    return Refusal(RefusalKind.IMPOSSIBLE, f"the goal of '{step.text}' contradicts itself or can never hold here")


def _why_lost(refusal: Refusal | None, energy: float | None, best: float) -> str:
    """Return why another candidate goal was not taken."""
    if refusal is not None or energy is None:
        return refusal.message if refusal is not None else "no plan was found"
    if energy > best:
        return f"energy {energy - best:+.4g}"
    return "it costs more in the end"


def _little_longer(answer: Filled, least: Filled) -> bool:
    """Return whether a plan that keeps what earlier steps reached has not too many steps more than the least."""
    return len(answer.plan) <= len(least.plan) + _MOST_FURTHER_STEPS


def _step_goal(target: Target) -> StepGoal:
    goal = target.goal
    notes = (("nothing that a state shows",) if goal.formula == TRUE else ()) + goal.notes
    note = "; ".join(n for n in notes if n)
    step = target.step
    return StepGoal(step.number, step.text, goal.formula, goal.source, goal.explanation, target.already, note)
