"""The goal of a clause, and the state of reading one."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from tmd.goals.grounder import Moments
from tmd.goals.reading.noun_phrases import Memory
from tmd.goals.sources.table import GoalRow, Slot
from tmd.goals.words import relations_said, words_of
from tmd.language.clause import Clause
from tmd.pddl.model import Formula
from tmd.pddl.task import Bits, Cube

_WORD = re.compile(r"[a-z]+")


@dataclass(frozen=True, slots=True)
class ClauseGoal:
    """The goal of a clause.

    Attributes:
        clause: The clause.
        formula: The goal, over ground atoms.
        cubes: The same as a disjunction of conjunctions over the task's atoms.
        row: The row it was read by; ``None`` for a state ("the door is open").
        meant: For each noun the objects it may mean.
        approach: Conditions on the way, before the goal holds: *in the microwave*, *with the remote*.
        notes: The parts of the clause that were not taken into account.
    """

    clause: Clause
    formula: Formula
    cubes: tuple[Cube, ...]
    row: GoalRow | None = None
    meant: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    approach: tuple[Formula, ...] = ()
    notes: tuple[str, ...] = ()


@dataclass(slots=True)
class Unit:
    """One thing that the verb acts on, with what is said behind prepositions."""

    direct: str | None
    relations: list[tuple[str, str]]


class Decision(NamedTuple):
    """A decision between readings of a clause: its kind, and the noun that it is about."""

    kind: str
    noun: str


@dataclass(slots=True)
class Decisions:
    """The decisions of reading one clause, each between the likeliest reading, number 0, and others.

    Attributes:
        changed: The decisions that are taken otherwise, each with the number of its reading.
        met: The decisions that were met, each with the number of readings that it is between.
    """

    changed: Mapping[Decision, int] = field(default_factory=dict)
    met: dict[Decision, int] = field(default_factory=dict)

    def taken(self, kind: str, noun: str, count: int) -> int:
        """Return the number of the reading to take of ``count``, at least 1."""
        decision = Decision(kind, noun)
        self.met[decision] = max(count, self.met.get(decision, 0))
        return min(self.changed.get(decision, 0), count - 1)


@dataclass(slots=True)
class ClauseReading:
    """The work of reading one clause in one state.

    Attributes:
        strict: Every place that was said must have a slot.
        awaited: It is not asked for but waited for: a pronoun means that of which it holds already.
        wanted: Adjectives of nouns that tell what shall be, not which thing is meant.
        asked: The nouns whose meaning is being asked for: none leads to itself.
        pronoun: The pronoun whose antecedents are being tried.
        antecedent: The number of the antecedent that is tried for it.
        taken: The thing that a noun is taken for, where the same clause speaks of another one as well.
        decisions: The decisions between readings.
    """

    clause: Clause
    moments: Moments
    memory: Memory
    strict: bool = False
    awaited: bool = False
    notes: list[str] = field(default_factory=list)
    meant: dict[str, tuple[str, ...]] = field(default_factory=dict)
    approach: list[Formula] = field(default_factory=list)
    wanted: dict[str, tuple[str, ...]] = field(default_factory=dict)
    asked: set[str] = field(default_factory=set)
    pronoun: str | None = None
    antecedent: int | None = None
    taken: dict[str, str] = field(default_factory=dict)
    decisions: Decisions = field(default_factory=Decisions)

    @property
    def state(self) -> Bits:
        """The state when the clause begins."""
        return self.moments.now

    def again(self, *, strict: bool = False) -> ClauseReading:
        """Return a fresh reading of the same clause."""
        return ClauseReading(self.clause, self.moments, self.memory, strict, self.awaited, decisions=self.decisions)


@dataclass(frozen=True, slots=True)
class RowUse:
    """A row with what stands behind its prepositions.

    Attributes:
        row: The row.
        direct: The noun of what the verb acts on.
        places: The slots behind prepositions, each with the relation and the noun; ``None`` where it points back.
        leftover: The relations of what is acted on that no slot takes.
        reading: The clause.
    """

    row: GoalRow
    direct: str | None
    places: Sequence[tuple[Slot, str, str | None]]
    leftover: Sequence[tuple[str, str]]
    reading: ClauseReading

    @property
    def said(self) -> list[str]:
        """The relations that ``?rel`` may be."""
        return [r for slot, relation, _ in self.places for r in relations_said(relation, slot.prepositions)] or [""]


def lost_amount(clause: Clause) -> str | None:
    """Return a word for an amount that stands in a clause and in no part of it: *half of the milk*."""
    setting = "" if clause.setting in words_of("amounts") else clause.setting or ""
    kept = " ".join((*clause.objects, *clause.quantities.values(), clause.duration or "", setting))
    lost = [word for word in _WORD.findall(clause.text.lower()) if word in words_of("amounts")]
    return next((word for word in lost if word not in _WORD.findall(kept)), None)


def text_of(clause: Clause) -> str:
    """Return the clause as it was said, for messages."""
    return " ".join(clause.text.split()) or words(clause.verb)


def words(name: str) -> str:
    """Return a name as words, for messages."""
    return name.replace("_", " ")
