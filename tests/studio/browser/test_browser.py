"""What visitors do, in a real browser: say, step, point, show, save, learn, correct."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

import pytest

from .conftest import Served

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator, Page

WAIT = 60_000
RAMEN = "Fill the pot with water and boil it. Add the ramen to the pot and wait. Put the ramen in the bowl."
UNKNOWN = "Sterilize the kettle."
BOIL = (
    ("kettle1", "find(kettle1)"), ("kettle1", "moveto(kettle1)"), ("kettle1", "grasp(kettle1)"),
    ("sink1", "moveto(sink1)"), ("sink1", "keep(kettle1, sink1, in)"), ("sink1", "turn(sink1_handle, high)"),
    ("sink1", "turn(sink1_handle, off)"), ("kettle1", "grasp(kettle1)"), ("stove1", "moveto(stove1)"),
    ("stove1", "keep(kettle1, stove1_burner1, on)"), ("stove1", "turn(stove1_knob1, high)"), ("stove1", "wait()"),
)  # fmt: skip
"""Boiling water in a kettle: the object that is pointed at, and what is done."""


@contextmanager
def visiting(browser: Browser, served: Served, width: int = 640, height: int = 640) -> Iterator[Page]:
    context = browser.new_context(viewport={"width": width, "height": height})
    page = context.new_page()
    page.set_default_timeout(WAIT)
    page.goto(served.url)
    page.get_by_text("Welcome").wait_for()
    yield page
    context.close()


def tab(page: Page, name: str) -> None:
    page.get_by_role("tab", name=name).click()


def entry(page: Page, label: str) -> Locator:
    """The input beside a label."""
    found = page.locator(f"xpath=//*[normalize-space(text())='{label}']/following::*[self::input or self::textarea][1]")
    return found.locator("visible=true").first


def choose(page: Page, label: str, option: str) -> None:
    entry(page, label).click()
    page.get_by_role("option", name=option, exact=True).locator("visible=true").click()


def press(page: Page, name: str) -> None:
    page.get_by_role("button", name=name, exact=True).locator("visible=true").first.click()


def told(page: Page, words: str) -> None:
    page.locator("[role=status]").filter(has_text=words).first.wait_for()


def say(page: Page, text: str) -> None:
    page.locator("textarea:visible").first.fill(text)
    page.wait_for_timeout(1000)  # the page sends what was typed a moment later, on a busy machine later still
    press(page, "Plan it")


def shown(page: Page) -> list[str]:
    """The steps that are listed."""
    lists = page.locator("ol:visible")
    return [] if not lists.count() else lists.first.locator("> li").all_inner_texts()


def test_a_sentence_becomes_a_plan_and_is_stepped_through(
    kitchen_studio: Served, browser: Browser, screens: Path
) -> None:
    with visiting(browser, kitchen_studio) as page:
        page.screenshot(path=screens / "01-welcome.png")
        say(page, RAMEN)
        told(page, "Planned in")
        steps = shown(page)
        assert len(steps) > 8 and any(step.startswith(("find(pot1)", "find(kettle1)")) for step in steps)
        assert page.locator(".tmd-verb").count() >= 3
        for _ in range(5):
            press(page, "▶")
        page.locator("[aria-current=step]").filter(has_text=steps[4].split("\n")[0].split(")")[0]).wait_for()
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
            page.wait_for_timeout(200)
            assert page.evaluate(NAMELESS) == []


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


def test_shown_by_clicks_saved_learned_and_used(kitchen_studio: Served, browser: Browser, screens: Path) -> None:
    corpus = Path(kitchen_studio.arguments[1]) / "kitchen" / "boiling" / "demonstrations.jsonl"
    with visiting(browser, kitchen_studio) as page:
        say(page, UNKNOWN)
        told(page, "No plan")
        page.screenshot(path=screens / "04-nobody-has-shown-it.png")
        tab(page, "Demonstrate")
        page.locator("textarea:visible").first.fill(UNKNOWN)
        page.wait_for_timeout(300)
        press(page, "Begin")
        told(page, "Point at an object")
        pointed = ""
        for number, (name, instruction) in enumerate(BOIL, start=1):
            if name != pointed:
                choose(page, "With", name)
                pointed = name
            press(page, instruction)
            page.locator(f"ol:visible > li:nth-child({number}) [aria-current=step]").wait_for()
            if number == 6:
                page.get_by_text("Not possible now, and why").click()
                page.get_by_text("✗").first.wait_for()
                page.screenshot(path=screens / "05-what-can-be-done-and-what-not.png")
                page.get_by_text("Not possible now, and why").click()
        page.screenshot(path=screens / "06-boiled.png")
        press(page, "Undo")
        page.locator(f"ol:visible > li:nth-child({len(BOIL) - 1}) [aria-current=step]").wait_for()
        press(page, "Redo")
        page.locator(f"ol:visible > li:nth-child({len(BOIL)}) [aria-current=step]").wait_for()
        entry(page, "Task name").fill("boiling")
        page.wait_for_timeout(300)
        press(page, "Save (K)")
        told(page, "Saved as boiling-kitchen1-01")
        page.screenshot(path=screens / "07-saved.png")
        (line,) = corpus.read_text().splitlines()
        assert [i for s in json.loads(line)["segments"] for i in s["instructions"]] == [i for _, i in BOIL]
        assert not {"who", "when"} & set(json.loads(line))
        told(page, "The same sentence now gives what you showed, and does more: turn(stove1_knob1, off).")
        page.get_by_text("Learning from what was saved").wait_for()
        tab(page, "Say")
        assert any("turn(stove1_knob" in step for step in shown(page))
        page.screenshot(path=screens / "08-learned.png")


def test_an_object_is_pointed_at(kitchen_studio: Served, browser: Browser, screens: Path) -> None:
    with visiting(browser, kitchen_studio) as page:
        tab(page, "Object")
        choose(page, "Object", "stove1")
        page.locator("svg", has_text="stove1").first.wait_for()
        page.get_by_text("What controls what").first.wait_for()
        page.screenshot(path=screens / "09-object.png")
        choose(page, "Object", "fridge1")  # one that is opened in the page can be closed again
        page.get_by_role("heading", name="fridge1: fridge").wait_for()
        page.get_by_text("Change the world").click()
        choose(page, "Its state", "door: opened")
        press(page, "Make it so")
        told(page, "Changed: fridge1: door: opened.")
        tab(page, "Say")
        say(page, "Close the fridge.")
        told(page, "Planned in")
        page.get_by_text("✓ reaches its goals").wait_for()
        assert [step.split(")")[0] for step in shown(page)] == ["moveto(fridge1", "close(fridge1_door"]


def test_a_plan_is_corrected(kitchen_studio: Served, browser: Browser, screens: Path) -> None:
    corpus = Path(kitchen_studio.arguments[1]) / "kitchen" / "shown" / "demonstrations.jsonl"
    with visiting(browser, kitchen_studio) as page:
        say(page, "Boil some water in the pot.")
        told(page, "Planned in")
        before = [step.split("\n")[0] for step in shown(page)]
        press(page, "Correct this plan")
        press(page, "Delete")
        page.get_by_text("does not apply").wait_for()
        page.screenshot(path=screens / "10-broken.png")
        press(page, "Let the planner put in what is missing")
        page.get_by_text("Every step applies.").wait_for()
        choose(page, "Insert with", "cup1")
        choose(page, "Instruction", "find(cup1)")
        press(page, "Insert behind this step")
        page.locator("ol:visible > li").filter(has_text="find(cup1)").wait_for()
        press(page, "Done: look at it, and save it")
        press(page, "Save (K)")
        told(page, "Saved as shown-kitchen1-01")
        record = json.loads(corpus.read_text().splitlines()[-1])
        assert [step.split(")")[0] for step in record["proposed"]] == [step.split(")")[0] for step in before]
        assert "find(cup1)" in [i for s in record["segments"] for i in s["instructions"]]


def reach(page: Page, tag: str, words: str, key: str = "Tab") -> None:
    """Press a key until what has the focus begins with some words."""
    told = "(e => [e.tagName, e.innerText || e.value || ''])(document.activeElement)"
    for _ in range(120):
        page.keyboard.press(key)
        name, said = page.evaluate(told)
        if name == tag and said.startswith(words):
            return
    raise AssertionError(f"{words} is not reached")


def pick(page: Page, field: Locator, name: str) -> None:
    """Choose with arrows and Enter in a list that has come up, as a person does: look, press, look again.

    A list goes to its first option, or to the one that holds, some time after it has come up.
    """
    option = page.get_by_role("option", name=name, exact=True).locator("visible=true")
    for _ in range(100):
        if option.count() and option.get_attribute("data-combobox-selected") is not None:
            page.keyboard.press("Enter")
            for _ in range(10):
                page.wait_for_timeout(300)
                if not option.count() and field.input_value() == name:
                    return
        # a list that is closed comes up, one that is open goes on; one that was just filtered may have missed Enter
        page.keyboard.press("ArrowDown")
        page.wait_for_timeout(300)
    raise AssertionError(f"{name} cannot be chosen: {field.input_value()} is")


def test_by_keys_alone(table_studio: Served, browser: Browser, screens: Path) -> None:
    with visiting(browser, table_studio) as page:
        keys = page.keyboard
        reach(page, "INPUT", "corner1")
        pick(page, entry(page, "Environment"), "corner2")
        reach(page, "TEXTAREA", "")
        keys.type("Put the cup on the first table.")
        page.wait_for_timeout(300)
        reach(page, "BUTTON", "Plan it")
        keys.press("Enter")
        told(page, "Planned in")
        for key, number in (("n", 1), ("n", 2), ("b", 1)):
            keys.press(key)
            page.locator(f"ol:visible > li:nth-child({number}) [aria-current=step]").wait_for()
        reach(page, "DIV", "Demonstrate", "Shift+Tab")
        keys.press("Enter")
        page.get_by_text("Task text").locator("visible=true").wait_for()
        reach(page, "TEXTAREA", "")
        keys.type("Take the cup.")
        page.wait_for_timeout(300)
        reach(page, "BUTTON", "Begin")
        keys.press("Enter")
        told(page, "Point at an object")
        reach(page, "INPUT", "(no object)")
        keys.press("Control+a")
        keys.type("cup1")
        pick(page, entry(page, "With"), "cup1")
        page.get_by_role("button", name="moveto(cup1)", exact=True).wait_for()
        reach(page, "BUTTON", "moveto(cup1)")  # a hot key of a letter or digit means something else in an input
        keys.press("Enter")
        page.locator("ol:visible > li:nth-child(1) [aria-current=step]").wait_for()
        keys.press("u")
        page.get_by_text("No steps yet.").wait_for()
        keys.press("1")
        page.locator("ol:visible > li:nth-child(1) [aria-current=step]").wait_for()
        keys.press("k")
        told(page, "Saved as shown-corner2-01")
        page.get_by_role("alert").filter(has_text="Saved as shown-corner2-01").wait_for()
        page.screenshot(path=screens / "13-by-keys.png")


def test_what_visitors_type_is_text(kitchen_studio: Served, browser: Browser, screens: Path) -> None:
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
        tab(page, "Demonstrate")
        entry(page, "Task text").fill("Fill the pot.")
        page.wait_for_timeout(300)
        press(page, "Begin")
        press(page, "Save (K)")
        told(page, "nothing was demonstrated yet")
        page.screenshot(path=screens / "12-narrow-fault.png")


def test_a_page_of_another_origin_cannot_open_the_studio(table_studio: Served, browser: Browser) -> None:
    """As `http://localhost:9009/?websocket=ws://127.0.0.1:8123` could: it has the cookie, which knows of no ports."""
    viser = pytest.importorskip("viser", reason="needs the extra studio")
    address = urlsplit(table_studio.url)
    server = ThreadingHTTPServer(("127.0.0.1", 0), SimpleHTTPRequestHandler)
    Thread(target=server.serve_forever, daemon=True).start()
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
