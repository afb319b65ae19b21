"""A goal written by itself, on the command line or in a program."""

from __future__ import annotations

from dataclasses import replace

from tmd.errors import Location
from tmd.pddl.check import check_problem
from tmd.pddl.model import Problem
from tmd.pddl.parentheses import parse
from tmd.pddl.read_formula import read_condition

PLACE = "--goal"
"""What a goal is called in errors where nothing else is said."""


def with_goal(problem: Problem, text: str, file: str = PLACE) -> Problem:
    """``problem`` with the goal that ``text`` states, such as ``(contains mug1 coffee)``; ``file`` names it in errors.

    Raises:
        TmdError: It is no condition, or speaks of what the problem does not have.
    """
    document = parse(text, file)
    source = document.source
    if len(document.groups) != 1:
        place = Location(file, 1, 1)
        raise source.error("a goal is one condition", place, "write (and (…) (…)) for several")
    aimed = replace(problem, goal=read_condition(document.groups[0], source))
    for fault in check_problem(aimed, source):
        fault.source = source.line(fault.location)
        raise fault
    return aimed
