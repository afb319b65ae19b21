"""What visitors do, in a real browser: say, step, point, show, save, learn, correct."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

import pytest

from tests.readers.fake_server import Answer, asked, reply
from tests.readers.fake_server import serve as serve_model
from tmd.readers.llm.client import KEY, MODEL, URL

from .conftest import Served, serve

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator, Page

WAIT = 120_000
RAMEN = "Fill the pot with water and boil it. Add the ramen to the pot and wait. Put the ramen in the bowl."
MANY = (
    "Open the fridge. Put the bowl on the table. Put the mug in the sink. "
    "Close the fridge. Put the cup in the sink. Put the kettle on the table."
)
"""A request with many steps that are soon planned."""
UNKNOWN = "Sterilize the kettle."
BOIL = (
    ("kettle1", "find(kettle1)", "Look around until kettle1 is in view"),
    ("kettle1", "moveto(kettle1)", "Go and stand before kettle1"),
    ("kettle1", "grasp(kettle1)", "Take kettle1 into a free hand"),
    ("sink1", "moveto(sink1)", "Go and stand before sink1"),
    ("sink1", "keep(kettle1, sink1, in)", "Put kettle1 in sink1"),
    ("sink1", "turn(sink1_handle, high)", "Turn the knob sink1_handle to high"),
    ("sink1", "turn(sink1_handle, off)", "Turn the knob sink1_handle to off"),
    ("kettle1", "grasp(kettle1)", "Take kettle1 into a free hand"),
    ("stove1", "moveto(stove1)", "Go and stand before stove1"),
    ("stove1", "keep(kettle1, stove1_burner1, on)", "Put kettle1 on stove1_burner1"),
    ("stove1", "turn(stove1_knob1, high)", "Turn the knob stove1_knob1 to high"),
    ("stove1", "wait()", "Let time pass"),
)
"""Boiling water in a kettle: the object that is pointed at, what is done, and what the page calls it."""


UNDRAWN = """
for (const name of ["drawArrays", "drawArraysInstanced", "drawElements", "drawElementsInstanced"])
  WebGL2RenderingContext.prototype[name] = () => {};
