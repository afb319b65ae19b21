"""Every bundled planning problem: read, written and read again, still what its environment says, and solvable."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.bundled import corpus
from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.model import Problem
from tmd.pddl.reading.reader import parse_problem, read_domain, read_problem
from tmd.pddl.validator import validate
from tmd.pddl.writer import format_problem
from tmd.planning.backends import solve
from tmd.planning.result import Solved
from tmd.world.compile import compile_problem
from tmd.world.corpus import replay
from tmd.world.environment import load_environment
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).parents[2]
PROBLEMS = sorted(ROOT.glob("problems/*/p*.pddl"))
CORPORA = sorted({p.parent.parent for p in ROOT.glob("problems/*/*/demonstrations.jsonl")})


def read(path: Path) -> Problem:
    return read_problem(path, read_domain(ROOT / "domains" / path.parent.name / "domain.pddl"))


@pytest.mark.parametrize("path", PROBLEMS, ids=lambda p: p.stem)
def test_a_problem_survives_a_round_trip(path: Path) -> None:
    problem = read(path)
    again = parse_problem(format_problem(problem), problem.domain)
    assert (again.init, again.objects, again.goal) == (problem.init, problem.objects, problem.goal)


@pytest.mark.parametrize("path", PROBLEMS, ids=lambda p: p.stem)
def test_a_problem_is_what_its_environment_compiles_to(path: Path) -> None:
    environment = next((path.parent / "environments").glob(f"{path.stem.rpartition('-')[2]}.*"))
    folder = DomainFolder(ROOT / "domains" / path.parent.name)
    problem = read(path)
    if environment.suffix == ".pddl":
        compiled = read_problem(environment, folder.domain)
    else:
        compiled = compile_problem(load_environment(environment), folder)
    assert problem.init == compiled.init
    assert sorted(o.name for o in problem.objects) == sorted(o.name for o in compiled.objects)


@pytest.mark.parametrize("path", PROBLEMS, ids=lambda p: p.stem)
def test_a_problem_has_a_goal_that_relaxed_reachability_admits_and_words_for_it(path: Path) -> None:
    task = ground(read(path))
    assert task.goal
    assert not any(cube.holds(task.init) for cube in task.goal)
    assert path.with_suffix(".nl").read_text().strip()


@pytest.mark.parametrize("path", PROBLEMS, ids=lambda p: p.stem)
def test_a_problem_is_solved_and_its_plan_works(path: Path) -> None:
    pytest.importorskip("up_fast_downward", reason="the longer problems need Fast Downward")
    problem = read(path)
    answer = solve(problem)
    assert isinstance(answer, Solved)
    assert validate(problem, answer.plan).valid


@pytest.mark.parametrize("directory", CORPORA, ids=lambda p: p.name)
def test_every_fact_that_a_demonstration_brings_about_is_reachable_in_the_ground_task(directory: Path) -> None:
    own = corpus(directory.name)
    for number, demonstration in enumerate(own.demonstrations()):
        world = own.world(demonstration.environment)
        assert all(i in world.task.by_instruction for i in demonstration.instructions), demonstration.id
        for state in replay(demonstration, world.task.problem) if number % 4 == 0 else ():
            assert world.task.decode(world.task.encode(state)) == state, demonstration.id
