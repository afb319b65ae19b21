"""Object graphs: parts, edges, states and relations, and what a step changed."""

from __future__ import annotations

import pytest

from tests.view.conftest import corpus
from tests.view.reading import lines, lists
from tmd.pddl.model import Domain, GroundAtom, Predicate, Problem, TypedName
from tmd.pddl.plan_file import parse_instruction
from tmd.pddl.semantics import apply
from tmd.view.object_graph import GraphChanges, anatomy, draw, object_graph
from tmd.world.world import World


def test_parts_edges_states_and_relations_are_drawn(kitchen: World) -> None:
    found = lines(object_graph(kitchen, kitchen.task.problem.init, "fridge1"))
    assert {"fridge1: dispenser_fridge", "door", "dispenser", "button"} <= set(found)
    assert {"shut", "in ← milk1", "found ← pr2", "controls → dispenser", "guards → fridge1"} <= set(found)
    assert "found ← pr2" in found and found.count("found ← pr2") == 1  # of the parts it is told at the whole


def test_a_part_is_drawn_with_its_whole(kitchen: World) -> None:
    init = kitchen.task.problem.init
    assert object_graph(kitchen, init, "fridge1_door") == object_graph(kitchen, init, "fridge1")


@pytest.mark.parametrize("domain", ["kitchen", "living_room", "01_blocks", "02_table", "03_drawer"])
def test_every_object_of_every_environment_can_be_drawn(domain: str) -> None:
    for name in corpus(domain).environments()[:2]:
        problem = corpus(domain).world(name).task.problem
        graph = anatomy(problem)
        for thing in problem.objects:
            drawn = draw(graph, problem.init, thing.name)
            assert len(lists(drawn)) >= 1
            assert drawn == draw(anatomy(problem), problem.init, thing.name)


def test_what_a_step_changes_is_marked(kitchen: World) -> None:
    problem = kitchen.task.problem
    before = problem.init
    for text in ("find(cup1)", "moveto(cup1)"):
        before = apply(parse_instruction(text), before, problem)
    after = apply(parse_instruction("grasp(cup1)"), before, problem)
    first = object_graph(kitchen, before, "cup1", GraphChanges(removed=before - after))
    then = object_graph(kitchen, after, "cup1", GraphChanges(added=after - before))
    assert lines(first, "removed") == ["− on → counter2"] and not lines(first, "added")
    assert lines(then, "added") == ["+ holding ← pr2"] and not lines(then, "removed")
    both = object_graph(kitchen, after, "cup1", GraphChanges(after - before, before - after))
    assert lines(both, "removed") == ["− on → counter2"] and lines(both, "added") == ["+ holding ← pr2"]


def test_an_unknown_object_is_refused(kitchen: World) -> None:
    with pytest.raises(KeyError):
        object_graph(kitchen, kitchen.task.problem.init, "spaceship1")


def test_edges_stand_at_the_part_that_they_leave(kitchen: World) -> None:
    graph = anatomy(kitchen.task.problem)
    for whole, parts in graph.parts.items():
        found = lists(draw(graph, kitchen.task.problem.init, whole))
        assert [element.get("class") for element in found] == ["root", *("part" for _ in parts)]
        for vertex, element in zip(graph.vertices(whole), found, strict=True):
            told = [line.text for line in element if line.get("class") == "edge"]
            assert len(told) == sum(tail == vertex for tail, _ in graph.edges)


def test_a_cycle_of_edges_ends() -> None:
    facts = frozenset(GroundAtom("part_of", (part, "r")) for part in "ab") | {
        GroundAtom("drives", ("a", "b")),
        GroundAtom("drives", ("b", "r")),
        GroundAtom("drives", ("r", "a")),
    }
    problem = Problem("p", Domain("d", predicates=(Predicate("drives"),)), tuple(map(TypedName, "rab")), facts)
    drawn = draw(anatomy(problem), facts, "r")
    assert len(lists(drawn)) == 3
    assert lines(drawn, "edge") == ["drives → a", "drives → b", "drives → r"]
