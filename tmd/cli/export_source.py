"""The source of an export: a problem with the plan of a planner, of a text, or of a file."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import click

from tmd.cli.grounding import answer, remarks
from tmd.cli.options import ReadingOptions
from tmd.cli.plans import exit_code, why_invalid, why_none
from tmd.diagnostics import ExitCode, TmdError
from tmd.export.planned_problem import Planned, planned, with_outcome
from tmd.json_record import json_value
from tmd.pddl.model import TRUE, Instruction, Problem
from tmd.pddl.plan_file import Plan, read_plan
from tmd.pddl.reading.reader import with_goal
from tmd.pddl.reading.syntax import read_text
from tmd.planning.backends import AUTO, solve
from tmd.planning.result import Solved
from tmd.records.grounding import GroundingRecord
from tmd.world.roots import Roots

ASKED, CHANGED = "asked", "changed"
"""Goals by name, for a text: what it asks for, and everything that its plan changes."""


@dataclass(frozen=True, slots=True)
class ExportRequest:
    """The options that say what is to be exported."""

    source: str
    domain: str | None
    plan: Path | None
    planner: str | None
    text: str | None
    goal: str | None
    seconds: float | None
    memory: int | None
    reading: ReadingOptions


class NotPlannedError(Exception):
    """There is no plan that works, which is an answer of the command; with the reason and the exit code."""

    def __init__(self, reason: str, code: ExitCode) -> None:
        super().__init__(reason)
        self.code = code


def planned_source(roots: Roots, asked: ExportRequest) -> Planned:
    """Return the problem and the plan that were asked for.

    Raises:
        NotPlannedError: There is no plan, or it does not work.
        TmdError: Something is missing or wrong.
        click.UsageError: An option has no meaning for this source.
    """
    path = Path(asked.source)
    of_text = asked.text is not None or path.suffix == ".json"
    if asked.goal in (ASKED, CHANGED) and not of_text:
        raise click.UsageError(f"--goal {asked.goal} is for a text, or for what tmd ground --json printed")
    if path.suffix == ".json":
        return _of_json(roots, path, asked)
    if path.suffix == ".pddl" and asked.text is None:
        problem = roots.problem(path, asked.domain)
        return _planned(with_goal(problem, asked.goal) if asked.goal else problem, asked)
    return _of_environment(roots, asked)


def _of_environment(roots: Roots, asked: ExportRequest) -> Planned:
    if not (asked.text or asked.plan or asked.goal) or (asked.text and asked.plan):
        raise click.UsageError(f"for the environment {asked.source} give one of --text, --text-file, --plan and --goal")
    corpus, world = roots.world(asked.source, asked.domain)
    problem = replace(world.task.problem, goal=TRUE)  # what a PDDL environment has as its goal nobody asked for
    if asked.text is not None:
        found = answer(corpus, world, asked.source, asked.text, asked.reading, planner=asked.planner)
        if found.code:
            raise NotPlannedError(remarks(found.grounded)[-1].strip().partition(": ")[2], found.code)
        best = found.record().plans[0]
        return _checked(problem, found.grounded.plans[0].instructions, _goal(asked, best.goal))
    if asked.goal:
        return _planned(with_goal(problem, asked.goal), asked)
    assert asked.plan is not None
    plan = read_plan(asked.plan)
    _refuse(problem, plan)
    return _checked(problem, plan.instructions, None)


def _of_json(roots: Roots, path: Path, asked: ExportRequest) -> Planned:
    """Return a plan of ``tmd ground --json``."""
    hint = "give what tmd ground --json wrote"
    value = json_value(read_text(path), str(path), hint=hint)
    if not isinstance(value, dict) or "plans" not in value:
        raise TmdError(f"{path} is no plan", hint=hint)
    told = GroundingRecord.from_value(value, str(path))
    if not told.plans:
        raise NotPlannedError(f"{path} has no plan", ExitCode.NOT_GROUNDED)
    _, world = roots.world(told.environment, asked.domain or told.domain)
    best = told.plans[0]
    return _checked(world.task.problem, tuple(step.instruction for step in best.steps), _goal(asked, best.goal))


def _goal(asked: ExportRequest, stated: str | None) -> str | None:
    """Return the goal for the plan of a text; ``None`` for everything that the plan changes.

    Raises:
        TmdError: What the text asks for is wanted, and not known.
    """
    if asked.goal == ASKED and stated is None:
        raise TmdError(
            "what the text asks for is not known: it was grounded by a model without goals",
            hint=f"ground it again, or take --goal {CHANGED}",
        )
    if asked.goal in (None, ASKED):
        return stated
    return None if asked.goal == CHANGED else asked.goal


def _checked(problem: Problem, plan: tuple[Instruction, ...], goal: str | None) -> Planned:
    """Return a plan that reaches ``goal``; where none is stated, what the plan brings about is its goal."""
    wanted = with_goal(problem, goal) if goal else problem
    _refuse(wanted, Plan(plan))
    return planned(wanted if goal else with_outcome(problem, plan), plan)


def _planned(problem: Problem, asked: ExportRequest) -> Planned:
    """Return a problem with the plan in the file that was named, or else with that of a planner."""
    if asked.plan:
        plan = read_plan(asked.plan)
        _refuse(problem, plan)
        return planned(problem, plan.instructions)
    found = solve(problem, asked.planner or AUTO, seconds=asked.seconds, memory=asked.memory)
    if isinstance(found, Solved):
        return planned(problem, found.plan)
    raise NotPlannedError(why_none(found), exit_code(found))


def _refuse(problem: Problem, plan: Plan) -> None:
    fault = why_invalid(problem, plan)
    if fault:
        raise NotPlannedError(fault, ExitCode.INVALID_PLAN)
