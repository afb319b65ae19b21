"""The offline reader: grammar and lexicon.

The parser turns the request into clauses. The goal tables turn each clause into a goal, in the state that the clauses
before it lead to.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial

from tmd.diagnostics import Refusal, RefusalKind
from tmd.goals.clause_goal import ClauseGoal
from tmd.goals.grounder import Moments
from tmd.goals.reading.goal_reader import GoalReader
from tmd.goals.reading.noun_phrases import Bound, Memory
from tmd.goals.reading.referents import ANY_TYPE, is_none
from tmd.goals.sources.table import GoalTable
from tmd.goals.tables import SOURCES, goal_tables
from tmd.goals.text_constraints import ConstraintReader
from tmd.goals.words import BE, is_condition, is_noun, is_pronoun, is_relation, is_verb, words_of
from tmd.language.clause import AGENT, PERSONS, PUT, Clause, Condition, Mood, Parsed, Quantifier, Relation, Skipped
from tmd.language.lexicon.lexicon import Lexicon, section, singular
from tmd.language.lexicon.names import with_names
from tmd.language.parser import NO_VERB, parse
from tmd.language.syntax.brackets import REMINDER
from tmd.pddl.ground_formula import TRUE
from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits, Cube
from tmd.readers.interface import (
    CandidateGoal,
    Dialogue,
    HandledGroup,
    PlanConstraints,
    Step,
    StepGoals,
)
from tmd.readers.rule_steps import (
    USE,
    RuleStep,
    about_things,
    in_text_order,
    one_after_another,
    steps_of,
    with_addressees,
    with_unwanted_states,
    without_doers,
)
from tmd.world.world import World


class RuleReader:
    """The reader by grammar and lexicon.

    Args:
        lexicon: The words of the domain.
        learned: The goals that the domain's demonstrations teach.
        sources: The sources of goals that are used (:data:`tmd.goals.tables.SOURCES`); ``None`` where only the clauses
            are wanted.
        guess: Whether a noun may mean a thing that is only similar to it, and an unread step be left out.
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

    def begin(self, request: str, world: World, state: Bits) -> Dialogue:
        """Read a request that is made in ``state``.

        Raises:
            TmdError: The lexicon declares something that is wrong; with its place.
        """
        actions = tuple(action.name for action in world.task.problem.domain.actions)
        names = (*world.profiles.objects, *(kind.name for kind in world.domain.types))
        parsed = parse(request, _with_names(self._lexicon, names, actions))
        if self._sources is None:
            return Dialogue(parsed)
        tables = goal_tables(self._lexicon, world.domain, self._learned, self._sources)
        return RuleDialogue(parsed, GoalReader(world, tables, self._lexicon, guess=self._guess), state)

    def objection(self, dialogue: Dialogue, plan: Sequence[Instruction], world: World) -> str | None:
        """Return ``None``: rules trust their goals."""
        return None

    def revise(self, dialogue: Dialogue, reason: str) -> Dialogue | None:
        """Return ``None``: rules have no second reading to offer."""
        return None


_TITLES = {":": (9, 3), "!": (4, 1), ".": (2, 0)}
"""By the sign behind a title, the words of it and those before the sign, at most: "Popcorn and a film tonight!"."""
_SENTENCE = re.compile(r"[^.!?:;\n]*")
_COLON = re.compile(r"[^.!?;\n]*:")
"""The rest of a heading."""


@lru_cache(maxsize=16)
def _with_names(lexicon: Lexicon, names: tuple[str, ...], actions: tuple[str, ...]) -> Lexicon:
    return with_names(lexicon, names, actions)


@dataclass(frozen=True, slots=True)
class _Progress:
    """The state of a dialogue before a step.

    Attributes:
        memory: What nouns turned out to mean.
        guard: Whether the condition of the sentence held; ``None`` where it has none so far.
        each: The nouns of the step that stand for each of several things.
    """

    memory: Memory
    guard: bool | None = None
    each: frozenset[str] = frozenset()


