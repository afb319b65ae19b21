"""The ``tmd`` command: its global options, its sub-commands, and how every run of it ends."""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path

import click

from tmd import __version__
from tmd.cli.errors import Fault, fault_of
from tmd.cli.output import emit, emit_json
from tmd.cli.signals import stoppable
from tmd.diagnostics import ExitCode
from tmd.world.roots import Roots

COMMANDS = (
    "ground",
    "run",
    "view",
    "scene",
    "studio",
    "new",
    "test",
    "learn",
    "check",
    "fmt",
    "parse",
    "validate",
    "plan",
    "export",
    "compile",
    "data",
    "experiment",
)
"""The sub-commands, in the order in which a newcomer meets them; :mod:`tmd.cli.commands` has a module for each."""


class _Commands(click.Group):
    """A group that imports a sub-command when it is asked for."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in COMMANDS:
            return None
        command = import_module(f"tmd.cli.commands.{cmd_name}").command
        assert isinstance(command, click.Command)
        return command


@click.group(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.option("--domains", type=click.Path(path_type=Path), metavar="DIR", help="The directory of all domains.")
@click.option("--problems", type=click.Path(path_type=Path), metavar="DIR", help="The directory of all problems.")
@click.option("--debug", is_flag=True, help="Show where an internal error happened.")
@click.version_option(__version__, prog_name="tmd", message="%(prog)s %(version)s")
@click.pass_context
def program(ctx: click.Context, domains: Path | None, problems: Path | None, debug: bool) -> None:
    """Turn what a person says into plans that a robot may safely execute.

    The directories are looked for in this order: the option, ./domains and ./problems, the packaged copy.
    """
    ctx.obj = Roots(domains, problems)


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
    """Not :meth:`click.Command.main`, which has exit codes of its own."""
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
            emit_json(fault.json())
        sys.stdout.flush()
    except OSError:
        _silence()
    emit(fault.text(), error=True)
    return code


def _silence() -> None:
    """Let nothing more reach standard output: the interpreter flushes it once more when it ends."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
