"""A text, clause by clause: its goals in the state reached so far, what must be kept, and where meanings come from."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import lru_cache
from weakref import WeakKeyDictionary

from tmd.goals.clause_goal import ClauseGoal, Kept, Refused, Why, aims, combined, keep
from tmd.goals.grounder import TRUE
from tmd.goals.reading.goal_reader import GoalReader
from tmd.goals.reading.noun_phrases import Bound, Memory
from tmd.goals.reading.requirements import BE
from tmd.goals.sources.actions import rows_of_actions
from tmd.goals.sources.table import ACTIONS, DECLARED, LEARNED, GoalTable, read_table
from tmd.goals.text_constraints import USE, ConstraintReader, TextConstraints, is_of_the_end
from tmd.language.clause import Clause, Condition, Mood, Parsed, Relation
from tmd.language.lexicon.lexicon import Lexicon
from tmd.language.syntax.pronouns import is_pronoun
from tmd.language.syntax.subordinate import REMINDER
from tmd.pddl.model import Domain
from tmd.pddl.task import Bits, Cube
from tmd.veil.world import World

SOURCES = (DECLARED, LEARNED, ACTIONS)
"""All sources, the surest first."""


_DECLARED: WeakKeyDictionary[Lexicon, dict[Domain, GoalTable]] = WeakKeyDictionary()


def declared_goals(lexicon: Lexicon, domain: Domain) -> GoalTable:
    """What a lexicon declares for a domain; read once.

    Raises:
        TmdError: A row is wrong; with its place.
    """
    known = _DECLARED.setdefault(lexicon, {})
    if domain not in known:
        known[domain] = read_table(lexicon.goals, lexicon.attributes, lexicon.groups, domain)
    return known[domain]


@lru_cache(maxsize=8)
def _actions(domain: Domain) -> GoalTable:
    return rows_of_actions(domain)


def goal_reader(
    world: World,
    lexicon: Lexicon,
    learned: GoalTable | None = None,
    *,
    sources: Collection[str] = SOURCES,
    guess: bool = False,
) -> GoalReader:
    """A reader for one environment.

    Args:
        world: The environment.
        lexicon: The domain's words.
        learned: The rows that its demonstrations teach.
        sources: Which sources are asked.
        guess: Whether a thing may be taken for what a noun is only like in meaning.

    Raises:
        TmdError: The lexicon declares something that is wrong; with its place.
    """
    domain = world.task.problem.domain
    said = declared_goals(lexicon, domain)
    rows = said.rows if DECLARED in sources else ()
    tables = [GoalTable(rows, said.attributes, said.groups)]
    if LEARNED in sources and learned is not None:
        tables.append(learned)
    if ACTIONS in sources:
        tables.append(_actions(domain))
    return GoalReader(world, tables, lexicon, guess=guess)


GUARDS = frozenset({"if", "unless", "in_case", "provided_that", "whether", "as_long_as"})
EARLIER = frozenset(
    {"when", "once", "after", "whenever", "as_soon_as", "now_that", "by_the_time", "the_moment", "since"}
)
PARTINGS = frozenset({"leave", "go"})
LATER = frozenset({"before", "until", "till", "to", "with"})


class Role(StrEnum):
    """What a step is to the clause it comes from."""

    MAIN = "main"
    EARLIER = "earlier"
    """Done first: *when you have taken the cup out*."""
    LATER = "later"
    """Done afterwards: *before you put the noodles in*, *until it is hot*, *to warm it up*."""


@dataclass(frozen=True, slots=True)
class GoalStep:
    """One thing to be done.

    Attributes:
        clause: What.
        number: The clause of the text that it belongs to, counted from 0.
        role: What it is to that clause.
        guards: Conditions of which it depends whether it is done.
        otherwise: It is done where the guards of the step before it did not hold.
        optional: It may be left out where it is not understood: *when they are done*.
        awaited: It is waited for, not asked for: *until it boils*.
        besides: It must hold together with what the same clause asks for: *with its door open*.
    """

    clause: Clause
    number: int
    role: Role = Role.MAIN
    guards: tuple[Condition, ...] = ()
    otherwise: bool = False
    optional: bool = False
    awaited: bool = False
    besides: bool = False


def in_order(clauses: Sequence[Clause]) -> tuple[GoalStep, ...]:
    """The steps of a text in the order of doing; what is to be kept is not a step."""
    heading = next((clause for clause in clauses if clause.heading), None)
    if heading is not None and not heading.implied:
        clauses = [replace(c, verb=heading.verb) if c.implied and c is not heading else c for c in clauses]
    ordered = sorted(enumerate(clauses), key=lambda pair: pair[1].heading)
    if len(ordered) > 1 and ordered[-1][1].text.rstrip(" .!").endswith(" first"):
        ordered.insert(-2, ordered.pop())  # "put the milk in the mug. Rinse it first."
    return tuple(step for number, clause in ordered for step in _steps(clause, number))


def _with_end(steps: Sequence[GoalStep], clause: Clause, number: int) -> tuple[GoalStep, ...]:
    """The steps, and after those of a clause what must not be left so: *put it in the drawer, don't leave it open*."""
    place = max((at for at, step in enumerate(steps, 1) if step.number == number), default=len(steps))
    other = replace(clause, mood=Mood.DO, result=f"not_{clause.result}")
    return (*steps[:place], GoalStep(other, number, Role.LATER), *steps[place:])


