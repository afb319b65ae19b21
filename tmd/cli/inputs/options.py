"""The options that several commands share."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from tmd.diagnostics import TmdError
from tmd.inference.config import DEFAULT, PRESETS

if TYPE_CHECKING:
    from tmd.readers.llm.client import CacheMode, ModelSettings

VARIABLE = "TMD_LEARNED"
# nobody says that much
MAX_CHARACTERS = 1_000_000
# states and instructions beyond which a number is a slip
_MOST = 1_000_000
_MEGABYTE = 1 << 20
_Command = TypeVar("_Command", bound=Callable[..., Any])
_Decorator = Callable[[Any], Any]


def _with(options: Sequence[_Decorator], command: _Command) -> _Command:
    """Return a command with options, in their order."""
    for option in reversed(options):
        command = option(command)
    return command


def _bundled(kind: type[Any], name: str, options: Sequence[_Decorator], command: _Command) -> Callable[..., Any]:
    """Return a command with options, which it gets as one argument: a ``kind``, whose fields they are."""

    @wraps(command)
    def bundled(*args: Any, **given: Any) -> Any:  # noqa: ANN401 - what the command takes and gives
        made = kind(**{field.name: given.pop(field.name) for field in fields(kind)})
        if kind is ReadingOptions:
            made.check(compare=bool(given.get("compare")))
        return command(*args, **{name: made}, **given)

    return _with(options, bundled)


json_option = click.option("--json", "as_json", is_flag=True, help="Print JSON.")
overwrite_option = click.option(
    "--overwrite", is_flag=True, help="DIR may hold files; those of the same names are replaced."
)
environment_domain_option = click.option(
    "--domain", "domain_name", metavar="NAME", help="The domain; the environment's own by default."
)
learned_option = click.option(
    "--learned",
    type=click.Path(path_type=Path),
    metavar="DIR",
    envvar=VARIABLE,
    help=f"What `tmd learn --out DIR` saved; ${VARIABLE}, or else learned/ beside the demonstrations, by default.",
)


def text_options(command: _Command) -> _Command:
    """Add ``--text`` and ``--text-file``, of which one is to be given (:func:`said`)."""
    options = (
        click.option("--text", metavar="TEXT", help="What was said."),
        click.option("--text-file", metavar="FILE", help="A file with what was said; - is standard input."),
    )
    return _with(options, command)


def said(text: str | None, file: str | None) -> str:
    """Return the text of :func:`text_options`.

    Raises:
        click.UsageError: Both options are given, or none.
        TmdError: There is no text, it is too long, or it is not UTF-8.
    """
    from tmd.pddl.reading.syntax import read_standard_input, read_text

    if (text is None) == (file is None):
        raise click.UsageError("give one of --text and --text-file")
    place = "--text" if file is None else "standard input" if file == "-" else file
    if file is not None:
        text = read_standard_input() if file == "-" else read_text(Path(file))
    found = text or ""
    if not found.strip():
        raise TmdError(f"{place}: the text is empty", hint='say what is to be done: --text "boil some water"')
    if len(found) > MAX_CHARACTERS:
        message = f"{place}: the text has {len(found):,} characters, more than {MAX_CHARACTERS:,}"
        raise TmdError(message, hint="split it")
    try:
        found.encode("utf-8")
    except UnicodeEncodeError as error:
        raise TmdError(f"{place}: character {error.start + 1} is not UTF-8", hint="send UTF-8") from error
    return found


class _Memory(click.IntRange):
    """Megabytes, given to the command in bytes."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> int:  # noqa: ANN401
        return int(super().convert(value, param, ctx)) * _MEGABYTE


