"""A tab that is closed while its robot works, and two browsers at one studio."""

from __future__ import annotations

from contextlib import closing
from typing import TYPE_CHECKING

from .conftest import Served
from .test_browser import UNDRAWN, WAIT, choose, entry, press, say, shown, told, visiting

if TYPE_CHECKING:
    from playwright.sync_api import Browser, BrowserContext, Page

TAKE = "Take the bowl."
PUT = "Put the cup on the shelf."


def opened(context: BrowserContext, served: Served) -> Page:
    page = context.new_page()
    page.set_default_timeout(WAIT)
    page.add_init_script(UNDRAWN)
    page.goto(served.url)
    page.locator("[role=status]:not(:empty)").first.wait_for()
    return page


def test_a_tab_that_is_closed_stops_its_robot(kitchen_studio: Served, browser: Browser) -> None:
    with closing(browser.new_context(viewport={"width": 640, "height": 640})) as context:
        page = opened(context, kitchen_studio)
        say(page, TAKE)
        told(page, "Planned in")
        press(page, "Let the robot do it")
        told(page, "The robot, step")
        page.close()
        again = opened(context, kitchen_studio)
        say(again, TAKE)
        told(again, "The robot was stopped")
        choose(again, "Plan", "the robot's run")
        again.get_by_text("Second of run").wait_for()
        assert again.get_by_role("button", name="Stop", exact=True).is_disabled()
        press(again, "Let the robot do it")
        told(again, "The robot's run ended: done.")
    assert "Traceback" not in kitchen_studio.errors.read_text()


def test_two_browsers_have_their_own_plans_and_share_corrections(table_studio: Served, browser: Browser) -> None:
    with visiting(browser, table_studio) as one, visiting(browser, table_studio) as other:
        say(one, PUT)
        say(other, "Take the book.")
        for page in (one, other):
            told(page, "Planned in")
        own = shown(other)
        assert own and own != shown(one)
        press(one, "Correct this plan")
        choose(one, "Insert with", "book1")
        choose(one, "Instruction", "Go and stand before book1")
        press(one, "Insert behind this step")
        press(one, "Let the planner put in what is missing")
        one.get_by_text("Every step applies.").wait_for()
        press(one, "Save the correction")
        told(one, "This sentence now gives it here, as it was corrected.")
        assert shown(other) == own
        say(other, PUT)
        other.locator("ol:visible > li").filter(has_text="Put cup1 on shelf1").wait_for()
        assert "as it was corrected" in entry(other, "Plan").input_value()
        other.get_by_text("Energies, and why").click()
        other.get_by_text("is first because somebody corrected a plan so").wait_for()
    assert "Traceback" not in table_studio.errors.read_text()
