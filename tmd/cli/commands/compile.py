"""``tmd compile``: object graphs to PDDL."""

from __future__ import annotations

from pathlib import Path

import click

from tmd.cli.output import emit
from tmd.diagnostics import ExitCode
from tmd.world.roots import Roots


@click.command("compile", short_help="Compile object graphs to PDDL.")
@click.argument("what", metavar="DOMAIN|ENVIRONMENT.yaml")
@click.option("--check", is_flag=True, help="Write nothing; end with 13 if the domain.pddl there has drifted.")
@click.option("--output", type=click.Path(path_type=Path), metavar="FILE", help="Write the PDDL problem to this file.")
@click.option("--goal", metavar="CONDITION", help='The goal of the PDDL problem, such as "(hot pot1)".')
@click.pass_obj
def command(roots: Roots, what: str, check: bool, output: Path | None, goal: str | None) -> ExitCode:
    """Compile a domain folder to its domain.pddl, or an environment to a PDDL problem.

    The domain.pddl is written into the folder, the problem to standard output.
    """
    if Path(what).suffix not in (".yaml", ".yml"):
        if output or goal:
            raise click.UsageError("--output and --goal are for environments")
        return _domain(roots, what, check)
    if check:
        raise click.UsageError("--check is for domains")
    return _environment(roots, Path(what), output, goal)


def _domain(roots: Roots, name: str, check: bool) -> ExitCode:
    from tmd.world.compile import update_domain

    folder = roots.sources(name)
    target, changed = folder.path / "domain.pddl", update_domain(folder, write=not check)
    if check:
        emit(f"{target} {'has drifted: run `tmd compile`' if changed else 'is up to date'}\n")
        return ExitCode.FAULTS_FOUND if changed else ExitCode.OK
    emit(f"{target} {'written' if changed else 'was up to date'}\n")
    return ExitCode.OK


def _environment(roots: Roots, path: Path, output: Path | None, goal: str | None) -> ExitCode:
    from tmd.files import write_text
    from tmd.pddl.reading.reader import with_goal
    from tmd.pddl.writer import format_problem
    from tmd.world.compile import compile_problem
    from tmd.world.environment import load_environment

    environment = load_environment(path)
    problem = compile_problem(environment, roots.folder(environment.domain))
    text = format_problem(with_goal(problem, goal) if goal else problem)
    if output:
        write_text(output, text)
    else:
        emit(text)
    return ExitCode.OK
