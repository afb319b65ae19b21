"""The language model as the reader of the studio; the model is a server on loopback."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from threading import Event
from typing import Any

import pytest

from tests.readers.fake_server import Answer, FakeServer, asked, reply, serve
from tmd.pddl.model import Atom, Not
from tmd.readers.interface import Question, QuestionOption, Usage
from tmd.readers.llm.client import KEY, MODEL, URL, ModelError
from tmd.studio.panels.say_panel import Request
from tmd.studio.teaching import Teacher
from tmd.view.panels import effort
from tmd.world.corpus import Corpus

pytest.importorskip("openai", reason="needs the extra llm")
pytest.importorskip("viser", reason="needs the extra studio")

from experiments.studio.wire import Wire
from tmd.studio.server import Server
from tmd.studio.studio import Studio

TEXT = "Put it on the shelf."
CUP, BOOK = "(at cup1 shelf1 on)", "(at book1 table1 on)"
QUESTION = {
    "text": "Which thing <b>do</b> you mean?",
    "step": 0,
    "options": [{"answer": "the cup, on the shelf", "goal": CUP}, {"answer": "the book, on the table", "goal": BOOK}],
}
OPTIONS = [option["answer"] for option in QUESTION["options"]]  # type: ignore[attr-defined]
SECRET = "sk-of-this-test-only"


@pytest.fixture(autouse=True)
def _alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """No reply of another test, and nothing of the user's environment."""
    for name in (KEY, URL, MODEL):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("TMD_STUDIO_STATE", str(tmp_path / "drafts"))


@pytest.fixture
def go_on() -> Event:
    """The model replies only while it is set."""
    event = Event()
    event.set()
    return event


@pytest.fixture
def model(go_on: Event) -> Iterator[FakeServer]:
    """A model that asks back, where it is asked for :data:`TEXT`, and refuses anything else."""

    def decide(body: dict[str, Any]) -> Answer:
        assert go_on.wait(30)
        _, request = asked(body)
        return Answer(reply(request, CUP, questions=[QUESTION]) if request == TEXT else reply(request, None))

    with serve(decide) as server:
        yield server


@pytest.fixture
def server(table: Corpus) -> Iterator[Server]:
    served = Server(Studio(table, Teacher(table), "corner1"), "127.0.0.1", 0)
    yield served
    served.close()


def element(visitor: Wire, label: str) -> dict[str, Any]:
    return visitor.elements[visitor.find(label)]


def ask(visitor: Wire, url: str, text: str = TEXT) -> None:
    visitor.put("Reader", "language model")
    visitor.put("Model", "fake")
    visitor.put("Server address", url)
    visitor.put("Text", text)
    visitor.press("Plan it")


def buttons(visitor: Wire) -> list[str]:
    """The options that are offered."""
    if not element(visitor, "Which one is meant?")["visible"]:
        return []
    return [str(each["label"]) for each in visitor.elements.values() if each.get("label") in OPTIONS]


def test_the_teacher_grounds_with_a_reader_and_answers(table: Corpus, model: FakeServer) -> None:
    teacher, world = Teacher(table), table.world("corner1")
    reader = teacher.model_reader("fake", model.url, verify=False)
    request = Request(TEXT, reader)
    grounded = teacher.ground(TEXT, world, reader=reader, ask=request.answer)
    assert grounded.question is not None and str(grounded.plans[0].instructions[-1]) == "keep(cup1, shelf1, on)"
    again = Request(TEXT, reader, {0: grounded.question.options[1].formula})
    answered = teacher.ground(TEXT, world, reader=reader, ask=again.answer)
    assert answered.question is None and str(answered.plans[0].instructions[-1]) == "keep(book1, table1, on)"
    assert len(model.bodies) == 1


def test_a_reader_is_made_once_for_its_settings(table: Corpus) -> None:
    teacher = Teacher(table)
    with pytest.raises(ModelError, match="no language model is named"):
        teacher.model_reader("", "http://localhost:1/v1", verify=False)
    first = teacher.model_reader("fake", "http://localhost:1/v1", verify=False)
    assert teacher.model_reader("fake", "http://localhost:1/v1", verify=False) is first
    assert teacher.model_reader("fake", "http://localhost:1/v1", verify=True) is not first
    for number in range(20):
        teacher.model_reader(f"fake{number}", "http://localhost:1/v1", verify=False)
        assert teacher.model_reader("fake", "http://localhost:1/v1", verify=False) is first


