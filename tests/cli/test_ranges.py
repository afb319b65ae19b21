"""Ranges of numbers on the command line."""

from __future__ import annotations

import click
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tmd.cli.commands.experiment import numbers

COMMAND = click.Command("experiment")
CONTEXT = click.Context(COMMAND)
OPTION = click.Option(["--train-environments"])


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("1-8", (1, 2, 3, 4, 5, 6, 7, 8)),
        ("9,10", (9, 10)),
        ("1,3,5-7", (1, 3, 5, 6, 7)),
        ("5-7,6,1", (1, 5, 6, 7)),
        (" 2 , 4 - 5 ", (2, 4, 5)),
        (None, None),
    ],
)
def test_meant(said: str | None, meant: tuple[int, ...] | None) -> None:
    assert numbers(CONTEXT, OPTION, said) == meant


@pytest.mark.parametrize("said", ["", "a", "1-", "-1", "8-1", "1,,2", "1.5", "1-2-3", "99999"])
def test_refused(said: str) -> None:
    with pytest.raises(click.BadParameter):
        numbers(CONTEXT, OPTION, said)


@given(st.sets(st.integers(0, 9999), min_size=1, max_size=20))
def test_any_set_of_numbers_can_be_said(wanted: set[int]) -> None:
    assert numbers(CONTEXT, OPTION, ",".join(map(str, wanted))) == tuple(sorted(wanted))
