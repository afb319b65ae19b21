"""The reference planner: Fast Downward through unified-planning, optimal.

Its word is final: the gaps of a plan that leaves the system are filled by it or checked against it. It runs in
processes of its own (see :mod:`tmd.planning.up_worker`); one call takes about half a second, nearly all of it for
starting processes and translating. An impossible goal can keep it busy for ever, hence the limit in seconds.
"""

from __future__ import annotations

from importlib.util import find_spec

from tmd.diagnostics import MissingToolError
from tmd.pddl.model import And, Domain, Exists, Forall, Formula, Imply, Not, Or
from tmd.pddl.task import Task
from tmd.planning.unified import EngineSpec, UnifiedPlanner

OPTIMAL = "astar(hmax())"
"""Optimal for every domain that Fast Downward translates without axioms, and the fastest such configuration."""

FIRST = (
    "let(hff,ff(),let(hlm,landmark_sum(lm_reasonable_orders_hps(lm_rhw())),eager_greedy([hff,hlm],preferred=[hff])))"
)
"""Fast, and content with any plan.

FF alone does not see that a full hand takes nothing more: of a goal that clears a table of four things it evaluates two
million states in vain, with landmarks beside it 1,700. On the bundled problems the plans are as long.
"""

OPTIMAL_WITH_AXIOMS = "astar(blind())"
"""Universal preconditions become axioms, under which hmax may overestimate."""


def fast_downward(task: Task, *, time_limit: float = 60.0) -> UnifiedPlanner:
    """Fast Downward for ``task``.

    Args:
        task: The ground problem.
        time_limit: Seconds for one call.

    Raises:
        MissingToolError: It is not installed.
    """
    _installed()
    return UnifiedPlanner(task, spec(task.problem.domain, time_limit))


def first_plan(task: Task, *, time_limit: float = 10.0) -> UnifiedPlanner:
    """Fast Downward for ``task``, content with the first plan it finds; arguments and errors as above."""
    _installed()
    search = {"fast_downward_search_config": FIRST}
    return UnifiedPlanner(task, EngineSpec("fast-downward", search, time_limit, skip_checks=True, any_plan=True))


def _installed() -> None:
    if find_spec("up_fast_downward") is None:
        raise MissingToolError("Fast Downward is not installed", hint="pip install up-fast-downward")


def spec(domain: Domain, time_limit: float = 60.0) -> EngineSpec:
    """How Fast Downward is called for ``domain``."""
    universal = any(
        has_universal(action.precondition, True)
        or any(has_universal(effect.condition, True) for effect in action.effects)
        for action in domain.actions
    )
    search = OPTIMAL_WITH_AXIOMS if universal else OPTIMAL
    return EngineSpec("fast-downward", {"fast_downward_search_config": search}, time_limit, skip_checks=True)


def has_universal(formula: Formula, positive: bool) -> bool:
    """Whether a universal quantifier remains once negations are pushed inwards."""
    match formula:
        case Not(part):
            return has_universal(part, not positive)
        case And(parts) | Or(parts):
            return any(has_universal(part, positive) for part in parts)
        case Imply(left, right):
            return has_universal(left, not positive) or has_universal(right, positive)
        case Forall(_, part):
            return positive or has_universal(part, positive)
        case Exists(_, part):
            return not positive or has_universal(part, positive)
        case _:
            return False
