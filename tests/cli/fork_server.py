"""A process that has imported what commands import, and carries each command out in a fork of itself.

What takes longest in a small command is to import numpy, numba and the rest; here that is done once. The fork is a
process like any other: it has its directory, environment, streams and exit code. One request is a line of JSON on
standard input; the answer is a line with the exit code.
"""

from __future__ import annotations

import atexit
import json
import os
import sys
import threading
import traceback
from collections.abc import Sequence
from contextlib import redirect_stderr, redirect_stdout, suppress
from pathlib import Path
from typing import Any

from tmd.cli import main
from tmd.cli.program import run

WARM = ("ground", "--environment", "kitchen1", "--text", "Take the cup.")


def serve(requests: int) -> None:
    """Answer until there are no more requests on this file descriptor."""
    with Path(os.devnull).open("w") as nothing, redirect_stdout(nothing), redirect_stderr(nothing):
        run(WARM)
    assert threading.active_count() == 1, "a process with threads cannot be forked safely"
    with os.fdopen(requests, "rb") as lines:
        for line in lines:
            child = os.fork()
            if not child:
                os._exit(_carry_out(json.loads(line)))
            _, status = os.waitpid(child, 0)
            sys.stdout.write(f"{os.waitstatus_to_exitcode(status)}\n")
            sys.stdout.flush()


def _carry_out(request: dict[str, Any]) -> int:
    os.chdir(request["cwd"])
    os.environ.clear()
    os.environ.update(request["environ"])
    for number, (name, flags) in enumerate(
        zip(request["streams"], (os.O_RDONLY, os.O_WRONLY, os.O_WRONLY), strict=True)
    ):
        opened = os.open(name, flags)
        os.dup2(opened, number)
        os.close(opened)
    code = _ended(request["arguments"])
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError):
            stream.flush()
    return code


def _ended(arguments: Sequence[str]) -> int:
    sys.argv = ["tmd", *arguments]
    try:
        main()
    except SystemExit as ended:
        return int(ended.code or 0)
    except BaseException:
        traceback.print_exc()
        return 1
    return 0


if __name__ == "__main__":
    stdin = os.dup(0)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    serve(stdin)
