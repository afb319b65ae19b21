"""The report of a run: lines for people, one JSON value, and a log that grows."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Literal, Self

from tmd.cli.output import emit
from tmd.cli.plans import Orders
from tmd.diagnostics import OutputError
from tmd.files import writing
from tmd.json_record import JsonRecord
from tmd.pddl.model import GroundAtom
from tmd.records.run import (
    BeginEvent,
    EndEvent,
    PlanEvent,
    RunRecord,
    RunRequest,
    StepEvent,
    how_it_ended,
)
from tmd.robot.monitor.listeners import Order, Title
from tmd.robot.session import SimulationSession
from tmd.robot.sim.simulator import STEPS_PER_SECOND
from tmd.robot.skills.results import Basis, ExecutedStep, Execution, SkillStatus
from tmd.robot_trials.plan_runner import StepRecorder

_FACTS = 2
"""Maximum number of facts of each kind on a line."""


class RunReport(StepRecorder):
    """The report of a run as it goes: a line for each instruction, or one JSON value in the end; and the log.

    With ``as_json`` it prints JSON, and nothing before the end.

    Attributes:
        heading: What is done, where and how, in a few words.
    """

    def __init__(self, asked: RunRequest, orders: Sequence[Order], journal: RunLog | None, *, as_json: bool) -> None:
        super().__init__()
        self._asked = asked
        self._journal = journal
        self._as_json = as_json
        self._width = max((len(str(order.instruction)) for order in orders), default=0)
        self._origin = max((len(_origin(order)) for order in orders), default=0)
        how = "under physics" if asked.mode == "physics" else "without physics"
        self.heading = f"{_count(len(orders), 'instruction')} in {asked.environment}, {how}"

    def prepare(self, session: SimulationSession) -> tuple[Self]:
        """Report the plan when its simulation is ready; see :data:`tmd.robot.run_plan.Prepare`."""
        self._print(f"plan: {self.heading}\n")
        self._log(PlanEvent(event="plan", **self._asked.given()))
        return (self,)

    def begin(self, title: Title, expected: Sequence[GroundAtom]) -> None:
        """Log the beginning of an instruction, which the log of a killed run ends with."""
        self._log(BeginEvent(event="begin", number=title.number, instruction=str(title.instruction)))

    def end(self, title: Title, step: ExecutedStep) -> None:
        """Print and log an instruction that is over."""
        super().end(title, step)
        self._log(StepEvent(event="step", **self.steps[-1].given()))
        origin = "repair" if title.order is None else _origin(title.order)
        number = "+" if title.repair else str(title.number)
        self._print(f"  {number:>3}. {step.instruction!s:<{self._width}}  {origin:<{self._origin}}  {_found(step)}\n")

    def log_ending(self, execution: Execution, steps: int) -> None:
        """Log the outcome after ``steps`` steps of physics, as the last line."""
        self._log(EndEvent(event="end", **how_it_ended(execution, steps)))

    def print_ending(self, execution: Execution, steps: int) -> None:
        """Print the outcome, or the whole record, when all files are written."""
        if self._as_json:
            record = RunRecord.of(self._asked, self.steps, execution, steps)
            emit(record.to_value())
        else:
            emit(_ending(execution, steps))
            for left in execution.lasting:
                emit(f"  left otherwise than planned: {left}\n")

    def _print(self, text: str) -> None:
        if not self._as_json:
            emit(text)

    def _log(self, entry: JsonRecord) -> None:
        if self._journal is not None:
            self._journal.write(entry)


def without_plan(asked: RunRequest, orders: Orders) -> dict[str, object]:
    """Return the record of a run that has no plan."""
    ended = {"status": orders.code.name.lower(), "reason": orders.remarks[-1].strip()}
    nothing = {"steps": (), "repairs": 0, "seconds": 0.0}
    return RunRecord.model_validate({**asked.given(), **nothing, **ended}).to_value()


def _found(step: ExecutedStep) -> str:
    """Return the observations in one line; all of them are in the JSON record."""
    if step.failure:
        return f"failed: {step.failure}"
    if step.mismatches:
        first = min(step.mismatches, key=lambda m: not m.expected)
        return f"not as predicted: {_first([str(first), *step.mismatches[1:]], 1)}"
    told = [f"ok: {step.evidence}"]
    for basis in Basis:
        facts = [effect for effect in step.effects if effect.basis is basis]
        facts.sort(key=lambda effect: not effect.holds)
        if facts:
            told.append(f"{basis} {_first(facts, _FACTS)}")
    return "; ".join(told)


def _first(things: Sequence[object], most: int) -> str:
    """Return the first of some things, and how many more there are."""
    more = f" and {len(things) - most} more" if len(things) > most else ""
    return " ".join(str(thing) for thing in things[:most]) + more


def _origin(order: Order) -> str:
    if order.clause is None:
        return ""
    return f"clause {order.clause + 1}{', latent' if order.latent else ''}"


def _ending(execution: Execution, steps: int) -> str:
    how = f"after {_count(execution.repairs, 'repair')}" if execution.repairs else "but not all went as predicted"
    known = _known_by(execution)
    of = " on what the plan names" if any(step.mismatches for step in execution.steps) else ""
    told = {
        SkillStatus.DONE: f"every effect{of} is as predicted{known}" if execution.steps else "there was nothing to do",
        SkillStatus.RECOVERED: f"everything that the plan is for holds, {how}{known}",
        SkillStatus.STOPPED: execution.reason,
    }[execution.status]
    count = _count(len(execution.steps), "instruction")
    return f"{execution.status}: {told}; {count}, {steps / STEPS_PER_SECOND:.1f} s simulated\n"


def _known_by(execution: Execution) -> str:
    """Return the numbers of measured, inferred and assumed effects, and the assumed ones."""
    effects = [effect for step in execution.steps for effect in step.effects]
    counts = [(basis, sum(effect.basis is basis for effect in effects)) for basis in Basis]
    told = ", ".join(f"{count} {basis}" for basis, count in counts if count)
    assumed = list(dict.fromkeys(str(e) for e in effects if e.basis is Basis.ASSUMED))
    return f" ({told}{': ' if assumed else ''}{_first(assumed, _FACTS + 1)})" if told else ""


def _count(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"


class RunLog:
    """A JSON Lines file: the plan, then each step when it is over, then how the run ended.

    Every line is written at once, so that the log of a run that was killed can be read.

    Raises:
        OutputError: It cannot be written.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._ended = False
        with writing(self._path):
            self._file = path.open("w", encoding="utf-8", buffering=1)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            if kind is not None and not self._ended and not isinstance(error, OutputError):
                interrupted = issubclass(kind, KeyboardInterrupt)
                status: Literal["interrupted", "error"] = "interrupted" if interrupted else "error"
                self.write(EndEvent(event="end", status=status, reason=str(error) or None))
        finally:
            with suppress(OSError):  # what was not written was told by then
                self._file.close()

    def write(self, entry: JsonRecord) -> None:
        """Write one line.

        Raises:
            OutputError: It cannot be written.
        """
        with writing(self._path):
            self._file.write(entry.to_line())
        self._ended = isinstance(entry, EndEvent)
