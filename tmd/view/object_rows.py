"""A row for each object of a plan, with a mark at each step that names it."""

from __future__ import annotations

from collections.abc import Sequence

from tmd.goals.wording import Wording
from tmd.pddl.model import Instruction, Problem
from tmd.view.markup import macro


def object_rows(plan: Sequence[Instruction], problem: Problem, current: int, wording: Wording, link: str = "") -> str:
    """Render the objects of a plan as rows and its steps as columns; empty for an empty plan.

    Args:
        plan: The plan.
        problem: Its problem; constants of the domain have no row.
        current: The number of the step that is looked at, from 1; 0 for none.
        wording: Puts instructions into words.
        link: The beginning of the address of a step; without it a step is a mark of the studio's page.
    """
    constants = {each.name for each in problem.domain.constants}
    rows: dict[str, dict[int, str]] = {}
    for number, instruction in enumerate(plan, start=1):
        for name in instruction.args:
            if name not in constants:
                rows.setdefault(name, {})[number] = wording.instruction(instruction)
    return macro("state.html.j2", "object_rows", rows, len(plan), current, link) if rows else ""
