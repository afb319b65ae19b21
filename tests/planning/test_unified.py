"""Fast Downward and other engines of unified-planning, in processes of their own."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from tmd.diagnostics import MissingToolError, TmdError
from tmd.pddl.model import Problem
from tmd.pddl.reading.formulas import read_condition
from tmd.pddl.reading.syntax import parse
from tmd.pddl.task import Cube, Task
from tmd.planning.backends import fast_downward_for_gaps, make
from tmd.planning.fast_downward import OPTIMAL_WITH_AXIOMS, OPTIMAL_WITH_CONDITIONS
from tmd.planning.gap_filler import GapFiller
from tmd.planning.result import Filled, GaveUp, Unreachable
from tmd.planning.up_planners import EngineSpec, _judged, fast_downward_engine, has_universal

installed = pytest.mark.skipif(
    __import__("importlib.util").util.find_spec("up_fast_downward") is None, reason="Fast Downward is not installed"
)


@installed
def test_fast_downward_agrees_in_the_pantry(pantry: Task, pantry_problem: Problem) -> None:
    """Costs, free steps, conditional effects, a disjunctive precondition, negative goals."""
    reference = fast_downward_for_gaps(pantry)
    ours = GapFiller(pantry)
    for goal in (pantry.goal, (Cube(0, 1 << 3), Cube(1 << 5, 0))):
        theirs = reference.fill(pantry.init, goal)
        assert isinstance(theirs, Filled)
        mine = ours.fill(pantry.init, goal)
        assert isinstance(mine, Filled)
        assert mine.cost == theirs.cost
    assert reference.fill(pantry.init, (Cube(),)) == Filled((), pantry.init, 0)
    assert isinstance(reference.fill(pantry.init, (Cube(1, 1),)), Unreachable)


@installed
def test_two_at_once_do_not_disturb_each_other(pantry: Task) -> None:
    planners = [fast_downward_for_gaps(pantry), fast_downward_for_gaps(pantry)]
    with ThreadPoolExecutor(2) as pool:
        answers = list(pool.map(lambda p: [p.fill(pantry.init, (Cube(1 << i, 0),)) for i in range(2)], planners))
    assert answers[0] == answers[1]
    assert all(isinstance(answer, Filled) for answer in answers[0])


@installed
def test_an_engine_leaves_nothing_behind(pantry: Task, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    fast_downward_for_gaps(pantry).fill(pantry.init, pantry.goal)
    assert list(tmp_path.iterdir()) == []


def test_an_unknown_engine_is_missing(pantry: Task) -> None:
    with pytest.raises(MissingToolError, match="no engine 'nonesuch'"):
        make("up:nonesuch", pantry).fill(pantry.init, pantry.goal)


@pytest.mark.parametrize("name", ["", "fast-downwards", "up:", "inprocess"])
def test_unknown_planners_are_refused(name: str, pantry: Task) -> None:
    with pytest.raises(TmdError, match="there is no planner"):
        make(name, pantry)


def test_without_fast_downward(monkeypatch: pytest.MonkeyPatch, pantry: Task) -> None:
    monkeypatch.setattr("tmd.planning.fast_downward.find_spec", lambda name: None)
    with pytest.raises(MissingToolError) as caught:
        make("fast-downward", pantry)
    assert caught.value.hint == "pip install up-fast-downward"


def test_without_unified_planning(monkeypatch: pytest.MonkeyPatch, pantry: Task) -> None:
    monkeypatch.setattr("tmd.planning.up_planners.find_spec", lambda name: None)
    with pytest.raises(MissingToolError, match="unified-planning"):
        make("up:tamer", pantry)


@pytest.mark.parametrize(
    ("status", "kind"),
    [
        ("UNSOLVABLE_PROVEN", Unreachable),
        ("UNSOLVABLE_INCOMPLETELY", GaveUp),
        ("TIMEOUT", GaveUp),
        ("MEMOUT", GaveUp),
        ("UNSUPPORTED_PROBLEM", TmdError),
        ("INTERNAL_ERROR", TmdError),
        ("INTERMEDIATE", TmdError),
    ],
)
def test_statuses(status: str, kind: type) -> None:
    engine = EngineSpec("fast-downward", time_limit=7)
    if issubclass(kind, Exception):
        with pytest.raises(kind, match="fast-downward"):
            _judged(status, engine)
    else:
        assert isinstance(_judged(status, engine), kind)


@pytest.mark.parametrize(
    ("text", "universal"),
    [
        ("(forall (?x - object) (p ?x))", True),
        ("(not (exists (?x - object) (p ?x)))", True),
        ("(not (forall (?x - object) (p ?x)))", False),
        ("(imply (forall (?x - object) (p ?x)) (q))", False),
        ("(and (q) (or (p a) (not (p b))))", False),
    ],
)
def test_universal_conditions_are_found(text: str, universal: bool) -> None:
    document = parse(text, "test")
    assert has_universal(read_condition(document.groups[0], document.source)) is universal


def test_axioms_decide_the_configuration(pantry_problem: Problem) -> None:
    assert (
        fast_downward_engine(pantry_problem.domain).parameters["fast_downward_search_config"] == OPTIMAL_WITH_CONDITIONS
    )
    assert OPTIMAL_WITH_CONDITIONS != OPTIMAL_WITH_AXIOMS
