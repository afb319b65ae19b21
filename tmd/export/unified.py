"""Problems and plans as objects of unified-planning and back.

unified-planning is imported when it is first needed, which takes about a third of a second.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from importlib.util import find_spec
from typing import Any, TypeAlias

from tmd.diagnostics import MissingToolError, TmdError
from tmd.pddl.derived import without_derived
from tmd.pddl.model import Instruction, Problem
from tmd.pddl.normalise import portable
from tmd.pddl.reading.checking import check_problem, used_requirements
from tmd.pddl.reading.reader import parse_domain, parse_problem
from tmd.pddl.writer import format_domain, format_problem

# A ``unified_planning.model.Problem``; the package ships no types.
UpProblem: TypeAlias = Any
# A plan of unified-planning.
UpPlan: TypeAlias = Any
_NAME = re.compile(r"[a-z][a-z0-9_-]*")
# What a ``unified_planning.model.Problem`` may have and a classical problem does not, by the name of its attribute.
_UNSUPPORTED = ("durative_actions", "timed_effects", "timed_goals", "trajectory_constraints", "processes", "events")
# Minimising this metric needs no costs: without them every instruction costs 1.
_LENGTH = "MinimizeSequentialPlanLength"
_METRICS = ("MinimizeActionCosts", _LENGTH)


def to_unified_planning(problem: Problem) -> UpProblem:
    """Return ``problem`` as a ``unified_planning.model.Problem``, made by unified-planning's own reader.

    Names stay as they are. The name of the domain is lost: unified-planning has no place for it.

    Raises:
        MissingToolError: unified-planning is not installed.
        TmdError: The problem cannot be written in the form that other tools read.
    """
    if find_spec("unified_planning") is None:
        raise MissingToolError("the package unified-planning is not installed", hint="pip install unified-planning")
    from unified_planning.io import PDDLReader

    plain = portable(without_derived(_without_idle_costs(problem)))
    with warnings.catch_warnings(), _shared_names():
        warnings.simplefilter("ignore")
        return PDDLReader().parse_problem_string(format_domain(plain.domain), format_problem(plain))


@contextmanager
def _shared_names() -> Iterator[None]:
    """Let an action and a predicate, or a type and an object, have one name, as PDDL does."""
    from unified_planning.environment import get_environment

    environment = get_environment()  # the reader mixes other ones with this one
    before = environment.error_used_name
    environment.error_used_name = False
    try:
        yield
    finally:
        environment.error_used_name = before


def _without_idle_costs(problem: Problem) -> Problem:
    """Return ``problem`` without costs that nothing minimises: unified-planning would take them for numeric fluents."""
    if problem.minimize_cost or not problem.domain.functions:
        return problem
    actions = tuple(replace(action, cost=None) for action in problem.domain.actions)
    return replace(problem, domain=replace(problem.domain, functions=(), actions=actions), function_values={})


def from_unified_planning(problem: UpProblem, *, domain: str | None = None) -> Problem:
    """Return a ``unified_planning.model.Problem`` as one of ours, by way of the text of PDDL.

    Names are taken over in lower case. Objects that an action names become constants. It is classical: fluents are true
    or false, effects may be conditional and universal, and ``MinimizeActionCosts`` may be minimised. The domain, whose
    name unified-planning does not know, is called as the problem by default.

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
    if any(type(metric).__name__ == _LENGTH for metric in problem.quality_metrics):
        found = _without_idle_costs(replace(found, minimize_cost=False))
    found = replace(found, name=named, domain=replace(found.domain, name=_named(domain or named)))
    requirements = used_requirements(found.domain, found)
    complete = replace(found, domain=replace(found.domain, requirements=requirements))
    for fault in check_problem(complete):
        raise fault
    return complete


def _writer(problem: UpProblem) -> Any:  # noqa: ANN401 - theirs
    """Return a writer that leaves names as they are: in PDDL an action and a predicate may have the same name."""
    from unified_planning.io import PDDLWriter
    from unified_planning.model import Parameter, Variable

    class Writer(PDDLWriter):  # type: ignore[misc]  # of a package without types
        def _get_mangled_name(self, item: Any) -> str:  # noqa: ANN401 - theirs
            name = _named(item.name)
            return f"?{name}" if isinstance(item, Parameter | Variable) else name

    return Writer(problem)


def _refuse_the_unsupported(problem: UpProblem) -> None:
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


def plan_to_unified_planning(plan: Iterable[Instruction], problem: UpProblem) -> UpPlan:
    """Return a plan as a ``SequentialPlan`` for ``problem``.

    ``problem`` is what :func:`to_unified_planning` returned.

    Raises:
        TmdError: An instruction names what ``problem`` does not have.
    """
    from unified_planning.exceptions import UPValueError
    from unified_planning.plans import ActionInstance, SequentialPlan

    expressions = problem.environment.expression_manager
    steps = []
    for instruction in plan:
        try:
            objects = [expressions.ObjectExp(problem.object(name)) for name in instruction.args]
            steps.append(ActionInstance(problem.action(instruction.name), objects))
        except (UPValueError, AssertionError) as error:
            raise TmdError(f"{instruction} cannot be said in this problem: {error}") from error
    return SequentialPlan(steps, problem.environment)


def plan_from_unified_planning(plan: UpPlan) -> tuple[Instruction, ...]:
    """Return the instructions of a plan of unified-planning: of a sequential one, or of one with times, by their start.

    Raises:
        TmdError: It is a plan of another kind.
    """
    from unified_planning.plans import SequentialPlan, TimeTriggeredPlan

    if isinstance(plan, SequentialPlan):
        actions = plan.actions
    elif isinstance(plan, TimeTriggeredPlan):
        actions = [action for _, action, _ in sorted(plan.timed_actions, key=lambda timed: timed[0])]
    else:
        raise TmdError(f"a {type(plan).__name__} is not a sequence of instructions", hint="give a SequentialPlan")
    return tuple(
        Instruction(a.action.name.lower(), tuple(str(argument).lower() for argument in a.actual_parameters))
        for a in actions
    )
