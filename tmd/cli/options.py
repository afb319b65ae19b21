"""The options that several commands share."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click
from click.core import ParameterSource

from tmd.diagnostics import TmdError
from tmd.inference.config import DEFAULT, PRESETS

if TYPE_CHECKING:
    from tmd.readers.llm.client import CacheMode, ModelSettings

VARIABLE = "TMD_LEARNED"
# Longer texts are files that were given by mistake.
MAX_CHARACTERS = 1_000_000
# Larger numbers of states and instructions are typing errors.
_MOST = 1_000_000
_MEGABYTE = 1 << 20
_Command = TypeVar("_Command", bound=Callable[..., Any])
_Decorator = Callable[[Any], Any]

PATH = click.Path(path_type=Path)
# The file that is standard input.
STANDARD = "-"


def _together(*options: _Decorator) -> Callable[[_Command], _Command]:
    """Return a decorator that adds options, in their order."""

    def decorate(command: _Command) -> _Command:
        for option in reversed(options):
            command = option(command)
        return command

    return decorate


def gathered(name: str, kind: Callable[..., object], *options: _Decorator) -> Callable[[_Command], Callable[..., Any]]:
    """Return a decorator that adds options, which the command gets as one argument ``name``, made by ``kind``."""

    def decorate(command: _Command) -> Callable[..., Any]:
        @wraps(command)
        def gathering(*args: Any, **given: Any) -> Any:  # noqa: ANN401 - what the command takes and gives
            made = kind(**{option: given.pop(option) for option in names})
            return command(*args, **{name: made}, **given)

        others = len(getattr(gathering, "__click_params__", ()))
        _together(*options)(gathering)
        names = [parameter.name for parameter in vars(gathering)["__click_params__"][others:]]
        return gathering

    return decorate


json_option = click.option("--json", "as_json", is_flag=True, help="Print JSON.")
overwrite_option = click.option(
    "--overwrite", is_flag=True, help="DIR may hold files; those of the same names are replaced."
)


def named_files(
    files: Sequence[str], environment: str | None, domain: str | None, option: str = "ENVIRONMENT"
) -> tuple[str, str | None]:
    """Return an environment or problem, and its domain, of the arguments ``[[DOMAIN] PROBLEM]`` or of the options.

    Raises:
        click.UsageError: One of them is named twice, or there is no environment.
    """
    source = click.get_current_context().get_parameter_source
    if files and source("environment") is ParameterSource.DEFAULT_MAP:
        environment = None
    if len(files) > 1 and source("domain") is ParameterSource.DEFAULT_MAP:
        domain = None
    if len(files) > 2 or (files and environment) or (len(files) == 2 and domain):
        raise click.UsageError(f"name each file once: DOMAIN PROBLEM, or --domain and {option}; quote a request")
    if files:
        environment = files[-1]
        domain = files[0] if len(files) == 2 else domain
    if environment is None:
        raise click.UsageError(f"Missing argument '{option}'.")
    return environment, domain


# The names of options that several commands have, each with other words of help.
ENVIRONMENT = ("-e", "--environment")
OUTPUT = ("-o", "--output", "--out")
_PLACE = (
    click.option(
        *ENVIRONMENT,
        metavar="FILE|NAME",
        help="An environment (YAML), or the name of a bundled one; to ground a text, also a PDDL problem.",
    ),
    click.option("--domain", metavar="NAME|FILE", help="The domain; the environment's own by default."),
)
seed_option = click.option("--seed", type=click.IntRange(0), default=0, show_default=True, help="Random seed.")
learned_option = click.option(
    "--learned",
    type=PATH,
    metavar="DIR",
    envvar=VARIABLE,
    help=f"The DIR of `tmd learn -o DIR`; ${VARIABLE}, or else learned/ beside the demonstrations, by default.",
)


@dataclass(frozen=True, slots=True)
class GivenText:
    """The options ``--text`` and ``--text-file``, and the argument ``REQUEST``."""

    text: str | None
    text_file: str | None
    argument: str | None = None

    def __bool__(self) -> bool:
        return any(given is not None for given in (self.text, self.text_file, self.argument))

    @property
    def from_input(self) -> bool:
        """Return whether the text comes from standard input."""
        return STANDARD in (self.text_file, self.argument)

    def read(self) -> str:
        """Return the text.

        Raises:
            click.UsageError: Both options are given, or none.
            TmdError: There is no text, it is too long, or it is not UTF-8.
        """
        from tmd.pddl.reading.syntax import read_standard_input, read_text

        given = [text for text in (self.text, self.text_file, self.argument) if text is not None]
        if len(given) != 1:
            raise click.UsageError("give one of REQUEST, --text and --text-file")
        place, found = "the request", given[0]
        if self.from_input:
            place, found = "standard input", read_standard_input()
        elif self.text_file is not None:
            place, found = self.text_file, read_text(Path(self.text_file))
        if not found.strip():
            raise TmdError(f"{place}: the text is empty", hint='say what is to be done: "boil some water"')
        if len(found) > MAX_CHARACTERS:
            message = f"{place}: the text has {len(found):,} characters, more than {MAX_CHARACTERS:,}"
            raise TmdError(message, hint="split it")
        try:
            found.encode("utf-8")
        except UnicodeEncodeError as error:
            raise TmdError(f"{place}: character {error.start + 1} is not UTF-8", hint="send UTF-8") from error
        return found

    def request(self) -> str:
        """Return the text, which must be short enough to be grounded.

        Raises:
            click.UsageError: As :meth:`read`.
            TmdError: As :meth:`read`, or the text has too many words.
        """
        from tmd.language.parser import short_enough

        return short_enough(self.read())


_TEXT = (
    click.option("-t", "--text", metavar="TEXT", help="The request."),
    click.option("--text-file", metavar="FILE", help="A file with the request; - is standard input."),
)
text_options = gathered("spoken", GivenText, *_TEXT)
"""``--text`` and ``--text-file``, gathered as ``spoken``."""
_REQUEST = click.argument("argument", required=False, metavar="[REQUEST]")
request_options = gathered("spoken", GivenText, _REQUEST, *_TEXT)
"""These and the argument ``REQUEST``, gathered as ``spoken``."""


@dataclass(frozen=True, slots=True)
class Asked:
    """A request, if there is one, with its environment and domain."""

    environment: str
    domain: str | None
    spoken: GivenText


def _asked(
    files: Sequence[str],
    environment: str | None,
    domain: str | None,
    text: str | None = None,
    text_file: str | None = None,
) -> Asked:
    """Return what positions and options name; without an option for the text, the last of several is the request."""
    spoken = GivenText(text, text_file)
    if files[environment is None :] and not spoken and not files[-1].endswith(".pddl"):
        *files, spoken = *files[:-1], GivenText(None, None, files[-1])
    return Asked(*named_files(files, environment, domain), spoken)


asked_options = gathered(
    "asked",
    _asked,
    click.argument("files", nargs=-1, metavar="[ENVIRONMENT|DOMAIN PROBLEM] [REQUEST]"),
    *_PLACE,
    *_TEXT,
)
"""Environment, domain and request, as positions or options, gathered as ``asked``."""
place_options = gathered("place", named_files, click.argument("files", nargs=-1, metavar="[ENVIRONMENT]"), *_PLACE)
"""Environment and domain, as positions or options, gathered as ``place``."""


def name_list(*choices: str) -> Callable[[click.Context, click.Parameter, str | None], tuple[str, ...] | None]:
    """Return a callback of an option for names with commas between them: each once, in the order given.

    Args:
        choices: The names that there are, all of which ``all`` stands for; any name if none are given.
    """

    def parse(ctx: click.Context, param: click.Parameter, value: str | None) -> tuple[str, ...] | None:
        if value is None:
            return None
        found = tuple(dict.fromkeys(name.strip() for name in value.split(",") if name.strip()))
        if not found:
            raise click.BadParameter("it names nothing", ctx, param)
        if found == ("all",) and choices:
            return choices
        for name in found if choices else ():
            if name not in choices:
                from tmd.pddl.reading.syntax import nearest

                hint = nearest(name, choices) or f"there are {', '.join(choices)}, all"
                raise click.BadParameter(f"there is no '{name}': {hint}", ctx, param)
        return found

    return parse


class _Memory(click.IntRange):
    """Megabytes, given to the command in bytes."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> int:  # noqa: ANN401
        return int(super().convert(value, param, ctx)) * _MEGABYTE


