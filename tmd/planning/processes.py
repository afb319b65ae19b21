"""Planners as processes: none outlives the program, and what a planner said last is told when it fails.

A process gets a group of its own, which is killed as a whole, and is killed by the kernel (Linux) when this program
dies, even by SIGKILL. Its texts come through pipes and unnamed files, so there is no directory to be left behind.
"""

from __future__ import annotations

import os
import selectors
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from functools import cache
from pathlib import Path
from types import TracebackType
from typing import IO

from tmd.diagnostics import PlannerError
from tmd.files import lives, machine

_TAIL = 4_096
"""Bytes at the end of what a planner printed that are looked at when it fails."""
_LINES = 3
"""Lines of them that are told."""
_LARGEST = 4 << 30
"""Bytes of a file beyond which a planner is stopped: one that prints without end shall not fill the disk."""
_PR_SET_PDEATHSIG = 1
MEGABYTE = 1 << 20
MARK = "TMD_PLANNER"
"""The variable that marks the processes of a conversation."""


PROGRAM = "TMD_PROGRAM"
"""The variable that marks what a program started."""


class Deadline:
    """A time limit for several processes one after another, and what memory each of them may take.

    Args:
        seconds: How long from now.
        memory: Bytes for each process; ``None`` for most of what the machine has.
        processor: Seconds of the processor for each process, which do not pass while others use it or the machine
            sleeps; ``None`` for no such limit.
    """

    def __init__(self, seconds: float, memory: int | None = None, processor: int | None = None) -> None:
        self.seconds = seconds
        self.memory = memory
        self.processor = processor
        self._end = time.monotonic() + seconds

    def left(self) -> float:
        """Seconds that are left, at least 0."""
        return max(0.0, self._end - time.monotonic())

    def memory_of(self, name: str) -> str:
        """The limit of memory that the process ``name`` came to, in words."""
        return f"the memory of {name}" if self.memory is None else f"{self.memory // MEGABYTE} MB of {name}"

    def at_most(self, seconds: float) -> Deadline:
        """This deadline, or one in ``seconds`` if that is earlier."""
        return Deadline(min(seconds, self.left()), self.memory, self.processor)


class PlannerProcess:
    """A planner that runs; leaving its ``with`` block kills what is left of it.

    Args:
        name: What people call it, for messages.
        command: Program and arguments.
        stdin: What it reads; nothing by default.
        passed: File descriptors that it inherits under their numbers.
        environment: Variables that are set besides those of this program.
        keep_output: Whether standard output is a result, apart from what it says on standard error.
        answers: The file descriptor that becomes its standard output, instead.
        directory: Where it runs.
        with_thread: Whether it dies with the thread that started it, and not only with the program.
        memory: Bytes that it may take; ``None`` for most of what the machine has.
        processor: Seconds of the processor after which it is stopped.

    Raises:
        PlannerError: It cannot be started.
    """

    def __init__(
        self,
        name: str,
        command: Sequence[str],
        *,
        stdin: IO[bytes] | None = None,
        passed: Sequence[int] = (),
        environment: Mapping[str, str] | None = None,
        keep_output: bool = False,
        answers: int | None = None,
        directory: str | None = None,
        with_thread: bool = True,
        memory: int | None = None,
        processor: int | None = None,
    ) -> None:
        self.name = name
        self._files = ExitStack()
        self._said = self._files.enter_context(unnamed_file())
        self._output = self._files.enter_context(unnamed_file()) if keep_output else None
        try:
            self._process = subprocess.Popen(
                list(command),
                stdin=stdin or subprocess.DEVNULL,
                stdout=answers if answers is not None else self._output or self._said,
                stderr=self._said,
                pass_fds=tuple(passed),
                cwd=directory,
                env={**os.environ, **(environment or {})},
                preexec_fn=_bound(os.getpid() if with_thread else None, memory, processor),
                process_group=0,
            )
        except OSError as error:
            self._files.close()
            raise PlannerError(f"{name} cannot be started: {error.strerror or error}") from error

    def __enter__(self) -> PlannerProcess:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.kill()
        self._files.close()

    def wait(self, deadline: Deadline) -> int | None:
        """Its exit code, negative for the signal that killed it; ``None`` where it still runs at the deadline."""
        _until_ended((self._process,), deadline.left())
        return self._process.poll()

    def wait_with(self, other: PlannerProcess, deadline: Deadline) -> None:
        """Wait until this or the other process ends, or the deadline is reached."""
        _until_ended((self._process, other._process), deadline.left())

    def poll(self) -> int | None:
        """Its exit code; ``None`` while it runs."""
        return self._process.poll()

    def kill(self) -> None:
        """Kill it and all that it started in its group."""
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(self._process.pid, signal.SIGKILL)
        self._process.wait()

    def output(self) -> str:
        """Everything on standard output, of a process that was started with ``keep_output``."""
        return "" if self._output is None else _read(self._output)

    def said(self) -> str:
        """Everything else that it printed."""
        return _read(self._said)

    def failed(self, why: str) -> PlannerError:
        """The error that says why it failed, with the last lines that it printed."""
        lines = []
        for file in filter(None, (self._output, self._said)):
            size = file.seek(0, os.SEEK_END)
            file.seek(max(0, size - _TAIL))
            lines += file.read().decode(errors="replace").splitlines()
        told = [" ".join(line.split()) for line in lines if any(c.isalnum() for c in line)][-_LINES:]
        last = f"its last lines: {' / '.join(told)}" if told else "it said nothing"
        return PlannerError(f"{self.name} {why}; {last}")


