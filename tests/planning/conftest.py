"""Tasks to search in: a small pantry, and the kitchens as they were when queries were recorded in them."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from random import Random
from typing import Any

import pytest

from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.model import GroundAtom, Instruction, Problem
from tmd.pddl.reading.reader import read_domain, read_problem
from tmd.pddl.task import Bits, Cube, Operator, Task

HERE = Path(__file__).parent
QUERIES = HERE / "queries"


@pytest.fixture(scope="session")
def pantry_problem() -> Problem:
    domain = read_domain(HERE / "cases" / "pantry.pddl")
    return read_problem(HERE / "cases" / "pantry-problem.pddl", domain)


@pytest.fixture(scope="session")
def pantry(pantry_problem: Problem) -> Task:
    return ground(pantry_problem)


@dataclass(frozen=True)
class Query:
    """A recorded question, with what Fast Downward said of it."""

    name: str
    task: Task
    state: Bits
    goal: Cube
    verdict: str
    cost: int


@cache
def kitchen(name: str) -> Task:
    """A kitchen as it was when queries were recorded in it."""
    return ground(read_problem(QUERIES / f"{name}.pddl", read_domain(QUERIES / "domain.pddl")))


@pytest.fixture(scope="session")
def any_kitchen() -> Callable[[str], Task]:
    return kitchen


@pytest.fixture(scope="session")
def queries_of() -> Callable[[str], tuple[Query, ...]]:
    return recorded


@pytest.fixture(scope="session")
def walk() -> Callable[[Task, Random, int], list[Bits]]:
    return random_walk


@cache
def recorded(name: str) -> tuple[Query, ...]:
    """The queries recorded in one kitchen."""
    task = kitchen(name)
    lines = (QUERIES / f"{name}.jsonl").read_text(encoding="utf-8").splitlines()
    return tuple(_query(task, f"{name}:{number}", json.loads(line)) for number, line in enumerate(lines, 1))


def _query(task: Task, name: str, line: dict[str, Any]) -> Query:
    state = task.init
    for text in line["walk"]:
        action, arguments = text.rstrip(")").split("(")
        operator = task.by_instruction[Instruction(action, tuple(filter(None, arguments.split(", "))))]
        assert operator.applicable(state)
        state = operator.apply(state)
    goal = Cube(_bits(task, line["goal"]), _bits(task, line["not"]))
    return Query(name, task, state, goal, line["verdict"], line.get("cost", -1))


def _bits(task: Task, atoms: Sequence[str]) -> Bits:
    bits = 0
    for text in atoms:
        predicate, *arguments = text.strip("()").split()
        bits |= 1 << task.index[GroundAtom(predicate, tuple(arguments))]
    return bits


def random_walk(task: Task, random: Random, length: int) -> list[Bits]:
    """The states of a random walk from the initial state; rare actions are as likely as frequent ones."""
    states = [task.init]
    for _ in range(length):
        open_now: dict[str, list[Operator]] = {}
        for operator in task.operators:
            if operator.applicable(states[-1]):
                open_now.setdefault(operator.instruction.name, []).append(operator)
        if not open_now:
            break
        states.append(random.choice(open_now[random.choice(sorted(open_now))]).apply(states[-1]))
    return states
