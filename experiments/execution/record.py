"""What is kept of a run: one JSON line, written when the run ends."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, TypeAlias

from tmd.diagnostics import Location, TmdError
from tmd.robot.monitor.faults import Happening

Key: TypeAlias = tuple[str, str, str, int]

FILE = "runs.jsonl"
FAILED = "error"
"""The status of a run that ended by a fault of the program."""


@dataclass(frozen=True, slots=True)
class Case:
    """One run that is asked for.

    Attributes:
        name: Of the demonstration or plan.
        domain: The domain's name.
        task: Which task it serves.
        environment: Where.
        plan: The instructions, in functional notation.
        end_state: Literals that hold when all is done.
        physics: Under physics; otherwise kinematically.
        fault: Which kind of fault is injected; empty for none.
        seed: Random seed. With 0 things stand exactly where they should; other seeds move them a little.
        repairs: So often the plan may be mended.
        twice: Run it two times and compare the trajectories.
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

    @property
    def key(self) -> Key:
        """What makes it one run and not another."""
        return self.name, "physics" if self.physics else "kinematic", self.fault, self.seed


@dataclass(frozen=True, slots=True)
class Line:
    """One instruction as it went; see :class:`tmd.robot.skills.results.ExecutedStep`.

    Attributes:
        instruction: What was done.
        skill: Which skill did it.
        repair: Whether the monitor put it in.
        failure: Why it failed.
        mismatches: What was not as predicted.
        evidence: What showed its event.
        seconds: Of wall-clock time.
        ticks: Of the simulation.
        begin: The tick it began at.
    """

    instruction: str
    skill: str
    repair: bool
    failure: str
    mismatches: tuple[str, ...]
    evidence: str
    seconds: float
    ticks: int
    begin: int


@dataclass(frozen=True, slots=True)
class Record:
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
        repairs: How often the plan was mended.
        lines: The instructions.
        faults: The faults that came about.
        goal: The literals of the end state that do not hold in what is observed at the end.
        setup: Seconds until the robot could begin.
        seconds: Of wall-clock time from then on.
        simulated: Seconds of physics in that time.
        trajectory: The digest of the trajectory; empty where it was not asked for.
        repeated: Whether the second run had the same; ``None`` where it was not asked for.
    """

    name: str
    task: str
    environment: str
    mode: str
    fault: str
    seed: int
    status: str
    reason: str
    repairs: int
    lines: tuple[Line, ...]
    faults: tuple[Happening, ...]
    goal: tuple[str, ...]
    setup: float
    seconds: float
    simulated: float
    trajectory: str = ""
    repeated: bool | None = field(default=None)

    @property
    def key(self) -> Key:
        """That of its case."""
        return self.name, self.mode, self.fault, self.seed


def append(directory: Path, record: Record) -> None:
    """Add a record to the file of a directory; what an interruption cut off before it is ended first."""
    path = directory / FILE
    cut = path.exists() and path.stat().st_size > 0 and not path.read_bytes().endswith(b"\n")
    with path.open("a", encoding="utf-8") as file:
        file.write("\n" * cut + json.dumps(asdict(record), ensure_ascii=False) + "\n")


def read(directory: Path) -> list[Record]:
    """The records of a directory in their order; none where there is no file. A line that was cut off is left out.

    Raises:
        TmdError: A line is whole and no run.
    """
    path = directory / FILE
    if not path.exists():
        return []
    found = {}
    for number, text in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        try:
            record = _record(json.loads(text))
        except ValueError:
            continue
        except (KeyError, TypeError) as error:
            raise TmdError(
                "this line is not a run of this version",
                location=Location(str(path), number, 1),
                hint="move the file away to begin anew",
            ) from error
        found[record.key] = record
    return sorted(found.values(), key=lambda record: (record.task, record.environment, record.key))


def _record(data: dict[str, Any]) -> Record:
    data["lines"] = tuple(Line(**{**line, "mismatches": tuple(line["mismatches"])}) for line in data["lines"])
    data["faults"] = tuple(Happening(**happening) for happening in data["faults"])
    data["goal"] = tuple(data["goal"])
    return Record(**data)
