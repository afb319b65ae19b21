"""Plans as text: the plan files of the planning competitions, and the functional notation of instructions.

A plan file has one ``(name arg ...)`` a line; ``;`` begins a comment, and the last line tells the cost:
``; cost = 3 (unit cost)``. Plans with times, as VAL, POPF and PlanSys2 have them, are read as well. The functional
notation of an instruction is ``keep(mug1, counter1, on)``.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from decimal import Decimal
from itertools import pairwise
from pathlib import Path

from tmd.diagnostics import Location, TmdError
from tmd.pddl.model import Instruction
from tmd.pddl.reading.syntax import read_text, split_lines

_NAME = re.compile(r"[a-z0-9_][a-z0-9_-]*")
_COST = re.compile(r";\s*cost\s*=\s*([0-9]{1,15})\s*(?:\((?:unit|general) cost\))?\s*$", re.IGNORECASE)
_CALL = re.compile(r"([^(]*)\((.*)\)\s*", re.DOTALL)
_TIME = r"([0-9]+(?:\.[0-9]*)?|\.[0-9]+)"
_DURATION = rf"\[\s*(?:D:)?\s*{_TIME}(?:[;\s][^\]]*)?\]"
_STEP = re.compile(rf"(?:{_TIME}\s*:\s*)?\(([^()]*)\)(?:\s*{_DURATION})?", re.IGNORECASE)
# What stands before a comment; LPG has a ``;`` within the brackets of a duration.
_CODE = re.compile(r"[^;\[]*(?:\[[^\]]*\])?[^;]*")
# Times are printed with three decimals; what overlaps by less does not.
_TOLERANCE = Decimal("0.001")
_ANNOUNCED = re.compile(r"(?:;*\s*solution found.*|plan:)", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Plan:
    """A plan that was read: its instructions, the cost it claims, and where each instruction stands.

    ``overlap`` is where the first instruction stands that was to start before another one ended. Such a plan is taken
    as the sequence of its instructions by their starts; what else its times say is lost.
    """

    instructions: tuple[Instruction, ...] = ()
    cost: int | None = None
    locations: tuple[Location, ...] = field(default=(), compare=False, repr=False)
    overlap: Location | None = field(default=None, compare=False, repr=False)


def read_plan(path: str | Path) -> Plan:
    """Return the plan in the file at ``path``.

    Raises:
        TmdError: The file cannot be read, or a line of it is not an instruction.
    """
    return parse_plan(read_text(path), str(path))


def parse_plan(text: str, file: str = "<text>") -> Plan:
    """Return the plan that ``text`` lists; ``file`` names it in errors.

    Besides plan files of the planning competitions this takes plans with times: those that VAL reads
    (``0.000: (grasp mug1) [1.000]``), what the planner POPF prints (the last plan after ``Solution Found``), and what
    PlanSys2's terminal prints (``plan:``, then ``0: (grasp mug1) [1]``). Their instructions are put in the order of
    their times; where those overlap, :attr:`Plan.overlap` says so.

    Raises:
        TmdError: A line is not an instruction, or only some lines have a time.
    """
    lines = split_lines(text)
    first = _after_preamble(lines)
    steps: list[_Line] = []
    cost: int | None = None
    for number, line in enumerate(lines[first:], start=first + 1):
        claimed = _COST.match(line.strip())
        if claimed:
            cost = int(claimed[1])
        code = _CODE.match(line)[0]  # type: ignore[index]  # it matches the empty text
        if code.strip():
            place = Location(file, number, len(code) - len(code.lstrip()) + 1)
            steps.append(_parse_line(code.strip(), place, line))
    steps = _in_time(steps)
    return Plan(tuple(s.instruction for s in steps), cost, tuple(s.place for s in steps), _overlap(steps))


@dataclass(frozen=True, slots=True)
class _Line:
    """A line of a plan: its instruction, and when it starts and ends if that is said."""

    instruction: Instruction
    place: Location
    source: str
    start: Decimal | None = None
    end: Decimal | None = None


def _after_preamble(lines: Sequence[str]) -> int:
    """Return the start of the plan: behind the last line with which POPF or PlanSys2 announce one."""
    found = 0
    for number, line in enumerate(lines, start=1):
        if _ANNOUNCED.fullmatch(line.strip()):
            found = number
    return found


def _in_time(steps: list[_Line]) -> list[_Line]:
    """Return the lines in the order of their times; as they are where there are none."""
    timed = [step for step in steps if step.start is not None]
    if not timed:
        return steps
    if len(timed) < len(steps):
        stray = next(step for step in steps if step.start is None)
        raise TmdError(
            "this line has no time, and others have", location=stray.place, source=stray.source, hint="give all or none"
        )
    return sorted(timed, key=lambda step: step.start or Decimal(0))


def _overlap(steps: Sequence[_Line]) -> Location | None:
    """Return the place of the first instruction that starts before its predecessor ends."""
    for before, after in pairwise(steps):
        if before.end is not None and after.start is not None and after.start < before.end - _TOLERANCE:
            return after.place
    return None


def _parse_line(code: str, place: Location, source: str) -> _Line:
    """Read ``(name argument ...)``, or with times ``START: (name argument ...) [DURATION]``."""
    found = _STEP.fullmatch(code)
    if found is None:
        hint = f'found "{_shown(code)}"; with times, START: (name argument ...) [DURATION]'
        raise TmdError("a plan has one (name argument ...) a line", location=place, source=source, hint=hint)
    words = found[2].lower().split()
    if not words:
        raise TmdError("() is not an instruction", location=place, source=source, hint="write (name argument ...)")
    for word in words:
        if not _NAME.fullmatch(word):
            place = Location(place.file, place.line, place.column + code.lower().find(word))
            hint = "a name has letters, digits, _ and -, a letter first"
            raise TmdError(f'"{_shown(word)}" is not a name', location=place, source=source, hint=hint)
    start = Decimal(found[1]) if found[1] else None
    end = start + Decimal(found[3]) if start is not None and found[3] else None
    return _Line(Instruction(words[0], tuple(words[1:])), place, source, start, end)


def format_plan(instructions: Iterable[Instruction], cost: int | None = None, *, unit: bool = True) -> str:
    """Return the text of a plan file.

    Args:
        instructions: The plan.
        cost: Its cost; the number of instructions where ``None``.
        unit: Whether each instruction costs 1, as the last line says.
    """
    lines = [instruction.pddl() for instruction in instructions]
    total = len(lines) if cost is None else cost
    lines.append(f"; cost = {total} ({'unit' if unit else 'general'} cost)")
    return "\n".join(lines) + "\n"


def parse_instruction(text: str) -> Instruction:
    """Return the instruction written as ``keep(mug1, counter1, on)``; ``str`` of it gives the text back.

    Raises:
        TmdError: It is not an instruction.
    """
    hint = "write name(argument, ...)"
    call = _CALL.fullmatch(text)
    if call is None:
        raise TmdError(f'"{_shown(text.strip())}" is not an instruction', hint=hint)
    arguments = call[2].split(",") if call[2].strip() else []
    words = [word.strip().lower() for word in (call[1], *arguments)]
    for word in words:
        if not _NAME.fullmatch(word):
            raise TmdError(f'"{_shown(word)}" is not a name' if word else "a name is missing", hint=hint)
    return Instruction(words[0], tuple(words[1:]))


def _shown(text: str) -> str:
    line = "".join(c if c.isprintable() else " " for c in text)
    return line if len(line) <= 40 else f"{line[:37]}..."
