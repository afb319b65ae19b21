"""Our semantics against VAL, Fast Downward, unified-planning and the ``pddl`` package."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from random import Random
from typing import Any, TypeAlias

import pytest

from tmd.pddl import semantics
from tmd.pddl.derived import without_derived
from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.model import Atom, GroundAtom, Instruction, Problem
from tmd.pddl.plan_file import read_plan
from tmd.pddl.reading.reader import parse_domain, parse_problem
from tmd.pddl.task import Task
from tmd.pddl.validator import Status, validate
from tmd.pddl.writer import format_domain, format_formula, format_problem

from .conftest import few_cases

STEPS = 25
Outside: TypeAlias = Any
"""An object of a tool that ships no types."""
pytestmark = [
    pytest.mark.filterwarnings("ignore:.*deprecated.*:DeprecationWarning"),
    pytest.mark.filterwarnings("ignore::UserWarning:unified_planning"),
]


def _fact(atom: GroundAtom) -> str:
    """An atom as Fast Downward's translator names it."""
    return f"{atom.predicate}({', '.join(atom.args)})"


def test_val_reads_what_we_write(problem: Problem, write: Callable[..., Any], val: Outside) -> None:
    assert val.parse(write(problem)) == "Errors: 0, warnings: 0"


def test_val_gives_the_same_verdict(
    plan_path: Path, plan_problem: Problem, write: Callable[..., Any], val: Outside
) -> None:
    plan = read_plan(plan_path)
    ours = validate(plan_problem, plan.instructions)
    valid, step, value = val.validate(write(plan_problem), plan_path.read_text(encoding="utf-8"))
    assert valid == ours.valid
    if ours.status is Status.BROKEN_PRECONDITION:
        assert step == ours.step
    if valid:
        assert value == ours.cost


@few_cases
def test_val_follows_random_walks(problem: Problem, task: Task, write: Callable[..., Any], val: Outside) -> None:
    """A random walk is executable, and stops being so at the step where a broken instruction is put in."""
    rng = Random(5)
    walk: list[Instruction] = []
    bits = task.init
    for _ in range(STEPS):
        choices = [o for o in task.operators if o.applicable(bits)]
        if not choices:
            break
        chosen = rng.choice(choices)
        walk.append(chosen.instruction)
        bits = chosen.apply(bits)
    broken = next((o for o in task.operators if not o.applicable(bits)), None)
    assert broken is not None
    written = write(problem)
    plan = "\n".join(i.pddl() for i in (*walk, broken.instruction))
    assert val.validate(written, plan)[:2] == (False, len(walk) + 1)
    assert validate(problem, (*walk, broken.instruction)).step == len(walk) + 1


@few_cases
def test_fast_downward_has_the_same_instructions_and_successors(
    problem: Problem, task: Task, write: Callable[..., Any], translate: Callable[..., Any]
) -> None:
    """We leave out no operator of theirs, except such as never apply in truth."""
    sas = translate(write(problem))
    assert {o.instruction.pddl()[1:-1] for o in task.operators} <= {name for name, _, _ in sas.operators}
    _same_successors(task, sas)


def _same_successors(task: Task, sas: Outside) -> None:
    """In every state of a random walk."""
    known = sas.known()
    rng = Random(11)
    bits, state = task.init, sas.derive(sas.start)
    for _ in range(STEPS):
        theirs = sas.successors(state)
        ours = {o.instruction.pddl()[1:-1]: o for o in task.operators if o.applicable(bits)}
        assert sorted(ours) == sorted(theirs)
        for name, operator in ours.items():
            after = {_fact(a) for a in task.decode(operator.apply(bits))} & known
            assert after == sas.facts(theirs[name]), name
        if not ours:
            break
        chosen = rng.choice(sorted(ours))
        bits, state = ours[chosen].apply(bits), theirs[chosen]


def test_fast_downward_agrees_on_random_problems(
    random_problem: Problem, write: Callable[..., Any], translate: Callable[..., Any]
) -> None:
    """With a goal that is neither settled nor out of reach: for those it writes an empty task."""
    task = ground(random_problem)
    if not task.atoms:
        pytest.skip("nothing changes in this problem")
    goal = Atom(task.atoms[0].predicate, task.atoms[0].args)
    problem = replace(random_problem, goal=goal)
    _same_successors(ground(problem), translate(write(problem)))


def test_val_agrees_on_random_problems(random_problem: Problem, write: Callable[..., Any], val: Outside) -> None:
    """On random plans of any instructions: the verdict, and the step that fails."""
    assert val.parse(write(random_problem)) == "Errors: 0, warnings: 0"
    operators = ground(random_problem).operators
    rng = Random(7)
    for length in range(5):
        plan = [rng.choice(operators).instruction for _ in range(length if operators else 0)]
        ours = validate(random_problem, plan)
        valid, step, _ = val.validate(write(random_problem), "\n".join(i.pddl() for i in plan))
        assert valid == ours.valid
        if ours.status is Status.BROKEN_PRECONDITION:
            assert step == ours.step


