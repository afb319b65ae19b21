"""Whether a plan that is played at ten steps a second is sent at that pace: ``python -m experiments.studio.pace``.

A visitor without a browser listens on the websocket, so what is measured is the studio and the way to the page, not
how quickly a page is drawn. Told are, for each bundled kitchen, how many steps arrived and the times between them.
"""

from __future__ import annotations

import statistics
import time
from itertools import pairwise

from experiments.studio.browser_speed import KITCHENS, opened, text_of
from experiments.studio.wire import Wire

PER_SECOND = 10
PLAY = "▶ play"
SETTLED = 3.0
"""Seconds in which a kitchen that was entered has been sent."""


def shown(visitor: Wire) -> int:
    """The number of the step that the page lights up, from 1; 0 where it lights up none."""
    for element in visitor.elements.values():
        content = str(element.get("content"))
        at = content.find("aria-current")
        if at >= 0:
            return content.count("<li", 0, at)
    return 0


def played(url: str, kitchen: str) -> tuple[int, list[tuple[int, float]]]:
    """The number of steps of a plan, and when which of them arrived."""
    with Wire(url) as visitor:
        visitor.put("Environment", kitchen)
        time.sleep(SETTLED)
        visitor.put("Text", text_of(kitchen))
        visitor.press("Plan it")
        visitor.told("Planned in")
        visitor.put("Steps a second", PER_SECOND)
        steps = int(str(visitor.elements[visitor.find("Plan")]["value"]).split()[-2])
        seen = [(shown(visitor), time.perf_counter())]
        buttons = next(uuid for uuid, each in visitor.elements.items() if PLAY in (each.get("options") or ()))
        visitor.send({"type": "GuiUpdateMessage", "uuid": buttons, "updates": {"value": PLAY}})
        while seen[-1][0] < steps:
            visitor.until(lambda: shown(visitor) != seen[-1][0])
            seen.append((shown(visitor), time.perf_counter()))
    return steps, seen[1:]


def main() -> None:
    """Start a studio, play a plan in each kitchen, print."""
    with opened() as url:
        for kitchen in KITCHENS:
            steps, seen = played(url, kitchen)
            gaps = [1e3 * (later - earlier) for (_, earlier), (_, later) in pairwise(seen)]
            print(
                f"{kitchen}: {len({number for number, _ in seen})} of {steps} steps arrived, "
                f"median {statistics.median(gaps):.0f} ms apart, {min(gaps):.0f} to {max(gaps):.0f}",
                flush=True,
            )


if __name__ == "__main__":
    main()
