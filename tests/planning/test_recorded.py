"""Gap queries recorded in five kitchens, with the verdicts of Fast Downward at the time of recording.

A sample is asked of Fast Downward again, so that neither the recording nor the way to it goes stale.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Protocol

import pytest

from tmd.pddl import semantics
from tmd.pddl.task import Bits, Cube, Task
from tmd.planning.backends import fast_downward_for_gaps
from tmd.planning.gap_filler import GapFiller
from tmd.planning.result import Filled, GaveUp, Unreachable

NAMES = sorted(path.stem for path in (Path(__file__).parent / "queries").glob("*.jsonl"))


class Query(Protocol):
    name: str
    task: Task
    state: Bits
    goal: Cube
    verdict: str
    cost: int


Queries = Callable[[str], Sequence[Query]]


def test_there_are_enough(queries_of: Queries) -> None:
    everything = [query for name in NAMES for query in queries_of(name)]
    assert len(everything) >= 500
    assert sum(query.verdict == "solved" for query in everything) >= 500
    assert max(query.cost for query in everything) >= 12


def test_hardly_any_search_ends_at_its_cap(queries_of: Queries) -> None:
    """Of what Fast Downward solved in ten seconds, 99 % is solved within the usual cap: asked of every sixth."""
    solvable = [query for name in NAMES for query in queries_of(name) if query.verdict == "solved"][::6]
    fillers = {name: GapFiller(queries_of(name)[0].task) for name in NAMES}
    capped = [
        query.name
        for query in solvable
        if isinstance(fillers[query.name.split(":")[0]].fill(query.state, (query.goal,)), GaveUp)
    ]
    assert len(capped) <= len(solvable) // 100, capped


@pytest.mark.parametrize("name", NAMES)
def test_cost_and_solvability_are_those_of_fast_downward(name: str, queries_of: Queries) -> None:
    """Of one query in five; one in fifteen is replayed under the lifted domain as well, which is slow."""
    queries = queries_of(name)[NAMES.index(name) :: 5]
    filler = GapFiller(queries[0].task, cap=5_000)
    for number, query in enumerate(queries):
        answer = filler.fill(query.state, (query.goal,))
        if query.verdict == "solved" and not isinstance(answer, GaveUp):
            assert isinstance(answer, Filled), query.name
            assert answer.cost == query.cost, query.name
        elif query.verdict == "unreachable":
            assert isinstance(answer, Unreachable), query.name
        if isinstance(answer, Filled):
            state = query.state
            for instruction in answer.plan:
                operator = query.task.by_instruction[instruction]
                assert operator.applicable(state)
                state = operator.apply(state)
            assert state == answer.state
            assert query.goal.holds(state)
            if number % 3 == 0:
                _replayed(query, answer)


def _replayed(query: Query, answer: Filled) -> None:
    """The plan works under the semantics of the lifted domain, and ends in the same state."""
    problem = query.task.problem
    state = query.task.decode(query.state)
    for instruction in answer.plan:
        assert semantics.applicable(instruction, state, problem), (query.name, instruction)
        state = semantics.apply(instruction, state, problem)
    assert query.task.encode(state) == answer.state


def test_a_sample_is_asked_of_fast_downward_again(queries_of: Queries) -> None:
    pytest.importorskip("up_fast_downward", reason="Fast Downward is not installed")
    queries = [query for query in queries_of(NAMES[0]) if query.verdict != "gave up"]
    chosen = queries[len(queries) // 2 :][:1]
    reference = fast_downward_for_gaps(queries[0].task)
    for query in chosen:
        answer = reference.fill(query.state, (query.goal,))
        if query.verdict == "solved":
            assert isinstance(answer, Filled)
            assert answer.cost == query.cost
        else:
            assert isinstance(answer, Unreachable)
