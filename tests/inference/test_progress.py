"""Progress: nothing where work is quick, one line where it is not, and a share that moves on a terminal."""

from __future__ import annotations

import io

import pytest

from tmd import knowledge
from tmd.knowledge import Progress


class Terminal(io.StringIO):
    """Standard error as a person has it."""

    def isatty(self) -> bool:
        """It is a terminal."""
        return True


def told(error: io.StringIO, seconds: float, monkeypatch: pytest.MonkeyPatch) -> str:
    """What is written while work of so many seconds is half and then nearly done."""
    clock = iter([0.0, seconds, seconds, seconds])
    monkeypatch.setattr("sys.stderr", error)
    monkeypatch.setattr(knowledge.time, "monotonic", lambda: next(clock))
    with Progress("learning") as shown:
        for share in (0.5, 0.5, 0.99):
            shown.tell(share)
    return error.getvalue()


@pytest.mark.parametrize("error", [io.StringIO(), Terminal()], ids=["a file", "a terminal"])
def test_nothing_is_said_of_what_is_quick(error: io.StringIO, monkeypatch: pytest.MonkeyPatch) -> None:
    assert told(error, 1.9, monkeypatch) == ""


def test_one_line_is_written_to_what_is_no_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    assert told(io.StringIO(), 2.1, monkeypatch) == "learning …\n"


def test_a_terminal_shows_the_share_and_is_left_clean(monkeypatch: pytest.MonkeyPatch) -> None:
    written = told(Terminal(), 2.1, monkeypatch)
    assert written.startswith("\rlearning:  50%\rlearning:  99%\r")
    assert written.rsplit("\r", 2)[1].isspace()
    assert written.endswith("\r")
