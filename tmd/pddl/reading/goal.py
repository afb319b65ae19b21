"""A goal written by itself, on the command line or in a program."""

from __future__ import annotations

from dataclasses import replace

from tmd.diagnostics import Location
from tmd.pddl.model import Formula, Problem
from tmd.pddl.reading.checking import check_problem
from tmd.pddl.reading.formulas import read_condition
from tmd.pddl.reading.parentheses import parse
from tmd.pddl.reading.requirements import undeclared_requirements
from tmd.pddl.reading.syntax import Source

PLACE = "--goal"
"""What a goal is called in errors where nothing else is said."""


def with_goal(problem: Problem, text: str, file: str = PLACE) -> Problem:
    """``problem`` with the goal that ``text`` states, such as ``(contains mug1 coffee)``; ``file`` names it in errors.

    A goal may use ``exists``, ``forall`` and the like whatever the domain's ``:requirements`` say: what the domain does
    not declare, the problem does.

    Raises:
        TmdError: It is not a condition, or speaks of what the problem does not have.
    """
    document = parse(text, file)
    source = document.source
    document.check_depth()
    if len(document.groups) != 1:
        place = Location(file, 1, 1)
        raise source.error("a goal is one condition", place, "write (and (…) (…)) for several")
    return aimed_at(problem, read_condition(document.groups[0], source), source)


def aimed_at(problem: Problem, goal: Formula, source: Source | None = None) -> Problem:
    """``problem`` with a goal, and with the requirements that this goal needs.

    Raises:
        TmdError: The goal speaks of what the problem does not have.
    """
    aimed = replace(problem, goal=goal)
    aimed = replace(aimed, requirements=(*aimed.requirements, *undeclared_requirements(aimed)))
    for fault in check_problem(aimed, source):
        if source is not None:
            fault.source = source.line(fault.location)
        raise fault
    return aimed
