"""What a model proposes, checked against the domain: nothing is believed that PDDL does not accept."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field

from tmd.diagnostics import Refusal, RefusalKind, TmdError
from tmd.goals.grounder import why_never
from tmd.language.clause import Clause, Parsed, Skipped, Span
from tmd.language.parser import is_filler
from tmd.language.syntax.pronouns import is_pronoun
from tmd.pddl.ground_formula import FALSE, TRUE, goal_cubes, instantiated
from tmd.pddl.model import Atom, Formula, GroundAtom, conjuncts
from tmd.pddl.reading.reader import with_goal
from tmd.pddl.reading.syntax import nearest
from tmd.pddl.writer import format_formula
from tmd.readers.interface import CandidateGoal, PlanConstraints, Question, QuestionOption, Step
from tmd.readers.llm.reply import Reply, ReplyConstraint, ReplyQuestion, ReplyRefusalKind, ReplyStep
from tmd.veil.world import World

SOURCE = "model"
"""The source of goals that a language model proposed."""
_MOST_STEPS = 40
_MOST_OPTIONS = 4
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
        constraints: Prohibitions and exceptions.
        refusal: Why the model refuses the request; ``None`` where it does not.
        question: Its question to the user; ``None`` where it has none.
        thoughts: Its own explanation.
    """

    parsed: Parsed
    steps: tuple[ModelStep, ...] = ()
    constraints: PlanConstraints = field(default_factory=PlanConstraints)
    refusal: Refusal | None = None
    question: Question | None = None
    thoughts: str = ""


