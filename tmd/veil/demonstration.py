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

These two may be left out, and three keys may be there besides. ``who`` and ``when`` are texts. ``proposed`` stands
where somebody corrected a plan: it lists the instructions of that plan, and each segment has those of its own as
``proposed``.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

from tmd.diagnostics import Location, TmdError
from tmd.pddl.model import Formula, Instruction, Problem, State
from tmd.pddl.plan_file import parse_instruction
from tmd.pddl.reading.reader import with_goal
from tmd.pddl.reading.syntax import read_text, split_lines
from tmd.pddl.semantics import first_false

_KEYS = ("id", "task", "environment", "text", "segments")
_ENDS = "\x85\u2028\u2029"


@dataclass(frozen=True, slots=True)
class Segment:
    """A piece ``text[start:end]`` of a demonstration's text, and the instructions that serve it.

    ``proposed`` are those that a plan had for it which was corrected; ``None`` where there was none.
    """

    start: int
    end: int
    instructions: tuple[Instruction, ...]
    proposed: tuple[Instruction, ...] | None = None


@dataclass(frozen=True, slots=True)
class Demonstration:
    """One demonstration, as described in the module's docstring; ``location`` is where it was read."""

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

    @property
    def instructions(self) -> tuple[Instruction, ...]:
        """The whole sequence, segment after segment."""
        return tuple(instruction for segment in self.segments for instruction in segment.instructions)


def demonstration_line(demonstration: Demonstration) -> str:
    """The line of a corpus that :func:`read_demonstration` reads ``demonstration`` from, without its end."""
    text = demonstration.text
    data: dict[str, object] = {key: getattr(demonstration, key) for key in _KEYS[:4]}
    data["segments"] = [
        {"text": text[s.start : s.end], "instructions": list(map(str, s.instructions)), **_proposed(s.proposed)}
        for s in demonstration.segments
    ]
    data["end_state"] = list(demonstration.end_state)
    data |= _proposed(demonstration.proposed)
    data |= {key: value for key in ("goal", "who", "when") if (value := getattr(demonstration, key)) is not None}
    line = json.dumps(data, ensure_ascii=False)
    # other programs may take these for ends of lines
    return "".join(f"\\u{ord(c):04x}" if c in _ENDS else c for c in line)


def _proposed(instructions: tuple[Instruction, ...] | None) -> dict[str, list[str]]:
    return {} if instructions is None else {"proposed": list(map(str, instructions))}


def read_demonstrations(path: Path) -> list[Demonstration]:
    """Read a corpus.

    Raises:
        TmdError: A line is not a demonstration; with file, line and column.
    """
    found: list[Demonstration] = []
    seen: set[str] = set()
    for number, line in enumerate(split_lines(read_text(path)), start=1):
        if not line.strip():
            continue
        reader = _Line(path, number)
        demonstration = reader.read(line)
        if demonstration.id in seen:
            raise reader.error(f"the id '{demonstration.id}' stands in this file twice")
        seen.add(demonstration.id)
        found.append(demonstration)
    return found


def read_demonstration(path: Path, number: int, line: str) -> Demonstration:
    """The demonstration in line ``number`` of a corpus.

    Raises:
        TmdError: The line is not a demonstration; with its place.
    """
    return _Line(path, number).read(line)


