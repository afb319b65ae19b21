"""The command line: the commands, their options, and what they print.

Begin with :mod:`tmd.cli.program`, the table of commands.
Nothing heavy is imported before a command needs it: ``tmd --help`` is to be there at once.
"""

from __future__ import annotations

import gc
import os
import sys

ALLOCATIONS = 100_000
"""Number of new objects after which Python looks for cycles: parse trees grow quickly, and hold none."""


def main() -> None:
    """Run ``tmd`` on the arguments of the process, and end it with the documented exit code."""
    # its matrices are small: on busy processors the threads of BLAS wait for one another ten times as long as they work
    for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(variable, "1")
    # we have no plugins of pydantic, and to look for some among all that is installed takes longer than a small file
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    gc.set_threshold(ALLOCATIONS)
    try:
        from tmd.cli.output import open_closed_streams, settle_errors

        open_closed_streams()
        from tmd.cli.program import run

        code = int(run(sys.argv[1:]))
        settle_errors()
    except KeyboardInterrupt:  # before the command heard of signals, or after
        from tmd.diagnostics import ExitCode

        sys.stderr.write("error: interrupted\n")
        code = ExitCode.INTERRUPTED
    sys.exit(code)
