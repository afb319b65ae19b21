"""Planner processes: start them, limit their time and memory, read what they print, and stop them.

Each process gets a process group, which is killed as a whole. On Linux the kernel also kills it when this program
dies, even by SIGKILL. Texts pass through files without names, so nothing is left on the disk.
"""

from __future__ import annotations

import json
import math
import os
import pickle
import resource
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from contextlib import ExitStack, contextmanager, suppress
from copy import copy
from functools import cache
from pathlib import Path
from pkgutil import resolve_name
from shutil import rmtree
from tempfile import TemporaryDirectory, TemporaryFile, gettempdir
from typing import IO, TypeVar

from tmd.diagnostics import LimitError, PlannerError
from tmd.pddl.model import Problem

T = TypeVar("T")
MEGABYTE = 1 << 20
# A planner that prints without end must not fill the disk.
_LARGEST_FILE = 4 << 30
# Share of the machine's memory that a process may take where no limit is given.
_SHARE_OF_MEMORY = 0.8
# Bytes at the end of the output, and lines of them, that are quoted when a planner fails.
_TAIL = 4_096
_LINES = 3
_PR_SET_PDEATHSIG = 1
# CPUCLOCK_SCHED: the clock of a process's processor time.
_CLOCK = 2
# Seconds between two looks at a running process. Popen.wait looks every 50 ms, longer than a small search takes.
_PAUSE = 0.002

PROGRAM = "TMD_PROGRAM"
"""Environment variable that marks all processes that a program started."""


class Deadline:
    """A time limit for several processes one after another, with the memory that each of them may take.

    ``memory`` is in bytes, ``None`` for most of that of the machine. It also ends as soon as ``over`` holds.
    """

    def __init__(self, seconds: float, memory: int | None = None, over: Callable[[], bool] = lambda: False) -> None:
        self.seconds = seconds
        self.memory = memory
        self._end = time.monotonic() + seconds
        self._over = over

    def left(self) -> float:
        """Return the seconds that are left, at least 0."""
        return 0.0 if self._over() else max(0.0, self._end - time.monotonic())

    def until(self, over: Callable[[], bool]) -> Deadline:
        """Return this deadline, which ends as soon as ``over`` holds."""
        earlier = copy(self)  # which is of so many seconds as well, for messages
        earlier._over = lambda: self._over() or over()
        return earlier

    def memory_limit(self) -> str:
        """Describe the memory limit."""
        return "the memory" if self.memory is None else f"{self.memory // MEGABYTE} MB"

    def at_most(self, seconds: float) -> Deadline:
        """Return this deadline, or one in ``seconds`` if that is earlier."""
        return Deadline(min(seconds, self.left()), self.memory, self._over)


