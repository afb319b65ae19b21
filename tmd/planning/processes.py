"""Planner processes: start them, limit their time and memory, read what they print, and stop them.

Each process gets a process group, which is killed as a whole. On Linux the kernel also kills it when this program
dies, even by SIGKILL. Texts pass through files without names, so nothing is left on the disk.
"""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import IO, TYPE_CHECKING

from tmd.diagnostics import PlannerError

if TYPE_CHECKING:
    import socket

MEGABYTE = 1 << 20
# A planner that prints without end must not fill the disk.
_LARGEST_FILE = 4 << 30
# Bytes at the end of the output, and lines of them, that are quoted when a planner fails.
_TAIL = 4_096
_LINES = 3
_PR_SET_PDEATHSIG = 1
# Seconds between two looks at a running process. Popen.wait looks every 50 ms, longer than a small search takes.
_PAUSE = 0.002

PROGRAM = "TMD_PROGRAM"
"""Environment variable that marks all processes that a program started."""
PLANNER = "TMD_PLANNER"
"""Environment variable that marks a planner and all processes that it started."""


class Deadline:
    """A time limit for several processes one after another, with the memory that each of them may take.

    Args:
        seconds: Time limit, from now.
        memory: Bytes for each process; ``None`` for most of the machine's memory.
        processor: Seconds of processor time for each process; ``None`` for no limit.
    """

    def __init__(self, seconds: float, memory: int | None = None, processor: int | None = None) -> None:
        self.seconds = seconds
        self.memory = memory
        self.processor = processor
        self._end = time.monotonic() + seconds

    def left(self) -> float:
        """Return the seconds that are left, at least 0."""
        return max(0.0, self._end - time.monotonic())

    def memory_limit(self) -> str:
        """Describe the memory limit."""
        return "the memory" if self.memory is None else f"{self.memory // MEGABYTE} MB"

    def at_most(self, seconds: float) -> Deadline:
        """Return this deadline, or one in ``seconds`` if that is earlier."""
        return Deadline(min(seconds, self.left()), self.memory, self.processor)


class PlannerProcess:
    """A running planner; leaving its ``with`` block kills it and its process group.

    Args:
        name: Name of the planner for messages.
        command: Program and arguments.
        deadline: Memory and processor time that it may take. The caller watches the time limit.
        stdin: Standard input; empty by default.
        passed: Files that it inherits under their descriptors.
        environment: Variables that are set in addition to those of this program.
        channel: A socket that becomes standard input and output. The process then does not end with the thread that
            started it, and must end by itself when the program dies.
        directory: Working directory.

    Raises:
        PlannerError: It cannot be started.
    """

    def __init__(
        self,
        name: str,
        command: Sequence[str],
        deadline: Deadline,
        *,
        stdin: IO[bytes] | None = None,
        passed: Sequence[IO[bytes]] = (),
        environment: Mapping[str, str] | None = None,
        channel: socket.socket | None = None,
        directory: str | None = None,
    ) -> None:
        self.name = name
        self._files = (unnamed_file(), unnamed_file())
        ends = (
            (stdin or subprocess.DEVNULL, self._files[0]) if channel is None else (channel.fileno(), channel.fileno())
        )
        try:
            self._process = subprocess.Popen(
                list(command),
                stdin=ends[0],
                stdout=ends[1],
                stderr=self._files[1],
                pass_fds=[file.fileno() for file in passed],
                cwd=directory,
                env={**os.environ, **(environment or {})},
                preexec_fn=_limits(deadline, None if channel else os.getpid()),
                process_group=0,
            )
        except OSError as error:
            self._close_files()
            raise PlannerError(f"{name} cannot be started: {error.strerror or error}") from error

    def __enter__(self) -> PlannerProcess:
        return self

    def __exit__(self, *exception: object) -> None:
        self.kill()

    def wait(self, deadline: Deadline, other: PlannerProcess | None = None) -> int | None:
        """Wait until this process or the other one ends, or the deadline is reached; return this one's exit code.

        The code is negative for the signal that killed the process, and ``None`` while it runs.
        """
        while (code := self._process.poll()) is None and (other is None or other._process.poll() is None):
            if not deadline.left():
                break
            time.sleep(min(_PAUSE, deadline.left()))
        return code

    def kill(self) -> None:
        """Kill the process and its group, and forget its output."""
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()
        self._close_files()

    def output(self) -> str:
        """Return everything on standard output."""
        return _read(self._files[0])

    def log(self) -> str:
        """Return everything on standard error."""
        return _read(self._files[1])

    def failed(self, why: str) -> PlannerError:
        """Return the error that this process failed, which quotes its last lines."""
        lines = [line for file in self._files for line in _read(file, _TAIL).splitlines()]
        last = [" ".join(line.split()) for line in lines if any(c.isalnum() for c in line)][-_LINES:]
        quoted = f"its last lines: {' / '.join(last)}" if last else "it printed nothing"
        return PlannerError(f"{self.name} {why}; {quoted}")

    def _close_files(self) -> None:
        for file in self._files:
            file.close()