def _steps(clause: Clause, number: int) -> Iterator[GoalStep]:
    guards = tuple(c for c in clause.conditions if c.word in GUARDS)
    if clause.mood is Mood.KEEP:
        if clause.result and clause.result != "alone":
            verb = clause.verb if all(map(is_pronoun, clause.direct)) else BE
            yield GoalStep(replace(clause, verb=verb, mood=Mood.DO), number, Role.MAIN, guards, clause.otherwise)
        elif guards:
            yield GoalStep(
                clause, number, Role.MAIN, guards, clause.otherwise
            )  # "if it is there, leave it, otherwise …"
        return
    for condition in clause.conditions:
        if condition.word in EARLIER and not condition.negated:
            for inner in condition.clauses:
                # "once it boils" is about what boils by then, if that is what is meant
                awaited = inner.verb == BE or any(map(is_pronoun, inner.direct))
                yield GoalStep(inner, number, Role.EARLIER, guards, clause.otherwise, optional=True, awaited=awaited)
    yield GoalStep(clause, number, Role.MAIN, guards, clause.otherwise, optional=clause.heading)
    if clause.duration and not clause.verb.startswith("wait"):
        # "put the noodles in for three minutes" asks for what time brings about, where a domain says what that is
        waiting = Clause("wait", span=clause.span, text=clause.text)
        yield GoalStep(waiting, number, Role.LATER, guards, clause.otherwise, optional=True)
    for condition in clause.conditions:
        if condition.word in LATER and not condition.negated:
            for inner in condition.clauses:
                # "before you leave" says when, and is nothing to be done where nobody knows how
                said = condition.word
                yield GoalStep(
                    inner,
                    number,
                    Role.LATER,
                    guards,
                    clause.otherwise,
                    optional=said not in ("before", "with") or inner.verb in PARTINGS,
                    awaited=said in ("until", "till"),
                    besides=said == "with",
                )


_COMPLETE = frozenset({"done", "ready", "finished", "complete", "over"})
"""What is said of something only to say when: the clause before has brought it about."""


@dataclass(frozen=True, slots=True)
class Context:
    """What was said and done before a step.

    Attributes:
        memory: What nouns turned out to mean.
        kept: What must not be undone.
        guard: For the sentence so far, whether its condition held; ``None`` where it has none.
    """

    memory: Memory
    kept: tuple[Kept, ...] = ()
    guard: bool | None = None


@dataclass(frozen=True, slots=True)
class Target:
    """A step with its goal in one state.

    Attributes:
        step: The step.
        goal: What it asks for; ``None`` where there is nothing to do.
        already: It holds already.
        note: Why there is nothing to do.
        aims: What to plan for: the goal with what is to be kept, then with ever less of that.
        ways: What shall hold on the way, before the goal does.
    """

    step: GoalStep
    goal: ClauseGoal | None
    already: bool = False
    note: str = ""
    aims: tuple[tuple[Cube, ...], ...] = ()
    ways: tuple[tuple[Cube, ...], ...] = ()


