"""Grounding as the command line asks for it: the options of ``tmd ground``, and what they mean."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from tmd import __version__
from tmd.cli.inputs.reading import ReadingOptions
from tmd.diagnostics import ExitCode
from tmd.inference.config import DEFAULT, PRESETS, InferenceConfig
from tmd.veil.roots import Roots

if TYPE_CHECKING:
    from tmd.ground import Ask
    from tmd.grounded import Grounded
    from tmd.records.grounding import GroundingRecord
    from tmd.veil.corpus import Corpus


VARIABLE = "TMD_LEARNED"
_Command = TypeVar("_Command", bound=Callable[..., Any])


def learned_option(command: _Command) -> _Command:
    """``--learned DIR``: where `tmd learn --out DIR` has saved."""
    return click.option(
        "--learned",
        type=click.Path(path_type=Path),
        metavar="DIR",
        envvar=VARIABLE,
        help=f"What `tmd learn --out DIR` saved; ${VARIABLE}, or else learned/ beside the demonstrations, by default.",
    )(command)


@dataclass(frozen=True, slots=True)
class GroundingOptions:
    """How a text is to be grounded; the fields are the options of ``tmd ground``."""

    top: int
    planner: str | None
    model_name: str
    guess: bool
    weights: str | None
    learned: Path | None
    beam: int | None
    trim: int | None


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
        """What ``tmd ground --json`` prints; ``environment`` is as it was given."""
        from tmd.view.grounding_record import grounding_record

        return grounding_record(
            self.grounded,
            domain=self.corpus.folder.name,
            environment_file=environment_file(environment),
            made_with=self.made_with,
        )


def grounding_options(command: _Command) -> Callable[..., Any]:
    """The options of ``tmd ground`` that say how; the command gets them as ``options``."""

    @wraps(command)
    def bundled(*args: Any, **given: Any) -> Any:  # noqa: ANN401 - what the command takes and gives
        options = GroundingOptions(**{field.name: given.pop(field.name) for field in fields(GroundingOptions)})
        return command(*args, options=options, **given)

    found: Callable[..., Any] = bundled
    for option in reversed(_OPTIONS):
        found = option(found)
    return found


_MOST = 1_000_000
"""States and instructions beyond which a number is a slip; 0 follows all states."""
_OPTIONS = (
    click.option("--top", type=click.IntRange(1, 100), default=1, show_default=True, help="How many plans to show."),
    click.option("--planner", metavar="NAME", help="in-process (default), fast-downward or up:ENGINE."),
    click.option(
        "--model",
        "model_name",
        default=DEFAULT,
        show_default=True,
        metavar="NAME",
        help=f"What is minimised: {', '.join(PRESETS)}; the last is the paper's as printed.",
    ),
    click.option("--guess", is_flag=True, help="Plan even where what was said is not understood or cannot be done."),
    click.option("--weights", metavar="NAME|FILE", help="The factors' weights; the model's own by default."),
    learned_option,
    click.option(
        "--beam",
        type=click.IntRange(0, _MOST),
        help=f"How many states to follow from clause to clause, {PRESETS[DEFAULT].beam} by default; 0 follows all.",
    ),
    click.option(
        "--trim",
        type=click.IntRange(0, _MOST),
        help="How many leading instructions of a template may be dropped; any by default.",
    ),
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
    """The file of an environment as it was given; ``None`` for the name of a bundled one."""
    path = Path(name)
    return name if path.suffix or "/" in name or path.is_file() else None


def made_with(
    planner: str | None,
    model: str = DEFAULT,
    config: InferenceConfig = PRESETS[DEFAULT],
    weights: str | None = None,
    top: int = 1,
) -> dict[str, object]:
    """What decides the plans for a text, beside the text and the environment."""
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
