"""Meanings of verbs, learned from demonstrations: the literals that hold when the segments of a verb are done.

For every verb with the same slots, each literal that could be a goal is counted: in how many clauses it *could* hold,
in how many of these it held at the end, and in how many it became true. A literal that nearly always holds and often
becomes true is what the verb is for; what comes about by the way is not. Dishes (*make ramen*) are learned from the
ends of whole demonstrations. What is opened or switched on by the way and mostly undone again is learned as well. Not
in the paper.
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from typing import Any

from tmd.diagnostics import TmdError
from tmd.goals.grounder import Grounder, Moments
from tmd.goals.reading.noun_phrases import Nouns
from tmd.goals.sources.table import (
    LEARNED,
    PREPOSITIONS,
    RELATION,
    GoalRow,
    GoalTable,
    PutBack,
    read_row,
)
from tmd.goals.words import CONTRARY, is_noun, is_pronoun, is_verb, results, table, the_word, words_of
from tmd.language.clause import PERSONS, Clause, Mood
from tmd.language.lexicon.lexicon import Declared, Lexicon
from tmd.language.lexicon.names import words_in_name
from tmd.language.lexicon.nouns import NAME, Match
from tmd.library.library import lessons
from tmd.pddl.domain_traits import passing_predicates
from tmd.pddl.ground_formula import FALSE
from tmd.pddl.model import OBJECT, Domain, Formula, GroundAtom, Instruction, Predicate
from tmd.pddl.task import Bits
from tmd.pddl.writer import format_formula
from tmd.world.demonstration import Demonstration
from tmd.world.world import World, run

FEWEST = 3
"""Clauses that a literal must have been possible in."""
SUPPORT = 0.7
"""The share of them in which it must have held at the end."""
CHANGED = 0.3
"""The share of them in which it must have become true: what always was so is no goal."""
COMPANION = 0.8
"""The share of what the best literal has that a further one must have to join it."""
DISH = 0.75
"""The share of whole demonstrations of a dish whose ends must agree."""
UNDONE = 0.6
"""The share of the cases in which people must have undone what they opened or switched on."""
FEWEST_UNDONE = 5
"""The cases of which that is a share."""
LEFT = 0.9
"""The share of the cases in which people leave what they opened open, so that no plan restores it: packets, tins."""
FEWEST_LEFT = 2
"""The cases of which that is a share."""
_NAMES = re.compile(r"\((\S+)")
"""What stands behind parentheses: the predicates of a condition, and its connectives."""
_NEGATED = "(not"
_QUANTIFIED = "(exists"


@dataclass(slots=True)
class _Count:
    possible: int = 0
    held: int = 0
    changed: int = 0

    @property
    def support(self) -> float:
        """The share of the clauses in which it was possible where it held at the end."""
        return self.held / self.possible if self.possible else 0.0

    @property
    def gained(self) -> float:
        """The share in which it became true."""
        return self.changed / self.possible if self.possible else 0.0


@dataclass(slots=True)
class _Shape:
    """Counts for one verb with one kind of slots."""

    clauses: int = 0
    counts: dict[str, _Count] = field(default_factory=lambda: defaultdict(_Count))


def learn_goals(
    demonstrations: Iterable[Demonstration], world_of: Callable[[str], World], lexicon: Lexicon
) -> GoalTable:
    """Return the rows that demonstrations teach."""
    shown = list(demonstrations)
    if not shown:
        return GoalTable()
    learner = _Learner(shown, world_of, lexicon)
    for demonstration in shown:
        learner.take(demonstration)
    return GoalTable(tuple(learner.rows()), put_back=learner.put_back(), unrestored=learner.unrestored())


def table_to_json(table: GoalTable) -> dict[str, object]:
    """Return a learned table as :func:`table_from_json` reads it."""
    rows = [
        {
            "pattern": row.pattern,
            "condition": " ".join(format_formula(row.condition).split()),
            "evidence": row.evidence,
            "probability": round(row.probability, 4),
        }
        for row in table.rows
    ]
    return {"rows": rows, "put_back": _pairs(table.put_back), "unrestored": _pairs(table.unrestored)}


def _pairs(states: Iterable[PutBack]) -> list[list[str]]:
    return [[state.predicate, state.kind] for state in sorted(states)]


def _states(pairs: Iterable[Sequence[str]]) -> frozenset[PutBack]:
    return frozenset(PutBack(str(predicate), str(kind)) for predicate, kind in pairs)


def table_from_json(data: Mapping[str, Any], domain: Domain) -> GoalTable:
    """Return a learned table.

    Raises:
        KeyError, TypeError, ValueError, TmdError: It is no such table.
    """
    rows = []
    for entry in data["rows"]:
        row = read_row(Declared(str(entry["pattern"]), str(entry["condition"])), domain, LEARNED)
        rows.append(replace(row, evidence=str(entry["evidence"]), probability=float(str(entry["probability"]))))
    return GoalTable(tuple(rows), put_back=_states(data["put_back"]), unrestored=_states(data["unrestored"]))


def _said(text: str) -> int:
    """Return how specific a literal is: of two that hold alike, the more specific one is the goal."""
    return text.count("?x") + text.count("?y") + text.count("(")


def _acted_on(clause: Clause) -> list[str]:
    """Return what a verb acts on; the empty name for what was left out."""
    return [n for n in clause.direct if n not in PERSONS] or ([""] if "" in clause.antecedents else [])


class _Learner:
    """Counts, demonstration after demonstration."""

    def __init__(
        self, demonstrations: Sequence[Demonstration], world_of: Callable[[str], World], lexicon: Lexicon
    ) -> None:
        self.world_of = world_of
        self.lexicon = lexicon
        self.domain = world_of(demonstrations[0].environment).domain
        self.shapes: dict[tuple[str, tuple[str, ...], bool], _Shape] = defaultdict(_Shape)
        self.dishes: dict[str, Counter[tuple[str, ...]]] = defaultdict(Counter)
        self.made: Counter[str] = Counter()
        self.started: dict[PutBack, _Count] = defaultdict(_Count)
        words = {word for verb in words_of("verbs", "starting") for word in results(verb)}
        self.startable = {p.name for p in self.domain.predicates if words & words_in_name(p.name)}
        self._grounders: dict[str, tuple[Grounder, Nouns]] = {}
        self._known_literals: dict[tuple[str, ...], list[tuple[str, GoalRow]]] = {}
        self._known_possible: dict[tuple[str, tuple[tuple[str, str], ...], str], list[tuple[str, Formula]]] = {}
        self.predicates = self._of_ends(demonstrations)

    def _of_ends(self, demonstrations: Sequence[Demonstration]) -> tuple[Predicate, ...]:
        """Return the predicates of the stated ends; where none is stated, those that last."""
        said = (text for d in demonstrations for text in (*d.end_state, d.goal or ""))
        named = {name for text in said for name in _NAMES.findall(text)}
        passing = passing_predicates(self.domain)
        fluent = {e.atom.predicate for action in self.domain.actions for e in action.effects}
        wanted = (named & fluent) or (fluent - passing)
        return tuple(p for p in self.domain.predicates if p.name in wanted and p.parameters)

    def _tools(self, world: World) -> tuple[Grounder, Nouns]:
        if world.name not in self._grounders:
            grounder = Grounder(world)
            self._grounders[world.name] = grounder, Nouns(world, GoalTable(), grounder)
        return self._grounders[world.name]

    # ------------------------------------------------------------------ counting

    def take(self, demonstration: Demonstration) -> None:
        """Count what one demonstration shows."""
        world = self.world_of(demonstration.environment)
        whole = world.task.init, run(world, world.task.init, demonstration.instructions)
        self._undone(world, world.task.init, demonstration.instructions)
        for lesson in lessons(demonstration, world, self.lexicon):
            if lesson.clause is not None and lesson.clause.mood is Mood.DO:
                self._clause(lesson.clause, world, lesson.states, lesson.instructions)
                self._dish(lesson.clause, world, whole)

    def _clause(self, clause: Clause, world: World, states: tuple[Bits, Bits], done: Sequence[object]) -> None:
        binding = self._slots(clause, world, states[0], done)
        if binding is None:
            return
        slots, relation, substance = binding
        key = self.lexicon.canonical_verb(clause.verb), tuple(p for p, _ in slots), substance
        shape = self.shapes[key]
        shape.clauses += 1
        grounder, _ = self._tools(world)
        names = tuple((variable, name) for variable, (_, name) in zip(("?x", "?y"), slots, strict=False))
        for text, found in self._possible(world, names, relation or "in"):
            count = shape.counts[text]
            count.possible += 1
            after = grounder.truth(found, states[1])
            count.held += after
            count.changed += after and not grounder.truth(found, states[0])

    def _possible(
        self, world: World, names: tuple[tuple[str, str], ...], relation: str
    ) -> Sequence[tuple[str, Formula]]:
        """Return the literals of some objects that may hold, ground; none of them looks back."""
        key = world.name, names, relation
        if key not in self._known_possible:
            grounder, _ = self._tools(world)
            slots = dict(names)
            said, moments = {**slots, RELATION: relation}, Moments(world.task.init, world.task.init)
            each = (
                (text, *grounder.ground_live(row.condition, said, slots, moments))
                for text, row in self._literals(tuple(slots))
            )
            self._known_possible[key] = [(text, found) for text, found, live in each if live and found != FALSE]
        return self._known_possible[key]

    def _undone(self, world: World, state: Bits, instructions: Sequence[Instruction]) -> None:
        """Count what is opened or switched on, and whether that is undone before the end."""
        first, ever = state, 0
        for instruction in instructions:
            operator = world.task.by_instruction.get(instruction)
            if operator is None or not operator.applicable(state):
                continue
            state = operator.apply(state)
            ever |= state & ~first
        for atom in world.task.names(ever):
            if atom.predicate in self.startable and len(atom.args) == 1:
                count = self.started[PutBack(atom.predicate, world.mentions.kinds.get(atom.args[0], ""))]
                count.possible += 1
                count.held += not state >> world.task.index[atom] & 1

    def unrestored(self) -> frozenset[PutBack]:
        """Return the literals that are hardly ever undone."""
        left = (p for p, c in self.started.items() if c.possible >= FEWEST_LEFT and c.held <= (1 - LEFT) * c.possible)
        return frozenset(left)

    def put_back(self) -> frozenset[PutBack]:
        """Return the literals that are undone in most cases."""
        return frozenset(p for p, c in self.started.items() if c.possible >= FEWEST_UNDONE and c.support >= UNDONE)

    def _slots(
        self, clause: Clause, world: World, state: Bits, done: Sequence[object]
    ) -> tuple[list[tuple[str, str]], str, bool] | None:
        """Return preposition group and object of the direct object and of the first place that was said."""
        used = {a for i in done for a in getattr(i, "args", ())}
        direct = _acted_on(clause)
        first = self._object(direct[0], clause, world, state, used) if len(direct) == 1 else None
        if first is None:
            return None
        substance = first in world.profiles.constants
        for relation in (r for r in clause.relations if r.source in (direct[0], None) and r.target not in PERSONS):
            group = next((g for g, words in PREPOSITIONS.items() if relation.relation in words), None)
            if group is None:
                continue
            second = self._object(relation.target, clause, world, state, used)
            if second is not None and second != first:
                return [("", first), (group, second)], group, substance
        return [("", first)], "", substance

    def _object(self, noun: str, clause: Clause, world: World, state: Bits, used: set[str]) -> str | None:
        """Return the one object, or constant, that a noun meant: one that was used, or the only one there is."""
        _, nouns = self._tools(world)
        name = clause.meant(noun)[0]
        if is_pronoun(name):
            return None
        objects = [t for t in nouns.things(name, state) if t not in world.profiles.constants]
        own = [t for t in objects if t in used or any(p in used for _, p in world.profiles.parts.get(t, ()))]
        only = objects if len(objects) == 1 else () if objects else nouns.constants(name, (OBJECT,), state)
        return next(iter((*own, *only)), None)

    # ------------------------------------------------------------------ literals

    def _literals(self, variables: tuple[str, ...]) -> Sequence[tuple[str, GoalRow]]:
        if variables not in self._known_literals:
            self._known_literals[variables] = list(self._make_literals(variables))
        return self._known_literals[variables]

    def _make_literals(self, variables: tuple[str, ...]) -> Iterator[tuple[str, GoalRow]]:
        """Yield every literal that could be a goal of a clause with such slots."""
        pattern = "do X" + (" in Y" if "?y" in variables else "")
        for predicate in self.predicates:
            for terms in product(*self._choices(predicate, variables)):
                own = [t for t in terms if t in variables]
                if not own or len(set(own)) < len(own) or (RELATION in terms and "?y" not in terms):
                    continue
                for text in self._texts(predicate, terms):
                    try:
                        yield text, read_row(Declared(pattern, text), self.domain, LEARNED)
                    except TmdError:
                        continue

    def _choices(self, predicate: Predicate, variables: tuple[str, ...]) -> Iterator[list[str]]:
        """Yield for each parameter of a predicate what may stand there."""
        for parameter in predicate.parameters:
            types = set(parameter.types)
            fixed = [c.name for c in self.domain.constants if set(c.types) & types or c.types == parameter.types]
            if any(c in PREPOSITIONS for c in fixed):
                yield [RELATION]
            elif len(fixed) == 1 and len(predicate.parameters) > 1 and not is_noun(fixed[0], "floor"):
                yield [*fixed, *variables]
            else:
                yield [*variables, "?v", *fixed[:6]]

    def _texts(self, predicate: Predicate, terms: Sequence[str]) -> Iterator[str]:
        """Yield the literals of a predicate with such terms."""
        atom = f"({' '.join((predicate.name, *terms))})"
        if "?v" not in terms:
            yield atom
            yield f"{_NEGATED} {atom})"
            return
        kind = " ".join(predicate.parameters[terms.index("?v")].types[:1])
        yield f"{_QUANTIFIED} (?v - {kind}) {atom})"
        states = (p.name for p in self.predicates if len(p.parameters) == 1)
        for state in states if terms.index("?v") == 0 else ():
            yield f"{_QUANTIFIED} (?v - {kind}) (and {atom} ({state} ?v)))"

    # ------------------------------------------------------------------ dishes

    def _dish(self, clause: Clause, world: World, states: tuple[Bits, Bits]) -> None:
        """Count what is so of some one thing at the end of a demonstration that makes a dish."""
        nouns = [n for n in clause.direct if n not in {*PERSONS, *words_of("measures")} and not is_pronoun(n)]
        if not is_verb(clause.verb, "making") or len(nouns) != 1:
            return
        if any(m.score == 1.0 for m in self._named(nouns[0], world)):
            return
        facts: dict[str, set[tuple[str, ...]]] = defaultdict(set)
        for atom in world.task.names(states[1] & ~states[0]):
            if self._is_of_a_dish(atom, world):
                facts[atom.args[0]].add((atom.predicate, *atom.args[1:]))
        if facts:
            best = max(facts.values(), key=lambda found: (len(found), sorted(found)))
            self.made[nouns[0]] += 1
            self.dishes[nouns[0]].update(best)

    def _is_of_a_dish(self, atom: GroundAtom, world: World) -> bool:
        """Return whether a fact is about one thing, its state or its contents."""
        constants = world.profiles.constants
        wanted = any(p.name == atom.predicate for p in self.predicates) and atom.args and atom.args[0] not in constants
        return bool(wanted) and all(a in constants and a not in PREPOSITIONS for a in atom.args[1:])

    def _named(self, noun: str, world: World) -> list[Match]:
        """Return the objects that a noun names, where it names nothing that they contain."""
        constants = world.profiles.constants
        if any(m.name in constants for m in world.mentions.ranked(noun)):
            return []
        return [m for m in world.mentions.ranked(noun) if m.how == NAME and m.name not in constants]

    # ------------------------------------------------------------------ rows

    def rows(self) -> Iterator[GoalRow]:
        """Yield the rows that the counts bear out, by verb."""
        for noun, count in sorted(self.made.items()):
            common = sorted(f for f, n in self.dishes[noun].items() if n >= DISH * count)
            if count >= FEWEST and common:
                parts = " ".join(f"({' '.join((f[0], '?v', *f[1:]))})" for f in common)
                condition = f"(exists (?v - object) (and {parts}))"
                evidence = f"the ends of {count} demonstrations that make {noun}"
                yield from self._row(f"{'|'.join(table('rows')['serve'])} {noun}", condition, evidence, 0.8)
        for (verb, groups, _), shape in sorted(self.shapes.items()):
            yield from self._of_shape(verb, groups, shape)

    def _of_shape(self, verb: str, groups: tuple[str, ...], shape: _Shape) -> Iterator[GoalRow]:
        good = sorted(
            ((text, c) for text, c in shape.counts.items() if self._good(text, c)),
            key=lambda pair: (
                -round(pair[1].gained * pair[1].support, 1),
                _QUANTIFIED in pair[0],
                -_said(pair[0]),
                pair[0],
            ),
        )
        if not good:
            return
        core, count = good[0]
        companions = [
            text
            for text, other in good[1:]
            if other.held >= COMPANION * count.held and not text.startswith((_NEGATED, _QUANTIFIED))
        ]
        parts = [core, *companions[:2]]
        condition = parts[0] if len(parts) == 1 else f"(and {' '.join(parts)})"
        take = the_word("verbs", "taking")
        held = {word for word in results(take) if not word.startswith(CONTRARY)}
        if not is_verb(verb, "carrying") and any(word in core for word in held):
            return  # what is in the hand is the way, not the goal
        pattern = f"{verb} X" + (f" {groups[1]} Y" if len(groups) > 1 else "")
        evidence = f"holds after {count.held} of {count.possible} clauses, became true in {count.changed}"
        yield from self._row(pattern, condition, evidence, count.support)

    def _good(self, text: str, count: _Count) -> bool:
        least = 0.9 if text.startswith(_NEGATED) else SUPPORT
        return count.possible >= FEWEST and count.support >= least and count.gained >= CHANGED

    def _row(self, pattern: str, condition: str, evidence: str, probability: float) -> Iterator[GoalRow]:
        try:
            row = read_row(Declared(pattern, condition), self.domain, LEARNED)
        except TmdError:
            return
        yield replace(row, evidence=evidence, probability=probability)
