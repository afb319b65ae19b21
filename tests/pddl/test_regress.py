"""Regression is exact: a state satisfies a regressed cube if and only if it satisfies the cube afterwards."""

from __future__ import annotations

from random import Random

from hypothesis import given, settings
from hypothesis import strategies as st

from tmd.pddl.model import Instruction
from tmd.pddl.semantics import regress
from tmd.pddl.task import ConditionalEffect, Cube, Operator, Task

from .conftest import few_cases

WIDTH = 5
bits = st.integers(0, 2**WIDTH - 1)
cubes = st.builds(Cube, bits, bits)
effects = st.builds(ConditionalEffect, cubes, bits, bits)
operators = st.builds(
    Operator,
    st.just(Instruction("a")),
    st.builds(Cube, bits, bits),
    bits,
    bits,
    st.lists(effects, max_size=4).map(tuple),
    st.lists(cubes, max_size=2).map(tuple),
)


def _exact(cube: Cube, operator: Operator, states: list[int]) -> None:
    found = regress(cube, operator)
    for state in states:
        expected = operator.applicable(state) and cube.holds(operator.apply(state))
        assert any(c.holds(state) for c in found) == expected, (cube, operator, state, found)
    assert list(found) == sorted(set(found))
    for one in found:
        assert not one.positive & one.negative
        implied = [
            other
            for other in found
            if other != one and other.positive & ~one.positive == 0 and other.negative & ~one.negative == 0
        ]
        assert not implied


@settings(max_examples=1500, deadline=None)
@given(cubes, operators)
def test_in_every_state_of_any_operator(cube: Cube, operator: Operator) -> None:
    _exact(cube, operator, list(range(2**WIDTH)))


@settings(max_examples=500, deadline=None)
@given(st.builds(Cube, st.integers(0, 3), st.integers(0, 3)), operators, bits)
def test_sparse_cubes(cube: Cube, operator: Operator, loose: int) -> None:
    """Few literals and a weak precondition, so that most answers are not trivially false."""
    weak = Operator(
        operator.instruction,
        Cube(operator.precondition.positive & loose & 4, 0),
        operator.add & loose,
        operator.delete & ~loose,
        operator.conditional,
    )
    _exact(cube, weak, list(range(2**WIDTH)))


@few_cases
def test_of_ground_operators(task: Task) -> None:
    """Over the operators of real problems, in states that differ from reachable ones in some atoms."""
    rng = Random(8)
    width = len(task.atoms)
    for _ in range(150):
        operator = rng.choice(task.operators)
        state = task.init
        for _ in range(rng.randint(0, 6)):
            state = rng.choice(task.operators).apply(state)
        after = operator.apply(state)
        literals = rng.sample(range(width), min(4, width))
        positive = sum(1 << n for n in literals if after >> n & 1)
        negative = sum(1 << n for n in literals if not after >> n & 1)
        near = [state] + [state ^ (1 << rng.randrange(width)) for _ in range(30)]
        _exact(Cube(positive, negative), operator, near)
        _exact(Cube(positive, negative & ~1 | (~positive & 1)), operator, near)


def test_by_hand() -> None:
    heat = Operator(Instruction("heat"), Cube(0b1), 0, 0, (ConditionalEffect(Cube(0b10), 0b100, 0),), (Cube(0b1000),))
    assert regress(Cube(0b100), heat) == (Cube(0b0011, 0b1000), Cube(0b0101, 0b1000))
    assert regress(Cube(0, 0b100), heat) == (Cube(0b0001, 0b1110),)
    assert regress(Cube(0b1000), heat) == ()
    assert regress(Cube(), heat) == (Cube(0b0001, 0b1000),)
