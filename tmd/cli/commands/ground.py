"""``tmd ground``: a text, in an environment, to ranked plans that PDDL vouches for."""

from __future__ import annotations

import click

from tmd.cli.inputs.grounding import GroundingOptions, answer, grounding_options
from tmd.cli.inputs.text import said, text_options
from tmd.cli.output import emit, emit_json
from tmd.diagnostics import ExitCode
from tmd.veil.roots import Roots


@click.command("ground", short_help="Ground a text in an environment: ranked, validated plans.")
@click.option(
    "--environment",
    required=True,
    metavar="FILE|NAME",
    help="An environment (YAML), a PDDL problem, or the name of a bundled environment.",
)
@text_options
@click.option("--domain", "domain_name", metavar="NAME", help="The domain; the environment's own by default.")
@grounding_options
@click.option("--goal-only", is_flag=True, help="Print what shall hold at the end as a PDDL problem, and no plan.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.pass_obj
def command(
    roots: Roots,
    environment: str,
    text: str | None,
    text_file: str | None,
    domain_name: str | None,
    options: GroundingOptions,
    goal_only: bool,
    as_json: bool,
) -> ExitCode:
    """Ground what was said in an environment.

    What the words mean here is learned from the domain's demonstrations: now, or before by `tmd learn`, which saves
    the time. Ends with 12 where no plan was found.
    """
    from tmd.cli.show.grounding import grounded_text, remarks, whole_goal_text
    from tmd.inference.config import preset
    from tmd.language.parser import short_enough

    if goal_only and not preset(options.model_name).goals:
        raise click.UsageError(f"the model {options.model_name} knows no goals: leave --model out")
    found = answer(roots, short_enough(said(text, text_file)), environment, domain_name, options)
    grounded = found.grounded
    if as_json:
        record = found.record(environment)
        emit_json((record.goal_only() if goal_only else record).to_value())
    else:
        emit(whole_goal_text(grounded) if goal_only else grounded_text(grounded))
    for line in remarks(grounded):
        emit(line, error=True)
    return ExitCode.NOT_GROUNDED if grounded.reason else ExitCode.OK
