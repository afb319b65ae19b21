"""The player above the tabs: a slider and a row of buttons for the steps of a panel, and the caption."""

from __future__ import annotations

import threading
import time
from html import escape

from tmd.pddl.model import Instruction
from tmd.studio.panels.context import PanelContext, Played
from tmd.studio.panels.widgets import chosen, put

BUTTONS = ("|◀", "◀", "▶ play", "▶", "▶|")


class PlayerPanel:
    """Panel that steps through, and plays, the plan of another panel."""

    def __init__(self, visitor: PanelContext) -> None:
        self._visitor = visitor
        self._owner: Played | None = None
        self._step = self._last = 0
        gui, guarded = visitor.client.gui, visitor.guarded
        self._caption = gui.add_html("")
        self._slider = gui.add_slider("Step", 0, 1, 1, 0, visible=False)
        self._slider.on_update(guarded(self._slid))
        self._buttons = gui.add_button_group("Steps", BUTTONS, visible=False)
        self._buttons.on_click(guarded(self._pressed))
        self._speed = gui.add_slider("Steps a second", 1, 10, 1, 2, visible=False)

    def show(self, owner: Played | None, instructions: tuple[Instruction, ...], step: int) -> None:
        """Show where in the steps of a panel the visitor is; nothing where there are none."""
        self._owner, self._step, self._last = owner, step, len(instructions)
        found = owner is not None and bool(instructions)
        for handle in (self._slider, self._buttons, self._speed):
            if handle.visible != found:
                handle.visible = found
        if found:
            self._slider.max = self._last
            put(self._slider, step)
        done = self._visitor.wording.instruction(instructions[step - 1]) if 0 < step <= self._last else "the beginning"
        self.say(f"{step} / {self._last} {done}" if found else "")

    @property
    def owner(self) -> Played | None:
        """The panel whose steps are looked at."""
        return self._owner

    def say(self, words: str) -> None:
        """Put a caption over the picture."""
        content = f'<p class="tmd-caption" hidden>{escape(words)}</p>'
        if self._caption.content != content:
            self._caption.content = content

    def _slid(self) -> None:
        if self._owner is not None and self._slider.value != self._step:
            self.goto(int(self._slider.value))

    def goto(self, step: int) -> None:
        """Look at the state after so many steps; playing ends."""
        self._visitor.stop()
        self._go(step)

    def move(self, by: int) -> None:
        """Go some steps on, or back."""
        self.goto(self._step + by)

    def _go(self, step: int) -> None:
        if self._owner is not None:
            self._owner.goto(min(max(step, 0), self._last))

    def _pressed(self) -> None:
        to = {"|◀": 0, "◀": self._step - 1, "▶": self._step + 1, "▶|": self._last}
        pressed = chosen(self._buttons)
        if pressed in to:
            self.goto(to[pressed])
        else:
            self.toggle()

    def toggle(self) -> None:
        """Play, or pause."""
        visitor = self._visitor
        if self._owner is None:
            return
        if visitor.is_playing():
            visitor.stop()
            return
        if self._step >= self._last:
            self._go(0)
        visitor.play(self._frames)

    def _frames(self, ended: threading.Event) -> None:
        due = time.monotonic()
        owner = self._owner
        while not ended.is_set() and self._step < self._last and self._owner is owner:
            self._go(self._step + 1)
            due = max(due + 1 / min(max(self._speed.value, 1), 10), time.monotonic())
            ended.wait(due - time.monotonic())
        ended.set()
