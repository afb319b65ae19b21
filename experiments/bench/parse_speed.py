"""Measure the clause parser: ``python -m experiments.bench.parse_speed``.

Prints the start-up (import and first parse in a fresh interpreter), sentences per second on the invented gold
texts, and the time for texts of growing length, which shows that it is linear.
"""

from __future__ import annotations

import random
import subprocess
import sys
import time

from experiments.language.gold import own_items
from tmd.language import parse

_START = (
    "import time; start = time.perf_counter(); from tmd.language import parse; parse('Take the cup.'); "
    "print(time.perf_counter() - start)"
)
_LENGTHS = (2500, 5000, 10_000, 20_000)


def _startup(runs: int = 5) -> float:
    times = [float(subprocess.check_output([sys.executable, "-c", _START])) for _ in range(runs)]
    return sorted(times)[runs // 2]


def _rate(texts: list[str], seconds: float = 2.0) -> float:
    start, count = time.perf_counter(), 0
    while time.perf_counter() - start < seconds:
        for text in texts:
            parse(text)
        count += sum(max(1, text.count(". ") + 1) for text in texts)
    return count / (time.perf_counter() - start)


def main() -> None:
    """Print the three measurements."""
    texts = [item.text for item in own_items()]
    print(f"start-up          {_startup():.3f} s (median of 5)")
    print(f"sentences/s       {_rate(texts):.0f}")
    words = " ".join(texts).split()
    generator = random.Random(0)
    for length in _LENGTHS:
        text = " ".join(generator.choices(words, k=length))
        start = time.perf_counter()
        parse(text)
        print(f"{length:6} words      {time.perf_counter() - start:.3f} s")


if __name__ == "__main__":
    main()
