"""Many visitors at once, a server that is killed, and a corpus that cannot be written to."""

from __future__ import annotations

import json
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from .conftest import Served
from .test_browser import choose, entry, press, tab, told, visiting

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

VISITORS = 10
STEPS = (("cup1", "moveto(cup1)"), ("cup1", "grasp(cup1)"), ("shelf1", "moveto(shelf1)"))
LAST = ("shelf1", "keep(cup1, shelf1, on)")


def begin(page: Page, text: str) -> None:
    tab(page, "Demonstrate")
    page.locator("textarea:visible").first.fill(text)
    page.wait_for_timeout(300)
    press(page, "Begin")
    told(page, "Point at an object")


def do(page: Page, name: str, instruction: str, number: int) -> None:
    if entry(page, "With").input_value() != name:
        choose(page, "With", name)
    press(page, instruction)
    page.locator(f"ol:visible > li:nth-child({number}) [aria-current=step]").wait_for()


def corpus(served: Served, task: str) -> list[dict[str, object]]:
    path = Path(served.arguments[1]) / "02_table" / task / "demonstrations.jsonl"
    return [json.loads(line) for line in path.read_text().splitlines()]


def test_ten_visitors_at_once(table_studio: Served, browser: Browser) -> None:
    wanted = {f"Put the cup on the shelf, please, number {n}." for n in range(VISITORS)}
    with ExitStack() as stack:
        pages = [stack.enter_context(visiting(browser, table_studio, 500, 700)) for _ in range(VISITORS)]
        for page, text in zip(pages, sorted(wanted), strict=True):
            begin(page, text)
        for number, (name, instruction) in enumerate((*STEPS, LAST), start=1):
            for index, page in enumerate(pages):
                if number <= 3 or index % 2 == 0:  # every other visitor stops before the last step
                    do(page, name, instruction, number)
        for page in pages:
            press(page, "Save (S)")
        for page in pages:
            told(page, "Saved as shown-corner1-")
    records = corpus(table_studio, "shown")
    assert {record["text"] for record in records} == wanted and len(records) == VISITORS
    assert len({record["id"] for record in records}) == VISITORS
    for record in records:
        segments = record["segments"]
        assert isinstance(segments, list)
        done = [i for segment in segments for i in segment["instructions"]]
        odd = sorted(wanted).index(str(record["text"])) % 2
        assert done == [i for _, i in STEPS] + ([] if odd else [LAST[1]])


def test_killed_in_the_middle(table_studio: Served, browser: Browser) -> None:
    with visiting(browser, table_studio, 500, 700) as page:
        begin(page, "Put the cup on the shelf.")
        do(page, *STEPS[0], 1)
        press(page, "Save (S)")
        told(page, "Saved as shown-corner1-01")
        page.locator("textarea:visible").first.fill("Take the cup to the shelf.")
        page.wait_for_timeout(300)
        press(page, "Begin")
        for number, step in enumerate(STEPS, start=1):
            do(page, *step, number)
        table_studio.kill()
        assert len(corpus(table_studio, "shown")) == 1
        port = table_studio.url.rpartition(":")[2]
        table_studio.arguments[table_studio.arguments.index("--port") + 1] = port
        table_studio.start()
        page.reload()
        page.get_by_text("Welcome").wait_for()
        tab(page, "Demonstrate")
        press(page, "Go on with what was not saved")
        told(page, "3 steps")
        do(page, *LAST, 4)
        press(page, "Save (S)")
        told(page, "Saved as shown-corner1-02")
    assert len(corpus(table_studio, "shown")) == 2


def test_a_corpus_that_cannot_be_written_to(table_studio: Served, browser: Browser) -> None:
    (Path(table_studio.arguments[1]) / "02_table" / "blocked").write_text("a file where a directory should be")
    with visiting(browser, table_studio, 500, 700) as page:
        begin(page, "Take the cup.")
        do(page, *STEPS[0], 1)
        for task, answer in (("blocked", "cannot be"), ("../../etc", "cannot be called")):
            entry(page, "Task name").fill(task)
            page.wait_for_timeout(300)
            press(page, "Save (S)")
            told(page, answer)
        entry(page, "Task name").fill("taken")
        page.wait_for_timeout(300)
        press(page, "Save (S)")
        told(page, "Saved as taken-corner1-01")
    assert len(corpus(table_studio, "taken")) == 1
