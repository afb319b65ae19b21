"""Checks of a model's reply against the domain: every formula must be accepted by PDDL."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from tmd.diagnostics import Refusal, RefusalKind, TmdError, one_line
from tmd.goals.reasons import why_never
from tmd.language.clause import Clause, Mood, Parsed, Skipped, Span
from tmd.language.lexicon.lexicon import section
from tmd.language.syntax.antecedents import is_pronoun
from tmd.pddl.ground_formula import FALSE, TRUE, goal_cubes, instantiated
from tmd.pddl.grounding.ground_task import ground_condition
from tmd.pddl.model import Atom, Formula, GroundAtom, conjuncts
from tmd.pddl.reading.reader import with_goal
from tmd.pddl.reading.syntax import nearest
from tmd.pddl.task import Cube
from tmd.pddl.writer import format_formula
from tmd.readers.interface import CandidateGoal, PlanConstraints, Question, QuestionOption, Step
from tmd.readers.llm.reply import Reply, ReplyConstraint, ReplyQuestion, ReplyRefusalKind, ReplyStep
from tmd.world.world import World

# The source of goals that a language model proposed.
SOURCE = "model"
_MOST_STEPS = 40
_MOST_OPTIONS = 4
_MOST_NOUNS = 40
_LONGEST_VERB = 60
_UNCOVERED = "no step of the reading covers it"
_KINDS = {
    ReplyRefusalKind.MISSING: RefusalKind.NO_SUCH_THING,
    ReplyRefusalKind.IMPOSSIBLE: RefusalKind.IMPOSSIBLE,
    ReplyRefusalKind.UNSAFE: RefusalKind.UNSAFE,
    ReplyRefusalKind.NO_REQUEST: RefusalKind.NO_REQUEST,
    ReplyRefusalKind.NOT_UNDERSTOOD: RefusalKind.NOT_UNDERSTOOD,
}
_WORD = re.compile(r"\w+(?:['\u2019-]\w+)*")


@dataclass(frozen=True, slots=True)
class ModelStep(Step):
    """A step as a model proposed it.

    Attributes:
        candidates: Its candidate goals, the likeliest first.
        when: The condition that guards it; ``None`` where there is none.
        otherwise: Whether it is done exactly when the guard of the step before failed.
    """

    candidates: tuple[CandidateGoal, ...] = ()
    when: Formula | None = None
    otherwise: bool = False


@dataclass(frozen=True, slots=True)
class ModelReading:
    """A reply that was accepted.

    Attributes:
        parsed: Its clauses, and the pieces of the request that none of them covers.
        steps: The steps in the order of doing.
        refusal: Why the model refuses the request; ``None`` where it does not.
        question: Its question to the user; ``None`` where it has none.
    """

    parsed: Parsed
    steps: tuple[ModelStep, ...] = ()
    constraints: PlanConstraints = field(default_factory=PlanConstraints)
    refusal: Refusal | None = None
    question: Question | None = None
    thoughts: str = ""


class ReplyChecker:
    """The checks of replies to one request in one environment."""

    def __init__(self, request: str, world: World) -> None:
        self.request = request
        self.world = world
        self.task = world.task
        self.faults: list[str] = []

    def read(self, reply: Reply) -> ModelReading | list[str]:
        """Return the reading, or all its faults, in words for the model."""
        self.faults = []
        thoughts = _short(reply.thoughts)
        if reply.refusal is not None:
            reason = _short(reply.refusal.reason) or "no reason was given"
            refusal = Refusal(_KINDS[reply.refusal.kind], reason)
            return ModelReading(Parsed(self.request, ()), refusal=refusal, thoughts=thoughts)
        if not reply.steps and not reply.constraints:
            return ["the reply has neither steps nor constraints nor a refusal"]
        if len(reply.steps) > _MOST_STEPS:
            return [f"the reply has {len(reply.steps)} steps, more than {_MOST_STEPS}"]
        clauses = tuple(self._clause(step, f"steps[{n}]") for n, step in enumerate(reply.steps))
        steps, question = self._steps(reply, clauses)
        constraints, avoided = self._constraints(reply.constraints)
        if self.faults:
            return self.faults
        skipped = self._uncovered([clause.span for clause in (*clauses, *avoided)])
        if not avoided and not any(step.when is not None or step.otherwise for step in steps):
            turning = [_short(piece.text) for piece in skipped if _turns(piece.text)]
            if turning:
                return [f"no step and no constraint covers '{text}', which changes what is asked" for text in turning]
        parsed = Parsed(self.request, clauses, skipped, avoided)
        return ModelReading(parsed, tuple(steps), constraints, question=question, thoughts=thoughts)

    def _steps(self, reply: Reply, clauses: Sequence[Clause]) -> tuple[list[ModelStep], Question | None]:
        vias = [self._via(step, f"steps[{n}]") for n, step in enumerate(reply.steps)]
        question, options = self._question(reply.questions, vias)
        steps = [self._step(reply.steps, n, clauses[n], vias[n], options.get(n, ())) for n in range(len(clauses))]
        if reply.final is not None and steps:
            steps.append(self._final(reply.final, len(clauses) - 1))
        elif reply.final is not None:
            self.faults.append("final: there are no steps; write what must hold as the goal of a step")
        if steps and all(candidate.formula == TRUE for step in steps for candidate in step.candidates):
            self.faults.append("the goals hold in every state; say what must be true, or refuse the request")
        return steps, question

    # ------------------------------------------------------------------ the parts of a reply

    def _clause(self, step: ReplyStep, place: str) -> Clause:
        span = self._quoted(step.text, place)
        verb = "_".join(_WORD.findall(step.verb.lower())) or "do"
        nouns = dict.fromkeys("_".join(_WORD.findall(noun.lower())) for noun in step.objects)
        if len(verb) > _LONGEST_VERB or len(nouns) > _MOST_NOUNS:
            self.faults.append(f"{place}: a verb of {len(verb)} letters and {len(nouns)} objects are too many")
        objects = tuple(noun for noun in nouns if noun and ("_" in noun or not is_pronoun(noun)))
        return Clause(verb, objects, span=span, text=self.request[span.start : span.end], direct=objects)

    def _via(self, step: ReplyStep, place: str) -> tuple[Formula, ...]:
        """Return the conditions to pass through on the way to the goal of a step."""
        places = [(f"{place}.via[{number}]", text) for number, text in enumerate(step.via)]
        found = [(self._formula(text, where, reachable=True), where) for where, text in places]
        return tuple(formula for formula, where in found if self._cubes(formula, where))

    def _step(
        self,
        steps: Sequence[ReplyStep],
        number: int,
        clause: Clause,
        via: tuple[Formula, ...],
        options: tuple[CandidateGoal, ...],
    ) -> ModelStep:
        step, place = steps[number], f"steps[{number}]"
        when = None if step.when is None else self._formula(step.when, f"{place}.when")
        before = steps[number - 1] if number else None
        if step.otherwise and (before is None or (before.when is None and not before.otherwise)):
            self.faults.append(f"{place}.otherwise: the step before it has no condition")
        # a goal behind a guard need not be reachable: it is never asked for where the guard fails
        goal = self._goal(step.goal, f"{place}.goal", via, reachable=step.when is None and not step.otherwise)
        return ModelStep(
            clause,
            number,
            direct=clause.direct,
            candidates=options or (goal,),
            when=when,
            otherwise=step.otherwise,
        )

    def _final(self, text: str, number: int) -> ModelStep:
        goal = self._goal(text, "final", reachable=True)
        return ModelStep(Clause("be", text="in the end"), number, main=False, candidates=(goal,))

    def _goal(
        self,
        text: str,
        place: str,
        via: tuple[Formula, ...] = (),
        *,
        prior: float = 0.0,
        reachable: bool = False,
    ) -> CandidateGoal:
        formula = self._formula(text, place, reachable=reachable)
        return CandidateGoal(formula, self._cubes(formula, place), prior, via, source=SOURCE)

    def _cubes(self, formula: Formula, place: str) -> tuple[Cube, ...]:
        """Return the cases of a condition; without any, that is a fault, unless the condition is plainly false."""
        try:
            cubes = goal_cubes(self.task, formula)
        except TmdError as error:
            self.faults.append(f"{place}: {error.message}")
            return ()
        if not cubes and formula != FALSE:
            self.faults.append(f"{place}: it contradicts itself")
        return cubes

    def _constraints(self, given: Sequence[ReplyConstraint]) -> tuple[PlanConstraints, tuple[Clause, ...]]:
        """Return the constraints, and a clause for each to show it."""
        never: list[Formula] = []
        untouched: set[str] = set()
        avoided: list[Clause] = []
        objects = self.world.profiles.objects
        for number, constraint in enumerate(given):
            place = f"constraints[{number}]"
            span = self._quoted(constraint.text, place)
            said = self.request[span.start : span.end]
            shown = Clause("avoid", span=span, text=said, mood=Mood.AVOID)
            if constraint.untouched:
                avoided.append(replace(shown, verb="touch", objects=tuple(dict.fromkeys(constraint.untouched))))
            if constraint.never is not None:
                avoided.append(replace(shown, condition=" ".join(constraint.never.split())))
                never += self._never(constraint.never, f"{place}.never")
            elif not constraint.untouched:
                self.faults.append(f"{place}: it forbids nothing; give never or untouched")
            for name in constraint.untouched:
                if name in objects:
                    untouched.update((name, *(part for _, part in self.world.profiles.parts.get(name, ()))))
                else:
                    hint = f" ({close})" if (close := nearest(name, objects)) else ""
                    self.faults.append(f"{place}.untouched: there is no object '{_short(name)}'{hint}")
        return PlanConstraints(tuple(never), untouched=frozenset(untouched)), tuple(avoided)

    def _never(self, text: str, place: str) -> list[Formula]:
        """Return a prohibition, if it forbids anything; none of its cases may be left out, so they must be few."""
        formula = self._formula(text, place)
        if formula == TRUE:
            self.faults.append(f"{place}: it always holds, so no plan can avoid it")
        if formula in (TRUE, FALSE):
            return []
        try:
            ground_condition(self.task, formula)
        except TmdError as error:
            self.faults.append(f"{place}: {error.message}")
        return [formula]

    def _question(
        self, given: Sequence[ReplyQuestion], vias: Sequence[tuple[Formula, ...]]
    ) -> tuple[Question | None, dict[int, tuple[CandidateGoal, ...]]]:
        """Return the first question, and its options as the candidate goals of its step."""
        if not given:
            return None, {}
        asked = given[0]
        if not 0 <= asked.step < len(vias) or not 2 <= len(asked.options) <= _MOST_OPTIONS:
            self.faults.append(f"questions[0]: it needs the number of a step and 2 to {_MOST_OPTIONS} options")
            return None, {}
        candidates: dict[Formula, tuple[str, CandidateGoal]] = {}
        for number, option in enumerate(asked.options):
            prior = -(number + 1) * math.log(2)  # the model names the likeliest first, and no numbers
            goal = self._goal(option.goal, f"questions[0].options[{number}].goal", vias[asked.step], prior=prior)
            candidates.setdefault(goal.formula, (_short(option.answer), goal))
        if len(candidates) < 2:
            self.faults.append("questions[0]: its options do not have two different goals; ask nothing then")
            return None, {}
        options = tuple(QuestionOption(answer, formula) for formula, (answer, _) in candidates.items())
        goals = tuple(goal for _, goal in candidates.values())
        return Question(_short(asked.text), asked.step, options), {asked.step: goals}

    # ------------------------------------------------------------------ formulas

    def _formula(self, text: str, place: str, *, reachable: bool = False) -> Formula:
        """Return a condition over ground atoms that may change; false where it is wrong, which is a fault.

        With ``reachable``, it is a fault as well if the condition can never hold.
        """
        try:
            formula = instantiated(self.task, with_goal(self.task.problem, text, place).goal)
        except TmdError as error:
            hint = f" ({error.hint})" if error.hint else ""
            where = f"{place}, column {error.location.column}" if error.location is not None else place
            self.faults.append(_short(f"{where}: {error.message}{hint}"))
            return FALSE
        if reachable and formula == FALSE:
            self.faults.append(f"{place}: it can never hold here: {self._why_never(text, place)}")
        return formula

    def _why_never(self, text: str, place: str) -> str:
        for part in conjuncts(with_goal(self.task.problem, text, place).goal):
            if instantiated(self.task, part) != FALSE:
                continue
            if isinstance(part, Atom):
                return why_never(GroundAtom(part.predicate, part.terms), self.task)
            return f"no action of the domain can bring about {format_formula(part)}"
        return "its parts exclude each other"

    # ------------------------------------------------------------------ words

    def _span(self, quoted: str) -> Span | None:
        """Return where a quotation stands in the request; case and white space do not matter."""
        words = quoted.split()
        if not words:
            return None
        pattern = r"\s+".join(map(re.escape, words))
        found = re.search(pattern, self.request, re.IGNORECASE)
        if found is None:  # models leave quotation marks and full stops out, or add them
            pattern = r"[^\w]+".join(re.escape(word) for word in _WORD.findall(quoted))
            found = re.search(pattern, self.request, re.IGNORECASE) if pattern else None
        return None if found is None else Span(*found.span())

    def _quoted(self, text: str, place: str) -> Span:
        """Return where a quotation stands in the request; where it does not, that is a fault."""
        span = self._span(text)
        if span is None:
            self.faults.append(f"{place}.text: '{_short(text)}' is not a quotation of the request")
        return span or Span(0, 0)

    def _uncovered(self, spans: Sequence[Span]) -> tuple[Skipped, ...]:
        """Return the runs of words with a meaning that no quotation covers."""
        found: list[Span] = []
        for match in _WORD.finditer(self.request):
            covered = any(span.start <= match.start() and match.end() <= span.end for span in spans)
            if covered or match[0].lower() in section("idle"):
                continue
            if found and not self.request[found[-1].end : match.start()].strip():
                found[-1] = Span(found[-1].start, match.end())
            else:
                found.append(Span(*match.span()))
        return tuple(Skipped(self.request[s.start : s.end], s, _UNCOVERED) for s in found)


def _turns(text: str) -> bool:
    """Return whether words change what the words beside them ask for: *not*, *if*, *except*."""
    return any(word.lower().replace("\u2019", "'") in section("turning") for word in _WORD.findall(text))


def _short(text: str) -> str:
    """Return words of a model on one line, at most 300 characters."""
    return one_line(text)[:300]
