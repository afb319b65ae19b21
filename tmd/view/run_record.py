"""What a robot made of a plan: the record that ``tmd run`` prints as JSON, or writes as a log."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from pydantic import BaseModel, ConfigDict

from tmd.pddl.model import Instruction

OUTCOMES = {"ok": "✓", "failed": "✗", "mismatch": "≠"}
UNFINISHED = "unfinished"


class _Record(BaseModel):
    """Part of a file. What a later version adds is passed over."""

    model_config = ConfigDict(frozen=True, extra="ignore")


class MismatchRecord(_Record):
    """A fact that is not as predicted."""

    fact: str
    expected: bool
    measured: str


class RanStep(_Record):
    """One instruction as it was carried out.

    Attributes:
        number: Its place in the plan, from 1; of a repair, the place before which it was put.
        action: The instruction's name.
        args: Its arguments.
        repair: Whether the monitor put it in.
        outcome: ``ok``, ``failed`` or ``mismatch``.
        failure: Why it failed.
        evidence: What showed that it happened.
        confirmed: The facts that were seen.
        mismatches: The facts that are not as predicted.
    """

    number: int
    action: str
    args: tuple[str, ...] = ()
    repair: bool = False
    outcome: str
    failure: str | None = None
    evidence: str | None = None
    confirmed: tuple[str, ...] = ()
    mismatches: tuple[MismatchRecord, ...] = ()

    @property
    def instruction(self) -> Instruction:
        """What was done."""
        return Instruction(self.action, self.args)

    @property
    def sign(self) -> str:
        """The sign of the outcome."""
        return OUTCOMES.get(self.outcome, "?")

    @property
    def seen(self) -> str:
        """What was seen, in one line."""
        return self.failure or self.evidence or ""


@dataclass(frozen=True, slots=True)
class Ran:
    """A run.

    Attributes:
        status: How it ended: ``done``, ``recovered``, ``stopped`` …; ``unfinished`` where nothing says so.
        reason: Why it stopped.
        repairs: How often the plan was mended.
        seconds: Simulated time.
        steps: What was done, in order.
        faults: What was made to go wrong.
    """

    status: str
    reason: str = ""
    repairs: int = 0
    seconds: float = 0.0
    steps: tuple[RanStep, ...] = ()
    faults: tuple[str, ...] = ()

    def of(self, number: int, last: int) -> list[tuple[int, RanStep]]:
        """The steps that belong to place ``number`` of a plan of ``last``, each with its place in the run."""
        return [(i, s) for i, s in enumerate(self.steps) if min(max(s.number, 1), last) == number]


class _Ending(_Record):
    status: str = UNFINISHED
    reason: str | None = None
    repairs: int = 0
    seconds: float = 0.0


class _Fault(_Record):
    what: str


class _Whole(_Ending):
    steps: tuple[RanStep, ...] = ()
    faults: tuple[_Fault, ...] = ()


def ran(value: Mapping[str, Any]) -> Ran:
    """The record that ``tmd run --json`` printed.

    Raises:
        pydantic.ValidationError: It is none.
    """
    whole = _Whole.model_validate(value)
    faults = tuple(fault.what for fault in whole.faults)
    return Ran(whole.status, whole.reason or "", whole.repairs, whole.seconds, whole.steps, faults)


def ran_events(events: Sequence[Mapping[str, Any]]) -> Ran:
    """The lines of a log of ``tmd run``; that of a run that was killed has no end.

    Raises:
        pydantic.ValidationError: A line is wrong.
    """
    end: Mapping[str, Any] = next((event for event in reversed(events) if event.get("event") == "end"), {})
    steps = [event for event in events if event.get("event") == "step"]
    return ran({**end, "steps": steps, "faults": [event for event in events if event.get("event") == "fault"]})