class Follower:
    """Follows a text in one environment.

    Args:
        reader: Reads clauses as goals.
    """

    def __init__(self, reader: GoalReader) -> None:
        self.reader = reader
        self.task = reader.world.task
        self.constraints = ConstraintReader(reader)

    def begin(self, parsed: Parsed, state: Bits) -> tuple[tuple[GoalStep, ...], Context, TextConstraints] | Refused:
        """The steps of a text, what is known before the first, and what holds throughout."""
        unread = [piece for piece in parsed.skipped if piece.reason == REMINDER]
        if unread and not self.reader.nouns.guess:
            message = f"'{' '.join(unread[0].text.split())}' {REMINDER}"
            return Refused(Why.NOT_UNDERSTOOD, message, "say what shall be done with it")
        memory = Memory(first=state)
        constraints = self.constraints.read(parsed, state, memory)
        if isinstance(constraints, Refused):
            return constraints
        memory = replace(memory, left=constraints.left)
        steps = in_order(self._with_instruments(parsed))
        for clause in filter(is_of_the_end, parsed.constraints):
            before = [n for n, other in enumerate(parsed.clauses) if other.span.start < clause.span.start]
            steps = _with_end(steps, clause, before[-1] if before else 0)
        return steps, Context(memory, constraints.kept), constraints

    def _with_instruments(self, parsed: Parsed) -> tuple[Clause, ...]:
        """The clauses, those beside a *use* of the same sentence done with that: *use the pot to boil water*.

        The clause behind it, or where there is none, the one before it: *heat the milk, use the microwave*.
        """
        clauses = list(parsed.clauses)
        for number, clause in enumerate(parsed.clauses):
            alone = clause.verb == USE and clause.mood is Mood.DO and len(clause.direct) == 1 and not clause.relations
            if not alone or self.constraints.leaves_a_trace(USE):
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

    def target(self, step: GoalStep, context: Context, state: Bits) -> tuple[Target, Context] | Refused:
        """What a step asks for in ``state``."""
        spoken: dict[str, None] = {}
        due = self._due(step, context, state, spoken)
        if isinstance(due, Refused):
            return due
        recent = tuple(dict.fromkeys((*spoken, *context.memory.recent)))
        context = replace(context, memory=replace(context.memory, recent=recent))
        if step.otherwise or step.guards:
            context = replace(context, guard=due if not step.otherwise else context.guard)
        if not due:
            note = "the condition does not hold" if not step.otherwise else "the condition before it held"
            return Target(step, None, note=note), context
        if step.clause.mood is Mood.KEEP:
            preserved = self.constraints.preserved(step.clause, step.number, state, context.memory)
            if isinstance(preserved, Refused):
                return preserved
            return Target(step, None, note="it stays as it is"), replace(context, kept=(*context.kept, *preserved))
        goal = self.reader.read(step.clause, state, context.memory, awaited=step.awaited)
        if isinstance(goal, Refused):
            unread = {Why.UNKNOWN_VERB, Why.NOT_UNDERSTOOD, Why.CONTRADICTION}
            if step.clause.verb in PARTINGS:
                unread.add(Why.NO_SUCH_THING)  # "before you leave the room"
            if step.clause.result in _COMPLETE:
                unread.add(Why.IMPOSSIBLE)  # "when they are done"
            if step.optional and goal.why in unread:
                return Target(step, None, note=goal.message), context
            return goal
        if goal.formula == TRUE:
            return Target(step, goal, already=True, note="nothing that a state shows"), context
        if step.besides:
            own = tuple(replace(k, hard=True) if k.clause == step.number else k for k in context.kept)
            context = replace(context, kept=own)
        targets = tuple(a for a in aims(goal.cubes, context.kept, goal.released, self.task) if a)
        hard = [k for k in context.kept if k.hard]
        if not targets or (hard and not combined(goal.cubes, hard)):
            return Refused(Why.CONTRADICTION, f"'{step.clause.text}' contradicts what was said before")
        held = any(cube.holds(state) for cube in targets[0])
        ways = () if held else self._ways(goal)
        return Target(step, goal, already=held, aims=targets, ways=ways), context

    def reached(self, target: Target, context: Context, end: Bits) -> Context:
        """What is known after a step that ended in ``end``."""
        if target.goal is None or target.goal.formula == TRUE:
            return context
        cube = next((c for c in target.goal.cubes if c.holds(end)), target.goal.cubes[0])
        memory = bindings_of(target.goal, cube, self.reader, context.memory)
        task = self.task
        number = target.step.number
        hard = {k.ways[0] for k in context.kept if k.hard}
        fresh = tuple(k for k in keep(cube, number, task) if k.ways[0] not in hard)
        literals = {k.ways[0] for k in fresh}
        still = tuple(
            k for k in context.kept if (any(way.holds(end) for way in k.ways) or k.hard) and k.ways[0] not in literals
        )
        return replace(context, memory=memory, kept=(*still, *fresh))

    def put_back(self, before: Bits, end: Bits, context: Context, *, at_once: bool) -> tuple[Cube, ...]:
        """What people undo by themselves of that which became true between two states and which nobody asked for.

        Together with all that is to be kept; empty where there is nothing to undo.
        """
        known = {(p.predicate, p.kind) for t in self.reader.tables for p in t.put_back if p.at_once == at_once}
        kinds = self.reader.world.mentions.kinds
        asked: Bits = 0
        for kept in context.kept:
            asked |= kept.ways[0].positive
        undone: Bits = 0
        for atom in self.task.names(end & ~before & ~asked) if known else ():
            if len(atom.args) == 1 and (atom.predicate, kinds.get(atom.args[0], "")) in known:
                undone |= 1 << self.task.index[atom]
        return combined((Cube(0, undone),), context.kept) if undone else ()

    def _ways(self, goal: ClauseGoal) -> tuple[tuple[Cube, ...], ...]:
        found = []
        for formula in goal.approach:
            cubes = self.reader.grounder.cubes(formula)
            if cubes:
                found.append(cubes)
        return tuple(found)

    # ------------------------------------------------------------------ conditions

    def _due(self, step: GoalStep, context: Context, state: Bits, spoken: dict[str, None]) -> bool | Refused:
        """Whether a step is to be done in ``state``; ``spoken`` gets the objects that its conditions speak of."""
        if step.otherwise:
            return context.guard is False
        if context.guard is not None and step.guards and all(guard.carried for guard in step.guards):
            return context.guard  # "if the lamp is on, turn it off and bring it": what was so when it was said
        for condition in step.guards:
            found = self._holds(condition, context, state, spoken)
            if isinstance(found, Refused):
                return found
            if found == (condition.word == "unless"):
                return False
        return True

    def _holds(self, condition: Condition, context: Context, state: Bits, spoken: dict[str, None]) -> bool | Refused:
        if not condition.clauses:
            return Refused(
                Why.CONDITION,
                f"the condition '{condition.text}' is not understood",
                "say it as a state: if the door is open",
            )
        truth = True
        for clause in condition.clauses:
            goal = self.reader.read(clause, state, context.memory)
            if isinstance(goal, Refused):
                states = clause.result or any(r.relation == "with" for r in clause.relations)
                exists = clause.verb == BE and not states and all(map(self.reader.knows, clause.direct))
                never = goal.why is Why.CONTRADICTION and (exists or condition.negated or not clause.relations)
                if never or (exists and goal.why is Why.NO_SUCH_THING):
                    truth = False  # "if there is milk": where there is none, there is none
                    continue
                return replace(goal, why=Why.CONDITION, message=f"the condition '{condition.text}': {goal.message}")
            truth = truth and any(cube.holds(state) for cube in goal.cubes)
            objects = self.reader.world.profiles.objects
            spoken.update((n, None) for names in goal.meant.values() for n in names if n in objects)
        return truth != condition.negated


