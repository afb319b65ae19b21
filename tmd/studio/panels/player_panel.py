"""The player above the tabs: a slider and a row of buttons for the steps of a panel, and the caption."""

from __future__ import annotations

import threading
import time
from html import escape
from math import ceil

from tmd.studio.view3d.performance import RATE, RobotRun
from tmd.studio.visitor import Panel, Visitor, chosen, put

BUTTONS = ("|◀", "◀", "▶ play", "▶", "▶|")


class PlayerPanel(Panel):
    """Panel that steps through, and plays, the plan of another panel."""

    def __init__(self, visitor: Visitor) -> None:
        super().__init__(visitor)
        self._last, self._shown = 0, 0.0
        gui = visitor.client.gui
        self._caption = gui.add_html("")
        self._slider = gui.add_slider("Step", 0, 1, 1, 0, visible=False)
        self._slider.on_update(visitor.guarded(self._slid))
        self._buttons = visitor.buttons("Steps", BUTTONS, self._pressed, visible=False)
        self._seconds = gui.add_slider("Second of run", 0.0, 1.0, 0.1, 0.0, visible=False)
        self._seconds.on_update(visitor.guarded(self._sought))
        with visitor.view:
            self._speed = gui.add_slider("Steps a second", 1, 10, 1, 2)
        visitor.command("Next step", "N", lambda: self._move(1))
        visitor.command("Step back", "B", lambda: self._move(-1))
        visitor.command("Play or pause", "P", self._toggle)

    def seen(self) -> None:
        """Show the place in the steps of the panel that is looked at; nothing where there are none."""
        visitor, step, instructions = self._visitor, self._visitor.cursor, self._visitor.instructions
        self._last = len(visitor.reel.states) - 1
        found = visitor.owner is not None and bool(instructions)
        run = visitor.reel if isinstance(visitor.reel, RobotRun) else None
        for handle, seen in ((self._slider, found), (self._buttons, found), (self._seconds, run is not None)):
            if handle.visible != seen:
                handle.visible = seen
        if run is not None:
            self.moved(run)
        if found and self._last:
            self._slider.max = self._last
            put(self._slider, step)
        done = (
            visitor.setting.wording.instruction(instructions[step - 1]) if 0 < step <= self._last else "the beginning"
        )
        now = run.now if run is not None and visitor.live else None
        if now is not None:
            said = ("repair: " if now.repair else "") + visitor.setting.wording.instruction(now.instruction)
            self._say(f"The robot, step {now.number} of {now.of}: {said}")
        else:
            self._say(f"{step} / {self._last} {done}" if found else "")

    def moved(self, run: RobotRun) -> None:
        """Show how long a run is, and the moment that is looked at."""
        last = ceil(max(len(run.moments) - 1, 1) * 10 / RATE) / 10  # of tenths of seconds, as the slider
        if not run.ended.is_set():
            last = 20 * (last // 20 + 1)  # a slider that grows at each moment cannot be held
        if self._seconds.max != last:
            self._seconds.max = last
        self._shown = round(self._visitor.moment / RATE, 1)
        put(self._seconds, self._shown)

    def _sought(self) -> None:
        """Look at a moment of the run that is looked at."""
        visitor, run = self._visitor, self._visitor.reel
        if self._seconds.value == self._shown or not isinstance(run, RobotRun) or not run.moments:
            return
        moment = min(max(round(self._seconds.value * RATE), 0), len(run.moments) - 1)
        self._goto(run.moments[moment].step)
        visitor.moment, visitor.live = moment, moment == len(run.moments) - 1
        visitor.draw()

    def _say(self, words: str) -> None:
        """Put a caption over the picture."""
        content = f'<p class="tmd-caption" hidden>{escape(words)}</p>'
        if self._caption.content != content:
            self._caption.content = content

    def _slid(self) -> None:
        if self._slider.value != self._visitor.cursor:
            self._goto(int(self._slider.value))

    def _goto(self, step: int) -> None:
        self._visitor.stop()
        self._go(step)

    def _move(self, by: int) -> None:
        self._goto(self._visitor.cursor + by)

    def _go(self, step: int) -> None:
        visitor = self._visitor
        with visitor.lock:
            if visitor.owner is not None:
                visitor.owner.goto(min(max(step, 0), self._last))

    def _pressed(self) -> None:
        step = self._visitor.cursor
        to = {"|◀": 0, "◀": step - 1, "▶": step + 1, "▶|": self._last}
        pressed = chosen(self._buttons)
        if pressed in to:
            self._goto(to[pressed])
        else:
            self._toggle()

    def _toggle(self) -> None:
        """Play, or pause."""
        visitor = self._visitor
        if visitor.owner is None:
            return
        if visitor.is_playing():
            visitor.stop()
            return
        if visitor.cursor >= self._last:
            self._go(0)
        visitor.play(self._frames)

    def _frames(self, ended: threading.Event) -> None:
        visitor = self._visitor
        due = time.monotonic()
        owner = visitor.owner
        while not ended.is_set() and visitor.cursor < self._last and visitor.owner is owner:
            self._go(visitor.cursor + 1)
            due = max(due + 1 / min(max(self._speed.value, 1), 10), time.monotonic())
            ended.wait(due - time.monotonic())
        ended.set()