"""
"""Leaves the canvas empty: without a graphics card, to compile what it draws takes six seconds for each page."""


@contextmanager
def visiting(
    browser: Browser, served: Served, width: int = 640, height: int = 640, *, drawn: bool = "TMD_SCREENS" in os.environ
) -> Iterator[Page]:
    """Open the page; the scene is drawn where somebody asks for the pictures, and in one test."""
    context = browser.new_context(viewport={"width": width, "height": height})
    with closing(context):  # a page that stays open draws on and slows all other tests down
        page = context.new_page()
        page.set_default_timeout(WAIT)
        if not drawn:
            page.add_init_script(UNDRAWN)
        page.goto(served.url)
        page.locator("[role=status]:not(:empty)").first.wait_for()  # a welcome, or what was learned just before
        yield page


def tab(page: Page, name: str) -> None:
    page.get_by_role("tab", name=name).click()


def entry(page: Page, label: str) -> Locator:
    """The input beside a label."""
    found = page.locator(f"xpath=//*[normalize-space(text())='{label}']/following::*[self::input or self::textarea][1]")
    return found.locator("visible=true").first


def choose(page: Page, label: str, option: str) -> None:
    """Open a list and choose from it; a list that an update closes again is opened again, as anybody would."""
    from playwright.sync_api import TimeoutError as NotInTime

    listed = page.get_by_role("option", name=option, exact=True).locator("visible=true")
    entry(page, label).click()
    try:
        listed.click(timeout=10_000)
    except NotInTime:
        entry(page, label).click()
        listed.click()


def press(page: Page, name: str) -> None:
    page.get_by_role("button", name=name, exact=True).locator("visible=true").first.click()


def told(page: Page, words: str) -> None:
    """Wait until the page says something; what it says instead is told."""
    from playwright.sync_api import TimeoutError as NotInTime

    said = page.locator("[role=status]")
    try:
        said.filter(has_text=words).first.wait_for()
    except NotInTime as late:
        raise AssertionError(f"{words!r} is not in {said.all_inner_texts()}") from late


def begin(page: Page, text: str) -> None:
    """Begin to demonstrate; where the page was slow to change and nothing has begun, once more, as anybody would."""
    from playwright.sync_api import TimeoutError as NotInTime

    begun = page.get_by_role("button", name="Start over", exact=True).locator("visible=true")
    tab(page, "Demonstrate")
    entry(page, "Task text").fill(text)  # by its label: the tab that is left may still be seen for a moment
    press(page, "Begin")
    try:
        begun.wait_for(timeout=10_000)
    except NotInTime:
        entry(page, "Task text").fill(text)
        press(page, "Begin")
        begun.wait_for()


def say(page: Page, text: str) -> None:
    page.locator("textarea:visible").first.fill(text)
    press(page, "Plan it")


def eventually(page: Page, script: str, answer: object) -> None:
    """Wait until a script gives some answer; what it gives instead is told."""
    try:
        page.wait_for_function(f"answer => JSON.stringify(({script})()) === JSON.stringify(answer)", arg=answer)
    finally:
        assert page.evaluate(script) == answer


def first_line(step: str) -> str:
    """What a step does, without what it is for."""
    return step.split("\n")[0].removeprefix("▸ ").split("clause")[0].strip()


def shown(page: Page) -> list[str]:
    """The steps that are listed."""
    lists = page.locator("ol:visible")
    return [] if not lists.count() else lists.first.locator("> li").all_inner_texts()


def test_a_sentence_becomes_a_plan_and_is_stepped_through(
    kitchen_studio: Served, browser: Browser, screens: Path
) -> None:
    with visiting(browser, kitchen_studio, drawn=True) as page:
        page.screenshot(path=screens / "01-welcome.png")
        say(page, RAMEN)
        told(page, "Planned in")
        steps = shown(page)
        assert len(steps) > 8 and steps[0].startswith(("Look around until pot1", "Look around until kettle1"))
        assert page.locator(".tmd-verb").count() >= 3
        assert page.locator("[data-object]").count() == 0  # the room is drawn, not a graph
        for _ in range(5):
            press(page, "▶")
        page.locator("[aria-current=step]").filter(has_text=first_line(steps[4])).wait_for()
        pddl = page.locator("ol:visible [data-step='5']").get_attribute("title")
        eventually(page, PDDL, [pddl])  # of this step only
        page.screenshot(path=screens / "02-step.png")
        page.keyboard.press("Escape")
        page.get_by_text("Energies, and why").click()
        page.get_by_role("heading", name="Why the others lost").wait_for()
        page.screenshot(path=screens / "03-energies.png")
        page.get_by_text("What the factors count").click()
        page.get_by_text("The sum of the factors").wait_for()
        press(page, "▶|")
        page.locator("ol:visible > li").last.locator("[aria-current=step]").wait_for()
        for name in ("Say", "Demonstrate", "Correct", "Object"):
            tab(page, name)
            eventually(page, NAMELESS, [])


PDDL = "() => [...document.querySelectorAll('ol code')].filter((e) => e.offsetParent).map((e) => e.textContent)"
"""The PDDL that is seen in lists."""
NAMELESS = """() => [...document.querySelectorAll(
    'input, textarea, select, button, [role=button], [role=slider], [role=tab]')]
  .filter((each) => each.offsetParent && each.type !== 'hidden' && !each.closest('[aria-hidden=true]'))
  .filter((each) => {
    const ids = (each.getAttribute('aria-labelledby') || '').split(' ');
    const of = ids.map((id) => document.getElementById(id)?.textContent);
    const labels = [...(each.labels || [])].map((label) => label.textContent);
    const own = each.matches('input, textarea, select') ? '' : each.textContent;
    return ![each.getAttribute('aria-label'), each.title, own, ...of, ...labels].some((name) => (name || '').trim());
  })
  .map((each) => each.outerHTML.slice(0, 200))"""
"""Everything that can be worked with and has no name for a screen reader."""


def test_an_object_is_pointed_at(kitchen_studio: Served, browser: Browser, screens: Path) -> None:
    with visiting(browser, kitchen_studio) as page:
        tab(page, "Object")
        choose(page, "Object", "stove1")
        page.get_by_role("heading", name="stove1: stove").wait_for()
        page.get_by_text("What controls what").first.wait_for()
        page.screenshot(path=screens / "09-object.png")


def reach(page: Page, tag: str, words: str, key: str = "Tab") -> None:
    """Press a key until what has the focus begins with some words."""
    told = "(e => [e.tagName, e.innerText || e.value || ''])(document.activeElement)"
    for _ in range(120):
        page.keyboard.press(key)
        name, said = page.evaluate(told)
        if name == tag and said.startswith(words):
            return
    raise AssertionError(f"{words} is not reached")


def stroke(page: Page, key: str, seen: Locator) -> None:
    """Press a hot key and see what it does; one that comes while the page is drawn is missed, and pressed again."""
    page.keyboard.press(key)
    with suppress(Exception):
        seen.wait_for(timeout=20_000)
        return
    page.keyboard.press(key)
    seen.wait_for()


CHOSEN = "document.querySelector('[role=option][data-combobox-selected]')?.textContent ?? ''"
"""The option that Enter would take."""


def pick(page: Page, field: Locator, name: str) -> None:
    """Choose with arrows and Enter in a list that has come up, as a person does: look, press, look again.

    A list goes to its first option, or to the one that holds, some time after it has come up, and one that was just
    filtered may miss a key.
    """
    for _ in range(100):
        before = page.evaluate(CHOSEN)
        page.keyboard.press("Enter" if before == name else "ArrowDown")
        with suppress(Exception):  # nothing has changed: press again
            page.wait_for_function(f"before => ({CHOSEN}) !== before", arg=before, timeout=2_000)
        if before == name and field.input_value() == name:
            return
    raise AssertionError(f"{name} cannot be chosen: {field.input_value()} is")


def test_by_keys_alone(table_studio: Served, browser: Browser, screens: Path) -> None:
    with visiting(browser, table_studio) as page:
        keys = page.keyboard
        reach(page, "INPUT", "corner1")
        pick(page, entry(page, "Environment"), "corner2")
        reach(page, "TEXTAREA", "")
        keys.type("Put the cup on the first table.")
        reach(page, "BUTTON", "Plan it")
        keys.press("Enter")
        told(page, "Planned in")
        for key, number in (("n", 1), ("n", 2), ("b", 1)):
            stroke(page, key, page.locator(f"ol:visible > li:nth-child({number}) [aria-current=step]"))
        reach(page, "DIV", "Demonstrate", "Shift+Tab")
        keys.press("Enter")
        page.get_by_text("Task text").locator("visible=true").wait_for()
        reach(page, "TEXTAREA", "")
        keys.type("Take the cup.")
        reach(page, "BUTTON", "Begin")
        keys.press("Enter")
        told(page, "Point at an object")
        reach(page, "INPUT", "(no object)")
        pick(page, entry(page, "With"), "cup1")
        page.get_by_role("button", name="Go and stand before cup1", exact=True).wait_for()
        reach(
            page, "BUTTON", "Go and stand before cup1"
        )  # a hot key of a letter or digit means something else in an input
        keys.press("Enter")
        page.locator("ol:visible > li:nth-child(1) [aria-current=step]").wait_for()
        stroke(page, "u", page.get_by_text("No steps."))
        stroke(page, "r", page.locator("ol:visible > li:nth-child(1) [aria-current=step]"))
        keys.press("k")
        told(page, "Saved as shown-corner2-01")
        page.get_by_role("alert").filter(has_text="Saved as shown-corner2-01").first.wait_for()
        page.screenshot(path=screens / "13-by-keys.png")


HASTE = """async (words) => {
  const box = [...document.querySelectorAll("textarea")].find((each) => each.offsetParent);
  const value = Object.getOwnPropertyDescriptor(HTMLTextAreaElement.prototype, "value");
  for (const typed of ["Take the book.", words]) {
    value.set.call(box, typed);
    box.dispatchEvent(new Event("input", { bubbles: true }));
  }
  const step = document.body.appendChild(document.createElement("span"));
  step.dataset.step = "0";
  step.click(); // the page's own script has something to tell as well
  step.remove();
}"""
"""Types something, and something else at once."""


def test_what_was_typed_just_before_a_button_is_pressed_counts(table_studio: Served, browser: Browser) -> None:
    with visiting(browser, table_studio) as page:
        button = page.get_by_role("button", name="Plan it", exact=True)
        for text, end in (("Put the cup on the shelf.", "Put cup1 on shelf1"), ("Take the cup.", "Take cup1")) * 2:
            button.focus()  # the list of steps scrolls the button away: a key reaches it wherever it is
            page.evaluate(HASTE, text)
            page.keyboard.press("Enter")
            page.locator("ol:visible > li").last.get_by_text(end).wait_for()


SECRET = "sk-of-this-test-only"
ANSWERS = {"The cup": "(at cup1 shelf1 on)", "The book, but on the table": "(at book1 table1 on)"}


def test_a_question_of_the_language_model_is_answered(browser: Browser, tmp_path: Path, screens: Path) -> None:
    pytest.importorskip("openai", reason="needs the extra llm")

    def decide(body: dict[str, Any]) -> Answer:
        options = [{"answer": answer, "goal": goal} for answer, goal in ANSWERS.items()]
        question = {"text": "What shall be put there, the cup or the book?", "step": 0, "options": options}
        return Answer(reply(asked(body)[1], ANSWERS["The cup"], questions=[question]))

    served = serve(tmp_path, "02_table", "--environment", "corner1")
    with serve_model(decide) as model:
        served.environ |= {MODEL: "fake", URL: model.url, KEY: SECRET, "XDG_CACHE_HOME": str(tmp_path / "cache")}
        served.start()
        try:
            with visiting(browser, served, 900, 1000) as page:
                page.get_by_text("Reader settings").click()
                choose(page, "Reader", "language model")
                page.get_by_text("Check the plan with the model").wait_for()
                assert (entry(page, "Model").input_value(), entry(page, "Server address").input_value()) == (
                    "fake",
                    model.url,
                )
                eventually(page, NAMELESS, [])
                page.screenshot(path=screens / "15-reader.png")
                page.get_by_text("Reader settings").click()
                say(page, "Put it on the shelf.")
                told(page, "It is for one of several meanings")
                page.locator("ol:visible > li").last.get_by_text("Put cup1 on shelf1").wait_for()
                page.get_by_text("What shall be put there, the cup or the book?", exact=True).wait_for()
                page.screenshot(path=screens / "16-question.png")
                press(page, "The book, but on the table")
                page.locator("ol:visible > li").last.get_by_text("Put book1 on table1").wait_for()
                page.get_by_role("button", name="The cup", exact=True).wait_for(state="hidden")
                page.get_by_text("Energies, and why").click()
                page.get_by_role("heading", name="Read by the language model fake").wait_for()
                page.wait_for_timeout(500)  # the folder opens slowly, which only the picture shows
                page.screenshot(path=screens / "17-answered.png")
                assert SECRET not in page.content()
        finally:
            served.kill()
    assert len(model.bodies) == 1


ABOVE = """() => ['Plan it', 'Look around until bowl1 is in view', 'Put bowl1 on table1'].every((words) => {
  const found = [...document.querySelectorAll('button, li')].find((each) => each.textContent.includes(words));
  const box = found.getBoundingClientRect();
  return box.top > 0 && box.bottom < 700;
})"""
"""Whether request and plan are seen without scrolling."""
SPILLS = """() => [...document.querySelectorAll('.mantine-ScrollArea-viewport')].some((each) =>
  each.scrollWidth > each.clientWidth + 1)"""
FILLED = """() => [...document.querySelectorAll('button[data-block]')]
  .filter((each) => each.offsetParent && !each.disabled)
  .filter((each) => getComputedStyle(each).backgroundColor !== 'rgba(0, 0, 0, 0)')
  .map((each) => each.textContent)"""
"""The buttons that stand out."""


def test_request_and_plan_are_above_the_fold(kitchen_studio: Served, browser: Browser, screens: Path) -> None:
    """Also one button stands out, and what is impossible is disabled."""
    with visiting(browser, kitchen_studio, 1024, 700) as page:
        say(page, "Put the bowl on the table.")
        told(page, "Planned in")
        page.locator("ol:visible > li").nth(4).wait_for()
        eventually(page, ABOVE, True)
        eventually(page, FILLED, ["Plan it"])
        assert not page.evaluate(SPILLS)
        assert page.get_by_role("button", name="Stop", exact=True).is_disabled()
        page.screenshot(path=screens / "18-fold-light.png")
        page.emulate_media(color_scheme="dark")
        eventually(page, "() => document.documentElement.dataset.theme", "dark")
        page.screenshot(path=screens / "19-fold-dark.png")
        page.get_by_text("Objects and steps").click()
        page.locator("td [data-step='3']").first.click()
        page.locator("ol:visible > li:nth-child(3) [aria-current=step]").wait_for()


SEEN = """() => ['[aria-current=step]', 'button'].map((kind) => {
  const all = [...document.querySelectorAll(kind)].filter((each) => each.offsetParent);
  const box = all.find((each) => kind !== 'button' || each.textContent === '▶|').getBoundingClientRect();
  return box.top > 0 && box.bottom < 700;
})"""
"""Returns true for the step that is looked at, and for the player, if they are seen without scrolling."""


def test_the_player_stays_in_view_along_a_long_plan(kitchen_studio: Served, browser: Browser) -> None:
    with visiting(browser, kitchen_studio, 1024, 700) as page:
        say(page, MANY)
        told(page, "Planned in")
        assert len(shown(page)) > 15
        for number in range(1, 15):
            press(page, "▶")
            page.locator(f"ol:visible > li:nth-child({number}) [aria-current=step]").wait_for()
        eventually(page, SEEN, [True, True])
        press(page, "▶|")
        page.locator("ol:visible > li").last.locator("[aria-current=step]").wait_for()
        eventually(page, SEEN, [True, True])


def test_a_state_without_places_is_a_graph(browser: Browser, tmp_path: Path, screens: Path) -> None:
    served = serve(tmp_path, "01_blocks")
    served.start()
    try:
        with visiting(browser, served, 1024, 700) as page:
            say(page, "Put the red block on the green block.")
            told(page, "Planned in")
            press(page, "▶|")
            page.locator("#tmd-graph .came").get_by_text("+ on").wait_for()
            page.locator("#tmd-graph [data-object=red_block]").click()
            page.locator("#tmd-graph .marked").wait_for()
            page.screenshot(path=screens / "20-graph.png")
            tab(page, "Object")
            page.get_by_role("heading", name="red_block: block").wait_for()
    finally:
        served.kill()


def test_what_visitors_type_is_text(kitchen_studio: Served, browser: Browser, screens: Path) -> None:
    from playwright.sync_api import expect

    with visiting(browser, kitchen_studio, 400, 820) as page:
        page.screenshot(path=screens / "11-narrow.png")
        for text, answer in (
            ("", "the text is empty"),
            ("word " * 1_001, "words"),
            ("x" * 30_000, "characters"),
            ("<img src=x onerror='document.title=1'> \x07 Fill the pot.", ""),
        ):
            say(page, text)
            if answer:
                told(page, answer)
        page.locator("[role=status]").filter(has_text="plan").first.wait_for()
        assert page.title() != "1" and page.locator("img[src=x]").count() == 0
        begin(page, "Fill the pot.")
        # nothing was demonstrated yet
        expect(page.get_by_role("button", name="Save (K)", exact=True)).to_be_disabled()
        page.screenshot(path=screens / "12-narrow-fault.png")


def test_a_page_of_another_origin_cannot_open_the_studio(table_studio: Served, browser: Browser) -> None:
    """As `http://localhost:9009/?websocket=ws://127.0.0.1:8123` could: it has the cookie, which knows of no ports."""
    viser = pytest.importorskip("viser", reason="needs the extra studio")
    address = urlsplit(table_studio.url)
    server = ThreadingHTTPServer(("127.0.0.1", 0), SimpleHTTPRequestHandler)
    Thread(target=server.serve_forever, args=(0.01,), daemon=True).start()
    socket = f"ws://127.0.0.1:{address.port}/"
    opened = """([url, protocol]) => new Promise((done) => {
      const socket = new WebSocket(url, protocol);
      socket.onopen = () => done(true);
      socket.onerror = () => done(false);
    })"""
    context = browser.new_context()
    page = context.new_page()
    page.goto(table_studio.url)
    assert "token" not in page.url
    assert page.evaluate(opened, [socket, f"viser-v{viser.__version__}"])
    page.goto(f"http://127.0.0.1:{server.server_port}/")
    assert not page.evaluate(opened, [socket, f"viser-v{viser.__version__}"])
    assert page.request.get(f"http://127.0.0.1:{address.port}/").status == 200  # the cookie is there
    context.close()
    server.shutdown()


# the last tests save, and then the studio learns the kitchen again, which would slow all other tests down


def test_a_plan_is_corrected(kitchen_studio: Served, browser: Browser, screens: Path) -> None:
    corpus = Path(kitchen_studio.arguments[1]) / "kitchen" / "shown" / "demonstrations.jsonl"
    with visiting(browser, kitchen_studio) as page:
        say(page, "Boil some water in the pot.")
        told(page, "Planned in")
        before = [step.get_attribute("title") for step in page.locator("ol:visible [data-step]").all()]
        press(page, "Correct this plan")
        press(page, "Delete")
        page.get_by_text("does not apply").wait_for()
        page.screenshot(path=screens / "10-broken.png")
        press(page, "Let the planner put in what is missing")
        page.get_by_text("Every step applies.").wait_for()
        choose(page, "Insert with", "cup1")
        choose(page, "Instruction", "Look around until cup1 is in view")
        press(page, "Insert behind this step")
        page.locator("ol:visible > li").filter(has_text="Look around until cup1 is in view").wait_for()
        press(page, "Save the correction")
        told(page, "Saved as shown-kitchen1-01")
        record = json.loads(corpus.read_text().splitlines()[-1])
        assert record["proposed"] == before
        assert "find(cup1)" in [i for s in record["segments"] for i in s["instructions"]]


def test_shown_by_clicks_saved_learned_and_used(kitchen_studio: Served, browser: Browser, screens: Path) -> None:
    corpus = Path(kitchen_studio.arguments[1]) / "kitchen" / "boiling" / "demonstrations.jsonl"
    with visiting(browser, kitchen_studio) as page:
        say(page, UNKNOWN)
        told(page, "No plan")
        page.screenshot(path=screens / "04-nobody-has-shown-it.png")
        begin(page, UNKNOWN)
        told(page, "Point at an object")
        pointed = ""
        for number, (name, _, words) in enumerate(BOIL, start=1):
            if name != pointed:
                choose(page, "With", name)
                pointed = name
            press(page, words)
            page.locator(f"ol:visible > li:nth-child({number}) [aria-current=step]").wait_for()
            if number == 6:
                page.screenshot(path=screens / "05-what-can-be-done.png")
        page.screenshot(path=screens / "06-boiled.png")
        press(page, "Undo")
        page.locator(f"ol:visible > li:nth-child({len(BOIL) - 1}) [aria-current=step]").wait_for()
        press(page, "Redo")
        page.locator(f"ol:visible > li:nth-child({len(BOIL)}) [aria-current=step]").wait_for()
        entry(page, "Task name").fill("boiling")
        press(page, "Save (K)")
        told(page, "Saved as boiling-kitchen1-01")
        page.screenshot(path=screens / "07-saved.png")
        (line,) = corpus.read_text().splitlines()
        assert [i for s in json.loads(line)["segments"] for i in s["instructions"]] == [i for _, i, _ in BOIL]
        assert not {"who", "when"} & set(json.loads(line))
        told(page, "The same sentence now gives what you showed, and does more: Turn the knob stove1_knob1 to off.")
        page.get_by_text("Learning from what was saved").wait_for()
        tab(page, "Say")
        assert any("Turn the knob stove1_knob" in step for step in shown(page))
        page.screenshot(path=screens / "08-learned.png")
