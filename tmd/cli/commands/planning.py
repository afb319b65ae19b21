"""``tmd plan``, ``tmd validate`` and ``tmd export``: PDDL problems and plans, for planners and other tools."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tmd.cli.options import (
    OUTPUT,
    PATH,
    GivenText,
    json_option,
    limit_options,
    name_list,
    named_files,
    overwrite_option,
    reading_options,
    text_options,
)
from tmd.cli.output import emit
from tmd.diagnostics import ExitCode, one_line
from tmd.world.roots import Roots

if TYPE_CHECKING:
    from tmd.pddl.model import Problem


# Number of renamed names that a warning lists.
_SHOWN = 10
FORMATS = ("adl", "ipc", "strips", "durative", "plansys2", "bt", "sas")
"""The forms of an export, the default first."""


@click.command("plan", short_help="Find a plan for a PDDL problem.")
@click.argument("domain")
@click.argument("problem", type=PATH)
@click.option("--planner", metavar="NAME", help="auto (default), kairos, fast-downward, in-process or up:ENGINE.")
@click.option("--optimal", is_flag=True, help="Only a plan that is proven to be optimal.")
@limit_options
@click.option(*OUTPUT, type=PATH, metavar="FILE", help="Write the plan to this file.")
@json_option
@click.pass_obj
def plan(
    roots: Roots,
    /,
    domain: str,
    problem: Path,
    planner: str | None,
    optimal: bool,
    output: Path | None,
    as_json: bool,
    seconds: float | None,
    memory: int | None,
) -> ExitCode:
    """Find a plan for PROBLEM, one (action argument ...) a line.

    DOMAIN is a PDDL file, a domain folder or the name of a bundled domain. A comment says whether the plan is optimal
    or just found. Ends with 0 for a plan, 10 where it is proven that there is none, 20 where the planner gave up at
    its limit, and 35 where it failed.
    """
    from tmd.cli.plans import answer_json, exit_code, plan_text, why_none
    from tmd.pddl.reading.reader import read_problem
    from tmd.planning.backends import AUTO, TIME_LIMIT, solve
    from tmd.planning.processes import Deadline, limited, memory_limit
    from tmd.planning.result import Solved

    name = planner or AUTO
    deadline = Deadline(TIME_LIMIT if seconds is None else seconds, memory)
    with limited(deadline), memory_limit(memory):
        wanted = read_problem(problem, roots.domain(domain))
    answer = solve(wanted, name, optimal=optimal, deadline=deadline)
    if isinstance(answer, Solved) and (output or not as_json):
        emit(plan_text(answer, wanted.domain), output)
    if as_json:
        emit(answer_json(answer, name))
    if not isinstance(answer, Solved):
        emit(f"no plan: {why_none(answer)}\n", error=True)
    return exit_code(answer)


@click.command("validate", short_help="Check whether a plan works, and where it breaks.")
@click.argument("domain")
@click.argument("problem", metavar="PROBLEM|ENVIRONMENT")
@click.argument("plan", type=PATH)
@json_option
@click.pass_obj
def validate(roots: Roots, domain: str, problem: str, plan: Path, as_json: bool) -> ExitCode:
    """Execute PLAN in PROBLEM and name the first precondition that does not hold.

    DOMAIN is a PDDL file, a domain folder or the name of a bundled domain. An environment is a YAML file or the name of
    a bundled one, and of its plans only that they can be executed is asked. PLAN is a plan file, or
    what a planner, a planning service or a language model printed (docs/export.md). Ends with 0 for a plan that works
    and 11 for one that does not.
    """
    from tmd.pddl.plan_file import read_plan
    from tmd.pddl.validator import validate

    world = _read(roots, domain, problem)
    told = read_plan(plan, world)
    emit("".join(f"warning: {warning}\n" for warning in told.warnings), error=True)
    verdict = validate(world, told.instructions)
    place = told.locations[verdict.step - 1] if verdict.step else None
    if as_json:
        emit(
            {
                "valid": verdict.valid,
                "status": str(verdict.status),
                "step": verdict.step,
                "line": place.line if place else None,
                "instruction": verdict.instruction.pddl() if verdict.instruction else None,
                "broken": verdict.broken.text if verdict.broken else None,
                "reason": verdict.reason or None,
                "cost": verdict.cost,
            }
        )
    elif verdict.valid:
        emit(f"valid: {len(told.instructions)} instructions, cost {verdict.cost}\n")
    else:
        emit(f"invalid: {f'{place}: ' if place else ''}{verdict.reason}\n")
    return ExitCode.OK if verdict.valid else ExitCode.INVALID_PLAN


def _read(roots: Roots, domain: str, name: str) -> Problem:
    """Return the problem in a PDDL file, or that of an environment, which has no goal.

    Raises:
        TmdError: It is missing or wrong.
    """
    path = Path(name)
    if path.suffix not in (".yaml", ".yml") and (path.is_file() or path.suffix or len(path.parts) > 1):
        return roots.problem(path, domain)
    from tmd.pddl.model import TRUE
    from tmd.pddl.reading.reader import read_problem
    from tmd.world.compile import compile_problem
    from tmd.world.environment import load_environment

    folder = roots.folder(str(Path(domain).absolute().parent) if domain.endswith(".pddl") else domain)
    found = roots.environment(name, folder.name)
    if found.suffix == ".pddl":
        return replace(read_problem(found, folder.domain), goal=TRUE)
    return compile_problem(load_environment(found), folder)


@click.command("export", short_help="Write a problem and its plan for other tools.")
@click.argument("paths", nargs=-1, required=True, metavar="[DOMAIN] PROBLEM|ENVIRONMENT|PLAN.json DIR")
@click.option(
    "--format",
    "formats",
    callback=name_list(*FORMATS),
    default=FORMATS[0],
    metavar="A,B|all",
    help=f"{FORMATS[0]} (default), {', '.join(FORMATS[1:])}.",
)
@click.option("--domain", metavar="NAME|FILE", help="The domain; otherwise what stands beside it or what it names.")
@click.option("--plan", type=PATH, metavar="FILE", help="Take this plan; otherwise one is found.")
@click.option("--planner", metavar="NAME", help="As for tmd plan, or for tmd ground where there is a text.")
@limit_options
@text_options
@reading_options
@click.option(
    "--goal",
    metavar="CONDITION|asked|changed",
    help="Another goal; of a text what it asks for (the default), or all that its plan changes.",
)
@overwrite_option
@click.pass_obj
def export(
    roots: Roots,
    /,
    paths: tuple[str, ...],
    domain: str | None,
    formats: Sequence[str],
    spoken: GivenText,
    overwrite: bool,
    **options: Any,  # noqa: ANN401 - arguments of planned_source
) -> ExitCode:
    """Write a problem and a plan for it into DIR.

    The source is a PDDL problem, an environment (with a text, a plan or a goal), or a plan of "tmd ground
    --json". A plan is executed before it is written: ends with 11 where it does not work, with 10,
    12 or 20 where none is found. One format fills DIR, several a directory each. The others are written when
    one format fails; the exit code is that of the first failure.
    """
    from tmd.cli.export_source import NotPlannedError, planned_source
    from tmd.export.directory import check_directory, write_directory
    from tmd.export.formats import chosen_files

    *files, target = paths
    source, domain = named_files(tuple(files), None, domain, "PROBLEM")
    directory = Path(target)
    check_directory(directory, overwrite=overwrite)
    text = spoken.request() if spoken else None
    try:
        found = planned_source(roots, source, domain=domain, text=text, **options)
    except NotPlannedError as none:
        emit(f"{'invalid' if none.code is ExitCode.INVALID_PLAN else 'no plan'}: {none}\n", error=True)
        return none.code
    written = chosen_files(found, formats)
    failures = written.failures
    if not written.files:
        raise next(iter(failures.values()))
    flat = {path: data for files in written.files.values() for path, data in files.items()}
    write_directory(directory, flat, overwrite=overwrite)
    emit("".join(f"{directory / path}\n" for path in flat))
    if changed := written.renames:
        pairs = [(f"{kind} {name}" if name[0] != "?" else name, new) for (kind, name), new in changed.items()]
        told = ", ".join(f"{name} is {new}" for name, new in pairs[:_SHOWN])
        more = f" and {len(changed) - _SHOWN} more" if len(changed) > _SHOWN else ""
        emit(f"warning: other tools refuse names, which are written differently: {told}{more}\n", error=True)
    for name, error in failures.items():
        emit(f"not written: {name}: {one_line(str(error))}\n", error=True)
    return next((error.exit_code for error in failures.values()), ExitCode.OK)
