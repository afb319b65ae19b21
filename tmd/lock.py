"""One at a time: a lock that holds between threads and between processes, and that no dead process keeps."""

from __future__ import annotations

import fcntl
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from tmd.diagnostics import OutputError

# Seconds between two attempts.
_PAUSE = 0.01


class Lock:
    """The right to a file, as long as it is held. The file is empty, and stays.

    Make it with :func:`try_lock`.
    """

    def __init__(self, path: Path, descriptor: int) -> None:
        self.path = path
        self._descriptor = descriptor

    def release(self, *, remove: bool = False) -> None:
        """Give it up; with ``remove`` the file goes as well."""
        if remove:
            with suppress(OSError):
                self.path.unlink()
        os.close(self._descriptor)


def try_lock(path: Path) -> Lock | None:
    """The lock; ``None`` where somebody has it.

    Raises:
        OutputError: The file cannot be made.
    """
    while True:
        try:
            descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
        except OSError as error:
            raise OutputError(
                f"{path.parent} cannot be written to: {error.strerror or error}",
                hint="check that the directory exists and that you may write there",
            ) from error
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if _same_file(path, descriptor):
                return Lock(path, descriptor)
        except BlockingIOError:
            os.close(descriptor)
            return None
        except OSError as error:
            os.close(descriptor)
            raise OutputError(
                f"{path} cannot be locked: {error.strerror or error}", hint="use a directory of this machine"
            ) from error
        os.close(descriptor)  # it was removed between opening and locking


@contextmanager
def locked(path: Path, *, wait: float) -> Iterator[None]:
    """Hold the lock for a while.

    Args:
        path: The file.
        wait: Seconds after which no more attempts are made.

    Raises:
        OutputError: Somebody else has it all that time, or the file cannot be made.
    """
    until = time.monotonic() + wait
    lock = try_lock(path)
    while lock is None:
        if time.monotonic() > until:
            raise OutputError(
                f"{path.parent} is in use: somebody else has been writing there for {wait:g} seconds",
                hint="try again",
            )
        time.sleep(_PAUSE)
        lock = try_lock(path)
    try:
        yield
    finally:
        lock.release()


def _same_file(path: Path, descriptor: int) -> bool:
    try:
        return os.path.samestat(path.stat(), os.fstat(descriptor))
    except FileNotFoundError:
        return False
