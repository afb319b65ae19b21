"""PDDL 2.1: each action takes time, and the robot does one thing at a time.

Conditions hold at the start and effects come at the end. A token, the predicate ``robot_free``, is taken at the start
of an action and given back at its end: without it a temporal planner would let one robot do two things at once, and
the meaning of the actions, which follow each other, would be lost. Nothing changes while an action runs, so the
conditions of conditional effects are read at its end (VAL takes them so, and not at the start).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from decimal import Decimal

from tmd.pddl.model import (
    TRUE,
    ActionSchema,
    Domain,
    Effect,
    GroundAtom,
    Instruction,
    Not,
    Predicate,
    Problem,
    TypedName,
)
from tmd.pddl.writer import format_domain, format_formula, format_problem, in_lines

# Between the end of an instruction and the start of the next: the tolerance of VAL where none is given.
GAP = Decimal("0.01")


def starts(count: int) -> list[Decimal]:
    """Return the start times of ``count`` instructions."""
    return [number * (DURATION + GAP) for number in range(count)]


def format_temporal(plan: Sequence[Instruction], gap: str = " ") -> str:
    """Return a plan of PDDL 2.1: ``0.000: (grasp cup1) [1.000]``."""
    timed = zip(starts(len(plan)), plan, strict=True)
    return "".join(f"{start:.3f}: {instruction.pddl()}{gap}[{DURATION:.3f}]\n" for start, instruction in timed)


def format_popf(plan: Sequence[Instruction]) -> str:
    """Return a plan as the planner POPF prints it, which is what PlanSys2 reads: from ``Solution Found`` on."""
    makespan = len(plan) * DURATION + max(0, len(plan) - 1) * GAP
    return f";;;; Solution Found\n; Cost: {makespan:.3f}\n{format_temporal(plan, '  ')}"


# How long every action takes; PDDL says nothing of how long an instruction takes a robot.
DURATION = 1
_TOKEN = "robot_free"


def token(domain: Domain) -> str:
    """Return the name of the token, which no predicate of ``domain`` has."""
    name = _TOKEN
    while any(p.name == name for p in domain.predicates):
        name += "_"
    return name


def format_durative_domain(domain: Domain) -> str:
    """Return ``domain``, whose actions have no duration, as text of PDDL 2.1 with durative actions.

    Costs are left out: what is minimised is time.
    """
    name = token(domain)
    bare = replace(
        domain,
        requirements=(*(r for r in domain.requirements if r != ":action-costs"), ":durative-actions"),
        predicates=(*domain.predicates, Predicate(name)),
        functions=(),
        actions=(),
    )
    typed = bool(domain.types)
    actions = [_action(action, name, typed) for action in domain.actions]
    return "\n\n".join([format_domain(bare).removesuffix("\n)\n"), *actions]) + "\n)\n"


def format_durative_problem(problem: Problem) -> str:
    """Return ``problem`` as text for :func:`format_durative_domain`."""
    free = GroundAtom(token(problem.domain))
    bare = replace(problem.domain, functions=())
    written = replace(
        problem,
        domain=bare,
        init=problem.init | {free},
        requirements=tuple(r for r in problem.requirements if r != ":action-costs"),
        function_values={},
        minimize_cost=False,
    )
    return format_problem(written).removesuffix("\n)\n") + "\n\n  (:metric minimize (total-time))\n)\n"


def _action(action: ActionSchema, name: str, typed: bool) -> str:
    conditions = [f"(at start ({name}))"]
    if action.precondition != TRUE:
        conditions.append(f"(at start {format_formula(action.precondition, typed=typed)})")
    effects = [f"(at start (not ({name})))", f"(at end ({name}))"]
    effects += [_effect(effect, typed) for effect in action.effects]
    return "\n".join(
        [
            f"  (:durative-action {action.name}",
            f"    :parameters ({_parameters(action.parameters, typed)})",
            f"    :duration (= ?duration {DURATION})",
            f"    :condition {in_lines('and', conditions, 6)}",
            f"    :effect {in_lines('and', effects, 6)})",
        ]
    )


def _effect(effect: Effect, typed: bool) -> str:
    text = f"(at end {format_formula(effect.atom if effect.positive else Not(effect.atom))})"
    if effect.condition != TRUE:
        text = f"(when (at end {format_formula(effect.condition, typed=typed)}) {text})"
    if effect.parameters:
        text = f"(forall ({_parameters(effect.parameters, typed)}) {text})"
    return text


def _parameters(parameters: tuple[TypedName, ...], typed: bool) -> str:
    return " ".join(f"{p.name} - {p.types[0]}" if typed else p.name for p in parameters)
