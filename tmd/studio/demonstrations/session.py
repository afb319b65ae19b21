"""One person's demonstration under way: the steps done for a text, with undo and redo.

Steps are counted from 1, so that ``goto(0)`` is the beginning; clauses from 0, as in a plan.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import accumulate

from tmd.diagnostics import TmdError
from tmd.goals.wording import Wording
from tmd.language.lexicon.lexicon import Lexicon
from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits
from tmd.studio.demonstrations.alignment import NO_HABITS, Habits, propose
from tmd.studio.demonstrations.clause_spans import ClauseSpan, clean, cut
from tmd.world.demonstration import Segment
from tmd.world.world import World

# Longer demonstrations are refused: the longest of the bundled ones has about thirty steps.
MAX_STEPS = 500


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


class EditedSteps:
    """Steps for a text, with undo and redo.

    They begin in ``world``; ``text`` says what is to be done.

    Attributes:
        text: The text, without control characters.
        clauses: The pieces of the text that steps serve, at least one.
        proposed: The plan that is corrected, if one is.

    Raises:
        TmdError: The text is empty or too long.
    """

    proposed: tuple[DemonstratedStep, ...] | None = None

    def __init__(
        self, world: World, text: str, lexicon: Lexicon | None, steps: tuple[DemonstratedStep, ...] = ()
    ) -> None:
        self.world = world
        self.text = clean(text)
        self.clauses: tuple[ClauseSpan, ...] = cut(self.text, lexicon)
        self._versions, self._at = [steps], 0
        self._wording = Wording(world.task.problem)

    @property
    def steps(self) -> tuple[DemonstratedStep, ...]:
        """All steps that were not undone."""
        return self._versions[self._at]

    @property
    def undoable(self) -> bool:
        """Return whether there is a change to take back."""
        return self._at > 0

    @property
    def redoable(self) -> bool:
        """Return whether there is a change that was taken back."""
        return self._at + 1 < len(self._versions)

    def undo(self) -> bool:
        """Take the last change back; false where there is none."""
        return self.undoable and self._go(-1)

    def redo(self) -> bool:
        """Make the change again that was taken back last; false where there is none."""
        return self.redoable and self._go(1)

    def _go(self, by: int) -> bool:
        self._at += by
        return True

    def _add(self, steps: tuple[DemonstratedStep, ...]) -> None:
        """Make steps current, in place of all that were undone."""
        self._versions[self._at + 1 :] = [steps]
        self._at += 1

    @property
    def instructions(self) -> tuple[Instruction, ...]:
        """The steps without the clauses."""
        return tuple(step.instruction for step in self.steps)

    def segments(self) -> tuple[Segment, ...]:
        """Return the pieces of the text with what serves each, as a demonstration has them."""
        last = len(self.clauses) - 1
        owners = list(accumulate((min(step.clause, last) for step in self.steps), max))
        return tuple(
            Segment(
                piece.start, piece.end, tuple(i for i, n in zip(self.instructions, owners, strict=True) if n == number)
            )
            for number, piece in enumerate(self.clauses)
        )

    def _known(self, step: int, least: int = 1) -> None:
        if not least <= step <= len(self.steps):
            raise TmdError(f"there is no step {step}", hint=f"there are {len(self.steps)} steps")

    def _after(self, instruction: Instruction, state: Bits) -> Bits | str:
        """Return the state after an instruction, or why it does not apply.

        Raises:
            TmdError: There is no such instruction.
        """
        task = self.world.task
        operator = task.by_instruction.get(instruction)
        if operator is not None and operator.applicable(state):
            return operator.apply(state)
        return self._wording.broken(instruction, task.decode(state)) or "nothing can bring it about here"


class Session(EditedSteps):
    """A demonstration under way.

    ``instructions`` were carried out already. ``pins`` are the clauses that the person chose, from 0, by the number of
    the step, from 1. ``habits`` are what was done for verbs before; proposals of clauses are better with them.

    Attributes:
        cursor: After how many steps the state is that is looked at.

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
        habits: Habits = NO_HABITS,
    ) -> None:
        super().__init__(world, text, lexicon)
        self._habits = habits
        self.cursor = 0
        for instruction in instructions:
            self.do(instruction)
        for step, clause in sorted((pins or {}).items()):
            self.mark(step, clause)

    @property
    def pins(self) -> dict[int, int]:
        """Numbers of the clauses that the person marked, from 0, by the number of the step, from 1."""
        return {number: step.clause for number, step in enumerate(self.steps, start=1) if step.marked}

    @property
    def state(self) -> Bits:
        """The state that is looked at, as bits of the environment's task."""
        return self.states[self.cursor]

    @property
    def states(self) -> tuple[Bits, ...]:
        """The states before the first step and after each, as bits of the environment's task."""
        return tuple(self.world.task.trace(self.world.task.init, self.instructions))

    def do(self, instruction: Instruction) -> DemonstratedStep:
        """Carry out ``instruction`` in the state that is looked at; steps behind it go, until this is undone.

        Raises:
            TmdError: It does not apply, with the broken precondition; or the demonstration is too long.
        """
        at = self.cursor
        if at >= MAX_STEPS:
            raise TmdError(f"a demonstration has at most {MAX_STEPS} steps", hint="save it, and begin another")
        after = self._after(instruction, self.state)
        if isinstance(after, str):
            raise TmdError(f"step {at + 1}, {instruction}, does not apply: {after}")
        self._become((*self.instructions[:at], instruction), {n: c for n, c in self.pins.items() if n <= at})
        self.cursor = at + 1
        return self.steps[-1]

    def _go(self, by: int) -> bool:
        super()._go(by)
        self.cursor = len(self.steps)
        return True

    def goto(self, step: int) -> None:
        """Look at the state after that many steps; 0 is the beginning. Nothing is undone.

        Raises:
            TmdError: There are not so many.
        """
        self._known(step, 0)
        self.cursor = step

    def mark(self, step: int, clause: int) -> None:
        """Mark the clause that a step serves.

        Steps before it that serve a later clause, and steps behind it that serve an earlier one, move along; where
        one of them was marked otherwise, that mark goes.

        ``step`` counts from 1, ``clause`` from 0.

        Raises:
            TmdError: There is no such step or clause.
        """
        self._known(step)
        if not 0 <= clause < len(self.clauses):
            raise TmdError(f"there is no clause {clause + 1}", hint=f"the text has {len(self.clauses)}")
        pins = {n: c for n, c in self.pins.items() if (n < step and c <= clause) or (n > step and c >= clause)}
        self._become(self.instructions, {**pins, step: clause})

    def _become(self, done: tuple[Instruction, ...], pins: Mapping[int, int]) -> None:
        """Make instructions, and the clauses that the person chose for some of them, the current steps."""
        chosen = {number - 1: clause for number, clause in pins.items()}
        clauses = propose([piece.clause for piece in self.clauses], done, self.world, chosen, self._habits)
        pairs = enumerate(zip(done, clauses, strict=True))
        self._add(tuple(DemonstratedStep(each, clause, n in chosen) for n, (each, clause) in pairs))