def ending(code: int) -> str:
    """Describe an exit code that was not expected, or the signal that killed a process."""
    if code >= 0:
        return f"ended with the exit code {code}"
    try:
        name = signal.Signals(-code).name
    except ValueError:
        name = f"signal {-code}"
    return f"was killed by {name}{' (out of memory?)' if -code == signal.SIGKILL else ''}"


def unnamed_file(text: str = "") -> IO[bytes]:
    """Return a temporary file without a name, at its beginning, with ``text`` in it."""
    file = _unnamed()
    file.write(text.encode())
    file.seek(0)
    return file


def _unnamed() -> IO[bytes]:
    with suppress(AttributeError, OSError):  # as tempfile does on Linux, whose import takes as long as a small search
        directory = os.environ.get("TMPDIR") or "/tmp"
        return os.fdopen(os.open(directory, os.O_TMPFILE | os.O_RDWR, 0o600), "w+b")
    import tempfile

    return tempfile.TemporaryFile()


def _read(file: IO[bytes], most: int | None = None) -> str:
    """Return the text of a file, or its last ``most`` bytes."""
    size = file.seek(0, os.SEEK_END)
    file.seek(0 if most is None else max(0, size - most))
    return file.read().decode(errors="replace")


@contextmanager
def memory_limit(memory: int | None) -> Iterator[None]:
    """Limit this process to ``memory`` bytes more than it has now; allocations beyond it raise MemoryError."""
    if memory is None or not Path("/proc/self/statm").exists():
        yield
        return
    taken = int(Path("/proc/self/statm").read_text().split()[0]) * os.sysconf("SC_PAGE_SIZE")
    before = resource.getrlimit(resource.RLIMIT_AS)
    _limit(resource.RLIMIT_AS, taken + memory)
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, before)


def _limit(kind: int, most: int) -> None:
    """Set a limit of this process, within the hard one, which may not be raised."""
    hard = resource.getrlimit(kind)[1]
    resource.setrlimit(kind, (most if hard == resource.RLIM_INFINITY else min(most, hard), hard))


def _limits(deadline: Deadline, parent: int | None) -> Callable[[], None]:
    """Return the function that a new process calls first, which sets its limits and lets it die with ``parent``."""
    import ctypes

    library = ctypes.CDLL(None)
    memory = deadline.memory or int(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") * 0.8)
    limits = [(resource.RLIMIT_AS, memory), (resource.RLIMIT_FSIZE, _LARGEST_FILE)]
    if deadline.processor is not None:
        limits.append((resource.RLIMIT_CPU, deadline.processor))

    def limit() -> None:
        if parent is not None and hasattr(library, "prctl"):
            library.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
            if os.getppid() != parent:
                os._exit(1)
        for kind, most in limits:
            _limit(kind, most)

    return limit


def kill_marked(variable: str, value: str) -> None:
    """Kill every process, except this one, that has the environment variable with this value (Linux)."""
    wanted = f"{variable}={value}".encode()
    for path in Path("/proc").glob("[0-9]*/environ"):
        with suppress(OSError):
            if int(path.parent.name) != os.getpid() and wanted in path.read_bytes().split(b"\0"):
                os.kill(int(path.parent.name), signal.SIGKILL)


_GUARD = f"""
import sys
from tmd.planning.processes import kill_marked
sys.stdin.buffer.read()
kill_marked("{PROGRAM}", sys.argv[1])
"""


@cache
def end_with_program() -> subprocess.Popen[bytes] | None:
    """Let all processes that are started from now on end with this program, even if it is killed.

    A guard process waits for the end of a pipe that only this program holds, and then kills the processes that carry
    the mark of this program in their environment. Libraries start worker processes in various ways, so the kernel
    cannot bind each of them to us.
    """
    if sys.platform != "linux":
        return None
    name = f"{os.getpid()}-{time.monotonic_ns()}"
    guard = subprocess.Popen(
        [sys.executable, "-c", _GUARD, name],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env=python_environment(),
        start_new_session=True,  # signals to our group must not end the guard
    )
    os.environ[PROGRAM] = name
    return guard  # the cache keeps it, and with it the pipe


def python_environment() -> dict[str, str]:
    """Return the environment in which another Python finds the modules that this one finds."""
    return {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
