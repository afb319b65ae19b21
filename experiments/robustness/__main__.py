"""Damage inputs and kill commands for some minutes, and print what failed.

``python -m experiments.robustness --minutes 5 --seed 1 --save failures``; ends with 1 where something failed. A case is
decided by seed and number, however many are done: ``--only N`` runs one of them again.
"""

from __future__ import annotations

import argparse
import os
import shutil
import tempfile
import time
from collections import Counter
from pathlib import Path
from random import Random

from experiments.robustness import cases, kills
from experiments.robustness.workspace import Case, Outcome, Workspace, kind_of_failure, save

_TOLD_EACH = 1_000
_BATCH = 50
"""Cases that one child does; it is not the same as fifty children, but many times as quick."""
_FAST = Path("/dev/shm")
"""A disk in memory, if there is one: most of what commands do here is to write small files."""


def fuzzed(work: Path, options: argparse.Namespace, end: float) -> Counter[tuple[str, str]]:
    """Do cases until ``end``; how often each kind had each fault (empty: none)."""
    workspace = Workspace(work / "outer" / "inner" / "space")  # ../../x is to stay inside
    workspace.prepare(robot=options.robot)
    found: Counter[tuple[str, str]] = Counter()
    slowest: dict[str, tuple[float, int]] = {}
    begun = time.monotonic()

    def made(number: int) -> tuple[str, Case]:
        return cases.case(workspace, options.seed, number)

    def saved(number: int, case: Case, outcome: Outcome) -> None:
        print(f"case {number}: {outcome.fault}: tmd {' '.join(map(repr, case.arguments))}"[:300], file=told, flush=True)
        if options.save is not None:
            save(workspace, case, outcome, options.save / kind_of_failure(case, outcome), f"{options.seed}-{number}")

    number, done = options.first if options.only is None else options.only, 0
    with os.fdopen(os.dup(1), "w") as told:  # the child's own is where the command prints
        while done < options.cases and time.monotonic() < end:
            for number, kind, outcome in workspace.batch(number, min(_BATCH, options.cases - done), made, saved):  # noqa: B020
                found[kind, outcome.fault] += 1
                slowest[kind] = max(slowest.get(kind, (0.0, 0)), (outcome.seconds, number))
                done += 1
                if done % _TOLD_EACH == 0:
                    print(f"{done} cases, {done / (time.monotonic() - begun):.1f} a second", file=told, flush=True)
            number += 1
    print("slowest: " + ", ".join(f"{kind} {seconds:.1f} s ({number})" for kind, (seconds, number) in slowest.items()))
    return found


def disturbed(work: Path, options: argparse.Namespace, end: float) -> Counter[tuple[str, str]]:
    """Disturb jobs in turn until ``end``: mostly by kills."""
    names = [name for name in kills.JOBS if not options.jobs_killed or name in options.jobs_killed.split(";")]
    found: Counter[tuple[str, str]] = Counter()
    disturbers: dict[str, kills.Disturber] = {}
    writes: dict[str, list[int]] = {}
    number = options.first
    try:
        while time.monotonic() < end and number < options.first + options.cases:
            name = names[number % len(names)]
            if name not in disturbers:
                disturbers[name] = kills.Disturber(kills.JOBS[name], work / "kill" / str(len(disturbers)))
            disturber, choose = disturbers[name], Random(f"{options.seed}-kill-{number}")
            how = options.how or choose.choice((*["kill"] * 7, "twice", "clock", "full"))
            if how == "full":
                if not writes.get(name):
                    writes[name] = list(range(1, disturber.writes() + 1))
                    choose.shuffle(writes[name])
                fault = disturber.full(writes[name].pop()) if writes[name] else ""
            else:
                fault = {"kill": disturber.kill, "twice": disturber.twice, "clock": disturber.clock_back}[how](choose)
            found[f"{how}: {name}", fault.partition(":")[0]] += 1
            print(f"{how} {number} of {name}: {fault or 'as if nothing had happened'}", flush=True)
            number += 1
    finally:
        for disturber in disturbers.values():
            disturber.close()
    return found


def main() -> int:
    """Run, print the table, and return 1 if anything failed."""
    parser = argparse.ArgumentParser(prog="python -m experiments.robustness", description=__doc__)
    parser.add_argument("--minutes", type=float, default=5.0, help="how long; the default is %(default)s")
    parser.add_argument("--cases", type=int, default=10**9, help="how many of each at most")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--robot", action="store_true", help="the log of a simulated robot as well")
    parser.add_argument("--first", type=int, default=0, help="the number of the first case")
    parser.add_argument("--only", type=int, help="run this case of the seed alone")
    parser.add_argument("--save", type=Path, help="where failed cases go, a folder each")
    parser.add_argument("--kills", type=float, default=0.4, help="the share of the time for kills")
    parser.add_argument("--how", choices=("kill", "twice", "clock", "full"), help="disturb in this way only")
    parser.add_argument("--jobs-killed", default="", metavar="A;B", help=f"of: {', '.join(kills.JOBS)}")
    options = parser.parse_args()
    if options.only is not None:
        options.cases, options.kills = 1, 0
    work = Path(tempfile.mkdtemp(prefix="tmd-robustness-", dir=_FAST if _FAST.is_dir() else None))
    begun, seconds = time.monotonic(), 60 * options.minutes
    share = options.kills
    found: Counter[tuple[str, str]] = Counter()
    try:
        if share < 1:
            found += fuzzed(work, options, begun + seconds * (1 - share))
        if share:
            found += disturbed(work, options, begun + seconds)
    finally:
        shutil.rmtree(work, ignore_errors=True)
    print("\n| what | tried | failed | how |\n|---|---|---|---|")
    for kind in dict.fromkeys(kind for kind, _ in sorted(found)):
        faults = {fault: count for (of, fault), count in sorted(found.items()) if of == kind and fault}
        tried = sum(count for (of, _), count in found.items() if of == kind)
        print(f"| {kind} | {tried} | {sum(faults.values())} | {', '.join(f'{n} × {f}' for f, n in faults.items())} |")
    failed = sum(count for (_, fault), count in found.items() if fault)
    print(f"| **all** | {sum(found.values())} | {failed} | |")
    return int(failed > 0)


if __name__ == "__main__":
    raise SystemExit(main())
