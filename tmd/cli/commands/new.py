"""``tmd new``: a new domain that works, to be changed into one's own."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from tmd.cli.inputs.options import json_option
from tmd.cli.output import emit, emit_json
from tmd.diagnostics import ExitCode
from tmd.world.roots import Roots

if TYPE_CHECKING:
    from tmd.world.scaffold import Scaffold


@click.command("new", short_help="Begin a domain of your own: a small one that works.")
@click.argument("domain", metavar="DOMAIN")
@click.option(
    "--from",
    "start",
    default="graph",
    show_default=True,
    metavar="plain|graph",
    help="Begin with plain PDDL, or with classes of things that have parts.",
)
@json_option
@click.pass_obj
def command(roots: Roots, domain: str, start: str, as_json: bool) -> ExitCode:
    """Begin the domain DOMAIN.

    Writes domains/DOMAIN and problems/DOMAIN here (--domains and --problems say where else): a domain with a lexicon,
    two environments, a problem, three demonstrations and three sentence tests. Nothing is overwritten.
    """
    from tmd.world.scaffold import scaffold

    made = scaffold(domain, start, roots.domains or Path("domains"), roots.problems or Path("problems"))
    if as_json:
        emit_json({"domain": domain, "from": start, "files": [path.as_posix() for path in made.files]})
    else:
        emit(_text(domain, start, made))
    return ExitCode.OK


def _text(domain: str, start: str, made: Scaffold) -> str:
    place = made.environments[-1]
    said = "Put the red block on the green block." if start == "plain" else "Put the key on the table."
    problem = next(path for path in made.files if path.suffix == ".pddl" and path.parent == made.problems)
    compiled = [f"  tmd compile {domain}"] if start == "graph" else []
    lines = [
        *(path.as_posix() for path in made.files),
        "",
        "try next:",
        *compiled,
        f"  tmd check {made.folder.as_posix()} {made.problems.as_posix()}",
        f"  tmd plan {domain} {problem.as_posix()}",
        f'  tmd ground --environment {place} --text "{said}"',
        f"  tmd test {domain}",
        f"  tmd learn {domain}",
    ]
    return "\n".join(lines) + "\n"
