"""The ``tmd`` command: its global options, its sub-commands, and how every run of it ends."""

from __future__ import annotations

import os
import signal
import sys
import traceback
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import reduce
from importlib import import_module
from pathlib import Path
from typing import Any

import click

from tmd import __version__
from tmd.cli.errors import Fault, fault_of
from tmd.cli.options import PATH
from tmd.cli.output import emit
from tmd.diagnostics import ExitCode, OptionError
from tmd.pddl.reading.syntax import nearest, read_text
from tmd.world.roots import Roots

_MODULES = {
    "ground": "requests",
    "run": "robot",
    "view": "pages",
    "scene": "robot",
    "studio": "pages",
    "list": "domain",
    "new": "domain",
    "test": "requests",
    "learn": "domain",
    "check": "domain",
    "fmt": "domain",
    "lsp": "pages",
    "parse": "requests",
    "validate": "planning",
    "plan": "planning",
    "export": "planning",
    "compile": "domain",
    "experiment": "experiment",
}
"""The module below :mod:`tmd.cli.commands` that has each sub-command."""
COMMANDS = tuple(_MODULES)
"""The sub-commands, in the order in which a newcomer meets them."""
_FUNCTIONS = {"list": "list_domains"}
"""Functions that cannot have the name of their command, because it is one of Python's own."""
_COMPLETION = "_TMD_COMPLETE"
"""The variable by which a shell asks click for completions."""
_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class _Commands(click.Group):
    """A group that imports a sub-command when it is asked for."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in COMMANDS:
            return None
        module = import_module(f"tmd.cli.commands.{_MODULES[cmd_name]}")
        command = getattr(module, _FUNCTIONS.get(cmd_name, cmd_name))
        assert isinstance(command, click.Command)
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        if not args[0].startswith("-") and args[0] not in COMMANDS:
            near = nearest(args[0], COMMANDS)
            raise click.UsageError(f"there is no command '{args[0]}'" + (f": {near}" if near else ""), ctx)
        return super().resolve_command(ctx, args)


@click.group(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.option("--domains", type=PATH, metavar="DIR", help="The directory of all domains.")
@click.option("--problems", type=PATH, metavar="DIR", help="The directory of all problems.")
@click.option("--debug", is_flag=True, help="Show where an internal error happened.")
@click.version_option(__version__, "-V", "--version", prog_name="tmd", message="%(prog)s %(version)s")
@click.pass_context
def program(ctx: click.Context, domains: Path | None, problems: Path | None, debug: bool) -> None:
    """Turn requests in English into PDDL goals and validated robot plans.

    The directories are looked for in this order: the option, ./domains and ./problems, the packaged copy.
    Defaults of options may stand in ./tmd.toml, or below [tool.tmd] in ./pyproject.toml.
    """
    ctx.obj = Roots(domains, problems)


def _settings() -> dict[str, Any]:
    """Return the table of settings in the working directory as click takes defaults; empty where there is none.

    Raises:
        OptionError: It is not TOML, or not a table of options.
    """
    for name, *keys in ("tmd.toml",), ("pyproject.toml", "tool", "tmd"):
        if Path(name).is_file():
            from tomllib import TOMLDecodeError, loads

            try:
                table = reduce(lambda found, key: found.get(key, {}), keys, loads(read_text(name)))
                if table:
                    return _defaults(table, program, name)
            except (TOMLDecodeError, AttributeError) as error:
                why = str(error) if isinstance(error, TOMLDecodeError) else "one value stands for a table"
                raise OptionError(f"{name} is no table of settings: {why}", hint="docs/cli.md shows one") from error
    return {}


def _defaults(table: dict[str, Any], command: click.Command, place: str) -> dict[str, Any]:
    """Return the settings of a command by the names of its parameters, and those of its sub-commands."""
    found: dict[str, Any] = {}
    given = (p for p in command.params if isinstance(p, click.Option) and not (p.is_flag and command is program))
    options = {name[2:]: option for option in given for name in option.opts if name.startswith("--")}
    for name, value in table.items():
        option, inner = options.get(name), command is program and program.get_command(click.Context(program), name)
        if inner:
            found[name] = _defaults(value, inner, f"{place}: {name}")
        elif option is None:
            known = [*options, *(COMMANDS if command is program else ())]
            raise OptionError(f"{place}: there is no option '{name}'", hint=nearest(name, known, what="options"))
        else:
            found[str(option.name)] = _default(value, option, f"{place}: {name}")
    return found


def _default(value: object, option: click.Option, place: str) -> object:
    """Return the setting of an option as the command line gives it."""
    if not isinstance(value, bool if option.is_flag else str | int | float):
        kind = "true or false" if option.is_flag else "a text or a number"
        raise OptionError(f"{place} is {value!r}", hint=f"write {kind}")
    if option.is_flag:
        return value
    return [str(value)] if option.multiple else str(value)


class Stopped(KeyboardInterrupt):
    """Request to stop the program.

    A separate type is needed because of a habit of Python: a plain KeyboardInterrupt that passes through ``exec`` of a
    text (making a dataclass is enough) lets the interpreter end by SIGINT, even if it is given another exit code later.
    """


@contextmanager
def stoppable() -> Iterator[None]:
    """Raise SIGINT, SIGTERM and SIGHUP as :class:`Stopped`, except those that the parent process set to be ignored."""

    def stop(number: int, frame: object) -> None:
        raise Stopped

    heard = [number for number in _SIGNALS if signal.getsignal(number) is not signal.SIG_IGN]
    before = {number: signal.signal(number, stop) for number in heard}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def run(arguments: Sequence[str]) -> ExitCode:
    """Run ``tmd`` and return the exit code; every error is reported in one line, never as a traceback."""
    try:
        with stoppable():
            code = _invoke(list(arguments) or ["--help"])
            sys.stdout.flush()
            return code
    except BrokenPipeError:
        _silence()
        return ExitCode.OK
    except (Exception, KeyboardInterrupt) as error:
        if "--debug" in arguments:
            traceback.print_exc()
        command = next((word for word in arguments if word in COMMANDS), None)
        fault = fault_of(error, f"tmd {command}" if command else "tmd")
        return _tell(fault, as_json="--json" in arguments)


def _invoke(arguments: list[str]) -> ExitCode:
    """Invoke the command without :meth:`click.Command.main`, which has other exit codes."""
    if instruction := os.environ.get(_COMPLETION):
        from click.shell_completion import shell_complete

        return ExitCode(shell_complete(program, {}, "tmd", _COMPLETION, instruction))
    try:
        with program.make_context("tmd", arguments, default_map=_settings()) as context:
            return ExitCode(program.invoke(context) or ExitCode.OK)
    except click.exceptions.Exit as ended:
        return ExitCode(ended.exit_code)


def _tell(fault: Fault, *, as_json: bool) -> ExitCode:
    """Report an error on standard error and, where JSON was asked for, on standard output."""
    code = fault.code
    try:
        if as_json:
            emit(fault.json())
        sys.stdout.flush()
    except OSError:
        _silence()
    emit(fault.text(), error=True)
    return code


def _silence() -> None:
    """Let nothing more reach standard output: the interpreter flushes it once more when it ends."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
