"""How long grounding takes, on a generated kitchen of 40 objects and on the kitchens of this repository.

Run it as ``python experiments/bench/grounding.py [REPEATS]``. The goal is a median of less than 100 milliseconds
for the generated kitchen. Nothing outside Python's standard library takes part.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from pathlib import Path
from statistics import median

from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.model import GroundAtom, Problem, TypedName
from tmd.pddl.reading.reader import read_domain
from tmd.world.compile import compile_problem
from tmd.world.environment import load_environment
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).resolve().parents[2]
GOAL = 0.1


def generated() -> Problem:
    """The kitchen that the tests use, with 40 objects: vessels, tools, places, appliances and their knobs."""
    domain = read_domain(ROOT / "tests" / "pddl" / "cases" / "kitchen" / "domain.pddl")
    counts = {"mug": 5, "pot": 3, "tool": 14, "place": 4, "appliance": 6, "knob": 6}
    named = {kind: [f"{kind}{n}" for n in range(1, count + 1)] for kind, count in counts.items()}
    constants = len(domain.constants)
    objects = tuple(TypedName(name, (kind,)) for kind, names in named.items() for name in names)
    assert len(objects) + constants == 40
    items = named["mug"] + named["pot"] + named["tool"]
    stands = named["place"] + named["appliance"]
    init = {GroundAtom("at", (item, stands[n % len(stands)])) for n, item in enumerate(items)}
    init |= {GroundAtom("controls", pair) for pair in zip(named["knob"], named["appliance"], strict=True)}
    init |= {GroundAtom("clean", (mug,)) for mug in named["mug"]}
    init |= {GroundAtom("near", ("place1",)), GroundAtom("sink", ("place2",))}
    return Problem("generated", domain, objects, frozenset(init))


def problems() -> Iterator[tuple[str, Problem]]:
    """A name and a problem, the generated one first."""
    yield "generated", generated()
    folder = DomainFolder(ROOT / "domains" / "kitchen")
    for path in sorted((ROOT / "problems" / "kitchen" / "environments").glob("*.yaml")):
        yield path.stem, compile_problem(load_environment(path), folder)


def main() -> None:
    """Print a line for each problem, and whether the goal is met."""
    repeats = int(sys.argv[1]) if len(sys.argv) > 1 else 15
    print(f"{'problem':<12}{'objects':>8}{'atoms':>7}{'operators':>10}{'effects':>9}{'median':>12}{'fastest':>12}")
    medians = {}
    for name, problem in problems():
        times = []
        for _ in range(repeats):
            start = time.perf_counter()
            task = ground(problem)
            times.append(time.perf_counter() - start)
        effects = sum(len(o.conditional) for o in task.operators)
        medians[name] = median(times)
        print(
            f"{name:<12}{len(problem.all_objects()):>8}{len(task.atoms):>7}{len(task.operators):>10}{effects:>9}"
            f"{median(times) * 1000:>9.1f} ms{min(times) * 1000:>9.1f} ms"
        )
    met = medians["generated"] < GOAL
    print(f"goal: generated below {GOAL * 1000:.0f} ms: {'met' if met else 'missed'}")


if __name__ == "__main__":
    main()
