"""Checking demonstrations: form, environments, whether they can be executed, and whether their goals are reached."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from tmd.diagnostics import Location, TmdError
from tmd.pddl.model import Problem, State
from tmd.pddl.reading.syntax import Report, nearest, read_text, split_lines
from tmd.veil.corpus import replay
from tmd.veil.demonstration import Demonstration, check_goal, read_demonstration


def check_demonstrations(path: Path, world: Callable[[str], Problem | None], known: list[str], report: Report) -> None:
    """Every demonstration of a file: read, and played in its environment.

    Args:
        path: JSON Lines.
        world: The environment of a name; ``None`` where it has faults of its own.
        known: The names of all environments.
        report: Takes the faults.

    Raises:
        TmdError: The file cannot be read.
    """
    seen: dict[str, int] = {}
    for number, line in enumerate(split_lines(read_text(path)), start=1):
        if not line.strip():
            continue
        try:
            demonstration = read_demonstration(path, number, line)
            if demonstration.id in seen:
                message = f"the id '{demonstration.id}' stands in this file twice"
                hint = f"it is that of line {seen[demonstration.id]} as well"
                raise TmdError(message, location=demonstration.location, hint=hint, code="duplicate-name")
            seen[demonstration.id] = number
            _play(demonstration, line, world, known)
        except TmdError as error:
            report(error)


def _play(demonstration: Demonstration, line: str, world: Callable[[str], Problem | None], known: list[str]) -> None:
    if demonstration.environment not in known:
        message = f"there is no environment '{demonstration.environment}'"
        hint = nearest(demonstration.environment, known, what="environments")
        raise TmdError(message, location=_place(demonstration, line), hint=hint, code="unknown-environment")
    problem = world(demonstration.environment)
    if problem is None:
        return
    last = _states(demonstration, problem)[-1]
    check_goal(demonstration, problem, last)


def _states(demonstration: Demonstration, problem: Problem) -> list[State]:
    """What happens, whatever the goal is; the plan that was corrected is played as well."""
    what = f"'{demonstration.id}'"
    try:
        states = replay(replace(demonstration, goal=None), problem)
        if demonstration.proposed is not None:
            what = f"the plan that '{demonstration.id}' corrects"
            replay(_as_proposed(demonstration), problem)
    except TmdError as error:
        message = f"{what} cannot be executed in {demonstration.environment}: {error.message}"
        hint = "mend the demonstration, or the domain or environment if they are what changed"
        raise TmdError(message, location=demonstration.location, hint=hint, code="not-executable") from None
    return states


def _as_proposed(demonstration: Demonstration) -> Demonstration:
    """What would have been done without the correction; how it ends is not stated, and it need not reach the goal."""
    segments = tuple(replace(segment, instructions=segment.proposed or ()) for segment in demonstration.segments)
    return replace(demonstration, segments=segments, end_state=(), goal=None)


def _place(demonstration: Demonstration, line: str) -> Location | None:
    """Where the environment's name stands."""
    place = demonstration.location
    column = line.find(json.dumps(demonstration.environment))
    return Location(place.file, place.line, column + 1) if place and column >= 0 else place
