"""How long a person waits before the page: ``python -m experiments.studio.browser_speed``; needs chromium, playwright.

For each bundled kitchen the text of its first bundled problem is planned; told is the time from the button to the first
plan on the page. Then a plan is played at ten steps a second; told are the times between two steps on the page, as the
page's own clock sees them change. The browser draws by software, on the processor that the studio uses as well.
"""

from __future__ import annotations

import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path

from playwright.sync_api import Browser, Page, sync_playwright

ROOT = Path(__file__).parents[2]
FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"]
KITCHENS = [f"kitchen{number}" for number in range(1, 6)]
REPEATS = 5
SIZE = {"width": 1400, "height": 900}
WATCH = """
window.seen = [];
let last = '';
const look = () => {
  const step = document.querySelector('[aria-current=step]');
  const list = step ? [...step.closest('ol').children].indexOf(step.closest('li')) + 1 : 0;
  if (list !== last) { last = list; window.seen.push([list, performance.now()]); }
};
new MutationObserver(look).observe(document.body, {subtree: true, childList: true, characterData: true});
"""
PLANNED = """
() => new Promise(done => {
  const button = [...document.querySelectorAll('button')].find(b => b.innerText === 'Plan it');
  const begun = performance.now();
  const old = document.querySelector('[role=status]').innerText;
  let news = false;
  const look = () => {
    const said = document.querySelector('[role=status]').innerText;
    news = news || said !== old;
    if (news && /Planned in/.test(said) && document.querySelectorAll('.tmd ol > li').length) {
      watcher.disconnect(); done(performance.now() - begun);
    }
  };
  const watcher = new MutationObserver(look);
  watcher.observe(document.body, {subtree: true, childList: true, characterData: true});
  button.click();
})
"""


def text_of(kitchen: str) -> str:
    """The text of the first bundled problem in a kitchen."""
    return next(iter(sorted((ROOT / "problems" / "kitchen").glob(f"p*-{kitchen}.nl")))).read_text().strip()


def first_plans(page: Page, text: str) -> list[float]:
    """Milliseconds from the button to the plan, each time with something else planned between."""
    times = []
    for _ in range(REPEATS):
        page.locator("textarea:visible").first.fill(text)
        page.wait_for_timeout(400)
        times.append(float(page.evaluate(PLANNED)))
        page.locator("textarea:visible").first.fill("Take the cup.")
        page.wait_for_timeout(400)
        page.evaluate(PLANNED)
    return times


def played(page: Page, text: str) -> list[float]:
    """Milliseconds between two steps on the page while ten a second are played."""
    page.locator("textarea:visible").first.fill(text)
    page.wait_for_timeout(400)
    page.evaluate(PLANNED)
    speed = page.locator("xpath=//*[normalize-space(text())='Steps a second']/following::input[@inputmode]").first
    speed.fill("10")
    speed.press("Tab")
    page.wait_for_timeout(500)
    page.evaluate(WATCH)
    page.get_by_role("button", name="▶ play", exact=True).first.click()
    page.locator("ol:visible > li").last.locator("[aria-current=step]").wait_for()
    seen: list[list[float]] = page.evaluate("window.seen")
    steps = len(page.locator("ol:visible > li").all())
    print(f"  {steps} steps, {len({number for number, _ in seen} - {0})} of them were seen")
    return [later - earlier for (_, earlier), (_, later) in pairwise(seen)]


def environment(browser: Browser, url: str, name: str, *, play: bool) -> None:
    """Print what one kitchen takes."""
    page = browser.new_page(viewport=SIZE)
    page.goto(url)
    page.get_by_text("Welcome").wait_for()
    page.locator("xpath=//*[normalize-space(text())='Environment']/following::input[1]").click()
    page.get_by_role("option", name=name, exact=True).locator("visible=true").click()
    page.wait_for_timeout(5_000)
    times = first_plans(page, text_of(name))
    print(f"{name}: first plan {times[0]:.0f} ms, then {min(times[1:]):.0f} to {max(times[1:]):.0f} ms", flush=True)
    if play:
        gaps = played(page, text_of(name))
        print(
            f"  from step to step: median {statistics.median(gaps):.0f} ms, longest {max(gaps):.0f} ms, "
            f"whole {sum(gaps) / 1e3:.1f} s"
        )
    page.close()


@contextmanager
def opened() -> Iterator[str]:
    """The address of a studio in a process of its own, with the arguments of this one; it ends afterwards."""
    with tempfile.TemporaryDirectory() as directory:
        environ = {**os.environ, "TMD_STUDIO_STATE": f"{directory}/drafts"}
        command = [sys.executable, "-m", "tmd", "studio", "--environment", "kitchen1", "--port", "0", *sys.argv[1:]]
        served = subprocess.Popen(command, text=True, stdout=subprocess.PIPE, env=environ)
        assert served.stdout is not None
        try:
            yield next(found.group() for line in served.stdout if (found := re.search(r"http://\S+", line)))
        finally:
            served.terminate()
            served.wait()


def main() -> None:
    """Start a studio and a browser, measure, end both."""
    chromium = shutil.which("chromium") or shutil.which("google-chrome")
    with opened() as url, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=FLAGS)
        for name in KITCHENS:
            environment(browser, url, name, play=name == "kitchen1")
        browser.close()


if __name__ == "__main__":
    main()
