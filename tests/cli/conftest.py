"""Running the real command in a process of its own, as a user does."""

from __future__ import annotations

import atexit
import json
import os
import select
import signal
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

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


PATIENCE = 240
"""Seconds that a command may take."""


class Forks:
    """A process that has imported everything, and runs each command in a fork of itself (see ``fork_server``)."""

    def __init__(self) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tests.cli.fork_server"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=ROOT, env=_environ({}),
        )  # fmt: skip
        atexit.register(self._process.kill)

    def run(self, arguments: Sequence[str], cwd: Path, stdin: bytes) -> Ended:
        """Run a command, and wait for its end."""
        assert self._process.stdin is not None and self._process.stdout is not None
        with TemporaryDirectory() as name:
            streams = [Path(name) / stream for stream in ("in", "out", "err")]
            for path, content in zip(streams, (stdin, b"", b""), strict=True):
                path.write_bytes(content)
            request = {"arguments": list(arguments), "cwd": str(cwd), "environ": _environ({})}
            self._process.stdin.write(json.dumps(request | {"streams": list(map(str, streams))}).encode() + b"\n")
            self._process.stdin.flush()
            if not select.select([self._process.stdout], [], [], PATIENCE)[0]:
                self._process.kill()
                raise TimeoutError(f"tmd {' '.join(arguments)} did not end: {streams[2].read_text()}")
            code = int(self._process.stdout.readline())
            return Ended(code, streams[1].read_text("utf-8"), streams[2].read_text("utf-8"))


forks = cache(Forks)


def _environ(more: Mapping[str, str]) -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(ROOT), **more}


def run_tmd(
    arguments: Sequence[str | Path],
    cwd: Path,
    *,
    stdin: bytes = b"",
    env: Mapping[str, str] | None = None,
    before: str = "",
) -> Ended:
    """Run ``tmd`` in ``cwd``; ``before`` is Python that is executed first, to take something away from it.

    With another environment, or something taken away, it is started from nothing.
    """
    words = list(map(str, arguments))
    if not env and not before:
        return forks().run(words, cwd, stdin)
    start = [sys.executable, "-m", "tmd"]
    if before:
        start = [sys.executable, "-c", f"{before}\nfrom tmd.cli import main\nmain()"]
    done = subprocess.run(
        [*start, *words],
        cwd=cwd,
        env=_environ(env or {}),
        input=stdin,
        capture_output=True,
        timeout=PATIENCE,
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
