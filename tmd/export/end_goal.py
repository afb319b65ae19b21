"""Goal of a whole text: one PDDL condition on the end of its plan."""

from __future__ import annotations

from collections.abc import Collection

from tmd.grounded import Grounded
from tmd.inference.ranking import RankedPlan
from tmd.pddl.ground_formula import atoms_of
from tmd.pddl.model import And, Formula, Or, Problem, conjuncts, universe
from tmd.pddl.reading.reader import aimed_at
from tmd.pddl.semantics import holds
from tmd.pddl.task import Task


def end_goal(plan: RankedPlan, task: Task) -> Formula | None:
    """Return the goals of a text that later steps did not undo, as one condition; ``None`` without goals.

    A conjunct that does not hold at the end of ``plan`` was undone by a later step: *open the fridge, …, close it*. Of
    alternatives only those are left that hold at the end, if a later step speaks of what was chosen: in *fill a cup and
    put it in the microwave* the cup in the microwave must be full.
    """
    if not plan.goals:
        return None
    end, objects = task.decode(plan.state), universe(task.problem)
    asked = [conjuncts(goal.formula) if goal.formula is not None else [] for goal in plan.goals]
    found: dict[Formula, None] = {}
    for number, parts in enumerate(asked, start=1):
        later = {name for others in asked[number:] for other in others for name in _objects(other)}
        for part in parts:
            if holds(part, end, objects):
                standing = [inner for inner in _alternatives(part) if holds(inner, end, objects)]
                found[_narrowed(part, standing, later)] = None
    return next(iter(found)) if len(found) == 1 else And(tuple(found))


def asked_problem(grounded: Grounded) -> Problem | None:
    """Return the environment with the goal of a text; ``None`` where the text has no plan with goals."""
    task = grounded.world.task
    whole = end_goal(grounded.plans[0], task) if grounded.plans else None
    return None if whole is None else aimed_at(task.problem, whole)


def _narrowed(part: Formula, standing: list[Formula], later: Collection[str]) -> Formula:
    """Return a disjunction without what was not chosen, where later steps speak of what was."""
    every = set.intersection(*(_objects(inner) for inner in _alternatives(part)))
    chosen = {name for inner in standing for name in _objects(inner)} - every
    if not chosen & set(later):
        return part
    return standing[0] if len(standing) == 1 else Or(tuple(standing))


def _alternatives(part: Formula) -> tuple[Formula, ...]:
    return part.parts if isinstance(part, Or) else (part,)


def _objects(formula: Formula) -> set[str]:
    """Return the objects that a condition over ground atoms speaks of."""
    return {name for atom in atoms_of(formula) for name in atom.args}
