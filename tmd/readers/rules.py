"""The offline reader: grammar and lexicon.

The parser turns the request into clauses. The goal tables turn each clause into a goal, in the state that the clauses
before it lead to.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace

from tmd.diagnostics import Refusal, RefusalKind
from tmd.goals.reading.goal_reader import GoalReader
from tmd.goals.reading.noun_phrases import Bound, Memory
from tmd.goals.reading.requirements import BE
from tmd.goals.sources.table import GoalTable
from tmd.goals.tables import SOURCES, goal_tables
from tmd.goals.text_constraints import USE, ConstraintReader, is_of_the_end
from tmd.language.clause import PERSONS, Clause, Condition, Mood, Parsed, Quantifier, Relation
from tmd.language.lexicon.lexicon import Lexicon
from tmd.language.parser import parse
from tmd.language.syntax.antecedents import is_pronoun
from tmd.language.syntax.brackets import REMINDER
from tmd.pddl.ground_formula import TRUE
from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits, Cube
from tmd.readers.interface import (
    CandidateGoal,
    Dialogue,
    HandledGroup,
    PlanConstraints,
    Question,
    Step,
    StepGoals,
    Usage,
)
from tmd.veil.world import World


class RuleReader:
    """Reads requests by grammar and lexicon.

    Args:
        lexicon: The words of the domain.
        learned: The goals that the domain's demonstrations teach.
        sources: The sources of goals that are used (:data:`tmd.goals.tables.SOURCES`); ``None`` where only the clauses
            are wanted.
        guess: Whether a noun may mean a thing that is only akin to it, and a step be left out that is not understood.
    """

    def __init__(
        self,
        lexicon: Lexicon,
        learned: GoalTable | None = None,
        *,
        sources: Collection[str] | None = SOURCES,
        guess: bool = False,
    ) -> None:
        self._lexicon = lexicon
        self._learned = learned
        self._sources = sources
        self._guess = guess

    def begin(self, request: str, world: World, state: Bits) -> ClauseDialogue:
        """Read a request that is made in ``state``.

        Raises:
            TmdError: The lexicon declares something that is wrong; with its place.
        """
        parsed = parse(request, self._lexicon)
        if self._sources is None:
            return ClauseDialogue(parsed)
        tables = goal_tables(self._lexicon, world.task.problem.domain, self._learned, self._sources)
        return RuleDialogue(parsed, GoalReader(world, tables, self._lexicon, guess=self._guess), state)

    def objection(self, dialogue: Dialogue, plan: Sequence[Instruction], world: World) -> str | None:
        """Return ``None``: rules trust their goals."""
        return None

    def revise(self, dialogue: Dialogue, reason: str) -> Dialogue | None:
        """Return ``None``: rules have no second reading to offer."""
        return None


class ClauseDialogue:
    """The clauses of a request, without goals: all that the models of the paper look at.

    Args:
        parsed: The clauses.
    """

    steps: tuple[RuleStep, ...] = ()
    constraints: PlanConstraints = PlanConstraints()
    memory: object = None
    refusal: Refusal | None = None
    question: Question | None = None
    notes: tuple[str, ...] = ()
    usage: Usage | None = None

    def __init__(self, parsed: Parsed) -> None:
        self.parsed = parsed
        self.clauses = parsed.clauses

    @property
    def asks(self) -> bool:
        """Whether something is asked for; to hear only what not to do asks for nothing."""
        return bool(self.clauses) or any(not (c.result or c.implied) for c in self.parsed.constraints)

    def goals(self, step: Step, state: Bits, memory: object) -> StepGoals | Refusal:
        """Return no goals."""
        return StepGoals((), memory)

    def reached(self, goal: CandidateGoal, state: Bits, memory: object) -> object:
        """Return the memory as it is."""
        return memory

    def handled(self, step: Step) -> Sequence[HandledGroup] | None:
        """Return nothing that must be handled."""
        return None


GUARDS = frozenset({"if", "unless", "in_case", "provided_that", "whether", "as_long_as"})
EARLIER = frozenset(
    {"when", "once", "after", "whenever", "as_soon_as", "now_that", "by_the_time", "the_moment", "since"}
)
PARTINGS = frozenset({"leave", "go"})
LATER = frozenset({"before", "until", "till", "to", "with"})
_COMPLETE = frozenset({"done", "ready", "finished", "complete", "over"})
"""States that only say when: the clause before has brought them about."""


@dataclass(frozen=True, slots=True)
class RuleStep(Step):
    """A step as the rules read it.

    Attributes:
        clause: The clause with its grammar.
        guards: The conditions that guard the step.
        otherwise: Whether it is done where the guards of the step before it did not hold.
        optional: Whether it may be left out where it is not understood: *when they are done*.
        awaited: Whether it is waited for, not asked for: *until it boils*.
    """

    clause: Clause
    guards: tuple[Condition, ...] = ()
    otherwise: bool = False
    optional: bool = False
    awaited: bool = False


@dataclass(frozen=True, slots=True)
class _Progress:
    """What was said and done before a step.

    Attributes:
        memory: What nouns turned out to mean.
        guard: Whether the condition of the sentence held; ``None`` where it has none so far.
    """

    memory: Memory
    guard: bool | None = None


class RuleDialogue(ClauseDialogue):
    """A request read clause by clause in one environment.

    Args:
        parsed: The clauses.
        goals: Reads a clause as a goal.
        state: The state in which the request was made.
    """

    def __init__(self, parsed: Parsed, goals: GoalReader, state: Bits) -> None:
        super().__init__(parsed)
        self._goals = goals
        self._constraints = ConstraintReader(goals)
        self.refusal = self._begin(parsed, state)

    def _begin(self, parsed: Parsed, state: Bits) -> Refusal | None:
        """Read the constraints, and order the steps."""
        unread = [piece for piece in parsed.skipped if piece.reason == REMINDER]
        if unread and not self._goals.nouns.guess:
            message = f"'{' '.join(unread[0].text.split())}' {REMINDER}"
            return Refusal(RefusalKind.NOT_UNDERSTOOD, message, "say what shall be done with it")
        memory = Memory(first=state)
        constraints = self._constraints.read(parsed, state, memory)
        if isinstance(constraints, Refusal):
            return constraints
        steps = in_order(self._with_instruments(parsed))
        for clause in filter(is_of_the_end, parsed.constraints):
            before = [n for n, other in enumerate(parsed.clauses) if other.span.start < clause.span.start]
            steps = _with_end(steps, clause, before[-1] if before else 0)
        self.steps = tuple(replace(step, continued=_goes_on(step, parsed.clauses)) for step in steps)
        self.memory = _Progress(replace(memory, left=constraints.left))
        self.constraints = PlanConstraints(constraints.never, constraints.kept, constraints.untouched)
        return None

    def goals(self, step: Step, state: Bits, memory: object) -> StepGoals | Refusal:
        """Return the goal of a step that begins in ``state``."""
        assert isinstance(step, RuleStep) and isinstance(memory, _Progress)
        spoken: dict[str, None] = {}
        due = self._due(step, memory, state, spoken)
        if isinstance(due, Refusal):
            return due
        recent = tuple(dict.fromkeys((*spoken, *memory.memory.recent)))
        progress = replace(memory, memory=replace(memory.memory, recent=recent))
        if step.otherwise or step.guards:
            progress = replace(progress, guard=due if not step.otherwise else progress.guard)
        if not due:
            note = "the condition does not hold" if not step.otherwise else "the condition before it held"
            return StepGoals((), progress, note)
        if step.clause.mood is Mood.KEEP:
            preserved = self._constraints.preserved(step.clause, state, progress.memory)
            if isinstance(preserved, Refusal):
                return preserved
            return StepGoals((), progress, "it stays as it is", tuple(preserved))
        goal = self._goals.read(step.clause, state, progress.memory, awaited=step.awaited)
        if isinstance(goal, Refusal):
            return StepGoals((), progress, goal.message) if step.optional and _means_nothing(step, goal) else goal
        row = goal.row
        candidate = CandidateGoal(
            goal.formula,
            goal.cubes,
            via=goal.approach,
            released=goal.released,
            bindings=goal.meant,
            source=row.source if row is not None else "",
            explanation=row.pattern if row is not None else "",
            notes=goal.notes,
        )
        return StepGoals((candidate,), progress)

    def reached(self, goal: CandidateGoal, state: Bits, memory: object) -> object:
        """Return the memory after a step that reached ``goal`` in ``state``: what its nouns turned out to mean."""
        assert isinstance(memory, _Progress)
        if goal.formula == TRUE:
            return memory
        cube = next((c for c in goal.cubes if c.holds(state)), goal.cubes[0])
        return replace(memory, memory=bindings_of(goal, cube, self._goals, memory.memory))

    def handled(self, step: Step) -> Sequence[HandledGroup] | None:
        """Return the objects that a demonstrated sequence must handle: for each noun one of them, or all."""
        assert isinstance(step, RuleStep)
        clause, world, nouns = step.clause, self._goals.world, self._goals.nouns
        groups = []
        for noun in (*clause.direct, *(r.target for r in clause.relations)):
            names = frozenset(n for n in nouns.things(noun, world.task.init) if n in world.profiles.objects)
            if not names and (noun in clause.direct or self._is_missing(noun, clause)):
                return None
            if names:
                groups.append(HandledGroup(names, clause.phrase(noun).quantifier is Quantifier.ALL))
        return groups

    def _is_missing(self, noun: str, clause: Clause) -> bool:
        """Return whether a noun of a clause names nothing here, thing or substance."""
        referents = self._goals.referents
        named = not (referents.points_back(noun) or noun in (*clause.quantities, *PERSONS))
        return named and not referents.nouns.constants(noun, ("object",), self._goals.world.task.init)

    def _with_instruments(self, parsed: Parsed) -> tuple[Clause, ...]:
        """Return the clauses, with the object of a *use* as the instrument of the clause beside it.

        That is the next clause of the sentence (*use the pot to boil water*), or else the one before it (*heat the
        milk, use the microwave*).
        """
        clauses = list(parsed.clauses)
        for number, clause in enumerate(parsed.clauses):
            alone = clause.verb == USE and clause.mood is Mood.DO and len(clause.direct) == 1 and not clause.relations
            if not alone or self._constraints.leaves_a_trace(USE):
                continue
            for other in (number + 1, number - 1):
                if not 0 <= other < len(clauses) or not _same_sentence(parsed, clause, clauses[other]):
                    continue
                done = clauses[other]
                told = any(r.relation in ("using", "with") for r in done.relations)
                if done.mood is Mood.DO and done.verb != USE and done.direct and not told:
                    clauses[other] = _using(done, clause)
                    break
        return tuple(clauses)

    def _due(self, step: RuleStep, context: _Progress, state: Bits, spoken: dict[str, None]) -> bool | Refusal:
        """Return whether a step is to be done in ``state``; ``spoken`` gets the objects that its conditions mention."""
        if step.otherwise:
            return context.guard is False
        if context.guard is not None and step.guards and all(guard.carried for guard in step.guards):
            return context.guard  # "if the lamp is on, turn it off and bring it": what was so when it was said
        for condition in step.guards:
            found = self._holds(condition, context, state, spoken)
            if isinstance(found, Refusal):
                return found
            if found == (condition.word == "unless"):
                return False
        return True

    def _holds(self, condition: Condition, context: _Progress, state: Bits, spoken: dict[str, None]) -> bool | Refusal:
        if not condition.clauses:
            return Refusal(
                RefusalKind.CONDITION,
                f"the condition '{condition.text}' is not understood",
                "say it as a state: if the door is open",
            )
        truth = True
        for clause in condition.clauses:
            goal = self._goals.read(clause, state, context.memory)
            if isinstance(goal, Refusal):
                states = clause.result or any(r.relation == "with" for r in clause.relations)
                exists = clause.verb == BE and not states and all(map(self._goals.knows, clause.direct))
                never = goal.kind is RefusalKind.CONTRADICTION and (exists or condition.negated or not clause.relations)
                if never or (exists and goal.kind is RefusalKind.NO_SUCH_THING):
                    truth = False  # "if there is milk": where there is none, there is none
                    continue
                return replace(
                    goal, kind=RefusalKind.CONDITION, message=f"the condition '{condition.text}': {goal.message}"
                )
            truth = truth and any(cube.holds(state) for cube in goal.cubes)
            objects = self._goals.world.profiles.objects
            spoken.update((n, None) for names in goal.meant.values() for n in names if n in objects)
        return truth != condition.negated


def _means_nothing(step: RuleStep, refusal: Refusal) -> bool:
    """Return whether an optional step may be left out for a reason."""
    unread = {RefusalKind.UNKNOWN_VERB, RefusalKind.NOT_UNDERSTOOD, RefusalKind.CONTRADICTION}
    if step.clause.verb in PARTINGS:
        unread.add(RefusalKind.NO_SUCH_THING)  # "before you leave the room"
    if step.clause.result in _COMPLETE:
        unread.add(RefusalKind.IMPOSSIBLE)  # "when they are done"
    return refusal.kind in unread


def _goes_on(step: RuleStep, clauses: Sequence[Clause]) -> bool:
    """Return whether the next clause goes on with what a step acts on: *pick up the boxes and put them in the bag*."""
    following = clauses[step.number + 1] if step.number + 1 < len(clauses) else None
    if following is None or following.mood is not Mood.DO:
        return False
    direct = set(step.direct)
    return any(direct & set(names) for names in following.antecedents.values())


def in_order(clauses: Sequence[Clause]) -> tuple[RuleStep, ...]:
    """Return the steps of a text in the order of doing."""
    heading = next((clause for clause in clauses if clause.heading), None)
    if heading is not None and not heading.implied:
        clauses = [replace(c, verb=heading.verb) if c.implied and c is not heading else c for c in clauses]
    ordered = sorted(enumerate(clauses), key=lambda pair: pair[1].heading)
    if len(ordered) > 1 and ordered[-1][1].text.rstrip(" .!").endswith(" first"):
        ordered.insert(-2, ordered.pop())  # "put the milk in the mug. Rinse it first."
    return tuple(step for number, clause in ordered for step in _steps(clause, number))


def _guards(clause: Clause) -> tuple[Condition, ...]:
    return tuple(condition for condition in clause.conditions if condition.word in GUARDS)


def _step(clause: Clause, number: int, owner: Clause, *, main: bool = True) -> RuleStep:
    """Return a step with the guards of the clause that it belongs to."""
    return RuleStep(clause, number, main=main, direct=clause.direct, guards=_guards(owner), otherwise=owner.otherwise)


def _with_end(steps: Sequence[RuleStep], clause: Clause, number: int) -> tuple[RuleStep, ...]:
    """Return the steps, and after those of a clause how things must not be left: *… and don't leave it open*."""
    place = max((at for at, step in enumerate(steps, 1) if step.number == number), default=len(steps))
    other = replace(clause, mood=Mood.DO, result=f"not_{clause.result}")
    return (*steps[:place], RuleStep(other, number, main=False, direct=other.direct), *steps[place:])


