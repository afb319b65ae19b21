"""``tmd validate``: does a plan work, and if not, which precondition breaks first."""

from __future__ import annotations

from pathlib import Path

import click

from tmd.cli.output import emit, emit_json
from tmd.diagnostics import ExitCode
from tmd.veil.roots import Roots


@click.command("validate", short_help="Tell whether a plan works, and where it breaks.")
@click.argument("domain")
@click.argument("problem", type=click.Path(path_type=Path))
@click.argument("plan", type=click.Path(path_type=Path))
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.pass_obj
def command(roots: Roots, domain: str, problem: Path, plan: Path, as_json: bool) -> ExitCode:
    """Execute PLAN in PROBLEM and name the first precondition that does not hold.

    DOMAIN is a PDDL file, a domain folder or the name of a bundled domain. PLAN has one (action argument ...) a line;
    plans with times are read as well, as VAL, POPF and PlanSys2 have them. Ends with 0 for a plan that works and 11
    for one that does not.
    """
    from tmd.export.strips import restored
    from tmd.pddl.plan_file import read_plan
    from tmd.pddl.reading.reader import read_problem
    from tmd.pddl.validator import validate

    world = read_problem(problem, roots.domain(domain))
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
