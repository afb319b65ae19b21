from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from heapq import heappop, heappush
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tmd.diagnostics import MissingToolError, TmdError
from tmd.pddl.model import Domain, GroundAtom, Instruction, Problem
from tmd.pddl.task import Bits, ConditionalEffect, Cube, Operator, Task
from tmd.planning.result import Filled, GaveUp, Unreachable
from tmd.planning.search.in_process import Backend, OptimalSearch

FAR = 10**9
ATOMS = 5

Graph = dict[Bits, list[tuple[Operator, Bits]]]
Reverse = dict[Bits, dict[Bits, int]]


def _cubes() -> st.SearchStrategy[Cube]:
    """Small conjunctions; an atom that is drawn twice is positive."""
    sets = st.sets(st.integers(0, ATOMS - 1), max_size=2)
    return st.builds(lambda p, n: Cube(_mask(p), _mask(n - p)), sets, sets)


def _mask(numbers: set[int]) -> Bits:
    return sum(1 << number for number in numbers)


def _operators() -> st.SearchStrategy[Operator]:
    bits = st.integers(0, 2**ATOMS - 1)
    few = st.sets(st.integers(0, ATOMS - 1), max_size=2).map(_mask)
    effects = st.lists(st.builds(ConditionalEffect, _cubes(), few, few), max_size=2).map(tuple)
    forbidden = st.lists(_cubes().filter(lambda c: c != Cube()), max_size=1).map(tuple)
    return st.builds(
        Operator,
        instruction=bits.map(lambda number: Instruction("a", (str(number),))),
        precondition=_cubes(),
        add=few,
        delete=few,
        conditional=effects,
        forbidden=forbidden,
        cost=st.sampled_from([1, 1, 1, 0, 2, 3]),
    )


@st.composite
def random_tasks(draw: st.DrawFn) -> Task:
    """Tasks of five atoms and up to seven operators, with everything an operator may have."""
    drawn = draw(st.lists(_operators(), min_size=1, max_size=7))
    operators = tuple(
        Operator(Instruction("a", (f"{i:02}",)), o.precondition, o.add, o.delete, o.conditional, o.forbidden, o.cost)
        for i, o in enumerate(drawn)
    )
    atoms = tuple(GroundAtom("p", (str(i),)) for i in range(ATOMS))
    goal = tuple(draw(st.lists(_cubes().filter(lambda c: c != Cube()), min_size=1, max_size=2)))
    return Task(
        problem=Problem("random", Domain("random")),
        atoms=atoms,
        static=frozenset(),
        init=draw(st.integers(0, 2**ATOMS - 1)),
        goal=goal,
        operators=operators,
        index={atom: i for i, atom in enumerate(atoms)},
        by_instruction={o.instruction: o for o in operators},
    )


def canonical(task: Task, start: Bits, goal: Sequence[Cube]) -> tuple[int, tuple[Instruction, ...]] | None:
    """The cheapest plan by brute force: least cost, then fewest steps, then first in the order of operators."""
    edges = graph(task, start)
    return read_off(edges, reverse(edges), start, goal)


def read_off(
    edges: Graph, before: Reverse, start: Bits, goal: Sequence[Cube]
) -> tuple[int, tuple[Instruction, ...]] | None:
    """The canonical plan in a graph of states, which is given with its reverse."""
    best = _to_goal(before, start, goal)
    if start not in best:
        return None
    plan, state = [], start
    while best[state] != (0, 0):
        for operator, after in edges[state]:
            left = best.get(after)
            if left and (left[0] + operator.cost, left[1] + 1) == best[state]:
                plan.append(operator.instruction)
                state = after
                break
    return best[start][0], tuple(plan)


def graph(task: Task, start: Bits) -> Graph:
    """Every state that can be reached, with its successors in the order of operators."""
    edges: Graph = {}
    waiting = [start]
    while waiting:
        state = waiting.pop()
        if state not in edges:
            edges[state] = [(o, o.apply(state)) for o in task.operators if o.applicable(state)]
            waiting.extend(after for _, after in edges[state])
    return edges


def reverse(edges: Graph) -> Reverse:
    """For each state the states before it, with the costs."""
    before: Reverse = {state: {} for state in edges}
    for state, out in edges.items():
        for operator, after in out:
            known = before[after].get(state, FAR)
            before[after][state] = min(known, operator.cost)
    return before


def _to_goal(before: Reverse, start: Bits, goal: Sequence[Cube]) -> dict[Bits, tuple[int, int]]:
    """Least cost and then fewest steps to the goal, for every state that is not farther from it than the start."""
    best = {state: (0, 0) for state in before if any(cube.holds(state) for cube in goal)}
    queue = [(cost, state) for state, cost in best.items()]
    while queue:
        (cost, steps), state = heappop(queue)
        if best[state] < (cost, steps):
            continue
        if state == start:
            break  # whatever lies on a cheapest plan is nearer, and settled
        for earlier, more in before[state].items():
            new = (cost + more, steps + 1)
            if new < best.get(earlier, (FAR, 0)):
                best[earlier] = new
                heappush(queue, (new, earlier))
    return best


