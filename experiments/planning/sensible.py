"""Measure whether right plans are ones that people would carry out.

    python -m experiments.planning.sensible kitchen living_room --cases FILE... [--output plans.jsonl]

For each request whose first plan ends in the gold goal: whether it leaves something open or working that was not, a
thing in the hand, or a thing on the floor, where the gold goal speaks of none of that; and its length against the
cheapest plan for the gold goal that leaves nothing so. Prints shares, the plans that are longest in proportion, and
the requests that take longest.
"""

from __future__ import annotations

import argparse
import json
from collections import defaultdict
from collections.abc import Collection, Sequence
from pathlib import Path
from time import perf_counter
from typing import Any

from tmd.domain_kit import DomainKit
from tmd.evaluation.sentence_tests import judge
from tmd.goals.sources.table import PutBack
from tmd.knowledge import known
from tmd.pddl.ground_formula import goal_cubes
from tmd.pddl.model import Formula, predicates_of
from tmd.pddl.reading.reader import with_goal
from tmd.pddl.task import Bits, Cube, Task
from tmd.planning.result import Filled
from tmd.planning.search.in_process import OptimalSearch
from tmd.records.sentence_test import Outcome
from tmd.world.roots import Roots
from tmd.world.sentence_file import SentenceTest, domain_sentences, read_sentences
from tmd.world.world import World

KINDS = {"open": ("opened",), "working": ("active",), "hand": ("holding", "held", "carrying"), "floor": ("at", "on")}
"""Kinds of untidiness, each with the predicates that show it."""
CAP = 60_000
"""Generated states after which the cheapest plan is not looked for any further."""


def untidy(world: World, goal: Formula, left: Collection[PutBack]) -> dict[str, Bits]:
    """Return for each kind the atoms that do not hold at the start and that the goal does not speak of.

    What demonstrations leave as it came about (``left``), an opened packet, is not untidy.
    """
    task, start, kinds = world.task, world.task.init, world.mentions.kinds
    text = repr(goal)
    named = predicates_of(goal)
    found: dict[str, Bits] = defaultdict(int)
    for bit, atom in enumerate(task.atoms):
        if start >> bit & 1 or not atom.args:
            continue
        for kind, predicates in KINDS.items():
            if PutBack(atom.predicate, kinds.get(atom.args[0], "")) in left:
                continue
            if atom.predicate not in predicates or (kind == "floor") != ("floor" in atom.args):
                continue
            if (kind == "floor" and "floor" in text) or (kind != "floor" and atom.predicate in named):
                continue
            found[kind] |= 1 << bit
    return found


def cheapest(task: Task, start: Bits, goal: Formula, forbidden: Bits) -> int | None:
    """Return the length of the cheapest plan that ends without ``forbidden`` atoms; ``None`` where it is not found."""
    cubes = [Cube(c.positive, c.negative | forbidden & ~c.positive) for c in goal_cubes(task, goal)]
    answer = OptimalSearch(task, cap=CAP).fill(start, cubes)
    return len(answer.plan) if isinstance(answer, Filled) else None


def measured(test: SentenceTest, kit: DomainKit, left: Collection[PutBack]) -> dict[str, object]:
    """Return what was measured for one request: the seconds alone where its plan is not right."""
    began = perf_counter()
    grounded = kit.ground(test.text, test.environment)
    seconds = {"id": test.id, "text": test.text, "seconds": round(perf_counter() - began, 2)}
    world = grounded.world
    result = judge(test, grounded, world.task.problem)
    if result.outcome is not Outcome.RIGHT or test.goal is None:
        return {**seconds, "planned": bool(grounded.plans)}
    task, start = world.task, world.task.init
    goal = with_goal(task.problem, test.goal, "goal").goal
    assert goal is not None
    end = next(p.state for p, v in zip(grounded.plans, grounded.verdicts, strict=True) if v.valid)
    own = untidy(world, goal, left)
    found = {kind: [str(a) for a in task.names(end & bits)] for kind, bits in own.items() if end & bits}
    forbidden = 0
    for bits in own.values():
        forbidden |= bits
    best = cheapest(task, start, goal, forbidden)
    return {
        **seconds, "planned": True, "environment": test.environment, "plan": list(result.plan), "left": found,
        "steps": len(result.plan), "best": best,
    }  # fmt: skip


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure the sentence tests of domains and of files."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("domains", nargs="*")
    parser.add_argument("--cases", type=Path, nargs="*", default=[])
    parser.add_argument("--output", type=Path)
    given = parser.parse_args(arguments)
    roots = Roots()
    tests = [t for d in given.domains for t in domain_sentences(roots.corpus(roots.folder(d)).directory)]
    tests += [t for path in given.cases for t in read_sentences(path)]
    kits: dict[str, DomainKit] = {}
    left: dict[str, frozenset[PutBack]] = {}
    rows: list[dict[str, Any]] = []
    for test in tests:
        if test.domain not in kits:
            corpus = roots.corpus(roots.folder(test.domain))
            kits[test.domain], goals = DomainKit(corpus), known(corpus).goals
            left[test.domain] = goals.unrestored if goals is not None else frozenset()
            kits[test.domain].ground(test.text, test.environment)  # reads what was learned, which is not measured
        rows.append(measured(test, kits[test.domain], left[test.domain]))
        if given.output:
            with given.output.open("a", encoding="utf-8") as file:
                file.write(json.dumps(rows[-1]) + "\n")
    report(rows)


def report(measurements: Sequence[dict[str, Any]]) -> None:
    """Print the slowest requests, and the shares of right plans."""
    slowest = sorted(measurements, key=lambda row: -row["seconds"])
    print(f"above 3 s: {sum(row['seconds'] > 3 for row in slowest)} of {len(slowest)}")
    print(f"without a plan, above 2 s: {sum(row['seconds'] > 2 for row in slowest if not row['planned'])}")
    for row in slowest[:5]:
        print(f"{row['seconds']:.2f} s {row['id']} {row['text']}")
    report_right([row for row in measurements if "steps" in row])


def report_right(rows: Sequence[dict[str, Any]]) -> None:
    """Print the shares of right plans, and those that are longest in proportion."""
    count = len(rows)
    for kind in KINDS:
        own = [row for row in rows if kind in row["left"]]
        print(f"{kind}: {len(own)} of {count} ({100 * len(own) / max(count, 1):.1f} %)")
    ratios = [(row["steps"] / row["best"], row) for row in rows if row["best"]]
    if ratios:
        mean = sum(ratio for ratio, _ in ratios) / len(ratios)
        print(f"length: mean {mean:.3f}, above 1.5: {sum(ratio > 1.5 for ratio, _ in ratios)}")
    print(f"cheapest plan unknown: {sum(row['best'] is None for row in rows)}")
    for ratio, row in sorted(ratios, key=lambda pair: -pair[0])[:15]:
        print(f"{ratio:.2f} {row['id']} {row['steps']}/{row['best']} {row['text']}")


if __name__ == "__main__":
    main()