class PlannerProcess:
    """A running planner; leaving its ``with`` block kills it and its process group.

    Its standard input is empty by default; ``passed`` are files that it inherits under their descriptors,
    ``environment`` variables beside those of this program. The ``deadline`` gives the memory that it may take; its time
    is the caller's to watch. One that is ``behind`` gives way to other processes. ``name`` is that of the planner, for
    messages.

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
        directory: str | None = None,
        behind: bool = False,
    ) -> None:
        self.name = name
        self._files = (unnamed_file(), unnamed_file())
        try:
            self._process = subprocess.Popen(
                list(command),
                stdin=stdin or subprocess.DEVNULL,
                stdout=self._files[0],
                stderr=self._files[1],
                pass_fds=[file.fileno() for file in passed],
                cwd=directory,
                env={**os.environ, **(environment or {})},
                preexec_fn=_limits(deadline, os.getpid(), _NICE if behind else 0),
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

    def code(self) -> int | None:
        """Return the exit code; ``None`` while it runs."""
        return self._process.poll()

    def processor_time(self) -> float:
        """Return the seconds of processor time that it took; of one that ended, and where nothing tells, infinity."""
        # what clock_getcpuclockid of Linux returns: psutil needs as long to be imported as a small problem to be solved
        with suppress(OSError):
            return math.inf if self.code() is not None else time.clock_gettime(~self._process.pid << 3 | _CLOCK)
        return math.inf

    def give_way(self) -> None:
        """Take only the processor time from now on that no other process wants."""
        with suppress(ProcessLookupError):
            os.setpriority(os.PRIO_PROCESS, self._process.pid, _LAST)

    def kill(self) -> None:
        """Kill the process and its group, and forget its output."""
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(self._process.pid, signal.SIGKILL)
        if self._process.returncode is None:
            # the wait of subprocess hangs where a signal interrupted its poll while that held a lock
            with suppress(ChildProcessError):
                os.waitpid(self._process.pid, 0)
            self._process.returncode = -signal.SIGKILL
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


def unnamed_file(content: bytes = b"") -> IO[bytes]:
    """Return a temporary file without a name, at its beginning, with ``content`` in it."""
    file = TemporaryFile()  # noqa: SIM115 - the caller closes it
    file.write(content)
    file.seek(0)
    return file


def _read(file: IO[bytes], most: int | None = None) -> str:
    """Return the text of a file, or its last ``most`` bytes."""
    size = file.seek(0, os.SEEK_END)
    file.seek(0 if most is None else max(0, size - most))
    return file.read().decode(errors="replace")


@contextmanager
def memory_limit(memory: int | None) -> Iterator[None]:
    """Limit this process to ``memory`` bytes more than it has now; allocations beyond it raise MemoryError."""
    if memory is None or not sys.platform.startswith("linux"):
        yield
        return
    import psutil

    before = resource.getrlimit(resource.RLIMIT_AS)
    _limit(resource.RLIMIT_AS, psutil.Process().memory_info().vms + memory)
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, before)


def in_thread(call: Callable[[], T]) -> Future[T]:
    """Begin a call in a thread of its own, which does not keep the program from ending as those of executors do."""
    future: Future[T] = Future()

    def run() -> None:
        try:
            future.set_result(call())
        except BaseException as error:  # for the thread that asked
            future.set_exception(error)

    threading.Thread(target=run, daemon=True).start()
    return future


class TimeIsUpError(LimitError):
    """The time of :func:`limited` is over."""


# Seconds that the planner processes get to end at their deadline themselves, before this process is stopped.
_GRACE = 1.0


@contextmanager
def limited(deadline: Deadline) -> Iterator[None]:
    """Limit what the main thread does, such as reading and replay, to the time of ``deadline``.

    Other threads get no signals, and are not limited.

    Raises:
        TimeIsUpError: The deadline has passed.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def stop(*_: object) -> None:
        raise TimeIsUpError(f"not done within {deadline.seconds:g} s", hint="raise --time-limit")

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, min(deadline.left() + _GRACE, threading.TIMEOUT_MAX))
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def _limit(kind: int, most: int) -> None:
    """Set a limit of this process, within the hard one, which may not be raised."""
    hard = resource.getrlimit(kind)[1]
    resource.setrlimit(kind, (most if hard == resource.RLIM_INFINITY else min(most, hard), hard))


# The lowest priority: beside a search on one processor, it leaves it 98 %.
_LAST = 19
# What a process that gives way adds to its priority: beside two searches on two processors, it gets a tenth of one.
_NICE = 10


