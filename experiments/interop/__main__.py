"""Measure which tools take our exports, and write the table of docs/export.md: ``python -m experiments.interop``.

The tools stand in ``requirements.txt`` beside this file; ``--python`` names the interpreter that has them. What was
measured, with the reason of each refusal, is kept in the working directory; remove it to measure again.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from experiments.interop.matrix import ROOT, run, versions
from experiments.interop.page import tables, write


def main() -> None:
    """Read the arguments, fill the matrix, write the table."""
    parser = argparse.ArgumentParser(prog="python -m experiments.interop", description=__doc__)
    parser.add_argument("--python", default=sys.executable, help="the interpreter in which the tools are installed")
    parser.add_argument("--work", type=Path, default=ROOT / "runs" / "interop", help="the working directory")
    parser.add_argument("--seconds", type=float, default=60.0, help="how long a tool may take")
    parser.add_argument("--jobs", type=int, default=1, help="tools at a time")
    parser.add_argument("--page", type=Path, help="write the table into this page, not to standard output")
    parser.add_argument("only", nargs="*", help="only problems whose name has one of these in it")
    given = parser.parse_args()
    given.work.mkdir(parents=True, exist_ok=True)
    cells = run(given.work, given.python, given.seconds, given.jobs, given.only)
    if given.page:
        write(given.page, cells, versions(given.python))
    else:
        print(tables(cells, versions(given.python)), end="")


if __name__ == "__main__":
    main()
