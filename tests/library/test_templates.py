"""Generalising demonstrations and instantiating templates: the three rules of section V-A."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path

import pytest

from tmd.language import parse
from tmd.language.clause import Clause
from tmd.library.library import align, learn
from tmd.library.template import Instantiation, Template, generalise, instantiate, replace
from tmd.pddl.model import Instruction
from tmd.pddl.plan_file import parse_instruction
from tmd.world.compile import compile_problem
from tmd.world.corpus import Corpus
from tmd.world.demonstration import Segment
from tmd.world.environment import load_environment
from tmd.world.world import World, make_world, run


def clause(text: str, corpus: Corpus) -> Clause:
    (found,) = parse(text, corpus.lexicon).clauses
    return found


def steps(*texts: str) -> tuple[Instruction, ...]:
    return tuple(parse_instruction(text) for text in texts)


def template(corpus: Corpus, environment: str, text: str, *instructions: str) -> Template:
    world = corpus.world(environment)
    done = steps(*instructions)
    return generalise(
        "test",
        clause(text, corpus),
        environment,
        done,
        (world.task.init, run(world, world.task.init, done)),
        world.profiles,
        world.mentions,
    )


def instantiated(corpus: Corpus, made: Template, environment: str, text: str, *, pair_nouns: bool = False) -> list[str]:
    world = corpus.world(environment)
    found = instantiate(made, clause(text, corpus), world, world.task.init, pair_nouns=pair_nouns)
    assert isinstance(found, Instantiation)
    return [str(i) for i in found.instructions]


def test_objects_become_variables_and_constants_stay(kitchen: Corpus) -> None:
    made = template(kitchen, "kitchen1", "put the pot on the stove", "moveto(pot1)", "keep(pot1, stove1_burner1, on)")
    assert [str(i) for i in made.instructions] == ["moveto(?z1)", "keep(?z1, ?z2, on)"]
    assert made.grounding == {"?z1": "pot1", "?z2": "stove1_burner1"}
    assert made.classes == {"?z1": "pot", "?z2": "burner"}
    assert made.wanted == {"?z1": (("thing",), ("item",)), "?z2": (("fixture",),)}
    assert made.mentions["pot"] == "?z1"


def test_every_template_of_the_corpus_gives_its_demonstration_back(kitchen: Corpus) -> None:
    library = learn(kitchen.demonstrations(), kitchen.world, kitchen.lexicon)
    shown = {d.id: d.instructions for d in kitchen.demonstrations()}
    templates = [t for verb in library.verbs() for t in library.propose(Clause(verb))]
    assert len(templates) == len(library) > 100
    for made in templates:
        # in the same order; detours are left out
        rest = iter(shown[made.source])
        assert all(instruction in rest for instruction in replace(made.instructions, made.grounding))
        assert not any(name in kitchen.world(made.environment).profiles.constants for name in made.grounding)


def test_what_was_shown_before_with_other_names_is_not_looked_at_again(kitchen: Corpus) -> None:
    library = learn(kitchen.demonstrations(), kitchen.world, kitchen.lexicon)
    copies = learn(kitchen.demonstrations(), kitchen.world, kitchen.lexicon)
    for verb in library.verbs():
        for made in library.templates(verb):
            names = {variable: f"{name}_elsewhere" for variable, name in made.grounding.items()}
            copies.add(dataclasses.replace(made, source=f"{made.source}-2", environment="elsewhere", grounding=names))
    world = kitchen.world("kitchen4")
    for verb in library.verbs():
        clause = Clause(verb)
        assert len(copies.propose(clause)) == 2 * len(library.propose(clause))
        few, more = (each.distinct(clause, world) for each in (library, copies))
        assert [made.source for made in more if not made.source.endswith("-2")] == [made.source for made in few]
        # a copy is looked at only where the first one's things are here under the same names, and its own are not
        assert all({*made.grounding.values()} - {*world.profiles.objects} for made in more if made not in few)
        assert set(map(proposed_by(world), few)) == set(map(proposed_by(world), library.propose(clause)))


def proposed_by(world: World) -> Callable[[Template], tuple[str, ...] | None]:
    """What a template comes to in an environment, for a clause that says nothing but its verb."""

    def come_to(made: Template) -> tuple[str, ...] | None:
        found = instantiate(made, Clause(made.clause.verb), world, world.task.init)
        return tuple(map(str, found.instructions)) if found is not None else None

    return come_to


def test_rule_1_a_shared_relation_maps_both_its_nouns(kitchen: Corpus) -> None:
    made = template(kitchen, "kitchen1", "put the cup on the table", "moveto(table1)", "keep(cup1, table1, on)")
    found = instantiated(kitchen, made, "kitchen4", "put the bowl on the counter")
    assert found == ["moveto(counter1)", "keep(bowl1, counter1, on)"]


def test_rule_2_a_shared_noun_is_mapped_as_it_was(kitchen: Corpus) -> None:
    made = template(kitchen, "kitchen1", "take the bowl", "moveto(bowl1)", "grasp(bowl1)")
    assert instantiated(kitchen, made, "kitchen2", "take the bowl") == ["moveto(bowl1)", "grasp(bowl1)"]


def test_rule_3_goes_by_states(kitchen: Corpus) -> None:
    # kitchen 5 has two cups; the one that is full is the like of the full pot of kitchen 4
    made = template(kitchen, "kitchen4", "heat it", "grasp(pot1)", "pour(pot1, bowl1)")
    world = kitchen.world("kitchen5")
    found = instantiate(made, Clause("heat"), world, world.task.init)
    assert found is not None
    assert found.grounding["?z1"] in {"cup1", "pot1"}
    assert found.profiles["?z1"]["filled",]


def test_rule_3_breaks_ties_by_the_edges_of_the_object_graph(kitchen: Corpus) -> None:
    made = template(
        kitchen,
        "kitchen4",
        "put the pot on the burner",
        "keep(pot2, stove1_burner3, on)",
        "turn(stove1_knob3, high)",
    )
    found = instantiated(kitchen, made, "kitchen2", "put the pot on the burner")
    assert found == ["keep(pot1, hotplate1_burner1, on)", "turn(hotplate1_knob1, high)"]


def test_the_extension_pairs_nouns_that_only_one_clause_has(kitchen: Corpus) -> None:
    made = template(kitchen, "kitchen1", "take the ramen", "moveto(ramen1)", "grasp(ramen1)")
    asked = "take the raspberry syrup"
    assert instantiated(kitchen, made, "kitchen3", asked) != ["moveto(raspberry_bottle1)", "grasp(raspberry_bottle1)"]
    assert instantiated(kitchen, made, "kitchen3", asked, pair_nouns=True) == [
        "moveto(raspberry_bottle1)",
        "grasp(raspberry_bottle1)",
    ]


def bare_world(corpus: Corpus, path: Path) -> World:
    file = path / "bare.yaml"
    file.write_text(
        "name: bare\ndomain: kitchen\nobjects:\n  counter1: {class: counter}\n  mug1: {class: mug, at: on counter1}\n"
    )
    return make_world("bare", compile_problem(load_environment(file), corpus.folder), corpus.lexicon)


def test_a_variable_without_any_object_of_its_type_makes_the_template_useless(kitchen: Corpus, tmp_path: Path) -> None:
    made = template(kitchen, "kitchen1", "add the ramen to the pot", "add(ramen1, pot1)")
    world = bare_world(kitchen, tmp_path)
    assert instantiate(made, clause("add the ramen to the pot", kitchen), world, world.task.init) is None


def test_two_variables_never_share_an_object(kitchen: Corpus, tmp_path: Path) -> None:
    made = template(kitchen, "kitchen1", "pour the cup into the mug", "pour(cup1, mug1)")
    world = bare_world(kitchen, tmp_path)
    found = instantiate(made, clause("pour the cup into the mug", kitchen), world, world.task.init)
    assert found is not None
    assert sorted(found.grounding.values()) == ["counter1", "mug1"]


def aligned(text: str, *pieces: str) -> list[tuple[str | None, list[str]]]:
    segments = [Segment(text.index(p), text.index(p) + len(p), ()) for p in pieces]
    found = align(parse(text).clauses, segments)
    return [(clauses[0].verb if clauses else None, [text[s.start : s.end] for s in own]) for clauses, own in found]


def test_a_clause_belongs_to_the_segment_it_lies_in() -> None:
    text = "fill the pot and boil it"
    assert aligned(text, "fill the pot", "boil it") == [("fill", ["fill the pot"]), ("boil", ["boil it"])]
    assert aligned(text, text) == [("fill", [text])]
    assert aligned(text, "and") == [(None, ["and"])]


def test_a_condition_joins_the_clause_it_belongs_to() -> None:
    text = "Fill the pot. When the water boils, add the ramen."
    assert aligned(text, "Fill the pot", "When the water boils", "add the ramen") == [
        ("fill", ["Fill the pot"]),
        ("add", ["When the water boils", "add the ramen"]),
    ]


def test_running_passes_over_what_can_never_be_done(kitchen: Corpus) -> None:
    world = kitchen.world("kitchen1")
    assert run(world, world.task.init, steps("grasp(stove1)", "fly(mug1)")) == world.task.init


@pytest.mark.parametrize(
    ("environment", "noun", "expected"),
    [
        ("kitchen1", "pot", "pot1"),
        ("kitchen2", "stove", "hotplate1"),
        ("kitchen3", "fridge", "fridge1"),
        ("kitchen5", "coffee", "pot1"),  # what is left of yesterday's
        ("kitchen4", "coffee", "coffee_pot1"),
        ("kitchen1", "raspberry_syrup", "raspberry_bottle1"),
        ("kitchen4", "vanilla", "vanilla_tub1"),
    ],
)
def test_nouns_find_their_objects(kitchen: Corpus, environment: str, noun: str, expected: str) -> None:
    world = kitchen.world(environment)
    assert world.mentions.of(noun, world.task.init)[0].name == expected


def test_a_noun_for_what_is_not_there_finds_nothing(kitchen: Corpus) -> None:
    world = kitchen.world("kitchen3")
    assert world.mentions.of("helicopter", world.task.init) == []