def test_the_key_goes_only_to_the_server_of_the_environment(
    table: Corpus, model: FakeServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    teacher, world = Teacher(table), table.world("corner1")
    monkeypatch.setenv(KEY, SECRET)
    teacher.ground(TEXT, world, reader=teacher.model_reader("fake", model.url, verify=False))
    monkeypatch.setenv(URL, model.url)
    for text, url in (("Take it.", ""), ("Lift it.", model.url)):
        teacher.ground(text, world, reader=teacher.model_reader("fake", url, verify=False))
    assert model.keys == ["Bearer none", f"Bearer {SECRET}", f"Bearer {SECRET}"]


def test_an_answer_is_found_by_step_and_goal() -> None:
    cup, book = Atom("at", ("cup1", "shelf1", "on")), Atom("at", ("book1", "table1", "on"))
    request = Request(TEXT, answers={1: cup, 2: Not(cup)})

    def question(step: int, *formulas: Atom) -> Question:
        return Question("Which?", step, tuple(QuestionOption("", formula) for formula in formulas))

    assert request.answer(question(1, cup, book)) == 0
    assert request.answer(question(1, book, cup)) == 1
    assert request.answer(question(0, cup, book)) is None  # another step
    assert request.answer(question(2, cup, book)) is None  # another reading, which does not offer it


def test_effort() -> None:
    assert effort(None) == ""
    html = effort(Usage("<i>m", 1234, 56, 1.26, cached=1, digests=("a", "b")))
    for words in ("&lt;i&gt;m", "1,234 tokens sent, 56 received", "1.3 s", "2 replies, 1 from the cache"):
        assert words in html


def test_a_question_is_answered_by_a_button(server: Server, model: FakeServer, go_on: Event) -> None:
    go_on.clear()
    with Wire(server.url) as visitor:
        ask(visitor, model.url)
        visitor.told("Asking the language model …")
        visitor.until(lambda: element(visitor, "Plan it")["disabled"])
        visitor.press("Plan it")  # no page would: the button is disabled
        visitor.put("Object", "cup1")  # the page stays usable
        visitor.shows("<h4>cup1: cup")
        go_on.set()
        visitor.told("It is for one of several meanings")
        visitor.until(lambda: buttons(visitor) == OPTIONS)
        visitor.shows("Which thing &lt;b&gt;do&lt;/b&gt; you mean?")
        visitor.shows("Put cup1 on shelf1")
        visitor.shows("<li>1,000 tokens sent, 100 received</li>")
        assert not element(visitor, "Plan it")["disabled"]
        assert element(visitor, OPTIONS[1])["hint"] == BOOK
        visitor.press(OPTIONS[1])
        visitor.shows("Put book1 on table1")
        visitor.until(lambda: buttons(visitor) == [])
        visitor.shows("1 reply, 1 from the cache")
        visitor.told("Planned in")
        visitor.press("Correct this plan")
        visitor.told("The plan is under Correct")
    assert len(model.bodies) == 1


def test_a_refusal_of_the_model_is_shown(server: Server, model: FakeServer) -> None:
    with Wire(server.url) as visitor:
        ask(visitor, model.url, "Fly.")
        visitor.told("No plan: It cannot be done here.<")
        visitor.shows("<h4>Read by the language model fake</h4>")
        assert element(visitor, "Energies, and why the others lost")["visible"]


@pytest.mark.parametrize(
    ("settings", "answer"),
    [
        ({"Model": "", "Server address": "http://127.0.0.1:9/v1"}, "no language model is named"),
        ({"Model": "", "Server address": "http://127.0.0.1:9/v1"}, f"name one, or set ${MODEL}"),
        ({"Model": "fake", "Server address": ""}, "there is no key for the language model"),
        ({"Model": "fake", "Server address": "http://127.0.0.1:9/v1"}, "http://127.0.0.1:9/v1 cannot be reached"),
        ({"Model": "fake", "Server address": "http://127.0.0.1:9/v1"}, "check the address of the server"),
        ({"Model": "fake", "Server address": "http://127.0.0.1:port/v1"}, "is not the address of a server"),
        ({"Model": "fake", "Server address": "file:///etc/passwd"}, "is not the address of a server"),
        ({"Model": 7, "Server address": "http://\x00/"}, "is not the address of a server"),
    ],
)
def test_an_error_is_shown_and_the_page_stays_usable(
    server: Server, settings: dict[str, object], answer: str, capfd: pytest.CaptureFixture[str]
) -> None:
    with Wire(server.url) as visitor:
        visitor.put("Reader", "language model")
        for label, value in settings.items():
            visitor.put(label, value)
        visitor.put("Text", TEXT)
        visitor.press("Plan it")
        visitor.told(answer)
        assert "Not done: " in visitor.said()
        visitor.until(lambda: not element(visitor, "Plan it")["disabled"])
        visitor.put("Reader", "rules")
        visitor.put("Text", "Put the cup on the shelf.")
        visitor.press("Plan it")
        visitor.told("Planned in")
    assert "Traceback" not in capfd.readouterr().err


def test_without_the_package(server: Server, model: FakeServer, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tmd.readers.llm.client.find_spec", lambda name: None)
    with Wire(server.url) as visitor:
        ask(visitor, model.url)
        visitor.told("the package openai is not installed")
        visitor.told("pip install")


def test_the_fields_are_filled_from_the_environment_and_the_key_is_not_sent(
    table: Corpus, model: FakeServer, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    for name, value in ((MODEL, "its model"), (URL, model.url), (KEY, SECRET)):
        monkeypatch.setenv(name, value)
    served = Server(Studio(table, Teacher(table), "corner1"), "127.0.0.1", 0)
    try:
        with Wire(served.url) as visitor:
            visitor.shows("Click on an object, or choose one")  # the last panel is there
            assert element(visitor, "Model")["value"] == "its model" and not element(visitor, "Model")["visible"]
            assert element(visitor, "Server address")["value"] == model.url
            assert not element(visitor, "Reader settings")["expand_by_default"]
            visitor.put("Reader", "language model")
            visitor.until(lambda: element(visitor, "Check the plan with the model")["visible"])
            visitor.put("Text", TEXT)
            visitor.press("Plan it")
            visitor.told("Planned in")
            assert SECRET not in json.dumps([visitor.elements, visitor.told_page], default=str)
    finally:
        served.close()
    assert model.keys == [f"Bearer {SECRET}"] and model.bodies[0]["model"] == "its model"
    assert SECRET not in "".join(capfd.readouterr())


def test_a_model_need_not_be_waited_for(server: Server, model: FakeServer, go_on: Event) -> None:
    go_on.clear()
    with Wire(server.url) as visitor:
        for label, value, answer in (
            ("Reader", "rules", "not waited for any longer"),
            ("Environment", "corner2", "Asking the language model …"),
        ):
            ask(visitor, model.url)
            visitor.told("Asking the language model …")
            visitor.put(label, value)
            visitor.told(answer)
            visitor.until(lambda: not element(visitor, "Plan it")["disabled"])
        visitor.put("Reader", "rules")
        visitor.put("Text", "Take the cup.")
        visitor.press("Plan it")
        visitor.told("Planned in")
        go_on.set()  # what comes too late is not shown
        visitor.happens(step=1, list="say")
        visitor.shows("1 / 2 ")
        assert not buttons(visitor)


def test_what_was_read_by_a_model_stays_when_all_is_learned(
    server: Server, model: FakeServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server.studio.teacher, "retrain", lambda: None)
    with Wire(server.url) as visitor:
        visitor.put("Task text", TEXT)
        visitor.press("Begin")
        visitor.told("Point at an object")
        visitor.put("With", "cup1")
        visitor.press("Go and stand before cup1")
        visitor.shows("▸ Go and stand before cup1")
        visitor.press("Save (K)")
        visitor.told("Saved as shown-corner1-01")
        ask(visitor, model.url)
        visitor.told("It is for one of several meanings")
        for each in server._visitors.values():
            each.learning(on=False)
        visitor.told("everything is learned")
        assert buttons(visitor) == OPTIONS
