"""Demonstrations: a text, an environment, and the instructions a person gave for each piece of the text.

A corpus is JSON Lines, one demonstration a line::

    {"id": "ramen-kitchen1-01", "task": "ramen", "environment": "kitchen1",
     "text": "Fill the pot and boil it. …",
     "segments": [{"text": "Fill the pot", "instructions": ["find(pot1)", "moveto(pot1)", …]}, …],
     "end_state": ["(contains pot1 cooked_ramen)", …],
     "goal": "(exists (?v - pot) (contains ?v cooked_ramen))"}

Segments are pieces of the text, in order and without overlap; each carries the instructions that serve it.
``end_state`` lists literals (``(not (…))`` as well) that hold when all instructions are done. ``goal`` is a closed PDDL
condition: what the text asks for, written from the text alone, with ``exists`` for what it leaves open.

These two may be left out, and three keys may be added. ``who`` and ``when`` are texts. ``proposed`` stands
where somebody corrected a plan: it lists the instructions of that plan.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from pydantic import BaseModel, ValidationError

from tmd.diagnostics import Location, TmdError
from tmd.json_record import expectation, json_value
from tmd.pddl.model import Formula, Instruction, Problem, State
from tmd.pddl.plan_file import parse_instruction
from tmd.pddl.reading.reader import with_goal
from tmd.pddl.reading.syntax import Report, read_text, split_lines
from tmd.pddl.semantics import first_false

_KEYS = ("id", "task", "environment", "text", "segments")
_LINE = f"a demonstration is a JSON object on one line, with {', '.join(_KEYS)}; text in quotes, lists in [ ]"
_SEGMENT = 'write [{"text": "Take the cup", "instructions": ["grasp(cup1)"]}, …]'
_ENDS = "\x85\u2028\u2029"


@dataclass(frozen=True, slots=True)
class Segment:
    """A piece ``text[start:end]`` of a demonstration's text, and the instructions that serve it."""

    start: int
    end: int
    instructions: tuple[Instruction, ...]


@dataclass(frozen=True, slots=True)
class Demonstration:
    """One demonstration, as described in the module's docstring; ``source`` is its line, ``location`` where that is."""

    id: str
    task: str
    environment: str
    text: str
    segments: tuple[Segment, ...]
    end_state: tuple[str, ...] = ()
    proposed: tuple[Instruction, ...] | None = None
    who: str | None = None
    when: str | None = None
    goal: str | None = None
    location: Location | None = field(default=None, compare=False, repr=False)
    source: str = field(default="", compare=False, repr=False)

    @property
    def instructions(self) -> tuple[Instruction, ...]:
        """The whole sequence, segment after segment."""
        return tuple(instruction for segment in self.segments for instruction in segment.instructions)


def demonstration_line(demonstration: Demonstration) -> str:
    """Return the line of a corpus that :func:`read_demonstration` reads ``demonstration`` from, without its end."""
    text = demonstration.text
    data: dict[str, object] = {key: getattr(demonstration, key) for key in _KEYS[:4]}
    data["segments"] = [
        {"text": text[s.start : s.end], "instructions": list(map(str, s.instructions))} for s in demonstration.segments
    ]
    data["end_state"] = list(demonstration.end_state)
    if demonstration.proposed is not None:
        data["proposed"] = list(map(str, demonstration.proposed))
    data |= {key: value for key in ("goal", "who", "when") if (value := getattr(demonstration, key)) is not None}
    line = json.dumps(data, ensure_ascii=False)
    # other programs may take these for ends of lines
    return "".join(f"\\u{ord(c):04x}" if c in _ENDS else c for c in line)


def read_demonstrations(path: Path, report: Report | None = None) -> list[Demonstration]:
    """Read a corpus; ``report`` takes the faults of its lines.

    Raises:
        TmdError: The file cannot be read; or, without ``report``, a line is not a demonstration.
    """
    found: dict[str, Demonstration] = {}
    for number, line in enumerate(split_lines(read_text(path)), start=1):
        try:
            if line.strip():
                demonstration = read_demonstration(path, number, line)
                first = found.setdefault(demonstration.id, demonstration)
                if first is not demonstration:
                    place = in_line(demonstration.location, line, ['"id"'])
                    hint = f"it is that of line {first.location.line if first.location else 0} as well"
                    message = f"the id '{demonstration.id}' stands in this file twice"
                    raise TmdError(message, location=place, hint=hint, source=line, code="duplicate-name")
        except TmdError as error:
            if report is None:
                raise
            report(error)
    return list(found.values())


def read_demonstration(path: Path, number: int, line: str) -> Demonstration:
    """Return the demonstration in line ``number`` of a corpus.

    Raises:
        TmdError: The line is not a demonstration; with its place.
    """
    return _Line(path, number, line).read()


class _Segment(BaseModel):
    """A segment as the file has it."""

    text: str
    instructions: list[str]


class _Entry(BaseModel):
    """A demonstration as the file has it; other keys are ignored."""

    id: str
    task: str
    environment: str
    text: str
    segments: list[_Segment]
    end_state: list[str] = []
    proposed: list[str] | None = None
    who: str | None = None
    when: str | None = None
    goal: str | None = None


