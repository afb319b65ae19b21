"""Running the real command in a process of its own, as a user does."""

from __future__ import annotations

import atexit
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory, TemporaryFile
from typing import Any

import pytest

from tests.cli.fork_server import PATIENCE, ask

ROOT = Path(__file__).resolve().parents[2]
BLOCKS = ROOT / "tests" / "pddl" / "cases" / "blocks"
UNTAUGHT = ("compile", "experiment", "lsp", "plan", "validate")
"""Commands that use nothing that was learned of a domain: they need not wait until it is."""


@dataclass(frozen=True)
class Ended:
    """Exit code and output of a command."""

    code: int
    out: str
    err: str


Tmd = Callable[..., Ended]


def heed_interrupts() -> None:
    """For a process to interrupt: from tests in the background it would inherit that interrupts are ignored."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@cache
def fork_server() -> str:
    """The socket of a process that has imported everything, and carries out each command in a fork of itself.

    Processes that run tests side by side share one, which ends with the process that has started them.
    """
    if "PYTEST_XDIST_WORKER" in os.environ:
        directory, owner = Path(os.environ["XDG_CACHE_HOME"]), os.getppid()
    else:
        own = TemporaryDirectory(prefix="tmd-fork-")
        atexit.register(own.cleanup)
        directory, owner = Path(own.name), os.getpid()
    address = directory / "socket"
    with suppress(FileExistsError):
        (directory / "socket.begun").touch(exist_ok=False)
        command = [sys.executable, "-m", "tests.cli.fork_server", address, str(owner)]
        subprocess.Popen(command, cwd=ROOT, env=_environ({}), start_new_session=True)
    for _ in range(PATIENCE * 20):
        with socket.socket(socket.AF_UNIX) as connection, suppress(OSError):
            connection.connect(str(address))
            return str(address)
        time.sleep(0.05)
    raise TimeoutError("the process that carries out commands does not begin")


def _environ(more: Mapping[str, str]) -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(ROOT), **more}


def run_tmd(
    arguments: Sequence[str | Path],
    cwd: Path,
    *,
    stdin: bytes = b"",
    env: Mapping[str, str] | None = None,
    before: str = "",
    fresh: bool = False,
) -> Ended:
    """Run ``tmd`` in ``cwd``; ``before`` is Python that is executed first, to take something away from it.

    A ``fresh`` one is started from nothing: what is taken away, or what Python itself reads from the environment, has
    no effect on a process that has begun.
    """
    words = list(map(str, arguments))
    if not fresh and not any(name.startswith("PYTHON") for name in env or ()):
        with TemporaryFile() as given, TemporaryFile() as out, TemporaryFile() as err:
            given.write(stdin)
            for stream in (given, out, err):
                stream.seek(0)
            streams = (given.fileno(), out.fileno(), err.fileno())
            code = ask(fork_server(), words, str(cwd), _environ(env or {}), streams, before)
            said = [stream.seek(0) or stream.read().decode("utf-8") for stream in (out, err)]
        return Ended(code, *said)
    done = subprocess.run(
        [sys.executable, "-c", f"{before}\nfrom tmd.cli import main\nmain()", *words],
        cwd=cwd,
        env=_environ(env or {}),
        input=stdin,
        capture_output=True,
        timeout=PATIENCE,
        check=False,
    )
    return Ended(done.returncode, done.stdout.decode("utf-8"), done.stderr.decode("utf-8"))


@pytest.fixture
def tmd(tmp_path: Path, request: pytest.FixtureRequest) -> Tmd:
    """``tmd("parse", "--text", "…")`` in an empty directory, with this checkout's domains and problems."""

    def run(*arguments: str | Path, **options: Any) -> Ended:  # noqa: ANN401 - those of run_tmd
        if not arguments or arguments[0] not in UNTAUGHT:
            request.getfixturevalue("learned")
        return run_tmd(arguments, tmp_path, **options)

    return run


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
