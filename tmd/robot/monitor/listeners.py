"""Events of a run: the purpose of each instruction, its beginning, and its result."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Protocol

from tmd.pddl.model import GroundAtom, Instruction
from tmd.robot.skills.results import ExecutedStep


@dataclass(frozen=True, slots=True)
class Order:
    """One instruction of a plan, and its purpose.

    Attributes:
        clause: The clause that it serves, from 0; ``None`` if the plan comes from a file.
        latent: Whether the request leaves it unsaid.
        text: The words of the request.
    """

    instruction: Instruction
    clause: int | None = None
    latent: bool = False
    text: str = ""


@dataclass(frozen=True, slots=True)
class Title:
    """An instruction that is being done.

    Attributes:
        number: Its place in the plan, from 1; of a repair, the place before which it was put.
        of: The length of the plan.
        repair: Whether the monitor put it in.
        order: Its purpose; ``None`` for a repair.
    """

    instruction: Instruction
    number: int
    of: int
    repair: bool
    order: Order | None


class Listener(Protocol):
    """Receiver of the events of a run."""

    def begin(self, title: Title, expected: Sequence[GroundAtom]) -> None:
        """Receive the beginning of an instruction, and the facts that it should bring about, sorted."""
        ...

    def end(self, title: Title, step: ExecutedStep) -> None:
        """Receive its result."""
        ...


class Recorder:
    """Tells listeners where in the plan a run is.

    Its methods are the callbacks ``begin`` and ``watch`` of :class:`tmd.robot.monitor.executor.Executor`.

    Args:
        orders: The plan.
        listeners: Receivers of all events, in this order.
    """

    def __init__(self, orders: Sequence[Order], listeners: Sequence[Listener]) -> None:
        self._orders = tuple(orders)
        self._listeners = tuple(listeners)
        self._next = 0
        self._open = False

    def begin(self, instruction: Instruction, gains: Collection[GroundAtom]) -> None:
        """Announce an instruction that should bring about ``gains``."""
        title = self._title(instruction, self._place(instruction))
        for listener in self._listeners:
            listener.begin(title, sorted(gains))

    def end(self, step: ExecutedStep) -> None:
        """Report a finished step."""
        place = None if step.repair else self._place(step.instruction)
        title = self._title(step.instruction, place)
        if place is not None:
            done = not step.failure and not step.mismatches
            self._next = place + 1 if done else place
            self._open = not done and not step.failure
        for listener in self._listeners:
            listener.end(title, step)

    def _place(self, instruction: Instruction) -> int | None:
        """Return the place in the plan; ``None`` for a repair.

        After a step whose facts are not as predicted, the executor may try it again or go on.
        """
        possible = range(self._next, min(self._next + 1 + self._open, len(self._orders)))
        return next((place for place in possible if self._orders[place].instruction == instruction), None)

    def _title(self, instruction: Instruction, place: int | None) -> Title:
        count = len(self._orders)
        if place is None:
            return Title(instruction, min(self._next + 1, count), count, True, None)
        return Title(instruction, place + 1, count, False, self._orders[place])
