"""Relaxed reachability from a state, to say which part of an impossible goal cannot be reached."""

from __future__ import annotations

from collections.abc import Sequence

from tmd.pddl.task import Bits, Cube, Task


def relaxed_literals(task: Task, state: Bits) -> Cube:
    """The atoms that may come to hold and those that may come not to hold, where nothing is ever lost."""
    everything = (1 << len(task.atoms)) - 1
    true, false = state, everything & ~state
    changed = True
    while changed:
        before = true, false
        for operator in task.operators:
            positive, negative = operator.precondition
            if positive & ~true or negative & ~false:
                continue
            if any(not p & false and not n & true for p, n in operator.forbidden):
                continue
            true |= operator.add
            false |= operator.delete & ~operator.add
            for (p, n), add, delete in operator.conditional:
                if not p & ~true and not n & ~false:
                    true |= add
                    false |= delete & ~add
        changed = (true, false) != before
    return Cube(true, false)


def unreachable_reason(task: Task, state: Bits, goal: Sequence[Cube]) -> str:
    """Why no plan from ``state`` reaches ``goal``, which is known to be out of reach."""
    if not goal:
        return "no state can satisfy the goal: it contradicts itself or what never changes"
    true, false = relaxed_literals(task, state)
    for positive, negative in goal:
        for atom in task.names(positive & negative):
            return f"{atom} would have to hold and not to hold"
        for atom in task.names(positive & ~true):
            return f"{atom} cannot be reached"
        for atom in task.names(negative & ~false):
            return f"(not {atom}) cannot be reached"
    wanted = [*map(str, task.names(goal[0].positive))]
    wanted += [f"(not {atom})" for atom in task.names(goal[0].negative)]
    return f"{', '.join(wanted)} cannot hold together"
