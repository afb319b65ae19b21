"""A server that is killed while somebody demonstrates."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

from .conftest import Served
from .test_browser import begin, choose, entry, press, told, visiting

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

STEPS = (("cup1", "Go and stand before cup1"), ("cup1", "Take cup1"), ("shelf1", "Go and stand before shelf1"))
LAST = ("shelf1", "Put cup1 on shelf1")


def do(page: Page, name: str, instruction: str, number: int) -> None:
    if entry(page, "With").input_value() != name:
        choose(page, "With", name)
    press(page, instruction)
    page.locator(f"ol:visible > li:nth-child({number}) [aria-current=step]").wait_for()


def corpus(served: Served, task: str) -> list[dict[str, object]]:
    path = Path(served.arguments[1]) / "02_table" / task / "demonstrations.jsonl"
    return [json.loads(line) for line in path.read_text().splitlines()]


def test_killed_in_the_middle(table_studio: Served, browser: Browser) -> None:
    with visiting(browser, table_studio, 360, 420) as page:
        begin(page, "Put the cup on the shelf.")
        do(page, *STEPS[0], 1)
        press(page, "Save (K)")
        told(page, "Saved as shown-corner1-01")
        begin(page, "Take the cup to the shelf.")
        for number, step in enumerate(STEPS, start=1):
            do(page, *step, number)
        table_studio.kill()
        assert len(corpus(table_studio, "shown")) == 1
        port = str(urlsplit(table_studio.url).port)
        table_studio.arguments[table_studio.arguments.index("--port") + 1] = port
        page.get_by_role("alert").filter(has_text="The studio has ended").wait_for()
        table_studio.start()
        told(page, "Here is what was not saved: 3 steps")  # the page has come back by itself
        assert page.get_by_role("tab", name="Demonstrate").get_attribute("aria-selected") == "true"
        do(page, *LAST, 4)
        press(page, "Save (K)")
        told(page, "Saved as shown-corner1-02")
    assert len(corpus(table_studio, "shown")) == 2
