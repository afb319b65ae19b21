"""Texts grounded with the options of the command line."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click

from tmd import __version__
from tmd.cli.options import ReadingOptions
from tmd.diagnostics import ExitCode
from tmd.domain_kit import DomainKit
from tmd.export.end_goal import asked_problem
from tmd.grounded import Grounded
from tmd.inference.config import DEFAULT
from tmd.pddl.model import Problem
from tmd.pddl.writer import format_problem
from tmd.planning.backends import IN_PROCESS
from tmd.readers.interface import Question
from tmd.records.grounding import GroundingRecord
from tmd.view.grounding_record import grounding_record, option_texts
from tmd.world.corpus import Corpus, is_environment_file
from tmd.world.world import World


@dataclass(frozen=True, slots=True)
class Answer:
    """A grounded text, and the record that ``tmd ground --json`` prints."""

    grounded: Grounded
    record: GroundingRecord

    @property
    def code(self) -> ExitCode:
        """The exit code."""
        if self.grounded.reason:
            return ExitCode.NOT_GROUNDED
        return ExitCode.OK if self.grounded.question is None else ExitCode.QUESTION


def answer(
    corpus: Corpus,
    world: World,
    environment: str,
    *,
    text: str,
    reading: ReadingOptions,
    learned: Path | None = None,
    planner: str | None = None,
    **options: Any,  # noqa: ANN401 - arguments of DomainKit.ground
) -> Answer:
    """Ground a text in an environment; ``environment`` is its name or file, as it was given.

    Raises:
        TmdError: The model, the planner or the weights are missing or wrong.
    """
    grounded = DomainKit(corpus, learned).ground(
        text,
        world,
        planner=planner or IN_PROCESS,
        reader=reading.reader,
        llm=reading.settings(),
        verify=reading.verify,
        **options,
    )
    made_with = {
        "version": __version__,
        "model": options.get("model", DEFAULT),
        "weights": options.get("weights") or grounded.config.weights,
        "planner": planner or IN_PROCESS,
        "beam": grounded.config.beam or 0,
        "trim": grounded.config.trim,
        "top": options.get("top", 1),
    }
    file = environment if is_environment_file(environment) else None
    record = grounding_record(grounded, domain=corpus.folder.name, environment_file=file, made_with=made_with)
    return Answer(grounded, record)


def ask_on_terminal(problem: Problem, question: Question) -> int | None:
    """Ask the user a question on standard error; ``None`` for 0 or an empty line, and where standard input ends."""
    texts = option_texts(question, problem)
    click.echo(question.text, err=True)
    for number, text in enumerate(texts, start=1):
        click.echo(f"  {number}. {text}", err=True)
    try:
        numbers = click.IntRange(0, len(texts))
        given = click.prompt("Number (0: the first with a plan)", default=0, show_default=False, type=numbers, err=True)
    except click.Abort:
        click.echo(err=True)
        return None
    return int(given) - 1 if given else None


def whole_goal_text(grounded: Grounded) -> str:
    """Return the environment as a PDDL problem whose goal is what the text asks for; empty where there is no plan."""
    problem = asked_problem(grounded)
    return "" if problem is None else format_problem(problem)
