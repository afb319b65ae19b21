"""One browser at the studio: what it looks at, and the panels it has."""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tmd.diagnostics import TmdError, install_extra
from tmd.inference.ranking import RankedPlan
from tmd.pddl.model import Instruction
from tmd.robot.monitor.listeners import Title
from tmd.robot.sim.pose import Vector
from tmd.studio.demonstrations.session import DemonstratedStep
from tmd.studio.environment_view import Reel
from tmd.studio.page import Event, PageLink, Window
from tmd.studio.panels.context import PanelContext, Played, put
from tmd.studio.panels.correct_panel import CorrectPanel
from tmd.studio.panels.demonstrate_panel import DemonstratePanel
from tmd.studio.panels.html import fragment, notice
from tmd.studio.panels.object_panel import ObjectPanel
from tmd.studio.panels.player_panel import PlayerPanel
from tmd.studio.panels.say_panel import SayPanel
from tmd.studio.view3d.performance import perform
from tmd.studio.view3d.scenery import Scenery
from tmd.world.demonstration import Demonstration

if TYPE_CHECKING:
    from viser import ClientHandle

    from tmd.studio.studio import Studio

# Pixels of the panel beside the 3D view: two fifths of the window, between these.
WIDTH, LEAST_WIDTH = 430, 330
WELCOME = (
    "Welcome. Say: type what is to be done, or take an example, and press Enter. Demonstrate: show how it is done, and "
    "the next sentence uses it. Correct: change a plan that was made."
)
LEARNING = "Learning from what was saved. Go on meanwhile; plans may still change at its end."
ROOM, EYES = "the whole room", "with the robot's eyes"
# Seconds within which a click in the picture is the one that an object was pointed at with.
_CLICK = 1.5
TABS = ("Say", "Demonstrate", "Correct", "Object")
# Under this name a browser keeps which visitors its windows are.
KEY = "tmd-visitor"


