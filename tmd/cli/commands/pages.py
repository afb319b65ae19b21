"""``tmd view``, ``tmd studio`` and ``tmd lsp``: plans and runs in the browser, domains in an editor."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tmd.cli.options import ENVIRONMENT, OUTPUT, PATH, learned_option, named_files
from tmd.cli.output import emit
from tmd.diagnostics import ExitCode, MissingToolError, install_extra
from tmd.world.roots import Roots

if TYPE_CHECKING:
    from tmd.world.corpus import Corpus


@click.command("view", short_help="Write one HTML page of a plan or a run.")
@click.argument("paths", nargs=-1, required=True, metavar="[[DOMAIN] PROBLEM] [PLAN|RUN]")
@click.option(*ENVIRONMENT, metavar="FILE|NAME", help="Where: for a plan file, or instead of what a file names.")
@click.option("--problem", type=PATH, metavar="FILE", help="Of a plan file: its PDDL problem.")
@click.option(
    "--domain", "domain_name", metavar="NAME|FILE", help="The domain; otherwise the environment's or problem's own."
)
@click.option(*OUTPUT, "out", metavar="FILE|-", help="The page; beside what it shows by default. - is standard output.")
@click.pass_obj
def view(
    roots: Roots,
    paths: tuple[str, ...],
    environment: str | None,
    problem: Path | None,
    domain_name: str | None,
    out: str | None,
) -> ExitCode:
    """Write one HTML page: the request, its goals, the plan step by step, and the candidates.

    PLAN|RUN is what "tmd ground --json" or "tmd run --json" printed, a log of "tmd run", or a plan file (with --problem
    or --environment, or after DOMAIN and PROBLEM); - is standard input, as in "tmd ground ... --json | tmd view -". For
    DOMAIN and PROBLEM alone a plan is found. Ends with 11 where the plan does not work and with 12 where there is none;
    the page is written all the same.
    """
    from tmd.view.page import render
    from tmd.view.sources import STANDARD, ViewRequest, subject_of_file

    files = tuple(paths) if paths[-1].endswith(".pddl") else paths[:-1]
    source = paths[-1]
    if files:
        where, domain_name = named_files(files, str(problem) if problem else environment, domain_name, "--problem")
        problem = Path(where)
    found = subject_of_file(roots, ViewRequest(source, environment, domain_name, problem))
    target = out or (STANDARD if source == STANDARD else str(Path(source).with_suffix(".html")))
    for path in (source, problem, domain_name):
        if path is not None and target != STANDARD and Path(target).resolve() == Path(path).resolve():
            raise click.UsageError(f"the page would overwrite {path}: give another --output")
    page = render(found.subject)
    emit(page.html, None if target == STANDARD else Path(target))
    if target != STANDARD:
        emit(f"{target}\n")
    for line in (*found.remarks, found.complaint(page.verdict)):
        emit(line, error=True)
    return found.ending(page.verdict)


LOCAL = "127.0.0.1"


@click.command("studio", short_help="Watch plans, correct them and demonstrate, in the browser.")
@click.option(
    "--domain", "domain_name", metavar="NAME|FILE", help="The domain; that of the environment, or kitchen, by default."
)
@click.option(*ENVIRONMENT, metavar="FILE|NAME", help="The first environment; that of the domain by default.")
@click.option("--host", default=LOCAL, show_default=True, metavar="ADDRESS", help="The address to listen on.")
@click.option("--port", type=click.IntRange(0, 65535), default=8080, show_default=True, help="0 takes a free one.")
@learned_option
@click.pass_obj
def studio(
    roots: Roots, domain_name: str | None, environment: str | None, host: str, port: int, learned: Path | None
) -> ExitCode:
    """Open a studio: a page with the environment in 3D.

    Type a text and see how it is understood, which plans there are and why the others lost; step through them; point at
    objects; show how a thing is done, and save it beside the domain's demonstrations. Ctrl-C ends it.
    """
    from tmd.studio.server import Server, free_port, need_viser
    from tmd.studio.studio import Studio
    from tmd.studio.teaching import Teacher

    need_viser()
    free_port(host, port)  # before anything that takes time
    corpus, path = _opened(roots, domain_name, environment)
    emit(f"Looking at what the demonstrations of {corpus.folder.name} teach …\n", error=True)
    server = Server(Studio(corpus, Teacher(corpus, learned), path), host, port)
    try:
        emit(f"The studio of {corpus.folder.name} is open: {server.url}\n")
        emit(f"Demonstrations are saved below {corpus.directory}.\n")
        if host == LOCAL:
            forward = f"ssh -L {server.port}:{LOCAL}:{server.port} THIS-MACHINE"
            emit(f"Only who has this address can see it, from this machine. To share it: {forward}\n", error=True)
        else:
            emit(f"Whoever has this address and reaches {host} can see it and save demonstrations.\n", error=True)
        server.serve()
    finally:
        server.close()
    return ExitCode.OK


@click.command("lsp", short_help="Answer an editor: diagnostics, names and requests while typing.")
@click.pass_obj
def lsp(roots: Roots) -> ExitCode:
    """Serve an editor over standard input and output, in the Language Server Protocol.

    It reads PDDL, lexicon.yaml, objects.yaml, skills.yaml and environments. docs/editors.md has the settings of
    editors.
    """
    try:
        from tmd.editor.language_server import serve
    except ImportError as error:
        if (error.name or "").startswith("tmd"):
            raise
        raise MissingToolError("the language server needs the package pygls", hint=install_extra("editor")) from error
    if sys.stdin.isatty():
        emit("waiting for an editor on standard input; Ctrl-C ends this\n", error=True)
    serve(roots)
    return ExitCode.OK


def _opened(roots: Roots, domain: str | None, environment: str | None) -> tuple[Corpus, Path | None]:
    """Return the domain: that of the environment, unless one is named; and the environment's file."""
    if environment is None:
        return roots.corpus(roots.folder(domain or "kitchen")), None
    path = roots.environment(environment, domain)
    return roots.corpus_of(path, domain), path
