"""A process that has imported what commands import, and carries each command out in a fork of itself.

What takes longest in a small command is to import numpy, numba and the rest; here that is done once. A fork is a
process like any other, with arguments, directory, environment, streams and exit code of its own::

    python -m tests.cli.fork_server SOCKET OWNER      answers, as long as the process OWNER lives
    python -I -S fork_server.py SOCKET ARGUMENTS …    carries ``tmd ARGUMENTS …`` out, as a program for shells
"""

from __future__ import annotations

import json
import os
import signal
import socket
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

WARM = ("ground", "--environment", "corner1", "--text", "Take the cup.")
HEAVY = ("pybullet", "PIL.Image", "openai.resources.chat", "tmd.robot_trials.trials")
"""Modules that some commands import as well, and that take long."""
PATIENCE = 240
"""Seconds that a command may take."""


def ask(
    address: str,
    arguments: Sequence[str],
    cwd: str,
    environ: Mapping[str, str],
    streams: tuple[int, int, int],
    before: str = "",
) -> int:
    """Have a command carried out; ``before`` is Python that is executed first.

    Returns:
        Its exit code.

    Raises:
        TimeoutError: It has not ended.
    """
    with socket.socket(socket.AF_UNIX) as connection:
        connection.settimeout(PATIENCE)
        connection.connect(address)
        asked = {"arguments": list(arguments), "cwd": cwd, "environ": dict(environ), "before": before}
        request = json.dumps(asked).encode()
        socket.send_fds(connection, [len(request).to_bytes(8, "little")], streams)
        connection.sendall(request)
        answer = connection.recv(8)
        return int(answer) if answer else -signal.SIGKILL


def serve(address: str, owner: int) -> None:
    """Answer, as long as the process ``owner`` lives."""
    import gc
    import threading
    from contextlib import redirect_stderr, redirect_stdout, suppress
    from importlib import import_module

    from tmd.cli.program import run
    from tmd.planning.__main__ import main as load_searches

    with socket.socket(socket.AF_UNIX) as server:
        server.bind(address)
        with Path(os.devnull).open("w") as nothing, redirect_stdout(nothing), redirect_stderr(nothing):
            run(WARM)
            for module in HEAVY:
                with suppress(ImportError):
                    import_module(module)
            load_searches()
        assert threading.active_count() == 1, "a process with threads cannot be forked safely"
        gc.freeze()  # so that no garbage collection of a fork goes through all that
        server.listen(64)
        server.settimeout(1)
        while True:
            try:
                connection, _ = server.accept()
            except TimeoutError:
                try:
                    os.kill(owner, 0)
                except ProcessLookupError:
                    return
                continue
            with suppress(ChildProcessError):
                while os.waitpid(-1, os.WNOHANG)[0]:
                    pass
            if not os.fork():
                server.close()
                _answer(connection)
            connection.close()


def _answer(connection: socket.socket) -> None:
    """Become the command, and say how it ended."""
    head, streams, _, _ = socket.recv_fds(connection, 8, 3)
    if not head:
        os._exit(0)  # somebody looked whether we are here
    size, body = int.from_bytes(head, "little"), b""
    while len(body) < size:
        body += connection.recv(size - len(body))
    request = json.loads(body)
    for number, stream in enumerate(streams):
        os.dup2(stream, number)
        os.close(stream)
    # Python asks once whether a stream can be wound back, so those of the server will not do
    sys.stdin = sys.__stdin__ = open(0, encoding="utf-8", closefd=False)  # noqa: SIM115
    sys.stdout = sys.__stdout__ = open(1, "w", encoding="utf-8", closefd=False)  # noqa: SIM115
    sys.stderr = sys.__stderr__ = open(2, "w", 1, "utf-8", "backslashreplace", closefd=False)  # noqa: SIM115
    os.chdir(request["cwd"])
    os.environ.clear()
    os.environ.update(request["environ"])
    connection.sendall(str(_ended(request["arguments"], request["before"])).encode())
    os._exit(0)


def _ended(arguments: Sequence[str], before: str) -> int:
    import atexit
    import traceback
    from contextlib import suppress

    from tmd.cli import main

    sys.argv = ["tmd", *arguments]
    try:
        exec(before, {})
        main()
        code = 0
    except SystemExit as ended:
        code = int(ended.code or 0)
    except BaseException:
        traceback.print_exc()
        code = 1
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError):
            stream.flush()
    return code


if __name__ == "__main__":
    if __package__:
        serve(sys.argv[1], int(sys.argv[2]))
    else:
        sys.exit(ask(sys.argv[1], sys.argv[2:], str(Path.cwd()), os.environ, (0, 1, 2)))