class Conversation:
    """A process that answers each line with a line, in a directory of its own, which is its temporary one as well.

    It and all that it started, even in groups of their own, carry a mark in their environment by which
    :func:`end_marked` finds them. It must end by itself when the program dies: it is not bound to a thread.

    Args:
        name: What people call it.
        command: Program and arguments.
        environment: Variables that are set.
    """

    def __init__(self, name: str, command: Sequence[str], environment: Mapping[str, str]) -> None:
        from tempfile import TemporaryDirectory

        _remove_left_directories()
        self._directory = TemporaryDirectory(prefix=f"{_DIRECTORY}{machine()}-{os.getpid()}-")
        self._mark = Path(self._directory.name).name
        questions, self._questions = os.pipe()
        self._answers, answers = os.pipe()
        self._open = True
        self._pending = b""
        try:
            with os.fdopen(questions, "rb") as stdin:
                self.process = PlannerProcess(
                    name,
                    command,
                    stdin=stdin,
                    answers=answers,
                    directory=self._directory.name,
                    environment={**environment, MARK: self._mark, "TMPDIR": self._directory.name},
                    with_thread=False,
                )
        except BaseException:
            os.close(self._questions)
            os.close(self._answers)
            self._directory.cleanup()
            raise
        finally:
            os.close(answers)
        os.set_blocking(self._questions, False)

    def ask(self, line: str, deadline: Deadline) -> str | None:
        """The line that answers ``line``; ``None`` where there is none by the deadline.

        Raises:
            PlannerError: It ended.
        """
        data = memoryview(f"{line}\n".encode())
        with selectors.DefaultSelector() as selector:
            selector.register(self._answers, selectors.EVENT_READ)
            selector.register(self._questions, selectors.EVENT_WRITE)
            while b"\n" not in self._pending:
                ready = [key.fd for key, _ in selector.select(deadline.left())]
                if not ready:
                    return None
                if self._questions in ready:
                    with suppress(BrokenPipeError):  # the end of the answers tells the rest
                        data = data[os.write(self._questions, data) :]
                    if not data or self.process.poll() is not None:
                        selector.unregister(self._questions)
                if self._answers in ready:
                    piece = os.read(self._answers, 1 << 16)
                    if not piece:
                        code = self.process.wait(Deadline(1.0))
                        raise self.process.failed("closed its output" if code is None else died(code))
                    self._pending += piece
        answer, _, self._pending = self._pending.partition(b"\n")
        return answer.decode(errors="replace")

    def close(self) -> None:
        """End it and all that it started, and remove its directory."""
        if self._open:
            self._open = False
            end_marked(self._mark)
            self.process.__exit__(None, None, None)
            end_marked(self._mark)
            os.close(self._questions)
            os.close(self._answers)
            self._directory.cleanup()


_DIRECTORY = "tmd-planner-"


def _remove_left_directories() -> None:
    """Remove what programs left that were killed before their worker could do so."""
    from shutil import rmtree
    from tempfile import gettempdir

    for path in Path(gettempdir()).glob(f"{_DIRECTORY}{machine()}-*-*"):
        number = path.name.split("-")[3]
        if number.isdecimal() and not lives(int(number)):
            rmtree(path, ignore_errors=True)


def end_marked(mark: str) -> None:
    """Kill every process but this one whose environment has the mark."""
    wanted = f"{MARK}={mark}".encode()
    for path in Path("/proc").glob("[0-9]*/environ"):
        with suppress(OSError):
            if int(path.parent.name) != os.getpid() and wanted in path.read_bytes().split(b"\0"):
                os.kill(int(path.parent.name), signal.SIGKILL)


_GUARD = f"""
import glob, os, signal, sys
sys.stdin.buffer.read()
wanted = f"{PROGRAM}={{sys.argv[1]}}".encode()
for path in glob.glob("/proc/[0-9]*/environ"):
    try:
        number = int(path.split("/")[2])
        with open(path, "rb") as file:
            if number != os.getpid() and wanted in file.read().split(b"\\0"):
                os.kill(number, signal.SIGKILL)
    except OSError:
        pass
"""


