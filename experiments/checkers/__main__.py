"""Slips × readers: is a slip caught, with its place, with a hint what was meant?

``python -m experiments.checkers`` runs every installed reader over every folder of ``cases/``, prints each result and
writes the counts into docs/errors.md, between its markers. ``--python`` names the interpreter that has the readers.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from tmd import __version__
from tmd.files import write_text

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PAGE = ROOT / "docs" / "errors.md"
BEGIN, END = "<!-- slips: made by python -m experiments.checkers -->", "<!-- end of slips -->"
TOOLS = ("VAL", "kairos check", "fast-downward", "unified-planning", "pddl", "pyperplan", "tarski", "plado", "pymimir")
_PLACE = re.compile(r"\bline:? *\d+|:\d+:\d+|\(line \d+|line \d+|at line|\b\d+:\d+\b", re.IGNORECASE)
_HINT = re.compile(r"did you mean|expected|perhaps|known (types|predicates)|should be|must be", re.IGNORECASE)
_SECONDS = 120


def said(python: str, tool: str, case: Path) -> str | None:
    """What a reader says to a case; ``None`` where it accepts it."""
    files = [str(case / "domain.pddl"), str(case / "problem.pddl")]
    command = [python, str(HERE / "readers.py"), tool, *files]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=_SECONDS, check=False)
    except subprocess.TimeoutExpired:
        return "does not end"
    return (done.stdout + done.stderr)[-4000:] if done.returncode else None


def ours(case: Path) -> str:
    """The cell of ``tmd check``, by what its JSON says."""
    command = [sys.executable, "-m", "tmd", "check", str(case), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False)
    found = json.loads(done.stdout)["diagnostics"]
    if not found:
        return "–"
    kind = "warning" if all(d["severity"] == "warning" for d in found) else "yes"
    return ", ".join([kind, "place", *(["hint"] if any(d["hint"] for d in found) else [])])


def cell(text: str | None, refuses_all: bool) -> str:
    """Caught, with place, with hint; ``?`` for a reader that refuses the case without a slip as well."""
    if refuses_all:
        return "?"
    if text is None:
        return "–"
    marks = [name for name, pattern in (("place", _PLACE), ("hint", _HINT)) if pattern.search(text)]
    return ", ".join(["yes", *marks])


def version_of(python: str, tool: str) -> str | None:
    """The version of a reader, if it is installed."""
    done = subprocess.run([python, str(HERE / "readers.py"), tool], capture_output=True, text=True, check=False)
    return done.stdout.strip() if done.returncode == 0 else None


def table(python: str) -> str:
    """The counts of each reader as Markdown; a line for each slip is printed."""
    cases = sorted(path for path in (HERE / "cases").iterdir() if path.name != "none")
    harmless = sorted((HERE / "harmless").iterdir())
    lines = [
        "| reader | slips reported | with a line | with a hint | harmless edits reported |",
        "| --- | ---: | ---: | ---: | ---: |",
    ]
    refused = sum(ours(case).startswith("yes") for case in harmless)
    lines.append(counts(f"tmd {__version__}", {case.name: ours(case) for case in cases}, str(refused)))
    for tool, version in ((tool, v) for tool in TOOLS if (v := version_of(python, tool))):
        refuses_all = said(python, tool, HERE / "cases" / "none") is not None
        with ThreadPoolExecutor(4) as pool:
            texts = list(pool.map(lambda case, t=tool: said(python, t, case), cases))
            refused = sum(pool.map(lambda case, t=tool: said(python, t, case) is not None, harmless))
        cells = {case.name: cell(text, refuses_all) for case, text in zip(cases, texts, strict=True)}
        lines.append(counts(f"{tool} {version}", cells, "?" if refuses_all else str(refused)))
    return "\n".join(lines)


def counts(reader: str, cells: dict[str, str], refused: str) -> str:
    """The row of a reader, whose cell for each slip is printed."""
    for slip, found in cells.items():
        print(f"{reader}: {slip}: {found}")
    if "?" in cells.values():
        return f"| {reader} | ? | ? | ? | ? |"
    caught = [found for found in cells.values() if found != "–"]
    numbers = [len(caught), *(sum(mark in found for found in caught) for mark in ("place", "hint"))]
    return f"| {reader} | {' | '.join(map(str, numbers))} | {refused} |"


def main() -> None:
    """Write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--python", default=sys.executable, help="the interpreter that has the readers")
    made = table(parser.parse_args().python)
    text = PAGE.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    write_text(PAGE, f"{before}{BEGIN}\n\n{made}\n\n{END}{rest.split(END)[1]}")
    print(made)


if __name__ == "__main__":
    main()
