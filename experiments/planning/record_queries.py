"""Record gap queries from random walks in the kitchens, with the verdict of Fast Downward.

    python experiments/planning/record_queries.py --output tests/planning/queries

Writes, for each environment, the domain and the problem as they are now (so that what was recorded stays true when
the kitchens change) and one JSON line per query: the walk from the initial state, the goal, and what Fast Downward
says of it. About a second per query; impossible goals take the whole time limit.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.normalise import portable
from tmd.pddl.task import Bits, Cube, Operator, Task
from tmd.pddl.writer import format_domain, format_problem
from tmd.planning.backends import fast_downward_for_gaps
from tmd.planning.result import Answer, Filled, GaveUp, Planner, Unreachable
from tmd.planning.search.flat_task import ones
from tmd.world.compile import compile_problem
from tmd.world.environment import load_environment
from tmd.world.folder import find_domain

SHARES = {"precondition": 0.6, "effect": 0.32, "effects": 0.05, "twice": 0.03}
"""How often a goal is the precondition of an operator, one of its effects, an effect of each of two, or two atoms
about one thing, such as one mug in two places, which are often impossible together."""

LONGEST_WALK = 25


def main() -> None:
    """Record queries for every environment of a domain."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("--domain", default="kitchen")
    parser.add_argument("--count", type=int, default=110, help="queries per environment")
    parser.add_argument("--seed", type=int, default=20)
    parser.add_argument("--time-limit", type=float, default=10.0, help="seconds of Fast Downward per query")
    arguments = parser.parse_args()
    folder = find_domain(arguments.domain)
    environments = sorted((Path("problems") / arguments.domain / "environments").glob("*.yaml"))
    arguments.output.mkdir(parents=True, exist_ok=True)
    for number, path in enumerate(environments):
        problem = portable(compile_problem(load_environment(path), folder))
        (arguments.output / "domain.pddl").write_text(format_domain(problem.domain), encoding="utf-8")
        (arguments.output / f"{path.stem}.pddl").write_text(format_problem(problem), encoding="utf-8")
        task = ground(problem)
        random = np.random.default_rng([arguments.seed, number])
        reference = fast_downward_for_gaps(task, time_limit=arguments.time_limit)
        lines = [json.dumps(query(task, random, reference)) for _ in range(arguments.count)]
        (arguments.output / f"{path.stem}.jsonl").write_text("\n".join(lines) + "\n", encoding="utf-8")
        print(path.stem, len(lines), flush=True)


def query(task: Task, random: np.random.Generator, reference: Planner) -> dict[str, object]:
    """One query that is not satisfied at once, with its verdict."""
    while True:
        walk, state = random_walk(task, random, int(random.integers(0, LONGEST_WALK + 1)))
        goal = random_goal(task, random)
        if not goal.holds(state) and not goal.positive & goal.negative:
            break
    return {
        "walk": [f"{operator.instruction}" for operator in walk],
        "goal": [str(atom) for atom in task.names(goal.positive)],
        "not": [str(atom) for atom in task.names(goal.negative)],
        **verdict(reference.fill(state, (goal,))),
    }


def verdict(answer: Answer) -> dict[str, object]:
    """What is kept of an answer."""
    match answer:
        case Filled(_, _, cost):
            return {"verdict": "solved", "cost": cost}
        case Unreachable():
            return {"verdict": "unreachable"}
        case GaveUp():
            return {"verdict": "gave up"}


def random_walk(task: Task, random: np.random.Generator, length: int) -> tuple[list[Operator], Bits]:
    """Operators executed from the initial state, action names drawn first so that rare ones occur."""
    state, walk = task.init, []
    for _ in range(length):
        open_now = [operator for operator in task.operators if operator.applicable(state)]
        if not open_now:
            break
        walk.append(drawn(open_now, random))
        state = walk[-1].apply(state)
    return walk, state


def random_goal(task: Task, random: np.random.Generator) -> Cube:
    """A goal as inference asks for it, drawn by :data:`SHARES`."""
    kind = random.choice(list(SHARES), p=list(SHARES.values()))
    if kind == "precondition":
        return drawn(task.operators, random).precondition
    if kind == "twice":
        return about_one_thing(task, random)
    first = random_effect(task, random)
    if kind == "effect":
        return first
    second = random_effect(task, random)
    return Cube(first.positive | second.positive, first.negative | second.negative)


def about_one_thing(task: Task, random: np.random.Generator) -> Cube:
    """Two atoms of one predicate with the same first argument."""
    while True:
        first = int(random.integers(len(task.atoms)))
        atom = task.atoms[first]
        others = [
            number
            for number, other in enumerate(task.atoms)
            if len(atom.args) > 1 and number != first and other[0] == atom[0] and other.args[:1] == atom.args[:1]
        ]
        if others:
            return Cube(1 << first | 1 << int(random.choice(others)), 0)


def random_effect(task: Task, random: np.random.Generator) -> Cube:
    """One literal that some operator makes true; nine in ten are positive where there is a choice."""
    add = delete = 0
    while not add | delete:
        operator = drawn(task.operators, random)
        add, delete = operator.add, operator.delete
        for effect in operator.conditional:
            add, delete = add | effect.add, delete | effect.delete
    added, deleted = ones(add), ones(delete & ~add)
    if added and (not deleted or random.random() < 0.9):
        return Cube(1 << int(random.choice(added)), 0)
    return Cube(0, 1 << int(random.choice(deleted)))


def drawn(operators: Sequence[Operator], random: np.random.Generator) -> Operator:
    """An operator; first the action, then its arguments."""
    names = sorted({operator.instruction.name for operator in operators})
    name = str(random.choice(names))
    matching = [operator for operator in operators if operator.instruction.name == name]
    return matching[int(random.integers(len(matching)))]


if __name__ == "__main__":
    main()
