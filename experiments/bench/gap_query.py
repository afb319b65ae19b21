"""One gap query: Fast Downward through unified-planning against the in-process search, interleaved query by query.

Run it as ``python experiments/bench/gap_query.py [QUERIES]``. The goal is a median at least 100 times smaller at
equal plan cost. Absolute times depend on the machine and its load; the ratios much less, since both sides of a
ratio are measured one after the other. Queries come from random walks in the bundled kitchens, as in
``experiments/planning/record_queries.py``.

Columns: ``cold`` is a goal never seen before (its relaxation is built), ``warm`` the same question again when its
answer was forgotten, ``memo`` once more when it was not, ``python`` a cold query without numba.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from time import perf_counter

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "planning"))
from record_queries import random_goal, random_walk

from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.task import Bits, Cube, Task
from tmd.planning.backends import fast_downward_for_gaps
from tmd.planning.gap_filler import GapFiller
from tmd.planning.result import Answer, Filled, Planner
from tmd.world.compile import compile_problem
from tmd.world.environment import load_environment
from tmd.world.folder import find_domain, find_roots

GOAL = 100
COLUMNS = ("cold", "warm", "memo", "python")


@dataclass(frozen=True)
class Row:
    """The seconds of one query by each route."""

    steps: int
    reference: float
    seconds: dict[str, float]


def main() -> None:
    """Measure and print."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 50
    folder = find_domain("kitchen")
    rows: list[Row] = []
    different = unsolved = 0
    environments = sorted((find_roots("problems")[0] / "kitchen" / "environments").glob("*.yaml"))
    for number, path in enumerate(environments):
        task = ground(compile_problem(load_environment(path), folder))
        reference = fast_downward_for_gaps(task, time_limit=10)
        random = np.random.default_rng([7, number])
        GapFiller(task, backend="numba").fill(task.init, (Cube(1, 0),))
        for _ in range(-(-count // len(environments))):
            state, goal = question(task, random)
            row, answers = measured(task, state, goal, reference)
            if not all(isinstance(answer, Filled) for answer in answers):
                unsolved += 1
                continue
            different += len({answer.cost for answer in answers if isinstance(answer, Filled)}) > 1
            rows.append(row)
    show(rows, different, unsolved)


def question(task: Task, random: np.random.Generator) -> tuple[Bits, Cube]:
    """A state and a goal that does not hold in it."""
    while True:
        _, state = random_walk(task, random, int(random.integers(0, 26)))
        goal = random_goal(task, random)
        if not goal.holds(state) and not goal.positive & goal.negative:
            return state, goal


def measured(task: Task, state: Bits, goal: Cube, reference: Planner) -> tuple[Row, list[Answer]]:
    """One query by every route."""
    compiled, plain = GapFiller(task, backend="numba"), GapFiller(task, backend="python")

    def again() -> Answer:
        compiled.forget()
        return compiled.fill(state, (goal,))

    routes: list[Callable[[], Answer]] = [
        lambda: compiled.fill(state, (goal,)),
        again,
        lambda: compiled.fill(state, (goal,)),
        lambda: plain.fill(state, (goal,)),
        lambda: reference.fill(state, (goal,)),
    ]
    seconds, answers = [], []
    for route in routes:
        start = perf_counter()
        answers.append(route())
        seconds.append(perf_counter() - start)
    first = answers[0]
    steps = len(first.plan) if isinstance(first, Filled) else -1
    return Row(steps, seconds[-1], dict(zip(COLUMNS, seconds, strict=False))), answers


def show(rows: Sequence[Row], different: int, unsolved: int) -> None:
    """Print the table."""
    steps = sorted(row.steps for row in rows)
    print(f"{len(rows)} queries solved by all, {steps[0]}..{steps[-1]} steps, median {median(steps):g}")
    print(f"{unsolved} left out (impossible, or a limit was met), {different} of different cost")
    slow = sorted(row.reference * 1e3 for row in rows)
    print(f"{'route':10} {'median ms':>10} {'p90 ms':>10} {'median ratio':>13} {'least ratio':>12}")
    print(f"{'UP + FD':10} {median(slow):10.1f} {slow[int(0.9 * len(slow))]:10.1f} {1:13.0f} {1:12.0f}")
    for column in COLUMNS:
        fast = sorted(row.seconds[column] * 1e3 for row in rows)
        ratios = [row.reference / row.seconds[column] for row in rows]
        print(
            f"{column:10} {median(fast):10.3f} {fast[int(0.9 * len(fast))]:10.3f} "
            f"{median(ratios):13.0f} {min(ratios):12.1f}"
        )
    ratio = median(row.reference / row.seconds["cold"] for row in rows)
    met = ratio >= GOAL and not different
    print(f"goal: median ratio of at least {GOAL} at equal cost: {'met' if met else 'MISSED'}")


if __name__ == "__main__":
    main()
