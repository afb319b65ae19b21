"""A problem of unified-planning as one of ours: the way back from :mod:`tmd.export.to_unified`."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any, TypeAlias

from tmd.diagnostics import TmdError
from tmd.pddl.model import Problem
from tmd.pddl.reading.checking import check_problem
from tmd.pddl.reading.reader import parse_domain, parse_problem
from tmd.pddl.reading.requirements import used_requirements

# Something of unified-planning, which ships no types.
_Outside: TypeAlias = Any
_NAME = re.compile(r"[a-z][a-z0-9_-]*")
# What a ``unified_planning.model.Problem`` may have and a classical problem does not, by the name of its attribute.
_UNSUPPORTED = ("durative_actions", "timed_effects", "timed_goals", "trajectory_constraints", "processes", "events")
_METRICS = ("MinimizeActionCosts", "MinimizeSequentialPlanLength")


def from_unified_planning(problem: _Outside, *, domain: str | None = None) -> Problem:
    """Return a ``unified_planning.model.Problem`` as one of ours, by way of the text of PDDL.

    Names are taken over in lower case. Objects that an action names become constants.

    Args:
        problem: A classical problem: fluents are true or false, effects may be conditional and universal, and
            ``MinimizeActionCosts`` may be minimised.
        domain: The name of the domain, which unified-planning does not know; the problem's own name by default.

    Raises:
        TmdError: The problem has what we do not support, or a name that PDDL does not allow; places are those of its
            text.
    """
    from unified_planning.exceptions import UPException

    _refuse_the_unsupported(problem)
    named = _named(problem.name or "problem")
    try:
        writer = _writer(problem)
        domain_text, problem_text = writer.get_domain(), writer.get_problem()
    except (UPException, AssertionError) as error:
        raise TmdError(f"the problem '{named}' cannot be written as PDDL: {error}") from error
    read = parse_domain(domain_text, f"the domain of {named}")
    found = parse_problem(problem_text, read, f"the problem {named}")
    found = replace(found, name=named, domain=replace(found.domain, name=_named(domain or named)))
    requirements = used_requirements(found.domain, found)
    complete = replace(found, domain=replace(found.domain, requirements=requirements))
    for fault in check_problem(complete):
        raise fault
    return complete


def _writer(problem: _Outside) -> _Outside:
    """Return a writer that leaves names as they are: in PDDL an action and a predicate may have the same name."""
    from unified_planning.io import PDDLWriter
    from unified_planning.model import Parameter, Variable

    class Writer(PDDLWriter):  # type: ignore[misc]  # of a package without types
        def _get_mangled_name(self, item: _Outside) -> str:
            name = _named(item.name)
            return f"?{name}" if isinstance(item, Parameter | Variable) else name

    return Writer(problem)


def _refuse_the_unsupported(problem: _Outside) -> None:
    for name in _UNSUPPORTED:
        if list(getattr(problem, name)):
            raise TmdError(f"the problem '{problem.name}' has {name.replace('_', ' ')}, which are not supported")
    kinds = [type(metric).__name__ for metric in problem.quality_metrics]
    if len(kinds) > 1 or not set(kinds) <= set(_METRICS):
        raise TmdError(f"the metric {', '.join(kinds)} is not supported", hint="use MinimizeActionCosts")


def _named(name: str) -> str:
    plain = name.lower()
    if not _NAME.fullmatch(plain):
        raise TmdError(f"'{name}' is not a name in PDDL", hint="names have letters, digits, _ and -, a letter first")
    return plain
