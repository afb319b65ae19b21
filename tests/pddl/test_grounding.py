"""The ground task against the semantics it stands for."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from itertools import product
from random import Random
from typing import Any

import pytest

from tmd.diagnostics import LimitError, TmdError
from tmd.pddl import semantics
from tmd.pddl.grounding import instantiate
from tmd.pddl.grounding.ground_task import ground, ground_condition
from tmd.pddl.model import Instruction, Problem, State, universe
from tmd.pddl.reading.reader import parse_domain, parse_problem
from tmd.pddl.task import Task

from .conftest import each_random_problem, few_cases


def _instructions(problem: Problem) -> list[Instruction]:
    """Every instruction whose arguments have the right types."""
    objects = universe(problem)
    return [
        Instruction(action.name, choice)
        for action in problem.domain.actions
        for choice in product(*(objects.of(p.types) for p in action.parameters))
    ]


def _walk(problem: Problem, task: Task, start: State, steps: int, rng: Random) -> list[State]:
    """Compare task and semantics in every state of a random walk; give the states."""
    every = _instructions(problem)
    states = [start]
    for _ in range(steps):
        state = states[-1]
        bits = task.encode(state)
        assert semantics.close(task.decode(bits), problem) == state  # what is derived is no part of a ground state
        goal = semantics.holds(problem.goal, state, problem)
        assert any(cube.holds(bits) for cube in task.goal) == goal
        ours = {o.instruction for o in task.operators if o.applicable(bits)}
        theirs = {i for i in every if semantics.applicable(i, state, problem)}
        assert ours == theirs
        for instruction in sorted(theirs):
            operator = task.by_instruction[instruction]
            after = semantics.close(task.decode(operator.apply(bits)), problem)
            assert after == semantics.apply(instruction, state, problem)
            assert operator.cost == semantics.cost(instruction, problem)
        if not theirs:
            break
        states.append(semantics.apply(rng.choice(sorted(theirs)), state, problem))
    return states


@few_cases
def test_cases(problem: Problem, task: Task) -> None:
    assert semantics.close(task.decode(task.init), problem) == problem.init
    _walk(problem, task, problem.init, 15 if len(task.atoms) < 100 else 3, Random(1))


@each_random_problem
def test_random_problems(random_problem: Problem) -> None:
    task = ground(random_problem)
    for turn in range(3):
        _walk(random_problem, task, random_problem.init, 8, Random(turn))


@each_random_problem
def test_random_problems_from_other_states(random_problem: Problem) -> None:
    """A task made for several initial states is exact from each of them, static facts included."""
    rng = Random(2)
    every = sorted({a for a in random_problem.init})
    other: State = frozenset(a for a in every if rng.random() < 0.6)
    task = ground(random_problem, initial_states=[other])
    _walk(random_problem, task, random_problem.init, 6, rng)
    _walk(random_problem, task, other, 6, rng)


@each_random_problem
def test_random_problems_with_forced_instructions(random_problem: Problem) -> None:
    """After an instruction that was forced through, the task is still exact."""
    rng = Random(4)
    every = _instructions(random_problem)
    if not every:
        return
    forced = rng.sample(every, min(2, len(every)))
    task = ground(random_problem, forced=forced)
    state = random_problem.init
    for instruction in forced:
        bits = task.encode(state)
        operator = task.by_instruction[instruction]
        assert operator.applicable(bits) == semantics.applicable(instruction, state, random_problem)
        state = semantics.apply(instruction, state, random_problem)
        assert task.decode(operator.apply(bits)) == state
        state = _walk(random_problem, task, state, 4, rng)[-1]


@each_random_problem
def test_conditions_over_a_task(random_problem: Problem) -> None:
    task = ground(random_problem)
    objects = universe(random_problem)
    state = random_problem.init
    for action in random_problem.domain.actions:
        for choice in product(*(objects.of(p.types) for p in action.parameters)):
            binding = dict(zip((p.name for p in action.parameters), choice, strict=True))
            cubes = ground_condition(task, action.precondition, binding)
            expected = semantics.holds(action.precondition, state, random_problem, binding)
            assert any(c.holds(task.init) for c in cubes) == expected


def test_every_atom_can_change(task: Task) -> None:
    """No bit is wasted on an atom that holds at the start and that no operator deletes."""
    deleted = added = 0
    for operator in task.operators:
        deleted |= operator.delete
        added |= operator.add
        for _, add, delete in operator.conditional:
            added |= add
            deleted |= delete
    for number in range(len(task.atoms)):
        bit = 1 << number
        assert deleted & bit if task.init & bit else added & bit, task.atoms[number]


def test_what_never_applies_is_left_out(task: Task) -> None:
    names = {o.instruction.name for o in task.operators}
    assert not names & {"paint", "unready"}


@few_cases
def test_the_same_bytes_each_time(problem: Problem, task: Task) -> None:
    again = ground(replace(problem, init=frozenset(sorted(problem.init, reverse=True))))
    assert (task.atoms, task.init, task.goal, task.operators) == (again.atoms, again.init, again.goal, again.operators)
    assert list(task.atoms) == sorted(task.atoms)
    assert [o.instruction for o in task.operators] == sorted(o.instruction for o in task.operators)


STRIPS = """(define (domain d) (:requirements :adl) (:predicates (p ?x) (q ?x) (r ?x ?y) (s))
  (:action a :parameters (?x) :precondition (p ?x) :effect (and (not (p ?x)) (q ?x)))
  (:action b :parameters (?x) :precondition (not (s)) :effect (r ?x ?x))
  (:action c :parameters () :precondition (and (s) (not (s))) :effect (s))
  (:action e :parameters (?x) :precondition (r ?x ?x) :effect (when (p ?x) (not (p ?x)))))"""


def test_small_things_by_hand() -> None:
    domain = parse_domain(STRIPS)
    problem = parse_problem(
        "(define (problem x) (:domain d) (:objects u v) (:init (p u) (r v u)) (:goal (q v)))", domain
    )
    task = ground(problem)
    assert [str(a) for a in task.atoms] == ["(p u)", "(q u)", "(r u u)", "(r v v)"]
    assert [str(a) for a in sorted(task.static)] == ["(r v u)"]
    assert [str(o.instruction) for o in task.operators] == ["a(u)", "b(u)", "b(v)", "e(u)", "e(v)"]
    assert task.goal == ()
    e_u = task.by_instruction[Instruction("e", ("u",))]
    assert (e_u.conditional, e_u.delete) == ((), 1), "deleting p where p holds is deleting p"


def test_the_goal_that_holds_always() -> None:
    domain = parse_domain(STRIPS)
    text = "(define (problem x) (:domain d) (:objects u) (:init) (:goal (not (s))))"
    assert [tuple(c) for c in ground(parse_problem(text, domain)).goal] == [(0, 0)]


def test_too_much_is_refused() -> None:
    predicates = " ".join(f"(m{i}) (n{i})" for i in range(16))
    parts = " ".join(f"(and (m{i}) (n{i}))" for i in range(16))
    text = STRIPS.replace("(s))", f"(s) {predicates})", 1)
    changing = f"(:action change :parameters () :effect (and {predicates}))"
    text = text[:-1] + f"{changing} (:action big :parameters () :precondition (or {parts}) :effect (s)))"
    problem = parse_problem(
        "(define (problem x) (:domain d) (:objects u v) (:init (p u)) (:goal (s)))", parse_domain(text)
    )
    with pytest.raises(TmdError, match=r"condition of big\(\) has more than"):
        ground(problem)
    names = " ".join(f"?x{i}" for i in range(16))
    wide = STRIPS[:-1] + f" (:action wide :parameters ({names} ?y ?z) :effect (s)))"
    objects = " ".join(f"o{i}" for i in range(20))
    problem = parse_problem(
        f"(define (problem x) (:domain d) (:objects {objects}) (:init) (:goal (s)))", parse_domain(wide)
    )
    with pytest.raises(TmdError, match="combinations of objects"):
        ground(problem)


def test_a_thousand_things_in_one_place_are_matched_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """The parcels and the van are at the depot; who asks for each parcel which van is there sees all parcels again."""
    domain = parse_domain("""(define (domain d) (:requirements :typing) (:types truck parcel place)
      (:predicates (at ?x - (either truck parcel) ?p - place) (in ?x - parcel ?t - truck))
      (:action load :parameters (?x - parcel ?t - truck ?p - place)
        :precondition (and (at ?x ?p) (at ?t ?p)) :effect (and (in ?x ?t) (not (at ?x ?p)))))""")
    names = [f"b{number}" for number in range(1_000)]
    facts = " ".join(f"(at {name} depot)" for name in names)
    problem = parse_problem(
        f"(define (problem x) (:domain d) (:objects {' '.join(names)} - parcel van - truck depot - place)"
        f" (:init (at van depot) {facts}) (:goal (in b7 van)))",
        domain,
    )
    matching, seen = semantics.JoinRelation.matching, []

    def counted(relation: semantics.JoinRelation, places: tuple[int, ...], key: semantics.Row) -> Collection[Any]:
        found = matching(relation, places, key)
        seen.append(len(found))
        return found

    monkeypatch.setattr(semantics.JoinRelation, "matching", counted)
    assert len(ground(problem).operators) == 1_000
    assert sum(seen) < 10_000


def test_a_cost_without_a_value_is_refused() -> None:
    text = """(define (domain d) (:requirements :typing :action-costs) (:predicates (p))
      (:functions (total-cost) (f ?x))
      (:action a :parameters (?x) :effect (and (p) (increase (total-cost) (f ?x)))))"""
    goal = "(:goal (p)) (:metric minimize (total-cost))"
    problem = parse_problem(
        f"(define (problem x) (:domain d) (:objects u v) (:init (= (f u) 3)) {goal})", parse_domain(text)
    )
    with pytest.raises(TmdError, match=r"no value for \(f v\)"):
        ground(problem)
    assert semantics.cost(Instruction("a", ("u",)), problem) == 3


def test_forced_instructions_must_exist(problem: Problem) -> None:
    with pytest.raises(TmdError, match='unknown action "fly"'):
        ground(problem, forced=[Instruction("fly")])


HUGE = {
    "parameters": (30, "(and {p})", "(done)"),
    "parameters without a condition": (30, "()", "(done)"),
    "an effect": (0, "()", "(forall ({b}) (when (and (p ?b0) (p ?b1) (p ?b2) (p ?b3) (p ?b4)) (q ?b5)))"),
    "a precondition": (0, "(exists ({b}) (and (q ?b0) (q ?b1)))", "(forall (?x) (q ?x))"),
    "a static precondition": (0, "(exists ({b}) (and (or (q ?b0) (q ?b3) (q ?b5)) (or (q ?b0) (q ?b5))))", "(done)"),
}


@pytest.mark.parametrize("kind", HUGE)
def test_what_is_too_large_is_counted_before_it_is_written_down(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(instantiate, "_MOST_CHECKED", 10_000)
    count, condition, effect = HUGE[kind]
    names = [f"?a{n}" for n in range(count)]
    filled = {"p": " ".join(f"(p {name})" for name in names), "b": " ".join(f"?b{n}" for n in range(6))}
    domain = parse_domain(
        "(define (domain d) (:requirements :adl) (:predicates (p ?x) (q ?x) (done)) (:action a :parameters "
        f"({' '.join(names)}) :precondition {condition.format(**filled)} :effect {effect.format(**filled)}))"
    )
    things = [f"o{n}" for n in range(30)]
    problem = parse_problem(
        f"(define (problem p) (:domain d) (:objects {' '.join(things)})"
        f" (:init {' '.join(f'(p {o})' for o in things)}) (:goal (done)))",
        domain,
    )
    with pytest.raises(LimitError, match="more than"):
        ground(problem)
