"""Drawings of states and plans of any PDDL domain."""

from __future__ import annotations

import re
from itertools import combinations
from pathlib import Path
from xml.etree import ElementTree

import pytest

from tests.bundled import corpus
from tmd.diagnostics import ExitCode
from tmd.goals.wording import Wording
from tmd.pddl.model import GroundAtom, Problem, State, TypedName
from tmd.pddl.plan_file import parse_instruction
from tmd.pddl.semantics import apply
from tmd.pddl.validator import validate
from tmd.view import state_graph
from tmd.view.page import render
from tmd.view.sources import ViewRequest, subject_of_file
from tmd.view.state_graph import MOST, Layout, Places, Point, StateGraph, by_graphviz, by_networkx, object_rows, placed
from tmd.view.subject import PlannedStep, Subject
from tmd.world.roots import Roots

PLAN = [parse_instruction(line) for line in ("pick_up(red_block)", "stack(red_block, green_block)")]


def blocks() -> tuple[Problem, list[State]]:
    found = corpus("01_blocks")
    problem = found.world("yard1").task.problem
    states = [problem.init]
    for instruction in PLAN:
        states.append(apply(instruction, states[-1], problem))
    return problem, states


def overlapping(places: Places, sizes: dict[str, Point]) -> list[tuple[str, str]]:
    return [
        (one, other)
        for one, other in combinations(places, 2)
        if all(abs(places[one][n] - places[other][n]) < (sizes[one][n] + sizes[other][n]) / 2 - 0.2 for n in (0, 1))
    ]


@pytest.mark.parametrize("layout", [by_graphviz, by_networkx])
def test_nodes_do_not_overlap(layout: Layout) -> None:
    sizes: dict[str, Point] = {f"object{n}": (60.0 + 7 * (n % 5), 23.0 + 15 * (n % 3)) for n in range(40)}
    names = list(sizes)
    pairs = [(names[n], names[n * n % 20]) for n in range(1, 20) if n != n * n % 20]
    found = placed(sizes, pairs, layout)
    assert set(found) == set(sizes) and overlapping(found, sizes) == []
    assert found == placed(sizes, pairs, layout)


def test_many_things_in_one_place_stand_in_several_rows() -> None:
    sizes: dict[str, Point] = {"depot": (60.0, 23.0), **{f"box{n}": (70.0, 23.0) for n in range(76)}}
    found = placed(sizes, [(name, "depot") for name in sizes if name != "depot"], by_graphviz)
    assert overlapping(found, sizes) == []
    assert max(x for x, _ in found.values()) < 1_200


def test_a_machine_without_graphviz_uses_networkx(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    sizes: dict[str, Point] = {name: (60.0, 23.0) for name in "abc"}
    pairs = [("a", "b"), ("b", "c")]
    assert by_graphviz(sizes, pairs) == by_networkx(sizes, pairs)
    assert placed(sizes, pairs) == placed(sizes, pairs, by_networkx)


def test_a_state_is_drawn_with_what_the_last_step_changed() -> None:
    problem, states = blocks()
    graph = StateGraph(problem, states)
    drawn = ElementTree.fromstring(graph.svg(states[2], states[1], "red_block").split("</svg>")[0] + "</svg>")
    (edge,) = [each for each in drawn.iter("g") if "edge" in each.get("class", "")]
    assert edge.get("class") == "edge came" and "".join(edge.itertext()).strip() == "+ on"
    (marked,) = [each for each in drawn.iter("g") if "marked" in each.get("class", "")]
    assert marked.get("data-object") == "red_block" and "clear" in "".join(marked.itertext())
    places = [
        re.findall(r'data-object="(\w+)".*?<rect x="([\d.]+)" y="([\d.]+)"', graph.svg(state)) for state in states
    ]
    assert places[0] == places[1] == places[2] and len(places[0]) == len(problem.objects)


def test_of_many_objects_some_are_drawn() -> None:
    problem, _ = blocks()
    many = tuple(TypedName(f"block{n}", ("block",)) for n in range(1_000))
    huge = Problem("huge", problem.domain, many, frozenset(GroundAtom("on_table", (each.name,)) for each in many))
    graph = StateGraph(huge, [huge.init], ["block777"])
    svg = graph.svg(huge.init)
    assert svg.count("data-object") == MOST and 'data-object="block777"' in svg
    assert f"{1_000 - MOST} more objects are not drawn." in svg


def test_names_are_text(monkeypatch: pytest.MonkeyPatch) -> None:
    problem, _ = blocks()
    odd = '<b>"&'
    strange = Problem("odd", problem.domain, (TypedName(odd),), frozenset({GroundAtom("clear", (odd,))}))
    assert odd not in StateGraph(strange, [strange.init]).svg(strange.init)
    monkeypatch.setattr(state_graph, "_PATIENCE", 0.0)  # a layout that takes too long
    assert StateGraph(strange, [strange.init]).svg(strange.init)


def test_a_row_for_each_object_of_a_plan() -> None:
    problem, _ = blocks()
    html = object_rows(PLAN, problem, 2, Wording(problem), "#step-")
    rows = re.findall(r"<tr><th scope=\"row\">(\w+)</th>(.*?)</tr>", html)
    assert [(name, [step for step in ("1", "2") if f"#step-{step}" in row]) for name, row in rows] == [
        ("red_block", ["1", "2"]),
        ("green_block", ["2"]),
    ]
    assert object_rows([], problem, 0, Wording(problem)) == ""


def test_the_page_draws_a_problem(tmp_path: Path) -> None:
    problem, _ = blocks()
    page = render(Subject("blocks", problem, tuple(PlannedStep(each) for each in PLAN))).html
    assert page.count("<svg") == 2 and "edge came" in page and "tmd-rows" in page
    assert render(Subject("no plan", problem, ())).html.count("<svg") == 1


def test_a_problem_without_a_plan_is_drawn(tmp_path: Path) -> None:
    file = tmp_path / "no.pddl"
    goal = "(and (on a b) (on b a))"
    init = "(hand_empty) (clear a) (clear b) (on_table a) (on_table b)"
    file.write_text(f"(define (problem no) (:domain blocks) (:objects a b - block) (:init {init}) (:goal {goal}))")
    found = subject_of_file(Roots(), ViewRequest(str(file), domain="01_blocks", problem=file))
    assert found.subject.steps == () and "no plan was found" in found.remarks[0]
    assert found.ending(validate(found.subject.problem, [])) == ExitCode.NOT_GROUNDED
    assert "✗ no plan</b>: none was found" in render(found.subject).html


def test_a_problem_whose_goal_holds_has_a_plan_without_steps(tmp_path: Path) -> None:
    file = tmp_path / "so.pddl"
    file.write_text("(define (problem so) (:domain blocks) (:objects a - block) (:init (clear a)) (:goal (clear a)))")
    found = subject_of_file(Roots(), ViewRequest(str(file), domain="01_blocks", problem=file))
    assert found.ending(validate(found.subject.problem, [])) == ExitCode.OK
    page = render(found.subject).html
    assert "✓ executable</b>: there is nothing to do" in page or "✓ reaches its goal</b>: there is nothing" in page
    assert "no plan" not in page