def _steps(clause: Clause, number: int) -> Iterator[RuleStep]:
    if clause.mood is Mood.KEEP:
        if clause.result and clause.result != "alone":
            verb = clause.verb if all(map(is_pronoun, clause.direct)) else BE
            yield _step(replace(clause, verb=verb, mood=Mood.DO), number, clause)
        elif _guards(clause):
            yield _step(clause, number, clause)  # "if it is there, leave it, otherwise …"
        return
    for condition in clause.conditions:
        if condition.word in EARLIER and not condition.negated:
            for inner in condition.clauses:
                # "once it boils" is about what boils by then, if that is what is meant
                awaited = inner.verb == BE or any(map(is_pronoun, inner.direct))
                yield replace(_step(inner, number, clause, main=False), optional=True, awaited=awaited)
    yield replace(_step(clause, number, clause), optional=clause.heading)
    if clause.duration and not clause.verb.startswith("wait"):
        # "put the noodles in for three minutes" asks for what time brings about, where a domain says what that is
        waiting = Clause("wait", span=clause.span, text=clause.text)
        yield replace(_step(waiting, number, clause, main=False), optional=True)
    for condition in clause.conditions:
        if condition.word in LATER and not condition.negated:
            for inner in condition.clauses:
                # "before you leave" says when, and is nothing to be done where nobody knows how
                said = condition.word
                yield replace(
                    _step(inner, number, clause, main=False),
                    optional=said not in ("before", "with") or inner.verb in PARTINGS,
                    awaited=said in ("until", "till"),
                    jointly=said == "with",
                )