class NumberRange(click.FloatRange):
    """A number: not nan, which is below no limit."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:  # noqa: ANN401
        """Return the number."""
        found = float(super().convert(value, param, ctx))
        return found if found == found else self.fail(f"'{value}' is not a number.", param, ctx)


limit_options = _together(
    click.option(
        "--time-limit",
        "seconds",
        type=NumberRange(min=0, min_open=True),
        metavar="SECONDS",
        help="Stop the planner after this time; 300 by default.",
    ),
    click.option(
        "--memory-limit",
        "memory",
        type=_Memory(min=100, max=1 << 40),
        metavar="MB",
        help="Memory of the planner; 80 % of the machine's memory by default.",
    ),
)
"""``--time-limit`` and ``--memory-limit``; the command gets them as ``seconds`` and ``memory``, in bytes."""


def _one_robot(robot: str | None, urdf: Path | None) -> dict[str, Any]:
    if robot is not None and urdf is not None:
        raise click.UsageError("give one of --robot and --urdf")
    return {"robot": robot, "urdf": urdf}


robot_options = gathered(
    "model",
    _one_robot,
    click.option("--robot", metavar="NAME", help="The robot: pr2 (default) or tiago_pro."),
    click.option("--urdf", type=PATH, metavar="FILE", help="Another PR2 or TIAGo Pro than the packaged."),
)
"""``--robot`` and ``--urdf``, of which at most one may be given, gathered as ``model``."""


@dataclass(frozen=True, slots=True)
class ReadingOptions:
    """The options that say how requests are read; the fields are the options.

    Raises:
        click.UsageError: There are options for a language model without ``--reader llm``.
        ModelError: There is no model, or no key for a server that needs one.
    """

    reader: str = "rules"
    llm_model: str | None = None
    llm_url: str | None = None
    llm_cache: CacheMode = "on"
    verify: bool = False

    def settings(self) -> ModelSettings | None:
        """Return how the language model is reached; ``None`` where none is asked."""
        if self.reader != "llm":
            return None
        from tmd.readers.llm.client import ModelSettings

        return ModelSettings(self.llm_model, self.llm_url, cache=self.llm_cache)

    def __post_init__(self) -> None:
        given = [f.name for f in fields(self) if f.name != "reader" and getattr(self, f.name) != f.default]
        settings = self.settings()
        if settings is not None:
            settings.resolved()
        elif given:
            raise click.UsageError(f"--{given[0].replace('_', '-')} is for --reader llm")


reading_options = gathered(
    "reading",
    ReadingOptions,
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
    click.option("--verify", is_flag=True, help="Ask the language model whether the plan does what was asked."),
)
"""The options that say how a request is read, gathered as ``reading``."""

grounding_options = gathered(
    "options",
    dict,
    click.option("--top", type=click.IntRange(1, 100), default=1, show_default=True, help="How many plans to show."),
    click.option("--planner", metavar="NAME", help="in-process (default), fast-downward or up:ENGINE."),
    click.option(
        "--model",
        default=DEFAULT,
        show_default=True,
        metavar="NAME",
        help=f"The model: {', '.join(PRESETS)}; the last is the paper's as printed.",
    ),
    click.option("--guess", is_flag=True, help="Plan also for a request that is not understood or cannot be done."),
    click.option("--weights", metavar="NAME|FILE", help="The factors' weights; the model's own by default."),
    learned_option,
    click.option(
        "--beam",
        type=click.IntRange(0, _MOST),
        help=f"How many states to follow from clause to clause, {PRESETS[DEFAULT].beam} by default; 0 follows all.",
    ),
)
"""The options of ``tmd ground`` that say how, gathered as ``options``: arguments of ``answer``."""
