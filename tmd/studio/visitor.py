"""One browser at the studio: what it looks at, and the panels it has."""

from __future__ import annotations

import time
from collections.abc import Sequence
from html import escape
from typing import TYPE_CHECKING

import numpy as np

from tmd.diagnostics import TmdError, install_extra
from tmd.inference.ranking import RankedPlan
from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits
from tmd.robot.sim.pose import Vector
from tmd.studio.demonstrations.session import DemonstratedStep
from tmd.studio.environment_view import Reel
from tmd.studio.page import Event, PageLink, Window
from tmd.studio.panels.context import PanelContext, Played, put
from tmd.studio.panels.correct_panel import CorrectPanel
from tmd.studio.panels.demonstrate_panel import DemonstratePanel
from tmd.studio.panels.object_panel import ObjectPanel
from tmd.studio.panels.player_panel import PlayerPanel
from tmd.studio.panels.say_panel import SayPanel
from tmd.studio.view3d.performance import RATE, RobotRun
from tmd.studio.view3d.scenery import Scenery
from tmd.view.markup import style
from tmd.view.panels import fragment, notice
from tmd.view.state_graph import StateGraph
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
VIEWS = ("the whole room", "behind the robot", "the object of the step", "the robot's eyes")
ROOM, BEHIND, OBJECT, EYES = VIEWS
# Seconds within which a click in the picture is the one that an object was pointed at with.
_CLICK = 1.5
_NOWHERE = (0.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
TABS = ("Say", "Demonstrate", "Correct", "Object")
# Under this name a browser keeps which visitors its windows are.
KEY = "tmd-visitor"


class Visitor(PanelContext):
    """One connected browser, with its panels and its view; arguments as of :class:`PanelContext`."""

    def __init__(self, studio: Studio, client: ClientHandle, identity: str) -> None:
        super().__init__(studio, client, identity)
        self._pointed_at = -_CLICK
        self._scenes = 0
        self.run: RobotRun | None = None
        self._aimed: tuple[float, Vector, Vector] = _NOWHERE
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
        self._graph: tuple[tuple[Bits, ...], StateGraph] | None = None
        self._drawn = gui.add_html("")
        self._message = gui.add_html(
            notice(WELCOME, "Click on a thing in the picture to see what it is. Ctrl-K lists commands and their keys.")
        )
        self._learning = gui.add_html(fragment(f"<p>{LEARNING}</p>"), visible=False)
        self._blind = gui.add_html("")
        self._where = self.dropdown("Environment", studio.environments())
        put(self._where, studio.start)
        self._where.on_update(self.guarded(self._go))
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
        with gui.add_folder("View", expand_by_default=False):
            self._view = self.dropdown("View (V)", VIEWS, self._camera)
            self._names = gui.add_checkbox("Names (L)", False)
            self._names.on_update(self.guarded(self._name))
            self.player.settings()
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
        self._dark = dark
        self.client.gui.configure_theme(show_logo=False, show_share_button=False, dark_mode=dark)

    def _happened(self, event: Event) -> None:
        """Handle an event that the page's own script sends."""
        if event.dark is not None:
            self._theme(dark=event.dark)
            self._build()
            self.draw()
        elif event.tab in TABS:
            self._tab = event.tab
            self.keep_link()
        elif event.step is not None:
            owners: dict[str, Played] = {"say": self.say, "demonstrate": self.demonstrate, "correct": self.correct}
            if event.list in owners:
                self.stop()
                owners[event.list].goto(event.step)
        elif event.object:
            self.select(event.object)
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
            try:
                self.enter(self._where.value)
            finally:  # it may be wrong, or too large
                put(self._where, self.setting.name)

    def enter(self, name: str) -> None:
        """Go to another environment."""
        self.stop()
        self.tell(f"Opening {name} …")
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
        self.tell(f"This is {name}. Say what is to be done, or show it.")
        self.keep_link()

    def _build(self) -> None:
        self.client.scene.reset()
        look = self.setting.look
        self.scenery = None
        self._view.visible = self._names.visible = look is not None
        self._blind.content = "" if look is not None else fragment(f"<p class='quiet'>{escape(self.setting.blind)}</p>")
        self._drawn.content, self._graph, self._aimed = "", None, _NOWHERE
        if look is None:
            self._draw_graph()
            return
        with self.client.atomic():
            self._scenes += 1
            self.scenery = Scenery(
                self.client.scene, look, self.studio.figure(), self._pointed, dark=self._dark, number=self._scenes
            )
        self._camera()
        self._name()
        if self.studio.figure() is None:
            self.tell("The PR2 is not shown: its model is not installed.", install_extra("robot"))

    def watch(self, reel: Reel, step: int, by: Played | None = None, instructions: Sequence[Instruction] = ()) -> None:
        """Look at a state of some states; ``by`` is the panel whose instructions lead through them."""
        self.reel, self.cursor, self.owner = reel, step, by
        if isinstance(reel, RobotRun):
            self.moment = len(reel.moments) - 1 if self.live and not reel.over else reel.after(step)
        self.player.show(tuple(instructions))
        self.draw()
        self.object.refresh()

    def draw(self) -> None:
        """Draw what is looked at: a moment of a run, or a state."""
        reel, scenery = self.reel, self.scenery
        if scenery is None:
            self._draw_graph()
            return
        with self.client.atomic():  # half of the robot must not go before the rest
            if isinstance(reel, RobotRun) and reel.moments:
                scenery.replay(reel.moments[self.moment])
            elif (picture := reel.picture(0 if isinstance(reel, RobotRun) else self.cursor)) is not None:
                scenery.draw(picture)
        if self._view.value != ROOM:
            self._camera()
        if self._names.value:
            self._name()

    def _draw_graph(self) -> None:
        """Draw the state that is looked at as a graph, where there is no scene; the page puts it into the view."""
        reel, problem = self.reel, self.setting.world.task.problem
        if self._graph is None or self._graph[0] != reel.states:
            states = [reel.facts(step) for step in range(len(reel.states))]
            names = [name for instruction in self.player.instructions for name in instruction.args]
            self._graph = reel.states, StateGraph(problem, states, names)
        before = reel.facts(self.cursor - 1) if self.cursor else None
        svg = self._graph[1].svg(reel.facts(self.cursor), before, self.selected, f"{self.setting.name} as a graph")
        self._drawn.content = f'<style>{style()}</style><div class="tmd-state" hidden>{svg}</div>'

    def select(self, name: str | None) -> None:
        """Point at an object."""
        if name is not None and name not in self.setting.names():
            raise TmdError(f"there is no object '{name}' here")
        self.selected = name
        if self.scenery is not None:
            self.scenery.mark(name)
        else:
            self._draw_graph()
        self.object.refresh()
        self.demonstrate.offers()

    def _name(self) -> None:
        """Show the names, or hide them."""
        if self.scenery is not None:
            self.scenery.names(self.client.camera if self._names.value else None)

    def _pointed(self, name: str) -> None:
        self._pointed_at = time.monotonic()
        self.guarded(lambda: self.select(name))(None)

    # the camera

    def _camera(self) -> None:
        """Look from where the view says."""
        scenery, camera = self.scenery, self.client.camera
        if scenery is None:
            return
        aim = {BEHIND: scenery.behind, OBJECT: lambda: scenery.near(self._touched()), EYES: scenery.eyes}
        eye, target = aim.get(self._view.value, lambda: None)() or scenery.overview(camera.fov, camera.aspect)
        if (camera.aspect, eye, target) == self._aimed:
            return
        self._aimed = camera.aspect, eye, target
        with self.client.atomic():
            camera.up_direction = (0.0, 0.0, 1.0)
            camera.position = eye
            camera.look_at = target

    def _touched(self) -> list[str]:
        """Return the objects of the step that is looked at, or of what the robot does now; parts as their wholes."""
        done, step = self.player.instructions, self.cursor
        now = self.run.now if self.run is not None and self.live and self.reel is self.run else None
        found = now.instruction if now else done[step - 1] if 0 < step <= len(done) else None
        wholes = self.setting.world.profiles.wholes
        return [wholes.get(name, name) for name in found.args] if found else []

    def _resized(self) -> None:
        """Look at the whole room again in a view of another form, unless the visitor moved the camera; move names."""
        camera = self.client.camera
        aspect, eye, _ = self._aimed
        if self._view.value == ROOM and aspect != camera.aspect and np.allclose(camera.position, eye, atol=0.01):
            self._camera()
        if self._names.value:
            self._name()

    def _turn(self) -> None:
        """Take the next view."""
        put(self._view, VIEWS[(VIEWS.index(self._view.value) + 1) % len(VIEWS)])

    # the robot

    def execute(self, plan: RankedPlan) -> RobotRun:
        """Let the simulated robot carry a plan out, in the background."""
        if self.scenery is None:
            raise TmdError(f"the robot cannot do it here. {self.setting.blind}")
        if self.studio.figure() is None:
            raise TmdError("the PR2's model is not installed", hint=install_extra("robot"))
        self.halt()
        self.run = run = self.studio.runs[self.identity] = RobotRun(self.setting, plan)
        self.live = True
        self.tell("The simulation is being set up …", aloud=True)

        def moved() -> None:
            with self.lock:
                if self.live and self.reel is run:
                    self.moment = len(run.moments) - 1
                    self.draw()
                    self.player.time(run)

        def advanced() -> None:
            with self.lock:
                if self.run is run:
                    self.say.ran(run)

        self.behind(lambda: run.carry_out(self.studio.corpus.folder, moved, advanced))
        return run

    def halt(self) -> None:
        """Stop the robot."""
        if self.run is not None:
            self.run.ended.set()

    def seek(self, second: float) -> None:
        """Look at a moment of the run that is looked at."""
        run = self.reel
        if not isinstance(run, RobotRun) or not run.moments:
            return
        self.stop()
        moment = min(max(round(second * RATE), 0), len(run.moments) - 1)
        self.say.goto(run.moments[moment].step)
        self.moment, self.live = moment, moment == len(run.moments) - 1
        self.draw()

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
            ("Next view", "V", self._turn),
            ("Undo", "U", self.demonstrate.undo),
            ("Redo", "R", self.demonstrate.redo),
            ("Keep the demonstration: save it", "K", self.demonstrate.save),
        ):
            gui.add_command(label, hotkey=key).on_trigger(self.guarded(act))  # type: ignore[arg-type]
