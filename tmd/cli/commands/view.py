"""``tmd view``: one HTML page of a plan, a run or a demonstration."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click
from click.core import ParameterSource

from tmd.cli.inputs.options import (
    GroundingOptions,
    ReadingOptions,
    grounding_options,
    reading_options,
    said,
    text_options,
)
from tmd.cli.output import emit
from tmd.diagnostics import ExitCode
from tmd.world.roots import Roots

if TYPE_CHECKING:
    from tmd.view.sources import FoundSubject

_OF_GROUNDING = ("top", "planner", "model_name", "weights", "beam", "trim", "reader", "llm_model", "llm_url", "verify")


@click.command("view", short_help="Write one HTML page of a plan, a run or a demonstration.")
@click.argument("source", required=False, metavar="[PLAN|RUN]")
@click.option(
    "--environment", metavar="FILE|NAME", help="Where: for a text, for a plan file, or instead of what a file names."
)
@text_options
@click.option("--problem", type=click.Path(path_type=Path), metavar="FILE", help="Of a plan file: its PDDL problem.")
@click.option(
    "--domain", "domain_name", metavar="NAME|FILE", help="The domain; otherwise the environment's or problem's own."
)
@click.option("--id", "demonstration", metavar="ID", help="Of a file of demonstrations: which one.")
@click.option(
    "--strip",
    type=click.Path(path_type=Path),
    metavar="FILE.png",
    help="Of a run: its filmstrip; beside the log if not.",
)
@click.option("--out", metavar="FILE|-", help="The page; beside what it shows by default. - is standard output.")
@grounding_options
@reading_options
@click.pass_context
def command(
    ctx: click.Context,
    source: str | None,
    environment: str | None,
    text: str | None,
    text_file: str | None,
    problem: Path | None,
    domain_name: str | None,
    demonstration: str | None,
    strip: Path | None,
    out: str | None,
    options: GroundingOptions,
    reading: ReadingOptions,
) -> ExitCode:
    """Write one HTML page: what was said, what it means here, the plan step by step, and the candidates.

    PLAN|RUN is what "tmd ground --json" or "tmd run --json" printed, a log of "tmd run", a plan file (with --problem or
    --environment), or a file of demonstrations (with --id); - is standard input. Without it a text is grounded as by
    "tmd ground". Ends with 11 where the plan does not work and with 12 where there is none; the page is written anyhow.
    """
    roots: Roots = ctx.obj
    given = [name for name in _OF_GROUNDING if ctx.get_parameter_source(name) is ParameterSource.COMMANDLINE]
    if source is not None and (given or text is not None or text_file is not None):
        raise click.UsageError("a text, and how it is grounded, are for --environment without PLAN|RUN")
    if source is None and (environment is None or (problem, demonstration, strip) != (None, None, None)):
        raise click.UsageError("give PLAN|RUN, or --environment and --text")

    from tmd.files import write_text
    from tmd.language.parser import short_enough
    from tmd.view.page import render
    from tmd.view.sources import STANDARD, ViewRequest, subject_of_file

    if source is None:
        spoken = short_enough(said(text, text_file))
        found = _subject_of_text(roots, spoken, environment or "", domain_name, options, reading)
    else:
        found = subject_of_file(roots, ViewRequest(source, environment, domain_name, problem, demonstration, strip))
    target = out or (STANDARD if source == STANDARD else str(found.beside))
    _refuse_to_overwrite(target, source, problem, strip)
    page = render(found.subject)
    if target == STANDARD:
        emit(page.html)
    else:
        write_text(target, page.html)
        emit(f"{target}\n")
    for line in (*found.remarks, found.complaint(page.verdict)):
        emit(line, error=True)
    return found.ending(page.verdict)


def _subject_of_text(
    roots: Roots,
    text: str,
    environment: str,
    domain: str | None,
    options: GroundingOptions,
    reading: ReadingOptions,
) -> FoundSubject:
    """Ground a text now.

    Raises:
        TmdError: The environment, or how it is to be grounded, is wrong.
    """
    from tmd.cli.inputs.grounding import answer
    from tmd.cli.show.grounding import remarks
    from tmd.view.sources import FoundSubject, made_rows
    from tmd.view.subject import text_subject

    found = answer(roots, text, environment, domain, options, reading)
    rows = made_rows({**found.made_with, "domain": found.corpus.folder.name, "environment": environment})
    told = tuple(remarks(found.grounded))
    return FoundSubject(
        text_subject(found.grounded, rows),
        Path(f"{found.grounded.world.name}.html"),
        told,
        of_text=True,
        asks=found.grounded.question is not None,
    )


def _refuse_to_overwrite(target: str, *shown: str | Path | None) -> None:
    """Refuse to write a page over a file that it shows."""
    for path in shown:
        if path is not None and target != "-" and Path(target).resolve() == Path(path).resolve():
            raise click.UsageError(f"the page would overwrite {path}: give another --out")
