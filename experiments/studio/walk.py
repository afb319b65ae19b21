"""A walk through the studio in a real browser: pictures at three widths, light and dark, and what a person waits for.

    python -m experiments.studio.walk [DIRECTORY]

saves the pictures below DIRECTORY (runs/studio by default), to be looked at, and prints how many clicks and seconds it
takes from an empty text box to a corrected, saved and reused plan. The kitchen is learned first, where that is not in
the cache.
"""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from playwright.sync_api import Browser, Page, sync_playwright

SIZES = ((420, 900), (900, 700), (1920, 1080))
FLAGS = (
    "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist",
    "--disable-quic", "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--no-first-run",
)  # fmt: skip
TEXT = "Boil some water in the pot."
WAIT = 60_000


class Opened:
    """A studio in a process of its own, with problems that may be written to."""

    def __init__(self, directory: Path) -> None:
        self._directory = directory
        self._port = "0"
        shutil.copytree("problems/kitchen", directory / "problems" / "kitchen")
        self.url = self.start()

    def start(self) -> str:
        """Start it, again at the same port, and return its address."""
        environ = {**os.environ, "TMD_STUDIO_STATE": str(self._directory / "drafts")}
        options = ["--problems", str(self._directory / "problems"), "studio", "--environment", "kitchen1"]
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tmd", *options, "--port", self._port],
            env=environ,
            text=True,
            stdout=subprocess.PIPE,
        )
        assert self._process.stdout is not None
        for line in self._process.stdout:
            if found := re.search(r"http://[^:]+:(\d+)\S*", line):
                self._port = found[1]
                return found[0]
        raise RuntimeError("the studio did not open")

    def kill(self) -> None:
        """End it as a crash does."""
        self._process.send_signal(signal.SIGKILL)
        self._process.wait()


def opened_page(browser: Browser, url: str, size: tuple[int, int], scheme: str) -> Page:
    """A page in a browser of its own, loaded."""
    context = browser.new_context(viewport={"width": size[0], "height": size[1]}, color_scheme=scheme)  # type: ignore[arg-type]
    page = context.new_page()
    page.set_default_timeout(WAIT)
    page.goto(url)
    told(page, "Welcome")
    page.wait_for_timeout(2_000)
    return page


def told(page: Page, words: str) -> None:
    """Wait for a message."""
    page.locator("[role=status]").filter(has_text=words).first.wait_for()


def press(page: Page, name: str) -> None:
    """Press a button."""
    page.get_by_role("button", name=name, exact=True).locator("visible=true").first.click()


def say(page: Page, text: str) -> None:
    """Type a sentence, and plan it with Enter."""
    page.locator("textarea:visible").first.fill(text)
    page.keyboard.press("Enter")
    told(page, "Planned in")


def pictures(browser: Browser, url: str, directory: Path) -> None:
    """What the page looks like."""
    for size in SIZES:
        for scheme in ("light", "dark"):
            page = opened_page(browser, url, size, scheme)
            stem = f"{size[0]}-{scheme}"
            page.screenshot(path=directory / f"{stem}-1-first.png")
            say(page, TEXT)
            page.locator("[data-step='6']").first.click()
            page.locator("#tmd-over").filter(has_text="6 / ").wait_for()  # drawn by software, that may take seconds
            page.locator("[data-step='6'] [aria-current=step]").first.wait_for()
            page.wait_for_timeout(2_000)
            page.screenshot(path=directory / f"{stem}-2-plan.png")
            press(page, "Correct this plan")
            told(page, "The plan is under Correct")
            page.wait_for_timeout(2_000)
            page.screenshot(path=directory / f"{stem}-3-correct.png")
            page.get_by_role("tab", name="Object").click()
            page.wait_for_timeout(1_000)
            page.screenshot(path=directory / f"{stem}-4-object.png")
            page.context.close()


def corrected(browser: Browser, url: str) -> tuple[int, float]:
    """From an empty text box to a corrected, saved and reused plan: clicks and keys, and seconds."""
    page = opened_page(browser, url, (1400, 900), "light")
    begun = time.monotonic()
    clicks = 2  # into the text box, and Enter
    say(page, TEXT)
    press(page, "Correct this plan")
    told(page, "The plan is under Correct")
    page.locator("[data-list=correct] [data-step]").last.click()
    page.locator("[data-list=correct] li:last-child [aria-current=step]").wait_for()
    press(page, "Delete")
    page.get_by_text("Every step applies.").wait_for()
    press(page, "Save the correction")
    told(page, "The same sentence")
    clicks += 4
    took = time.monotonic() - begun
    print(page.locator("[role=status]").first.inner_text().splitlines()[0])
    page.context.close()
    return clicks, took


def main() -> None:
    """Walk."""
    directory = Path(sys.argv[1] if len(sys.argv) > 1 else "runs/studio")
    directory.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as place, sync_playwright() as playwright:
        opened = Opened(Path(place))
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        try:
            pictures(browser, opened.url, directory)
            clicks, took = corrected(browser, opened.url)
            print(f"corrected, saved and reused: {clicks} clicks and keys, {took:.1f} s")
        finally:
            opened.kill()
            browser.close()


if __name__ == "__main__":
    main()
