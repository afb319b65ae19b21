"""Files: reading within a limit of size, atomic writing, locks.

A reader never meets half a file, even if the writer is killed. A lock ends with its process.
"""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import BytesIO
from pathlib import Path
from typing import IO, TYPE_CHECKING
from zlib import crc32

from tmd.diagnostics import OutputError

if TYPE_CHECKING:
    from filelock import FileLock

# Maximum size of a file that is read: a device may have no end.
MAX_BYTES = 100_000_000
_PIECE = 1 << 20
# The content of files that are changed in an editor and not saved, by their real paths: it is read instead of the disk.
UNSAVED: dict[Path, bytes] = {}


def opened(path: str | Path) -> IO[bytes]:
    """Open a file, or its unsaved content, for reading.

    Raises:
        OSError: It cannot be read.
    """
    unsaved = UNSAVED.get(real(Path(path))) if UNSAVED else None
    return Path(path).open("rb") if unsaved is None else BytesIO(unsaved)


def read_bytes(source: str | Path | IO[bytes]) -> bytes:
    """Return all bytes of a file, or of an open one.

    Raises:
        OSError: It cannot be read, or has more than :data:`MAX_BYTES`.
    """
    if isinstance(source, str | Path):
        with opened(source) as file:
            return read_bytes(file)
    pieces: list[bytes] = []
    while piece := source.read(_PIECE):
        pieces.append(piece)
        if len(pieces) > MAX_BYTES // _PIECE:
            raise OSError(errno.EFBIG, f"it is larger than {MAX_BYTES // 1_000_000} MB")
    return b"".join(pieces)


def write_text(path: str | Path, text: str) -> None:
    """Write ``text`` as UTF-8.

    Raises:
        OutputError: It cannot be written; what stood there before still stands.
    """
    write_bytes(path, text.encode("utf-8"))