def _limits(deadline: Deadline, parent: int, nice: int) -> Callable[[], None]:
    """Return the function that a new process calls first, which sets its limits and lets it die with ``parent``."""
    import ctypes

    library = ctypes.CDLL(None)
    memory = deadline.memory or int(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") * _SHARE_OF_MEMORY)
    limits = [(resource.RLIMIT_AS, memory), (resource.RLIMIT_FSIZE, _LARGEST_FILE)]

    def limit() -> None:
        if hasattr(library, "prctl"):
            library.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
            if os.getppid() != parent:
                os._exit(1)
        os.nice(nice)
        for kind, most in limits:
            _limit(kind, most)

    return limit


def kill_marked(variable: str, value: str) -> None:
    """Kill every process, except this one, that has the environment variable with this value."""
    import psutil

    for _ in range(2):  # the second time those that were being started
        for process in psutil.process_iter(["environ"]):
            if (process.info["environ"] or {}).get(variable) == value and process.pid != os.getpid():
                with suppress(psutil.NoSuchProcess):
                    process.kill()


# The program of the guard; its arguments are the mark of the program and the directory of temporary files.
_GUARD = "from tmd.planning.processes import guard; guard()"
# How the names of temporary directories begin that end with the program, before its mark.
_DIRECTORY = "tmd-planner-"


@cache
def end_with_program() -> subprocess.Popen[bytes]:
    """Let all processes that are started from now on end with this program, even if it is killed.

    A guard process waits for the end of a pipe that only this program holds, and then kills the processes that carry
    the mark of this program in their environment. Libraries start worker processes in various ways, so the kernel
    cannot bind each of them to us.
    """
    name = os.environ[PROGRAM] = f"{os.getpid()}-{time.monotonic_ns()}"
    return subprocess.Popen(  # the cache keeps it, and with it the pipe
        [sys.executable, "-c", _GUARD, name, gettempdir()],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env=python_environment(),
        start_new_session=True,  # signals to our group must not end the guard
    )


def guard() -> None:
    """Wait for the end of a program, then end its processes and remove its directories: the guard's program."""
    _, name, temporary = sys.argv
    sys.stdin.buffer.read()
    kill_marked(PROGRAM, name)
    for directory in Path(temporary).glob(f"{_DIRECTORY}{name}-*"):
        rmtree(directory, ignore_errors=True)


@contextmanager
def temporary_directory() -> Iterator[str]:
    """Make a directory for a process; in the end remove it, and end all processes that have it as their ``TMPDIR``.

    This is done even if this program is killed.
    """
    end_with_program()
    with TemporaryDirectory(prefix=f"{_DIRECTORY}{os.environ[PROGRAM]}-") as directory:
        try:
            yield directory
        finally:
            kill_marked("TMPDIR", directory)


def python_environment() -> dict[str, str]:
    """Return the environment in which another Python finds the modules that this one finds."""
    return {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}


# The program of a process that calls one function.
_CALL = (sys.executable, "-c", "from tmd.planning.processes import answer_call; answer_call()")


def call_in_process(
    name: str,
    function: str,
    arguments: Sequence[object],
    deadline: Deadline,
    *,
    directory: str | None = None,
    behind: bool = False,
) -> PlannerProcess:
    """Start a Python process that calls a function and prints the result as JSON.

    The function is given as ``module:name``, so that this program need not import it, and its arguments are pickled. A
    ``directory`` is for its temporary files as well. Other arguments are those of :class:`PlannerProcess`.
    """
    with unnamed_file(pickle.dumps((function, arguments))) as question:
        variables = {**python_environment(), **({"TMPDIR": directory} if directory else {})}
        return PlannerProcess(
            name, _CALL, deadline, stdin=question, environment=variables, directory=directory, behind=behind
        )


def answer_call() -> None:
    """Answer a call in the process that was started for it; other output goes to standard error."""
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    function, arguments = pickle.load(sys.stdin.buffer)
    json.dump(resolve_name(function)(*arguments), answers)
    answers.close()


class Prover(ExitStack):
    """The process that looks for a proof that a problem has no plan, from when it is first needed.

    No search finds out that a mug cannot be in two places; it runs to its limit. The proofs that do
    (:mod:`tmd.planning.unsolvable`) need the instantiated problem, which takes long where the problem is large. So they
    run beside a search that has not ended soon, and give way to it. Leaving the ``with`` block ends them. ``deadline``
    gives the memory that the process may take.
    """

    # Seconds of search after which proofs are looked for.
    SOON = 1.0
    # Seconds in which the reason is looked for when it is known that there is no plan.
    EXPLAINING = 20.0

    def __init__(self, problem: Problem, deadline: Deadline) -> None:
        super().__init__()
        self._problem = problem
        self._deadline = deadline
        self._process: PlannerProcess | None = None

    def explain(self) -> str | None:
        """Return why the problem, which is known to have no plan, has none; ``None`` where that takes too long."""
        return self._reason(self._deadline.at_most(self.EXPLAINING))

    def watch(self, search: PlannerProcess, deadline: Deadline) -> str | None:
        """Wait until a search ends or there is a proof, and return the proof.

        ``None`` means that the search ended or that the deadline was reached.
        """
        if search.wait(deadline.at_most(self.SOON)) is None and search.wait(deadline, self._started()) is None:
            reason = self._reason(Deadline(0))
            if reason is not None:
                return reason
            search.wait(deadline)
        return None

    def _reason(self, deadline: Deadline) -> str | None:
        process = self._started()
        reason: str | None = json.loads(process.output()) if process.wait(deadline) == 0 else None
        return reason

    def _started(self) -> PlannerProcess:
        if self._process is None:
            function, arguments = "tmd.planning.unsolvable:proof", [self._problem]
            name = "the search for a proof"
            started = call_in_process(name, function, arguments, self._deadline, behind=True)
            self._process = self.enter_context(started)
        return self._process
