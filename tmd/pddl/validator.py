"""Validation of plans; the first reason of failure is a step, its instruction and a literal."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum

from tmd.diagnostics import TmdError
from tmd.pddl import semantics
from tmd.pddl.model import Instruction, Problem, State
from tmd.pddl.semantics import Broken


class Status(StrEnum):
    """The outcome of validation."""

    VALID = "valid"
    BAD_INSTRUCTION = "bad-instruction"
    """An unknown action or object, or arguments of the wrong number or type."""
    BROKEN_PRECONDITION = "broken-precondition"
    GOAL_NOT_REACHED = "goal-not-reached"


@dataclass(frozen=True, slots=True)
class Verdict:
    """The result of validation.

    Attributes:
        valid: Whether every instruction applies in turn and the goal holds at the end.
        step: The number of the instruction that fails, from 1; ``None`` where none does.
        broken: The first ground part of the precondition or goal that does not hold.
        reason: One line for people; empty for a valid plan.
        trace: The states before, between and after the instructions that were executed, if asked for.
    """

    valid: bool
    status: Status
    step: int | None = None
    instruction: Instruction | None = None
    broken: Broken | None = None
    reason: str = ""
    trace: tuple[State, ...] = ()
    cost: int = 0


def validate(problem: Problem, plan: Iterable[Instruction], *, trace: bool = False) -> Verdict:
    """Execute ``plan`` from the problem's initial state and look for the goal.

    With ``trace`` the verdict holds the states that were passed.

    Raises:
        TmdError: The problem gives no value for an instruction's cost.
    """
    state = problem.init
    states = [state]
    total = 0
    for step, instruction in enumerate(plan, start=1):
        seen = tuple(states) if trace else ()
        try:
            broken = semantics.first_broken(instruction, state, problem)
        except TmdError as error:
            reason = f"step {step}, {instruction}: {error}"
            return Verdict(False, Status.BAD_INSTRUCTION, step, instruction, None, reason, seen, total)
        if broken:
            reason = f"step {step}, {instruction}: its precondition {broken.text} does not hold"
            status = Status.BROKEN_PRECONDITION
            return Verdict(False, status, step, instruction, broken, reason, seen, total)
        total += semantics.cost(instruction, problem)
        state = semantics.apply(instruction, state, problem)
        if trace:
            states.append(state)
    seen = tuple(states) if trace else ()
    missing = semantics.first_false(problem.goal, state, problem)
    if missing:
        reason = f"at the end the goal {missing.text} does not hold"
        return Verdict(False, Status.GOAL_NOT_REACHED, None, None, missing, reason, seen, total)
    return Verdict(True, Status.VALID, trace=seen, cost=total)
