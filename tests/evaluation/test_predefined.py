"""The baseline whose templates people wrote: where it wins, where it must fail, and what it says of a bad file."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import numpy as np
import pytest

from tests import bundled
from tmd.diagnostics import TmdError
from tmd.evaluation.models.predefined_templates import PredefinedTemplates
from tmd.evaluation.models.prediction import Prediction
from tmd.evaluation.models.template_file import FILE, load_templates
from tmd.evaluation.runs.dataset import BundledData, Example, VeilDataset
from tmd.pddl.validator import validate
from tmd.world.demonstration import Demonstration
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).parents[2]
LIBRARIES = sorted(ROOT.glob(f"domains/*/{FILE}"))
RANDOM = np.random.default_rng(0)


@pytest.fixture(scope="module")
def data() -> BundledData:
    return bundled.data("all")


@pytest.fixture(scope="module")
def model(data: BundledData) -> PredefinedTemplates:
    return PredefinedTemplates().fit((), data, RANDOM)


def predict(model: PredefinedTemplates, data: BundledData, text: str, environment: str) -> Prediction:
    said = Demonstration("said", "none", environment, text, ())
    return model.predict(Example("said", "none", "kitchen", environment, 1, said), data, RANDOM)


def executable(data: BundledData, prediction: Prediction, environment: str) -> bool:
    return validate(data.world(environment).task.problem, prediction.instructions).valid


def written(prediction: Prediction) -> list[str]:
    return [str(instruction) for instruction in prediction.instructions]


# ---------------------------------------------------------------- where it wins: no demonstration was ever seen


def test_a_template_for_exactly_this_is_carried_out(model: PredefinedTemplates, data: BundledData) -> None:
    found = predict(model, data, "Put the plate on the table.", "kitchen4")
    assert written(found) == [
        "find(plate1)",
        "moveto(plate1)",
        "grasp(plate1)",
        "moveto(table1)",
        "keep(plate1, table1, on)",
    ]
    assert executable(data, found, "kitchen4")


@pytest.mark.parametrize("thing", ["fork", "egg", "sponge", "towel", "knife", "glass"])
def test_objects_that_nobody_ever_demonstrated_are_served(
    thing: str, model: PredefinedTemplates, data: BundledData
) -> None:
    environment = next(
        e for e in data.corpus.environments() if any(o.startswith(thing) for o in data.world(e).profiles.objects)
    )
    found = predict(model, data, f"Take the {thing}.", environment)
    assert written(found)[-1] == f"grasp({thing}1)"


def test_each_of_several_nouns_is_served(model: PredefinedTemplates, data: BundledData) -> None:
    found = predict(model, data, "Take the spoon and the fork.", "kitchen1")
    assert [i.args for i in found.instructions if i.name == "grasp"] == [("spoon1",), ("fork1",)]


def test_a_verb_has_several_templates_and_the_clause_chooses(model: PredefinedTemplates, data: BundledData) -> None:
    sources = {
        text: predict(model, data, text, "kitchen1").served[0].source
        for text in ("Heat the pot.", "Heat the cup.", "Heat some water.", "Heat some water in the kettle.")
    }
    assert None not in sources.values()
    assert len(set(sources.values())) == len(sources)


def test_an_edge_of_the_object_graph_ties_knob_and_burner(model: PredefinedTemplates, data: BundledData) -> None:
    found = predict(model, data, "Light burner 3.", "kitchen1")
    assert written(found)[-1] == "turn(stove1_knob3, high)"


def test_the_next_clause_sees_what_was_done(model: PredefinedTemplates, data: BundledData) -> None:
    found = predict(model, data, "Fill the kettle. Pour the water into the bowl.", "kitchen1")
    assert "pour(kettle1, bowl1)" in written(found)


def test_together_the_clauses_are_the_prediction(model: PredefinedTemplates, data: BundledData) -> None:
    found = predict(model, data, "Take the cup. Sing a song. Close the fridge.", "kitchen1")
    assert sum((s.said for s in found.served), ()) == found.instructions
    assert [s.source is None for s in found.served] == [False, True, False]
    assert found.served[1].said == ()


# ---------------------------------------------------------------- where it fails, as the paper says


def test_a_shut_cupboard_is_not_thought_of(model: PredefinedTemplates, data: BundledData) -> None:
    text = "Take the plate."
    assert not executable(data, predict(model, data, text, "kitchen1"), "kitchen1")  # it is in the cupboard
    assert executable(data, predict(model, data, text, "kitchen4"), "kitchen4")  # it is on the counter


def test_a_full_pot_is_filled_again(model: PredefinedTemplates, data: BundledData) -> None:
    found = predict(model, data, "Boil some water in the pot.", "kitchen4")  # the pot holds water already
    assert "turn(sink1_handle, high)" in written(found)


def test_a_door_that_is_open_is_opened_again(model: PredefinedTemplates, data: BundledData) -> None:
    text = "Put the milk into the fridge."
    assert executable(data, predict(model, data, "Put the fork into the fridge.", "kitchen1"), "kitchen1")
    assert not executable(data, predict(model, data, text, "kitchen4"), "kitchen4")


def test_what_is_in_the_hand_is_fetched_again(model: PredefinedTemplates, data: BundledData) -> None:
    found = predict(model, data, "Take the pot. Put it on the stove.", "kitchen1")
    assert not executable(data, found, "kitchen1")


def test_of_several_objects_it_takes_the_first_whatever_is_meant(model: PredefinedTemplates, data: BundledData) -> None:
    found = predict(model, data, "Open the fridge. Close the door.", "kitchen1")
    assert written(found)[-1] == "close(cupboard1_door)"


# ---------------------------------------------------------------- classes that are no types: by name and by word


@pytest.mark.skipif(not os.environ.get("VEIL500_DIR"), reason="VEIL500_DIR does not say where VEIL-500 is")
@pytest.mark.parametrize(
    ("text", "environment", "last"),
    [
        ("Turn on the television.", "living_room1", "press Tv_1PowerButton"),
        ("Lay the cushion on the coffee table.", "living_room1", "keep Pillow_1 On CoffeeTable_1"),
        ("Light the burner.", "kitchen1", "turn StoveKnob_1"),
        ("Place the can on the couch.", "living_room1", "keep Coke_1 On Loveseat_1"),
    ],
)
def test_names_and_words_stand_for_classes(text: str, environment: str, last: str) -> None:
    veil = VeilDataset(Path(os.environ["VEIL500_DIR"]), "all")
    world = environment.rstrip("0123456789")
    said = Demonstration("said", "none", environment, text, ())
    example = Example("said", "none", world, environment, 1, said)
    found = PredefinedTemplates().fit((), veil, RANDOM).predict(example, veil, RANDOM)
    assert veil.written(environment, found.instructions)[-1] == last


# ---------------------------------------------------------------- all of it


def test_it_is_deterministic_and_learns_nothing(data: BundledData) -> None:
    fitted = [PredefinedTemplates().fit(some, data, RANDOM) for some in ((), data.examples[:40])]
    for example in data.examples[::25]:
        assert len({model.predict(example, data, RANDOM).instructions for model in fitted}) == 1


@pytest.mark.parametrize("path", LIBRARIES, ids=lambda path: path.parent.name)
def test_every_library_loads(path: Path) -> None:
    library = load_templates(DomainFolder(path.parent))
    assert library.templates
    known = {action.name for action in DomainFolder(path.parent).domain.actions}
    assert {i.name for t in library.templates for i in t.instructions} <= known
    assert all(variable in t.variables for t in library.templates for variable in t.objects)


def test_there_is_a_library_for_the_kitchen() -> None:
    assert ROOT / "domains" / "kitchen" / FILE in LIBRARIES


# ---------------------------------------------------------------- faults


GOOD = """\
kinds:
  jar: {types: coffee_jar}