class _Seconds(click.FloatRange):
    """A time that can pass: not nan, which is below no limit."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:  # noqa: ANN401
        found = float(super().convert(value, param, ctx))
        return found if found == found else self.fail(f"'{value}' is no time.", param, ctx)


def limit_options(command: _Command) -> _Command:
    """Add ``--time-limit`` and ``--memory-limit``; the command gets them as ``seconds`` and ``memory``, in bytes."""
    options = (
        click.option(
            "--time-limit",
            "seconds",
            type=_Seconds(min=0, min_open=True),
            metavar="SECONDS",
            help="Stop the planner after this time; 300 by default.",
        ),
        click.option(
            "--memory-limit",
            "memory",
            type=_Memory(min=100, max=1 << 40),
            metavar="MB",
            help="What the planner may take; 80 % of the machine's memory by default.",
        ),
    )
    return _with(options, command)


def robot_options(command: _Command) -> Callable[..., Any]:
    """Add ``--robot`` and ``--urdf``, of which at most one may be given."""

    @wraps(command)
    def checked(*args: Any, **given: Any) -> Any:  # noqa: ANN401 - what the command takes and gives
        if given["robot"] is not None and given["urdf"] is not None:
            raise click.UsageError("give one of --robot and --urdf")
        return command(*args, **given)

    options = (
        click.option("--robot", metavar="NAME", help="The robot: pr2 (default) or tiago_pro."),
        click.option(
            "--urdf",
            type=click.Path(path_type=Path),
            metavar="FILE",
            help="Another PR2 or TIAGo Pro than the packaged.",
        ),
    )
    return _with(options, checked)


@dataclass(frozen=True, slots=True)
class ReadingOptions:
    """The options that say how requests are read; the fields are the options."""

    reader: str = "rules"
    llm_model: str | None = None
    llm_url: str | None = None
    llm_cache: CacheMode = "on"
    llm_timeout: float = 600.0
    verify: bool = False

    def settings(self) -> ModelSettings | None:
        """Return how the language model is reached; ``None`` where none is asked."""
        return self.model_settings() if self.reader == "llm" else None

    def model_settings(self) -> ModelSettings:
        """Return how the language model is reached, whatever the reader is."""
        from tmd.readers.llm.client import ModelSettings

        return ModelSettings(self.llm_model, self.llm_url, cache=self.llm_cache, timeout=self.llm_timeout)

    def check(self, *, compare: bool = False) -> None:
        """Refuse options of a language model where none is asked, and settings with which none can be.

        Args:
            compare: Whether a language model is asked whatever the reader is.

        Raises:
            click.UsageError: There are options for a language model without ``--reader llm``.
            ModelError: There is no model, or no key for a server that needs one.
        """
        given = [f.name for f in fields(self) if f.name != "reader" and getattr(self, f.name) != f.default]
        if compare or self.reader == "llm":
            self.model_settings().resolved()
        elif given:
            raise click.UsageError(f"--{given[0].replace('_', '-')} is for --reader llm")


_READING = (
    click.option(
        "--reader",
        type=click.Choice(["rules", "llm"]),
        default="rules",
        show_default=True,
        help="Read requests by grammar and lexicon, or with a language model.",
    ),
    click.option("--llm-model", metavar="NAME", help="The language model; $OPENAI_MODEL by default."),
    click.option("--llm-url", metavar="URL", help="Its server; $OPENAI_BASE_URL, or else OpenAI's, by default."),
    click.option(
        "--llm-cache",
        type=click.Choice(["on", "off", "only"]),
        default="on",
        show_default=True,
        help="Use replies that were kept; 'only' never asks the server.",
    ),
    click.option(
        "--llm-timeout",
        type=click.FloatRange(0.1, 86_400),
        default=600.0,
        show_default=True,
        metavar="SECONDS",
        help="How long to wait for a reply.",
    ),
    click.option("--verify", is_flag=True, help="Ask the language model whether the plan does what was asked."),
)


def reading_options(command: _Command) -> Callable[..., Any]:
    """Add the options that say how a request is read; the command gets them as ``reading``."""
    return _bundled(ReadingOptions, "reading", _READING, command)


@dataclass(frozen=True, slots=True)
class GroundingOptions:
    """The options that say how a text is grounded; the fields are the options of ``tmd ground``."""

    top: int
    planner: str | None
    model_name: str
    guess: bool
    weights: str | None
    learned: Path | None
    beam: int | None
    trim: int | None


_GROUNDING = (
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


def grounding_options(command: _Command) -> Callable[..., Any]:
    """Add the options of ``tmd ground`` that say how; the command gets them as ``options``."""
    return _bundled(GroundingOptions, "options", _GROUNDING, command)
