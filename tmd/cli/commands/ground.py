"""``tmd ground``: a text, in an environment, to ranked plans that PDDL vouches for."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from tmd.cli.inputs.grounding import answer, ask_on_terminal
from tmd.cli.inputs.options import (
    GroundingOptions,
    ReadingOptions,
    environment_domain_option,
    grounding_options,
    json_option,
    reading_options,
    said,
    text_options,
)
from tmd.cli.output import emit, emit_json
from tmd.diagnostics import ExitCode
from tmd.world.roots import Roots

if TYPE_CHECKING:
    from tmd.ground import Ask
    from tmd.readers.interface import Question


@click.command("ground", short_help="Ground a text in an environment: ranked, validated plans.")
@click.option(
    "--environment",
    required=True,
    metavar="FILE|NAME",
    help="An environment (YAML), a PDDL problem, or the name of a bundled environment.",
)
@text_options
@environment_domain_option
@grounding_options
@reading_options
@click.option("--ask", is_flag=True, help="Ask on the terminal which of several readings is meant.")
@click.option("--verbose", is_flag=True, help="Print tokens, seconds, corrections and reasons of the language model.")
@click.option("--show-prompt", is_flag=True, help="Print the prompt for the language model, and send nothing.")
@click.option("--goal-only", is_flag=True, help="Print what shall hold at the end as a PDDL problem, and no plan.")
@json_option
@click.pass_obj
def command(
    roots: Roots,
    environment: str,
    text: str | None,
    text_file: str | None,
    domain_name: str | None,
    options: GroundingOptions,
    reading: ReadingOptions,
    ask: bool,
    verbose: bool,
    show_prompt: bool,
    goal_only: bool,
    as_json: bool,
) -> ExitCode:
    """Ground what was said in an environment.

    What the words mean here is learned from the domain's demonstrations: now, or before by `tmd learn`, which saves
    the time. Ends with 12 where no plan was found, and with 15 where two readings of the request differ and nobody said
    which one is meant; the plan is then for the first one that has a plan.
    """
    from tmd.cli.show.grounding import grounded_text, remarks, whole_goal_text
    from tmd.inference.config import preset
    from tmd.language.parser import short_enough

    if goal_only and not preset(options.model_name).goals:
        raise click.UsageError(f"the model {options.model_name} knows no goals: leave --model out")
    if ask and text_file == "-":
        raise click.UsageError("--ask reads answers from standard input, so the text cannot come from there")
    request = short_enough(said(text, text_file))
    if show_prompt:
        emit(_prompt(roots, request, environment, domain_name, reading))
        return ExitCode.OK
    asking = _asking(roots, environment, domain_name) if ask else None
    found = answer(roots, request, environment, domain_name, options, reading, asking)
    grounded = found.grounded
    if as_json:
        record = found.record(environment)
        emit_json((record.goal_only() if goal_only else record).to_value())
    else:
        emit(whole_goal_text(grounded) if goal_only else grounded_text(grounded))
    for line in remarks(grounded, verbose=verbose):
        emit(line, error=True)
    return found.code


def _prompt(roots: Roots, request: str, environment: str, domain: str | None, reading: ReadingOptions) -> str:
    """Return the messages that the language model would be sent first."""
    from tmd.readers.llm.reader import llm_reader

    settings = reading.settings()
    if settings is None:
        raise click.UsageError("--show-prompt is for --reader llm")
    corpus, world = roots.world(environment, domain)
    prompt = llm_reader(corpus, settings).prompt(request, world, world.task.init)
    return f"{prompt.system}\n\n{prompt.user}\n"


def _asking(roots: Roots, environment: str, domain: str | None) -> Ask:
    """Return a function that asks the user a question on the terminal."""
    from tmd.view.grounding_record import option_texts

    _, world = roots.world(environment, domain)

    def ask(question: Question) -> int | None:
        return ask_on_terminal(question, option_texts(question, world.task.problem))

    return ask
