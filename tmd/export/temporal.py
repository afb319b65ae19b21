"""Plans with times, as VAL, POPF and PlanSys2 write and read them.

One instruction a line: when it starts, the instruction, and how long it takes. The first starts at 0, each of the
others a little after the end of the one before it, as PDDL 2.1 demands of actions that need what the other one does.
"""

from __future__ import annotations

from collections.abc import Sequence
from decimal import Decimal

from tmd.export.durative import DURATION
from tmd.pddl.model import Instruction

GAP = Decimal("0.001")
"""Between the end of an instruction and the start of the next; the tolerance of VAL and POPF."""


def starts(count: int) -> list[Decimal]:
    """When each of ``count`` instructions starts."""
    return [number * (DURATION + GAP) for number in range(count)]


def format_temporal(plan: Sequence[Instruction]) -> str:
    """A plan of PDDL 2.1: ``0.000: (grasp cup1) [1.000]``."""
    lines = [f"{start:.3f}: {i.pddl()} [{DURATION:.3f}]" for start, i in zip(starts(len(plan)), plan, strict=True)]
    return "".join(f"{line}\n" for line in lines)


def format_popf(plan: Sequence[Instruction]) -> str:
    """A plan as the planner POPF prints it, which is what PlanSys2 reads: from ``Solution Found`` on."""
    makespan = len(plan) * DURATION + max(0, len(plan) - 1) * GAP
    lines = [f"{start:.3f}: {i.pddl()}  [{DURATION:.3f}]" for start, i in zip(starts(len(plan)), plan, strict=True)]
    return "".join(f"{line}\n" for line in [";;;; Solution Found", f"; Cost: {makespan:.3f}", *lines])
