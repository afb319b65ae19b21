"""How long an open page takes to be back after the studio was killed and started again.

    python -m experiments.studio.restart [TIMES]

plans a sentence, goes to a step of the plan, kills the studio, starts it again at the same port, and prints seconds
from when the new one has said that it is open: until the page says no more that the studio has ended, until the
sentence, the plan and the step are there, and until it is planned again. The browser draws by software, on the
processor that the studio uses as well. The kitchen is learned first, where that is not in the cache.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
import time
from pathlib import Path

from playwright.sync_api import Browser, Page, sync_playwright

from experiments.studio.walk import FLAGS, TEXT, Opened, opened_page, say

STEP = 6
BACK = """([text, step]) => {
  const list = [...document.querySelectorAll('[data-list=say]')].find((each) => !each.dataset.old && each.offsetParent);
  const now = list && list.querySelector('[aria-current=step]');
  const said = [...document.querySelectorAll('textarea')].some((each) => each.value === text);
  return Boolean(said && now && now.closest('li').value === step);
}"""


def waits(page: Page, opened: Opened) -> tuple[float, float]:
    """Kill the studio, start it again, and measure."""
    page.evaluate("document.querySelectorAll('[data-list=say]').forEach((each) => { each.dataset.old = 'yes'; })")
    opened.kill()
    ended = page.get_by_role("alert").filter(has_text="has ended")
    ended.wait_for()
    opened.start()
    begun = time.monotonic()
    ended.wait_for(state="detached")
    found = time.monotonic() - begun
    page.wait_for_function(BACK, arg=[TEXT, STEP], polling=50)
    return found, time.monotonic() - begun


def measured(browser: Browser, opened: Opened, times: int) -> None:
    """Print each time."""
    page = opened_page(browser, opened.url, (900, 700), "light")
    say(page, TEXT)
    page.locator(f"[data-step='{STEP}']").first.click()
    page.locator(f"[data-list=say] li[value='{STEP}'] [aria-current=step]").wait_for()
    page.wait_for_timeout(1_000)
    for _ in range(times):
        found, planned = waits(page, opened)
        print(f"found after {found:.1f} s, planned again, with plan and step, after {planned:.1f} s")
    page.context.close()


def main() -> None:
    """Start a studio and a browser, measure, end both."""
    times = int(sys.argv[1]) if len(sys.argv) > 1 else 3
    with tempfile.TemporaryDirectory() as place, sync_playwright() as playwright:
        opened = Opened(Path(place))
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        try:
            measured(browser, opened, times)
        finally:
            opened.kill()
            browser.close()


if __name__ == "__main__":
    main()
