"""``tmd run --json``, and the lines of ``tmd run --log``: a plan that a robot carried out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

from pydantic import Field

from tmd.diagnostics import Location, TmdError
from tmd.json_record import JsonRecord, TextOrNull, json_value
from tmd.pddl.model import Instruction
from tmd.records.grounding import GroundingRecord, InstructionRecord
from tmd.robot.sim.simulator import STEPS_PER_SECOND
from tmd.short_repr import short_repr

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tmd.robot.monitor.listeners import Order, Title
    from tmd.robot.monitor.observation import Mismatch
    from tmd.robot.skills.results import ExecutedStep, Execution

StepOutcome: TypeAlias = Literal["ok", "failed", "mismatch"]
Basis: TypeAlias = Literal["measured", "inferred", "assumed"]
SIGNS: dict[StepOutcome, str] = {"ok": "✓", "failed": "✗", "mismatch": "≠"}
MARKS: dict[Basis, str] = {"measured": "✓", "inferred": "∴", "assumed": "?"}


class OrderRecord(InstructionRecord):
    """An instruction of the plan; ``clause`` is what it serves, null where the plan comes from a file."""

    clause: int | None
    latent: bool

    @classmethod
    def of(cls, order: Order) -> OrderRecord:
        """Return the instruction as a record."""
        action, args = order.instruction
        return cls.copied(order, action=action, args=args)


class MismatchRecord(JsonRecord):
    """A fact that is not as predicted."""

    fact: str
    expected: bool
    measured: str

    @classmethod
    def of(cls, mismatch: Mismatch) -> MismatchRecord:
        """Return the mismatch as a record."""
        return cls.copied(mismatch, fact=str(mismatch.atom))

    def __str__(self) -> str:
        return f"{'' if self.expected else 'not '}{self.fact} was expected, but {self.measured}"


class EffectRecord(JsonRecord):
    """A fact that changed as predicted."""

    fact: str
    holds: bool = Field(description="Whether it came to hold; else it ended.")
    basis: Basis = Field(
        description="measured: a sensor of the simulation shows it; inferred: it follows from what was measured, by a "
        "rule; assumed: PDDL says so."
    )
    how: str = Field(description="The numbers, or the rule.")

    def __str__(self) -> str:
        return f"{'' if self.holds else 'not '}{self.fact}"


class RanStep(JsonRecord):
    """One instruction as it was carried out."""

    number: int = Field(description="Its place in the plan, from 1; of a repair, the place before which it was put.")
    action: str
    args: tuple[str, ...]
    repair: bool = Field(description="The monitor put it in.")
    outcome: StepOutcome
    failure: TextOrNull = Field(description="Why the skill failed.")
    evidence: TextOrNull = Field(description="What showed that its event happened.")
    effects: tuple[EffectRecord, ...] = Field(description="What changed as predicted.")
    mismatches: tuple[MismatchRecord, ...]
    begin: int = Field(description="Tick of the simulation.")
    end: int

    @classmethod
    def of(cls, title: Title, step: ExecutedStep) -> RanStep:
        """Return a step that is over."""
        action, args = step.instruction
        return cls.copied(
            step,
            number=title.number,
            action=action,
            args=args,
            repair=title.repair,
            outcome="failed" if step.failure else "mismatch" if step.mismatches else "ok",
            effects=tuple(EffectRecord.copied(e, fact=str(e.atom), basis=e.basis.value) for e in step.effects),
            mismatches=tuple(map(MismatchRecord.of, step.mismatches)),
        )

    @property
    def instruction(self) -> Instruction:
        """Instruction that was carried out."""
        return Instruction(self.action, self.args)

    @property
    def sign(self) -> str:
        """The sign of the outcome."""
        return SIGNS[self.outcome]

    @property
    def seen(self) -> str:
        """Observation in one line, without mismatches."""
        return self.failure or self.evidence or ""

    @property
    def told(self) -> str:
        """Reason of the failure, or the mismatches, or the observation."""
        return self.failure or "; ".join(map(str, self.mismatches)) or self.seen


class RunRequest(JsonRecord):
    """Request to a robot: a plan, and how to carry it out."""

    text: str | None
    domain: str
    environment: str
    mode: Literal["physics", "kinematic"]
    seed: int
    planner: str
    plan: tuple[OrderRecord, ...]
    version: str
    environment_file: str | None
    strip: str | None = Field(description="The name of the filmstrip's file.")
    grounding: GroundingRecord | None = Field(description="Of the text; null for a plan file or a goal.")
    goal: str | None = Field(default=None, description="What a plan was found for, where that was a PDDL condition.")


class RunRecord(RunRequest):
    """A whole run."""

    WHAT = "what tmd run --json prints"
    REMAKE = "make it again with tmd run --json"

    steps: tuple[RanStep, ...]
    lasting: tuple[MismatchRecord, ...] = Field(
        default=(), description="What is otherwise in the end than the plan would have left it."
    )
    status: Literal[
        "done", "recovered", "stopped", "not_grounded", "question", "unreachable", "gave_up", "invalid_plan"
    ]
    reason: str | None
    repairs: int
    seconds: float = Field(description="Simulated time.")

    @classmethod
    def of(cls, asked: RunRequest, steps: Sequence[RanStep], execution: Execution, ticks: int) -> RunRecord:
        """Return a run that is over. ``ticks`` are steps of the physics."""
        ended = how_it_ended(execution, ticks)
        return cls.model_validate({**asked.given(), "steps": tuple(steps), **ended})


@short_repr(lambda run: f"in {run.record.environment}: {run.execution}")
@dataclass(frozen=True, slots=True)
class RecordedRun:
    """Result of a run.

    Attributes:
        execution: How it ended: ``.status``, ``.reason``, and ``.steps`` with the state after each.
        record: The same as JSON has it: ``.to_value()``.
    """

    execution: Execution
    record: RunRecord


def how_it_ended(execution: Execution, ticks: int) -> dict[str, Any]:
    """Return the keys of a record, or of the last line of a log, for the end of a run of ``ticks`` steps of physics."""
    ended: dict[str, Any] = {
        "status": execution.status.value,
        "reason": execution.reason or None,
        "repairs": execution.repairs,
        "seconds": round(ticks / STEPS_PER_SECOND, 2),
    }
    if execution.lasting:
        ended["lasting"] = tuple(map(MismatchRecord.of, execution.lasting))
    return ended


class _Event(JsonRecord):
    """A line of a log; its kind stands first."""

    WHAT = "a line of a log of tmd run"
    REMAKE = "make the log again with tmd run --log"

    event: str


class PlanEvent(RunRequest, _Event):
    """The first line: what was to be done."""

    event: Literal["plan"]


class BeginEvent(_Event):
    """Beginning of an instruction."""

    event: Literal["begin"]
    number: int
    instruction: str


class StepEvent(RanStep, _Event):
    """An instruction is over."""

    event: Literal["step"]


class EndEvent(_Event):
    """The last line; where the run was interrupted, or ended by an error, without ``repairs`` and ``seconds``."""

    event: Literal["end"]
    status: Literal["done", "recovered", "stopped", "interrupted", "error"]
    reason: str | None
    repairs: int = 0
    seconds: float = 0.0
    lasting: tuple[MismatchRecord, ...] = ()


RunEvent: TypeAlias = PlanEvent | BeginEvent | StepEvent | EndEvent
_EVENTS: dict[str, type[RunEvent]] = {
    "plan": PlanEvent, "begin": BeginEvent, "step": StepEvent, "end": EndEvent,
}  # fmt: skip


def read_log(lines: Sequence[tuple[int, str]], file: str) -> tuple[PlanEvent, list[RunEvent]]:
    """Return the first line of a log, and those after it; the last one may be cut off where the run was killed.

    ``lines`` are those that are not blank, with their numbers.

    Raises:
        TmdError: A line is not one of a log, or the first is not the plan.
    """
    found = []
    for number, line in lines:
        try:
            value = json_value(line, file, number, _Event.REMAKE)
        except TmdError:
            if number == lines[-1][0]:
                break
            raise
        kind = value.get("event") if isinstance(value, dict) else None
        if not isinstance(kind, str) or kind not in _EVENTS:
            told = f"this is not {_Event.WHAT}: event: should be one of {', '.join(_EVENTS)}"
            raise TmdError(told, location=Location(file, number, 1), hint=_Event.REMAKE)
        found.append(_EVENTS[kind].from_value(value, file, number))
    if not found or not isinstance(found[0], PlanEvent):
        raise TmdError(f"{file} does not begin with a plan", hint="give a whole log of tmd run")
    return found[0], found[1:]
