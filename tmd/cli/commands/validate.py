"""``tmd validate``: does a plan work, and if not, which precondition breaks first."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tmd.cli.inputs.options import json_option
from tmd.cli.output import emit, emit_json
from tmd.diagnostics import ExitCode
from tmd.world.roots import Roots

if TYPE_CHECKING:
    from tmd.pddl.model import Problem


@click.command("validate", short_help="Tell whether a plan works, and where it breaks.")
@click.argument("domain")
@click.argument("problem", metavar="PROBLEM|ENVIRONMENT")
@click.argument("plan", type=click.Path(path_type=Path))
@json_option
@click.pass_obj
def command(roots: Roots, domain: str, problem: str, plan: Path, as_json: bool) -> ExitCode:
    """Execute PLAN in PROBLEM and name the first precondition that does not hold.

    DOMAIN is a PDDL file, a domain folder or the name of a bundled domain. An environment is a YAML file or the name of
    a bundled one, and of its plans only that they can be executed is asked. PLAN has one (action argument ...) a line;
    plans with times are read as well, as VAL, POPF and PlanSys2 have them. Ends with 0 for a plan that works and 11
    for one that does not.
    """
    from tmd.export.strips import restored
    from tmd.pddl.plan_file import read_plan
    from tmd.pddl.validator import validate

    world = _read(roots, domain, problem)
    told = read_plan(plan)
    if told.overlap:
        emit(f"warning: {told.overlap}: instructions overlap in time; they are taken one after the other\n", error=True)
    verdict = validate(world, restored(world, told.instructions))
    place = told.locations[verdict.step - 1] if verdict.step else None
    if as_json:
        emit_json(
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
    from tmd.pddl.reading.reader import read_problem

    path = Path(name)
    if path.suffix not in (".yaml", ".yml") and (path.is_file() or path.suffix or len(path.parts) > 1):
        return read_problem(path, roots.domain(domain))
    from tmd.pddl.model import TRUE
    from tmd.world.compile import compile_problem
    from tmd.world.environment import load_environment

    folder = roots.folder(str(Path(domain).absolute().parent) if domain.endswith(".pddl") else domain)
    found = roots.environment(name, folder.name)
    if found.suffix == ".pddl":
        return replace(read_problem(found, folder.domain), goal=TRUE)
    return compile_problem(load_environment(found), folder)
