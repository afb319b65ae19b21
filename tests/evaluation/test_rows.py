"""The rows of Table II on a few lessons of our own in the bundled kitchens: where each must win, and where fail.

The rows that learn weights have here those set by hand, so that what they can do does not hang on what a handful of
examples teach; learning is tested in ``test_crf.py``.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests import bundled
from tmd.diagnostics import TmdError
from tmd.evaluation.metrics import ied
from tmd.evaluation.models.model import MODELS, Model, make_model
from tmd.evaluation.models.paper_models import ROWS, Crf
from tmd.evaluation.models.prediction import Prediction
from tmd.evaluation.runs.dataset import BundledData, Example
from tmd.evaluation.runs.jobs import sentences
from tmd.inference.config import PAPER, PRESETS
from tmd.pddl.plan_file import parse_instruction
from tmd.pddl.validator import validate
from tmd.world.demonstration import Demonstration, Segment

ROOT = Path(__file__).parents[2]
KITCHENS = tuple(f"kitchen{number}" for number in range(1, 6))
BY_CLAUSE = ("nearest", "no_domain", "no_latent", "full")
"""The rows that serve each clause from a template of its verb."""

FETCH = "find({x}); moveto({x}); grasp({x})"
OPEN_CUPBOARD = "moveto(cupboard1); open(cupboard1_door)"
FILL = FETCH + "; moveto(sink1); keep({x}, sink1, in); turn(sink1_handle, high); turn(sink1_handle, off); grasp({x})"
ON_STOVE = "moveto(stove1); keep({x}, stove1_burner1, on)"


def lines(text: str, x: str = "") -> list[str]:
    return [line.strip() for line in text.format(x=x).split(";")]


def lesson(*pieces: tuple[str, str], environment: str = "kitchen1", x: str = "", name: str = "lesson") -> Example:
    """A demonstration: sentences, each with what was done for it."""
    text, segments = "", []
    for words, done in pieces:
        start = len(text)
        text += f"{words}. "
        made = tuple(parse_instruction(line) for line in lines(done, x))
        segments.append(Segment(start, start + len(words), made))
    return example(text.strip(), environment, segments, name)


def example(text: str, environment: str, segments: Sequence[Segment] = (), name: str = "asked") -> Example:
    demonstration = Demonstration(name, "own", environment, text, tuple(segments))
    return Example(name, "own", "kitchen", environment, int(environment[-1]), demonstration)


PLATE_ON_COUNTER = lesson(("Take the plate", FETCH), environment="kitchen4", x="plate1", name="on-counter")
PLATE_IN_CUPBOARD = lesson(("Take the plate", f"{OPEN_CUPBOARD}; {FETCH}"), x="plate1", name="in-cupboard")
TAKE_POT = lesson(("Take the pot", FETCH), x="pot1", name="take")
SET_POT = lesson(("Put the pot on the stove", f"{FETCH}; {ON_STOVE}"), x="pot1", name="put")
HEATING = lesson(
    ("Fill the kettle", FILL),
    ("Put the kettle on the stove", ON_STOVE),
    ("Turn on burner 1", "turn(stove1_knob1, high)"),
    x="kettle1",
    name="heating",
)
TEXT_OF_HEATING = HEATING.demonstration.text
KETTLE_ON_TAP = lesson(
    ("Take the kettle", FETCH), ("Place the kettle on the tap", "moveto(sink1); keep({x}, sink1, in)"), x="kettle1"
)
LESSONS = (PLATE_ON_COUNTER, PLATE_IN_CUPBOARD, TAKE_POT, SET_POT, HEATING, KETTLE_ON_TAP)


@pytest.fixture(scope="module")
def data() -> BundledData:
    return bundled.data("ramen")


def fitted(name: str, data: BundledData, *lessons: Example) -> Model:
    model = make_model(name)
    if isinstance(model, Crf):
        model.learned = False
    return model.fit(lessons, data, np.random.default_rng(0))


def ask(model: Model, data: BundledData, text: str, environment: str = "kitchen1") -> Prediction:
    return model.predict(example(text, environment), data, np.random.default_rng(0))


def written(prediction: Prediction) -> list[str]:
    return [str(instruction) for instruction in prediction.instructions]


def executable(data: BundledData, prediction: Prediction, environment: str = "kitchen1") -> bool:
    return validate(data.world(environment).task.problem, prediction.instructions).valid


@pytest.mark.parametrize("demonstration", LESSONS, ids=lambda e: e.id)
def test_the_lessons_themselves_can_be_executed(data: BundledData, demonstration: Example) -> None:
    assert executable(data, Prediction(demonstration.gold), demonstration.environment)


# ---------------------------------------------------------------- Chance


def test_chance_has_the_usual_length_and_is_almost_never_right(data: BundledData) -> None:
    train = data.examples[:7]
    model = make_model("chance").fit(train, data, np.random.default_rng(0))
    random = np.random.default_rng(1)
    drawn = [(e, model.predict(e, data, random).instructions) for e in data.examples[::2] for _ in range(10)]
    assert {len(made) for _, made in drawn} == {sorted(len(e.gold) for e in train)[3]}
    assert not any(made == e.gold for e, made in drawn)
    assert np.mean([ied(made, e.gold) for e, made in drawn]) < 3


def test_chance_draws_from_all_that_can_be_said_in_the_environment(data: BundledData) -> None:
    model = make_model("chance").fit([HEATING], data, np.random.default_rng(0))
    operators = data.world("kitchen3").task.by_instruction
    random = np.random.default_rng(1)
    drawn = Counter(i for _ in range(300) for i in model.predict(example("", "kitchen3"), data, random).instructions)
    assert set(drawn) <= set(operators)
    assert len(drawn) > 0.9 * len(operators)
    assert max(drawn.values()) < 10 * drawn.total() / len(operators)


def test_chance_says_nothing_in_a_kind_of_world_it_was_not_trained_in(data: BundledData) -> None:
    model = make_model("chance").fit([], data, np.random.default_rng(0))
    assert ask(model, data, "Take the pot.") == Prediction()


# ---------------------------------------------------------------- Nearest Environment Instantiation


@pytest.mark.parametrize("seen", [PLATE_ON_COUNTER, PLATE_IN_CUPBOARD], ids=lambda e: e.id)
def test_nearest_wins_where_the_environment_is_the_one_of_the_template(data: BundledData, seen: Example) -> None:
    model = fitted("nearest", data, PLATE_ON_COUNTER, PLATE_IN_CUPBOARD)
    found = ask(model, data, "Take the plate.", seen.environment)
    assert (found.instructions, found.served[0].source) == (seen.gold, seen.id)


def test_nearest_heeds_the_environment_more_than_the_words(data: BundledData) -> None:
    """The mug stands as the bowl stood; the words are those of the other template."""
    bowl = lesson(("Take the bowl", FETCH), x="bowl1", name="bowl")
    cup = lesson(("Take the mug", f"{OPEN_CUPBOARD}; {FETCH}"), environment="kitchen5", x="mug1", name="mug")
    found = {n: ask(fitted(n, data, cup, bowl), data, "Take the mug.") for n in ("nearest", "full")}
    assert found["nearest"].served[0].source == "bowl"
    assert found["full"].served[0].source == "mug"


@pytest.mark.parametrize("name", ["nearest", "no_domain"])
@pytest.mark.parametrize(
    ("seen", "text", "environment"),
    [
        ((PLATE_ON_COUNTER,), "Take the plate.", "kitchen1"),
        ((PLATE_IN_CUPBOARD,), "Take the plate.", "kitchen4"),
        ((TAKE_POT, SET_POT), "Take the pot. Put it on the stove.", "kitchen1"),
        ((KETTLE_ON_TAP,), "Place the pot on the tap.", "kitchen1"),
        ((HEATING,), "Put the kettle on the stove.", "kitchen1"),
    ],
    ids=["behind a shut door", "the door is open already", "in the hand already", "not in the hand", "left unsaid"],
)
def test_without_knowledge_a_template_is_taken_as_it_is_where_that_cannot_be_executed(
    data: BundledData, name: str, seen: Sequence[Example], text: str, environment: str
) -> None:
    found = ask(fitted(name, data, *seen), data, text, environment)
    assert all(served.said and not served.latent for served in found.served)
    assert not executable(data, found, environment)
    full = ask(fitted("full", data, *seen), data, text, environment)
    assert all(served.said for served in full.served)
    assert executable(data, full, environment)


# ---------------------------------------------------------------- No NL Instructions


TEXTS = ("Take the pot.", "Fill the kettle. Turn on burner 1.", "Open the fridge, please", "Sing a song.", "")


def test_no_nl_cannot_tell_two_texts_apart(data: BundledData) -> None:
    deaf, full = (fitted(name, data, TAKE_POT, HEATING) for name in ("no_nl", "full"))
    for environment in ("kitchen1", "kitchen3"):
        assert len({ask(deaf, data, text, environment).instructions for text in TEXTS}) == 1
        assert executable(data, ask(deaf, data, "", environment), environment)
    assert ask(full, data, "Take the pot.").instructions == TAKE_POT.gold
    assert ask(full, data, TEXT_OF_HEATING).instructions == HEATING.gold


def test_no_nl_wins_where_nothing_has_to_be_said(data: BundledData) -> None:
    """All that was ever done here is one thing."""
    assert ask(fitted("no_nl", data, TAKE_POT), data, "Sing a song.").instructions == TAKE_POT.gold


def test_no_nl_takes_as_many_steps_as_people_do(data: BundledData) -> None:
    for seen, steps in (((TAKE_POT,), 1), ((HEATING,), 3), ((TAKE_POT, HEATING, HEATING), 3)):
        served = ask(fitted("no_nl", data, *seen), data, "Take the pot.").served
        assert len(served) == steps
        assert {(s.text, s.verb) for s in served} == {("", "")}


def test_no_nl_weighs_nothing_that_was_said(data: BundledData) -> None:
    deaf = ask(fitted("no_nl", data, TAKE_POT), data, "Take the pot.", "kitchen3")
    assert not any(
        served.factors.get(name)
        for served in deaf.served
        for name in ("clause_distance", "parameter_cardinality", "inconsistent_end", "objects_not_touched")
    )


# ---------------------------------------------------------------- No Domain Knowledge


@pytest.mark.parametrize("name", BY_CLAUSE)
@pytest.mark.parametrize("seen", [PLATE_IN_CUPBOARD, TAKE_POT, HEATING, KETTLE_ON_TAP], ids=lambda e: e.id)
def test_where_nothing_has_to_be_known_every_row_says_what_was_shown(
    data: BundledData, name: str, seen: Example
) -> None:
    found = ask(fitted(name, data, seen), data, seen.demonstration.text, seen.environment)
    assert found.instructions == seen.gold


def test_no_domain_does_not_know_what_its_instructions_did(data: BundledData) -> None:
    """To it the kettle is as empty as before when it is put on the stove, unlike in the lesson."""
    env = {
        name: [
            served.factors["environment_distance"]
            for served in ask(fitted(name, data, HEATING), data, TEXT_OF_HEATING).served
        ]
        for name in ("no_domain", "full")
    }
    assert env["full"] == [0, 0, 0]
    assert env["no_domain"][0] == 0 < env["no_domain"][1]


# ---------------------------------------------------------------- No latent nodes


def test_the_example_of_the_paper(data: BundledData) -> None:
    """Section VII-A: no template fits, as the robot "is not already grasping the pot"."""
    text, template = "Place the pot on the tap.", ["moveto(sink1)", "keep(pot1, sink1, in)"]
    found = {name: ask(fitted(name, data, KETTLE_ON_TAP), data, text) for name in BY_CLAUSE}
    assert written(found["nearest"]) == written(found["no_domain"]) == template
    assert written(found["no_latent"]) == []
    assert written(found["full"]) == [*lines(FETCH, "pot1"), *template]
    (served,) = found["full"].served
    assert [str(i) for i in served.latent] == lines(FETCH, "pot1")
    assert [str(i) for i in served.said] == template


@pytest.mark.parametrize("environment", KITCHENS)
def test_without_latent_nodes_nothing_is_added_and_nothing_impossible_is_said(
    data: BundledData, environment: str
) -> None:
    model = fitted("no_latent", data, *LESSONS)
    for text in (seen.demonstration.text for seen in LESSONS):
        found = ask(model, data, text, environment)
        assert not any(served.latent for served in found.served)
        assert executable(data, found, environment)


def test_no_latent_leaves_out_what_is_done_already(data: BundledData) -> None:
    """Trimming needs no planner: the pot is in the hand."""
    found = ask(fitted("no_latent", data, TAKE_POT, SET_POT), data, "Take the pot. Put it on the stove.")
    assert found.instructions == SET_POT.gold


# ---------------------------------------------------------------- Our full model


@pytest.mark.parametrize("left_out", range(3))
def test_a_sentence_that_is_missing_is_made_up_for(data: BundledData, left_out: int) -> None:
    """Section VII-A: latent nodes are "especially helpful in scenarios where instructions were partially missing"."""
    whole = TEXT_OF_HEATING
    spans = sentences(whole)
    assert len(spans) == 3
    text = "".join(whole[span.start : span.end] for place, span in enumerate(spans) if place != left_out)
    full, without = (ask(fitted(name, data, HEATING), data, text) for name in ("full", "no_latent"))
    assert executable(data, full)
    assert [served.said for served in full.served] == [
        segment.instructions for place, segment in enumerate(HEATING.demonstration.segments) if place != left_out
    ]
    needed = left_out < 2  # the last sentence is nothing that others build upon
    assert any(served.latent for served in full.served) == needed
    assert all(served.said for served in without.served) != needed


def sentences_of(examples: Sequence[Example]) -> list[str]:
    texts = [e.demonstration.text for e in examples]
    return list(dict.fromkeys(text[s.start : s.end].strip(" .") for text in texts for s in sentences(text)))


@st.composite
def texts(draw: st.DrawFn) -> str:
    """A few sentences that somebody has said."""
    pool = sentences_of([*bundled.data("ramen").examples[1::9], *LESSONS])
    return ". ".join(draw(st.lists(st.sampled_from(pool), min_size=1, max_size=3)))


@pytest.fixture(scope="module")
def full(data: BundledData) -> Model:
    """The row itself, with the weights that it learns from a few examples."""
    model = make_model("full")
    assert isinstance(model, Crf)
    model.most_examples, model.rounds, model.proposals = 3, 1, 3
    return model.fit(data.examples[::12], data, np.random.default_rng(0))


@settings(max_examples=20, deadline=None)
@given(
    said=texts(),
    environment=st.sampled_from(KITCHENS),
)
def test_whatever_is_said_the_full_model_can_execute_its_answer(
    data: BundledData, full: Model, said: str, environment: str
) -> None:
    found = ask(full, data, said, environment)
    assert executable(data, found, environment)
    assert found.instructions == tuple(i for served in found.served for i in (*served.latent, *served.said))


def test_those_answers_are_not_empty(data: BundledData, full: Model) -> None:
    for environment in KITCHENS:
        assert any(ask(full, data, e.demonstration.text, environment).instructions for e in data.examples[:24:12])


# ---------------------------------------------------------------- all rows


@pytest.mark.parametrize("name", sorted(MODELS))
def test_every_row_runs_by_name_and_says_the_same_again(data: BundledData, name: str) -> None:
    text = "Fill the kettle. Turn on burner 1."
    answers = []
    for _ in range(2):
        model = make_model(name)
        if isinstance(model, Crf):
            model.most_examples, model.rounds, model.proposals = 2, 1, 2
        # the plate twice: of lessons that teach each other nothing, weights are learned that favour doing nothing
        model = model.fit((HEATING, PLATE_ON_COUNTER, PLATE_IN_CUPBOARD), data, np.random.default_rng(0))
        answers.append(ask(model, data, text))
    assert answers[0] == answers[1]
    assert bool(answers[0].instructions) == (name != "empty")
    assert all(i in data.world("kitchen1").task.by_instruction for i in answers[0].instructions)
    if name in ("templates", "tree", *BY_CLAUSE):
        assert [served.verb for served in answers[0].served] == ["fill", "turn_on"]


@pytest.mark.parametrize("name", ["templates", "tree"])
def test_the_baselines_of_others_do_not_look_whether_the_cupboard_is_shut(data: BundledData, name: str) -> None:
    model = fitted(name, data, *[PLATE_ON_COUNTER] * 4)
    assert executable(data, ask(model, data, "Take the plate.", "kitchen4"), "kitchen4")
    assert ask(model, data, "Take the plate.", "kitchen4").instructions
    assert not executable(data, ask(model, data, "Take the plate.", "kitchen1"), "kitchen1")


def test_the_table_has_the_rows_of_the_paper_in_its_order() -> None:
    rows = ["chance", "templates", "tree", "no_nl", "nearest", "no_domain", "no_latent", "full"]
    assert [name for name in MODELS if name in rows] == rows
    assert set(ROWS) <= set(MODELS)


def test_an_unknown_row_is_refused_with_one_that_is_like_it() -> None:
    with pytest.raises(TmdError, match="fulll") as caught:
        make_model("fulll")
    assert "full" in (caught.value.hint or "")


def test_what_ships_is_what_is_measured() -> None:
    """The presets are rows as they are; ``full`` and its ablations differ from the paper's in one thing each."""
    for name, config in PRESETS.items():
        assert (ROWS[name]().config, ROWS[name]().learned) == (config, False)
    assert ROWS["full"]().config == PAPER
    assert ROWS["no_latent"]().config == replace(PAPER, latent=False)
    assert ROWS["no_domain"]().config == replace(PAPER, knowledge=False)
    assert ROWS["no_nl"]().config == replace(PAPER, language=False)