@cache
def end_with_program() -> subprocess.Popen[bytes] | None:
    """Let whatever is started from now on end with this program, even when it is killed before it can say so.

    A process waits for the end of a pipe that only this program holds, and then kills what carries this program's mark
    in its environment. Libraries start worker processes in ways of their own, so each cannot be bound to us.
    """
    if sys.platform != "linux":
        return None
    name = f"{os.getpid()}-{time.monotonic_ns()}"
    guard = subprocess.Popen(
        [sys.executable, "-S", "-E", "-c", _GUARD, name],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,  # whatever ends the others of our group, this one goes by the pipe
    )
    os.environ[PROGRAM] = name
    return guard  # kept by the cache, and with it the pipe


def died(code: int) -> str:
    """How a process ended that was not meant to: by a signal or by an exit code of its own."""
    if code >= 0:
        return f"ended with the exit code {code}"
    try:
        name = signal.Signals(-code).name
    except ValueError:
        name = f"signal {-code}"
    return f"was killed by {name}{' (out of memory?)' if -code == signal.SIGKILL else ''}"


def feed(descriptor: int, text: str, reader: PlannerProcess, deadline: Deadline) -> bool:
    """Write a text into a pipe and close it; whether all was taken before the reader died or the deadline came."""
    data = memoryview(text.encode())
    os.set_blocking(descriptor, False)
    try:
        with selectors.DefaultSelector() as selector:
            selector.register(descriptor, selectors.EVENT_WRITE)
            while data and reader.poll() is None:
                if not selector.select(min(deadline.left(), 1.0)):
                    if not deadline.left():
                        break
                    continue
                data = data[os.write(descriptor, data) :]
    except BrokenPipeError:
        pass  # how the reader ended tells the rest
    finally:
        os.close(descriptor)
    return not data


def unnamed_file() -> IO[bytes]:
    """A file without a name, which is gone when nobody has it open, in the directory for temporary ones."""
    with suppress(AttributeError, OSError):  # as tempfile does on Linux, whose import takes as long as a small search
        directory = os.environ.get("TMPDIR") or "/tmp"
        return os.fdopen(os.open(directory, os.O_TMPFILE | os.O_RDWR, 0o600), "w+b")
    import tempfile

    return tempfile.TemporaryFile()


def _read(file: IO[bytes]) -> str:
    file.seek(0)
    return file.read().decode(errors="replace")


def _until_ended(processes: Sequence[subprocess.Popen[bytes]], seconds: float) -> None:
    """Wait until one of the processes ended, or ``seconds`` are over."""
    if any(process.poll() is not None for process in processes):
        return
    if not hasattr(os, "pidfd_open"):  # not on Linux
        end = time.monotonic() + seconds
        while time.monotonic() < end and all(process.poll() is None for process in processes):
            time.sleep(0.005)
        return
    with selectors.DefaultSelector() as selector:  # Popen.wait looks every 50 ms only
        descriptors = [os.pidfd_open(process.pid) for process in processes]
        try:
            for descriptor in descriptors:
                selector.register(descriptor, selectors.EVENT_READ)
            selector.select(seconds)
        finally:
            for descriptor in descriptors:
                os.close(descriptor)


@contextmanager
def memory_limit(memory: int | None) -> Iterator[None]:
    """Let this process take no more than ``memory`` bytes beyond what it has; what needs more is a MemoryError."""
    import resource

    if memory is None or not Path("/proc/self/statm").exists():
        yield
        return
    taken = int(Path("/proc/self/statm").read_text().split()[0]) * os.sysconf("SC_PAGE_SIZE")
    before = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (_least(taken + memory, before[1]), before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, before)


def _least(limit: int, most: int) -> int:
    """A limit that is not above the one that may not be raised."""
    import resource

    return limit if most == resource.RLIM_INFINITY else min(limit, most)


def _bound(parent: int | None, most: int | None, processor: int | None = None) -> Callable[[], None]:
    """What a new process does first: die with ``parent``, and neither fill the disk nor take all memory or time."""
    import ctypes
    import resource

    library = ctypes.CDLL(None)
    memory = most or int(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") * 0.8)

    limits = [(resource.RLIMIT_AS, memory), (resource.RLIMIT_FSIZE, _LARGEST)]
    if processor is not None:
        limits.append((resource.RLIMIT_CPU, processor))

    def bind() -> None:
        if parent is not None and hasattr(library, "prctl"):
            library.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
            if os.getppid() != parent:
                os._exit(1)
        for kind, limit in limits:
            _, hard = resource.getrlimit(kind)
            resource.setrlimit(kind, (_least(limit, hard), hard))

    return bind