@dataclass(frozen=True, slots=True)
class _Line:
    """One line of a corpus, with its place."""

    path: Path
    number: int
    line: str

    def error(self, message: str, hint: str | None = None, *words: str) -> TmdError:
        """Return a fault of the last of ``words``."""
        place = in_line(Location(str(self.path), self.number, 1), self.line, words)
        return TmdError(message, location=place, hint=hint, source=self.line, code="bad-demonstration")

    def read(self) -> Demonstration:
        value = json_value(self.line, str(self.path), self.number, _LINE)
        try:
            entry = _Entry.model_validate(value)
        except ValidationError as error:
            fault = error.errors(include_url=False, include_input=False)[0]
            key = ".".join(map(str, fault["loc"]))
            said = f"{f'{key}: ' if key else ''}{expectation(fault, 'a JSON object')}"
            hint = _SEGMENT if key.startswith("segments") else _LINE
            words = (f'"{part}"' for part in fault["loc"] if isinstance(part, str))
            raise self.error(f"this is not a demonstration: {said}", hint, *words) from None
        return Demonstration(
            entry.id,
            entry.task,
            entry.environment,
            entry.text,
            tuple(self._segments(entry)),
            tuple(entry.end_state),
            None if entry.proposed is None else self._instructions(entry.proposed),
            entry.who,
            entry.when,
            entry.goal,
            Location(str(self.path), self.number, 1),
            self.line,
        )

    def _segments(self, entry: _Entry) -> Iterator[Segment]:
        end = 0
        for index, segment in enumerate(entry.segments):
            start = entry.text.find(segment.text, end)
            if start < 0:
                raise self.error(
                    f"segment {index + 1}: '{segment.text}' does not stand in the text after the segment before it",
                    "segments are pieces of the text, letter by letter and in its order",
                    '"segments"',
                    json.dumps(segment.text, ensure_ascii=False),
                )
            end = start + len(segment.text)
            yield Segment(start, end, self._instructions(segment.instructions))

    def _instructions(self, lines: Sequence[str]) -> tuple[Instruction, ...]:
        found = []
        for line in lines:
            try:
                found.append(parse_instruction(line))
            except TmdError as error:
                raise self.error(f"'{line}': {error.message}", error.hint, line) from None
        return tuple(found)


def step_fault(demonstration: Demonstration, number: int, fault: TmdError) -> TmdError:
    """Return the fault of step ``number`` (the first is 1), with its segment, and its place in the file.

    ``number`` counts over all segments. The place is that of the first name that ``fault`` quotes, where the step has
    it.
    """
    owners = [segment for segment in demonstration.segments for _ in segment.instructions]
    at, segment = demonstration.segments.index(owners[number - 1]) + 1, owners[number - 1]
    step = str(demonstration.instructions[number - 1])
    what = fault.message.removesuffix(f" in {step}").replace(f" in {step} ", " ")
    quoted = re.search(r'"([^"]+)"', what)
    text = json.dumps(demonstration.text[segment.start : segment.end], ensure_ascii=False)
    words = (text, '"instructions"', step, *(quoted.groups() if quoted and quoted[1] in step else ()))
    place = in_line(demonstration.location, demonstration.source, words)
    return not_executable(demonstration, f"segment {at}, step {number}, {step}: {what}", place, fault.hint)


def not_executable(
    demonstration: Demonstration, why: str, place: Location | None = None, hint: str | None = None
) -> TmdError:
    """Return the fault of a demonstration that does not work in its environment."""
    return TmdError(
        f"'{demonstration.id}' cannot be executed in {demonstration.environment}: {why}",
        location=place or demonstration.location,
        hint=hint or "fix the demonstration, or the domain or environment if they are what changed",
        source=demonstration.source or None,
        code="not-executable",
    )


# The kind of fault of a goal that does not hold when all instructions are done.
NOT_REACHED = "goal-not-reached"


def read_goal(demonstration: Demonstration, problem: Problem) -> Formula | None:
    """Read the goal of a demonstration; ``None`` where it has none.

    Raises:
        TmdError: It is not a condition, or speaks of what the environment does not have; with file, line and column.
    """
    if demonstration.goal is None:
        return None
    try:
        # the goal alone is looked at: to check every fact of the environment again takes long
        return with_goal(replace(problem, init=frozenset()), demonstration.goal, "goal").goal
    except TmdError as fault:
        raise _goal_fault(demonstration, fault, f"the goal of '{demonstration.id}': {fault.message}") from None


def check_goal(demonstration: Demonstration, problem: Problem, state: State) -> None:
    """Make sure that the goal, if there is one, holds in ``state``, the last one.

    Raises:
        TmdError: It does not, or as :func:`read_goal`.
    """
    goal = read_goal(demonstration, problem)
    missing = None if goal is None else first_false(goal, state, problem)
    if missing is not None:
        message = f"the goal of '{demonstration.id}' is not reached: {missing.text} does not hold at the end"
        hint = "fix the goal, or the instructions if it is what the text asks for"
        fault = TmdError(message, location=Location("goal", 1, 1), hint=hint, code=NOT_REACHED)
        raise _goal_fault(demonstration, fault, message)


def _goal_fault(demonstration: Demonstration, fault: TmdError, message: str) -> TmdError:
    """Return the fault with its place in the file of the demonstration instead of that in the goal's own text."""
    place, line, goal = demonstration.location, demonstration.source, demonstration.goal or ""
    if place is not None and fault.location is not None:
        starts = [0, *(end.end() for end in re.finditer(r"\r\n|\r|\n", goal))]
        before = goal[: starts[fault.location.line - 1] + fault.location.column - 1]
        start = line.rfind('"goal":') + len('"goal":')
        for escaped in (False, True):
            written = json.dumps(before, ensure_ascii=escaped)[:-1]
            found = line.find(written, start)
            if found >= 0:
                place = replace(place, column=found + len(written) + 1)
                break
    return TmdError(message, location=place, hint=fault.hint, source=line or None, code=fault.code)


def in_line(place: Location | None, line: str, words: Sequence[str]) -> Location | None:
    """Return the place of the last of ``words`` in ``line``, each looked for behind the one before."""
    column = 0
    for word in words:
        column = max(column, line.find(word, column))
    return place and replace(place, column=column + 1)
