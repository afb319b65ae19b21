"""Φ: instruction applications a second, on the bit sets and on the plain semantics.

``python experiments/bench/phi.py``: random walks in every bundled kitchen, both forms on the same steps.
"""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np

from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.semantics import apply
from tmd.world.compile import compile_problem
from tmd.world.environment import load_environment
from tmd.world.folder import find_domain, find_roots

STEPS = 400
REPEATS = 200


def main() -> None:
    """Print one line for each kitchen."""
    folder = find_domain("kitchen")
    print(f"{'environment':12} {'bit sets/s':>12} {'semantics/s':>12} {'ratio':>8}")
    for path in sorted((find_roots("problems")[0] / "kitchen" / "environments").glob("*.yaml")):
        bits, plain = measure(path, folder.name)
        print(f"{path.stem:12} {bits:12.0f} {plain:12.0f} {bits / plain:8.0f}")


def measure(path: Path, domain: str) -> tuple[float, float]:
    """Applications a second of both forms, the applicability test included."""
    problem = compile_problem(load_environment(path), find_domain(domain))
    task = ground(problem)
    random = np.random.default_rng(0)
    walk = []
    state = task.init
    for _ in range(STEPS):
        applicable = [o for o in task.operators if o.applicable(state)]
        operator = applicable[int(random.integers(len(applicable)))]
        walk.append((operator, state))
        state = operator.apply(state)
    start = time.perf_counter()
    for _ in range(REPEATS):
        for operator, before in walk:
            if operator.applicable(before):
                operator.apply(before)
    bits = STEPS * REPEATS / (time.perf_counter() - start)
    some = walk[:40]
    decoded = [(operator.instruction, task.decode(before)) for operator, before in some]
    start = time.perf_counter()
    for instruction, full in decoded:
        apply(instruction, full, problem)
    return bits, len(some) / (time.perf_counter() - start)


if __name__ == "__main__":
    main()
