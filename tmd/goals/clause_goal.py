"""The goal of a clause, and the state of reading one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from tmd.goals.grounder import Moments
from tmd.goals.reading.noun_phrases import Memory
from tmd.goals.sources.table import GoalRow
from tmd.language.clause import Clause
from tmd.pddl.model import Formula
from tmd.pddl.task import Bits, Cube


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
        notes: What of the clause was not taken into account.
    """

    clause: Clause
    formula: Formula
    cubes: tuple[Cube, ...]
    row: GoalRow | None = None
    meant: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    approach: tuple[Formula, ...] = ()
    released: tuple[str, ...] = ()
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
