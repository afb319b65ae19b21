"""What is to be shown: a text that is grounded now, or what a file holds."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from tmd.cli.inputs.grounding import GroundingOptions, answer
from tmd.cli.inputs.view import STANDARD, FoundSubject, ViewRequest
from tmd.cli.inputs.view_records import demonstration_found, grounding_found, made_rows, run_found
from tmd.cli.show.plans import remarks
from tmd.diagnostics import TmdError
from tmd.export.record import parse_record
from tmd.export.strips import restored
from tmd.pddl.model import Problem
from tmd.pddl.plan_file import Plan, parse_plan
from tmd.pddl.reading.syntax import read_text
from tmd.records.json_record import json_value
from tmd.records.plan import FORMAT
from tmd.veil.roots import Roots
from tmd.view.subject import PlannedStep, Subject, text_subject

MAX_STEPS = 10_000
"""Plans with more steps are refused: nobody reads such a page."""
_KINDS = "what tmd ground --json or tmd run --json printed, a log of tmd run, a plan file, or demonstrations"


def subject_of_text(
    roots: Roots, text: str, environment: str, domain: str | None, options: GroundingOptions
) -> FoundSubject:
    """Ground a text now.

    Raises:
        TmdError: The environment, or how it is to be grounded, is wrong.
    """
    found = answer(roots, text, environment, domain, options)
    rows = made_rows({**found.made_with, "domain": found.corpus.folder.name, "environment": environment})
    told = tuple(remarks(found.grounded))
    return FoundSubject(
        text_subject(found.grounded, rows), Path(f"{found.grounded.world.name}.html"), told, of_text=True
    )


def subject_of_file(roots: Roots, asked: ViewRequest) -> FoundSubject:
    """What a file holds: its content says what kind of file it is.

    Raises:
        TmdError: It is of no kind that is known, or something in it or around it is wrong.
        click.UsageError: An option has no meaning for this kind.
    """
    if asked.source != STANDARD and asked.path.is_dir():
        raise TmdError(f"{asked.source} is a directory", hint=f"give a file: {_KINDS}")
    text = _read(asked)
    found = _of_text(roots, asked, text)
    if len(found.subject.steps) > MAX_STEPS:
        raise TmdError(
            f"{asked.name}: the plan has {len(found.subject.steps):,} steps; at most {MAX_STEPS:,} are shown"
        )
    return found


def _read(asked: ViewRequest) -> str:
    if asked.source != STANDARD:
        return read_text(asked.path)
    try:
        return sys.stdin.buffer.read().decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise TmdError(f"standard input: byte {error.start + 1} is not UTF-8", hint="send UTF-8") from error


def _of_text(roots: Roots, asked: ViewRequest, text: str) -> FoundSubject:
    lines = [(number, line) for number, line in enumerate(text.splitlines(), start=1) if line.strip()]
    if not lines:
        raise TmdError(f"{asked.name} is empty", hint=f"give {_KINDS}")
    if not lines[0][1].lstrip().startswith(("{", "[")):
        _only(asked, "problem", "environment", "domain")
        return _plan_found(roots, asked, text)
    try:
        first = _object(asked, lines[0][1])  # of JSON Lines, or all on one line
    except TmdError:
        first = _object(asked, text)
    return _of_json(roots, asked, first, lines)


def _of_json(roots: Roots, asked: ViewRequest, first: dict[str, Any], lines: list[tuple[int, str]]) -> FoundSubject:
    if "segments" in first:
        _only(asked, "demonstration", "environment", "domain")
        return demonstration_found(roots, asked, lines)
    if first.get("format") == FORMAT:
        _only(asked)
        planned = parse_record("\n".join(line for _, line in lines), asked.name)
        return _plan_of(asked, planned.problem, Plan(planned.plan))
    if "event" in first or ("mode" in first and "steps" in first):
        _only(asked, "environment", "domain", "strip")
        return run_found(roots, asked, first, lines)
    if "plans" in first:
        _only(asked, "environment", "domain")
        return grounding_found(roots, asked, first)
    if isinstance(first.get("error"), dict):
        raise TmdError(f"{asked.name} is an error that tmd printed, no plan: {first['error'].get('message')}")
    raise TmdError(f"{asked.name} is JSON of no kind that can be shown", hint=f"give {_KINDS}")


def _only(asked: ViewRequest, *meant: str) -> None:
    """Refuse options that this kind of file has no use for."""
    names = {"problem": "--problem", "environment": "--environment", "domain": "--domain"}
    names |= {"demonstration": "--id", "strip": "--strip"}
    for field, option in names.items():
        if field not in meant and getattr(asked, field) is not None:
            raise click.UsageError(f"{option} has no meaning for {asked.name}")


def _object(asked: ViewRequest, text: str) -> dict[str, Any]:
    """The JSON object in a text."""
    value = json_value(text, asked.name, hint=f"give {_KINDS}")
    if not isinstance(value, dict):
        raise TmdError(f"{asked.name} is JSON, but no object", hint=f"give {_KINDS}")
    return value


def _plan_found(roots: Roots, asked: ViewRequest, text: str) -> FoundSubject:
    """A plan file, in a problem or an environment."""
    if (asked.problem is None) == (asked.environment is None):
        raise click.UsageError(f"for the plan {asked.name} give one of --problem and --environment")
    plan = parse_plan(text, asked.name)
    if not plan.instructions:
        raise TmdError(f"{asked.name}: the plan has no instructions", hint="write one (name argument ...) a line")
    if asked.problem is not None:
        problem = roots.problem(asked.problem, asked.domain)
    else:
        problem = roots.world(asked.environment or "", asked.domain)[1].task.problem
    return _plan_of(asked, problem, plan)


def _plan_of(asked: ViewRequest, problem: Problem, plan: Plan) -> FoundSubject:
    where = {"problem": asked.problem, "environment": asked.environment or problem.name, "domain": problem.domain.name}
    steps = tuple(PlannedStep(instruction) for instruction in restored(problem, plan.instructions))
    subject = Subject(f"{asked.path.name}: a plan in {problem.name}", problem, steps, made=made_rows(where))
    told = f"warning: {plan.overlap}: instructions overlap in time; they are taken one after the other\n"
    return FoundSubject(subject, asked.path.with_suffix(".html"), (told,) if plan.overlap else (), plan.locations)
