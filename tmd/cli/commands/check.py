"""``tmd check``: everything that is wrong with the files of a domain."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from tmd.cli.errors import one_line, pointed
from tmd.cli.inputs.paths import Roots
from tmd.cli.output import emit, emit_json
from tmd.diagnostics import ExitCode

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from tmd.check.checker import Checker
    from tmd.check.codes import Severity
    from tmd.check.diagnostic import Diagnostic


@click.command("check", short_help="Find everything that is wrong with domains, problems and their files.")
@click.argument("paths", metavar="PATH...", nargs=-1, required=True)
@click.option("--domain", metavar="FILE", help="The domain of the problems; otherwise it is looked for.")
@click.option("--strict", is_flag=True, help="Treat warnings as errors.")
@click.option("--notes", is_flag=True, help="Print notes as well.")
@click.option("--fix", is_flag=True, help="Apply safe fixes, then check again.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.pass_obj
def command(
    roots: Roots, paths: tuple[str, ...], domain: str | None, strict: bool, notes: bool, fix: bool, as_json: bool
) -> ExitCode:
    """Check files and folders, and tell every problem with its place and what to do.

    PATH is a file, a folder, or the name of a bundled domain. Ends with 0 where there are no errors, 13 otherwise.
    """
    from tmd.check.codes import Severity

    given = roots.pddl_file(domain) if domain else None
    checker = _checked(roots, paths, given)
    fixed: list[Path] = []
    for _ in range(_MOST_ROUNDS if fix else 0):
        mended = _mend(checker)
        if not mended:
            break
        fixed += [file for file in mended if file not in fixed]
        checker = _checked(roots, paths, given)
    found = checker.findings.sorted()
    count = {severity: sum(d.severity is severity for d in found) for severity in Severity}
    if as_json:
        emit_json(_all_json(len(checker.files), count, fixed, found))
    else:
        emit("".join(_text(d) for d in found if notes or d.severity is not Severity.NOTE))
        emit("".join(f"{file}: mended\n" for file in fixed))
        emit(_summary(len(checker.files), count, notes))
    faulty = count[Severity.ERROR] or (strict and count[Severity.WARNING])
    return ExitCode.FAULTS_FOUND if faulty else ExitCode.OK


_MOST_ROUNDS = 4
"""Mending one thing may bring another to light."""


def _checked(roots: Roots, paths: tuple[str, ...], domain: Path | None) -> Checker:
    from tmd.check.checker import Checker

    checker = Checker(roots.domains, domain, roots.problems)
    for name in paths:
        checker.check(roots.path(name))
    checker.finish()
    return checker


def _mend(checker: Checker) -> list[Path]:
    """Mend the files that were checked, each written whole; the files that changed."""
    from tmd.check.fixes import FIXABLE, fix_file
    from tmd.files import write_text

    by_file: dict[Path, list[Diagnostic]] = {}
    for diagnostic in checker.findings.sorted():
        if diagnostic.code in FIXABLE:
            by_file.setdefault(Path(diagnostic.location.file), []).append(diagnostic)
    changed = []
    for file, diagnostics in sorted(by_file.items()):
        text = fix_file(file, diagnostics)
        if text is not None:
            write_text(file, text)
            changed.append(file)
    return changed


def _summary(files: int, count: Mapping[Severity, int], shown: bool) -> str:
    """How many files and problems there are; notes only where there are some."""
    errors, warnings, notes = count.values()
    said = f"{files} file(s) checked: {errors} error(s), {warnings} warning(s)"
    if notes:
        said += f", {notes} note(s)" + ("" if shown else " (--notes prints them)")
    return said + "\n"


def _all_json(
    files: int, count: Mapping[Severity, int], fixed: Sequence[Path], found: Sequence[Diagnostic]
) -> dict[str, object]:
    return {
        "files": files,
        **{f"{severity}s": number for severity, number in count.items()},
        "fixed": [str(file) for file in fixed],
        "diagnostics": [_json(diagnostic) for diagnostic in found],
    }


def _text(diagnostic: Diagnostic) -> str:
    head = f"{diagnostic.location}: {diagnostic.severity}[{diagnostic.code}]: {one_line(diagnostic.message)}"
    lines = [head]
    if diagnostic.source is not None:
        lines += pointed(diagnostic.source, diagnostic.location.column)
    if diagnostic.hint:
        lines.append(f"  hint: {one_line(diagnostic.hint)}")
    return "\n".join(lines) + "\n"


def _json(diagnostic: Diagnostic) -> dict[str, object]:
    place = diagnostic.location
    return {
        "file": place.file,
        "line": place.line,
        "column": place.column,
        "severity": str(diagnostic.severity),
        "code": diagnostic.code,
        "message": one_line(diagnostic.message),
        "hint": one_line(diagnostic.hint) if diagnostic.hint else None,
    }
