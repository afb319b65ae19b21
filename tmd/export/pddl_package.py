"""Problems as objects of the package ``pddl`` (AI-Planning/pddl), and back: both ways by way of the text of PDDL."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, TypeAlias

from tmd.diagnostics import TmdError
from tmd.pddl.derived import without_derived
from tmd.pddl.model import TRUE, ActionSchema, Problem
from tmd.pddl.normalise import portable
from tmd.pddl.reading.reader import parse_domain, parse_problem
from tmd.pddl.writer import format_domain, format_problem

# A ``pddl.core.Problem``; the package ships no types.
PddlProblem: TypeAlias = Any


def to_pddl(problem: Problem) -> PddlProblem:
    """Return ``problem`` as a ``pddl.core.Problem`` whose ``domain`` is set, made by that package's own reader.

    Names stay as they are, and so does the meaning; ``either`` becomes a separate type.

    Raises:
        TmdError: The problem cannot be written in the form that other tools read, or the package refuses it.
    """
    from lark.exceptions import LarkError
    from pddl.core import Problem as Theirs
    from pddl.exceptions import PDDLError
    from pddl.parser.domain import DomainParser
    from pddl.parser.problem import ProblemParser

    plain = portable(without_derived(problem))
    if len(plain.domain.functions) > 1:  # costs that are looked up: for that package :action-costs is not enough
        requirements = (*plain.domain.requirements, ":numeric-fluents")
        plain = replace(plain, domain=replace(plain.domain, requirements=requirements))
    # its reader of problems knows no requirements, so it refuses goals with quantifiers, "or" and "=": the goal is read
    # as what an action needs
    aim = replace(plain.domain, constants=plain.all_objects(), actions=(ActionSchema("aim", (), plain.goal, ()),))
    try:
        found = ProblemParser()(format_problem(replace(plain, goal=TRUE)))
        # to make a reader takes longer than to read; what it keeps of the domain is in the next one as well
        read = DomainParser()
        domain = read(format_domain(plain.domain))
        (action,) = read(format_domain(aim)).actions
        return Theirs(found.name, domain, None, None, found.objects, found.init, action.precondition, found.metric)
    except (LarkError, PDDLError, ValueError) as error:
        raise TmdError(
            f"the package pddl cannot take the problem '{problem.name}': {' '.join(str(error).split())}"
        ) from error


def from_pddl(problem: PddlProblem) -> Problem:
    """Return a ``pddl.core.Problem`` as one of ours.

    It must know its domain: typed ADL with action costs.

    Raises:
        TmdError: It has no domain, or has what we do not support; places are those of its text.
    """
    from pddl.formatter import domain_to_string, problem_to_string

    try:
        domain = problem.domain
    except AssertionError as error:
        raise TmdError(
            f"the problem '{problem.name}' has no domain", hint="set problem.domain to its pddl.core.Domain"
        ) from error
    read = parse_domain(domain_to_string(domain), f"the domain {domain.name}")
    return parse_problem(problem_to_string(problem), read, f"the problem {problem.name}")
