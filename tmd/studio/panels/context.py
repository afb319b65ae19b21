"""Services of a browser window for its panels: widgets, messages, one action at a time, and playing."""

from __future__ import annotations

import sys
import threading
import traceback
from collections.abc import Callable, Sequence
from html import escape
from typing import TYPE_CHECKING, Any, Literal, Protocol

from tmd.diagnostics import TmdError
from tmd.goals.wording import Wording
from tmd.inference.ranking import RankedPlan
from tmd.pddl.model import Instruction
from tmd.studio.demonstrations.session import DemonstratedStep
from tmd.studio.environment_view import Reel, Setting
from tmd.studio.studio import Studio
from tmd.studio.view3d.performance import RobotRun
from tmd.view.panels import fragment, notice
from tmd.world.demonstration import Demonstration

if TYPE_CHECKING:
    import viser

# Of messages and of faults, as on the page.
BLUE, ORANGE = (0, 114, 178), (213, 94, 0)
# Seconds that a message over the view stays.
ALOUD = 8.0

Act = Callable[[], Any]
Colour = Literal["gray", "blue", "red"]

# Set by its name: the inputs' own types say that a program cannot set it.
_VALUE = "value"


class Played(Protocol):
    """A panel whose steps are looked at."""

    def goto(self, step: int) -> None:
        """Look at the state after so many steps."""


