"""``tmd plan``: a plan for a PDDL problem."""

from __future__ import annotations

from pathlib import Path

import click

from tmd.cli.output import emit, emit_json
from tmd.diagnostics import ExitCode
from tmd.veil.roots import Roots


@click.command("plan", short_help="Find a plan for a PDDL problem.")
@click.argument("domain")
@click.argument("problem", type=click.Path(path_type=Path))
@click.option("--planner", metavar="NAME", help="auto (default), in-process, fast-downward[-first], up:ENGINE.")
@click.option("--output", type=click.Path(path_type=Path), metavar="FILE", help="Write the plan to this file.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.pass_obj
def command(
    roots: Roots, domain: str, problem: Path, planner: str | None, output: Path | None, as_json: bool
) -> ExitCode:
    """Find a plan for PROBLEM, one (action argument ...) a line.

    DOMAIN is a PDDL file, a domain folder or the name of a bundled domain. By default the plan is the shortest where
    that is found soon, and otherwise the first that Fast Downward finds. Ends with 0 for a plan, 10 where it is
    proven that there is none, and 20 where the planner gave up.
    """
    from tmd.cli.show.answer import answer_json, exit_code, plan_text, why_none
    from tmd.files import write_text
    from tmd.pddl.reading.reader import read_problem
    from tmd.planning.backends import AUTO, solve
    from tmd.planning.result import Filled

    name = planner or AUTO
    wanted = read_problem(problem, roots.domain(domain))
    answer = solve(wanted, name)
    if isinstance(answer, Filled) and output:
        write_text(output, plan_text(answer, wanted.domain))
    if as_json:
        emit_json(answer_json(answer, name))
    elif isinstance(answer, Filled) and not output:
        emit(plan_text(answer, wanted.domain))
    if not isinstance(answer, Filled):
        emit(f"no plan: {why_none(answer)}\n", error=True)
    return exit_code(answer)
