"""The last word on a plan: each gap in it is asked of the reference planner again.

Inference trusts the in-process search. What leaves the system can be held against Fast Downward: every gap must be
solvable, and no cheaper filling may exist.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from tmd.diagnostics import TmdError
from tmd.pddl.model import Instruction
from tmd.pddl.semantics import regress
from tmd.pddl.task import Bits, Cube, Operator, Task
from tmd.planning.result import Answer, Filled, GaveUp, Planner


@dataclass(frozen=True, slots=True)
class Segment:
    """Instructions that were filled in (``gap``), and those that were asked for and come after them."""

    gap: tuple[Instruction, ...]
    asked: tuple[Instruction, ...]


class Verdict(Enum):
    """What the reference says of a gap."""

    OPTIMAL = "optimal"
    LONGER = "longer than needed"
    UNPROVEN = "unproven"


@dataclass(frozen=True, slots=True)
class Proof:
    """A gap and what the reference says of it.

    Attributes:
        cost: What the gap costs in the plan.
        verdict: The outcome.
        reference: The reference's answer, with its own plan.
    """

    cost: int
    verdict: Verdict
    reference: Answer


def needs(operators: Sequence[Operator]) -> tuple[Cube, ...]:
    """What must hold for a sequence of operators to be executable: getConstraints of section V-B of the paper."""
    cubes: tuple[Cube, ...] = (Cube(),)
    for operator in reversed(operators):
        cubes = tuple(dict.fromkeys(before for cube in cubes for before in regress(cube, operator)))
    return cubes


def prove(task: Task, start: Bits, segments: Sequence[Segment], reference: Planner) -> tuple[Proof, ...]:
    """Ask ``reference`` for every gap of a plan.

    Args:
        task: The ground problem.
        start: The state in which the plan begins.
        segments: The plan.
        reference: The planner whose word counts, usually Fast Downward.

    Raises:
        TmdError: The plan names unknown instructions or cannot be executed, or the reference finds no plan where
            there is one.
    """
    proofs = []
    state = start
    for segment in segments:
        goal = needs(_operators(task, segment.asked))
        gap = _operators(task, segment.gap)
        answer = reference.fill(state, goal)
        proofs.append(_judged(sum(operator.cost for operator in gap), answer))
        state = _executed(state, gap + _operators(task, segment.asked))
    return tuple(proofs)


def _judged(cost: int, answer: Answer) -> Proof:
    match answer:
        case Filled(_, _, least):
            if least > cost:
                raise TmdError(f"the reference needs {least} where a plan of {cost} is known")
            return Proof(cost, Verdict.OPTIMAL if least == cost else Verdict.LONGER, answer)
        case GaveUp():
            return Proof(cost, Verdict.UNPROVEN, answer)
        case _:
            raise TmdError(f"the reference calls a gap unreachable that is filled: {answer.reason}")


def _operators(task: Task, instructions: Sequence[Instruction]) -> list[Operator]:
    unknown = [instruction for instruction in instructions if instruction not in task.by_instruction]
    if unknown:
        raise TmdError(f"{unknown[0]} can never be done here")
    return [task.by_instruction[instruction] for instruction in instructions]


def _executed(state: Bits, operators: Sequence[Operator]) -> Bits:
    for operator in operators:
        if not operator.applicable(state):
            raise TmdError(f"the plan cannot be executed: {operator.instruction} does not apply")
        state = operator.apply(state)
    return state