templates:
  - verb: take
    objects: [x]
    variables: {x: item}
    where: scoopable ?x
    instructions: find ?x, grasp ?x
"""


def folder(tmp_path: Path, text: str) -> DomainFolder:
    shutil.copy(ROOT / "domains" / "kitchen" / "domain.pddl", tmp_path)
    (tmp_path / FILE).write_text(text, encoding="utf-8")
    return DomainFolder(tmp_path)


FAULTS = {
    "unknown type": ("{x: item}", "{x: itme}", "unknown type or kind 'itme'", 6),
    "unknown type of a kind": ("coffee_jar}", "cofee_jar}", "unknown type 'cofee_jar'", 2),
    "kind like a type": ("  jar:", "  item:", "is a type of the domain", 2),
    "unknown action": ("grasp ?x", "grab ?x", "unknown action 'grab'", 8),
    "wrong arity": ("grasp ?x", "grasp ?x ?x", "has 2 arguments, 'grasp' takes 1", 8),
    "unbound variable": ("grasp ?x", "grasp ?y", "unknown variable 'y'", 8),
    "unbound object": ("[x]", "[z]", "unknown variable 'z'", 5),
    "not a constant": ("grasp ?x", "grasp x", "unknown constant 'x'", 8),
    "wrong type": ("{x: item}", "{x: thing}", "'?x' is of type thing", 8),
    "unknown predicate": ("scoopable ?x", "suits ?x", "unknown predicate 'suits'", 7),
    "empty step": ("find ?x, ", "find ?x, , ", "unknown action ''", 8),
    "no verb": ("verb: take", "verb: []", "'verb' is empty", 4),
    "relation of one": ("[x]", "[x]\n    relation: on", "a relation is between two objects", 6),
    "unknown key": ("objects", "object", "unknown key", 5),
    "not a word": ("[x]", "[1]", "should be text", 5),
    "not YAML": ("[x]", "[x", "not YAML", 6),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_in_the_file_is_located(fault: str, tmp_path: Path) -> None:
    right, wrong, message, line = FAULTS[fault]
    assert load_templates(folder(tmp_path, GOOD)).templates
    assert right in GOOD
    with pytest.raises(TmdError) as caught:
        load_templates(folder(tmp_path, GOOD.replace(right, wrong, 1)))
    assert message in caught.value.message
    assert caught.value.location is not None
    assert caught.value.location.line == line
    assert "\n" not in str(caught.value)


def test_a_domain_without_a_library_is_an_error(tmp_path: Path) -> None:
    shutil.copy(ROOT / "domains" / "kitchen" / "domain.pddl", tmp_path)
    with pytest.raises(TmdError, match=FILE):
        load_templates(DomainFolder(tmp_path))
