"""Every bundled problem in every format, given to every tool that reads it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path

from experiments.interop.tools import TOOLS
from tmd.diagnostics import TmdError
from tmd.export.directory import write_directory
from tmd.export.formats import FORMATS
from tmd.export.planned_problem import Planned, planned
from tmd.export.strips import strips
from tmd.pddl.plan_file import parse_plan, read_plan
from tmd.pddl.reading.reader import read_domain, read_problem
from tmd.pddl.validator import validate
from tmd.pddl.writer import format_plan
from tmd.planning.backends import solve
from tmd.planning.result import Solved

ROOT = Path(__file__).resolve().parents[2]
SCHEMA = ROOT / "tests" / "export" / "behavior_tree.xsd"
GRACE = 30.0
"""Seconds a process may take beyond the limit that its tool was told."""


@dataclass(frozen=True, slots=True)
class Cell:
    """What one tool made of one problem in one format; ``None`` where it does no such thing.

    Attributes:
        tool: The tool.
        format: The format.
        problem: The problem, as ``domain/file``.
        accepts: It reads the problem.
        solves: It finds a plan.
        validates: It finds our plan valid.
        confirmed: Our validator finds its plan valid, for the problem that was exported.
        why: What was said where something is false.
    """

    tool: str
    format: str
    problem: str
    accepts: bool
    solves: bool | None
    validates: bool | None
    confirmed: bool | None
    why: str


def bundled() -> Iterator[tuple[str, Path, Path]]:
    """The name, the domain and the file of every bundled problem."""
    for problem in sorted((ROOT / "problems").glob("*/p[0-9]*.pddl")):
        name = problem.parent.name
        yield f"{name}/{problem.stem}", ROOT / "domains" / name / "domain.pddl", problem


def prepared(name: str, domain: Path, problem: Path, work: Path) -> Planned:
    """A problem with the plan of our planner, which is kept in ``work``."""
    read = read_problem(problem, read_domain(domain))
    kept = work / "plans" / f"{name}.plan"
    if not kept.is_file():
        answer = solve(read)
        if not isinstance(answer, Solved):
            raise TmdError(f"{name}: our planner found no plan")
        kept.parent.mkdir(parents=True, exist_ok=True)
        kept.write_text(format_plan(answer.plan, answer.cost), encoding="utf-8")
    return planned(read, read_plan(kept).instructions)


def exported(source: Planned, name: str, work: Path) -> Path:
    """The directory in which a problem stands in every format."""
    directory = work / "exports" / name
    files = {f"{name}/{path}": text.encode() for name, make in FORMATS.items() for path, text in make(source).items()}
    write_directory(directory, files, overwrite=True)
    return directory


def measure(source: Planned, name: str, directory: Path, tool: str, form: str, python: str, seconds: float) -> Cell:
    """One cell of the matrix."""
    answer = _asked(tool, form, directory / form, python, seconds)
    confirmed, doubt = _confirmed(source, answer["plan"])
    return Cell(
        tool,
        form,
        name,
        answer["accepts"],
        answer["solves"],
        answer["validates"],
        confirmed,
        answer["why"] or doubt,
    )


def _asked(tool: str, form: str, directory: Path, python: str, seconds: float) -> dict[str, object]:
    worker = Path(__file__).with_name("tools.py")
    with tempfile.TemporaryDirectory(prefix="tmd-interop-") as scratch:
        try:
            done = subprocess.run(
                [python, str(worker), tool, form, str(directory), str(seconds)],
                cwd=scratch,
                env={**os.environ, "TMD_TREE_SCHEMA": str(SCHEMA), "PYTHONHASHSEED": "0"},
                capture_output=True,
                text=True,
                timeout=seconds + GRACE,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return _nothing(f"no answer in {seconds:g} s")
    try:
        answer: dict[str, object] = json.loads(done.stdout)
    except ValueError:
        return _nothing(f"its process ended with {done.returncode}")
    return answer


def _nothing(why: str) -> dict[str, object]:
    return {"accepts": False, "solves": None, "validates": None, "plan": None, "why": why}


def _confirmed(source: Planned, text: object) -> tuple[bool | None, str]:
    """Whether our validator takes the plan of a tool, and if not, why."""
    if not isinstance(text, str):
        return None, ""
    try:
        read = parse_plan(text, "plan").instructions
    except TmdError as error:
        return False, str(error)
    made = strips(source).instructions  # the actions of plan-resolved formats are named by their instructions
    verdict = validate(source.problem, [step if step.args else made.get(step.name, step) for step in read])
    return verdict.valid, verdict.reason


def run(work: Path, python: str, seconds: float, jobs: int, only: Sequence[str]) -> list[Cell]:
    """The whole matrix; cells that were measured before are taken from ``work``."""
    kept = work / "cells.jsonl"
    known = {(c.tool, c.format, c.problem): c for c in _read(kept)}
    with ThreadPoolExecutor(jobs) as pool:
        for name, domain, problem in bundled():
            if only and not any(part in name for part in only):
                continue
            wanted = [(t, f) for t, (kind, _) in TOOLS.items() for f in kind.formats if (t, f, name) not in known]
            if not wanted:
                continue
            source = prepared(name, domain, problem, work)
            directory = exported(source, name, work)
            waiting = [
                pool.submit(measure, source, name, directory, tool, form, python, seconds) for tool, form in wanted
            ]
            for future in waiting:
                cell = future.result()
                known[(cell.tool, cell.format, cell.problem)] = cell
                with kept.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(asdict(cell)) + "\n")
            print(f"{name}: {len(wanted)} cells", file=sys.stderr)
    return [known[key] for key in sorted(known)]


def _read(path: Path) -> Iterator[Cell]:
    if path.is_file():
        for line in path.read_text(encoding="utf-8").splitlines():
            yield Cell(**json.loads(line))


def versions(python: str) -> dict[str, str]:
    """The version of each tool's package, where it is installed."""
    code = (
        "import json, sys\nfrom importlib.metadata import version, PackageNotFoundError\nfound = {}\n"
        "for name in sys.argv[1:]:\n    try:\n        found[name] = version(name)\n"
        "    except PackageNotFoundError:\n        pass\nprint(json.dumps(found))"
    )
    packages = sorted({package for _, package in TOOLS.values()})
    done = subprocess.run([python, "-c", code, *packages], capture_output=True, text=True, check=True)
    found: dict[str, str] = json.loads(done.stdout)
    return found