@settings(max_examples=100, deadline=None)
@given(random_tasks())
def test_the_plan_is_the_canonical_cheapest_one(task: Task) -> None:
    answer = OptimalSearch(task, backend="python").fill(task.init, task.goal)
    expected = canonical(task, task.init, task.goal)
    if expected is None:
        assert isinstance(answer, Unreachable)
    else:
        assert isinstance(answer, Filled)
        assert (answer.cost, answer.plan) == expected


@pytest.fixture(scope="module")
def edges(pantry: Task) -> Graph:
    """All states of the pantry."""
    return graph(pantry, pantry.init)


@pytest.fixture(scope="module")
def before(edges: Graph) -> Reverse:
    """What comes before each of them."""
    return reverse(edges)


def test_costs_conditional_effects_and_disjunctions_in_the_pantry(pantry: Task, edges: Graph, before: Reverse) -> None:
    answer = OptimalSearch(pantry).fill(pantry.init, pantry.goal)
    expected = read_off(edges, before, pantry.init, pantry.goal)
    assert expected is not None
    assert isinstance(answer, Filled)
    assert (answer.cost, answer.plan) == expected
    assert any(cube.holds(answer.state) for cube in pantry.goal)


def test_goals_of_one_atom_in_the_pantry(pantry: Task, edges: Graph, before: Reverse) -> None:
    search = OptimalSearch(pantry)
    lengths = set()
    for number in range(0, len(pantry.atoms), 3):
        for goal in (Cube(1 << number, 0), Cube(0, 1 << number)):
            answer = search.fill(pantry.init, (goal,))
            expected = read_off(edges, before, pantry.init, (goal,))
            assert expected is not None
            assert isinstance(answer, Filled)
            assert (answer.cost, answer.plan) == expected
            lengths.add(len(answer.plan))
    assert max(lengths) > 4


def test_a_goal_that_holds_needs_nothing(pantry: Task) -> None:
    assert OptimalSearch(pantry).fill(pantry.init, (Cube(),)) == Filled((), pantry.init, 0)


def test_an_empty_disjunction_is_unreachable(pantry: Task) -> None:
    answer = OptimalSearch(pantry).fill(pantry.init, ())
    assert isinstance(answer, Unreachable)
    assert "goal" in answer.reason


def test_contradiction_names_the_atom(pantry: Task) -> None:
    answer = OptimalSearch(pantry).fill(pantry.init, (Cube(1, 1),))
    assert isinstance(answer, Unreachable)
    assert str(pantry.atoms[0]) in answer.reason


def test_unreachable_names_the_atom(any_kitchen: Callable[[str], Task]) -> None:
    """Nothing makes the robot forget where things are."""
    task = any_kitchen("kitchen1")
    found = [i for i, atom in enumerate(task.atoms) if atom.predicate == "found"]
    state = task.init | 1 << found[0]
    answer = OptimalSearch(task).fill(state, (Cube(0, 1 << found[0]),))
    assert answer == Unreachable(f"(not {task.atoms[found[0]]}) cannot be reached")


@pytest.mark.parametrize("backend", ["python", "auto"])
def test_both_forms_of_the_kernel_do_the_same(
    backend: Backend, any_kitchen: Callable[[str], Task], walk: Callable[[Task, Random, int], list[Bits]]
) -> None:
    """Same answers and same amount of work, step by step."""
    pytest.importorskip("numba", reason="numba is not installed")
    task = any_kitchen("kitchen1")
    fast = OptimalSearch(task, backend="numba", cap=150)
    slow = OptimalSearch(task, backend=backend, cap=150)
    random = Random(5)
    for state in walk(task, random, 15):
        operator = random.choice(task.operators)
        goals = [operator.precondition, Cube(1 << random.randrange(len(task.atoms)), 0)]
        for goal in goals:
            assert slow.fill(state, (goal,)) == fast.fill(state, (goal,))
            assert slow.generated == fast.generated


def test_without_numba_the_answers_are_the_same(monkeypatch: pytest.MonkeyPatch, pantry: Task) -> None:
    expected = OptimalSearch(pantry).fill(pantry.init, pantry.goal)
    monkeypatch.setitem(sys.modules, "numba", None)
    monkeypatch.setattr("tmd.planning.search.in_process.find_spec", lambda name: None)
    search = OptimalSearch(pantry)
    assert search.backend == "python"
    assert search.fill(pantry.init, pantry.goal) == expected
    with pytest.raises(MissingToolError, match="numba"):
        OptimalSearch(pantry, backend="numba")


def test_the_cap_is_kept_and_repeats(pantry: Task) -> None:
    answers = [OptimalSearch(pantry, backend="python", cap=3).fill(pantry.init, pantry.goal) for _ in range(2)]
    assert answers == [GaveUp("3 generated states")] * 2


def test_a_larger_cap_never_changes_a_plan(pantry: Task) -> None:
    best = OptimalSearch(pantry, backend="python").fill(pantry.init, pantry.goal)
    for cap in (1, 5, 25, 125, 625, 3125):
        answer = OptimalSearch(pantry, backend="python", cap=cap).fill(pantry.init, pantry.goal)
        assert answer == best or answer == GaveUp(f"{cap} generated states")


def test_wrong_arguments_are_refused(pantry: Task) -> None:
    with pytest.raises(TmdError, match="at least 1"):
        OptimalSearch(pantry, cap=0)
    with pytest.raises(TmdError, match="no search back-end 'cython'"):
        OptimalSearch(pantry, backend="cython")  # type: ignore[arg-type]
