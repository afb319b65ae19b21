"""The goal of a demonstration: a condition within a line of a corpus, whose faults have their place in that line."""

from __future__ import annotations

import json
import re
from dataclasses import replace

from tmd.diagnostics import Location, TmdError
from tmd.pddl.model import Formula, Problem, State
from tmd.pddl.reading.goal import with_goal
from tmd.pddl.reading.syntax import read_text, split_lines
from tmd.pddl.semantics import first_false
from tmd.veil.demonstration import Demonstration

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
        hint = "mend the goal, or the instructions if it is what the text asks for"
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