class Visitor(PanelContext):
    """One connected browser, with its panels and its view; arguments as of :class:`PanelContext`."""

    def __init__(self, studio: Studio, client: ClientHandle, identity: str) -> None:
        super().__init__(studio, client, identity)
        self._pointed_at = -_CLICK
        self._first_person = False
        self._aimed: tuple[float, Vector] = (0.0, (0.0, 0.0, 0.0))
        self.scenery: Scenery | None = None
        with self.lock:  # who is quick waits until everything is there
            self._furnish()

    def _furnish(self) -> None:
        """Make the panels and the view."""
        studio, gui = self.studio, self.client.gui
        gui.set_panel_label("tmd studio")
        self.window = Window(self.client, lambda event: self.guarded(lambda: self._happened(event))(None))
        self._theme(dark=self.window.dark)
        gui.main_panel.dock_right()
        gui.main_panel.set_width(min(WIDTH, max(LEAST_WIDTH, self.client.camera.image_width * 2 // 5)))
        self.setting = studio.setting(studio.start)
        self.reel = Reel(self.setting)
        self._message = gui.add_html(
            notice(WELCOME, "Click on a thing in the picture to see what it is. Ctrl-K lists commands and their keys.")
        )
        self._learning = gui.add_html(fragment(f"<p>{LEARNING}</p>"), visible=False)
        self._blind = gui.add_html("")
        self._where = self.dropdown("Environment", studio.environments())
        put(self._where, studio.start)
        self._where.on_update(self.guarded(self._go))
        self._view = self.dropdown("View (V)", (ROOM, EYES), lambda: self.first_person(self._view.value == EYES))
        self._names = gui.add_checkbox("Names (L)", False)
        self._names.on_update(self.guarded(self._name))
        self.player = PlayerPanel(self)
        tabs = gui.add_tab_group()
        with tabs.add_tab(TABS[0]):
            self.say = SayPanel(self)
        with tabs.add_tab(TABS[1]):
            self.demonstrate = DemonstratePanel(self)
        with tabs.add_tab(TABS[2]):
            self.correct = CorrectPanel(self)
        with tabs.add_tab(TABS[3]):
            self.object = ObjectPanel(self)
        self._tab = "Say"
        self._commands()
        self._build()
        self.client.camera.on_update(self.guarded(self._resized))

    def come_back(self) -> None:
        """Show the view of the window's address: that before it was loaded again, or one that was sent."""
        link = self.window.link
        if link.environment in self.studio.environments() and link.environment != self.setting.name:
            self.enter(link.environment)
        if link.say:
            self.say.come_back(link)
        if link.tab in TABS:
            self._tab = link.tab
            self.window.show_tab(link.tab)
        if link.tab == "Demonstrate":
            self.demonstrate.come_back()
        elif link.tab == "Correct":
            self.correct.come_back()

    def _theme(self, *, dark: bool) -> None:
        self.client.gui.configure_theme(show_logo=False, show_share_button=False, dark_mode=dark)

    def _happened(self, event: Event) -> None:
        """Handle an event that the page's own script sends."""
        if event.dark is not None:
            self._theme(dark=event.dark)
        elif event.tab in TABS:
            self._tab = event.tab
            self.keep_link()
        elif event.step is not None:
            owners: dict[str, Played] = {"say": self.say, "demonstrate": self.demonstrate, "correct": self.correct}
            if event.list in owners:
                self.stop()
                owners[event.list].goto(event.step)
        elif event.clicked and time.monotonic() - self._pointed_at > _CLICK:  # a click on an object has come before
            self.select(None)

    def keep_link(self) -> None:
        """Let the window's address say what is looked at."""
        plan, step, text = self.say.looked_at()
        tab = self._tab if self._tab != "Say" else ""
        self.window.keep(PageLink(environment=self.setting.name, say=text, plan=plan, step=step, tab=tab))

    def show_tab(self, name: str) -> None:
        """Open a tab."""
        self._tab = name
        self.window.show_tab(name)
        self.keep_link()

    # what is looked at

    def _go(self) -> None:
        if self._where.value != self.setting.name:
            self.enter(self._where.value)

    def enter(self, name: str) -> None:
        """Go to another environment."""
        self.stop()
        self.setting = self.studio.setting(name)
        names = tuple(self.studio.environments())
        if self._where.options != names:
            self._where.options = names
        self.reel = Reel(self.setting)
        self.cursor, self.selected = 0, None
        put(self._where, name)
        self._build()
        for panel in (self.say, self.demonstrate, self.correct, self.object):
            panel.entered()
        self.keep_link()

    def _build(self) -> None:
        self.client.scene.reset()
        look = self.setting.look
        self.scenery = None
        self._view.visible = self._names.visible = look is not None
        listed = "Its objects are listed under Object."
        self._blind.content = "" if look is not None else notice(self.setting.blind, listed)
        if look is None:
            self.client.scene.add_label("/blind", "no picture of this environment")
            return
        with self.client.atomic():
            self.scenery = Scenery(self.client.scene, look, self.studio.figure(), self._pointed)
            self.scenery.names(shown=self._names.value)
        self._camera()
        if self.studio.figure() is None:
            self.tell("The PR2 is not shown: its model is not installed.", install_extra("robot"))

    def watch(self, reel: Reel, step: int, by: Played | None = None, instructions: Sequence[Instruction] = ()) -> None:
        """Look at a state of some states; ``by`` is the panel whose instructions lead through them."""
        self.reel, self.cursor, self.owner = reel, step, by
        self.player.show(tuple(instructions))
        picture = reel.picture(step)
        if picture is not None and self.scenery is not None:
            self.scenery.draw(picture)
            if self._first_person:
                self._camera()
        self.object.refresh()

    def select(self, name: str | None) -> None:
        """Point at an object."""
        if name is not None and name not in self.setting.names():
            raise TmdError(f"there is no object '{name}' here")
        self.selected = name
        if self.scenery is not None:
            self.scenery.mark(name)
        self.object.refresh()
        self.demonstrate.offers()

    def _name(self) -> None:
        if self.scenery is not None:
            self.scenery.names(shown=self._names.value)

    def _pointed(self, name: str) -> None:
        self._pointed_at = time.monotonic()
        self.guarded(lambda: self.select(name))(None)

    # the camera

    def _camera(self) -> None:
        picture = self.reel.picture(self.cursor)
        if self.scenery is None or picture is None:
            return
        camera = self.client.camera
        if self._first_person:
            eye, target = self.scenery.eyes(picture)
        else:
            eye, target = self.scenery.overview(camera.fov, camera.aspect)
        self._aimed = camera.aspect, eye
        with self.client.atomic():
            camera.up_direction = (0.0, 0.0, 1.0)
            camera.position = eye
            camera.look_at = target

    def _resized(self) -> None:
        """Look at the whole room again in a view of another form, unless the visitor moved the camera."""
        camera = self.client.camera
        aspect, eye = self._aimed
        if not self._first_person and aspect != camera.aspect and np.allclose(camera.position, eye, atol=0.01):
            self._camera()

    def first_person(self, on: bool) -> None:
        """See with the robot's eyes, or the whole room."""
        if on != self._first_person:
            self._first_person = on
            put(self._view, EYES if on else ROOM)
            self._camera()

    # the robot

    def execute(self, plan: RankedPlan) -> None:
        """Let the simulated robot carry a plan out, in the background; :meth:`stop` ends it."""
        scenery, figure = self.scenery, self.studio.figure()
        if scenery is None:
            raise TmdError(f"the robot cannot do it here. {self.setting.blind}")
        if figure is None:
            raise TmdError("the PR2's model is not installed", hint=install_extra("robot"))

        def frames(ended: threading.Event) -> None:
            self.tell("The simulation is being set up …", aloud=True)
            folder = self.studio.corpus.folder

            def begun(title: Title) -> None:
                repair = "repair: " if title.repair else ""
                done = self.wording.instruction(title.instruction)
                said = f"The robot, step {title.number} of {title.of}: {repair}{done}"
                self.player.say(said)
                self.tell(said)
                self.say.mark(title.number)

            self.tell(perform(self.setting, folder, plan, scenery, figure, ended, begun), aloud=True)
            ended.set()

        self.play(frames)

    # what panels have for one another

    def open_correction(self, text: str, plan: Sequence[DemonstratedStep]) -> None:
        """Correct a plan for a text in the panel for that."""
        self.correct.open(text, plan)

    def saved(self, demonstration: Demonstration) -> None:
        """Plan the text of a saved demonstration again, and report whether the plan uses it."""
        self.say.saved(demonstration)

    def learning(self, *, on: bool) -> None:
        """Show that something is being learned, or that it is done."""
        self._learning.visible = on
        if not on:
            self.guarded(self.say.learned)(None)

    # keys

    def _commands(self) -> None:
        """Add the hot keys; W, A, S, D, Q, E and the arrows move the camera, and space presses the focused button."""
        gui = self.client.gui
        for label, key, act in (
            ("Next step", "N", lambda: self.player.move(1)),
            ("Step back", "B", lambda: self.player.move(-1)),
            ("Play or pause", "P", self.player.toggle),
            ("Show or hide the names", "L", lambda: put(self._names, not self._names.value)),
            ("Point at no object", "O", lambda: self.select(None)),
            ("See with the robot's eyes, or the whole room", "V", lambda: self.first_person(not self._first_person)),
            ("Undo", "U", self.demonstrate.undo),
            ("Redo", "R", self.demonstrate.redo),
            ("Keep the demonstration: save it", "K", self.demonstrate.save),
        ):
            gui.add_command(label, hotkey=key).on_trigger(self.guarded(act))  # type: ignore[arg-type]
