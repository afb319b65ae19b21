"""Execution of a plan by a robot, as the page shows it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from tmd.records.run import EndEvent, RanStep, RunEvent, RunRecord, StepEvent

UNFINISHED = "unfinished"


@dataclass(frozen=True, slots=True)
class Ran:
    """A run.

    Attributes:
        status: How it ended: ``done``, ``recovered``, ``stopped`` …; ``unfinished`` where nothing says so.
        reason: Why it stopped.
        repairs: How often the executor replanned.
        seconds: Simulated time.
        steps: What was done, in order.
    """

    status: str
    reason: str = ""
    repairs: int = 0
    seconds: float = 0.0
    steps: tuple[RanStep, ...] = ()

    def of(self, number: int, last: int) -> list[tuple[int, RanStep]]:
        """Return the steps that belong to place ``number`` of a plan of ``last``, each with its place in the run."""
        return [(i, s) for i, s in enumerate(self.steps) if min(max(s.number, 1), last) == number]


def ran(record: RunRecord) -> Ran:
    """Return a whole run."""
    return Ran(record.status, record.reason or "", record.repairs, record.seconds, record.steps)


def ran_events(events: Iterable[RunEvent]) -> Ran:
    """Return the lines of a log; that of a run that was killed has no end."""
    told = list(events)
    steps = tuple(event for event in told if isinstance(event, StepEvent))
    end = next((event for event in reversed(told) if isinstance(event, EndEvent)), None)
    if end is None:
        return Ran(UNFINISHED, steps=steps)
    return Ran(end.status, end.reason or "", end.repairs, end.seconds, steps)