class RuleDialogue(Dialogue):
    """A request read clause by clause in one environment.

    Args:
        parsed: The clauses.
        goals: Reads a clause as a goal.
        state: The state in which the request was made.
    """

    def __init__(self, parsed: Parsed, goals: GoalReader, state: Bits) -> None:
        self._goals = goals
        parsed = without_doers(self._with_untrue(with_unwanted_states(parsed), state), goals.is_actor)
        parsed = one_after_another(with_addressees(parsed, goals.is_actor))
        super().__init__(parsed)
        self._constraints = ConstraintReader(goals)
        read = partial(about_things, known=goals.knows_of)
        clauses, constraints = (tuple(map(read, said)) for said in (parsed.clauses, parsed.constraints))
        self.refusal = self._begin(replace(parsed, clauses=clauses, constraints=constraints), state)

    def _begin(self, parsed: Parsed, state: Bits) -> Refusal | None:
        """Read the constraints, and order the steps."""
        unread = [piece for piece in parsed.skipped if piece.reason == REMINDER or self._names_thing(piece, state)]
        if unread and parsed.clauses and not self._goals.nouns.guess:
            message = f"'{' '.join(unread[0].text.split())}' {REMINDER}"
            return Refusal(RefusalKind.NOT_UNDERSTOOD, message, "say what shall be done with it")
        memory = Memory(first=state)
        constraints = self._constraints.read(parsed, state, memory)
        if isinstance(constraints, Refusal):
            return constraints
        self.steps = steps_of(parsed, use=not self._constraints.leaves_a_trace(USE))
        kept = (noun for clause in parsed.clauses if clause.mood is Mood.KEEP for noun in clause.objects)
        # "the shirt has lost a button": the shirt; but not where it is
        agents = (r.target for said in parsed.stated for r in said.relations if r.relation == AGENT)
        told = (*agents, *(noun for said in parsed.stated for noun in said.direct))
        named = (noun for noun in (*kept, *told) if not is_pronoun(noun))
        spoken = tuple(dict.fromkeys(n for noun in named for n in self._goals.nouns.things(noun, state)[:1]))
        self.memory = _Progress(replace(memory, left=constraints.left, recent=spoken))
        self.constraints = PlanConstraints(constraints.never, constraints.kept, constraints.untouched)
        self.notes = constraints.notes
        return None

    def _with_untrue(self, parsed: Parsed, state: Bits) -> Parsed:
        """Return a request with what it states of known things and is not so as what shall be so.

        "A soda poured into the glass, and the glass left on the table": the glass stands elsewhere.
        """
        taken_up = {name for c in parsed.clauses for meant in c.antecedents.values() for name in meant[:1]}
        # "the fridge is open, close it" gives a reason
        stated = [said for said in parsed.stated if taken_up.isdisjoint(said.resolved())] if parsed.clauses else []
        untrue = [said for said in stated if _tells_state(said) and self._is_untrue(said, state)]
        clauses = in_text_order(parsed.clauses, untrue)
        told = [clause.span for clause in untrue]
        skipped = tuple(s for s in parsed.skipped if not any(s.span.start <= t.start < s.span.end for t in told))
        return replace(parsed, clauses=clauses, skipped=skipped)

    def _is_untrue(self, said: Clause, state: Bits) -> bool:
        """Return whether a statement is understood, and not so."""
        goal = self._goals.read(said, state, Memory(first=state))
        return not isinstance(goal, Refusal) and not any(cube.holds(state) for cube in goal.cubes)

    def _names_thing(self, piece: Skipped, state: Bits) -> bool:
        """Return whether a piece that belongs to no verb names something that is here."""
        nouns = self._goals.nouns
        words = [singular(word) for word in re.findall(r"[a-z]+", piece.text.lower())]
        if self._is_title(piece, len(words)):
            return False
        objects = self._goals.world.profiles.objects
        named = [word for word in words if nouns.lexicon.names_thing(word) or word in objects]
        named = [n for n in named if not self._goals.is_actor(n)]  # "Joe, wash the car"
        known = any(nouns.things(n, state) or nouns.substances(n) for n in named) or any(
            map(self._goals.names_deed, words)
        )
        return piece.reason == NO_VERB and known

    def _is_title(self, piece: Skipped, count: int) -> bool:
        """Return whether a piece of so many words is a title: "popcorn for one: …", "Movie night! …"."""
        text, rest = self.parsed.text, _SENTENCE.match(self.parsed.text, piece.span.end)
        assert rest is not None
        sign = text[rest.end() : rest.end() + 1]
        most, between = _TITLES.get(sign, (0, 0))
        first = sign == ":" or not text[: piece.span.start].strip()
        free = not any(rest.start() < clause.span.start < rest.end() for clause in self.parsed.clauses)
        return first and free and count <= most and len(rest[0].split()) <= between

    def goals(self, step: Step, state: Bits, memory: object) -> StepGoals | Refusal:
        """Return the goal of a step that begins in ``state``."""
        assert isinstance(step, RuleStep) and isinstance(memory, _Progress)
        guarded = self._due(step, memory, state)
        if isinstance(guarded, Refusal):
            return guarded
        due, remembered = guarded
        progress = _Progress(remembered, due if step.guards and not step.otherwise else memory.guard)
        if not due:
            note = "the condition does not hold" if not step.otherwise else "the condition before it held"
            return StepGoals((), progress, note)
        if step.explained:
            return StepGoals((), progress, "what follows says how")
        clause = self._cleared(step, state, progress.memory)
        each = frozenset(n for n, said in clause.phrases.items() if said.each and not said.plural)
        memory_here = self._with_named_before(step, state, progress.memory)
        progress = replace(progress, memory=memory_here, each=each)
        moved = self._to_be_done(clause, state, progress.memory)
        if moved is None:
            return self._kept(step, state, progress)
        found = self._goals.candidates(moved, state, progress.memory, awaited=step.awaited)
        if isinstance(found, Refusal):
            idle = (step.optional and _means_nothing(step, found)) or self._is_aside(step, found)
            return StepGoals((), progress, "" if _is_order(moved) else found.message) if idle else found
        return StepGoals(tuple(_candidate(goal, log_prior) for log_prior, goal in found), progress)

    def _cleared(self, step: RuleStep, state: Bits, memory: Memory) -> Clause:
        """Return the clause of a step, with its things where the heading is about: "clear the desk: the pen …"."""
        clause = step.clause
        told_of = {relation.source for relation in clause.stated}
        for noun in [noun for noun in clause.direct if step.explains and noun not in told_of]:
            for word in words_of("relations", "resting"):
                there = Relation(word, noun, step.explains)
                objects = tuple(dict.fromkeys((*clause.objects, step.explains)))
                if self._goals.is_there(replace(clause, relations=(there,), objects=objects), state, memory):
                    clause = replace(clause, relations=(there, *clause.relations), objects=objects)
                    break
        return clause

    def _to_be_done(self, clause: Clause, state: Bits, memory: Memory) -> Clause | None:
        """Return the clause that is to be done; ``None`` where things stay as they are.

        *It shall remain on the table* is to put it there, wherever it is by now.
        """
        left = is_verb(clause.verb, "leaving") and not clause.result  # "leave the one in the hall on" says how
        stays = left and self._goals.is_there(clause, state, memory)
        if not (clause.mood is Mood.KEEP or stays):
            return clause
        if stays or clause.result or not self._goals.goes_elsewhere(clause, state, memory):
            return None
        return replace(clause, verb=PUT, mood=Mood.DO)

    def _with_named_before(self, step: RuleStep, state: Bits, memory: Memory) -> Memory:
        """Return the memory with what the text names before a step and what is done to it later.

        *Before you shut the fridge, put the milk in*: in the fridge.
        """
        place = next(at for at, other in enumerate(self.steps) if other is step)
        later = [other.clause for other in self.steps[place + 1 :] if isinstance(other, RuleStep)]
        ahead = (noun for clause in later if clause.span.end < step.clause.span.end for noun in clause.direct)
        named = (n for noun in ahead if not is_pronoun(noun) for n in self._goals.nouns.things(noun, state)[:1])
        return replace(memory, recent=tuple(dict.fromkeys((*named, *memory.recent))))

    def _kept(self, step: RuleStep, state: Bits, progress: _Progress) -> StepGoals | Refusal:
        """Return what a step keeps as it is."""
        preserved = self._constraints.preserved(step.clause, state, progress.memory)
        if isinstance(preserved, Refusal):
            return StepGoals((), progress, preserved.message) if self._is_aside(step, preserved) else preserved
        return StepGoals((), progress, "it stays as it is", tuple(preserved))

    def _is_aside(self, step: RuleStep, refusal: Refusal) -> bool:
        """Return whether a step that is refused may be left out, since another one asks for something.

        It tells what somebody does who is not asked (*they are starving*), says only that somebody leaves, or has no
        verb and names nothing that the domain knows (*what a day!*).
        """
        clause, referents = step.clause, self._goals.referents
        named = (noun for noun in clause.objects if not (referents.points_back(noun) or noun in PERSONS))
        nothing = refusal.kind is RefusalKind.NO_SUCH_THING and not any(map(self._goals.knows_of, named))
        others = (other for other in self.steps if isinstance(other, RuleStep) and other is not step)
        asked = any(o.main and o.clause.objects and not (o.optional or o.clause.told) for o in others)
        bare = not clause.objects and is_verb(clause.verb, "parting")  # "time to go home"
        if asked and self._is_heading(clause, refusal, nothing=nothing):
            return True
        wished = not (section("wishing") - section("liking")).isdisjoint(clause.text.lower().split()[:1])
        return asked and (clause.told or bare or (clause.implied and nothing and not wished))

    def _is_heading(self, clause: Clause, refusal: Refusal, *, nothing: bool) -> bool:
        """Return whether a colon follows what names nothing and asks for nothing that is known here.

        *Two things need to happen before the demo: …*
        """
        behind = self.parsed.text[clause.span.end :]
        strange = refusal.kind is RefusalKind.UNKNOWN_VERB
        return (nothing and behind.lstrip().startswith(":")) or (strange and bool(_COLON.match(behind)))

    def reached(self, goal: CandidateGoal, state: Bits, memory: object) -> object:
        """Return the memory after a step that reached ``goal`` in ``state``: what its nouns turned out to mean."""
        assert isinstance(memory, _Progress)
        if goal.formula == TRUE:
            return memory
        cube = next((c for c in goal.cubes if c.holds(state)), goal.cubes[0])
        found = bindings_of(goal.bindings, cube, self._goals, memory.memory)
        # "take every plate and put it on the table": all of them
        every = {n: replace(b, every=True) for n, b in found.bound.items() if n in memory.each and len(b.names) > 1}
        return replace(memory, memory=replace(found, bound={**found.bound, **every}))

    def handled(self, step: Step) -> Sequence[HandledGroup] | None:
        """Return the objects that a demonstrated sequence must handle: for each noun one of them, or all."""
        assert isinstance(step, RuleStep)
        clause, world, nouns = step.clause, self._goals.world, self._goals.nouns
        groups = []
        for noun in (*clause.direct, *(r.target for r in clause.relations)):
            names = frozenset(n for n in nouns.things(noun, world.task.init) if n in world.profiles.objects)
            if is_none(noun, clause) or (not names and (noun in clause.direct or self._is_missing(noun, clause))):
                return None  # "rinse nothing": a demonstration of rinsing does the opposite
            if names:
                groups.append(HandledGroup(names, clause.phrase(noun).quantifier is Quantifier.ALL))
        return groups

    def _is_missing(self, noun: str, clause: Clause) -> bool:
        """Return whether a noun of a clause names nothing here, thing or substance."""
        referents = self._goals.referents
        named = not (referents.points_back(noun) or noun in (*clause.quantities, *PERSONS))
        return named and not referents.nouns.constants(noun, ANY_TYPE, self._goals.world.task.init)

    def _due(self, step: RuleStep, context: _Progress, state: Bits) -> tuple[bool, Memory] | Refusal:
        """Return whether a step is to be done in ``state``, and the memory with what its conditions mention."""
        memory = context.memory
        if step.otherwise:
            return context.guard is False, memory
        if context.guard is not None and step.guards and all(guard.carried for guard in step.guards):
            return context.guard, memory  # "if the lamp is on, turn it off and bring it": what was so when it was said
        for condition in step.guards:
            found = self._holds(condition, memory, state)
            if isinstance(found, Refusal):
                return found
            held, memory = found
            if held == is_condition(condition.word, "contrary"):
                return False, memory
        return True, memory

    def _holds(self, condition: Condition, memory: Memory, state: Bits) -> tuple[bool, Memory] | Refusal:
        """Return whether a condition holds, and the memory of what made it true: *it* is that tin, not any."""
        if not condition.clauses:
            message = f"the condition '{condition.text}' is not understood"
            return Refusal(RefusalKind.CONDITION, message, "say it as a state: if the door is open")
        truth = True
        for clause in condition.clauses:
            goal = self._goals.read(clause, state, memory)
            if not isinstance(goal, Refusal):
                cube = next((cube for cube in goal.cubes if cube.holds(state)), None)
                truth = truth and cube is not None
                memory = self._spoken(goal, cube, memory)
                if cube is not None and _of_any(clause):
                    memory = self._every(clause, goal, state, memory)
            elif self._is_never(clause, condition, goal):
                truth = False  # "if there is milk": where there is none, there is none
            else:
                message = f"the condition '{condition.text}': {goal.message}"
                return replace(goal, kind=RefusalKind.CONDITION, message=message)
        return truth != condition.negated, memory

    def _spoken(self, goal: ClauseGoal, cube: Cube | None, memory: Memory) -> Memory:
        """Return the memory after a condition; where it does not hold, only what was spoken of."""
        if cube is not None:
            return bindings_of(goal.meant, cube, self._goals, memory)
        objects = self._goals.world.profiles.objects
        spoken = (n for names in goal.meant.values() for n in names if n in objects)
        return replace(memory, recent=tuple(dict.fromkeys((*spoken, *memory.recent))))

    def _every(self, clause: Clause, goal: ClauseGoal, state: Bits, memory: Memory) -> Memory:
        """Return the memory where a noun means all things of which a condition holds."""
        noun, nouns = clause.direct[0], self._goals.nouns
        moments = Moments(state, memory.first)
        states = ((n, nouns.attribute(clause.result or "", n, moments)) for n in goal.meant.get(noun, ()))
        chosen = tuple(n for n, said in states if said is not None and nouns.grounder.truth(said, state))
        if len(chosen) < 2:
            return memory
        return replace(memory, bound={**memory.bound, noun: Bound(chosen, every=True)})

    def _is_never(self, clause: Clause, condition: Condition, refusal: Refusal) -> bool:
        """Return whether a refusal says that what a condition asks for does not hold."""
        states = clause.result or any(is_relation(r.relation, "accompanying") for r in clause.relations)
        exists = clause.verb == BE and not states and all(map(self._goals.knows, clause.direct))
        if refusal.kind is RefusalKind.CONTRADICTION:
            return exists or condition.negated or not clause.relations
        return exists and refusal.kind is RefusalKind.NO_SUCH_THING