def _same_sentence(parsed: Parsed, one: Clause, other: Clause) -> bool:
    first, second = sorted((one, other), key=lambda clause: clause.span)
    return not set(parsed.text[first.span.end : second.span.start]) & set(".!?;")


def _using(done: Clause, use: Clause) -> Clause:
    """Return a clause with the object of a *use* as its instrument."""
    tool = use.direct[0]
    if tool in done.objects:
        return done
    relations = (*done.relations, *(Relation("using", direct, tool) for direct in done.direct))
    phrases = {**done.phrases, tool: use.phrase(tool)}
    meant = {noun: tuple(n for n in names if n != tool) or names for noun, names in done.antecedents.items()}
    return replace(done, objects=(*done.objects, tool), relations=relations, phrases=phrases, antecedents=meant)


def bindings_of(goal: CandidateGoal, cube: Cube, reader: GoalReader, memory: Memory) -> Memory:
    """Return what later clauses remember of a clause whose goal was reached as ``cube``."""
    task = reader.world.task
    atoms = task.names(cube.positive | cube.negative)
    mentioned = dict.fromkeys(a for atom in atoms for a in atom.args)
    constants = reader.world.profiles.constants
    bound = dict(memory.bound)
    recent: dict[str, None] = {}
    # "heat it in the microwave, and add the noodles": to what was heated; where it was done comes after that
    for noun, names in sorted(goal.bindings.items(), key=lambda said: " " in said[0]):
        chosen = tuple(n for n in names if n in mentioned) or tuple(
            n for n in names if any(o in mentioned for level in range(4) for o in reader.grounder.relatives(n, level))
        )
        chosen = chosen or names
        containers: tuple[str, ...] = ()
        if all(n in constants for n in chosen):
            containers = tuple(
                dict.fromkeys(a.args[0] for a in atoms if set(a.args[1:]) & set(chosen) and a.args[0] not in constants)
            )
        bound.pop(noun, None)
        bound[noun] = Bound(chosen, containers)
        recent.update(dict.fromkeys((*(n for n in chosen if n not in constants), *containers)))
    recent.update(dict.fromkeys(a for a in mentioned if a not in constants))
    recent.update(dict.fromkeys(memory.recent))
    return replace(memory, bound=bound, recent=tuple(recent))
