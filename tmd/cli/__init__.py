"""The command line. One module for each sub-command; what they call lies in the rooms below.

Nothing heavy is imported before a command needs it: ``tmd --help`` is to be there at once.
"""

from __future__ import annotations

import sys


def main() -> None:
    """Run ``tmd`` on the arguments of the process, and end it with the documented exit code."""
    from tmd.cli.program import run

    sys.exit(run(sys.argv[1:]))
