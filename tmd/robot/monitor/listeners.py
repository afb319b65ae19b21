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

    The ``listeners`` receive all events, in this order.
    """

    def __init__(self, orders: Sequence[Order], listeners: Sequence[Listener]) -> None:
        self._orders = tuple(orders)
        self._listeners = tuple(listeners)
        self._title: Title

    def begin(self, instruction: Instruction, gains: Collection[GroundAtom], place: int, repair: bool) -> None:
        """Announce an instruction that should bring about ``gains``; see :data:`tmd.robot.monitor.executor.Begin`."""
        count = len(self._orders)
        order = None if repair else self._orders[place]
        self._title = Title(instruction, min(place + 1, count), count, repair, order)
        for listener in self._listeners:
            listener.begin(self._title, sorted(gains))

    def end(self, step: ExecutedStep) -> None:
        """Report a finished step."""
        for listener in self._listeners:
            listener.end(self._title, step)
