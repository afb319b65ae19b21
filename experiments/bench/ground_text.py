"""Grounding a text of six clauses: seconds once everything is loaded, by model; and ``tmd ground`` from the shell.

``python experiments/bench/ground_text.py``: in each bundled kitchen that has a pot and a burner, with what all
demonstrations teach, which is kept in the user's cache.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import time

import tmd
from tmd.inference.config import PRESETS

TEXT = (
    "Fill the pot with water. Put the pot on the stove. Turn on the burner. Wait until the water boils. "
    "Add the ramen to the pot. Wait for three minutes."
)
KITCHENS = ("kitchen1", "kitchen2", "kitchen4", "kitchen5")
REPEATS = 3


def main() -> None:
    """Print one line for each kitchen, one column for each model, and then the time from the shell."""
    kit = tmd.load_domain("kitchen")
    print(f"{'environment':12} " + " ".join(f"{name:>14}" for name in PRESETS) + "  (median s)")
    for environment in KITCHENS:
        cells = []
        for model in PRESETS:
            kit.ground(TEXT, environment, model=model)
            times = []
            for _ in range(REPEATS):
                start = time.perf_counter()
                grounded = kit.ground(TEXT, environment, model=model)
                times.append(time.perf_counter() - start)
                assert len(grounded.parsed.clauses) == 6
            cells.append(f"{statistics.median(times):14.2f}")
        print(f"{environment:12} " + " ".join(cells))
    command = [sys.executable, "-m", "tmd", "ground", "--environment", "kitchen1", "--text"]
    for name, text in (("one clause", "Take a cup."), ("six clauses", TEXT)):
        times = []
        for _ in range(REPEATS):
            start = time.perf_counter()
            subprocess.run([*command, text], check=True, capture_output=True)
            times.append(time.perf_counter() - start)
        print(f"tmd ground, {name}: {statistics.median(times):.2f} s")


if __name__ == "__main__":
    main()
