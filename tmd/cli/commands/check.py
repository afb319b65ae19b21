"""``tmd check``: everything that is wrong with the files of a domain."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from tmd.cli.errors import one_line, pointed
from tmd.cli.inputs.options import json_option
from tmd.cli.output import emit, emit_json
from tmd.diagnostics import ExitCode
from tmd.world.roots import Roots

if TYPE_CHECKING:
    from tmd.check.diagnostic import Diagnostic
    from tmd.check.report import CheckReport


@click.command("check", short_help="Find everything that is wrong with domains, problems and their files.")
@click.argument("paths", metavar="PATH...", nargs=-1)
@click.option("--domain", metavar="FILE", help="The domain of the problems; otherwise it is looked for.")
@click.option("--strict", is_flag=True, help="Treat warnings as errors.")
@click.option("--notes", is_flag=True, help="Print notes as well.")
@click.option("--fix", is_flag=True, help="Apply safe fixes, then check again.")
@click.option("--explain", metavar="VERB", help="Print all that is known of a verb, in the domains that are named.")
@json_option
@click.pass_obj
def command(
    roots: Roots,
    paths: tuple[str, ...],
    domain: str | None,
    strict: bool,
    notes: bool,
    fix: bool,
    explain: str | None,
    as_json: bool,
) -> ExitCode:
    """Check files and folders, and tell every problem with its place and what to do.

    PATH is a file, a folder, or the name of a bundled domain. Ends with 0 where there are no errors, 13 otherwise.
    With --explain nothing is checked; PATH is then the name of a domain, and may be missing.
    """
    if explain is not None:
        if any((domain, strict, notes, fix)):
            raise click.UsageError("--explain takes domains and --json only")
        return _explain(roots, explain, paths, as_json)
    if not paths:
        raise click.UsageError("Missing argument 'PATH...'.")
    given = roots.pddl_file(domain) if domain else None
    chosen = [roots.path(path) for path in paths]
    from tmd.check.report import check_paths

    report = check_paths(chosen, domain=given, domains=roots.domains, problems=roots.problems, fix=fix)
    return _told(report, strict=strict, notes=notes, as_json=as_json)


def _told(report: CheckReport, *, strict: bool, notes: bool, as_json: bool) -> ExitCode:
    """Print what was found; return how the program ends."""
    from tmd.check.diagnostic import Severity

    shown = [d for d in report.diagnostics if notes or d.severity is not Severity.NOTE]
    if as_json:
        emit_json(_all_json(report))
    else:
        emit("".join(map(_text, shown)))
        emit("".join(f"{file}: fixed\n" for file in report.fixed))
        emit(_summary(report, notes))
    count = report.counts
    faulty = count[Severity.ERROR] or (strict and count[Severity.WARNING])
    return ExitCode.FAULTS_FOUND if faulty else ExitCode.OK


def _explain(roots: Roots, verb: str, names: Sequence[str], as_json: bool) -> ExitCode:
    """Print what is known of a verb, in English and in each of the domains."""
    from tmd.check.explain import explain, explanation_text

    found = explain(verb, [roots.corpus(roots.folder(name)) for name in names])
    if as_json:
        emit_json(found.to_value())
    else:
        emit(explanation_text(found))
    return ExitCode.OK


def _summary(report: CheckReport, shown: bool) -> str:
    """Return the numbers of files and problems; notes only where there are some."""
    errors, warnings, notes = report.counts.values()
    said = f"{len(report.files)} file(s) checked: {errors} error(s), {warnings} warning(s)"
    if notes:
        said += f", {notes} note(s)" + ("" if shown else " (--notes prints them)")
    return said + "\n"


def _all_json(report: CheckReport) -> dict[str, object]:
    return {
        "files": len(report.files),
        **{f"{severity}s": number for severity, number in report.counts.items()},
        "fixed": [str(file) for file in report.fixed],
        "diagnostics": [_json(diagnostic) for diagnostic in report.diagnostics],
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
