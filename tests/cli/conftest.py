"""Running the real command in a process of its own, as a user does."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BLOCKS = ROOT / "tests" / "pddl" / "cases" / "blocks"


@dataclass(frozen=True)
class Ended:
    """How a command ended."""

    code: int
    out: str
    err: str


Tmd = Callable[..., Ended]


def heed_interrupts() -> None:
    """For a process to interrupt: from tests in the background it would inherit that interrupts are ignored."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def run_tmd(
    arguments: Sequence[str | Path],
    cwd: Path,
    *,
    stdin: bytes = b"",
    env: Mapping[str, str] | None = None,
    before: str = "",
) -> Ended:
    """Run ``tmd`` in ``cwd``; ``before`` is Python that is executed first, to take something away from it."""
    start = [sys.executable, "-m", "tmd"]
    if before:
        start = [sys.executable, "-c", f"{before}\nfrom tmd.cli import main\nmain()"]
    done = subprocess.run(
        [*start, *map(str, arguments)],
        cwd=cwd,
        env={**os.environ, "PYTHONPATH": str(ROOT), **(env or {})},
        input=stdin,
        capture_output=True,
        timeout=240,
        check=False,
    )
    return Ended(done.returncode, done.stdout.decode("utf-8"), done.stderr.decode("utf-8"))


@pytest.fixture
def tmd(tmp_path: Path, learned: Path) -> Tmd:
    """``tmd("parse", "--text", "…")`` in an empty directory, with this checkout's domains and problems."""
    return lambda *arguments, **options: run_tmd(arguments, tmp_path, **options)


@pytest.fixture
def environment(tmp_path: Path) -> Path:
    """A small environment of the kitchen domain."""
    path = tmp_path / "mine.yaml"
    path.write_text(
        "name: mine\n"
        "domain: kitchen\n"
        "objects:\n"
        "  counter1: {class: counter}\n"
        "  sink1: {class: sink}\n"
        "  pot1: {class: pot, at: on counter1}\n"
    )
    return path
