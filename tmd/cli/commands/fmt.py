"""``tmd fmt``: PDDL and YAML laid out the same way everywhere."""

from __future__ import annotations

import click

from tmd.cli.errors import fault_of
from tmd.cli.output import emit
from tmd.diagnostics import ExitCode, OutputError, TmdError
from tmd.world.roots import Roots


@click.command("fmt", short_help="Format PDDL and YAML files.")
@click.argument("paths", metavar="PATH...", nargs=-1, required=True)
@click.option("--check", "only_check", is_flag=True, help="Write nothing; exit with 13 if a file would be reformatted.")
@click.pass_obj
def command(roots: Roots, paths: tuple[str, ...], only_check: bool) -> ExitCode:
    """Lay out files, or all PDDL and YAML files of folders; comments and line breaks stay.

    A file with a fault that makes laying it out impossible is left as it is, and told; then this ends with 31.
    """
    from tmd.check.checker import files_of
    from tmd.format.files import SUFFIXES, format_file

    changed = 0
    failed: list[TmdError] = []
    files = [file for name in paths for file in files_of(roots.path(name)) if file.suffix in SUFFIXES]
    for file in files:
        try:
            if not format_file(file, write=not only_check):
                continue
        except OutputError:
            raise
        except TmdError as error:
            failed.append(error)
            continue
        changed += 1
        emit(f"{file}: {'would be reformatted' if only_check else 'reformatted'}\n")
    for fault in failed:
        emit(fault_of(fault).text(), error=True)
    emit(f"{len(files)} file(s): {changed} {'to change' if only_check else 'changed'}, {len(failed)} failed\n")
    if failed:
        return ExitCode.BAD_INPUT
    return ExitCode.FAULTS_FOUND if only_check and changed else ExitCode.OK
