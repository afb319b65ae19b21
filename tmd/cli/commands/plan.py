"""``tmd plan``: a plan for a PDDL problem."""

from __future__ import annotations

from pathlib import Path

import click

from tmd.cli.inputs.options import json_option, limit_options
from tmd.cli.output import emit, emit_json
from tmd.diagnostics import ExitCode
from tmd.world.roots import Roots


@click.command("plan", short_help="Find a plan for a PDDL problem.")
@click.argument("domain")
@click.argument("problem", type=click.Path(path_type=Path))
@click.option("--planner", metavar="NAME", help="auto (default), kairos, fast-downward, in-process or up:ENGINE.")
@click.option(
    "--optimal/--satisficing", default=False, help="Only a plan that is proven to be optimal, or any (the default)."
)
@limit_options
@click.option("--output", type=click.Path(path_type=Path), metavar="FILE", help="Write the plan to this file.")
@json_option
@click.pass_obj
def command(
    roots: Roots,
    domain: str,
    problem: Path,
    planner: str | None,
    optimal: bool,
    seconds: float | None,
    memory: int | None,
    output: Path | None,
    as_json: bool,
) -> ExitCode:
    """Find a plan for PROBLEM, one (action argument ...) a line.

    DOMAIN is a PDDL file, a domain folder or the name of a bundled domain. A comment says whether the plan is optimal
    or just found. Ends with 0 for a plan, 10 where it is proven that there is none, 20 where the planner gave up at
    its limit, and 35 where it failed.
    """
    from tmd.cli.show.answer import answer_json, exit_code, plan_text, why_none
    from tmd.pddl.reading.reader import read_problem
    from tmd.planning.backends import AUTO, solve
    from tmd.planning.result import Solved

    name = planner or AUTO
    wanted = read_problem(problem, roots.domain(domain))
    answer = solve(wanted, name, optimal=optimal, seconds=seconds, memory=memory)
    if isinstance(answer, Solved) and output:
        from tmd.files import write_text

        write_text(output, plan_text(answer, wanted.domain))
    if as_json:
        emit_json(answer_json(answer, name))
    elif isinstance(answer, Solved) and not output:
        emit(plan_text(answer, wanted.domain))
    if not isinstance(answer, Solved):
        emit(f"no plan: {why_none(answer)}\n", error=True)
    return exit_code(answer)
