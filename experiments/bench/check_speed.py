"""How fast ``tmd check`` is: the kitchen with start-up, and how time grows with the size of domain and problem.

``python experiments/bench/check_speed.py`` prints seconds of processor time, the best of three, and how
they grow from each size to the next.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from tmd.check.checker import Checker

ROOT = Path(__file__).resolve().parents[2]
SIZES = ((25, 250), (50, 500), (100, 1_000), (200, 2_000))
"""Actions of the domain, objects of the problem."""


def main() -> None:
    """Measure and print."""
    command = [sys.executable, "-m", "tmd", "check", "domains/kitchen"]
    kitchen = best(lambda: subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.DEVNULL))
    print(f"tmd check domains/kitchen, start-up included: {kitchen:.2f} s")
    before = None
    for actions, objects in SIZES:
        seconds = measured(actions, objects)
        growth = f", {seconds / before:.1f} times the one before" if before else ""
        print(f"{actions} actions, {objects} objects, {3 * objects} atoms: {seconds:.2f} s{growth}")
        before = seconds


def measured(actions: int, objects: int) -> float:
    """Seconds for a domain and a problem of that size."""
    with tempfile.TemporaryDirectory() as directory:
        folder = Path(directory)
        (folder / "domain.pddl").write_text(domain(actions))
        (folder / "p01.pddl").write_text(problem(actions, objects))
        return best(lambda: checked(folder))


def checked(folder: Path) -> None:
    """Check a folder, in which there is nothing wrong."""
    checker = Checker()
    checker.check(folder)
    checker.finish()
    assert not checker.findings.sorted()


def domain(actions: int) -> str:
    """A chain of machines: each action makes what the next one needs."""
    predicates = "\n    ".join(f"(made{n} ?x - item)" for n in range(actions + 1))
    schemas = "\n".join(
        f"""  (:action step{n}
    :parameters (?x - item ?m - machine)
    :precondition (and (made{n} ?x) (at ?x ?m) (not (busy ?m)))
    :effect (and (made{n + 1} ?x) (not (made{n} ?x)) (when (near ?m ?m) (busy ?m))))"""
        for n in range(actions)
    )
    return f"""(define (domain factory)
  (:requirements :strips :typing :negative-preconditions :conditional-effects)
  (:types item machine - object)
  (:predicates
    (at ?x - item ?m - machine) (near ?m - machine ?n - machine) (busy ?m - machine)
    {predicates})
{schemas})
"""


def problem(actions: int, objects: int) -> str:
    """Half items, half machines; three atoms for each object."""
    half = objects // 2
    items, machines = [f"i{n}" for n in range(half)], [f"m{n}" for n in range(half)]
    atoms = [f"(at {i} {m})" for i, m in zip(items, machines, strict=True)]
    atoms += [f"(made0 {i})" for i in items]
    atoms += [f"(near {m} {machines[(n + k) % half]})" for n, m in enumerate(machines) for k in range(4)]
    return f"""(define (problem all)
  (:domain factory)
  (:objects {" ".join(items)} - item {" ".join(machines)} - machine)
  (:init {" ".join(atoms)})
  (:goal (made{actions} i0)))
"""


def best(work: Callable[[], object]) -> float:
    """Seconds of processor time, children included, of the quickest of three runs: others may use the machine."""
    times = []
    for _ in range(3):
        start = sum(os.times()[:4])
        work()
        times.append(sum(os.times()[:4]) - start)
    return min(times)


if __name__ == "__main__":
    main()