@few_cases
def test_pddl_package_reads_and_writes_it(
    problem: Problem, write: Callable[..., Any], fixed_costs: Callable[[Problem], bool]
) -> None:
    pddl = pytest.importorskip("pddl", reason="the pddl package is not installed")
    from pddl.formatter import domain_to_string, problem_to_string

    if not fixed_costs(problem):
        pytest.skip("the pddl package refuses cost functions with parameters unless :numeric-fluents is declared")
    if "(forall" in format_formula(problem.goal) or "(exists" in format_formula(problem.goal):
        pytest.skip("the pddl package 0.5.1 refuses quantified goals whatever is declared")
    written = write(problem)
    domain_text = domain_to_string(pddl.parse_domain(str(written.domain_file)))
    problem_text = problem_to_string(pddl.parse_problem(str(written.problem_file)))
    domain = parse_domain(domain_text)
    again = parse_problem(problem_text, domain)
    before, after = ground(written.problem), ground(again)
    assert (before.atoms, before.init, before.goal) == (after.atoms, after.init, after.goal)
    assert before.operators == after.operators


@pytest.fixture
def unified(problem: Problem, write: Callable[..., Any]) -> Outside:
    """The problem, read by unified-planning from what we write."""
    return _unified(write(without_derived(problem)))


def _unified(written: Outside) -> Outside:
    pytest.importorskip("unified_planning", reason="unified-planning is not installed")
    from unified_planning.environment import get_environment
    from unified_planning.io import PDDLReader

    get_environment().credits_stream = None
    return PDDLReader().parse_problem(str(written.domain_file), str(written.problem_file))


def _their_action(unified: Outside, instruction: Instruction) -> Outside:
    from unified_planning.plans import ActionInstance

    arguments = tuple(unified.object(a) for a in instruction.args)
    return ActionInstance(unified.action(instruction.name), arguments)


@few_cases
def test_unified_planning_has_the_same_successors(problem: Problem, task: Task, unified: Outside) -> None:
    """Its simulator takes up to a second a question, so few of them."""
    from unified_planning.engines.sequential_simulator import UPSequentialSimulator

    simulator = UPSequentialSimulator(unified, error_on_failed_checks=False)
    rng = Random(3)
    state, theirs = problem.init, simulator.get_initial_state()
    fluents = {f.name: f for f in unified.fluents}
    steps, each = (4, 4) if len(task.atoms) < 100 else (1, 2)
    for _ in range(steps):
        bits = task.encode(state)
        open_now = [o for o in task.operators if o.applicable(bits)]
        closed = [o for o in task.operators if not o.applicable(bits)]
        for operator in rng.sample(open_now, min(each, len(open_now))) + rng.sample(closed, min(each, len(closed))):
            their = _their_action(unified, operator.instruction)
            answer = simulator.is_applicable(theirs, their.action, their.actual_parameters)
            assert answer == operator.applicable(bits), operator.instruction
        if not open_now:
            break
        chosen = rng.choice(open_now).instruction
        their = _their_action(unified, chosen)
        theirs = simulator.apply(theirs, their.action, their.actual_parameters)
        state = semantics.apply(chosen, state, problem)
        for atom in task.atoms:
            value = theirs.get_value(fluents[atom.predicate](*(unified.object(a) for a in atom.args)))
            assert value.bool_constant_value() == (atom in state), (chosen, atom)


def test_unified_planning_gives_the_same_verdict(
    plan_path: Path, plan_problem: Problem, write: Callable[..., Any]
) -> None:
    plan = read_plan(plan_path).instructions
    ours = validate(plan_problem, plan)
    if ours.status is Status.BAD_INSTRUCTION:
        pytest.skip("unified-planning cannot even write down such a plan")
    unified = _unified(write(without_derived(plan_problem)))
    from unified_planning.engines.plan_validator import SequentialPlanValidator
    from unified_planning.plans import SequentialPlan

    validator = SequentialPlanValidator()
    validator.skip_checks = True
    verdict = validator.validate(unified, SequentialPlan([_their_action(unified, i) for i in plan]))
    assert (verdict.status.name == "VALID") == ours.valid


def test_writing_is_a_fixed_point(problem: Problem) -> None:
    text = format_domain(problem.domain)
    domain = parse_domain(text)
    assert domain == problem.domain
    assert format_domain(domain) == text
    again = parse_problem(format_problem(problem), domain)
    assert again == problem
    assert format_problem(again) == format_problem(problem)
