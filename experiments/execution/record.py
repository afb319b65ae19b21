"""What is kept of a run: one JSON line, written when the run ends."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from tmd.diagnostics import TmdError
from tmd.json_record import JsonRecord, json_value
from tmd.records.run import RanStep

Key: TypeAlias = tuple[str, str, str, int]

FILE = "runs.jsonl"
FAILED = "error"
"""The status of a run that ended by a fault of the program."""


class FaultRecord(JsonRecord):
    """A fault that came about, and its tick of the simulation."""

    what: str
    tick: int


@dataclass(frozen=True, slots=True)
class Case:
    """One run that is asked for.

    Attributes:
        name: Of the demonstration or plan.
        domain: The domain's name.
        task: Which task it serves.
        environment: Where: the name of a bundled environment, or a file.
        plan: The instructions, in functional notation; none where there is a goal.
        end_state: Literals that hold when all is done.
        physics: Under physics; otherwise kinematically.
        fault: Which kind of fault is injected; empty for none.
        seed: Random seed. With 0 things stand exactly where they should; other seeds move them a little.
        repairs: Maximum number of times the executor replans.
        twice: Run it two times and compare the trajectories.
        goal: A PDDL condition that a plan is made for.
    """

    name: str
    domain: str
    task: str
    environment: str
    plan: tuple[str, ...]
    end_state: tuple[str, ...]
    physics: bool
    fault: str
    seed: int
    repairs: int
    twice: bool
    goal: str = ""

    @property
    def key(self) -> Key:
        """What makes it one run and not another."""
        return self.name, "physics" if self.physics else "kinematic", self.fault, self.seed


class TimedStep(RanStep):
    """One instruction as it went, with the skill that did it and the seconds of wall-clock time that it took."""

    skill: str
    took: float


class Record(JsonRecord):
    """One run, as it went.

    Attributes:
        name: Of the demonstration or plan.
        task: Its task.
        environment: Where.
        mode: ``kinematic`` or ``physics``.
        fault: The kind of fault that was asked for.
        seed: Random seed.
        status: ``done``, ``recovered``, ``stopped``, or ``error``.
        reason: Why it did not get to the end.
        repairs: How often the executor replanned.
        steps: The instructions.
        faults: The faults that came about.
        fault_missing: Why the fault that was asked for did not come about; empty where it did.
        lasting: What is otherwise in the end than the plan would have left it.
        goal: The literals of the end state that do not hold in what is observed at the end.
        setup: Seconds until the robot could begin.
        seconds: Of wall-clock time from then on.
        cpu: Of processor time from then on, with the recorder's.
        simulated: Seconds of physics in that time.
        trajectory: The digest of the trajectory; empty where it was not asked for.
        known: The number of effects that are measured, inferred and assumed.
        judged: The number of claims that the judge found to be true.
        unjudged: The number of those that it cannot tell about.
        false: The claims that are not true, with the reasons.
        worst: The farthest jump, the deepest contact, the farthest overrun of a joint.
        repeated: Whether the second run had the same; ``None`` where it was not asked for.
    """

    WHAT = "a run of this version"
    REMAKE = "move the file away to begin again"

    name: str
    task: str
    environment: str
    mode: str
    fault: str
    seed: int
    status: str
    reason: str
    repairs: int
    steps: tuple[TimedStep, ...]
    faults: tuple[FaultRecord, ...]
    fault_missing: str
    lasting: tuple[str, ...]
    goal: tuple[str, ...]
    setup: float
    seconds: float
    cpu: float
    simulated: float
    trajectory: str
    known: dict[str, int]
    judged: int
    unjudged: int
    false: tuple[str, ...]
    worst: tuple[str, ...]
    repeated: bool | None

    @property
    def key(self) -> Key:
        """That of its case."""
        return self.name, self.mode, self.fault, self.seed


def append(directory: Path, record: Record) -> None:
    """Add a record to the file of a directory; what an interruption cut off before it is ended first."""
    path = directory / FILE
    cut = path.exists() and path.stat().st_size > 0 and not path.read_bytes().endswith(b"\n")
    with path.open("a", encoding="utf-8") as file:
        file.write("\n" * cut + record.to_line())


def read(directory: Path) -> list[Record]:
    """The records of a directory in their order; none where there is no file. A line that was cut off is left out.

    Raises:
        TmdError: A line is whole and no run.
    """
    path = directory / FILE
    if not path.exists():
        return []
    found = {}
    for number, text in enumerate(path.read_text(encoding="utf-8").split("\n"), start=1):
        try:
            value = json_value(text, str(path), number)
        except TmdError:
            continue
        record = Record.from_value(value, str(path), number)
        found[record.key] = record
    return sorted(found.values(), key=lambda record: (record.task, record.environment, record.key))
