"""Colours of what a terminal shows: faults, warnings, hints, headings and results."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from typing import Any, TextIO

import click

_STYLES: Mapping[str, Mapping[str, Any]] = {
    "bad": {"fg": "red", "bold": True},
    "doubt": {"fg": "yellow", "bold": True},
    "well": {"fg": "green", "bold": True},
    "hint": {"fg": "cyan"},
    "heading": {"bold": True},
}
_MARKS = re.compile(
    r"""
    (?P<bad>^(?:error|no\ plan|invalid|stopped)(?=:)|(?<=:\ )error\[[\w-]+\]|(?<=,\ )invalid(?=:)
        |(?<=\ \ )(?:failed|not\ as\ predicted)(?=:))
    |(?P<doubt>^(?:warning|question|recovered)(?=:)|(?<=:\ )warning\[[\w-]+\])
    |(?P<well>^done(?=:)|(?<=,\ )valid$|(?<=\ \ )ok(?=:))
    |(?P<hint>^\ *hint(?=:))
    |(?P<heading>^(?:clauses|goals|constraints|skipped|plan\ \d+(?=:))(?=$|:))
    """,
    re.MULTILINE | re.VERBOSE,
)


def coloured(text: str) -> str:
    """Return a text with the escape sequences of a terminal around the words that lead a line or judge a result."""

    def styled(match: re.Match[str]) -> str:
        return click.style(match.group(), **_STYLES[str(match.lastgroup)])

    return _MARKS.sub(styled, text)


def takes_colour(stream: TextIO) -> bool:
    """Return whether a stream is a terminal that shows colours; ``$NO_COLOR`` asks for none (https://no-color.org)."""
    return stream.isatty() and not os.environ.get("NO_COLOR") and os.environ.get("TERM", "dumb") != "dumb"