def _candidate(goal: ClauseGoal, log_prior: float) -> CandidateGoal:
    """Return a goal of a clause as a candidate."""
    row = goal.row
    return CandidateGoal(
        goal.formula,
        goal.cubes,
        log_prior,
        via=goal.approach,
        bindings=goal.meant,
        source=row.source if row is not None else "",
        explanation=row.pattern if row is not None else "",
        notes=goal.notes,
    )


def _tells_state(said: Clause) -> bool:
    """Return whether a statement says where or how known things are."""
    known = all(said.phrase(noun).definite or noun in said.antecedents for noun in said.objects)
    return known and said.verb == BE and bool(said.result or said.relations)


def _of_any(clause: Clause) -> bool:
    """Return whether a condition speaks of any one thing that is in a state: "if a bottle is empty"."""
    if clause.verb != BE or clause.result is None or len(clause.direct) != 1:
        return False
    phrase = clause.phrase(clause.direct[0])
    return not (phrase.definite or phrase.plural) and phrase.quantifier is Quantifier.PLAIN


def _means_nothing(step: RuleStep, refusal: Refusal) -> bool:
    """Return whether an optional step may be left out for a reason."""
    if step.loose or _is_order(step.clause):
        return True
    unread = {RefusalKind.UNKNOWN_VERB, RefusalKind.NOT_UNDERSTOOD, RefusalKind.CONTRADICTION}
    if is_verb(step.clause.verb, "parting"):
        unread.add(RefusalKind.NO_SUCH_THING)  # "before you leave the room"
    if step.clause.result in words_of("outcomes", "complete"):
        unread.add(RefusalKind.IMPOSSIBLE)  # "when they are done"
    return refusal.kind in unread


