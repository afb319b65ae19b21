"""The source of an export: a problem with the plan of a planner, of a text, or of a file."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

import click

from tmd.cli.inputs.options import ReadingOptions
from tmd.diagnostics import ExitCode, TmdError
from tmd.export.planned_problem import Planned, planned, with_outcome
from tmd.pddl.model import TRUE, Instruction, Problem
from tmd.pddl.plan_file import Plan, read_plan
from tmd.pddl.reading.reader import with_goal
from tmd.pddl.reading.syntax import read_text
from tmd.world.roots import Roots

ASKED, CHANGED = "asked", "changed"
"""Goals by name, for a text: what it asks for, and everything that its plan changes."""


_MAKER = "give what tmd ground --json or tmd export --format json wrote"


@dataclass(frozen=True, slots=True)
class ExportRequest:
    """The options that say what is to be exported."""

    source: str
    domain: str | None = None
    plan: Path | None = None
    planner: str | None = None
    text: str | None = None
    goal: str | None = None
    example: str | None = None
    model: str | None = None
    seconds: float | None = None
    memory: int | None = None
    reading: ReadingOptions = field(default_factory=ReadingOptions)


@dataclass(frozen=True, slots=True)
class NoPlan:
    """The reason why there is no plan, and the exit code for it."""

    reason: str
    code: ExitCode


def planned_source(roots: Roots, asked: ExportRequest) -> Planned | NoPlan:
    """Return the problem and the plan that were asked for.

    Raises:
        TmdError: Something is missing or wrong.
        click.UsageError: An option has no meaning for this source.
    """
    path = Path(asked.source)
    of_text = asked.text is not None or path.suffix == ".json"
    if asked.goal in (ASKED, CHANGED) and not of_text:
        raise click.UsageError(f"--goal {asked.goal} is for a text, or for what tmd ground --json printed")
    if path.is_dir():
        from tmd.evaluation.runs.finished_run import predicted_plan

        return _checked(*predicted_plan(roots, path, asked.example, asked.model), asked.goal)
    if asked.example or asked.model:
        raise click.UsageError(f"--example and --model are for the directory of a run, and {path} is none")
    if path.suffix == ".json":
        return _of_json(roots, path, asked)
    if path.suffix == ".pddl" and asked.text is None:
        return _of_problem(roots, path, asked)
    return _of_environment(roots, asked)


def _of_problem(roots: Roots, path: Path, asked: ExportRequest) -> Planned | NoPlan:
    problem = roots.problem(path, asked.domain)
    if asked.goal:
        problem = with_goal(problem, asked.goal)
    return _of_file(problem, asked.plan) if asked.plan else _solved(problem, asked)


def _of_environment(roots: Roots, asked: ExportRequest) -> Planned | NoPlan:
    from tmd.cli.inputs.plan import orders_of_text
    from tmd.planning.backends import IN_PROCESS

    if not (asked.text or asked.plan or asked.goal) or (asked.text and asked.plan):
        raise click.UsageError(f"for the environment {asked.source} give one of --text, --text-file, --plan and --goal")
    corpus, world = roots.world(asked.source, asked.domain)
    problem = replace(world.task.problem, goal=TRUE)  # what a PDDL environment has as its goal nobody asked for
    if asked.text is not None:
        orders = orders_of_text(asked.text, corpus, world, asked.source, asked.planner or IN_PROCESS, asked.reading)
        if orders.status:
            reason = orders.remarks[-1].strip()
            return NoPlan(reason.removeprefix("no plan: ").removeprefix("question: "), orders.code)
        goal = _goal(asked, orders.grounding.plans[0].goal if orders.grounding else None)
        return _checked(problem, tuple(order.instruction for order in orders.orders), goal)
    if asked.plan is None:
        return _solved(with_goal(problem, asked.goal or ""), asked)
    if asked.goal:
        return _of_file(with_goal(problem, asked.goal), asked.plan)
    plan = _read_plan(problem, asked.plan)
    refused = _refusal(problem, plan)
    return refused or _checked(problem, plan.instructions, None)


def _of_json(roots: Roots, path: Path, asked: ExportRequest) -> Planned | NoPlan:
    """Return a plan of ``tmd ground --json``, or what ``tmd export --format json`` wrote."""
    from tmd.export.record import parse_record
    from tmd.json_record import json_value
    from tmd.records.grounding import GroundingRecord
    from tmd.records.plan import FORMAT

    text = read_text(path)
    value = json_value(text, str(path), hint=_MAKER)
    if isinstance(value, dict) and value.get("format") == FORMAT:
        return parse_record(text, str(path))
    if not isinstance(value, dict) or "plans" not in value:
        raise TmdError(f"{path} is no plan", hint=_MAKER)
    told = GroundingRecord.from_value(value, str(path))
    if not told.plans:
        return NoPlan(f"{path} has no plan", ExitCode.NOT_GROUNDED)
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


def _checked(problem: Problem, plan: tuple[Instruction, ...], goal: str | None) -> Planned | NoPlan:
    """Return a plan that reaches ``goal``; where none is stated, what the plan brings about is its goal."""
    refused = _refusal(with_goal(problem, goal) if goal else problem, Plan(plan))
    if refused:
        return refused
    return planned(with_goal(problem, goal) if goal else with_outcome(problem, plan), plan)


def _read_plan(problem: Problem, path: Path) -> Plan:
    """Return the plan in a file, which may be one for the exported STRIPS."""
    from tmd.export.strips import restored

    read = read_plan(path)
    return Plan(restored(problem, read.instructions), read.cost, read.locations)


def _of_file(problem: Problem, path: Path) -> Planned | NoPlan:
    plan = _read_plan(problem, path)
    return _refusal(problem, plan) or planned(problem, plan.instructions)


def _refusal(problem: Problem, plan: Plan) -> NoPlan | None:
    from tmd.pddl.validator import validate

    verdict = validate(problem, plan.instructions)
    if verdict.valid:
        return None
    place = f"{plan.locations[verdict.step - 1]}: " if verdict.step and plan.locations else ""
    return NoPlan(f"{place}{verdict.reason}", ExitCode.INVALID_PLAN)


def _solved(problem: Problem, asked: ExportRequest) -> Planned | NoPlan:
    from tmd.cli.show.answer import exit_code, why_none
    from tmd.planning.backends import AUTO, solve
    from tmd.planning.result import Solved

    answer = solve(problem, asked.planner or AUTO, seconds=asked.seconds, memory=asked.memory)
    if isinstance(answer, Solved):
        return planned(problem, answer.plan)
    return NoPlan(why_none(answer), exit_code(answer))
