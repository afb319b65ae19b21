"""Grounding as the command line asks for it: the options of ``tmd ground``, and what they mean."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

import click

from tmd import __version__
from tmd.cli.inputs.learned import learned_option
from tmd.diagnostics import TmdError
from tmd.inference.config import DEFAULT, PRESETS, InferenceConfig, preset
from tmd.veil.roots import Roots

if TYPE_CHECKING:
    from tmd.grounded import Grounded
    from tmd.inference.energy import Weights
    from tmd.veil.corpus import Corpus
    from tmd.veil.world import World

LEARNED = "learned"
"""The weights that `tmd learn` saved."""
_Command = TypeVar("_Command", bound=Callable[..., Any])


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

    def config(self) -> InferenceConfig:
        """The model, with what is to be otherwise.

        Raises:
            TmdError: There is none of that name.
        """
        model = preset(self.model_name)
        beam = model.beam if self.beam is None else self.beam or None
        trim = model.trim if self.trim is None else self.trim
        return replace(model, beam=beam, trim=trim, guess=self.guess)


@dataclass(frozen=True, slots=True)
class Answer:
    """A grounded text, with where and how that was done.

    Attributes:
        grounded: The plans.
        corpus: The domain.
        world: The environment.
        made_with: What decides the outcome beside text and environment.
    """

    grounded: Grounded
    corpus: Corpus
    world: World
    made_with: dict[str, object]


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
        type=click.IntRange(0),
        help=f"How many states to follow from clause to clause, {PRESETS[DEFAULT].beam} by default; 0 follows all.",
    ),
    click.option(
        "--trim",
        type=click.IntRange(0),
        help="How many leading instructions of a template may be dropped; any by default.",
    ),
)


def answer(roots: Roots, text: str, environment: str, domain: str | None, options: GroundingOptions) -> Answer:
    """Ground a text in an environment.

    Raises:
        TmdError: The environment, the model, the planner or the weights are missing or wrong.
    """
    from tmd.ground import ground
    from tmd.inference.learned.store import known
    from tmd.planning.backends import IN_PROCESS

    config = options.config()
    factors = _weights(options.weights) if options.weights and options.weights != LEARNED else None
    corpus, world = roots.world(environment, domain)
    knowledge = known(corpus, options.learned)
    if options.weights == LEARNED:
        factors = knowledge.weights or _no_weights(corpus.folder.name)
    grounded = ground(
        text,
        world,
        knowledge.library,
        factors,
        reward=knowledge.reward,
        goals=knowledge.goals,
        config=config,
        planner=options.planner or IN_PROCESS,
        top=options.top,
    )
    made = made_with(options.planner, options.model_name, config, options.weights, options.top)
    return Answer(grounded, corpus, world, made)


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


def _no_weights(domain: str) -> NoReturn:
    raise TmdError(
        f"there are no learned weights of '{domain}' that its demonstrations still bear out",
        hint=f"run tmd learn {domain}",
    )


def _weights(given: str) -> Weights:
    from tmd.inference.energy import named_weights, read_weights

    path = Path(given)
    return read_weights(path) if path.suffix or path.is_file() else named_weights(given)
