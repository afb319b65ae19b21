"""How long a planner may take for a whole problem, and how much memory, as options."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

_Command = TypeVar("_Command", bound=Callable[..., Any])
_MEGABYTE = 1 << 20


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
    """``--time-limit`` and ``--memory-limit``; the command gets them as ``seconds`` and ``memory``, in bytes."""
    command = click.option(
        "--memory-limit",
        "memory",
        type=_Memory(min=100, max=1 << 40),
        metavar="MB",
        help="What the planner may take; 80 % of the machine's memory by default.",
    )(command)
    return click.option(
        "--time-limit",
        "seconds",
        type=_Seconds(min=0, min_open=True),
        metavar="SECONDS",
        help="Stop the planner after this time; 300 by default.",
    )(command)
