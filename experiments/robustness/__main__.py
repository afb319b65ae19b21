"""Damage inputs and kill commands for some minutes, and print what failed.

``python -m experiments.robustness --minutes 5 --seed 1 --save failures``; ends with 1 where something failed. A case is
decided by seed and number, however many are done: ``--only N`` runs one of them again.
"""

from __future__ import annotations

import argparse
import shutil
import tempfile
import time
from collections import Counter
from pathlib import Path
from random import Random

from experiments.robustness import fuzz, kills


def fuzzed(work: Path, seed: int, end: float, keep: Path | None, only: int | None) -> Counter[tuple[str, str]]:
    """Do cases until ``end``; how often each kind had each fault (empty: none)."""
    ground = fuzz.Ground(work / "ground")
    ground.prepare()
    found: Counter[tuple[str, str]] = Counter()
    slowest = 0.0, 0
    number = only or 0
    while time.monotonic() < end:
        choose = Random(f"{seed}-{number}")
        kind = choose.choice(list(fuzz.KINDS))
        case = fuzz.KINDS[kind](ground, choose)
        outcome = ground.run(case)
        found[kind, outcome.fault] += 1
        slowest = max(slowest, (outcome.seconds, number))
        if outcome.fault:
            print(f"case {number}: {outcome.fault}: tmd {' '.join(map(repr, case.arguments))}", flush=True)
            if keep is not None:
                fuzz.save(ground, case, outcome, keep / f"fuzz-{seed}-{number}")
        ground.restore()
        number += 1
        if only is not None:
            break
    print(f"slowest case: {slowest[0]:.1f} s, number {slowest[1]}")
    return found


def killed(work: Path, seed: int, end: float, names: list[str]) -> Counter[tuple[str, str]]:
    """Kill jobs in turn until ``end``."""
    found: Counter[tuple[str, str]] = Counter()
    killers: dict[str, kills.Killer] = {}
    number = 0
    while time.monotonic() < end:
        name = names[number % len(names)]
        if name not in killers:
            killers[name] = kills.Killer(kills.JOBS[name], work / "kill" / str(len(killers)))
        fault = killers[name].kill(Random(f"{seed}-kill-{number}"))
        found[f"killed: {name}", fault] += 1
        if fault:
            print(f"kill {number} of {name}: {fault}", flush=True)
        number += 1
    return found


def main() -> int:
    """Run, print the table, and return 1 if anything failed."""
    parser = argparse.ArgumentParser(prog="python -m experiments.robustness", description=__doc__)
    parser.add_argument("--minutes", type=float, default=5.0, help="how long; the default is %(default)s")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", type=int, help="run this case of the seed alone")
    parser.add_argument("--save", type=Path, help="where failed cases go, a folder each")
    parser.add_argument("--kills", type=float, default=0.4, help="the share of the time for kills")
    parser.add_argument("--jobs-killed", default=",".join(j for j in kills.JOBS if "video" not in j), metavar="A,B")
    options = parser.parse_args()
    work = Path(tempfile.mkdtemp(prefix="tmd-robustness-"))
    begun, seconds = time.monotonic(), 60 * options.minutes
    try:
        share = 0 if options.only is not None else options.kills
        found = fuzzed(work, options.seed, begun + seconds * (1 - share), options.save, options.only)
        if share:
            names = [name for name in kills.JOBS if name in options.jobs_killed]
            found += killed(work, options.seed, begun + seconds, names)
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
