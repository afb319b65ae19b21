"""The options that say how a request is read: by rules or by a language model."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import wraps
from typing import TYPE_CHECKING, Any, TypeVar

import click

if TYPE_CHECKING:
    from tmd.readers.interface import Question
    from tmd.readers.llm.client import CacheMode, ModelSettings

_Command = TypeVar("_Command", bound=Callable[..., Any])


@dataclass(frozen=True, slots=True)
class ReadingOptions:
    """How requests are read; the fields are options."""

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

    def check(self) -> None:
        """Refuse options of a language model where none is asked, and settings with which none can be.

        Raises:
            click.UsageError: There are options for a language model without ``--reader llm``.
            ModelError: There is no model, or no key for a server that needs one.
        """
        given = [f.name for f in fields(self) if f.name != "reader" and getattr(self, f.name) != f.default]
        if self.reader != "llm" and given:
            raise click.UsageError(f"--{given[0].replace('_', '-')} is for --reader llm")
        if self.reader == "llm":
            self.model_settings().resolved()


_OPTIONS = (
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
    """The options that say how a request is read; the command gets them as ``reading``."""

    @wraps(command)
    def bundled(*args: Any, **given: Any) -> Any:  # noqa: ANN401 - what the command takes and gives
        reading = ReadingOptions(**{field.name: given.pop(field.name) for field in fields(ReadingOptions)})
        if given.get("compare"):  # it asks a language model whatever --reader says
            reading.model_settings().resolved()
        else:
            reading.check()
        return command(*args, reading=reading, **given)

    found: Callable[..., Any] = bundled
    for option in reversed(_OPTIONS):
        found = option(found)
    return found


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
