"""The ``tmd`` command: its global options, its sub-commands, and how every run of it ends."""

from __future__ import annotations

import os
import signal
import sys
import traceback
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path

import click

from tmd import __version__
from tmd.cli.errors import Fault, fault_of
from tmd.cli.options import PATH
from tmd.cli.output import emit
from tmd.diagnostics import ExitCode
from tmd.pddl.reading.syntax import nearest
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
    "data": "experiment",
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
    """
    ctx.obj = Roots(domains, problems)


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
        with program.make_context("tmd", arguments) as context:
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
