"""``tmd export``: a problem and its plan in the forms that other tools read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import click

from tmd.cli.errors import one_line
from tmd.cli.inputs.options import ReadingOptions, json_option, limit_options, overwrite_option, reading_options, said
from tmd.cli.output import emit, emit_json
from tmd.diagnostics import ExitCode
from tmd.world.roots import Roots

_ALL = "all"


@click.command("export", short_help="Write a problem and its plan for other tools.")
@click.argument("source", metavar="PROBLEM|ENVIRONMENT|PLAN.json|RUN")
@click.argument("directory", type=click.Path(path_type=Path), metavar="DIR")
@click.option(
    "--format",
    "formats",
    multiple=True,
    metavar="A,B|all",
    help="adl (default), ipc, strips, durative, anml, protobuf, plansys2, bt, sas, json.",
)
@click.option("--domain", metavar="NAME|FILE", help="The domain; otherwise what stands beside it or what it names.")
@click.option("--plan", type=click.Path(path_type=Path), metavar="FILE", help="Take this plan; otherwise one is found.")
@click.option("--planner", metavar="NAME", help="As for tmd plan, or for tmd ground where there is a text.")
@limit_options
@click.option("--text", metavar="TEXT", help="What was said, for an environment (YAML or PDDL).")
@click.option("--text-file", metavar="FILE", help="A file with what was said; - is standard input.")
@reading_options
@click.option(
    "--goal",
    metavar="CONDITION|asked|changed",
    help="Another goal; of a text what it asks for (the default), or all that its plan changes.",
)
@click.option("--example", metavar="ID", help="Of a run: which example.")
@click.option("--model", metavar="NAME", help="Of a run: whose prediction.")
@overwrite_option
@json_option
@click.pass_obj
def command(
    roots: Roots,
    source: str,
    directory: Path,
    formats: Sequence[str],
    domain: str | None,
    plan: Path | None,
    planner: str | None,
    seconds: float | None,
    memory: int | None,
    text: str | None,
    text_file: str | None,
    reading: ReadingOptions,
    goal: str | None,
    example: str | None,
    model: str | None,
    overwrite: bool,
    as_json: bool,
) -> ExitCode:
    """Write a problem and a plan for it into DIR.

    The source is a PDDL problem, an environment (with a text, a plan or a goal), a plan of "tmd ground --json", or the
    directory of an experiment. A plan is executed before it is written: ends with 11 where it does not work, with 10,
    12 or 20 where none is found. One format fills DIR, several a directory each. A format that fails does not keep the
    others back: why is told, and the exit code is that of the first failure.
    """
    from tmd.cli.inputs.export import ExportRequest, NoPlan, planned_source
    from tmd.export.directory import check_directory, write_directory
    from tmd.export.formats import chosen_files
    from tmd.language.parser import short_enough

    names = _chosen(formats)
    check_directory(directory, overwrite=overwrite)
    spoken = None if text is None and text_file is None else short_enough(said(text, text_file))
    request = ExportRequest(source, domain, plan, planner, spoken, goal, example, model, seconds, memory, reading)
    found = planned_source(roots, request)
    if isinstance(found, NoPlan):
        emit(f"{'invalid' if found.code is ExitCode.INVALID_PLAN else 'no plan'}: {found.reason}\n", error=True)
        if as_json:
            emit_json(_told(directory, {}, None, found.reason, {}))
        return found.code
    written = chosen_files(found, names)
    failures = written.failures
    if not written.files:
        raise next(iter(failures.values()))
    flat = {path: data for files in written.files.values() for path, data in files.items()}
    write_directory(directory, flat, overwrite=overwrite)
    if as_json:
        listed = {name: list(files) for name, files in written.files.items()}
        emit_json(_told(directory, listed, found.cost, None, {name: str(error) for name, error in failures.items()}))
    else:
        emit("".join(f"{directory / path}\n" for path in flat))
    for name, error in failures.items():
        emit(f"not written: {name}: {one_line(str(error))}\n", error=True)
    return next((error.exit_code for error in failures.values()), ExitCode.OK)


def _told(
    directory: Path, written: Mapping[str, list[str]], cost: int | None, reason: str | None, failed: Mapping[str, str]
) -> Mapping[str, object]:
    return {"directory": str(directory), "written": written, "cost": cost, "reason": reason, "failed": failed}


def _chosen(given: Sequence[str]) -> list[str]:
    """Return the names of the formats that were asked for, each once.

    Raises:
        click.UsageError: There is no such format.
    """
    from tmd.export.formats import DEFAULT, FORMATS
    from tmd.pddl.reading.syntax import nearest

    names = [name.strip() for text in given or (DEFAULT,) for name in text.split(",")]
    if names == [_ALL]:
        return list(FORMATS)
    for name in names:
        if name not in FORMATS:
            hint = nearest(name, list(FORMATS)) or f"there are {', '.join(FORMATS)}, all"
            raise click.UsageError(f"there is no format '{name}': {hint}")
    return list(dict.fromkeys(names))
