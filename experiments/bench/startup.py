"""How long ``tmd --help`` takes, interpreter included, beside an interpreter that does nothing.

Run it as ``python experiments/bench/startup.py [REPEATS]``. The two are timed in turn, so that a busy machine slows
both; the goal is a median of less than 0.3 seconds.
"""

from __future__ import annotations

import subprocess
import sys
import time
from statistics import median

GOAL = 0.3
COMMANDS = {
    "python -c pass": [sys.executable, "-c", "pass"],
    "tmd --help": [sys.executable, "-m", "tmd", "--help"],
}


def seconds(command: list[str]) -> float:
    """The wall time of one run."""
    start = time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return time.perf_counter() - start


def main() -> None:
    """Print median and slowest of each command."""
    repeats = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    times: dict[str, list[float]] = {name: [] for name in COMMANDS}
    for _ in range(repeats):
        for name, command in COMMANDS.items():
            times[name].append(seconds(command))
    for name, found in times.items():
        print(f"{name:<16} median {median(found) * 1000:6.1f} ms   slowest {max(found) * 1000:6.1f} ms")
    met = median(times["tmd --help"]) < GOAL
    print(f"goal: median below {GOAL * 1000:.0f} ms: {'met' if met else 'missed'}")


if __name__ == "__main__":
    main()