@dataclass(frozen=True, slots=True)
class _Line:
    """Reads one line; knows where it is."""

    path: Path
    number: int

    def error(
        self, message: str, hint: str | None = None, column: int = 1, code: str = "bad-demonstration"
    ) -> TmdError:
        return TmdError(message, location=Location(str(self.path), self.number, column), hint=hint, code=code)

    def read(self, line: str) -> Demonstration:
        try:
            data = json.loads(line)
        except json.JSONDecodeError as error:
            raise self.error(f"not JSON: {error.msg}", column=error.colno, code="json-syntax") from None
        except RecursionError:
            raise self.error("not a demonstration: nested too deeply", code="nested-too-deeply") from None
        except ValueError:  # Python reads no number of more than 4,300 digits
            raise self.error("not a demonstration: a number has too many digits", code="json-syntax") from None
        if not isinstance(data, dict):
            raise self.error("a demonstration is a JSON object")
        for key in _KEYS:
            if key not in data:
                raise self.error(f"the key '{key}' is missing", f"a demonstration has {', '.join(_KEYS)}")
        for key in _KEYS[:4]:
            if not isinstance(data[key], str):
                raise self.error(f"'{key}' is not a string")
        end_state = data.get("end_state", [])
        if not isinstance(end_state, list) or not all(isinstance(item, str) for item in end_state):
            raise self.error("'end_state' is not a list of strings")
        segments = tuple(self._segments(data["text"], data["segments"]))
        return Demonstration(
            data["id"],
            data["task"],
            data["environment"],
            data["text"],
            segments,
            tuple(end_state),
            self._corrected(data, segments),
            self._said(data, "who"),
            self._said(data, "when"),
            self._said(data, "goal"),
            Location(str(self.path), self.number, 1),
        )

    def _said(self, data: dict[str, object], key: str) -> str | None:
        value = data.get(key)
        if value is not None and not isinstance(value, str):
            raise self.error(f"'{key}' is not a string")
        return value

    def _corrected(self, data: dict[str, object], segments: tuple[Segment, ...]) -> tuple[Instruction, ...] | None:
        """The plan that was corrected; its segments must be that plan as well."""
        parts = [segment.proposed for segment in segments]
        if "proposed" not in data:
            if any(part is not None for part in parts):
                raise self.error("a segment has 'proposed', and the demonstration has not", "give the whole plan")
            return None
        whole = tuple(self._instructions("the demonstration", data["proposed"], "proposed"))
        if any(part is None for part in parts) or whole != tuple(i for part in parts for i in part or ()):
            raise self.error(
                "'proposed' is not what its segments have one after the other",
                "each segment has the part of the plan that was to serve it",
            )
        return whole

    def _segments(self, text: str, segments: object) -> Iterator[Segment]:
        if not isinstance(segments, list):
            raise self.error("'segments' is not a list")
        after = 0
        for index, segment in enumerate(segments):
            where = f"segment {index + 1}"
            if not isinstance(segment, dict) or not isinstance(segment.get("text"), str):
                raise self.error(f"{where} has no 'text'")
            start = text.find(segment["text"], after)
            if start < 0:
                raise self.error(
                    f"{where}: '{segment['text']}' does not stand in the text after the segment before it",
                    "segments are pieces of the text, letter by letter and in its order",
                )
            after = start + len(segment["text"])
            instructions = tuple(self._instructions(where, segment.get("instructions")))
            proposed = None
            if "proposed" in segment:
                proposed = tuple(self._instructions(where, segment["proposed"], "proposed"))
            yield Segment(start, after, instructions, proposed)

    def _instructions(self, where: str, lines: object, key: str = "instructions") -> Iterator[Instruction]:
        if not isinstance(lines, list) or not all(isinstance(line, str) for line in lines):
            raise self.error(f"{where}: '{key}' is not a list of strings")
        for line in lines:
            try:
                yield parse_instruction(line)
            except TmdError as error:
                raise self.error(f"{where}: '{line}': {error.message}", error.hint) from None


NOT_REACHED = "goal-not-reached"
"""The kind of fault of a goal that does not hold when all instructions are done."""
_TEXT = "goal"
_KEY = re.compile(r'"goal"\s*:\s*(?=")')
_HIGH, _LOW = r"\\u[dD][89abAB][\da-fA-F]{2}", r"\\u[dD][c-fC-F][\da-fA-F]{2}"
_CHARACTER = re.compile(rf"{_HIGH}{_LOW}|\\u[\da-fA-F]{{4}}|\\.|.", re.DOTALL)
_END_OF_LINE = re.compile(r"\r\n|\r|\n")


def read_goal(demonstration: Demonstration, problem: Problem) -> Formula | None:
    """What the demonstration's goal says; ``None`` where it has none.

    Args:
        demonstration: The demonstration.
        problem: Its environment.

    Raises:
        TmdError: It is not a condition, or speaks of what the environment does not have; with file, line and column.
    """
    if demonstration.goal is None:
        return None
    try:
        # the goal alone is looked at: to check every fact of the environment again takes long
        return with_goal(replace(problem, init=frozenset()), demonstration.goal, _TEXT).goal
    except TmdError as fault:
        raise _placed(demonstration, fault, f"the goal of '{demonstration.id}': {fault.message}") from None


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
        fault = TmdError(message, location=Location(_TEXT, 1, 1), hint=hint, code=NOT_REACHED)
        raise _placed(demonstration, fault, message)


def _placed(demonstration: Demonstration, fault: TmdError, message: str) -> TmdError:
    """The fault with its place in the file of the demonstration instead of that in the goal's own text."""
    place, line = demonstration.location, _line(demonstration.location)
    if place is not None and line is not None and fault.location is not None:
        place = replace(place, column=_column(line, demonstration.goal or "", fault.location))
    return TmdError(message, location=place, hint=fault.hint, source=line, code=fault.code)


def _line(place: Location | None) -> str | None:
    """The line of the corpus at ``place``; ``None`` where it is there no more."""
    if place is None:
        return None
    try:
        return split_lines(read_text(place.file))[place.line - 1]
    except (TmdError, IndexError):
        return None


def _column(line: str, goal: str, place: Location) -> int:
    """The column in ``line`` of a place in the goal that is written in it as a JSON string."""
    starts = [0, *(match.end() for match in _END_OF_LINE.finditer(goal))]
    offset = starts[place.line - 1] + place.column - 1
    for key in reversed(list(_KEY.finditer(line))):
        value, end = json.JSONDecoder().raw_decode(line, key.end())
        if value == goal:
            columns = [match.start() + 1 for match in _CHARACTER.finditer(line, key.end() + 1, end - 1)]
            return [*columns, end][min(offset, len(columns))]
    return 1
