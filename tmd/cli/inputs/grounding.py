"""Grounding with the options of the command line."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tmd import __version__
from tmd.cli.inputs.options import GroundingOptions, ReadingOptions
from tmd.diagnostics import ExitCode
from tmd.inference.config import DEFAULT, PRESETS, InferenceConfig
from tmd.world.roots import Roots

if TYPE_CHECKING:
    from tmd.ground import Ask
    from tmd.grounded import Grounded
    from tmd.readers.interface import Question
    from tmd.records.grounding import GroundingRecord
    from tmd.world.corpus import Corpus


@dataclass(frozen=True, slots=True)
class Answer:
    """A grounded text, with where and how that was done.

    Attributes:
        grounded: The plans.
        corpus: The domain.
        made_with: What decides the outcome beside text and environment.
    """

    grounded: Grounded
    corpus: Corpus
    made_with: dict[str, object]

    @property
    def code(self) -> ExitCode:
        """The exit code."""
        if self.grounded.reason:
            return ExitCode.NOT_GROUNDED
        return ExitCode.OK if self.grounded.question is None else ExitCode.QUESTION

    def record(self, environment: str) -> GroundingRecord:
        """Return what ``tmd ground --json`` prints; ``environment`` is as it was given."""
        from tmd.view.grounding_record import grounding_record

        return grounding_record(
            self.grounded,
            domain=self.corpus.folder.name,
            environment_file=environment_file(environment),
            made_with=self.made_with,
        )


def answer(
    roots: Roots,
    text: str,
    environment: str,
    domain: str | None,
    options: GroundingOptions,
    reading: ReadingOptions,
    ask: Ask | None = None,
) -> Answer:
    """Ground a text in an environment.

    Raises:
        TmdError: The environment, the model, the planner or the weights are missing or wrong.
    """
    from tmd.domain_kit import DomainKit
    from tmd.planning.backends import IN_PROCESS

    corpus, world = roots.world(environment, domain)
    grounded = DomainKit(corpus, options.learned).ground(
        text,
        world,
        top=options.top,
        planner=options.planner or IN_PROCESS,
        model=options.model_name,
        guess=options.guess,
        weights=options.weights,
        beam=options.beam,
        trim=options.trim,
        reader=reading.reader,
        llm=reading.settings(),
        verify=reading.verify,
        ask=ask,
    )
    made = made_with(options.planner, options.model_name, grounded.config, options.weights, options.top)
    return Answer(grounded, corpus, made)


def environment_file(name: str) -> str | None:
    """Return the file of an environment as it was given; ``None`` for the name of a bundled one."""
    path = Path(name)
    return name if path.suffix or "/" in name or path.is_file() else None


def made_with(
    planner: str | None,
    model: str = DEFAULT,
    config: InferenceConfig = PRESETS[DEFAULT],
    weights: str | None = None,
    top: int = 1,
) -> dict[str, object]:
    """Return what decides the plans for a text, beside the text and the environment."""
    from tmd.planning.backends import IN_PROCESS

    return {
        "version": __version__,
        "model": model,
        "weights": weights or config.weights,
        "planner": planner or IN_PROCESS,
        "beam": config.beam or 0,
        "trim": config.trim,
        "top": top,
    }


def ask_on_terminal(question: Question, texts: list[str]) -> int | None:
    """Ask the user a question on standard error; ``None`` for an empty line, and where standard input ends."""
    click.echo(question.text, err=True)
    for number, text in enumerate(texts, start=1):
        click.echo(f"  {number}. {text}", err=True)
    while True:
        try:
            given = click.prompt("Number (empty: the first with a plan)", default="", show_default=False, err=True)
        except click.Abort:
            click.echo(err=True)
            return None
        if not given.strip():
            return None
        if given.strip().isdecimal() and 1 <= int(given) <= len(texts):
            return int(given) - 1
        click.echo(f"Give a number from 1 to {len(texts)}.", err=True)