class ReplyChecker:
    """Checks the replies to one request in one environment.

    Args:
        request: The request.
        world: The environment.
    """

    def __init__(self, request: str, world: World) -> None:
        self.request = request
        self.world = world
        self.task = world.task
        self.faults: list[str] = []

    def read(self, reply: Reply) -> ModelReading | list[str]:
        """Return the reading, or everything that is wrong with it, in words for the model."""
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
        question, options = self._question(reply.questions, len(reply.steps))
        steps = [self._step(step, clauses[n], n, options.get(n, ())) for n, step in enumerate(reply.steps)]
        if reply.final is not None and steps:
            steps.append(self._final(reply.final, len(clauses) - 1))
        constraints = self._constraints(reply.constraints)
        if self.faults:
            return self.faults
        quotations = [s.text for s in reply.steps] + [c.text for c in reply.constraints]
        spans = [span for span in map(self._span, quotations) if span is not None]
        parsed = Parsed(self.request, clauses, self._uncovered(spans))
        return ModelReading(parsed, tuple(steps), constraints, question=question, thoughts=thoughts)

    # ------------------------------------------------------------------ the parts of a reply

    def _clause(self, step: ReplyStep, place: str) -> Clause:
        span = self._span(step.text)
        if span is None:
            self.faults.append(f"{place}.text: '{_short(step.text)}' is not a quotation of the request")
            span = Span(0, 0)
        verb = "_".join(_WORD.findall(step.verb.lower())) or "do"
        nouns = dict.fromkeys("_".join(_WORD.findall(noun.lower())) for noun in step.objects)
        objects = tuple(noun for noun in nouns if noun and not is_pronoun(noun))
        return Clause(verb, objects, span=span, text=self.request[span.start : span.end], direct=objects)

    def _step(self, step: ReplyStep, clause: Clause, number: int, options: Sequence[CandidateGoal]) -> ModelStep:
        place = f"steps[{number}]"
        when = None if step.when is None else self._condition(step.when, f"{place}.when")
        via = tuple(f for n, v in enumerate(step.via) if (f := self._reachable(v, f"{place}.via[{n}]")) is not None)
        if step.otherwise and number == 0:
            self.faults.append(f"{place}.otherwise: there is no step before it")
        # a goal behind a guard need not be reachable: it is never asked for where the guard fails
        guarded = step.when is not None or step.otherwise
        read = self._condition if guarded else self._reachable
        formula = read(step.goal, f"{place}.goal")
        goal = None if formula is None else self._candidate(formula, via, f"{place}.goal")
        candidates = tuple(options) or ((goal,) if goal is not None else ())
        return ModelStep(
            clause, number, direct=clause.direct, candidates=candidates, when=when, otherwise=step.otherwise
        )

    def _final(self, text: str, number: int) -> ModelStep:
        formula = self._reachable(text, "final")
        goal = None if formula is None else self._candidate(formula, (), "final")
        return ModelStep(
            Clause("be", text="in the end"), number, main=False, candidates=() if goal is None else (goal,)
        )

    def _candidate(
        self, formula: Formula, via: Sequence[Formula], place: str, prior: float = 0.0
    ) -> CandidateGoal | None:
        try:
            cubes = goal_cubes(self.task, formula)
        except TmdError as error:
            self.faults.append(f"{place}: {error.message}")
            return None
        if not cubes and formula != FALSE:
            self.faults.append(f"{place}: it contradicts itself")
            return None
        return CandidateGoal(formula, cubes, prior, tuple(via), source=SOURCE)

    def _constraints(self, given: Sequence[ReplyConstraint]) -> PlanConstraints:
        never: list[Formula] = []
        untouched: set[str] = set()
        objects = self.world.profiles.objects
        for number, constraint in enumerate(given):
            place = f"constraints[{number}]"
            if self._span(constraint.text) is None:
                self.faults.append(f"{place}.text: '{_short(constraint.text)}' is not a quotation of the request")
            if constraint.never is not None:
                formula = self._condition(constraint.never, f"{place}.never")
                if formula == TRUE:
                    self.faults.append(f"{place}.never: it always holds, so no plan can avoid it")
                elif formula is not None and formula != FALSE:
                    never.append(formula)
            for name in constraint.untouched:
                if name in objects:
                    untouched.update((name, *(part for _, part in self.world.profiles.parts.get(name, ()))))
                else:
                    hint = nearest(name, objects)
                    self.faults.append(f"{place}.untouched: there is no object '{_short(name)}'" + _in_brackets(hint))
        return PlanConstraints(tuple(never), untouched=frozenset(untouched))

    def _question(
        self, given: Sequence[ReplyQuestion], steps: int
    ) -> tuple[Question | None, dict[int, tuple[CandidateGoal, ...]]]:
        """Return the first question, and its options as the candidate goals of its step."""
        if not given:
            return None, {}
        asked = given[0]
        if not 0 <= asked.step < steps or not 2 <= len(asked.options) <= _MOST_OPTIONS:
            self.faults.append(f"questions[0]: it needs the number of a step and 2 to {_MOST_OPTIONS} options")
            return None, {}
        candidates: dict[Formula, tuple[str, CandidateGoal]] = {}
        for number, option in enumerate(asked.options):
            place = f"questions[0].options[{number}].goal"
            formula = self._condition(option.goal, place)
            prior = -(number + 1) * math.log(2)  # the model names the likeliest first, and no numbers
            candidate = None if formula is None else self._candidate(formula, (), place, prior)
            if candidate is not None:
                candidates.setdefault(candidate.formula, (_short(option.answer), candidate))
        if len(candidates) < 2:
            return None, {}
        options = tuple(QuestionOption(answer, formula) for formula, (answer, _) in candidates.items())
        goals = tuple(candidate for _, candidate in candidates.values())
        return Question(_short(asked.text), asked.step, options), {asked.step: goals}

    # ------------------------------------------------------------------ formulas

    def _condition(self, text: str, place: str) -> Formula | None:
        """Return a condition over ground atoms that may change; ``None`` where it is wrong."""
        try:
            return instantiated(self.task, with_goal(self.task.problem, text, place).goal)
        except TmdError as error:
            self.faults.append(_fault(error, place))
            return None

    def _reachable(self, text: str, place: str) -> Formula | None:
        """Return a condition that may come to hold; ``None`` where it is wrong or cannot."""
        formula = self._condition(text, place)
        if formula == FALSE:
            self.faults.append(f"{place}: it can never hold here: {self._why_never(text, place)}")
            return None
        return formula

    def _why_never(self, text: str, place: str) -> str:
        for part in conjuncts(with_goal(self.task.problem, text, place).goal):
            if instantiated(self.task, part) != FALSE:
                continue
            if isinstance(part, Atom):
                return why_never(GroundAtom(part.predicate, part.terms), self.task)
            return f"no action of the domain can bring about {' '.join(format_formula(part).split())}"
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

    def _uncovered(self, spans: Sequence[Span]) -> tuple[Skipped, ...]:
        """Return the runs of words with a meaning that no quotation covers."""
        found: list[Span] = []
        for match in _WORD.finditer(self.request):
            covered = any(span.start <= match.start() and match.end() <= span.end for span in spans)
            if covered or is_filler(match[0]):
                continue
            if found and not self.request[found[-1].end : match.start()].strip():
                found[-1] = Span(found[-1].start, match.end())
            else:
                found.append(Span(*match.span()))
        return tuple(Skipped(self.request[s.start : s.end], s, _UNCOVERED) for s in found)


def _fault(error: TmdError, place: str) -> str:
    hint = f" ({error.hint})" if error.hint else ""
    where = f"{place}, column {error.location.column}" if error.location is not None else place
    return f"{where}: {error.message}{hint}"


def _in_brackets(hint: str | None) -> str:
    return f" ({hint})" if hint else ""


def _short(text: str) -> str:
    """Return words of a model on one line, at most 300 characters."""
    line = "".join(sign if sign.isprintable() else " " for sign in text)
    return " ".join(line.split())[:300]
