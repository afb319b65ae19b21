"""What a clause asks for, why it may have no goal, and what later clauses must not undo."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import lru_cache
from itertools import product

from tmd.goals.grounder import Moments
from tmd.goals.reading.noun_phrases import Memory
from tmd.goals.sources.table import GoalRow
from tmd.language.clause import Clause
from tmd.pddl.model import Atom, Domain, Formula, GroundAtom, conjuncts, signed_atoms
from tmd.pddl.task import Bits, Cube, Operator, Task


class Why(StrEnum):
    """Why there is no goal, or no plan."""

    NO_SUCH_THING = "no-such-thing"
    IMPOSSIBLE = "impossible"
    UNKNOWN_VERB = "unknown-verb"
    NOT_UNDERSTOOD = "not-understood"
    CONDITION = "condition"
    CONTRADICTION = "contradiction"
    GAVE_UP = "gave-up"


@dataclass(frozen=True, slots=True)
class Refused:
    """Why a clause has no goal here; ``hint`` is what could be said or done instead."""

    why: Why
    message: str
    hint: str | None = None


@dataclass(frozen=True, slots=True)
class ClauseGoal:
    """What a clause asks for.

    Attributes:
        clause: The clause.
        formula: The goal, over ground atoms.
        cubes: The same as a disjunction of conjunctions over the task's atoms.
        row: The row it was read by; ``None`` for a state ("the door is open").
        meant: For each noun the objects it may mean.
        approach: What shall hold on the way, before the goal does: *in the microwave*, *with the remote*.
        released: Objects whose earlier commitments need not be kept: what is poured leaves where it was.
        touches: Things that were named; a plan that touches none of a group did something else.
        notes: What of the clause was not taken into account.
    """

    clause: Clause
    formula: Formula
    cubes: tuple[Cube, ...]
    row: GoalRow | None = None
    meant: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    approach: tuple[Formula, ...] = ()
    released: tuple[str, ...] = ()
    touches: tuple[tuple[str, tuple[str, ...]], ...] = ()
    notes: tuple[str, ...] = ()


@dataclass(slots=True)
class Unit:
    """One thing that the verb acts on, with what stands behind prepositions."""

    direct: str | None
    relations: list[tuple[str, str]]


@dataclass(slots=True)
class ClauseReading:
    """What one clause is read with, in one state."""

    clause: Clause
    state: Bits
    moments: Moments
    memory: Memory
    notes: list[str] = field(default_factory=list)
    meant: dict[str, tuple[str, ...]] = field(default_factory=dict)
    approach: list[Formula] = field(default_factory=list)
    released: list[str] = field(default_factory=list)
    wanted: dict[str, tuple[str, ...]] = field(default_factory=dict)
    """Adjectives of nouns that tell what shall be, not which thing is meant."""
    asked: set[str] = field(default_factory=set)
    """The nouns whose meaning is being asked for: none leads to itself."""
    strict: bool = False
    """Every place that was said must have a slot."""
    awaited: bool = False
    """It is not asked for but waited for: of what a pronoun may mean, that of which it holds already is meant."""
    pronoun: str | None = None
    antecedent: int | None = None
    """Which of what ``pronoun`` may mean is tried."""
    taken: dict[str, str] = field(default_factory=dict)
    """Which thing a noun is taken for, where the same clause speaks of another one as well."""

    def again(self, *, strict: bool) -> ClauseReading:
        """A fresh reading of the same clause."""
        return ClauseReading(self.clause, self.state, self.moments, self.memory, strict=strict, awaited=self.awaited)


def text_of(clause: Clause) -> str:
    """The clause as it was said, for messages."""
    return " ".join(clause.text.split()) or clause.verb.replace("_", " ")


_MOST = 512
"""Maximum number of conjunctions made of a goal and of what must be kept."""


@dataclass(frozen=True, slots=True)
class Kept:
    """One literal that an earlier clause reached, as single literals of which one must go on holding.

    Attributes:
        ways: The literal, and what it may turn into.
        clause: The number of the step that reached it.
        hard: It must be kept whatever else becomes impossible: it was said that it shall stay so.
    """

    ways: tuple[Cube, ...]
    clause: int
    hard: bool = False


def keep(cube: Cube, clause: int, task: Task, *, hard: bool = False) -> tuple[Kept, ...]:
    """What is to be kept of a goal that was reached as ``cube``; what passes by itself is not."""
    passing = passing_predicates(task.problem.domain)
    found = []
    for literal, atom in _literals(cube, task):
        if atom.predicate in passing:
            continue
        later = tuple(_later(atom, task)) if literal.positive else ()
        found.append(Kept((literal, *later), clause, hard))
    return tuple(found)


def _literals(cube: Cube, task: Task) -> Iterator[tuple[Cube, GroundAtom]]:
    for atom in task.names(cube.positive):
        yield Cube(1 << task.index[atom], 0), atom
    for atom in task.names(cube.negative):
        yield Cube(0, 1 << task.index[atom]), atom


def _later(atom: GroundAtom, task: Task) -> Iterator[Cube]:
    """What an atom may turn into: raw food, cooked."""
    for change, predicate, place in transformations(task.problem.domain):
        if predicate != atom.predicate:
            continue
        for fact in sorted(task.static):
            if fact.predicate == change and fact.args[0] == atom.args[place]:
                other = GroundAtom(predicate, (*atom.args[:place], fact.args[1], *atom.args[place + 1 :]))
                if other in task.index:
                    yield Cube(1 << task.index[other], 0)


@lru_cache(maxsize=32)
def transformations(domain: Domain) -> tuple[tuple[str, str, int], ...]:
    """(c, p, i): some action replaces p(… s …) by p(… t …), at place i, where c(s, t) never changes."""
    changing = {effect.atom.predicate for action in domain.actions for effect in action.effects}
    found: dict[tuple[str, str, int], None] = {}
    for action in domain.actions:
        for lost in (e for e in action.effects if not e.positive):
            for gained in (e for e in action.effects if e.positive and e.atom.predicate == lost.atom.predicate):
                differing = [
                    i for i, (a, b) in enumerate(zip(lost.atom.terms, gained.atom.terms, strict=True)) if a != b
                ]
                if len(differing) != 1 or lost.condition != gained.condition:
                    continue
                pair = lost.atom.terms[differing[0]], gained.atom.terms[differing[0]]
                for atom, negated in _literals_within(lost.condition):
                    if not negated and atom.terms == pair and atom.predicate not in changing:
                        found[(atom.predicate, lost.atom.predicate, differing[0])] = None
    return tuple(found)


def _literals_within(condition: Formula) -> list[tuple[Atom, int]]:
    """The literals among the conjuncts of a condition."""
    return [literal for part in conjuncts(condition) for literal in signed_atoms(part) or ()]


@lru_cache(maxsize=32)
def passing_predicates(domain: Domain) -> frozenset[str]:
    """The predicates that some action takes away from everything at once: being near something, for one.

    What it takes away only from what is related to one of its arguments is not among them: a knob's own burner. What
    time alone takes away is: to keep all contents would forbid most of what people do with them afterwards.
    """
    constants = {c.name for c in domain.constants}
    found = set()
    for action in domain.actions:
        for effect in action.effects:
            quantified = {p.name for p in effect.parameters}
            own = [t for t in effect.atom.terms if t not in constants]
            if effect.positive or not own or not all(t in quantified for t in own):
                continue
            given = {p.name for p in action.parameters}
            related = (atom for atom, negated in _literals_within(effect.condition) if not negated)
            if not any(set(atom.terms) & quantified and set(atom.terms) & given for atom in related):
                found.add(effect.atom.predicate)
    return frozenset(found)


def aims(
    cubes: Sequence[Cube], kept: Sequence[Kept], released: Collection[str], task: Task
) -> Iterator[tuple[Cube, ...]]:
    """What to plan for, to be tried in this order: the goal with all that is to be kept, then with ever less of it."""
    names = set(released)
    own = [k for k in kept if not (names & _objects(k, task)) or k.hard]
    yield combined(cubes, own)
    shared = _named(cubes, task)
    fewer = [k for k in own if k.hard or not (_objects(k, task) & shared)]
    if len(fewer) < len(own):
        yield combined(cubes, fewer)
    hard = [k for k in own if k.hard]
    if len(hard) < len(fewer):
        yield combined(cubes, hard)


def combined(cubes: Iterable[Cube], kept: Sequence[Kept]) -> tuple[Cube, ...]:
    """The conjunctions of a goal and of what is to be kept, without those that contradict themselves."""
    found: dict[Cube, None] = {}
    for cube in cubes:
        open_ = [k for k in kept if not _gives_way(k, cube)]
        for ways in product(*(k.ways for k in open_)):
            positive, negative = cube
            for way in ways:
                positive |= way.positive
                negative |= way.negative
            if not positive & negative:
                found[Cube(positive, negative)] = None
            if len(found) >= _MOST:
                return tuple(found)
    return tuple(found)


def _gives_way(kept: Kept, cube: Cube) -> bool:
    """Whether the goal itself says the contrary: later clauses win."""
    literal = kept.ways[0]
    return not kept.hard and bool(literal.positive & cube.negative or literal.negative & cube.positive)


def _objects(kept: Kept, task: Task) -> set[str]:
    literal = kept.ways[0]
    return {a for atom in task.names(literal.positive | literal.negative) for a in atom.args}


def _named(cubes: Sequence[Cube], task: Task) -> set[str]:
    bits = 0
    for cube in cubes:
        bits |= cube.positive | cube.negative
    constants = {c.name for c in task.problem.domain.constants}
    return {a for atom in task.names(bits) for a in atom.args} - constants


def without_operators(task: Task, forbidden: Cube, names: Collection[str] = ()) -> Task:
    """The task without the operators that make a literal of ``forbidden`` hold, or handle one of ``names``.

    An operator that does so under a condition is there where that does not hold.
    """
    operators = tuple(
        _harmless(operator, forbidden)
        for operator in task.operators
        if not (operator.add & forbidden.positive or operator.delete & forbidden.negative)
        and not set(operator.instruction.args) & set(names)
    )
    return replace(task, operators=operators, by_instruction={o.instruction: o for o in operators})


def _harmless(operator: Operator, forbidden: Cube) -> Operator:
    """The operator, but for the states where a condition of it would make something forbidden true."""
    harmful = tuple(
        effect.condition
        for effect in operator.conditional
        if effect.add & forbidden.positive or effect.delete & forbidden.negative
    )
    return replace(operator, forbidden=(*operator.forbidden, *harmful)) if harmful else operator