def _same_sentence(parsed: Parsed, one: Clause, other: Clause) -> bool:
    first, second = sorted((one, other), key=lambda clause: clause.span)
    return not set(parsed.text[first.span.end : second.span.start]) & set(".!?;")


def _using(done: Clause, use: Clause) -> Clause:
    """A clause, done with what another one says is to be used."""
    tool = use.direct[0]
    if tool in done.objects:
        return done
    relations = (*done.relations, *(Relation("using", direct, tool) for direct in done.direct))
    phrases = {**done.phrases, tool: use.phrase(tool)}
    meant = {noun: tuple(n for n in names if n != tool) or names for noun, names in done.antecedents.items()}
    return replace(done, objects=(*done.objects, tool), relations=relations, phrases=phrases, antecedents=meant)


def bindings_of(goal: ClauseGoal, cube: Cube, reader: GoalReader, memory: Memory) -> Memory:
    """What later clauses remember of a clause whose goal was reached as ``cube``."""
    task = reader.world.task
    atoms = task.names(cube.positive | cube.negative)
    mentioned = dict.fromkeys(a for atom in atoms for a in atom.args)
    constants = reader.world.profiles.constants
    bound = dict(memory.bound)
    recent: dict[str, None] = {}
    # "heat it in the microwave, and add the noodles": to what was heated; where it was done comes after that
    for noun, names in sorted(goal.meant.items(), key=lambda said: " " in said[0]):
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