def _is_order(clause: Clause) -> bool:
    """Return whether a condition says no more than that earlier steps come first: "when that is done"."""
    unnamed = all(is_pronoun(noun) or is_noun(noun, "everything") for noun in clause.direct)
    return clause.verb == BE and unnamed and clause.result in words_of("outcomes", "complete")


def bindings_of(meant: Mapping[str, tuple[str, ...]], cube: Cube, reader: GoalReader, memory: Memory) -> Memory:
    """Return what later clauses remember of a clause whose goal was reached as ``cube``."""
    atoms = reader.world.task.names(cube.positive | cube.negative)
    gained = reader.world.task.names(cube.positive)
    mentioned = dict.fromkeys(a for atom in atoms for a in atom.args)
    kept = {a for atom in gained for a in atom.args}
    is_constant = reader.nouns.is_constant
    bound = dict(memory.bound)
    recent: dict[str, None] = {}
    # "heat it in the microwave, and add the noodles": to what was heated; where it was done comes after that
    # what something was poured from comes last: "pour coffee from the pot into the cup, and add milk"
    for noun, names in sorted(meant.items(), key=lambda said: (" " in said[0], kept.isdisjoint(said[1]))):
        chosen = _chosen(names, mentioned, reader)
        containers: dict[str, None] = {}
        if all(map(is_constant, chosen)):
            vessels = (a.args[0] for a in gained if set(a.args[1:]) & set(chosen))
            containers = dict.fromkeys(v for v in vessels if not is_constant(v))
        bound.pop(noun, None)
        bound[noun] = Bound(chosen, tuple(containers))
        recent |= dict.fromkeys(n for n in chosen if not is_constant(n)) | containers
    recent |= dict.fromkeys(a for a in mentioned if not is_constant(a))
    # "put it there", after it was taken out of something: not back in that
    left = {place for atom in reader.world.task.names(cube.negative) for place in atom.args[1:]} - kept
    order = dict.fromkeys(sorted((*recent, *memory.recent), key=lambda name: name in left))
    return replace(memory, bound=bound, recent=tuple(order))


def _chosen(names: tuple[str, ...], mentioned: Collection[str], reader: GoalReader) -> tuple[str, ...]:
    """Return of what a noun may mean that which a goal mentions, itself or by a relative."""
    relatives = {n: {o for level in range(4) for o in reader.grounder.relatives(n, level)} for n in names}
    itself = tuple(n for n in names if n in mentioned)
    return itself or tuple(n for n in names if relatives[n].intersection(mentioned)) or names
