"""Object graphs: parts, edges, states and relations, and what a step changed."""

from __future__ import annotations

import pytest

from tests.view.conftest import corpus
from tests.view.reading import lines, svg
from tmd.pddl.model import Domain, GroundAtom, Predicate, Problem, TypedName
from tmd.pddl.plan_file import parse_instruction
from tmd.pddl.semantics import apply
from tmd.view.object_graph import LONGEST, Edge, GraphChanges, anatomy, draw, object_graph, place
from tmd.world.world import World


def test_parts_edges_states_and_relations_are_drawn(kitchen: World) -> None:
    found = lines(object_graph(kitchen, kitchen.task.problem.init, "fridge1"))
    assert {"fridge1: dispenser_fridge", "door", "dispenser", "button"} <= set(found)
    assert {"shut", "in ← milk1", "found ← pr2", "controls", "guards"} <= set(found)
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
            svg(drawn)
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


def test_long_names_are_cut_and_told_whole() -> None:
    name = "x" * 500
    problem = Problem("p", Domain("d"), (TypedName(name),), frozenset())
    drawn = draw(anatomy(problem), problem.init, name)
    (line,) = [text for text in svg(drawn).iter("text")]
    assert line.find("title") is not None and len(line.text or "") + len(line[0].tail or "") <= LONGEST


def test_boxes_do_not_overlap_and_edges_lead_to_the_right(kitchen: World) -> None:
    for domain in ("kitchen", "living_room"):
        for name in corpus(domain).environments():
            graph = anatomy(corpus(domain).world(name).task.problem)
            for whole in graph.parts:
                vertices, edges = graph.vertices(whole), graph.edges.get(whole, ())
                boxes = place(whole, {v: (len(v), 3) for v in vertices}, edges)
                for one in vertices:
                    for other in vertices:
                        a, b = boxes[one], boxes[other]
                        apart = a.right <= b.x or b.right <= a.x or a.bottom <= b.y or b.bottom <= a.y
                        assert one == other or apart
                assert all(boxes[edge.tail].right < boxes[edge.head].x for edge in edges)


def test_a_cycle_of_edges_ends() -> None:
    edges = (Edge("drives", "a", "b"), Edge("drives", "b", "a"))
    assert set(place("r", {"r": (3, 1), "a": (3, 1), "b": (3, 1)}, edges)) == {"r", "a", "b"}
    facts = frozenset(GroundAtom("part_of", (part, "r")) for part in "ab") | {
        GroundAtom("drives", ("a", "b")),
        GroundAtom("drives", ("b", "r")),
        GroundAtom("drives", ("r", "a")),
    }
    problem = Problem("p", Domain("d", predicates=(Predicate("drives"),)), tuple(map(TypedName, "rab")), facts)
    assert len(list(svg(draw(anatomy(problem), facts, "r")).iter("rect"))) == 3
