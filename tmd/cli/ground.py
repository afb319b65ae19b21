"""``tmd ground``: a text, in an environment, to ranked plans that PDDL vouches for."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import click

from tmd.cli.learned import learned_option
from tmd.cli.output import emit, emit_json
from tmd.cli.roots import Roots
from tmd.cli.said import said, text_options
from tmd.errors import ExitCode, TmdError

if TYPE_CHECKING:
    from tmd.energy.weights import Weights

LEARNED = "learned"
"""The weights that `tmd learn` saved."""


@click.command("ground", short_help="Ground a text in an environment: ranked, validated plans.")
@click.option(
    "--environment",
    required=True,
    metavar="FILE|NAME",
    help="An environment (YAML), a PDDL problem, or the name of a bundled environment.",
)
@text_options
@click.option("--domain", "domain_name", metavar="NAME", help="The domain; the environment's own by default.")
@click.option("--top", type=click.IntRange(1, 100), default=1, show_default=True, help="How many plans to show.")
@click.option("--planner", metavar="NAME", help="in-process (default), fast-downward or up:ENGINE.")
@click.option(
    "--model",
    "model_name",
    default="stating",
    show_default=True,
    metavar="NAME",
    help="What is minimised: stating, generating, extended, or paper, which is the paper's as printed.",
)
@click.option("--weights", metavar="NAME|FILE", help="The factors' weights; the model's own by default.")
@learned_option
@click.option(
    "--beam",
    type=click.IntRange(0),
    default=3,
    show_default=True,
    help="How many states to follow from clause to clause; 0 follows all.",
)
@click.option(
    "--trim", type=click.IntRange(0), help="How many leading instructions of a template may be dropped; any by default."
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.pass_obj
def command(
    roots: Roots,
    environment: str,
    text: str | None,
    text_file: str | None,
    domain_name: str | None,
    top: int,
    planner: str | None,
    model_name: str,
    weights: str | None,
    learned: Path | None,
    beam: int,
    trim: int | None,
    as_json: bool,
) -> ExitCode:
    """Ground what was said in an environment.

    What the words mean here is learned from the domain's demonstrations: now, or before by `tmd learn`, which saves
    the time. Ends with 12 where no plan was found.
    """
    from tmd.cli.remarks import remarks
    from tmd.cli.scene import frequent_verbs, load_scene, unknown_nouns
    from tmd.cli.show_plans import grounded_json, grounded_text
    from tmd.ground import ground, make_model
    from tmd.language.length import short_enough
    from tmd.learned.store import known
    from tmd.planning.backends import IN_PROCESS

    spoken = short_enough(said(text, text_file))
    model = make_model(model_name)
    factors = _weights(weights) if weights and weights != LEARNED else None
    corpus, world = load_scene(roots, environment, domain_name)
    knowledge = known(corpus, learned)
    if weights == LEARNED:
        factors = knowledge.weights or _no_weights(corpus.folder.name)
    grounded = ground(
        spoken,
        world,
        knowledge.library,
        factors,
        reward=knowledge.reward,
        model=model,
        planner=planner or IN_PROCESS,
        beam=beam or None,
        trim=trim,
        top=top,
    )
    library = knowledge.library
    unknown = unknown_nouns(grounded.parsed.clauses, world)
    if as_json:
        emit_json(grounded_json(grounded, corpus.folder.name, world.name, unknown))
    else:
        emit(grounded_text(grounded))
    for line in remarks(grounded, unknown, frequent_verbs(library)):
        emit(line, error=True)
    return ExitCode.OK if any(verdict.valid for verdict in grounded.verdicts) else ExitCode.NOT_GROUNDED


def _no_weights(domain: str) -> NoReturn:
    raise TmdError(
        f"there are no learned weights of '{domain}' that its demonstrations still bear out",
        hint=f"run tmd learn {domain}",
    )


def _weights(given: str) -> Weights:
    from tmd.energy.weights import named_weights, read_weights

    path = Path(given)
    return read_weights(path) if path.suffix or path.is_file() else named_weights(given)
