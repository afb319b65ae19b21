"""``tmd check``: everything that is wrong with the files of a domain."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from tmd.cli.faults import one_line, pointed
from tmd.cli.output import emit, emit_json
from tmd.cli.roots import Roots
from tmd.errors import ExitCode

if TYPE_CHECKING:
    from tmd.check.diagnostic import Diagnostic


@click.command("check", short_help="Find everything that is wrong with domains, problems and their files.")
@click.argument("paths", metavar="PATH...", nargs=-1, required=True)
@click.option("--domain", metavar="FILE", help="The domain of the problems; otherwise it is looked for.")
@click.option("--strict", is_flag=True, help="Let warnings count as errors.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.pass_obj
def command(roots: Roots, paths: tuple[str, ...], domain: str | None, strict: bool, as_json: bool) -> ExitCode:
    """Check files and folders, and tell every problem with its place and what to do.

    PATH is a file, a folder, or the name of a bundled domain. Ends with 0 where there are no errors, 13 otherwise.
    """
    from tmd.check.codes import Severity
    from tmd.check.run import Checker

    checker = Checker(roots.domains, roots.pddl_file(domain) if domain else None, roots.problems)
    for name in paths:
        checker.check(roots.path(name))
    checker.finish()
    found = checker.findings.sorted()
    errors = sum(d.severity is Severity.ERROR for d in found)
    warnings = len(found) - errors
    if as_json:
        emit_json(
            {
                "files": len(checker.files),
                "errors": errors,
                "warnings": warnings,
                "diagnostics": [_json(diagnostic) for diagnostic in found],
            }
        )
    else:
        emit("".join(_text(diagnostic) for diagnostic in found))
        emit(f"{len(checker.files)} file(s) checked: {errors} error(s), {warnings} warning(s)\n")
    return ExitCode.FAULTS_FOUND if errors or (strict and warnings) else ExitCode.OK


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
