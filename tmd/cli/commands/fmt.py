"""``tmd fmt``: PDDL and YAML laid out the same way everywhere."""

from __future__ import annotations

from pathlib import Path

import click

from tmd.cli.inputs.paths import Roots
from tmd.cli.output import emit
from tmd.diagnostics import ExitCode, TmdError


@click.command("fmt", short_help="Format PDDL and YAML files.")
@click.argument("paths", metavar="PATH...", nargs=-1, required=True)
@click.option("--check", "only_check", is_flag=True, help="Write nothing; exit with 13 if a file would be reformatted.")
@click.pass_obj
def command(roots: Roots, paths: tuple[str, ...], only_check: bool) -> ExitCode:
    """Lay out files, or all PDDL and YAML files of folders; comments and line breaks stay.

    A file with a fault that makes laying it out impossible is left as it is, and told; then this ends with 31.
    """
    from tmd.check.checker import files_of
    from tmd.files import write_text
    from tmd.pddl.reading.syntax import read_text

    changed = 0
    failed: list[TmdError] = []
    files = [file for name in paths for file in files_of(roots.path(name)) if file.suffix in _SUFFIXES]
    for file in files:
        try:
            raw = read_text(file)
            text = _laid_out(raw, file)
        except TmdError as error:
            failed.append(error)
            continue
        if text == raw and not _has_marks(file):
            continue
        changed += 1
        if not only_check:
            write_text(file, text)
        emit(f"{file}: {'would be reformatted' if only_check else 'reformatted'}\n")
    for fault in failed:
        emit(f"error: {fault}\n", error=True)
    emit(f"{len(files)} file(s): {changed} {'to change' if only_check else 'changed'}, {len(failed)} failed\n")
    if failed:
        return ExitCode.BAD_INPUT
    return ExitCode.FAULTS_FOUND if only_check and changed else ExitCode.OK


_SUFFIXES = (".pddl", ".yaml", ".yml")


def _laid_out(text: str, file: Path) -> str:
    if file.suffix == ".pddl":
        from tmd.format.pddl_layout import format_pddl

        return format_pddl(text, str(file))
    from tmd.format.yaml_layout import format_yaml

    return format_yaml(text, str(file))


def _has_marks(file: Path) -> bool:
    """Whether the file begins with a byte order mark or has Windows line ends, which reading hides."""
    data = file.read_bytes()
    return data.startswith(b"\xef\xbb\xbf") or b"\r" in data
