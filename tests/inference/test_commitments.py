"""Constraints as a task: what is left of it brings nothing about that is forbidden, and everything else as before."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tmd.inference.commitments import constrained, violated
from tmd.pddl.ground_formula import conjunction, negation
from tmd.pddl.model import Atom, Formula
from tmd.pddl.semantics import holds
from tmd.pddl.task import Bits, Task
from tmd.readers.interface import PlanConstraints
from tmd.world.corpus import Corpus
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).parents[2]


@cache
def task() -> Task:
    corpus = Corpus(DomainFolder(ROOT / "domains" / "04_tea"), ROOT / "problems" / "04_tea")
    return corpus.world("pantry1").task


def held(condition: Formula, state: Bits) -> bool:
    return holds(condition, task().decode(state), task().problem)


@st.composite
def conditions(draw: st.DrawFn) -> Formula:
    """A conjunction of one to three literals over atoms that may change."""
    literals = []
    for atom in draw(st.lists(st.sampled_from(task().atoms), min_size=1, max_size=3, unique=True)):
        literal = Atom(atom.predicate, atom.args)
        literals.append(literal if draw(st.booleans()) else negation(literal))
    return conjunction(literals)


@given(conditions(), st.integers(0, 10_000))
def test_an_operator_is_left_out_exactly_where_it_brings_the_condition_about(never: Formula, seed: int) -> None:
    constraints = PlanConstraints(never=(never,))
    left = constrained(task(), constraints).by_instruction
    random = np.random.default_rng(seed)
    state = task().init
    for _ in range(12):
        able = [o for o in task().operators if o.applicable(state)]
        for operator in able:
            after = operator.apply(state)
            kept = operator.instruction in left and left[operator.instruction].applicable(state)
            broken = not held(never, state) and holds(never, task().decode(after), task().problem)
            assert (violated(task(), constraints, [state, after]) == never) == broken
            if len(operator.conditional) > 1:
                continue  # effects under two conditions are not looked at together: whole plans are checked
            if broken:
                assert not kept
            elif not held(never, after):
                assert kept
        state = able[int(random.integers(len(able)))].apply(state)


def test_nothing_forbidden_leaves_the_task_as_it_is() -> None:
    assert constrained(task(), PlanConstraints()) is task()
