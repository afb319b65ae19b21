"""Interface of a browser window for its panels."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Protocol

from tmd.inference.ranking import RankedPlan
from tmd.pddl.model import Instruction
from tmd.studio.demonstrations.session import DemonstratedStep, Session
from tmd.studio.environment_view import Setting
from tmd.studio.studio import Studio
from tmd.studio.view3d.playback import Reel
from tmd.view.wording import Wording
from tmd.world.demonstration import Demonstration

if TYPE_CHECKING:
    from viser import ClientHandle


class Played(Protocol):
    """A panel whose steps are looked at."""

    def goto(self, step: int) -> None:
        """Look at the state after so many steps."""


class PanelContext(Protocol):
    """One connected browser, as its panels see it; attributes as those of :class:`~tmd.studio.visitor.Visitor`."""

    studio: Studio
    client: ClientHandle
    identity: str
    setting: Setting
    reel: Reel
    cursor: int
    selected: str | None

    @property
    def wording(self) -> Wording:
        """The words of the environment."""

    def guarded(self, act: Callable[[], Any]) -> Callable[[object], None]:
        """Return a callback that reports errors to the visitor."""

    def holding(self) -> threading.RLock:
        """Return the lock: one thing at a time happens to what is looked at."""

    def tell(self, message: str, hint: str | None = None, *, fault: bool = False, aloud: bool = False) -> None:
        """Show a message at the top of the panel."""

    def enter(self, name: str) -> None:
        """Go to another environment."""

    def watch(self, reel: Reel, step: int, by: Played | None = None, instructions: Sequence[Instruction] = ()) -> None:
        """Look at a state of some states; ``by`` is the panel whose instructions lead through them."""

    def shows(self, panel: Played) -> bool:
        """Return whether the steps of no other panel are looked at."""

    def keep_link(self) -> None:
        """Let the window's address say what is looked at."""

    def show_tab(self, name: str) -> None:
        """Open a tab."""

    def ask(self, title: str, question: str, yes: str, act: Callable[[], Any]) -> None:
        """Do something if the visitor says so."""

    def select(self, name: str | None) -> None:
        """Point at an object."""

    def play(self, frames: Callable[[threading.Event], None]) -> None:
        """Run something that shows one thing after the other, until :meth:`stop`."""

    def is_playing(self) -> bool:
        """Return whether something is being played."""

    def stop(self) -> None:
        """Stop playing."""

    def execute(self, plan: RankedPlan) -> None:
        """Let the simulated robot carry a plan out."""

    def open_correction(self, text: str, plan: Sequence[DemonstratedStep]) -> None:
        """Correct a plan for a text in the panel for that."""

    def saved(self, demonstration: Demonstration) -> None:
        """Plan the text of a saved demonstration again, and report whether the plan uses it."""

    def take_over(self, session: Session, goal: str, taken: Callable[[], None]) -> None:
        """Go on with a corrected plan in the panel where demonstrations are saved; ``taken`` is called then."""