class PanelContext:
    """One connected browser, as its panels see it; :class:`~tmd.studio.visitor.Visitor` has the panels and the view.

    Args:
        studio: The state that all visitors share.
        client: The browser's side.
        identity: The visitor's name, under which drafts are kept.

    Attributes:
        setting: The environment that is looked at.
        reel: The states that are looked at.
        cursor: The number of steps before the state that is seen.
        owner: The panel whose steps are looked at, if any.
        selected: The object that was pointed at.
        moment: The moment of the run that is seen, where a run is looked at.
        live: Whether the robot is followed in its run.
        lock: One thing at a time happens to what is looked at.
    """

    setting: Setting
    reel: Reel

    def __init__(self, studio: Studio, client: viser.ClientHandle, identity: str) -> None:
        self.studio = studio
        self.client = client
        self.identity = identity
        self.cursor = self.moment = 0
        self.live = False
        self.owner: Played | None = None
        self.selected: str | None = None
        self.lock = threading.RLock()
        self._playing: threading.Event | None = None
        self._message: viser.GuiHtmlHandle | None = None
        self._voice = threading.Lock()
        self._aloud: viser.NotificationHandle | None = None

    @property
    def wording(self) -> Wording:
        """The words of the environment."""
        return self.studio.offers(self.setting.name).wording

    # widgets

    def button(self, label: str, act: Act, *, color: Colour = "gray", **options: Any) -> viser.GuiButtonHandle:  # noqa: ANN401
        """Add a button: blue is the main one of its panel, red throws something away, any other one is grey."""
        handle = self.client.gui.add_button(label, color=color, **options)
        handle.on_click(self.guarded(act))
        return handle

    def buttons(
        self, label: str, names: Sequence[str], act: Act, *, visible: bool = True
    ) -> viser.GuiButtonGroupHandle:
        """Add a row of buttons."""
        handle = self.client.gui.add_button_group(label, names, visible=visible)
        handle.on_click(self.guarded(act))
        return handle

    def dropdown(
        self, label: str, options: Sequence[str], act: Act | None = None, *, visible: bool = True
    ) -> viser.GuiDropdownHandle[str]:
        """Add a list to choose from."""
        handle: viser.GuiDropdownHandle[str] = self.client.gui.add_dropdown(label, options, visible=visible)
        if act is not None:
            handle.on_update(self.guarded(act))
        return handle

    # one action at a time

    def guarded(self, act: Act) -> Callable[[object], None]:
        """Return a callback that holds the lock, and reports errors to the visitor, never by a traceback."""

        def called(_: object) -> None:
            with self.lock:
                self._report(act)

        return called

    def behind(self, act: Act) -> None:
        """Do something in the background, without the lock, and report errors to the visitor."""
        threading.Thread(target=self._report, args=(act,), daemon=True).start()

    def _report(self, act: Act) -> None:
        try:
            act()
        except TmdError as error:
            self.tell(error.message, error.hint, fault=True)
        except Exception:
            traceback.print_exc(file=sys.stderr)
            self.tell("that is a fault of tmd itself; what was saved is safe.", "See the terminal.", fault=True)

    # messages

    def tell(self, message: str, hint: str | None = None, *, fault: bool = False, aloud: bool = False) -> None:
        """Show a message at the top of the panel.

        Args:
            message: The message.
            hint: The remedy.
            fault: Something was not done.
            aloud: Show it over the view as well, for a while: the panel may be scrolled down. Faults always are.
        """
        if self._message is not None:
            self._message.content = notice(message, hint, fault=fault)
        if not (fault or aloud):
            return
        title, colour = ("Not done", ORANGE) if fault else ("tmd studio", BLUE)
        said = " – ".join(filter(None, (message, hint)))
        with self._voice:
            if self._aloud is not None:
                self._aloud.remove()
            self._aloud = self.client.add_notification(title, said, auto_close_seconds=ALOUD, color=colour)

    def ask(self, title: str, question: str, yes: str, act: Act) -> None:
        """Do something if the visitor agrees."""
        box = self.client.gui.add_modal(title)

        def agreed() -> None:
            box.close()
            act()

        with box:
            self.client.gui.add_html(fragment(f"<p>{escape(question)}</p>"))
            self.button(yes, agreed, color="red")
            self.button("Cancel", box.close)

    # playing

    def play(self, frames: Callable[[threading.Event], None]) -> None:
        """Run something that shows one thing after the other, in the background, until :meth:`stop`."""
        self.stop()
        ended = self._playing = threading.Event()
        self.behind(lambda: frames(ended))

    def is_playing(self) -> bool:
        """Return whether something is being played."""
        return self._playing is not None and not self._playing.is_set()

    def stop(self) -> None:
        """Stop playing."""
        if self._playing is not None:
            self._playing.set()

    # what concerns other panels or the view: see Visitor

    def enter(self, name: str) -> None:
        """Go to another environment."""

    def watch(self, reel: Reel, step: int, by: Played | None = None, instructions: Sequence[Instruction] = ()) -> None:
        """Look at a state of some states; ``by`` is the panel whose instructions lead through them."""

    def select(self, name: str | None) -> None:
        """Point at an object."""

    def keep_link(self) -> None:
        """Let the window's address name the view."""

    def show_tab(self, name: str) -> None:
        """Open a tab."""

    def execute(self, plan: RankedPlan) -> RobotRun:
        """Let the simulated robot carry a plan out, in the background; :meth:`halt` ends it."""
        raise NotImplementedError

    def halt(self) -> None:
        """Stop the robot."""

    def seek(self, second: float) -> None:
        """Look at a moment of the run that is looked at."""

    def open_correction(self, text: str, plan: Sequence[DemonstratedStep]) -> None:
        """Correct a plan for a text in the panel for that."""

    def saved(self, demonstration: Demonstration) -> None:
        """Plan the text of a saved demonstration again, and report whether the plan uses it."""


def put(handle: object, value: object) -> None:
    """Let an input have a value. Its callbacks are called as if the visitor had changed it, unless it has it."""
    if getattr(handle, _VALUE) != value:
        setattr(handle, _VALUE, value)


def chosen(handle: viser.GuiDropdownHandle[str] | viser.GuiButtonGroupHandle) -> str:
    """Return the chosen option of an input.

    Raises:
        TmdError: The page is out of date, or did not send the value.
    """
    value = handle.value
    if value not in handle.options:
        raise TmdError("that cannot be chosen any more", hint="choose again")
    return str(value)
