"""A run as it is told: what each instruction is for, when it begins, and how it ended."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Protocol

from tmd.pddl.model import GroundAtom, Instruction
from tmd.robot.execute import Performer
from tmd.robot.outcome import Step


@dataclass(frozen=True, slots=True)
class Order:
    """One instruction of a plan, and what it is for.

    Attributes:
        instruction: What to do.
        clause: The clause that it serves, from 0; ``None`` where the plan comes from a file.
        latent: Whether the person left it unsaid.
        text: What the person said there.
    """

    instruction: Instruction
    clause: int | None = None
    latent: bool = False
    text: str = ""


@dataclass(frozen=True, slots=True)
class Title:
    """An instruction that is being done.

    Attributes:
        instruction: What is done.
        number: Its place in the plan, from 1; of a repair, the place before which it was put.
        of: How many the plan has.
        repair: Whether the monitor put it in.
        order: What it is for; ``None`` for a repair.
    """

    instruction: Instruction
    number: int
    of: int
    repair: bool
    order: Order | None


class Listener(Protocol):
    """Who is told how a run goes."""

    def begin(self, title: Title, expected: Sequence[GroundAtom]) -> None:
        """An instruction begins; ``expected`` is what it should bring about, sorted."""
        ...

    def end(self, title: Title, step: Step) -> None:
        """It is over."""
        ...


class Recorder:
    """Stands between an executor and a performer, and tells listeners where in the plan the run is.

    Give it to :class:`tmd.robot.execute.Executor` as the performer, and :meth:`watch` as ``watch``.

    Args:
        performer: Does the instructions.
        orders: The plan.
        listeners: Who is told.
    """

    def __init__(self, performer: Performer, orders: Sequence[Order], listeners: Sequence[Listener]) -> None:
        self._performer = performer
        self._orders = tuple(orders)
        self._listeners = tuple(listeners)
        self._done = 0

    @property
    def clock(self) -> int:
        """The performer's."""
        return self._performer.clock

    def perform(self, instruction: Instruction, gains: Collection[GroundAtom], attempt: int) -> str:
        """Tell that it begins, and let it be done."""
        next_one = self._done < len(self._orders) and self._orders[self._done].instruction == instruction
        title = self._title(instruction, repair=not next_one)
        for listener in self._listeners:
            listener.begin(title, sorted(gains))
        return self._performer.perform(instruction, gains, attempt)

    def watch(self, step: Step) -> None:
        """Tell that a step is over."""
        title = self._title(step.instruction, repair=step.repair)
        # as the executor does: an instruction that did what it is for is not tried again
        if not step.repair and not step.failure and not any(m.expected for m in step.mismatches):
            self._done += 1
        for listener in self._listeners:
            listener.end(title, step)

    def _title(self, instruction: Instruction, *, repair: bool) -> Title:
        order = None if repair or self._done >= len(self._orders) else self._orders[self._done]
        number = min(self._done + 1, len(self._orders))
        return Title(instruction, number, len(self._orders), repair, order)
