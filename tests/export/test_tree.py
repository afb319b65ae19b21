"""Behaviour trees: they fit the schema, and whoever executes them does what the plan does, or stops."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from tests.export.conftest import planned_case
from tmd.export.behavior_tree import format_tree
from tmd.export.planned_problem import Planned, planned
from tmd.pddl import semantics
from tmd.pddl.model import TRUE, GroundAtom, Instruction, Problem, State
from tmd.pddl.reading.reader import parse_domain, parse_problem

SCHEMA = Path(__file__).with_name("behavior_tree.xsd")


@cache
def schema() -> Any:  # noqa: ANN401 - the package is not always there
    return pytest.importorskip("xmlschema").XMLSchema(str(SCHEMA))


class Robot:
    """Executes a tree as BehaviorTree.CPP does, on the semantics of PDDL; every action ends at once.

    An action node knows its ports only by the order in which ``TreeNodesModel`` declares them.
    """

    def __init__(self, text: str, problem: Problem, state: State) -> None:
        self.root = ET.fromstring(text)
        self.problem = problem
        self.state = state
        self.done: list[Instruction] = []
        models = self.root.find("TreeNodesModel")
        assert models is not None
        self.ports = {m.get("ID", ""): [p.get("name", "") for p in m.findall("input_port")] for m in models}

    def run(self) -> bool:
        """Whether the main tree succeeds."""
        main = self.root.get("main_tree_to_execute")
        tree = next(tree for tree in self.root.findall("BehaviorTree") if tree.get("ID") == main)
        return self.tick(tree[0])

    def tick(self, node: ET.Element) -> bool:
        match node.tag:
            case "Sequence":
                return all(self.tick(child) for child in node)
            case "Condition":
                assert node.get("ID") == "Holds"
                return all(self.holds(literal) for literal in node.get("literals", "").split(";"))
            case "Action":
                return self.act(node)
        raise AssertionError(f"no node {node.tag}")

    def holds(self, literal: str) -> bool:
        words = literal.split()
        positive = words[0] != "not"
        name, *args = words if positive else words[1:]
        return (GroundAtom(name, tuple(args)) in self.state) == positive

    def act(self, node: ET.Element) -> bool:
        name = node.get("ID", "")
        instruction = Instruction(name, tuple(node.get(port, "") for port in self.ports[name]))
        if not semantics.applicable(instruction, self.state, self.problem):
            return False
        self.state = semantics.apply(instruction, self.state, self.problem)
        self.done.append(instruction)
        return True


def test_it_fits_the_schema(source: Planned) -> None:
    schema().validate(format_tree(source))


def test_executing_it_reaches_the_end_of_the_plan(source: Planned) -> None:
    robot = Robot(format_tree(source), source.problem, source.problem.init)
    assert robot.run()
    assert tuple(robot.done) == source.plan
    assert robot.state == source.states[-1]


def test_it_stops_where_the_world_is_not_as_planned(small: Planned) -> None:
    """Whatever atom of a step's precondition is taken away: the robot does not do that step."""
    text = format_tree(small)
    steps = ET.fromstring(text).findall("./BehaviorTree/Sequence/Sequence")
    for step, before in zip(steps, small.states, strict=False):
        condition = step.find("Condition[@name='before']")
        for literal in condition.get("literals", "").split(";") if condition is not None else []:
            words = literal.removeprefix("not ").split()
            atom = GroundAtom(words[0], tuple(words[1:]))
            robot = Robot(text, small.problem, before ^ {atom})
            assert not robot.tick(step)
            assert not robot.done


def test_an_action_without_effect_is_noticed() -> None:
    source = planned_case("blocks")
    robot = Robot(format_tree(source), source.problem, source.problem.init)
    robot.act = lambda node: True  # type: ignore[method-assign]
    assert not robot.run()


def test_a_plan_of_nothing_for_nothing_succeeds() -> None:
    source = planned(replace(planned_case("blocks").problem, goal=TRUE), ())
    text = format_tree(source)
    assert "<AlwaysSuccess />" in text
    schema().validate(text)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('BTCPP_format="4"', 'BTCPP_format="3"'),
        ('main_tree_to_execute="MainTree"', 'main_tree_to_execute="Other"'),
        ('<Action ID="stack"', '<Action ID="stak"'),
        ('<Sequence name="1 ', '<Sequence nam="1 '),
        ('<input_port name="x"', '<input_port name="?x"'),
    ],
)
def test_the_schema_refuses_what_is_wrong(old: str, new: str) -> None:
    text = format_tree(planned_case("blocks"))
    assert old in text
    assert not schema().is_valid(text.replace(old, new, 1))


def test_ports_that_mean_something_else_get_another_name() -> None:
    domain = parse_domain(
        "(define (domain d) (:predicates (p ?x)) (:action a :parameters (?name ?id ?2) :effect (p ?name)))"
    )
    problem = parse_problem("(define (problem q) (:domain d) (:objects o) (:goal (p o)))", domain)
    source = replace(planned_case("blocks"), problem=problem, plan=(Instruction("a", ("o", "o", "o")),))
    text = format_tree(source)
    assert '<Action ID="a" name_="o" id_="o" p2="o" />' in text
    schema().validate(text)
