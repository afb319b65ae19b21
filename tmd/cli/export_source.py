"""The source of an export: a problem with the plan of a planner, of a text, or of a file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from tmd.cli.grounding import Answer, answer
from tmd.cli.options import ReadingOptions
from tmd.cli.output import emit
from tmd.cli.plans import exit_code, why_invalid, why_none
from tmd.diagnostics import ExitCode, TmdError
from tmd.export.planned_problem import Planned, planned, with_outcome
from tmd.json_record import json_value
from tmd.pddl.model import TRUE, Problem
from tmd.pddl.plan_file import Plan, read_plan
from tmd.pddl.reading.reader import with_goal
from tmd.pddl.reading.syntax import read_text
from tmd.planning.backends import AUTO, solve
from tmd.planning.result import Solved
from tmd.records.grounding import GroundingRecord
from tmd.view.answer_text import remarks
from tmd.world.roots import Roots

ASKED, CHANGED = "asked", "changed"
"""Goals by name, for a text: what it asks for, and everything that its plan changes."""


class NotPlannedError(Exception):
    """There is no plan that works, which is an answer of the command; with the reason and the exit code."""

    def __init__(self, reason: str, code: ExitCode) -> None:
        super().__init__(reason)
        self.code = code


def planned_source(
    roots: Roots,
    source: str,
    *,
    domain: str | None,
    plan: Path | None,
    goal: str | None,
    planner: str | None,
    text: str | None,
    reading: ReadingOptions,
    **limits: Any,  # noqa: ANN401 - arguments of solve
) -> Planned:
    """Return the problem and the plan that were asked for; the arguments are those of ``tmd export``.

    Raises:
        NotPlannedError: There is no plan, or it does not work.
        TmdError: Something is missing or wrong.
        click.UsageError: An option has no meaning for this source.
    """
    path = Path(source)
    if path.suffix == ".json":
        return _of_json(roots, path, domain, goal)
    unclear = click.UsageError(f"for the environment {source} give one of --text, --text-file, --plan and --goal")
    if text is not None:
        if plan:
            raise unclear
        corpus, world = roots.world(source, domain)
        return _of_text(
            answer(corpus, world, source, text=text, reading=reading, planner=planner), world.task.problem, goal
        )
    if goal in (ASKED, CHANGED):
        raise click.UsageError(f"--goal {goal} is for a text, or for what tmd ground --json printed")
    if path.suffix == ".pddl":
        problem = roots.problem(path, domain)
    elif plan or goal:
        problem = replace(roots.world(source, domain)[1].task.problem, goal=TRUE)
    else:
        raise unclear
    if goal:
        problem = with_goal(problem, goal)
    if plan:
        found = read_plan(plan, problem)
        emit("".join(f"warning: {warning}\n" for warning in found.warnings), error=True)
        return _checked(problem, found, whole=path.suffix != ".pddl" and not goal)
    solution = solve(problem, planner or AUTO, **limits)
    if isinstance(solution, Solved):
        return planned(problem, solution.plan)
    raise NotPlannedError(why_none(solution), exit_code(solution))


def _of_text(found: Answer, problem: Problem, goal: str | None) -> Planned:
    """Return the best plan of a text. Where two readings of the text differ there is none."""
    if found.code:
        raise NotPlannedError(remarks(found.grounded)[-1].strip().partition(": ")[2], found.code)
    return _first_plan(found.record, problem, goal)


def _of_json(roots: Roots, path: Path, domain: str | None, goal: str | None) -> Planned:
    """Return the first plan of ``tmd ground --json``, with another goal if one is given."""
    hint = "give what tmd ground --json wrote"
    value = json_value(read_text(path), str(path), hint=hint)
    if not isinstance(value, dict) or "plans" not in value:
        raise TmdError(f"{path} is no plan", hint=hint)
    told = GroundingRecord.from_value(value, str(path))
    if not told.plans:
        raise NotPlannedError(f"{path} has no plan", ExitCode.NOT_GROUNDED)
    _, world = roots.recorded(told.environment_file or told.environment, domain or told.domain)
    return _first_plan(told, world.task.problem, goal)


def _first_plan(told: GroundingRecord, problem: Problem, goal: str | None) -> Planned:
    """Return the first plan of a text, and as its goal what the text asks for unless another is given.

    Raises:
        TmdError: What the text asks for is wanted, and not known.
    """
    best = told.plans[0]
    if goal == ASKED and best.goal is None:
        raise TmdError(
            "what the text asks for is not known: it was grounded by a model without goals",
            hint=f"ground it again, or take --goal {CHANGED}",
        )
    wanted = best.goal if goal in (None, ASKED) else None if goal == CHANGED else goal
    plan = Plan(tuple(step.instruction for step in best.steps))
    return _checked(with_goal(problem, wanted) if wanted else replace(problem, goal=TRUE), plan, whole=not wanted)


def _checked(problem: Problem, plan: Plan, *, whole: bool) -> Planned:
    """Return a plan that works; its goal is what it brings about where the ``whole`` of that is wanted."""
    fault = why_invalid(problem, plan)
    if fault:
        raise NotPlannedError(fault, ExitCode.INVALID_PLAN)
    return planned(with_outcome(problem, plan.instructions) if whole else problem, plan.instructions)