def write_bytes(path: str | Path, data: bytes) -> None:
    """Write ``data`` to a new file beside ``path``, and let it take the place of ``path``.

    A link stays a link. What is not a regular file (``/dev/null``, a pipe) is written to as it is.

    Raises:
        OutputError: It cannot be written; what stood there before still stands.
    """
    given = Path(path)
    with writing(given):
        target = real(given)
        mode = _mode(target)
        if mode is not None and not stat.S_ISREG(mode):
            _write(target, data, os.O_WRONLY)
            return
        remove_leftovers(target)
        draft = draft_of(target)
        try:
            _write(draft, data, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
            if mode is not None:
                draft.chmod(stat.S_IMODE(mode))
            draft.replace(target)
        except BaseException:
            with suppress(OSError):
                draft.unlink(missing_ok=True)
            raise


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Report what the system says against writing ``path``.

    Raises:
        OutputError: It cannot be written.
    """
    try:
        yield
    except OSError as error:
        raise OutputError(
            f"{path} cannot be written: {error.strerror or error}",
            hint="check that the directory exists, that you may write there and that the disk has room",
        ) from error


def real(path: Path) -> Path:
    """Return the path without links, as :meth:`pathlib.Path.resolve`, which fails at a link that points to itself."""
    return Path(os.path.realpath(path))


_PACKAGE = Path(__file__).resolve().parent


def bundled(kind: str) -> list[Path]:
    """Return where the bundled ``domains`` or ``problems`` are: in an installed package, beside it in a checkout."""
    return [root for root in (_PACKAGE / "bundled" / kind, _PACKAGE.parent / kind) if root.is_dir()]


def make_directory(path: str | Path) -> Path:
    """Make a directory and those above it, if they are not there.

    Raises:
        OutputError: It cannot be made.
    """
    target = Path(path)
    try:
        target.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(
            f"{target} cannot be made: {error.strerror or error}", hint="name a directory you may write to"
        ) from error
    return target


def cache_directory(name: str) -> Path | None:
    """Return a directory of the user's cache; ``None`` where there can be none.

    It is in ``$XDG_CACHE_HOME``, if that is an absolute path, or else in ``.cache`` of a home directory that exists.
    """
    given = Path(os.environ.get("XDG_CACHE_HOME", ""))
    if given.is_absolute():
        return given / "tmd" / name
    try:
        home = Path.home()
    except RuntimeError:
        return None
    return home / ".cache" / "tmd" / name if home.is_absolute() and home.is_dir() else None


def check_writable(path: str | Path) -> None:
    """Refuse a file that cannot be written, before minutes are spent on what goes there.

    Raises:
        OutputError: Its directory is not there, it is a directory itself, or nobody may write there.
    """
    target = Path(path)
    reason = ""
    if not target.parent.is_dir():
        reason = "No such directory"
    elif target.is_dir():
        reason = "Is a directory"
    elif not os.access(target if target.exists() else target.parent, os.W_OK):
        reason = "Permission denied"
    if reason:
        raise OutputError(f"{target} cannot be written: {reason}", hint="name a file that you may write")


def try_lock(path: Path, wait: float = 0.0) -> FileLock | None:
    """Return the lock on a file; ``None`` where another thread or process still holds it after ``wait`` seconds.

    The file is empty and stays. The lock is held until it is released, or the process ends.

    Raises:
        OutputError: The file cannot be made or locked.
    """
    from filelock import FileLock, Timeout  # slow to load

    # a soft lock would outlive a process that was killed
    lock = FileLock(path, wait, thread_local=False, poll_interval=0.01, fallback_to_soft=False)
    try:
        lock.acquire()
    except Timeout:
        return None
    except OSError as error:
        raise OutputError(
            f"{path} cannot be locked: {error.strerror or error}",
            hint="use a directory of this machine that exists and that you may write to",
        ) from error
    return lock


@contextmanager
def locked(path: Path, *, wait: float) -> Iterator[None]:
    """Hold the lock on a file.

    No more attempts are made after ``wait`` seconds.

    Raises:
        OutputError: Somebody else holds it all that time, or the file cannot be made.
    """
    lock = try_lock(path, wait)
    if lock is None:
        raise OutputError(
            f"{path.parent} is in use: somebody else has been writing there for {wait:g} seconds", hint="try again"
        )
    try:
        yield
    finally:
        lock.release()


def draft_of(target: Path) -> Path:
    """Return the file in which this process writes the content of ``target``; no other process uses it.

    The host is in the name as a checksum, so that a long host name does not make the file name too long.
    """
    return target.with_name(f"{_beginning(target)}{os.getpid()}.part")


def remove_leftovers(target: Path) -> None:
    """Remove the drafts of ``target`` that processes of this machine left behind when they were killed."""
    beginning = _beginning(target)
    try:
        names = [entry.name for entry in os.scandir(target.parent) if entry.name.startswith(beginning)]
    except OSError:
        return
    for name in names:
        import shutil  # seldom needed, and slow to load

        number, _, end = name.removeprefix(beginning).partition(".")
        if end == "part" and number.isdecimal() and not lives(int(number)):
            left = target.with_name(name)
            with suppress(OSError):
                shutil.rmtree(left) if left.is_dir() else left.unlink()


def _beginning(target: Path) -> str:
    return f".{target.name}.{machine()}."


def machine() -> str:
    """Return eight characters for this machine, for names of files."""
    return f"{crc32(os.uname().nodename.encode()):08x}"


def lives(process: int) -> bool:
    """Return whether a process of this machine runs."""
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:
        return True
    return True


def _mode(path: Path) -> int | None:
    try:
        return path.stat().st_mode
    except FileNotFoundError:
        return None


def _write(path: Path, data: bytes, flags: int) -> None:
    """Write and make sure that it reached the disk: a rename may otherwise overtake the data."""
    descriptor = os.open(path, flags, 0o666)
    with os.fdopen(descriptor, "wb") as file:
        file.write(data)
        file.flush()
        if flags & os.O_CREAT:
            os.fsync(descriptor)
