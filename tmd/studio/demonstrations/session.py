"""One person's demonstration under way: the steps done for a text, with undo and redo.

Steps are counted from 1, so that ``goto(0)`` is the beginning; clauses from 0, as in a plan.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Generic, TypeVar

from tmd.diagnostics import TmdError
from tmd.goals.wording import Wording
from tmd.language.lexicon.lexicon import Lexicon
from tmd.pddl.model import Instruction
from tmd.pddl.semantics import bind
from tmd.pddl.task import Bits
from tmd.studio.demonstrations.alignment import NO_HABITS, Habits, propose
from tmd.studio.demonstrations.clause_spans import ClauseSpan, clean, cut
from tmd.world.demonstration import Segment
from tmd.world.world import World

# Longer demonstrations are refused: the longest of the bundled ones has about thirty steps.
MAX_STEPS = 500


_T = TypeVar("_T")


class History(Generic[_T]):
    """The versions of an immutable value, one of them current."""

    def __init__(self, first: _T) -> None:
        self._versions = [first]
        self._at = 0

    @property
    def current(self) -> _T:
        """The current version."""
        return self._versions[self._at]

    def add(self, version: _T) -> None:
        """Make a new version current, in place of all that were undone."""
        self._versions[self._at + 1 :] = [version]
        self._at += 1

    @property
    def before(self) -> bool:
        """Return whether there is a version to go back to."""
        return self._at > 0

    @property
    def after(self) -> bool:
        """Return whether there is a version that was undone."""
        return self._at + 1 < len(self._versions)

    def undo(self) -> bool:
        """Go back to the version before; return false if there is none."""
        moved = self.before
        self._at -= moved
        return moved

    def redo(self) -> bool:
        """Go to the version after; return false if there is none."""
        moved = self.after
        self._at += moved
        return moved


@dataclass(frozen=True, slots=True)
class DemonstratedStep:
    """One instruction of a demonstration.

    Attributes:
        instruction: What was done.
        clause: The number of the clause that it serves, from 0.
        marked: Whether the person chose the clause; otherwise it is a proposal.
    """

    instruction: Instruction
    clause: int
    marked: bool = False


@dataclass(frozen=True, slots=True)
class _Version:
    """Version of a session: its steps, the states before and after each, and the marked clauses."""

    steps: tuple[DemonstratedStep, ...]
    states: tuple[Bits, ...]
    pins: Mapping[int, int] = field(default_factory=lambda: MappingProxyType({}))


class Session:
    """A demonstration under way.

    Args:
        world: The environment it begins in.
        text: What is to be done.
        lexicon: The words of the domain.
        instructions: What was done already.
        pins: The clauses that the person chose, from 0, by the number of the step, from 1.
        proposed: The plan that is corrected, if one is.
        habits: What was done for verbs before; proposals of clauses are better with it.

    Attributes:
        world: The environment.
        text: The text, without control characters.
        clauses: The pieces of the text that steps serve, at least one.
        history: What was done, and undone.

    Raises:
        TmdError: The text is empty or too long, an instruction does not apply, or there is no step or clause of a pin.
    """

    def __init__(
        self,
        world: World,
        text: str,
        lexicon: Lexicon | None = None,
        *,
        instructions: Iterable[Instruction] = (),
        pins: Mapping[int, int] | None = None,
        proposed: tuple[DemonstratedStep, ...] | None = None,
        habits: Habits = NO_HABITS,
    ) -> None:
        self.world = world
        self.text = clean(text)
        self.clauses: tuple[ClauseSpan, ...] = cut(self.text, lexicon)
        self.proposed = None if proposed is None else _in_order(proposed, len(self.clauses))
        self._habits = habits
        self._wording = Wording(world.task.problem)
        self._cursor = 0
        self.history = History(_Version((), (world.task.init,)))
        for instruction in instructions:
            self.do(instruction)
        for step, clause in sorted((pins or {}).items()):
            self.mark(step, clause)

    @property
    def steps(self) -> tuple[DemonstratedStep, ...]:
        """All that was done and not undone."""
        return self.history.current.steps

    @property
    def instructions(self) -> tuple[Instruction, ...]:
        """The same without the clauses."""
        return tuple(step.instruction for step in self.steps)

    @property
    def pins(self) -> dict[int, int]:
        """Numbers of the clauses that the person marked, from 0, by the number of the step, from 1."""
        return {number + 1: clause for number, clause in sorted(self.history.current.pins.items())}

    @property
    def cursor(self) -> int:
        """After how many steps the state is that is looked at."""
        return self._cursor

    @property
    def state(self) -> Bits:
        """The state that is looked at, as bits of the environment's task."""
        return self.history.current.states[self._cursor]

    @property
    def states(self) -> tuple[Bits, ...]:
        """The states before the first step and after each, as bits of the environment's task."""
        return self.history.current.states

    def do(self, instruction: Instruction) -> DemonstratedStep:
        """Carry out ``instruction`` in the state that is looked at; steps behind it go, until this is undone.

        Raises:
            TmdError: It does not apply, with the broken precondition; or the demonstration is too long.
        """
        now, at = self.history.current, self._cursor
        if at >= MAX_STEPS:
            raise TmdError(f"a demonstration has at most {MAX_STEPS} steps", hint="save it, and begin another")
        after = self._applied(instruction, now.states[at], at + 1)
        done = (*(step.instruction for step in now.steps[:at]), instruction)
        pins = {number: clause for number, clause in now.pins.items() if number < at}
        self._become(self._version(done, (*now.states[: at + 1], after), pins))
        return self.steps[-1]

    def undo(self) -> bool:
        """Take the last change back (a step, a mark); false where there is none."""
        moved = self.history.undo()
        self._cursor = len(self.steps) if moved else self._cursor
        return moved

    def redo(self) -> bool:
        """Make the change again that was taken back last; false where there is none."""
        moved = self.history.redo()
        self._cursor = len(self.steps) if moved else self._cursor
        return moved

    def goto(self, step: int) -> None:
        """Look at the state after that many steps; 0 is the beginning. Nothing is undone.

        Raises:
            TmdError: There are not so many.
        """
        if not 0 <= step <= len(self.steps):
            raise TmdError(f"there is no step {step}", hint=f"the demonstration has {len(self.steps)} steps")
        self._cursor = step

    def mark(self, step: int, clause: int) -> None:
        """Mark the clause that a step serves.

        Steps before it that serve a later clause, and steps behind it that serve an earlier one, move along; where
        one of them was marked otherwise, that mark goes.

        Args:
            step: The number of the step, from 1.
            clause: The number of the clause, from 0.

        Raises:
            TmdError: There is no such step or clause.
        """
        now = self.history.current
        if not 0 < step <= len(self.steps):
            raise TmdError(f"there is no step {step}", hint=f"the demonstration has {len(self.steps)} steps")
        if not 0 <= clause < len(self.clauses):
            raise TmdError(f"there is no clause {clause + 1}", hint=f"the text has {len(self.clauses)}")
        pins = {n: c for n, c in now.pins.items() if (n < step - 1 and c <= clause) or (n > step - 1 and c >= clause)}
        done = tuple(s.instruction for s in now.steps)
        at = self._cursor
        self._become(self._version(done, now.states, {**pins, step - 1: clause}))
        self._cursor = at

    def segments(self) -> tuple[Segment, ...]:
        """Return the pieces of the text with what serves each, as a demonstration has them."""
        steps = self.steps
        return tuple(Segment(piece.start, piece.end, _own(steps, n)) for n, piece in enumerate(self.clauses))

    def _become(self, version: _Version) -> None:
        self.history.add(version)
        self._cursor = len(version.steps)

    def _version(self, done: tuple[Instruction, ...], states: tuple[Bits, ...], pins: Mapping[int, int]) -> _Version:
        clauses = propose([piece.clause for piece in self.clauses], done, self.world, pins, self._habits)
        pairs = enumerate(zip(done, clauses, strict=True))
        steps = tuple(DemonstratedStep(instruction, clause, number in pins) for number, (instruction, clause) in pairs)
        return _Version(steps, states, MappingProxyType(dict(pins)))

    def _applied(self, instruction: Instruction, state: Bits, step: int) -> Bits:
        """Return the state after ``instruction``.

        Raises:
            TmdError: It does not apply.
        """
        task = self.world.task
        operator = task.by_instruction.get(instruction)
        if operator is not None and operator.applicable(state):
            return operator.apply(state)
        bind(task.problem, instruction)
        why = self._wording.broken(instruction, task.decode(state)) or "nothing can bring it about here"
        raise TmdError(f"step {step}, {instruction}, does not apply: {why}")


def _in_order(steps: Iterable[DemonstratedStep], clauses: int) -> tuple[DemonstratedStep, ...]:
    """Return the steps with clauses that there are, never falling."""
    found: list[DemonstratedStep] = []
    for step in steps:
        clause = min(max(step.clause, found[-1].clause if found else 0), clauses - 1)
        found.append(DemonstratedStep(step.instruction, clause, step.marked))
    return tuple(found)


def _own(steps: Iterable[DemonstratedStep], clause: int) -> tuple[Instruction, ...]:
    return tuple(step.instruction for step in steps if step.clause == clause)
